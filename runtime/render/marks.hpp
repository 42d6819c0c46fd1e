// Draws everything except bodies: lines, sprites, cells, polygons, text. Each kind takes one instanced call, or one for
// each piece where a meter counts them.
#pragma once

#include <memory>
#include <vector>

#include "runtime/render/buffers.hpp"
#include "runtime/render/picture_meter.hpp"
#include "runtime/render/shaders.hpp"
#include "runtime/render/text.hpp"

namespace breve::render {

/// The room that a camera draws in, and what is counted.
struct Canvas {
  const Lens* lens = nullptr;
  int width = 0, height = 0;  // pixels
  std::uint64_t* draw_calls = nullptr;
  const SceneFog* fog = nullptr;  // null: none
  CostMeter meter{};
};

/// A camera whose world is the picture: pixels from the left and from the top.
Lens pixel_lens(const Canvas& canvas);

class Marks {
 public:
  Marks(const Gl& gl, const std::string& font);

  void draw_lines(const Shaders& shaders, const std::vector<SceneLine>& lines, const Canvas& canvas);
  void draw_polygons(const Shaders& shaders, const std::vector<SceneVertex>& triangles, const Canvas& canvas);
  /// In this order. @param bind_texture  binds the scene's texture of that number to unit 0
  template <class Bind>
  void draw_sprites(const Shaders& shaders, const std::vector<const SceneSprite*>& sprites, const Canvas& canvas,
                    Bind bind_texture);
  void draw_labels(const Shaders& shaders, const Scene& scene, const Canvas& canvas);
  void draw_texts(const Shaders& shaders, const Scene& scene, const Canvas& canvas);
  void draw_arrows(const Shaders& shaders, const std::vector<SceneArrow>& arrows, const Canvas& canvas);  // arrows.cpp
  void draw_plots(const Shaders& shaders, const Scene& scene, const Canvas& canvas);                      // plots.cpp

 private:
  struct Row {
    Vector4f first, second, color;
  };
  /// @param pixels_of  that the row of that number covers at most
  void draw(const std::vector<Row>& rows, std::size_t first, std::size_t count, const Canvas& canvas,
            const std::function<double(std::size_t row)>& pixels_of);
  void draw_some(const std::vector<Row>& rows, std::size_t first, std::size_t count);
  void draw_triangles(const SceneVertex* first, std::size_t count);
  void draw_rows(const Shaders& shaders, const std::vector<Row>& rows, const Canvas& canvas);
  /// Where a plot stands, and how high its letters are; pixels.
  struct PlotCell {
    float left, top, width, height;
    int letters;
  };
  struct PlotParts {
    std::vector<Row> plates, letters;
    std::vector<SceneLine> lines;
  };
  void add_plot(const ScenePlot& plot, const PlotCell& cell, PlotParts& parts);
  void add_words(const std::string& words, int size, float x, float y, float align, std::vector<Row>& rows);
  static Row row_of(const SceneSprite& sprite);
  static double sprite_pixels(const SceneSprite& sprite, const Canvas& canvas);
  void begin_sprites(const Shaders& shaders, const Canvas& canvas);

  const Gl& gl_;
  VertexArray array_, polygon_array_;
  Buffer buffer_;
  Font font_;
  std::unique_ptr<TextureBuffer> letters_;
};

template <class Bind>
void Marks::draw_sprites(const Shaders& shaders, const std::vector<const SceneSprite*>& sprites, const Canvas& canvas,
                         Bind bind_texture) {
  if (sprites.empty()) return;
  begin_sprites(shaders, canvas);
  std::vector<Row> rows;
  rows.reserve(sprites.size());
  for (const SceneSprite* sprite : sprites) rows.push_back(row_of(*sprite));
  for (std::size_t first = 0, next = 0; first < sprites.size(); first = next) {
    const SceneSprite& one = *sprites[first];
    while (next < sprites.size() && sprites[next]->texture == one.texture && sprites[next]->glow == one.glow) ++next;
    gl_.BlendFunc(GL_SRC_ALPHA, one.glow ? GL_ONE : GL_ONE_MINUS_SRC_ALPHA);
    shaders.sprite.set("glow", one.glow ? 1.0F : 0.0F);
    bind_texture(one.texture);
    draw(rows, first, next - first, canvas,
         [&](std::size_t number) { return sprite_pixels(*sprites[number], canvas); });
  }
  gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
}

}  // namespace breve::render
