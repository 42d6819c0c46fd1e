// Plots in SVG.
#include <fmt/format.h>

#include <string_view>

#include "runtime/scene/plot_layout.hpp"

namespace breve {

using namespace plot_layout;

namespace {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '&')
      out += "&amp;";
    else if (c == '>')
      out += "&gt;";
    else if (static_cast<unsigned char>(c) >= 0x20)
      out += c;
  }
  return out;
}

std::string ink_of(const ScenePlot::Line& line) {
  const auto byte = [&](int part) { return std::lround(255 * std::clamp(line.color[part], 0.0F, 1.0F)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(0), byte(1), byte(2));
}

std::string axes(const ScenePlot& plot, const Axis& x, const Axis& y) {
  std::string svg;
  for (const auto& [mark, text] : y.marks) {
    const double at = y_at(y.range, mark);
    svg += fmt::format("<line x1='{}' x2='{}' y1='{:.1f}' y2='{:.1f}' stroke='#e3e6ea'/>\n", kLeft, kWidth - kRight, at,
                       at);
    svg += fmt::format("<text x='{}' y='{:.1f}' text-anchor='end' class='m'>{}</text>\n", kLeft - 10, at + 6, text);
  }
  for (const auto& [mark, text] : x.marks) {
    const double at = x_at(x.range, mark);
    svg += fmt::format("<line x1='{0:.1f}' x2='{0:.1f}' y1='{1}' y2='{2}' stroke='#9aa3ad'/>\n", at, kHeight - kBottom,
                       kHeight - kBottom + 6);
    svg += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle' class='m'>{}</text>\n", at, kHeight - kBottom + 26,
                       text);
  }
  svg += fmt::format("<line x1='{0}' x2='{1}' y1='{2}' y2='{2}' stroke='#9aa3ad'/>\n", kLeft, kWidth - kRight,
                     kHeight - kBottom);
  svg += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{}</text>\n", (kLeft + kWidth - kRight) / 2, kXAxis,
                     escaped(plot.x_axis));
  if (!plot.y_axis.empty())
    svg += fmt::format("<text x='{}' y='{}' class='m'>{}</text>\n", 14, kYAxis, escaped(plot.y_axis));
  return svg;
}

/// A line that breaks where there is no number.
std::string path_of(const ScenePlot& plot, const ScenePlot::Line& line, const Axis& x, const Axis& y,
                    const CostMeter& meter, Counting& counting) {
  std::string path;
  bool drawing = false;
  counting.add(kOfPoint);
  for (const std::size_t i : points_to_draw(line.values, points_of(plot, line), kColumns, meter)) {
    counting.add(kOfPoint);
    const bool point = is_point(plot, line, i);
    if (point)
      path += fmt::format("{}{:.1f},{:.1f} ", drawing ? "L" : "M", x_at(x.range, x_of(plot, i)),
                          y_at(y.range, line.values[i]));
    drawing = point;
  }
  return fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='2.6' stroke-linejoin='round'/>\n", path,
                     ink_of(line));
}

}  // namespace

std::string plot_svg(const ScenePlot& plot, const CostMeter& meter) {
  Counting counting(meter);
  const Axis x = x_axis_of(plot), y = y_axis_of(plot, meter);
  const Key key = key_of(plot);
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0} {1}' width='{0}' height='{1}' "
      "font-family='DejaVu Sans, Helvetica, Arial, sans-serif' font-size='19' fill='#2b3138'>\n"
      "<style>.m{{font-size:17px;fill:#5b6570}}</style>\n<title>{2}</title>\n"
      "<rect width='{0}' height='{1}' fill='#ffffff'/>\n",
      kWidth, kHeight + key.height, escaped(plot.title));
  if (key.height > 0) svg += fmt::format("<g transform='translate(0,{})'>\n", key.height);
  svg += axes(plot, x, y);
  for (const ScenePlot::Line& line : plot.lines) svg += path_of(plot, line, x, y, meter, counting);
  if (key.height > 0) svg += "</g>\n";
  for (const KeyEntry& entry : key.entries)
    svg += fmt::format(
        "<rect x='{0}' y='{1}' width='26' height='5' rx='2.5' fill='{2}'/><text x='{3}' y='{4}'>{5}</text>\n", entry.x,
        26 + entry.below, ink_of(plot.lines[entry.line]), entry.x + 34, kKey + entry.below, escaped(entry.name));
  if (key.entries.empty())
    svg += fmt::format("<text x='{}' y='{}' text-anchor='middle'>{}</text>\n", (kLeft + kWidth - kRight) / 2, kKey,
                       escaped(plot.title));
  return svg + "</svg>\n";
}

}  // namespace breve
