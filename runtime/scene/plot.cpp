// Axes and tables of plots.
#include "runtime/scene/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

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

std::vector<std::size_t> points_to_draw(const std::vector<double>& values, std::size_t points, std::size_t columns,
                                        const CostMeter& meter) {
  constexpr std::size_t kOfColumn = 5;
  plot_layout::Counting counting(meter);
  std::vector<std::size_t> chosen;
  points = std::min(points, values.size());
  columns = std::max<std::size_t>(columns, 1);
  const bool all = points <= kOfColumn * columns;
  for (std::size_t column = 0, first = 0; first < points; ++column) {
    const std::size_t end = all ? first + 1 : std::min(points, (column + 1) * points / columns);
    counting.add(plot_layout::kOfValue * static_cast<double>(end - first));
    std::size_t low = first, high = first, gap = first;
    for (std::size_t i = first; i < end; ++i) {
      if (!std::isfinite(values[i])) {
        gap = i;
      } else {
        if (!(values[i] >= values[low])) low = i;
        if (!(values[i] <= values[high])) high = i;
      }
    }
    std::array<std::size_t, kOfColumn> some{first, low, high, gap, end - 1};
    std::sort(some.begin(), some.end());
    for (const std::size_t i : some)
      if (chosen.empty() || chosen.back() != i) chosen.push_back(i);
    first = end;
  }
  return chosen;
}

std::string plot_csv(const ScenePlot& plot, const CostMeter& meter) {
  plot_layout::Counting counting(meter);
  std::string text = plot.x_axis.empty() ? "x" : quoted(plot.x_axis);
  std::size_t rows = plot.xs.size();
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    const std::string& name = plot.lines[i].name;
    counting.add(plot_layout::kOfCell);
    text += ',' + (name.empty() ? fmt::format("line {}", i) : quoted(name));
    if (plot.xs.empty()) rows = std::max(rows, plot.lines[i].values.size());
  }
  text += '\n';
  for (std::size_t row = 0; row < rows; ++row) {
    text += fmt::format("{}", plot_layout::x_of(plot, row));
    for (const ScenePlot::Line& line : plot.lines) {
      counting.add(plot_layout::kOfCell);
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

/// Not more than so many bytes of a name in UTF-8: none of its characters is cut in two.
std::string shortened(const std::string& name, std::size_t most) {
  while (most > 0 && (static_cast<unsigned char>(name[most]) & 0xC0U) == 0x80U) --most;
  return name.substr(0, most);
}

}  // namespace

Axis x_axis_of(const ScenePlot& plot) {
  Range range;
  std::size_t points = 0;
  for (const ScenePlot::Line& line : plot.lines) points = std::max(points, points_of(plot, line));
  if (!plot.xs.empty()) {
    for (std::size_t i = 0; i < points; ++i) range.take(plot.xs[i]);
  } else if (points > 0) {
    range.take(0);
    range.take(static_cast<double>(points - 1));
  }
  return axis_of(range, 8);
}

Axis y_axis_of(const ScenePlot& plot, const CostMeter& meter) {
  Range range;
  Counting counting(meter);
  for (const ScenePlot::Line& line : plot.lines)
    for (const double value : line.values) {
      counting.add(kOfValue);
      range.take(value);
    }
  return axis_of(range, 6);
}

Key key_of(const ScenePlot& plot) {
  constexpr double kLetter = 11.5, kRoom = 64;  // about how wide a letter is, and what stands before and after a name
  constexpr auto kMost = static_cast<std::size_t>((kWidth - kLeft - kRight - kRoom) / kLetter);
  Key key;
  double x = kLeft;
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    std::string name = plot.lines[i].name;
    if (name.empty()) continue;
    if (name.size() > kMost) name = shortened(name, kMost - 3) + "...";
    const double width = kRoom + kLetter * static_cast<double>(name.size());
    if (x > kLeft && x + width - kRoom / 2 > kWidth - kRight) {
      x = kLeft;
      key.height += kKeyRow;
    }
    key.entries.push_back({x, key.height, i, std::move(name)});
    x += width;
  }
  return key;
}

}  // namespace plot_layout
}  // namespace breve
