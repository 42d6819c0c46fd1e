// Elements of lists, hashes, vectors, matrices and strings: reading, replacing, inserting, removing (6.6, 8.1, 8.4).
#include <fmt/format.h>

#include "steve/machine/brief.hpp"
#include "steve/machine/operators.hpp"
#include "steve/syntax/words.hpp"

namespace breve::steve {

namespace {

constexpr std::string_view kIndex = "an index";

[[noreturn]] void fail_bounds(const std::string& message) { throw RunError(RunErrorKind::Bounds, message); }

[[noreturn]] void fail_base(const Value& base) {
  if (base.tag == Tag::Null)
    throw RunError(RunErrorKind::Type, "cannot take an element of no value (NULL)",
                   "a missing key of a hash gives NULL: test it with 'if' before");
  throw RunError(RunErrorKind::Type, fmt::format("{} has no elements", typed_brief(base)),
                 "lists, hashes, vectors, matrices and strings have elements; objects have variables");
}

std::uint32_t size_of(const ListCell* list) { return list != nullptr ? list->size : 0; }

int three(const Value& base, const Value& key) {
  const std::int32_t i = to_int(key, kIndex);
  if (i < 0 || i > 2) {
    const std::string_view parts = base.tag == Tag::Vector ? "components of a vector" : "rows of a matrix";
    fail_bounds(fmt::format("index {} is not one of the {}, 0 to 2", i, parts));
  }
  return i;
}

/// 0 for x, 1 for y, 2 for z.
int component(const Value& base, const StringCell* name) {
  const std::string_view text = view(name);
  if (text.size() == 1 && base.tag == Tag::Vector) {
    if (text[0] >= 'x' && text[0] <= 'z') return text[0] - 'x';
    if (text[0] >= 'X' && text[0] <= 'Z') return text[0] - 'X';
  }
  std::string message = fmt::format("{} has no member '{}'", a_type(base.tag), text);
  const std::string help = base.tag == Tag::Vector ? "a vector has x, y and z"
                           : names_a_size(text)    ? "the size of a list or of a text is written with bars: |list|"
                                                   : "objects and hashes have members";
  const auto dash = text.find('-');
  if (dash != std::string_view::npos)
    message += fmt::format("; for a subtraction write spaces around the minus: {} - {}", text.substr(0, dash),
                           text.substr(dash + 1));
  throw RunError(RunErrorKind::Type, message, help);
}

Value string_with_index(Heap& heap, const Value& base, const Value& key, const Value& value) {
  if (value.tag != Tag::String)
    fail_type(fmt::format("an element of a string can only be replaced by a string, not by {}", a_type(value.tag)));
  const std::string_view text = view(base.string());
  const std::int32_t i = to_int(key, kIndex);
  if (i < 0 || static_cast<std::size_t>(i) > text.size())
    fail_bounds(fmt::format("index {} is outside a string of {} bytes", i, text.size()));
  const auto at = static_cast<std::size_t>(i);
  std::pmr::string result(heap.memory());
  result.reserve(text.size() + view(value.string()).size());  // moved once, not at each part
  result += text.substr(0, at);
  result += view(value.string());
  if (at < text.size()) result += text.substr(at + 1);
  return Value::of(Tag::String, heap.string(result));
}

}  // namespace

void fail_list_bounds(std::int64_t i, std::size_t size) {
  if (size == 0)
    throw RunError(RunErrorKind::Bounds, fmt::format("index {} is outside an empty list", i),
                   "test its length, |list|, before; or push an element onto it");
  throw RunError(RunErrorKind::Bounds, fmt::format("index {} is outside a list of {}", i, size),
                 size == 1 ? "elements are counted from 0: its only one is 0"
                           : fmt::format("elements are counted from 0: they are 0 to {}", size - 1));
}

Value index(Heap& heap, const Value& base, const Value& key) {
  switch (base.tag) {
    case Tag::List: {
      const std::int32_t i = key.tag == Tag::Int ? key.i : to_int(key, kIndex);
      if (base.list() == nullptr) fail_list_bounds(i, 0);
      return (*base.list())[list_position(*base.list(), i)];
    }
    case Tag::Hash: {
      const Value* found = base.hash() != nullptr ? heap.find(*base.hash(), key) : nullptr;
      return found != nullptr ? *found : Value();
    }
    case Tag::Vector: return Value::of(base.v[three(base, key)]);
    case Tag::Matrix: {
      const int row = three(base, key);
      return Value::of(Vector3(to_matrix(base).row(row).transpose()));
    }
    case Tag::String: {
      const std::string_view text = view(base.string());
      const std::int32_t i = to_int(key, kIndex);
      if (i < 0 || static_cast<std::size_t>(i) >= text.size())
        fail_bounds(fmt::format("index {} is outside a string of {} bytes", i, text.size()));
      return Value::of(Tag::String, heap.string(text.substr(static_cast<std::size_t>(i), 1)));
    }
    default: fail_base(base);
  }
}

void set_index(Heap& heap, const Value& base, const Value& key, const Value& value) {
  if (base.tag == Tag::Hash && base.hash() != nullptr) return heap.set(*base.hash(), key, value);
  if (base.tag != Tag::List || base.list() == nullptr) fail_base(base);
  ListCell& list = *base.list();
  const std::int32_t i = to_int(key, kIndex);
  if (i >= 0 && static_cast<std::uint32_t>(i) == list.size) return heap.push(list, value);
  heap.set(list, list_position(list, i), value);
}

Value with_index(Heap& heap, const Value& base, const Value& key, const Value& value) {
  if (base.tag == Tag::String) return string_with_index(heap, base, key, value);
  if (base.tag == Tag::Vector) {
    const int i = three(base, key);
    Value result = base;
    result.v[i] = to_double(value, "a component of a vector");
    return result;
  }
  if (base.tag != Tag::Matrix) fail_base(base);
  const int row = three(base, key);
  Matrix3 m = to_matrix(base);
  m.row(row) = to_vector(value, "a row of a matrix").transpose();
  return Value::of(Tag::Matrix, heap.matrix(m));
}

Value member(Heap& heap, const Value& base, StringCell* name) {
  if (base.tag == Tag::Hash) return index(heap, base, Value::of(Tag::String, name));
  if (base.tag == Tag::Null) fail_base(base);
  return Value::of(base.v[component(base, name)]);
}

void set_member(Heap& heap, const Value& base, StringCell* name, const Value& value) {
  if (base.tag != Tag::Hash) fail_type(fmt::format("{} has no members to assign to", a_type(base.tag)));
  set_index(heap, base, Value::of(Tag::String, name), value);
}

Value with_member(const Value& base, StringCell* name, const Value& value) {
  const int i = component(base, name);
  Value result = base;
  result.v[i] = to_double(value, "a component of a vector");
  return result;
}

bool insert_at(Heap& heap, ListCell& list, const Value& index, const Value& value) {
  const std::int32_t i = to_int(index, kIndex);
  if (i < 0) fail_list_bounds(i, list.size);
  if (static_cast<std::uint32_t>(i) > list.size) return false;
  heap.insert(list, static_cast<std::uint32_t>(i), value);
  return true;
}

Value remove_at(Heap& heap, const Value& base, const Value& index, bool& found) {
  found = false;
  Value removed;
  if (base.tag == Tag::Hash) {
    if (base.hash() != nullptr) found = heap.remove(*base.hash(), index, removed);
    return removed;
  }
  if (base.tag != Tag::List) fail_base(base);
  const std::int32_t i = to_int(index, kIndex);
  const std::uint32_t size = size_of(base.list());
  if (i < 0) fail_list_bounds(i, size);
  if (static_cast<std::uint32_t>(i) >= size) return removed;
  found = true;
  return heap.remove(*base.list(), static_cast<std::uint32_t>(i));
}

}  // namespace breve::steve
