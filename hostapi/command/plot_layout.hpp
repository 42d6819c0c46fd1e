// Where the parts of a plot are, in SVG and in PNG. Colours are those of Okabe and Ito (2008), which people of all
// kinds of vision tell apart.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "plot.hpp"

namespace breve::command::layout {

// Units of SVG, and pixels.
inline constexpr double kWidth = 900, kHeight = 520, kLeft = 92, kRight = 24, kTop = 64, kBottom = 74;
inline constexpr std::array<std::string_view, 7> kInks{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                       "#e69f00", "#56b4e9", "#333333"};
inline constexpr std::size_t kMostPoints = 2000;  // of a line: more are not seen

struct Range {
  double low = 0, high = 1;
  bool any = false;
  void take(double number) {
    if (!std::isfinite(number)) return;
    low = any ? std::min(low, number) : number;
    high = any ? std::max(high, number) : number;
    any = true;
  }
  void widen() {
    if (high > low) return;
    const double half = std::max(std::abs(low) * 0.05, 1e-9);
    low -= half;
    high += half;
  }
  double part(double number) const { return (number - low) / (high - low); }
};

inline double x_at(const Range& x, double number) { return kLeft + x.part(number) * (kWidth - kLeft - kRight); }
inline double y_at(const Range& y, double number) {
  return kHeight - kBottom - y.part(number) * (kHeight - kTop - kBottom);
}

inline std::string mark_text(double mark, double step) {
  return std::abs(mark) < step * 1e-6 ? "0" : fmt::format("{:.6g}", mark);
}

/// What the axes show: all times and all numbers.
inline std::pair<Range, Range> ranges_of(const Series& series) {
  Range x, y;
  for (const double time : series.times) x.take(time);
  for (const auto& column : series.columns)
    for (const double number : column) y.take(number);
  x.widen();
  y.widen();
  return {x, y};
}

}  // namespace breve::command::layout
