// Arrows over the picture. Shafts and heads are as wide as lines are, however far away they are, so that short ones are
// seen; a dark edge sets them off from what is behind them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/render/marks.hpp"

namespace breve::render {

namespace {

using Point = Eigen::Vector2f;

struct Sizes {
  float shaft, head, dot;  // pixels: the width of the shaft, the length of the head, the radius of the dot at its begin
};

struct Painted {
  std::vector<SceneLine> lines;
  std::vector<SceneVertex> triangles;
};

Vector3f flat(const Point& point) { return {point.x(), point.y(), 0}; }

void add_triangle(Painted& to, const Point& a, const Point& b, const Point& c, const Vector4f& color) {
  for (const Point& corner : {a, b, c}) to.triangles.push_back({flat(corner), color});
}

void add_dot(Painted& to, const Point& center, float radius, const Vector4f& color) {
  constexpr int kCorners = 12;
  const auto corner = [&](int i) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kCorners;
    return Point(center + radius * Point(std::cos(angle), std::sin(angle)));
  };
  for (int i = 0; i < kCorners; ++i) add_triangle(to, center, corner(i), corner(i + 1), color);
}

/// @param edge  pixels by which all is wider
void add_arrow(Painted& to, const Point& from, const Point& end, const Sizes& sizes, float edge,
               const Vector4f& color) {
  const float length = (end - from).norm();
  add_dot(to, from, sizes.dot + edge, color);
  if (length < 1) return;
  const Point way = (end - from) / length, side(-way.y(), way.x());
  const float head = std::min(sizes.head, 0.7F * length);
  const Point neck = end - head * way;
  to.lines.push_back({flat(from), flat(neck), color, sizes.shaft + 2 * edge});
  add_triangle(to, end + 1.6F * edge * way, neck - edge * way + (0.42F * head + 1.3F * edge) * side,
               neck - edge * way - (0.42F * head + 1.3F * edge) * side, color);
}

}  // namespace

void Marks::draw_arrows(const Shaders& shaders, const std::vector<SceneArrow>& arrows, const Canvas& canvas) {
  if (arrows.empty()) return;
  const float unit = std::max(1.0F, static_cast<float>(canvas.height) / 480);
  const Sizes sizes{2.2F * unit, 12 * unit, 2.6F * unit};
  Painted edges, inks;
  for (const SceneArrow& arrow : arrows) {
    double from[3], to[3];
    if (!project(*canvas.lens, arrow.from.cast<double>(), canvas.width, canvas.height, from) ||
        !project(*canvas.lens, arrow.to.cast<double>(), canvas.width, canvas.height, to))
      continue;  // an end is behind the camera
    const Point begin(static_cast<float>(from[0]), static_cast<float>(from[1]));
    const Point end(static_cast<float>(to[0]), static_cast<float>(to[1]));
    add_arrow(edges, begin, end, sizes, unit, {0.05F, 0.06F, 0.08F, 1});
    add_arrow(inks, begin, end, sizes, 0, arrow.color);
  }
  const Lens lens = pixel_lens(canvas);
  Canvas pixels = canvas;
  pixels.lens = &lens;
  pixels.fog = nullptr;
  for (const Painted* painted : {&edges, &inks}) {
    draw_lines(shaders, painted->lines, pixels);
    draw_polygons(shaders, painted->triangles, pixels);
  }
}

}  // namespace breve::render
