// What lies behind what: opaque things hide by depth; what lets light through is drawn after them, from back to front,
// whatever its kind.
#include <algorithm>

#include "runtime/render/work.hpp"

namespace breve::render {

namespace {

/// Something transparent that is not a body.
struct Other {
  enum class Kind : std::uint8_t { Sheet, Sprite, Triangle } kind = Kind::Sprite;
  std::size_t number = 0;  // of the sheet or sprite, or of a triangle's first corner
  Place place;
};

bool is_opaque(const std::vector<SceneVertex>& triangles, std::size_t first) {
  return std::all_of(triangles.begin() + static_cast<std::ptrdiff_t>(first),
                     triangles.begin() + static_cast<std::ptrdiff_t>(first + 3),
                     [](const SceneVertex& corner) { return corner.color.w() >= kOpaque; });
}

std::vector<SceneVertex> opaque_triangles(const std::vector<SceneVertex>& triangles) {
  std::vector<SceneVertex> opaque;
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3)
    if (is_opaque(triangles, i)) opaque.insert(opaque.end(), &triangles[i], &triangles[i] + 3);
  return opaque;
}

/// From back to front.
std::vector<Other> others_of(const Pass& pass) {
  const Scene& scene = *pass.scene;
  std::vector<Other> others;
  const auto add = [&](Other::Kind kind, std::size_t number, const Vector3f& middle) {
    others.push_back({kind, number, place_of(*pass.lens, pass.clear_sheets, middle)});
  };
  for (std::size_t i = 0; i < scene.sheets.size(); ++i) {
    const SceneSheet& sheet = scene.sheets[i];
    if (!sheet.clear) continue;
    add(Other::Kind::Sheet, i, sheet.corner + 0.5F * (sheet.across + sheet.along));
    ++others.back().place.planes;
  }
  for (std::size_t i = 0; i + 2 < scene.triangles.size(); i += 3)
    if (!is_opaque(scene.triangles, i))
      add(Other::Kind::Triangle, i,
          (scene.triangles[i].position + scene.triangles[i + 1].position + scene.triangles[i + 2].position) / 3);
  for (std::size_t i = 0; i < scene.sprites.size(); ++i) add(Other::Kind::Sprite, i, scene.sprites[i].center);
  std::stable_sort(others.begin(), others.end(),
                   [](const Other& a, const Other& b) { return is_behind(a.place, b.place); });
  return others;
}

}  // namespace

void Renderer::Work::draw_sheet(const Pass& pass, std::size_t number, Cells cells) {
  const Gl& gl = context.gl();
  const Program& program = shaders.sheet;
  const SceneSheet& sheet = pass.scene->sheets[number];
  std::unique_ptr<TextureBuffer>& kept = sheets[number];
  if (!kept || kept->revision() != sheet.revision) {
    kept = std::make_unique<TextureBuffer>(gl, TextureBuffer::Kind::Cells, sheet.columns, sheet.rows, sheet.rgba.data(),
                                           sheet.revision);
    ++counters.uploads;
  }
  constexpr unsigned kUnit = 0;
  kept->bind(kUnit);
  program.use();
  program.set("view", pass.lens->view);
  program.set("projection", pass.lens->projection);
  program.set("corner", sheet.corner);
  program.set("across", sheet.across);
  program.set("along", sheet.along);
  program.set("image", static_cast<int>(kUnit));
  program.set("least", cells == Cells::Opaque ? kOpaque : 0.0F);
  program.set("most", cells == Cells::Clear ? kOpaque : 2.0F);
  set_fog(program, &pass.scene->fog, *pass.lens);
  Extent extent(*pass.lens, pass.width, pass.height);
  for (const float across : {0.0F, 1.0F})
    for (const float along : {0.0F, 1.0F}) extent.add(sheet.corner + across * sheet.across + along * sheet.along);
  nothing.bind();
  draw_in_pieces(
      gl, meter, 0, 1, [&](std::size_t) { return kOfQuad + kOfBlended * extent.area(); },
      [&](std::size_t, std::size_t) { gl.DrawArrays(GL_TRIANGLE_STRIP, 0, 4); });
  ++counters.draw_calls;
}

void Renderer::Work::draw_sprites(const Pass& pass, const std::vector<const SceneSprite*>& sprites,
                                  const Canvas& canvas) {
  marks.draw_sprites(shaders, sprites, canvas, [&](std::uint32_t number) { bind_texture(*pass.scene, number, 0); });
}

void Renderer::Work::draw_layers(const Pass& pass, const Canvas& canvas) {
  const Scene& scene = *pass.scene;
  const std::vector<Other> others = others_of(pass);
  std::vector<Place> places;
  for (const Other& other : others) places.push_back(other.place);
  for (std::size_t i = 0; i < scene.sheets.size(); ++i) draw_sheet(pass, i, Cells::Opaque);
  const Batches all = upload_bodies(pass, places);
  draw_opaque(pass, all);
  marks.draw_polygons(shaders, opaque_triangles(scene.triangles), canvas);
  std::size_t next = 0;
  std::vector<const SceneSprite*> sprites;
  std::vector<SceneVertex> triangles;
  // Neighbours of one kind share a call.
  const auto draw_others = [&](std::size_t end) {
    context.gl().DepthMask(GL_FALSE);
    while (next < end) {
      sprites.clear();
      triangles.clear();
      const Other::Kind kind = others[next].kind;
      for (; next < end && others[next].kind == kind; ++next) {
        const std::size_t number = others[next].number;
        if (kind == Other::Kind::Sheet) draw_sheet(pass, number, Cells::Clear);
        if (kind == Other::Kind::Sprite) sprites.push_back(&scene.sprites[number]);
        if (kind == Other::Kind::Triangle)
          triangles.insert(triangles.end(), &scene.triangles[number], &scene.triangles[number] + 3);
      }
      draw_sprites(pass, sprites, canvas);
      marks.draw_polygons(shaders, triangles, canvas);
    }
    context.gl().DepthMask(GL_TRUE);
  };
  for (const Batch& one : all.transparent) {
    std::size_t end = next;
    while (end < others.size() && is_behind(others[end].place, one.place)) ++end;
    draw_others(end);
    draw_transparent(pass, one);
  }
  // Lines hide nothing: their edges are soft. Sprites in front of all bodies cover them.
  context.gl().DepthMask(GL_FALSE);
  marks.draw_lines(shaders, scene.lines, canvas);
  draw_others(others.size());
}

/// In a flat world what was made later lies on top; drawings lie on bodies, and lines and sprites on those.
void Renderer::Work::draw_flat_layers(const Pass& pass, const Canvas& canvas) {
  const Gl& gl = context.gl();
  gl.Disable(GL_DEPTH_TEST);
  for (std::size_t i = 0; i < pass.scene->sheets.size(); ++i) draw_sheet(pass, i, Cells::All);
  gl.Enable(GL_DEPTH_TEST);
  draw_bodies(pass);
  gl.Disable(GL_DEPTH_TEST);
  marks.draw_polygons(shaders, pass.scene->triangles, canvas);
  marks.draw_lines(shaders, pass.scene->lines, canvas);
  std::vector<const SceneSprite*> sprites;
  for (const SceneSprite& one : pass.scene->sprites) sprites.push_back(&one);
  std::stable_sort(sprites.begin(), sprites.end(), [&](const SceneSprite* a, const SceneSprite* b) {
    return (pass.lens->eye - a->center).dot(pass.lens->back) > (pass.lens->eye - b->center).dot(pass.lens->back);
  });
  draw_sprites(pass, sprites, canvas);
}

}  // namespace breve::render
