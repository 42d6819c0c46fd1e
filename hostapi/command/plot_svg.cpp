// Lines in SVG.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "plot_layout.hpp"

namespace breve::command {

using namespace layout;

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
    else
      out += c;
  }
  return out;
}

std::string axes(const Range& x, const Range& y, const std::string& x_axis) {
  std::string svg;
  const auto across = axis_marks(x.low, x.high, 8), along = axis_marks(y.low, y.high, 6);
  for (const double mark : along) {
    const double at = y_at(y, mark);
    svg += fmt::format("<line x1='{}' x2='{}' y1='{:.1f}' y2='{:.1f}' stroke='#e3e6ea'/>\n", kLeft, kWidth - kRight, at,
                       at);
    svg += fmt::format("<text x='{}' y='{:.1f}' text-anchor='end' class='m'>{}</text>\n", kLeft - 10, at + 6,
                       mark_text(mark, along.size() > 1 ? along[1] - along[0] : 1));
  }
  for (const double mark : across) {
    const double at = x_at(x, mark);
    svg += fmt::format("<line x1='{0:.1f}' x2='{0:.1f}' y1='{1}' y2='{2}' stroke='#9aa3ad'/>\n", at, kHeight - kBottom,
                       kHeight - kBottom + 6);
    svg += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle' class='m'>{}</text>\n", at, kHeight - kBottom + 26,
                       mark_text(mark, across.size() > 1 ? across[1] - across[0] : 1));
  }
  svg += fmt::format("<line x1='{0}' x2='{1}' y1='{2}' y2='{2}' stroke='#9aa3ad'/>\n", kLeft, kWidth - kRight,
                     kHeight - kBottom);
  svg += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{}</text>\n", (kLeft + kWidth - kRight) / 2,
                     kHeight - 18, escaped(x_axis));
  return svg;
}

/// A line that breaks where there is no number.
std::string line(const Series& series, std::size_t column, const Range& x, const Range& y) {
  std::string path;
  bool drawing = false;
  const std::size_t rows = series.times.size(), step = rows / kMostPoints + 1;
  for (std::size_t row = 0; row < rows; row += step) {
    const double number = series.columns[column][row];
    if (std::isfinite(number))
      path += fmt::format("{}{:.1f},{:.1f} ", drawing ? "L" : "M", x_at(x, series.times[row]), y_at(y, number));
    drawing = std::isfinite(number);
  }
  return fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='2.6' stroke-linejoin='round'/>\n", path,
                     kInks[column % kInks.size()]);
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

std::string series_svg(const Series& series, const std::string& x_axis, const std::string& title) {
  const auto [x, y] = ranges_of(series);
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0} {1}' width='{0}' height='{1}' "
      "font-family='DejaVu Sans, Helvetica, Arial, sans-serif' font-size='19' fill='#2b3138'>\n"
      "<style>.m{{font-size:17px;fill:#5b6570}}</style>\n<title>{2}</title>\n"
      "<rect width='{0}' height='{1}' fill='#ffffff'/>\n",
      kWidth, kHeight, escaped(title));
  svg += axes(x, y, x_axis);
  double next_label = kLeft;
  for (std::size_t i = 0; i < series.columns.size(); ++i) {
    svg += line(series, i, x, y);
    svg +=
        fmt::format("<rect x='{0}' y='26' width='26' height='5' rx='2.5' fill='{1}'/><text x='{2}' y='35'>{3}</text>\n",
                    next_label, kInks[i % kInks.size()], next_label + 34, escaped(series.names[i]));
    next_label += 64 + 11.5 * static_cast<double>(series.names[i].size());
  }
  return svg + "</svg>\n";
}

}  // namespace breve::command
