// Axes and tables of plots.
#include "runtime/scene/plot.hpp"

#include <fmt/format.h>

#include "runtime/scene/plot_layout.hpp"

namespace breve {

namespace {

std::string quoted(const std::string& name) {
  if (name.find_first_of(",\"\n\r") == std::string::npos) return name;
  std::string cell = "\"";
  for (const char c : name) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + '"';
}

}  // namespace

std::vector<double> axis_marks(double low, double high, int count) {
  if (!(high > low) || count < 1) return {low};
  const double rough = (high - low) / count, power = std::pow(10, std::floor(std::log10(rough)));
  const double of = rough / power;
  const double step = power * (of < 1.5 ? 1 : of < 3.5 ? 2 : of < 7.5 ? 5 : 10);
  std::vector<double> marks;
  for (double i = std::ceil(low / step - 1e-9); i * step <= high + step * 1e-9; ++i) marks.push_back(i * step);
  return marks;
}

std::string plot_csv(const ScenePlot& plot) {
  std::string text = plot.x_axis.empty() ? "x" : quoted(plot.x_axis);
  std::size_t rows = plot.xs.size();
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    const std::string& name = plot.lines[i].name;
    text += ',' + (name.empty() ? fmt::format("line {}", i) : quoted(name));
    if (plot.xs.empty()) rows = std::max(rows, plot.lines[i].values.size());
  }
  text += '\n';
  for (std::size_t row = 0; row < rows; ++row) {
    text += fmt::format("{}", plot_layout::x_of(plot, row));
    for (const ScenePlot::Line& line : plot.lines) {
      const bool number = row < line.values.size() && !std::isnan(line.values[row]);
      text += number ? fmt::format(",{}", line.values[row]) : ",";
    }
    text += '\n';
  }
  return text;
}

namespace plot_layout {

namespace {

Axis axis_of(Range range, int count) {
  range.widen();
  Axis axis{range, {}};
  const std::vector<double> marks = axis_marks(range.low, range.high, count);
  const double step = marks.size() > 1 ? marks[1] - marks[0] : 1;
  for (const double mark : marks)
    axis.marks.push_back({mark, std::abs(mark) < step * 1e-6 ? "0" : fmt::format("{:.6g}", mark)});
  return axis;
}

}  // namespace

Axis x_axis_of(const ScenePlot& plot) {
  Range range;
  for (const ScenePlot::Line& line : plot.lines)
    for (std::size_t i = 0; i < points_of(plot, line); ++i) range.take(x_of(plot, i));
  return axis_of(range, 8);
}

Axis y_axis_of(const ScenePlot& plot) {
  Range range;
  for (const ScenePlot::Line& line : plot.lines)
    for (const double value : line.values) range.take(value);
  return axis_of(range, 6);
}

std::vector<KeyEntry> key_of(const ScenePlot& plot) {
  std::vector<KeyEntry> key;
  double x = kLeft;
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    if (plot.lines[i].name.empty()) continue;
    key.push_back({x, i});
    x += 64 + 11.5 * static_cast<double>(plot.lines[i].name.size());
  }
  return key;
}

}  // namespace plot_layout
}  // namespace breve
