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

/// A line breaks where there is no number. Of many points only as many are drawn as there are pixels.
void add_line(const ScenePlot::Line& line, const Range& range, const Area& area, std::vector<SceneLine>& to) {
  const auto points = static_cast<float>(std::max<std::size_t>(range.points, 2) - 1);
  const std::size_t step = 1 + line.values.size() / static_cast<std::size_t>(std::max(1.0F, area.right - area.left));
  const auto at = [&](std::size_t i) {
    const float up = (static_cast<float>(line.values[i]) - range.low) / (range.high - range.low);
    return Vector3f(area.left + static_cast<float>(i) / points * (area.right - area.left),
                    area.bottom - up * (area.bottom - area.top), 0);
  };
  Vector4f color(0, 0, 0, 1);
  color.head<3>() = line.color;
  for (std::size_t i = step; i < line.values.size(); i += step)
    if (std::isfinite(static_cast<float>(line.values[i - step])) && std::isfinite(static_cast<float>(line.values[i])))
      to.push_back({at(i - step), at(i), color, 2});
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

/// From the lower right corner up.
void Marks::draw_plots(const Shaders& shaders, const Scene& scene, const Canvas& canvas) {
  if (scene.plots.empty()) return;
  // A part of the picture; of a small one most of it, or nothing could be read.
  const auto side = [](int picture, float part, float least) {
    return std::max(part * static_cast<float>(picture), std::min(least, static_cast<float>(picture) - 2 * kGap));
  };
  const float width = side(canvas.width, 0.42F, 240), height = side(canvas.height, 0.36F, 130);
  const int size = std::clamp(canvas.height / 40, 9, 22);
  const auto em = static_cast<float>(size);
  const Lens lens = pixel_lens(canvas);
  Canvas pixels = canvas;
  pixels.lens = &lens;
  std::vector<Row> plates, letters;
  std::vector<SceneLine> lines;
  float bottom = static_cast<float>(canvas.height) - kGap;
  for (const ScenePlot& plot : scene.plots) {
    const float left = static_cast<float>(canvas.width) - kGap - width, top = bottom - height;
    if (top < 0) break;
    plates.push_back({{left, top, width, height}, Vector4f::Zero(), kPlate});
    const Range range = range_of(plot);
    const Area area{left + 5 * em, top + 2.2F * em, left + width - em, bottom - 2.6F * em};
    add_words(plot.title, size, (left + left + width) / 2, top + 1.4F * em, 0.5F, letters);
    add_words(plot.y_axis, size, left + 0.6F * em, area.top - 0.4F * em, 0, letters);
    add_words(plot.x_axis, size, (area.left + area.right) / 2, bottom - 0.7F * em, 0.5F, letters);
    add_words(fmt::format("{:.3g}", range.high), size, area.left - 0.4F * em, area.top + 0.8F * em, 1, letters);
    add_words(fmt::format("{:.3g}", range.low), size, area.left - 0.4F * em, area.bottom, 1, letters);
    add_words("0", size, area.left, area.bottom + 1.2F * em, 0, letters);
    add_words(fmt::format("{}", range.points), size, area.right, area.bottom + 1.2F * em, 1, letters);
    lines.push_back({{area.left, area.top, 0}, {area.left, area.bottom, 0}, kAxis, 1});
    lines.push_back({{area.left, area.bottom, 0}, {area.right, area.bottom, 0}, kAxis, 1});
    for (const ScenePlot::Line& line : plot.lines) add_line(line, range, area, lines);
    bottom = top - kGap;
  }
  draw_rows(shaders, plates, pixels);
  draw_lines(shaders, lines, pixels);
  draw_rows(shaders, letters, pixels);
}

}  // namespace breve::render
