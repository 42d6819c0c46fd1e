// Numbers to numbers, out of text and to text: the same when a program is compiled and when it runs.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace breve::steve {

/// double to int: toward 0; beyond the range of int the nearest int; NaN gives 0.
inline std::int32_t truncate_to_int(double d) {
  if (d > -2147483649.0 && d < 2147483648.0) return static_cast<std::int32_t>(d);
  if (std::isnan(d)) return 0;
  return d < 0 ? std::numeric_limits<std::int32_t>::min() : std::numeric_limits<std::int32_t>::max();
}
std::int32_t leading_int(std::string_view text);  // 0 if there is none; the nearest int if it is out of range
double leading_double(std::string_view text);     // C rules without locale; 0.0 if there is none

inline constexpr std::size_t kLongestDouble = 330;  // 309 digits, sign, point, six decimals
/// As printf's %f; a small number that six decimals would show as another one is the shortest text that reads back.
/// @param begin  room for kLongestDouble characters
/// @return       the end of the text
char* write_double(char* begin, char* end, double d);
void append_double(std::string& out, double d);
void append_int(std::string& out, std::int32_t i);

}  // namespace breve::steve
