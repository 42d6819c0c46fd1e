// The shadow map: what light 0 sees, as depth. Its frustum holds all that casts shadows, so that each texel counts.
#include <algorithm>
#include <cmath>

#include "runtime/render/work.hpp"

namespace breve::render {

namespace {

// Texels along each side. A map that is finer than the picture shows no more, and takes longer.
constexpr int kFine = 2048, kCoarse = 1024;

/// Large fixed things receive shadows; what they would cast falls outside.
bool casts(const SceneInstance& instance) { return instance.shadow && instance.color.w() > 0.3F; }

Matrix4f looking(const Vector3f& eye, const Vector3f& at) {
  const Vector3f back = (eye - at).normalized();
  const Vector3f helper = std::abs(back.y()) > 0.9F ? Vector3f::UnitZ() : Vector3f::UnitY();
  const Vector3f right = helper.cross(back).normalized(), up = back.cross(right);
  Matrix4f view = Matrix4f::Identity();
  view.block<1, 3>(0, 0) = right.transpose();
  view.block<1, 3>(1, 0) = up.transpose();
  view.block<1, 3>(2, 0) = back.transpose();
  view.block<3, 1>(0, 3) = -view.block<3, 3>(0, 0) * eye;
  return view;
}

Matrix4f perspective(float slope, float near, float far) {
  Matrix4f p = Matrix4f::Zero();
  p(0, 0) = p(1, 1) = 1 / slope;
  p(2, 2) = -(far + near) / (far - near);
  p(2, 3) = -2 * far * near / (far - near);
  p(3, 2) = -1;
  return p;
}

/// Pixels of a length unit in the picture, where the box is nearest.
float finest_scale(const Lens& lens, const Eigen::AlignedBox3f& box, float picture_height) {
  if (lens.orthographic) return lens.scale_at(box.center(), picture_height);
  const Vector3f nearest = lens.eye.cwiseMax(box.min()).cwiseMin(box.max());
  return picture_height / (2 * lens.slope * std::max((lens.eye - nearest).norm(), 1e-3F));
}

/// A lens at the light that holds the box. @param finest  pixels of a length unit in the picture, where it shows most
ShadowLens lens_at(const Vector3f& eye, const Eigen::AlignedBox3f& box, float finest, int& side) {
  const float radius = std::max(box.sizes().norm() / 2, 1e-3F);
  const float away = (eye - box.center()).norm();
  // A light among the bodies sees those on one side of it.
  constexpr float kWidest = 2.5F;
  const float sine = std::min(radius / std::max(away, 1e-6F), 0.93F);
  const float slope = away > radius ? sine / std::sqrt(1 - sine * sine) : kWidest;
  const float near = std::max(away - radius, 0.02F * radius), far = away + 8 * radius;
  const Vector3f at = away > 1e-6F ? Vector3f(box.center()) : Vector3f(eye - Vector3f::UnitY());
  const float width = std::min(slope, kWidest);
  constexpr float kMostPixels = 1.5F;  // that a texel may be wide: its edge is soft
  side = finest * 2 * width * away > kMostPixels * static_cast<float>(kCoarse) ? kFine : kCoarse;
  // The edge is as soft in both: texels that are twice as wide are smoothed over half as many.
  const bool fine = side == kFine;
  return {true, perspective(width, near, far) * looking(eye, at), 2 * width / static_cast<float>(side),
          fine ? 2.6F : 1.3F, fine ? 3.0F : 2.0F};
}

}  // namespace

ShadowLens Renderer::Work::draw_shadows(const Scene& scene, const Lens& seen_by, int height) {
  if (!scene.flags.shadows || !scene.flags.lighting || scene.lights.empty() || scene.dimension == 2) return {};
  const SceneInstance* ground = ground_of(scene);
  Eigen::AlignedBox3f box;
  for (const SceneInstance& one : scene.instances) {
    if (!casts(one) || &one == ground) continue;
    const float radius = radius_of(one, scene.meshes[one.mesh]);
    const Vector3f center = one.transform.col(3);
    box.extend(center - Vector3f::Constant(radius));
    box.extend(center + Vector3f::Constant(radius));
  }
  if (box.isEmpty()) return {};
  int side = 0;
  const float finest = finest_scale(seen_by, box, static_cast<float>(height));
  const ShadowLens lens = lens_at(scene.lights[0].position.cast<float>(), box, finest, side);
  const Gl& gl = context.gl();
  if (!shadow || shadow->side() != side) shadow = std::make_unique<ShadowTarget>(gl, side);
  shadow->bind();
  gl.Viewport(0, 0, side, side);
  gl.Disable(GL_SCISSOR_TEST);
  gl.Enable(GL_DEPTH_TEST);
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  gl.Disable(GL_CULL_FACE);
  gl.Enable(GL_POLYGON_OFFSET_FILL);
  gl.PolygonOffset(1.6F, 5.0F);
  // How large spheres are in the map decides how finely they are drawn, as in a picture.
  const Vector3f eye = scene.lights[0].position.cast<float>();
  Lens sight;
  sight.eye = eye;
  sight.back = (eye - box.center()).normalized();
  sight.slope = lens.texel_slope * static_cast<float>(side) / 2;
  const Batches all = batch(scene, {&sight, static_cast<float>(side), true, false}, casts, ground);
  instances.fill(GL_ARRAY_BUFFER, all.instances.data(), all.instances.size() * sizeof(GpuInstance), GL_STREAM_DRAW);
  shaders.holes.use();
  shaders.holes.set("shadow_matrix", lens.matrix);
  shaders.holes.set("image", 0);
  shaders.depth.use();
  shaders.depth.set("shadow_matrix", lens.matrix);
  shaders.depth.set("eye", eye);
  for (const auto* batches : {&all.opaque, &all.transparent})
    for (const Batch& one : *batches) {
      const bool holes = one.texture != kNoTexture && scene.textures[one.texture].clear;
      const bool disc = !holes && one.mesh >= kDiscMesh;  // whatever is lit of a sphere is in front of its disc
      (holes ? shaders.holes : shaders.depth).use();
      if (holes) bind_texture(scene, one.texture, 0);
      if (!holes) shaders.depth.set("disc", disc ? 1.0F : 0.0F);
      // A coarse sphere lies within the one that is seen, which so does not shade itself.
      const std::uint32_t kind = disc ? kDiscMesh : std::min(one.mesh, kSphereMesh + 1);
      draw_pieces(mesh(scene, kind), one, false);
      ++counters.draw_calls;
    }
  gl.Disable(GL_POLYGON_OFFSET_FILL);
  return lens;
}

}  // namespace breve::render
