// Conversion on assignment, truth, and reading numbers from strings.
#include <cctype>
#include <charconv>
#include <cstdlib>

#include <fmt/format.h>

#include "steve/machine/brief.hpp"
#include "steve/machine/operators.hpp"

namespace breve::steve {

namespace {

std::string help_for(const Value& v, std::string_view to) {
  if (v.tag == Tag::Null) return "a method returns a value with 'return'; a missing key of a hash gives no value";
  if (v.tag == Tag::Vector && (to == "an int" || to == "a double"))
    return "use its length, |v|, or one of its components: v::x, v::y, v::z";
  if (to == "a vector") return "a vector is written (x, y, z)";
  if (to == "a list" && v.tag == Tag::Hash) return "for a list of the keys of a hash write keys(hash)";
  if (to == "a list") return "a list is written { a, b, c }; a counting loop: for n = 0, n < 10, n++: ...";
  if (to == "an object" && v.tag == Tag::Int) return "the only number allowed here is 0, which means no object";
  if (to == "an object")
    return "the value of a call is what its method returns: to return the object itself, end the method with 'return "
           "self.'";
  return {};
}

[[noreturn]] void fail_conversion(const Value& v, std::string_view to, std::string_view what) {
  const std::string value = typed_brief(v);
  const std::string message = what.empty() ? fmt::format("{} is needed here, not {}", to, value)
                                           : fmt::format("{} must be {}, not {}", what, to, value);
  throw RunError(RunErrorKind::Conversion, message, help_for(v, to));
}

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  return text;
}

}  // namespace

std::string a_type(Tag tag) {
  if (tag == Tag::Null) return "no value (NULL)";
  const bool vowel = tag == Tag::Int || tag == Tag::Object;
  return std::string(tag == Tag::Data ? "" : vowel ? "an " : "a ").append(type_name(tag));
}

std::int32_t leading_int(std::string_view text) {
  text = without_blanks(text);
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (!text.empty() && text.front() == '-') return 0;
  }
  std::int32_t i = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), i);
  if (result.ec == std::errc::result_out_of_range)
    return text.front() == '-' ? std::numeric_limits<std::int32_t>::min() : std::numeric_limits<std::int32_t>::max();
  return i;
}

double leading_double(std::string_view text) {
  text = without_blanks(text);
  bool negative = false;
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) {
    negative = text.front() == '-';
    text.remove_prefix(1);
  }
  if (text.empty() || text.front() == '-') return 0.0;
  auto format = std::chars_format::general;
  if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) {
    const char digit = text[2] == '.' && text.size() > 3 ? text[3] : text[2];
    if (std::isxdigit(static_cast<unsigned char>(digit)) != 0) {
      text.remove_prefix(2);
      format = std::chars_format::hex;
    }
  }
  double d = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), d, format);
  if (result.ec == std::errc::result_out_of_range) {
    // Too large or too small: the C library knows which, and the decimal point of its locale does not matter for that.
    d = std::strtod(std::string(format == std::chars_format::hex ? "0x" : "").append(text).c_str(), nullptr);
  } else if (result.ec != std::errc()) {
    return 0.0;
  }
  return negative ? -d : d;
}

std::int32_t to_int(const Value& v, std::string_view what) {
  switch (v.tag) {
    case Tag::Int: return v.i;
    case Tag::Double: return truncate_to_int(v.d);
    case Tag::String: return leading_int(view(v.string()));
    case Tag::List: return v.list() != nullptr ? static_cast<std::int32_t>(v.list()->size) : 0;
    default: fail_conversion(v, "an int", what);
  }
}

double to_double(const Value& v, std::string_view what) {
  switch (v.tag) {
    case Tag::Int: return v.i;
    case Tag::Double: return v.d;
    case Tag::String: return leading_double(view(v.string()));
    case Tag::List: return v.list() != nullptr ? static_cast<double>(v.list()->size) : 0.0;
    default: fail_conversion(v, "a double", what);
  }
}

Vector3 to_vector(const Value& v, std::string_view what) {
  if (v.tag != Tag::Vector) fail_conversion(v, "a vector", what);
  return v.vector();
}

Matrix3 to_matrix(const Value& v, std::string_view what) {
  if (v.tag != Tag::Matrix) fail_conversion(v, "a matrix", what);
  return v.matrix() != nullptr ? v.matrix()->m : Matrix3::Zero();
}

StringCell* to_string(Heap& heap, const Value& v, std::string_view) {
  switch (v.tag) {
    case Tag::String: return v.string();
    case Tag::Int: return number_to_string(heap, v.i);
    case Tag::Double: return number_to_string(heap, v.d);
    default: return heap.string(text(v, {}, &heap));
  }
}

Instance* to_object(const Value& v, std::string_view what) {
  if (v.tag == Tag::Object) return v.object();
  if ((v.tag == Tag::Int && v.i == 0) || (v.tag == Tag::Double && v.d == 0)) return nullptr;
  fail_conversion(v, "an object", what);
}

ListCell* to_list(const Value& v, std::string_view what) {
  if (v.tag != Tag::List) fail_conversion(v, "a list", what);
  return v.list();
}

HashCell* to_hash(const Value& v, std::string_view what) {
  if (v.tag != Tag::Hash) fail_conversion(v, "a hash", what);
  return v.hash();
}

PointerCell* to_pointer(const Value& v, std::string_view what) {
  if (v.tag == Tag::Pointer) return v.pointer();
  if (v.tag == Tag::Int && v.i == 0) return nullptr;
  fail_conversion(v, "a pointer", what);
}

DataCell* to_data(const Value& v, std::string_view what) {
  if (v.tag != Tag::Data) fail_conversion(v, "data", what);
  return v.data();
}

bool truth(const Value& v) {
  switch (v.tag) {
    case Tag::Null: return false;
    case Tag::Int: return v.i != 0;
    case Tag::Double: return v.d != 0;
    case Tag::Vector: return v.v[0] != 0 || v.v[1] != 0 || v.v[2] != 0;
    case Tag::Matrix: {
      if (v.matrix() == nullptr) return false;
      const double* m = v.matrix()->m.data();
      for (int i = 0; i < 9; ++i)
        if (m[i] != 0) return true;
      return false;
    }
    case Tag::Object: return v.object() != nullptr && v.object()->live();
    case Tag::List: return v.list() != nullptr && v.list()->size != 0;
    case Tag::Hash: return true;
    case Tag::String:
    case Tag::Pointer:
    case Tag::Data: return v.ref != nullptr;
  }
  return false;
}

}  // namespace breve::steve
