// Pictures of worlds.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>

#include "physical.hpp"
#include "runtime/store/image.hpp"
#include "scene.hpp"
#include "steve/library/show.hpp"
#ifdef BREVE_WITH_RENDER
#include "runtime/render/renderer.hpp"
#endif

using namespace breve::host;

#ifdef BREVE_WITH_RENDER

namespace breve::host {

namespace {

/// The view of a world that draws itself, made when it draws first.
class OwnView {
 public:
  const steve::DrawnView& draw(steve::Machine& machine, const steve::ViewPart& part) {
    constexpr int kWidth = 640, kHeight = 480;
    scene_.poll = machine.poller();
    steve::show(machine, scene_);
    const PicturePart needed{part.left, part.top, part.width, part.height};
    renderer_.set_meter([&machine](std::uint64_t units) { machine.charge(units); });
    renderer_.set_part(part.width != 0 ? std::optional(needed) : std::nullopt);
    renderer_.paint(scene_.scene(), kWidth, kHeight, picture_);
    drawn_ = {picture_.width, picture_.height, picture_.rgba, picture_.depth};
    return drawn_;
  }

 private:
  render::Renderer renderer_;
  SceneBuilder scene_;
  Picture picture_;
  steve::DrawnView drawn_;
};

}  // namespace

void let_draw(breve_world& world, steve::MachineHost& host) {
  const auto view = std::make_shared<std::optional<OwnView>>();
  host.draw = [&world, view](const steve::ViewPart& part) -> const steve::DrawnView& {
    if (!*view) view->emplace();
    try {
      return (*view)->draw(*world.machine, part);
    } catch (...) {
      view->reset();  // a picture that was begun is not gone on with
      throw;
    }
  };
}

}  // namespace breve::host

struct breve_view {
  breve_view_config config;
  breve::render::Renderer renderer;
  breve::SceneBuilder scene;
  breve::Picture picture;
  breve::steve::Arrows arrows;
  bool drawn = false;

  breve_view(const breve_view_config& given, const breve::render::Settings& settings)
      : config(given), renderer(settings) {}
};

namespace {

constexpr std::uint32_t kMostSide = 16384;

breve::render::ForeignContext context_of(const breve_gl& gl) {
  if (!gl.make_current || !gl.address) fail(BREVE_ERROR_ARGUMENT, "breve_gl.make_current and .address must be given");
  return {[gl](bool current) { return gl.make_current(gl.user, current); },
          [gl](const char* name) { return gl.address(gl.user, name); }};
}

breve::render::Settings settings_of(const breve_view_config& config) {
  if (config.width == 0 || config.height == 0 || config.width > kMostSide || config.height > kMostSide)
    fail(BREVE_ERROR_ARGUMENT, "a picture of " + std::to_string(config.width) + " x " + std::to_string(config.height) +
                                   " pixels cannot be drawn: each side must be from 1 to " + std::to_string(kMostSide));
  if (config.samples != 1 && config.samples != 2 && config.samples != 4)
    fail(BREVE_ERROR_ARGUMENT, "samples is " + std::to_string(config.samples) + " (must be 1, 2 or 4)");
  if (config.look > BREVE_LOOK_PLAIN)
    fail(BREVE_ERROR_ARGUMENT, "look is " + std::to_string(config.look) + ", which is not a breve_look");
  breve::render::Settings settings;
  settings.samples = static_cast<int>(config.samples);
  settings.look = config.look == BREVE_LOOK_PLAIN ? breve::render::Look::Plain : breve::render::Look::Full;
  if (config.font) settings.font = config.font;
  if (config.gl) settings.context = context_of(*config.gl);
  return settings;
}

/// Bytes from one row to the next. BREVE_ERROR_ARGUMENT if they do not hold `row` bytes.
std::size_t stride_of(std::size_t given, std::size_t row) {
  if (given != 0 && given < row)
    fail(BREVE_ERROR_ARGUMENT, "stride is " + std::to_string(given) + " bytes, but a row takes " + std::to_string(row));
  return given != 0 ? given : row;
}

void need_picture(const breve_view& view) {
  if (!view.drawn) fail(BREVE_ERROR_NOT_FOUND, "the view has drawn no picture yet");
}

}  // namespace

breve_status breve_view_create(breve_runtime* runtime, const breve_view_config* config, breve_view** view) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  return guard(runtime->error, [&] {
    need(view, "view");
    const breve_view_config all = read_config(config, breve_view_config_default(), "breve_view_config");
    auto made = std::make_unique<breve_view>(all, settings_of(all));
    made->config.font = nullptr;  // the host's, as is the next
    made->config.gl = nullptr;
    *view = made.release();
  });
}

void breve_view_destroy(breve_view* view) { delete view; }

breve_status breve_view_render(breve_view* view, breve_world* world, uint8_t* rgba, size_t stride) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(view, "view");
    need(rgba, "rgba");
    const std::size_t row = 4 * std::size_t{view->config.width};
    const std::size_t step = stride_of(stride, row);
    breve::steve::show(*world->machine, view->scene, view->arrows);
    view->renderer.paint(view->scene.scene(), static_cast<int>(view->config.width),
                         static_cast<int>(view->config.height), view->picture);
    view->drawn = true;
    for (std::size_t y = 0; y < view->config.height; ++y)
      std::memcpy(rgba + y * step, view->picture.rgba.data() + y * row, row);
  });
}

breve_status breve_view_depth(const breve_view* view, float* depth, size_t stride) {
  return guard([&] {
    need(view, "view");
    need(depth, "depth");
    const std::size_t row = view->config.width;
    const std::size_t step = stride_of(stride, row * sizeof(float));
    if (step % sizeof(float) != 0) fail(BREVE_ERROR_ARGUMENT, "stride is not a multiple of 4");
    need_picture(*view);
    for (std::size_t y = 0; y < view->config.height; ++y)
      std::copy_n(view->picture.depth.data() + y * row, row, depth + y * (step / sizeof(float)));
  });
}

breve_status breve_view_set_camera(breve_view* view, const breve_camera* camera) {
  return guard([&] {
    need(view, "view");
    view->renderer.set_camera(camera ? std::optional(from_host(*camera)) : std::nullopt);
  });
}

breve_status breve_view_set_arrows(breve_view* view, uint32_t arrows, double scale) {
  return guard([&] {
    need(view, "view");
    constexpr std::uint32_t kAll =
        BREVE_ARROWS_CONTACTS | BREVE_ARROWS_FORCES | BREVE_ARROWS_VELOCITIES | BREVE_ARROWS_JOINTS;
    if ((arrows & ~kAll) != 0) fail(BREVE_ERROR_ARGUMENT, "arrows has bits that are not a breve_arrows");
    if (!std::isfinite(scale) || !(scale > 0)) fail(BREVE_ERROR_ARGUMENT, "the scale of the arrows is not above 0");
    view->arrows = {(arrows & BREVE_ARROWS_CONTACTS) != 0, (arrows & BREVE_ARROWS_FORCES) != 0,
                    (arrows & BREVE_ARROWS_VELOCITIES) != 0, (arrows & BREVE_ARROWS_JOINTS) != 0, scale};
  });
}

breve_status breve_view_arrows(const breve_view* view, uint32_t* arrows, double* scale) {
  return guard([&] {
    need(view, "view");
    need(arrows, "arrows");
    need(scale, "scale");
    *arrows = (view->arrows.contacts ? std::uint32_t{BREVE_ARROWS_CONTACTS} : 0) |
              (view->arrows.forces ? std::uint32_t{BREVE_ARROWS_FORCES} : 0) |
              (view->arrows.velocities ? std::uint32_t{BREVE_ARROWS_VELOCITIES} : 0) |
              (view->arrows.joints ? std::uint32_t{BREVE_ARROWS_JOINTS} : 0);
    *scale = view->arrows.scale;
  });
}

breve_status breve_view_camera(const breve_view* view, breve_camera* camera) {
  return guard([&] {
    need(view, "view");
    need(camera, "camera");
    need_picture(*view);
    *camera = to_host(view->renderer.camera());
  });
}

breve_status breve_view_counts(const breve_view* view, breve_view_counters* counters) {
  return guard([&] {
    need(view, "view");
    const breve::render::Counters& last = view->renderer.counters();
    breve_view_counters filled{};
    filled.draw_calls = last.draw_calls;
    filled.instances = last.instances;
    filled.triangles = last.triangles;
    filled.uploads = last.uploads;
    write_struct(counters, filled, "breve_view_counters");
  });
}

#else

void breve::host::let_draw(breve_world&, steve::MachineHost&) {}

breve_status breve_view_create(breve_runtime* runtime, const breve_view_config*, breve_view**) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  return guard(runtime->error, [] { fail(BREVE_ERROR_UNSUPPORTED, "this library was built without drawing"); });
}
// There is no view to give them.
void breve_view_destroy(breve_view*) {}
breve_status breve_view_render(breve_view*, breve_world*, uint8_t*, size_t) { return BREVE_ERROR_ARGUMENT; }
breve_status breve_view_depth(const breve_view*, float*, size_t) { return BREVE_ERROR_ARGUMENT; }
breve_status breve_view_set_camera(breve_view*, const breve_camera*) { return BREVE_ERROR_ARGUMENT; }
breve_status breve_view_set_arrows(breve_view*, uint32_t, double) { return BREVE_ERROR_ARGUMENT; }
breve_status breve_view_arrows(const breve_view*, uint32_t*, double*) { return BREVE_ERROR_ARGUMENT; }
breve_status breve_view_camera(const breve_view*, breve_camera*) { return BREVE_ERROR_ARGUMENT; }
breve_status breve_view_counts(const breve_view*, breve_view_counters*) { return BREVE_ERROR_ARGUMENT; }

#endif

breve_status breve_png(uint32_t width, uint32_t height, const uint8_t* rgba, size_t stride, uint8_t* bytes,
                       size_t capacity, size_t* size) {
  return guard([&] {
    need(rgba, "rgba");
    need(size, "size");
    if (capacity != 0) need(bytes, "bytes");
    constexpr auto kMost = static_cast<std::uint32_t>(breve::Image::kMaxSide);
    if (width == 0 || height == 0 || width > kMost || height > kMost)
      fail(BREVE_ERROR_ARGUMENT, "a side of the picture is not from 1 to " + std::to_string(kMost));
    const std::size_t row = 4 * std::size_t{width};
    if (stride != 0 && stride < row) fail(BREVE_ERROR_ARGUMENT, "stride is less than a row of the picture");
    const std::size_t step = stride != 0 ? stride : row;
    const std::string file = breve::make_png(
        breve::PngKind::Rgba8, static_cast<int>(width), static_cast<int>(height),
        [&](std::size_t y, std::span<std::uint8_t> to) { std::memcpy(to.data(), rgba + y * step, row); }, {});
    if (file.size() <= capacity) std::copy(file.begin(), file.end(), bytes);
    *size = file.size();
  });
}
