// Plots: lines of numbers with axes, as data, as a table, and as a picture in SVG.
#pragma once

#include <string>
#include <vector>

#include "runtime/base/cost_meter.hpp"
#include "runtime/base/ids.hpp"
#include "runtime/base/math.hpp"

namespace breve {

struct ScenePlot {
  struct Line {
    Eigen::Vector3f color = Eigen::Vector3f::Zero();
    std::string name;            // "" for none
    std::vector<double> values;  // where one is not finite, the line breaks
  };
  ObjectId object;
  std::string title, x_axis, y_axis;
  std::vector<double> xs;  // of all lines; empty: 0, 1, 2 ...
  std::vector<Line> lines;
};

/// A table with a column for x and one for each line.
std::string plot_csv(const ScenePlot& plot, const CostMeter& meter = {});
/// A picture in SVG, legible at half its size.
std::string plot_svg(const ScenePlot& plot, const CostMeter& meter = {});

/// Which of the first `points` values have to be drawn for a line to look as if all were, in so many columns of pixels:
/// of each column the first, lowest, highest and last, and one that is not finite, where the line breaks. In order.
/// Source: Jugel, Jerzak, Hackenbroich and Markl 2014, "M4: a visualization-oriented time series data aggregation".
std::vector<std::size_t> points_to_draw(const std::vector<double>& values, std::size_t points, std::size_t columns,
                                        const CostMeter& meter = {});

/// Marks of an axis: a step of 1, 2 or 5 times a power of ten, so that there are about `count`.
std::vector<double> axis_marks(double low, double high, int count);

}  // namespace breve
