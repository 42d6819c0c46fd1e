// Where the parts of a plot are, in SVG and in pixels.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "runtime/scene/plot.hpp"

namespace breve::plot_layout {

// Units of SVG, and pixels.
inline constexpr double kWidth = 900, kHeight = 520, kLeft = 92, kRight = 24, kTop = 64, kBottom = 74;
inline constexpr double kKey = 35, kXAxis = kHeight - 18, kYAxis = kTop - 12;  // baselines of texts
inline constexpr double kKeyRow = 26;                                          // of the key at the top
inline constexpr std::size_t kColumns = 800;                                   // of pixels in which lines are drawn

// Units of CostMeter.
inline constexpr double kOfCell = 1, kOfPoint = 2, kOfValue = 0.05, kOfPixel = 0.03, kOfLetter = 0.2;

/// Adds up small pieces of work for a meter.
class Counting {
 public:
  explicit Counting(const CostMeter& meter) : meter_(meter) {}
  void add(double units) {
    due_ += units;
    if (due_ >= kOften) tell();
  }

 private:
  static constexpr double kOften = 1000;
  void tell() {
    if (meter_) meter_(static_cast<std::uint64_t>(due_));
    due_ = 0;
  }

  const CostMeter& meter_;
  double due_ = 0;
};

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
    // So far apart that their difference is not a number, or so near that there is none.
    low = std::clamp(low, -1e300, 1e300);
    high = std::clamp(high, -1e300, 1e300);
    const double half = std::max({std::abs(low), std::abs(high), 1e-8}) * 1e-9;
    if (high - low > half) return;
    const double wide = std::max(std::abs(low) * 0.05, 1e-9);
    low -= wide;
    high += wide;
  }
  double part(double number) const { return (std::clamp(number, low, high) - low) / (high - low); }
};

inline double x_at(const Range& x, double number) { return kLeft + x.part(number) * (kWidth - kLeft - kRight); }
inline double y_at(const Range& y, double number) {
  return kHeight - kBottom - y.part(number) * (kHeight - kTop - kBottom);
}

/// An axis: what it shows, and its marks with their texts.
struct Axis {
  struct Mark {
    double at;
    std::string text;
  };
  Range range;
  std::vector<Mark> marks;
};
Axis x_axis_of(const ScenePlot& plot);
Axis y_axis_of(const ScenePlot& plot, const CostMeter& meter);

/// Where point `i` of a line is along x: its number if the plot says nothing else.
inline double x_of(const ScenePlot& plot, std::size_t i) {
  return plot.xs.empty() ? static_cast<double>(i) : plot.xs[i];
}
/// The number of points of a line that have a place.
inline std::size_t points_of(const ScenePlot& plot, const ScenePlot::Line& line) {
  return plot.xs.empty() ? line.values.size() : std::min(line.values.size(), plot.xs.size());
}

/// Whether point `i` of a line is a point: both of its numbers are.
inline bool is_point(const ScenePlot& plot, const ScenePlot::Line& line, std::size_t i) {
  return std::isfinite(line.values[i]) && std::isfinite(x_of(plot, i));
}

/// A line's name in the key at the top, and where it stands. Without names the title stands there.
struct KeyEntry {
  double x, below;  // below: the first row
  std::size_t line;
  std::string name;  // as far as there is room
};
struct Key {
  std::vector<KeyEntry> entries;
  double height = 0;  // of the rows but the first: all else is as far below
};
Key key_of(const ScenePlot& plot);

}  // namespace breve::plot_layout
