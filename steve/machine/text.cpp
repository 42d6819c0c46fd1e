// The text of values (9): the same bytes as the C library's printf in the "C" locale, without its cost.
#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "steve/compile/program.hpp"
#include "steve/machine/operators.hpp"

namespace breve::steve {

namespace {

constexpr std::size_t kDeepest = 1000;
constexpr double kFixedLimit = 1e10;         // a vector with a larger component is written with exponents (F32)
constexpr std::size_t kLongestDouble = 330;  // 309 digits, sign, point, six decimals

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

void append_vector(std::string& out, const double* v) {
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

/// One open list: where its text goes on. Keeps the list alive while descriptions run script.
struct OpenList {
  ListCell* list;
  std::uint32_t next;
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
      OpenList& top = open_.back();
      if (top.next >= top.list->size) {
        out_ += " }";
        close();
        continue;
      }
      if (out_.size() >= check_at_) check_room();
      out_ += top.next == 0 ? " " : ", ";
      const Value element = (*top.list)[top.next++];
      append(element);
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
      case Tag::List: append_list(v.list()); break;
      case Tag::Hash: out_ += "{ hash table }"; break;
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

  void append_list(ListCell* list) {
    if (list == nullptr || list->size == 0) {
      out_ += "{ }";
    } else if (std::any_of(open_.begin(), open_.end(), [list](const OpenList& o) { return o.list == list; })) {
      out_ += "[circular list reference ";
      append_address(out_, list->serial);
      out_ += ']';
    } else if (open_.size() >= kDeepest) {
      out_ += "{ ... }";
    } else {
      open_.push_back({list, 0});
      if (pins_) heap_->retain(list);
      out_ += '{';
    }
  }

  void close() {
    if (pins_) heap_->release(open_.back().list);
    open_.pop_back();
  }

  // A list that holds one list twice, which holds another twice, and so on, is small and has an endless text.
  void check_room() {
    if (heap_ != nullptr) heap_->check_room(out_.size());
    check_at_ = 2 * out_.size();
  }

  std::string& out_;
  const Describe& describe_;
  Heap* heap_;
  bool pins_;  // descriptions run script, which may drop what is being written
  std::size_t check_at_ = std::size_t{1} << 20;
  std::vector<OpenList> open_;
};

}  // namespace

void append_int(std::string& out, std::int32_t i) {
  char buffer[16];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, i).ptr);
}

void append_double(std::string& out, double d) { append_number(out, d, std::chars_format::fixed, 6); }

void append_vector(std::string& out, const Vector3& v) { append_vector(out, v.data()); }

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
  const char* end = std::to_chars(buffer, buffer + sizeof buffer, d, std::chars_format::fixed, 6).ptr;
  return heap.string({buffer, static_cast<std::size_t>(end - buffer)});
}

}  // namespace breve::steve
