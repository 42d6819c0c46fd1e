// Rows of instances for quads that the shaders make.
#include "runtime/render/marks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace breve::render {

namespace {

/// Text is a thirty-sixth of the picture high, and neither tiny nor huge.
int text_size(int picture_height, float scale) {
  constexpr float kOfHeight = 1.0F / 36, kLeast = 11, kMost = 34;
  return static_cast<int>(
      std::lround(scale * std::clamp(kOfHeight * static_cast<float>(picture_height), kLeast, kMost)));
}

/// A line with its soft edges.
double line_pixels(const SceneLine& line, const Canvas& canvas) {
  constexpr double kEdges = 2;
  Extent extent(*canvas.lens, canvas.width, canvas.height);
  extent.add(line.from);
  extent.add(line.to);
  return (extent.diagonal() + kEdges) * (static_cast<double>(line.width) + kEdges);
}

float brightness(const Vector3f& color) { return color.dot(Vector3f(0.299F, 0.587F, 0.114F)); }

}  // namespace

Marks::Marks(const Gl& gl, const std::string& font)
    : gl_(gl), array_(gl), polygon_array_(gl), buffer_(gl), font_(font) {}

void Marks::draw(const std::vector<Row>& rows, std::size_t first, std::size_t count, const Canvas& canvas,
                 const std::function<double(std::size_t row)>& pixels_of) {
  array_.bind();
  draw_in_pieces(
      gl_, canvas.meter, first, count, [&](std::size_t row) { return kOfQuad + kOfBlended * pixels_of(row); },
      [&](std::size_t from, std::size_t some) { draw_some(rows, from, some); });
  ++*canvas.draw_calls;
}

void Marks::draw_some(const std::vector<Row>& rows, std::size_t first, std::size_t count) {
  buffer_.fill(GL_ARRAY_BUFFER, rows.data() + first, count * sizeof(Row), GL_STREAM_DRAW);
  // KEEP IN STEP: rows 0 and 1 and color are attributes 4, 5 and 7 (shaders.cpp).
  const std::pair<unsigned, std::size_t> attributes[] = {
      {4, offsetof(Row, first)}, {5, offsetof(Row, second)}, {7, offsetof(Row, color)}};
  for (const auto& [number, offset] : attributes) {
    gl_.EnableVertexAttribArray(number);
    gl_.VertexAttribPointer(number, 4, GL_FLOAT, GL_FALSE, sizeof(Row), reinterpret_cast<const void*>(offset));
    gl_.VertexAttribDivisor(number, 1);
  }
  gl_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count));
}

void Marks::draw_lines(const Shaders& shaders, const std::vector<SceneLine>& lines, const Canvas& canvas) {
  if (lines.empty()) return;
  std::vector<Row> rows;
  rows.reserve(lines.size());
  for (const SceneLine& line : lines)
    rows.push_back({{line.from.x(), line.from.y(), line.from.z(), line.width},
                    {line.to.x(), line.to.y(), line.to.z(), static_cast<float>(line.pattern)},
                    line.color});
  shaders.line.use();
  shaders.line.set("view", canvas.lens->view);
  shaders.line.set("projection", canvas.lens->projection);
  shaders.line.set("near", canvas.lens->orthographic ? -1.0F : canvas.lens->near);
  shaders.line.set("picture", static_cast<float>(canvas.width), static_cast<float>(canvas.height));
  set_fog(shaders.line, canvas.fog, *canvas.lens);
  draw(rows, 0, rows.size(), canvas, [&](std::size_t row) { return line_pixels(lines[row], canvas); });
}

void Marks::draw_polygons(const Shaders& shaders, const std::vector<SceneVertex>& triangles, const Canvas& canvas) {
  if (triangles.empty()) return;
  shaders.plain.use();
  shaders.plain.set("view", canvas.lens->view);
  shaders.plain.set("projection", canvas.lens->projection);
  set_fog(shaders.plain, canvas.fog, *canvas.lens);
  polygon_array_.bind();
  const auto cost_of = [&](std::size_t triangle) {
    Extent extent(*canvas.lens, canvas.width, canvas.height);
    for (std::size_t corner = 0; corner < 3; ++corner) extent.add(triangles[3 * triangle + corner].position);
    return kOfTriangle + kOfBlended * extent.area();
  };
  draw_in_pieces(gl_, canvas.meter, 0, triangles.size() / 3, cost_of,
                 [&](std::size_t first, std::size_t count) { draw_triangles(triangles.data() + 3 * first, count); });
  ++*canvas.draw_calls;
}

void Marks::draw_triangles(const SceneVertex* first, std::size_t count) {
  buffer_.fill(GL_ARRAY_BUFFER, first, 3 * count * sizeof(SceneVertex), GL_STREAM_DRAW);
  // KEEP IN STEP: position and color are attributes 0 and 7 (shaders.cpp).
  gl_.EnableVertexAttribArray(0);
  gl_.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(SceneVertex), nullptr);
  gl_.EnableVertexAttribArray(7);
  gl_.VertexAttribPointer(7, 4, GL_FLOAT, GL_FALSE, sizeof(SceneVertex),
                          reinterpret_cast<const void*>(offsetof(SceneVertex, color)));
  gl_.DrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * count));
}

// --- sprites ---------------------------------------------------------------------------------------------------------

Marks::Row Marks::row_of(const SceneSprite& s) {
  return {{s.center.x(), s.center.y(), s.center.z(), s.size}, {s.heading, s.point ? 1.0F : 0.0F, 0, 0}, s.color};
}

double Marks::sprite_pixels(const SceneSprite& sprite, const Canvas& canvas) {
  const double scale = sprite.point ? 1 : canvas.lens->scale_at(sprite.center, static_cast<float>(canvas.height));
  // A square that is rotated reaches as far as its corners.
  Extent extent(*canvas.lens, canvas.width, canvas.height);
  extent.add(sprite.center, std::numbers::sqrt2 / 2 * static_cast<double>(sprite.size) * scale);
  return extent.area();
}

void Marks::begin_sprites(const Shaders& shaders, const Canvas& canvas) {
  shaders.sprite.use();
  shaders.sprite.set("view", canvas.lens->view);
  shaders.sprite.set("projection", canvas.lens->projection);
  shaders.sprite.set("picture", static_cast<float>(canvas.width), static_cast<float>(canvas.height));
  shaders.sprite.set("image", 0);
  set_fog(shaders.sprite, canvas.fog, *canvas.lens);
}

// --- text ------------------------------------------------------------------------------------------------------------

namespace {

Vector4f rectangle_of(const Letter& one) { return {one.x, one.y, one.width, one.height}; }
Vector4f source_of(const Letter& one) { return {one.from_x, one.from_y, one.from_width, one.from_height}; }

}  // namespace

void Marks::draw_rows(const Shaders& shaders, const std::vector<Row>& rows, const Canvas& canvas) {
  if (rows.empty()) return;
  if (!letters_ || letters_->revision() != font_.revision())
    letters_ = std::make_unique<TextureBuffer>(gl_, TextureBuffer::Kind::Letters, Font::kSide, Font::kSide,
                                               font_.image().data(), font_.revision());
  letters_->bind(0);
  shaders.text.use();
  shaders.text.set("picture", static_cast<float>(canvas.width), static_cast<float>(canvas.height));
  shaders.text.set("image", 0);
  draw(rows, 0, rows.size(), canvas, [&](std::size_t row) {
    const Vector4f& at = rows[row].first;
    Extent extent(*canvas.lens, canvas.width, canvas.height);
    extent.add(at.x(), at.y(), at.x() + at.z(), at.y() + at.w());
    return extent.area();
  });
}

/// White letters on a dark plate, above the body.
void Marks::draw_labels(const Shaders& shaders, const Scene& scene, const Canvas& canvas) {
  constexpr float kGap = 5, kPadding = 0.35F;
  const Vector4f plate(0.08F, 0.10F, 0.13F, 0.72F), ink(1, 1, 1, 1);
  const int size = text_size(canvas.height, 0.85F * scene.flags.text_scale);
  const auto em = static_cast<float>(size);
  std::vector<Row> rows;
  std::vector<Letter> letters;
  for (const SceneLabel& label : scene.labels) {
    double seen[3];
    if (!project(*canvas.lens, label.location.cast<double>(), canvas.width, canvas.height, seen)) continue;
    letters.clear();
    const float width = font_.lay(label.text, size, 0, 0, letters);
    const float x = std::round(static_cast<float>(seen[0]) - width / 2);
    const float y = std::round(static_cast<float>(seen[1]) - kGap - kPadding * em);
    rows.push_back(
        {{x - kPadding * em, y - (0.78F + kPadding) * em, width + 2 * kPadding * em, (1.0F + 2 * kPadding) * em},
         Vector4f::Zero(),
         plate});
    for (Letter& one : letters) {
      one.x += x;
      one.y += y;
      rows.push_back({rectangle_of(one), source_of(one), ink});
    }
  }
  draw_rows(shaders, rows, canvas);
}

void Marks::draw_texts(const Shaders& shaders, const Scene& scene, const Canvas& canvas) {
  const int size = text_size(canvas.height, scene.flags.text_scale);
  std::vector<Row> rows;
  std::vector<Letter> letters;
  for (const SceneText& text : scene.texts) {
    letters.clear();
    const float x = (text.x + 1) / 2 * static_cast<float>(canvas.width);
    const float y = (1 - text.y) / 2 * static_cast<float>(canvas.height);
    font_.lay(text.text, size, x, y, letters);
    // A faint edge of the opposite brightness keeps letters legible on any ground.
    const float edge = brightness(text.color) > 0.5F ? 0.0F : 1.0F;
    for (const float dx : {-1.0F, 1.0F})
      for (const Letter& one : letters)
        rows.push_back({rectangle_of(one) + Vector4f(dx, 1, 0, 0), source_of(one), {edge, edge, edge, 0.22F}});
    const Vector4f ink(text.color.x(), text.color.y(), text.color.z(), 1);
    for (const Letter& one : letters) rows.push_back({rectangle_of(one), source_of(one), ink});
  }
  draw_rows(shaders, rows, canvas);
}

}  // namespace breve::render
