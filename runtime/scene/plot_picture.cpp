// Lines by their distance from each pixel, letters from the font's image.
#include "runtime/scene/plot_picture.hpp"

#include "runtime/scene/letters.hpp"
#include "runtime/scene/plot_layout.hpp"

namespace breve {

using namespace plot_layout;

namespace {

struct Rgb {
  double red, green, blue;  // 0 to 255
};
constexpr Rgb kFaint{227, 230, 234}, kLine{154, 163, 173}, kSmall{91, 101, 112}, kText{43, 49, 56};

Rgb rgb_of(const Eigen::Vector3f& color) {
  const auto part = [&](int i) { return 255.0 * std::clamp(color[i], 0.0F, 1.0F); };
  return {part(0), part(1), part(2)};
}

class Paper {
 public:
  /// @param shift  added to the height, and to all y until it is set to another
  Paper(double shift, const CostMeter& meter) : shift(shift), counting_(meter) {
    picture_.width = static_cast<int>(kWidth);
    picture_.height = static_cast<int>(kHeight + shift);
    picture_.rgba.assign(
        std::size_t{4} * static_cast<std::size_t>(picture_.width) * static_cast<std::size_t>(picture_.height), 255);
  }
  Picture& picture() { return picture_; }

  /// Pixels are mixed with the ink as far as the line covers them.
  void line(double x0, double y0, double x1, double y1, double width, const Rgb& ink) {
    y0 += shift;
    y1 += shift;
    const double across = x1 - x0, down = y1 - y0;
    const double reach = width / 2 + 0.5, long2 = std::max(1e-9, across * across + down * down);
    const int last_row = std::min(static_cast<int>(std::max(y0, y1) + reach) + 1, picture_.height - 1);
    for (int y = std::max(first(std::min(y0, y1) - reach), 0); y <= last_row; ++y) {
      const double v = y + 0.5 - y0;
      // The part of the line that is near enough to this row.
      double begin = 0, end = 1;
      if (down != 0) {
        const double one = (v - reach) / down, other = (v + reach) / down;
        begin = std::clamp(std::min(one, other), 0.0, 1.0);
        end = std::clamp(std::max(one, other), 0.0, 1.0);
      }
      const double left = x0 + (across < 0 ? end : begin) * across, right = x0 + (across < 0 ? begin : end) * across;
      const int last = std::min(static_cast<int>(right + reach) + 1, picture_.width - 1);
      int x = std::max(first(left - reach), 0);
      counting_.add(kOfPixel * (1 + last - x));
      for (; x <= last; ++x) {
        const double u = x + 0.5 - x0, t = std::clamp((u * across + v * down) / long2, 0.0, 1.0);
        mix(x, y, reach - std::hypot(u - t * across, v - t * down), ink);
      }
    }
  }
  /// @param align  0: from x on, 0.5: about x, 1: up to x
  void text(double x, double y, double align, const Letters& letters, std::string_view words, const Rgb& ink) {
    y += shift;
    counting_.add(kOfLetter * static_cast<double>(words.size()));
    double at = x - align * letters.width_of(words);
    while (!words.empty()) {
      const Letters::Glyph& one = letters.glyph(next_character(words));
      counting_.add(kOfLetter + kOfPixel * one.width * one.height);
      for (int j = 0; j < one.height; ++j)
        for (int i = 0; i < one.width; ++i) {
          const auto from = static_cast<std::size_t>((one.y + j) * Letters::kWidth + one.x + i);
          mix(static_cast<int>(std::lround(at + one.left)) + i, static_cast<int>(std::lround(y + one.top)) + j,
              letters.cover()[from] / 255.0, ink);
        }
      at += one.advance;
    }
  }
  const Letters small{17}, large{19};
  double shift = 0;

 private:
  static int first(double place) { return static_cast<int>(std::floor(place)) - 1; }
  void mix(int x, int y, double cover, const Rgb& ink) {
    if (x < 0 || y < 0 || x >= picture_.width || y >= picture_.height || !(cover > 0)) return;
    std::uint8_t* pixel =
        picture_.rgba.data() +
        4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width) + static_cast<std::size_t>(x));
    const double part = std::min(cover, 1.0), inks[] = {ink.red, ink.green, ink.blue};
    for (int k = 0; k < 3; ++k)
      pixel[k] = static_cast<std::uint8_t>(std::lround(pixel[k] + part * (inks[k] - pixel[k])));
  }

  Picture picture_;
  Counting counting_;
};

void draw_axes(Paper& paper, const ScenePlot& plot, const Axis& x, const Axis& y) {
  for (const auto& [mark, text] : y.marks) {
    const double at = y_at(y.range, mark);
    paper.line(kLeft, at, kWidth - kRight, at, 1, kFaint);
    paper.text(kLeft - 10, at + 6, 1, paper.small, text, kSmall);
  }
  for (const auto& [mark, text] : x.marks) {
    const double at = x_at(x.range, mark);
    paper.line(at, kHeight - kBottom, at, kHeight - kBottom + 6, 1, kLine);
    paper.text(at, kHeight - kBottom + 26, 0.5, paper.small, text, kSmall);
  }
  paper.line(kLeft, kHeight - kBottom, kWidth - kRight, kHeight - kBottom, 1, kLine);
  paper.text((kLeft + kWidth - kRight) / 2, kXAxis, 0.5, paper.large, plot.x_axis, kText);
  paper.text(14, kYAxis, 0, paper.small, plot.y_axis, kSmall);
}

void draw_line(Paper& paper, const ScenePlot& plot, const ScenePlot::Line& line, const Axis& x, const Axis& y,
               const CostMeter& meter) {
  const std::vector<std::size_t> drawn = points_to_draw(line.values, points_of(plot, line), kColumns, meter);
  for (std::size_t k = 1; k < drawn.size(); ++k) {
    const std::size_t i = drawn[k - 1], next = drawn[k];
    if (is_point(plot, line, i) && is_point(plot, line, next))
      paper.line(x_at(x.range, x_of(plot, i)), y_at(y.range, line.values[i]), x_at(x.range, x_of(plot, next)),
                 y_at(y.range, line.values[next]), 2.6, rgb_of(line.color));
  }
}

}  // namespace

Picture plot_picture(const ScenePlot& plot, const CostMeter& meter) {
  const Key key = key_of(plot);
  Paper paper(key.height, meter);
  const Axis x = x_axis_of(plot), y = y_axis_of(plot, meter);
  draw_axes(paper, plot, x, y);
  for (const ScenePlot::Line& line : plot.lines) draw_line(paper, plot, line, x, y, meter);
  for (const KeyEntry& entry : key.entries) {
    paper.shift = entry.below;
    paper.line(entry.x + 2, 28.5, entry.x + 24, 28.5, 5, rgb_of(plot.lines[entry.line].color));
    paper.text(entry.x + 34, kKey, 0, paper.large, entry.name, kText);
  }
  if (key.entries.empty()) paper.text((kLeft + kWidth - kRight) / 2, kKey, 0.5, paper.large, plot.title, kText);
  return std::move(paper.picture());
}

}  // namespace breve
