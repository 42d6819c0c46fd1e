// Script values as XML elements. Numbers are written so that they read back bit for bit.
#include "steve/library/archive_values.hpp"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <vector>

#include "runtime/base/in_pieces.hpp"

namespace breve::steve {

namespace {

[[noreturn]] void damaged(const std::string& what) { throw Error(ErrorCode::File, "the archive is damaged: " + what); }

std::string numbers_text(const double* values, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += (i == 0 ? "" : " ") + fmt::format("{}", values[i]);
  return text;
}

std::string shortened(std::string_view text) {
  constexpr std::size_t kShown = 40;  // bytes
  return std::string(text.substr(0, kShown)) + (text.size() > kShown ? "..." : "");
}

std::vector<double> numbers_of(std::string_view text, std::size_t count) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    while (at != end && *at == ' ') ++at;
    if (at == end) break;
    double number = 0;
    const auto [next, error] = std::from_chars(at, end, number);
    if (error != std::errc{}) damaged("'" + shortened(text) + "' is not a number");
    numbers.push_back(number);
    at = next;
    if (numbers.size() > count) break;
  }
  if (numbers.size() != count) damaged("'" + shortened(text) + "' has not " + std::to_string(count) + " numbers");
  return numbers;
}

std::int32_t int_of(std::string_view text) {
  const double number = numbers_of(text, 1)[0];
  using Limits = std::numeric_limits<std::int32_t>;
  if (!(number >= Limits::min() && number <= Limits::max())) damaged("'" + shortened(text) + "' is not an int");
  return static_cast<std::int32_t>(number);
}

/// XML cannot hold most control characters, and turns a carriage return into a newline.
bool plain(std::string_view text) {
  for (const char c : text)
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') return false;
  return true;
}

}  // namespace

std::string to_hex(std::string_view bytes, const Poll& poll) {
  static constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  text.reserve(bytes.size() * 2);
  in_pieces(bytes.size(), 1, poll, [&](std::size_t begin, std::size_t end) {
    for (const char c : bytes.substr(begin, end - begin)) {
      text += kDigits[static_cast<unsigned char>(c) >> 4];
      text += kDigits[static_cast<unsigned char>(c) & 15];
    }
  });
  return text;
}

std::string from_hex(std::string_view digits, const Poll& poll) {
  if (digits.size() % 2 != 0) damaged("an odd number of hexadecimal digits");
  std::string bytes;
  bytes.reserve(digits.size() / 2);
  in_pieces(digits.size() / 2, 1, poll, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      unsigned byte = 0;
      const char* const from = digits.data() + 2 * i;
      if (std::from_chars(from, from + 2, byte, 16).ptr != from + 2) damaged("a digit that is not hexadecimal");
      bytes += static_cast<char>(byte);
    }
  });
  return bytes;
}

bool ValueWriter::seen_before(pugi::xml_node node, std::uint64_t serial) {
  const auto [entry, fresh] = containers_.try_emplace(serial, static_cast<int>(containers_.size()) + 1);
  node.append_attribute(fresh ? "id" : "same") = entry->second;
  return !fresh;
}

void ValueWriter::write(pugi::xml_node parent, const Value& value, int depth) {
  if (depth > kMostNested)
    throw Error(ErrorCode::Argument,
                "lists nested more than " + std::to_string(kMostNested) + " deep cannot be archived");
  constexpr std::uint64_t kOfValue = 20, kBytesPerIteration = 16;  // iterations
  machine_.charge(kOfValue + (value.tag == Tag::String ? view(value.string()).size() / kBytesPerIteration : 0));
  pugi::xml_node node = parent.append_child(
      value.tag == Tag::Null || value.tag == Tag::Pointer ? "null" : std::string(type_name(value.tag)).c_str());
  switch (value.tag) {
    case Tag::Null:
    case Tag::Pointer: break;  // a pointer means nothing in another run
    case Tag::Int: node.text() = value.i; break;
    case Tag::Double: node.text() = numbers_text(&value.d, 1).c_str(); break;
    case Tag::Vector: node.text() = numbers_text(value.v, 3).c_str(); break;
    case Tag::Matrix:
      if (value.ref) node.text() = numbers_text(value.matrix()->m.data(), 9).c_str();
      break;
    case Tag::String: {
      const std::string text(view(value.string()));
      if (!plain(text)) node.append_attribute("hex") = true;
      node.text() = plain(text) ? text.c_str() : to_hex(text, machine_.poller()).c_str();
      break;
    }
    case Tag::Object: {
      const Instance* object = value.object();
      const auto number = object && object->live() ? numbers_.find(object->serial) : numbers_.end();
      if (number != numbers_.end()) node.append_attribute("ref") = number->second;
      break;
    }
    case Tag::List:
      if (!value.ref || seen_before(node, value.list()->serial)) break;
      for (const Value& element : *value.list()) write(node, element, depth + 1);
      break;
    case Tag::Hash: {
      if (!value.ref || seen_before(node, value.hash()->serial)) break;
      const HashCell& hash = *value.hash();
      for (std::uint32_t i = 0; i < hash.used; ++i) {
        if (!hash.entries[i].live()) continue;
        pugi::xml_node entry = node.append_child("entry");
        write(entry.append_child("key"), hash.entries[i].key, depth + 1);
        write(entry.append_child("value"), hash.entries[i].value, depth + 1);
      }
      break;
    }
    case Tag::Data:
      if (value.ref) {
        const auto& bytes = value.data()->bytes;
        node.text() = to_hex({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, machine_.poller()).c_str();
      }
      break;
  }
}

Value ValueReader::read_in(pugi::xml_node parent, int depth) {
  for (const pugi::xml_node element : parent.children())
    if (element.type() == pugi::node_element) return read(element, depth);
  damaged("a value is missing");
}

/// The list or hash that an earlier element stood for.
Value ValueReader::read_same(pugi::xml_node node, Tag tag) const {
  const auto found = containers_.find(node.attribute("same").as_int());
  if (found == containers_.end() || found->second.tag != tag) damaged("a list or hash that was not there before");
  return found->second;
}

Value ValueReader::read_list(pugi::xml_node node, int depth) {
  if (node.attribute("same")) return read_same(node, Tag::List);
  ListCell* list = machine_.heap().list();
  const Value value = Value::of(Tag::List, list);
  pins_.emplace_back(machine_, value);
  containers_.emplace(node.attribute("id").as_int(), value);
  for (const pugi::xml_node element : node.children())
    if (element.type() == pugi::node_element) machine_.heap().push(*list, read(element, depth + 1));
  return value;
}

Value ValueReader::read_hash(pugi::xml_node node, int depth) {
  if (node.attribute("same")) return read_same(node, Tag::Hash);
  HashCell* hash = machine_.heap().hash();
  const Value value = Value::of(Tag::Hash, hash);
  pins_.emplace_back(machine_, value);
  containers_.emplace(node.attribute("id").as_int(), value);
  for (const pugi::xml_node entry : node.children("entry")) {
    const Value key = read_in(entry.child("key"), depth + 1);
    machine_.heap().set(*hash, key, read_in(entry.child("value"), depth + 1));
  }
  return value;
}

Value ValueReader::read(pugi::xml_node element, int depth) {
  if (depth > kMostNested) damaged("its lists are nested too deeply");
  machine_.poll();
  Heap& heap = machine_.heap();
  const std::string_view type = element.name(), text = element.text().get();
  if (type == "null") return {};
  if (type == "int") return Value::of(int_of(text));
  if (type == "double") return Value::of(numbers_of(text, 1)[0]);
  if (type == "vector") return Value::of(Vector3(numbers_of(text, 3).data()));
  if (type == "matrix") return Value::of(Tag::Matrix, heap.matrix(Matrix3(numbers_of(text, 9).data())));
  if (type == "string")
    return Value::of(Tag::String,
                     heap.string(element.attribute("hex") ? from_hex(text, machine_.poller()) : std::string(text)));
  if (type == "data") return Value::of(Tag::Data, heap.data(from_hex(text, machine_.poller())));
  if (type == "list") return read_list(element, depth);
  if (type == "hash") return read_hash(element, depth);
  if (type == "object") {
    const auto found = objects_.find(element.attribute("ref").as_int());
    return Value::of(Tag::Object, found == objects_.end() ? nullptr : found->second);
  }
  damaged("there is no type '" + std::string(type) + "'");
}

}  // namespace breve::steve
