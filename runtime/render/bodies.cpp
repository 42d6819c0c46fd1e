// The passes over bodies: backdrop, instances, cells.
#include <algorithm>
#include <cmath>

#include "runtime/render/work.hpp"

namespace breve::render {

namespace {

Vector3f mix(const Vector3f& a, const Vector3f& b, float part) { return a + part * (b - a); }

// KEEP IN STEP: units of textures, with the names of samplers in shader_texts.hpp.
constexpr unsigned kImageUnit = 0, kShadowUnit = 1, kReflectionUnit = 2, kSkyboxUnit = 3;

constexpr float kOutlinePixels = 1.6F;

}  // namespace

const SceneInstance* ground_of(const Scene& scene) {
  const SceneInstance* largest = nullptr;
  float most = 0, others = 0;
  for (const SceneInstance& one : scene.instances) {
    const float radius = radius_of(one, scene.meshes[one.mesh]);
    const float reach = radius + (one.fixed ? 0 : one.transform.col(3).norm() * 0.2F);
    if (one.fixed && radius > most) {
      most = radius;
      largest = &one;
    } else if (!one.fixed) {
      others = std::max(others, reach);
    }
  }
  return most > others ? largest : nullptr;
}

Air Renderer::Work::air_of(const Scene& scene) const {
  Air air;
  air.color = linear(scene.backdrop.color);
  const float light = air.color.dot(Vector3f(0.21F, 0.72F, 0.07F));
  const float paler = settings.look == Look::Full ? 0.55F * std::clamp((light - 0.02F) / 0.3F, 0.0F, 1.0F) : 0.0F;
  air.horizon = mix(air.color, Vector3f(1, 1, 1), paler);
  air.zenith =
      settings.look == Look::Full ? Vector3f(air.color.cwiseProduct(mix(air.color, {1, 1, 1}, 0.45F))) : air.color;
  return air;
}

void Renderer::Work::draw_backdrop(const Pass& pass) {
  const Scene& scene = *pass.scene;
  const Air air = air_of(scene);
  int kind = settings.look == Look::Full ? 1 : 0;
  if (scene.backdrop.texture != kNoTexture) kind = 2;
  if (scene.backdrop.mountains) kind = 3;
  const auto& box = scene.backdrop.skybox;
  if (std::find(box.begin(), box.end(), kNoTexture) == box.end()) kind = 4;
  const Program& program = shaders.backdrop;
  program.use();
  program.set("kind", kind);
  program.set("flat_view", pass.ground ? 0.0F : 1.0F);
  program.set("right", pass.lens->right);
  program.set("up", pass.lens->up);
  program.set("back", pass.lens->back);
  program.set("slope", pass.lens->orthographic ? 0.36F : pass.lens->slope);
  program.set("aspect", static_cast<float>(pass.width) / static_cast<float>(pass.height));
  program.set("color", air.color);
  program.set("horizon", air.horizon);
  program.set("zenith", air.zenith);
  program.set("scroll", scene.backdrop.scroll_x - std::floor(scene.backdrop.scroll_x),
              scene.backdrop.scroll_y - std::floor(scene.backdrop.scroll_y));
  program.set("image", static_cast<int>(kImageUnit));
  bind_texture(scene, scene.backdrop.texture, kImageUnit);
  const char* const sides[] = {"side0", "side1", "side2", "side3", "side4", "side5"};
  for (unsigned i = 0; i < 6; ++i) {
    program.set(sides[i], static_cast<int>(kSkyboxUnit + i));
    bind_texture(scene, box[i], kSkyboxUnit + i);
  }
  context.gl().Disable(GL_DEPTH_TEST);
  nothing.bind();
  context.gl().DrawArrays(GL_TRIANGLES, 0, 3);
  ++counters.draw_calls;
  context.gl().Enable(GL_DEPTH_TEST);
}

void Renderer::Work::set_lights(const Pass& pass, const Program& program) {
  constexpr std::size_t kMost = 8;
  const Scene& scene = *pass.scene;
  const std::size_t count = std::min(scene.lights.size(), kMost);
  program.set("lights", static_cast<int>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const SceneLight& light = scene.lights[i];
    const std::string at = "[" + std::to_string(i) + "]";
    program.set(("light_place" + at).c_str(), Vector3f(light.position.cast<float>()));
    program.set(("light_ambient" + at).c_str(), light.ambient);
    program.set(("light_diffuse" + at).c_str(), light.diffuse);
    program.set(("light_specular" + at).c_str(), light.specular);
  }
  const Vector3f key = -0.45F * pass.lens->right + 0.75F * pass.lens->up + 0.55F * pass.lens->back;
  program.set("key", Vector3f(key.normalized()));
  const Air air = air_of(scene);
  program.set("sky", mix(air.horizon, {1, 1, 1}, 0.4F));
  program.set("ground", mix(air.color, {0.42F, 0.36F, 0.30F}, 0.7F));
  program.set("horizon", air.horizon);
  program.set("fill", settings.look == Look::Full ? 1.0F : 0.0F);
}

void Renderer::Work::set_body_uniforms(const Pass& pass, const Program& program) {
  const Scene& scene = *pass.scene;
  const Lens& lens = *pass.lens;
  program.set("view", lens.view);
  program.set("projection", lens.projection);
  program.set("eye", lens.eye);
  program.set("right", lens.right);
  program.set("up", lens.up);
  program.set("sight", lens.orthographic ? Vector3f(-lens.back) : Vector3f(0, 0, 0));
  const bool full = settings.look == Look::Full;
  const bool flat = scene.dimension == 2;
  program.set("layers", flat ? static_cast<float>(scene.instances.size()) + 2 : 0.0F);
  program.set("picture", static_cast<float>(pass.width), static_cast<float>(pass.height));
  set_lights(pass, program);
  program.set("shadow_matrix", pass.shadow.matrix);
  program.set("shadow_texel_slope", pass.shadow.texel_slope);
  program.set("shadow_bias", 6e-5F);
  program.set("shadow_clear", pass.shadow.clear);
  program.set("shadow_ring", shadow ? pass.shadow.ring / static_cast<float>(shadow->side()) : 0.0F);
  program.set("shadow_samples", 8);
  program.set("shadow_map", static_cast<int>(kShadowUnit));
  if (pass.shadow.on) shadow->bind_texture(kShadowUnit);
  program.set("image", static_cast<int>(kImageUnit));
  program.set("reflection", static_cast<int>(kReflectionUnit));
  program.set("mirror_height", pass.mirror.height);
  if (pass.mirror.on && !pass.reflected) reflection->bind_color(kReflectionUnit);
  program.set("clip_plane", pass.reflected ? Vector4f(0, 1, 0, -pass.mirror.height) : Vector4f(0, 0, 0, 1));
  set_fog(program, &scene.fog, lens);
  const bool haze = full && pass.ground && !scene.fog.enabled && !lens.orthographic;
  const auto away = static_cast<float>(pass.camera->offset.norm());
  program.set("haze_start", std::max(0.22F * lens.far, 1.3F * away));
  program.set("haze_end", haze ? std::max(0.92F * lens.far, 3 * away) : 0.0F);
}

/// In use, with the uniforms of this pass.
const Program& Renderer::Work::body_program(const Pass& pass, const Batch& batch) {
  const Scene& scene = *pass.scene;
  BodyKind kind;
  kind.disc = batch.mesh == kDiscMesh;
  kind.textured = batch.texture != kNoTexture;
  kind.holes = kind.textured && scene.textures[batch.texture].clear;
  kind.shadows = pass.shadow.on;
  kind.mirror = pass.mirror.on && !pass.reflected;
  kind.mode = scene.dimension == 2 ? 0 : scene.flags.lighting ? 1 : settings.look == Look::Full ? 2 : 0;
  const Program& program = shaders.body(kind);
  program.use();
  if (std::find(ready.begin(), ready.end(), &program) == ready.end()) {
    set_body_uniforms(pass, program);
    ready.push_back(&program);
  }
  return program;
}

/// All at once, or in pieces where there is a meter.
void Renderer::Work::draw_pieces(const MeshBuffer& buffer, const Batch& batch, bool blended) {
  const double pixels = (blended ? kOfBlended : kOfPixel) * batch.pixels / static_cast<double>(batch.count);
  const auto triangles = static_cast<double>(buffer.triangles()), each = kOfTriangle * triangles + pixels;
  constexpr double kMany = 10'000;  // of a body that is cut in pieces itself
  if (!meter || triangles < kMany)
    return draw_in_pieces(
        context.gl(), meter, batch.first, batch.count, [each](std::size_t) { return each; },
        [&](std::size_t first, std::size_t count) { buffer.draw(instances, first, count); });
  for (std::size_t i = 0; i < batch.count; ++i)
    draw_in_pieces(
        context.gl(), meter, 0, buffer.triangles(), [&](std::size_t) { return each / triangles; },
        [&](std::size_t from, std::size_t count) { buffer.draw_part(instances, batch.first + i, 1, from, count); });
}

void Renderer::Work::draw_batch(const Pass& pass, const Batch& one, bool blended, float outline) {
  const Gl& gl = context.gl();
  const MeshBuffer& buffer = mesh(*pass.scene, one.mesh);
  const Program& program = body_program(pass, one);
  program.set("outline", outline);
  program.set("tinted", buffer.tinted() ? 1.0F : 0.0F);
  bind_texture(*pass.scene, one.texture, kImageUnit);
  (buffer.two_sided() ? gl.Disable : gl.Enable)(GL_CULL_FACE);
  const bool disc = one.mesh == kDiscMesh;
  // Coverage is what its edge is made of; blending would count it twice.
  if (disc) gl.Disable(GL_BLEND);
  if (disc && settings.samples > 1) gl.Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  draw_pieces(buffer, one, blended);
  gl.Disable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  gl.Enable(GL_BLEND);
  ++counters.draw_calls;
  counters.instances += one.count;
  counters.triangles += one.count * buffer.triangles();
}

Batches Renderer::Work::upload_bodies(const Pass& pass, const std::vector<Place>& others, Wanted wanted) {
  const Scene& scene = *pass.scene;
  const bool flat = scene.dimension == 2;
  BatchView view{pass.lens, static_cast<float>(pass.height)};
  view.discs = !flat && !pass.reflected && !scene.flags.outline;
  view.by_distance = !flat;
  view.ground = pass.ground;
  view.sheets = &pass.clear_sheets;
  view.others = &others;
  Batches all = batch(scene, view, wanted);
  instances.fill(GL_ARRAY_BUFFER, all.instances.data(), all.instances.size() * sizeof(GpuInstance), GL_STREAM_DRAW);
  ready.clear();
  return all;
}

void Renderer::Work::draw_opaque(const Pass& pass, const Batches& all) {
  const Gl& gl = context.gl();
  const Scene& scene = *pass.scene;
  gl.PolygonMode(GL_FRONT_AND_BACK, scene.flags.outline ? GL_LINE : GL_FILL);
  for (const Batch& one : all.opaque) draw_batch(pass, one, false);
  if (scene.dimension == 2 && settings.look == Look::Full)
    for (const Batch& one : all.opaque)
      draw_batch(pass, one, false, kOutlinePixels / pass.lens->scale_at({0, 0, 0}, static_cast<float>(pass.height)));
  gl.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  gl.Disable(GL_CULL_FACE);
}

void Renderer::Work::draw_transparent(const Pass& pass, const Batch& one) {
  const Gl& gl = context.gl();
  gl.PolygonMode(GL_FRONT_AND_BACK, pass.scene->flags.outline ? GL_LINE : GL_FILL);
  // What a texture with holes leaves of an opaque body hides what is behind it.
  gl.DepthMask(one.solid ? GL_TRUE : GL_FALSE);
  draw_batch(pass, one, true);
  gl.DepthMask(GL_TRUE);
  gl.PolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  gl.Disable(GL_CULL_FACE);
}

void Renderer::Work::draw_bodies(const Pass& pass, Wanted wanted) {
  const Batches all = upload_bodies(pass, {}, wanted);
  draw_opaque(pass, all);
  for (const Batch& one : all.transparent) draw_transparent(pass, one);
}

}  // namespace breve::render
