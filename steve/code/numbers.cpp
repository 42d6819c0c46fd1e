// Reading numbers from text, and writing them.
#include "steve/code/numbers.hpp"

#include <cctype>
#include <charconv>
#include <cstdlib>

namespace breve::steve {

namespace {

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  return text;
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
    // Too large or too small: the C library knows which, and the decimal point of its locale does not matter for that.
    d = std::strtod(std::string(format == std::chars_format::hex ? "0x" : "").append(text).c_str(), nullptr);
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
