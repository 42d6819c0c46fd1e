// Reading numbers from text, and writing them.
#include "steve/code/numbers.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

namespace breve::steve {

namespace {

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  return text;
}

/// Whether a number that no double can hold is too large, and not too small. The C library would know, but it expects
/// the decimal point of the host's locale.
bool is_above_one(std::string_view text, std::chars_format format) {
  const bool hex = format == std::chars_format::hex;
  std::int64_t before = 0;  // digits between the first one that is not zero and the point; less than 0 behind it
  bool point = false, begun = false;
  std::size_t i = 0;
  for (; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '.') {
      if (std::exchange(point, true)) break;
      continue;
    }
    if (hex ? std::isxdigit(static_cast<unsigned char>(c)) == 0 : c < '0' || c > '9') break;
    begun = begun || c != '0';
    if (begun && !point) ++before;
    if (!begun && point) --before;
  }
  std::int64_t exponent = 0;
  if (i < text.size() && std::string_view(hex ? "pP" : "eE").find(text[i]) != std::string_view::npos) {
    text.remove_prefix(i + 1);
    const bool negative = !text.empty() && text.front() == '-';
    if (!text.empty() && (text.front() == '+' || negative)) text.remove_prefix(1);
    std::from_chars_result read = std::from_chars(text.data(), text.data() + text.size(), exponent);
    if (read.ec == std::errc::result_out_of_range) exponent = std::numeric_limits<std::int32_t>::max();
    if (negative) exponent = -exponent;
  }
  constexpr std::int64_t kBitsOfDigit = 4;
  return (hex ? kBitsOfDigit * before : before) + exponent > 0;
}

// Six decimals are off by half a millionth at most: that is too much of a number below this, unless it is a round one.
constexpr double kSmall = 1e-3;

}  // namespace

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
    d = is_above_one(text, format) ? std::numeric_limits<double>::infinity() : 0.0;
  } else if (result.ec != std::errc()) {
    return 0.0;
  }
  return negative ? -d : d;
}

char* write_double(char* begin, char* end, double d) {
  char* last = std::to_chars(begin, end, d, std::chars_format::fixed, 6).ptr;
  if (d == 0 || !(std::abs(d) < kSmall)) return last;
  double shown = 0;
  std::from_chars(begin, last, shown);
  return shown == d ? last : std::to_chars(begin, end, d).ptr;
}

void append_int(std::string& out, std::int32_t i) {
  char buffer[16];
  out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, i).ptr);
}

void append_double(std::string& out, double d) {
  char buffer[kLongestDouble];
  out.append(buffer, write_double(buffer, buffer + sizeof buffer, d));
}

}  // namespace breve::steve
