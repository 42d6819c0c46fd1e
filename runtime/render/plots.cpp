// Plots over the picture: a plate with a title, two axes with their ends and names, and a line for each series.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/render/marks.hpp"

namespace breve::render {

namespace {

const Vector4f kPlate(0.07F, 0.09F, 0.12F, 0.80F), kInk(0.92F, 0.94F, 0.96F, 1), kAxis(0.55F, 0.60F, 0.66F, 1);
constexpr float kGap = 8;  // pixels about a plot

struct Area {
  float left, top, right, bottom;
};

struct Range {
  float low = 0, high = 0;
  std::size_t points = 0;  // of the longest line
};

Range range_of(const ScenePlot& plot) {
  Range range;
  bool any = false;
  for (const ScenePlot::Line& line : plot.lines) {
    range.points = std::max(range.points, line.values.size());
    for (const double number : line.values) {
      const auto value = static_cast<float>(number);
      if (!std::isfinite(value)) continue;
      range.low = any ? std::min(range.low, value) : value;
      range.high = any ? std::max(range.high, value) : value;
      any = true;
    }
  }
  const float least = std::max(1e-6F, 1e-4F * std::abs(range.high));
  if (range.high - range.low < least) {
    range.low -= least;
    range.high += least;
  }
  return range;
}

/// A line breaks where there is no number.
void add_line(const ScenePlot::Line& line, const Range& range, const Area& area, std::vector<SceneLine>& to) {
  const auto points = static_cast<float>(std::max<std::size_t>(range.points, 2) - 1);
  const auto at = [&](std::size_t i) {
    const float up = (static_cast<float>(line.values[i]) - range.low) / (range.high - range.low);
    return Vector3f(area.left + static_cast<float>(i) / points * (area.right - area.left),
                    area.bottom - up * (area.bottom - area.top), 0);
  };
  Vector4f color(0, 0, 0, 1);
  color.head<3>() = line.color;
  const auto columns = static_cast<std::size_t>(std::max(1.0F, area.right - area.left));
  const std::vector<std::size_t> drawn = points_to_draw(line.values, line.values.size(), columns);
  for (std::size_t k = 1; k < drawn.size(); ++k) {
    const std::size_t i = drawn[k - 1], next = drawn[k];
    if (std::isfinite(static_cast<float>(line.values[i])) && std::isfinite(static_cast<float>(line.values[next])))
      to.push_back({at(i), at(next), color, 2});
  }
}

}  // namespace

Lens pixel_lens(const Canvas& canvas) {
  Lens lens;
  lens.orthographic = true;
  lens.projection(0, 0) = 2 / static_cast<float>(canvas.width);
  lens.projection(1, 1) = -2 / static_cast<float>(canvas.height);
  lens.projection(0, 3) = -1;
  lens.projection(1, 3) = 1;
  return lens;
}

/// @param align  0: from x on, 0.5: about x, 1: up to x
void Marks::add_words(const std::string& words, int size, float x, float y, float align, std::vector<Row>& rows) {
  std::vector<Letter> letters;
  const float width = font_.lay(words, size, 0, 0, letters);
  for (const Letter& one : letters)
    rows.push_back({{one.x + std::round(x - align * width), one.y + std::round(y), one.width, one.height},
                    {one.from_x, one.from_y, one.from_width, one.from_height},
                    kInk});
}

void Marks::add_plot(const ScenePlot& plot, const PlotCell& cell, PlotParts& parts) {
  const int size = cell.letters;
  const auto em = static_cast<float>(size);
  const float left = cell.left, top = cell.top, right = left + cell.width, bottom = top + cell.height;
  parts.plates.push_back({{left, top, cell.width, cell.height}, Vector4f::Zero(), kPlate});
  const Range range = range_of(plot);
  const Area area{left + 5 * em, top + 2.2F * em, right - em, bottom - 2.6F * em};
  const auto words = [&](const std::string& text, float x, float y, float align) {
    add_words(text, size, x, y, align, parts.letters);
  };
  words(plot.title, (left + right) / 2, top + 1.4F * em, 0.5F);
  words(plot.y_axis, left + 0.6F * em, area.top - 0.4F * em, 0);
  words(plot.x_axis, (area.left + area.right) / 2, bottom - 0.7F * em, 0.5F);
  words(fmt::format("{:.3g}", range.high), area.left - 0.4F * em, area.top + 0.8F * em, 1);
  words(fmt::format("{:.3g}", range.low), area.left - 0.4F * em, area.bottom, 1);
  words("0", area.left, area.bottom + 1.2F * em, 0);
  if (range.points > 1) words(fmt::format("{}", range.points - 1), area.right, area.bottom + 1.2F * em, 1);
  parts.lines.push_back({{area.left, area.top, 0}, {area.left, area.bottom, 0}, kAxis, 1});
  parts.lines.push_back({{area.left, area.bottom, 0}, {area.right, area.bottom, 0}, kAxis, 1});
  for (const ScenePlot::Line& line : plot.lines) add_line(line, range, area, parts.lines);
}

namespace {

/// What it takes to look at all values of a plot, twice.
std::uint64_t units_of(const ScenePlot& plot) {
  constexpr std::uint64_t kValues = 32, kOfLine = 4;  // values that take one unit; units of a line
  std::uint64_t units = kOfLine * plot.lines.size();
  for (const ScenePlot::Line& line : plot.lines) units += line.values.size() / kValues;
  return units;
}

}  // namespace

/// From the lower right corner up, then in the column to the left. Where there is no room for all they are smaller.
void Marks::draw_plots(const Shaders& shaders, const Scene& scene, const Canvas& canvas) {
  if (scene.plots.empty()) return;
  const auto picture_width = static_cast<float>(canvas.width), picture_height = static_cast<float>(canvas.height);
  // A part of the picture; of a small one most of it, or nothing could be read.
  const auto side = [](float picture, float part, float least) {
    return std::max(part * picture, std::min(least, picture - 2 * kGap));
  };
  const float usual_width = side(picture_width, 0.42F, 240), usual_height = side(picture_height, 0.36F, 130);
  const auto fits = [](float picture, float one) {
    return static_cast<std::size_t>(std::max(1.0F, (picture - kGap) / (one + kGap)));
  };
  std::size_t columns = fits(picture_width, usual_width), rows = fits(picture_height, usual_height);
  // One more where a plot then stays larger.
  while (columns * rows < scene.plots.size())
    ++(picture_width / usual_width * static_cast<float>(rows + 1) <
               picture_height / usual_height * static_cast<float>(columns + 1)
           ? rows
           : columns);
  const auto shrunk = [](float picture, float usual, std::size_t count) {
    const float share = (picture - kGap) / static_cast<float>(count);
    return std::max(1.0F, std::min(usual, share - std::min(kGap, 0.2F * share)));
  };
  const float width = shrunk(picture_width, usual_width, columns), height = shrunk(picture_height, usual_height, rows);
  const float smaller = std::min(width / usual_width, height / usual_height);
  const int size = std::max(4, static_cast<int>(smaller * static_cast<float>(std::clamp(canvas.height / 40, 9, 22))));
  const Lens lens = pixel_lens(canvas);
  Canvas pixels = canvas;
  pixels.lens = &lens;
  pixels.fog = nullptr;
  PlotParts parts;
  for (std::size_t i = 0; i < scene.plots.size(); ++i) {
    const std::size_t column = i / rows, row = i % rows;
    if (canvas.meter) canvas.meter(units_of(scene.plots[i]));
    const float gap_across = std::min(kGap, 0.25F * width), gap_down = std::min(kGap, 0.25F * height);
    add_plot(scene.plots[i],
             {picture_width - kGap - width - static_cast<float>(column) * (width + gap_across),
              picture_height - kGap - height - static_cast<float>(row) * (height + gap_down), width, height, size},
             parts);
  }
  draw_rows(shaders, parts.plates, pixels);
  draw_lines(shaders, parts.lines, pixels);
  draw_rows(shaders, parts.letters, pixels);
}

}  // namespace breve::render
