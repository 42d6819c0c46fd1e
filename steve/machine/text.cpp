// The text of values: the same bytes as the C library's printf in the "C" locale, without its cost. A number that
// six decimals would show as another one, such as 1e-9 as 0.000000, is the shortest text that reads back.
#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "steve/code/program.hpp"
#include "steve/machine/operators.hpp"

namespace breve::steve {

namespace {

constexpr std::size_t kDeepest = 1000;
constexpr double kFixedLimit = 1e10;  // a vector with a larger component is written with exponents
constexpr double kSmall = 1e-3;       // a vector with only smaller components shows all their digits

void append_number(std::string& out, double d, std::chars_format format, int decimals) {
  char buffer[kLongestDouble];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, d, format, decimals);
  out.append(buffer, result.ptr);
}

void append_triple(std::string& out, const double* v, std::chars_format format) {
  for (int i = 0; i < 3; ++i) {
    out += i == 0 ? "(" : ", ";
    append_number(out, v[i], format, 5);
  }
  out += ')';
}

/// Five decimals, or the shortest text that reads back where they would show another number.
void append_component(std::string& out, double d) {
  char buffer[kLongestDouble];
  const auto fixed = std::to_chars(buffer, buffer + sizeof buffer, d, std::chars_format::fixed, 5);
  double shown = 0;
  std::from_chars(buffer, fixed.ptr, shown);
  out.append(buffer, shown == d ? fixed.ptr : std::to_chars(buffer, buffer + sizeof buffer, d).ptr);
}

/// Small components are shown as they are only if there are no others: next to those they are mostly round-off.
void append_vector(std::string& out, const double* v) {
  if (std::all_of(v, v + 3, [](double x) { return std::abs(x) < kSmall; })) {
    for (int i = 0; i < 3; ++i) {
      out += i == 0 ? "(" : ", ";
      append_component(out, v[i]);
    }
    out += ')';
    return;
  }
  const bool large = std::any_of(v, v + 3, [](double x) { return std::abs(x) > kFixedLimit; });
  append_triple(out, v, large ? std::chars_format::scientific : std::chars_format::fixed);
}

void append_address(std::string& out, std::uint64_t serial) {
  fmt::format_to(std::back_inserter(out), "{:#x}", serial);
}

void append_data(std::string& out, const DataCell& data) {
  constexpr char kDigits[] = "0123456789abcdef";
  for (const std::uint8_t byte : data.bytes) {
    out += kDigits[byte >> 4];
    out += kDigits[byte & 15];
  }
}

void append_object(std::string& out, Instance* instance, const Describe& describe) {
  if (instance == nullptr) {
    out += "0x0 (NULL)";
    return;
  }
  out += instance->cls->name;
  out += " (";
  append_address(out, instance->serial);
  out += ") ";
  if (describe && instance->live()) out += describe(*instance);
}

/// One open list or hash: where its text goes on. Keeps it alive while descriptions run script.
struct Open {
  Cell* cell;
  std::uint32_t next = 0;
  bool empty = true;  // nothing of it is written yet
};

class Writer {
 public:
  Writer(std::string& out, const Describe& describe, Heap* heap)
      : out_(out), describe_(describe), heap_(heap), pins_(heap != nullptr && describe) {}
  ~Writer() {
    while (!open_.empty()) close();
  }

  void write(const Value& v) {
    append(v);
    while (!open_.empty()) {
      if (out_.size() >= check_at_) check();
      if (open_.back().cell->tag == Tag::List ? next_element() : next_entry()) continue;
      out_ += " }";
      close();
    }
  }

 private:
  void append(const Value& v) {
    switch (v.tag) {
      case Tag::Null: out_ += "(NULL expression)"; break;
      case Tag::Int: append_int(out_, v.i); break;
      case Tag::Double: append_double(out_, v.d); break;
      case Tag::Vector: append_vector(out_, v.v); break;
      case Tag::Matrix: append_matrix(v.matrix()); break;
      case Tag::String: out_ += view(v.string()); break;
      case Tag::Object: append_object(out_, v.object(), describe_); break;
      case Tag::List: open(v.list(), v.list() != nullptr ? v.list()->size : 0, "list"); break;
      case Tag::Hash: open(v.hash(), v.hash() != nullptr ? v.hash()->count_live : 0, "hash"); break;
      case Tag::Pointer:
        if (v.pointer() == nullptr)
          out_ += "(NULL pointer)";
        else
          append_address(out_, v.pointer()->serial);
        break;
      case Tag::Data:
        if (v.data() != nullptr) append_data(out_, *v.data());
        break;
    }
  }

  void append_matrix(const MatrixCell* cell) {
    const Matrix3 m = cell != nullptr ? cell->m : Matrix3::Zero();
    for (int row = 0; row < 3; ++row) {
      out_ += row == 0 ? "[ " : ", ";
      append_triple(out_, m.data() + 3 * row, std::chars_format::fixed);
    }
    out_ += " ]";
  }

  template <class Container>
  void open(Container* cell, std::uint32_t size, std::string_view kind) {
    if (size == 0) {
      out_ += "{ }";
    } else if (std::any_of(open_.begin(), open_.end(), [cell](const Open& o) { return o.cell == cell; })) {
      fmt::format_to(std::back_inserter(out_), "[circular {} reference ", kind);
      append_address(out_, cell->serial);
      out_ += ']';
    } else if (open_.size() >= kDeepest) {
      out_ += "{ ... }";
    } else {
      open_.push_back({cell});
      if (pins_) heap_->retain(cell);
      out_ += '{';
    }
  }

  /// @return  false at the end of the innermost list
  bool next_element() {
    Open& top = open_.back();
    auto& list = static_cast<ListCell&>(*top.cell);
    if (top.next >= list.size) return false;
    separate(top);
    const Value element = list[top.next++];
    append(element);
    return true;
  }

  /// The next `key: value` of the innermost hash, in the order in which the keys came.
  bool next_entry() {
    Open& top = open_.back();
    auto& hash = static_cast<HashCell&>(*top.cell);
    while (top.next < hash.used && !hash.entries[top.next].live()) ++top.next;
    if (top.next >= hash.used) return false;
    separate(top);
    const HashCell::Entry entry = hash.entries[top.next++];
    append_key(entry.key);
    out_ += ": ";
    append(entry.value);
    return true;
  }

  // A key that is a container or an object is known by what it is, not by what is in it. No script runs for it, which
  // could take the value away.
  void append_key(const Value& key) {
    if (key.tag == Tag::Object) {
      append_object(out_, key.object(), {});
      if (key.object() != nullptr) out_.pop_back();  // the blank that a description would follow
    } else if (key.tag == Tag::List || key.tag == Tag::Hash) {
      out_ += key.tag == Tag::List ? "[list " : "[hash ";
      append_address(out_, key.tag == Tag::List ? serial_of(key.list()) : serial_of(key.hash()));
      out_ += ']';
    } else {
      append(key);
    }
  }

  template <class Container>
  static std::uint64_t serial_of(const Container* cell) {
    return cell != nullptr ? cell->serial : 0;
  }

  void separate(Open& top) {
    out_ += top.empty ? " " : ", ";
    top.empty = false;
  }

  void close() {
    if (pins_) heap_->release(open_.back().cell);
    open_.pop_back();
  }

  // A list that holds one list twice, which holds another twice, and so on, is small and has an endless text.
  void check() {
    constexpr std::size_t kOfByte = 8;  // what is written takes so many times as long as what is moved
    if (heap_ != nullptr) {
      heap_->check_room(out_.size());
      heap_->work_on(kOfByte * (out_.size() - checked_));
    }
    checked_ = out_.size();
    check_at_ = out_.size() + kCheck;
  }

  std::string& out_;
  const Describe& describe_;
  Heap* heap_;
  bool pins_;  // descriptions run script, which may drop what is being written
  static constexpr std::size_t kCheck = std::size_t{1} << 16;  // bytes
  std::size_t checked_ = out_.size(), check_at_ = checked_ + kCheck;
  std::vector<Open> open_;
};

}  // namespace

void append_text(std::string& out, const Value& v, const Describe& describe, Heap* heap) {
  Writer(out, describe, heap).write(v);
}

std::string text(const Value& v, const Describe& describe, Heap* heap) {
  std::string out;
  append_text(out, v, describe, heap);
  return out;
}

StringCell* number_to_string(Heap& heap, std::int32_t i) {
  char buffer[16];
  const char* end = std::to_chars(buffer, buffer + sizeof buffer, i).ptr;
  return heap.string({buffer, static_cast<std::size_t>(end - buffer)});
}

StringCell* number_to_string(Heap& heap, double d) {
  char buffer[kLongestDouble];
  const char* end = write_double(buffer, buffer + sizeof buffer, d);
  return heap.string({buffer, static_cast<std::size_t>(end - buffer)});
}

}  // namespace breve::steve
