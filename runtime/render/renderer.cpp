// A picture, from top to bottom: shadows, reflection, backdrop, bodies, marks, text; then it is read back.
#include "runtime/render/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/base/error.hpp"
#include "runtime/render/work.hpp"

namespace breve::render {

namespace {

Mirror mirror_of(const Scene& scene) {
  const SceneInstance* ground = scene.flags.reflections && scene.dimension == 3 ? ground_of(scene) : nullptr;
  if (!ground || scene.meshes[ground->mesh].form != SceneMesh::Form::Box) return {};
  return {true, ground->transform(1, 3) + ground->transform.row(1).head<3>().cwiseAbs().sum() / 2};
}

bool moves(const SceneInstance& instance) { return !instance.fixed; }

/// A number of a window. No picture is as large as a million pixels: numbers beyond that are as far outside.
int pixel_of(double number) {
  constexpr double kFar = 1e6;
  return number > -kFar ? static_cast<int>(std::min(number, kFar)) : static_cast<int>(-kFar);
}

Window common(const Window& a, const Window& b) {
  const int left = std::max(a.left, b.left), bottom = std::max(a.bottom, b.bottom);
  return {left, bottom, std::min(a.left + a.width, b.left + b.width) - left,
          std::min(a.bottom + a.height, b.bottom + b.height) - bottom};
}

/// The part of a picture that must be drawn. Motion blur mixes whole pictures and therefore needs all of it.
Window needed_of(const std::optional<PicturePart>& part, const Scene& scene, int width, int height) {
  const Window all{0, 0, width, height};
  if (!part || scene.flags.blur) return all;
  return common(all, {part->left, height - part->top - part->height, part->width, part->height});
}

Lens mirrored(Lens lens, float height) {
  Matrix4f mirror = Matrix4f::Identity();
  mirror(1, 1) = -1;
  mirror(1, 3) = 2 * height;
  lens.view = lens.view * mirror;
  return lens;
}

}  // namespace

Renderer::Work::Work(const Settings& given)
    : settings(given),
      context(settings.context ? &*settings.context : nullptr),
      use(std::in_place, context),
      shaders(context.gl()),
      marks(context.gl(), settings.font),
      instances(context.gl()),
      nothing(context.gl()) {
  const Gl& gl = context.gl();
  gl.Enable(GL_FRAMEBUFFER_SRGB);
  gl.Enable(GL_MULTISAMPLE);
  gl.Enable(GL_BLEND);
  gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl.DepthFunc(GL_LEQUAL);
  use.reset();
}

Renderer::Work::~Work() {
  try {
    use.emplace(context);
  } catch (const Error&) {
    context.abandon();  // the host's is gone, and everything in it
  }
}

void Renderer::Work::paint_reflection(Pass pass) {
  const Gl& gl = context.gl();
  if (!reflection || reflection->width() != pass.width || reflection->height() != pass.height)
    reflection = std::make_unique<Target>(gl, pass.width, pass.height, 1);
  reflection->bind();
  gl.Viewport(0, 0, pass.width, pass.height);
  gl.Disable(GL_SCISSOR_TEST);
  gl.Enable(GL_DEPTH_TEST);
  gl.ClearColor(0, 0, 0, 0);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  const Lens lens = mirrored(*pass.lens, pass.mirror.height);
  pass.lens = &lens;
  pass.reflected = true;
  gl.FrontFace(GL_CW);
  gl.Enable(GL_CLIP_DISTANCE0);
  gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  draw_bodies(pass, moves);
  gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl.Disable(GL_CLIP_DISTANCE0);
  gl.FrontFace(GL_CCW);
  reflection->resolve();
}

void Renderer::Work::paint_camera(const Scene& scene, const SceneCamera& camera, int width, int height) {
  const Gl& gl = context.gl();
  const bool window = camera.width > 0 && camera.height > 0;
  const int left = window ? pixel_of(camera.x) : 0, bottom = window ? pixel_of(camera.y) : 0;
  if (window) {
    width = pixel_of(camera.width);
    height = pixel_of(camera.height);
  }
  const Window cut = common({left, bottom, width, height}, needed);
  if (cut.empty()) return;
  const Lens lens = lens_of(camera, static_cast<double>(width) / height);
  Pass pass{&scene, &camera, &lens, width, height, ground_of(scene), shadows, mirror_of(scene)};
  for (const SceneSheet& sheet : scene.sheets)
    if (sheet.clear) pass.clear_sheets.push_back(sheet.corner.z());
  std::sort(pass.clear_sheets.begin(), pass.clear_sheets.end());
  if (window || left != 0 || bottom != 0) pass.mirror.on = false;  // its image is as large as the whole picture
  if (pass.mirror.on) paint_reflection(pass);
  target->bind();
  gl.Viewport(left, bottom, width, height);
  gl.Enable(GL_SCISSOR_TEST);
  gl.Scissor(cut.left, cut.bottom, cut.width, cut.height);
  gl.ClearColor(0, 0, 0, 1);
  gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  const Canvas canvas{&lens, width, height, &counters.draw_calls, &scene.fog, meter};
  draw_backdrop(pass);
  (scene.dimension == 2) ? draw_flat_layers(pass, canvas) : draw_layers(pass, canvas);
  gl.DepthMask(GL_FALSE);
  gl.Disable(GL_DEPTH_TEST);
  marks.draw_arrows(shaders, scene.arrows, canvas);
  // In a lower picture letters would cover what is to be seen. The program decides about its windows.
  constexpr int kLeastForWords = 64;  // pixels
  const bool words = window || height >= kLeastForWords, overlay = words && scene.flags.text && camera.text;
  if (words) marks.draw_labels(shaders, scene, canvas);
  if (overlay) marks.draw_texts(shaders, scene, canvas);
  if (overlay && !window) marks.draw_plots(shaders, scene, canvas);
  gl.DepthMask(GL_TRUE);
  gl.Enable(GL_DEPTH_TEST);
}

/// Outside of the windows: scripts read the pixels inside. Windows that are drawn afterwards cover those of others.
void Renderer::Work::frame_windows(const Scene& scene, int width, int height) {
  const Gl& gl = context.gl();
  const Vector4f color(0.55F, 0.60F, 0.66F, 1);
  std::vector<SceneLine> edges;
  for (std::size_t i = 1; i < scene.cameras.size(); ++i) {
    const SceneCamera& camera = scene.cameras[i];
    if (camera.width < 1 || camera.height < 1) continue;
    const auto left = static_cast<float>(pixel_of(camera.x)) - 0.5F,
               right = left + static_cast<float>(pixel_of(camera.width)) + 1,
               low = static_cast<float>(height - pixel_of(camera.y)) + 0.5F,
               high = low - static_cast<float>(pixel_of(camera.height)) - 1;
    const Vector3f corners[] = {{left, low, 0}, {right, low, 0}, {right, high, 0}, {left, high, 0}};
    for (std::size_t k = 0; k < 4; ++k) edges.push_back({corners[k], corners[(k + 1) % 4], color, 1});
  }
  if (edges.empty()) return;
  gl.Viewport(0, 0, width, height);
  gl.Scissor(needed.left, needed.bottom, std::max(0, needed.width), std::max(0, needed.height));
  gl.Disable(GL_DEPTH_TEST);
  Canvas canvas{nullptr, width, height, &counters.draw_calls};
  const Lens lens = pixel_lens(canvas);
  canvas.lens = &lens;
  marks.draw_lines(shaders, edges, canvas);
  gl.Enable(GL_DEPTH_TEST);
}

void Renderer::Work::read(const Lens& lens, Picture& picture) {
  // Copying keeps to the scissor, which is that of the last camera.
  context.gl().Scissor(needed.left, needed.bottom, std::max(0, needed.width), std::max(0, needed.height));
  target->resolve();
  target->read(picture.rgba);
  target->read_depth(picture.depth);
  for (float& depth : picture.depth) depth = depth >= 1 ? std::numeric_limits<float>::infinity() : lens.distance(depth);
}

void Renderer::Work::blur(const Scene& scene, Picture& picture) {
  if (!scene.flags.blur || last_clears != scene.flags.clears || last_picture.size() != picture.rgba.size()) {
    last_picture.clear();
    if (scene.flags.blur) last_picture = picture.rgba;
    last_clears = scene.flags.clears;
    return;
  }
  const float part = std::clamp(scene.flags.blur_factor, 0.0F, 1.0F);
  for (std::size_t i = 0; i < last_picture.size(); ++i) {
    const auto old = static_cast<float>(last_picture[i]), now = static_cast<float>(picture.rgba[i]);
    last_picture[i] = static_cast<std::uint8_t>(std::lround(old + part * (now - old)));
  }
  picture.rgba = last_picture;
}

void Renderer::Work::paint(const Scene& scene, int width, int height, Picture& picture) {
  const Context::Use current(context);
  counters = {};
  if (!target || target->width() != width || target->height() != height) {
    target.reset();
    target = std::make_unique<Target>(context.gl(), width, height, settings.samples);
  }
  needed = needed_of(part, scene, width, height);
  const double aspect = static_cast<double>(width) / height;
  if (scene.cameras.empty()) throw Error(ErrorCode::Argument, "the scene has no camera");
  last_camera = own_camera ? *own_camera : framed(scene, scene.cameras[0], aspect, framing, poll());
  shadows = draw_shadows(scene, lens_of(last_camera, aspect), height);
  paint_camera(scene, last_camera, width, height);
  if (settings.look == Look::Full) frame_windows(scene, width, height);
  for (std::size_t i = 1; i < scene.cameras.size(); ++i)
    if (scene.cameras[i].width >= 1 && scene.cameras[i].height >= 1)
      paint_camera(scene, scene.cameras[i], width, height);
  picture.width = width;
  picture.height = height;
  read(lens_of(last_camera, aspect), picture);
  blur(scene, picture);
}

Renderer::Renderer(const Settings& settings) : work_(std::make_unique<Work>(settings)) {}
Renderer::~Renderer() = default;

void Renderer::paint(const Scene& scene, int width, int height, Picture& picture) {
  work_->paint(scene, width, height, picture);
}

void Renderer::set_meter(CostMeter meter) { work_->meter = std::move(meter); }

void Renderer::set_camera(const std::optional<SceneCamera>& camera) { work_->own_camera = camera; }
void Renderer::set_part(const std::optional<PicturePart>& part) { work_->part = part; }
const SceneCamera& Renderer::camera() const { return work_->last_camera; }
const Counters& Renderer::counters() const { return work_->counters; }

}  // namespace breve::render
