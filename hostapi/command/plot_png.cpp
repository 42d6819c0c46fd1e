// The same plot as in SVG, as pixels: lines by their distance from each pixel, letters from an image.
#include "letters.hpp"
#include "plot_layout.hpp"

namespace breve::command {

using namespace layout;

namespace {

struct Rgb {
  int red, green, blue;
};

Rgb rgb_of(std::string_view ink) {
  const auto part = [&](std::size_t at) { return std::stoi(std::string(ink.substr(at, 2)), nullptr, 16); };
  return {part(1), part(3), part(5)};
}

class Paper {
 public:
  Paper() {
    frame_.width = static_cast<std::uint32_t>(kWidth);
    frame_.height = static_cast<std::uint32_t>(kHeight);
    frame_.rgba.assign(std::size_t{4} * frame_.width * frame_.height, 255);
  }
  Frame& frame() { return frame_; }

  /// Pixels are mixed with the ink as far as the line covers them.
  void line(double x0, double y0, double x1, double y1, double width, Rgb ink) {
    const double half = width / 2, long2 = std::max(1e-9, (x1 - x0) * (x1 - x0) + (y1 - y0) * (y1 - y0));
    for (int y = first(std::min(y0, y1) - half); y <= std::max(y0, y1) + half + 1; ++y)
      for (int x = first(std::min(x0, x1) - half); x <= std::max(x0, x1) + half + 1; ++x) {
        const double u = x + 0.5 - x0, v = y + 0.5 - y0;
        const double t = std::clamp((u * (x1 - x0) + v * (y1 - y0)) / long2, 0.0, 1.0);
        mix(x, y, half + 0.5 - std::hypot(u - t * (x1 - x0), v - t * (y1 - y0)), ink);
      }
  }
  /// @param align  0: from x on, 0.5: about x, 1: up to x
  void text(const Letters& letters, double x, double y, double align, std::string_view words, Rgb ink) {
    double at = x - align * letters.width_of(words);
    while (!words.empty()) {
      const Letters::Glyph& one = letters.glyph(next_character(words));
      for (int j = 0; j < one.height; ++j)
        for (int i = 0; i < one.width; ++i) {
          const auto from = static_cast<std::size_t>((one.y + j) * Letters::kWidth + one.x + i);
          mix(static_cast<int>(std::lround(at + one.left)) + i, static_cast<int>(std::lround(y + one.top)) + j,
              letters.cover()[from] / 255.0, ink);
        }
      at += one.advance;
    }
  }

 private:
  static int first(double place) { return static_cast<int>(std::floor(place)) - 1; }
  void mix(int x, int y, double cover, Rgb ink) {
    if (x < 0 || y < 0 || x >= kWidth || y >= kHeight || !(cover > 0)) return;
    std::uint8_t* pixel =
        frame_.rgba.data() + 4 * (static_cast<std::size_t>(y) * frame_.width + static_cast<std::size_t>(x));
    const double part = std::min(cover, 1.0);
    const int inks[] = {ink.red, ink.green, ink.blue};
    for (int k = 0; k < 3; ++k)
      pixel[k] = static_cast<std::uint8_t>(std::lround(pixel[k] + part * (inks[k] - pixel[k])));
  }
  Frame frame_;
};

void draw_axes(Paper& paper, const Range& x, const Range& y, const std::string& x_axis) {
  const Letters small(17), large(19);
  constexpr Rgb kFaint{227, 230, 234}, kLine{154, 163, 173}, kSmall{91, 101, 112}, kText{43, 49, 56};
  const auto across = axis_marks(x.low, x.high, 8), along = axis_marks(y.low, y.high, 6);
  const auto step = [](const std::vector<double>& marks) { return marks.size() > 1 ? marks[1] - marks[0] : 1; };
  for (const double mark : along) {
    const double at = y_at(y, mark);
    paper.line(kLeft, at, kWidth - kRight, at, 1, kFaint);
    paper.text(small, kLeft - 10, at + 6, 1, mark_text(mark, step(along)), kSmall);
  }
  for (const double mark : across) {
    const double at = x_at(x, mark);
    paper.line(at, kHeight - kBottom, at, kHeight - kBottom + 6, 1, kLine);
    paper.text(small, at, kHeight - kBottom + 26, 0.5, mark_text(mark, step(across)), kSmall);
  }
  paper.line(kLeft, kHeight - kBottom, kWidth - kRight, kHeight - kBottom, 1, kLine);
  paper.text(large, (kLeft + kWidth - kRight) / 2, kHeight - 18, 0.5, x_axis, kText);
}

}  // namespace

Frame series_picture(const Series& series, const std::string& x_axis) {
  Paper paper;
  const auto [x, y] = ranges_of(series);
  draw_axes(paper, x, y, x_axis);
  const Letters large(19);
  double next_label = kLeft;
  const std::size_t rows = series.times.size(), step = rows / kMostPoints + 1;
  for (std::size_t i = 0; i < series.columns.size(); ++i) {
    const Rgb ink = rgb_of(kInks[i % kInks.size()]);
    const auto& column = series.columns[i];
    for (std::size_t row = step; row < rows; row += step)
      if (std::isfinite(column[row - step]) && std::isfinite(column[row]))
        paper.line(x_at(x, series.times[row - step]), y_at(y, column[row - step]), x_at(x, series.times[row]),
                   y_at(y, column[row]), 2.6, ink);
    paper.line(next_label + 2, 28.5, next_label + 24, 28.5, 5, ink);
    paper.text(large, next_label + 34, 35, 0, series.names[i], {43, 49, 56});
    next_label += 64 + 11.5 * static_cast<double>(series.names[i].size());
  }
  return std::move(paper.frame());
}

}  // namespace breve::command
