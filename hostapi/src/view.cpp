// What scripts want to be seen, as hosts read it.
#include <cmath>
#include <cstring>

#include "physical.hpp"
#include "runtime/store/image_resource.hpp"
#include "runtime/world/camera.hpp"
#include "runtime/world/drawing.hpp"
#include "steve/library/support.hpp"

using namespace breve::host;
using breve::CameraState;
using breve::ObjectId;
using breve::Vector3;
using breve::ViewState;

namespace {

const ViewState& view_of(const breve_world& world) { return std::as_const(*world.world).view(); }

breve_object living(const breve_world& world, ObjectId id) {
  return world.world->alive(id) ? handle_of(world, id) : breve_object{};
}

/// The native data of a live object: BREVE_ERROR_TYPE if it has none of that kind.
template <class R>
const R& resource(const breve_world& world, breve_object object, const char* what) {
  const auto& instance = live_instance(world, object);
  const R* found = breve::steve::resource_of<R>(*world.machine, &instance);
  if (!found) fail(BREVE_ERROR_TYPE, "the object is of class " + instance.cls->name + ", not " + what);
  return *found;
}

/// As cameras that are straight above their target know it: by their angles.
Vector3 up_of(const CameraState& camera) {
  return {std::sin(camera.pitch) * std::sin(camera.yaw), std::cos(camera.pitch),
          std::sin(camera.pitch) * std::cos(camera.yaw)};
}

breve_camera camera_of(const CameraState& camera, bool main) {
  breve_camera to = breve_camera_default();
  copy_to(to.location, camera.target + camera.offset);
  copy_to(to.target, camera.target);
  copy_to(to.up, up_of(camera));
  to.field_of_view = camera.field_of_view;
  to.far_plane = camera.far_plane;
  if (!main) {
    to.corner[0] = camera.x, to.corner[1] = camera.y;
    to.size[0] = camera.width, to.size[1] = camera.height;
  }
  to.enabled = camera.enabled;
  to.text = camera.text;
  return to;
}

}  // namespace

breve_status breve_object_look(const breve_world* world, breve_object object, breve_look* look) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const breve::Appearance& from = std::as_const(*world->world).bodies().appearance(live_body(*world, object));
    breve_look to = breve_look_default();
    copy_to(to.color, from.color);
    to.alpha = from.alpha;
    to.label = from.label.c_str();
    to.texture = living(*world, from.texture);
    to.bitmap = living(*world, from.bitmap);
    to.lightmap = living(*world, from.lightmap);
    to.texture_scale[0] = from.texture_scale_x, to.texture_scale[1] = from.texture_scale_y;
    to.bitmap_heading = from.bitmap_heading;
    to.visible = from.visible;
    to.shadows = from.shadows;
    to.as_point = from.as_point;
    to.bounding_box = from.bounding_box;
    to.axes = from.axis;
    to.neighbors = from.neighbor_lines;
    write_struct(look, to, "breve_look");
  });
}

breve_status breve_camera_state(const breve_world* world, breve_object camera, breve_camera* state) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (is_null(camera)) {
      write_struct(state, camera_of(view_of(*world).camera, true), "breve_camera");
      return;
    }
    const auto& found = resource<breve::CameraResource>(*world, camera, "a Camera");
    write_struct(state, camera_of(found.main ? view_of(*world).camera : found.state, found.main), "breve_camera");
  });
}

breve_status breve_world_view(const breve_world* world, breve_view* view) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const ViewState& from = view_of(*world);
    breve_view to = breve_view_default();
    copy_to(to.background, from.backdrop.color);
    to.backdrop = living(*world, from.backdrop.texture);
    to.backdrop_scroll[0] = from.backdrop.scroll_x, to.backdrop_scroll[1] = from.backdrop.scroll_y;
    copy_to(to.fog_color, from.fog.color);
    to.fog_start = from.fog.start, to.fog_end = from.fog.end;
    to.fog_intensity = from.fog.intensity;
    to.blur = from.flags.blur ? from.flags.blur_factor : 0;
    to.text_scale = from.text_scale;
    to.clears = from.clears;
    to.selection = living(*world, from.selection);
    to.fog = from.fog.enabled;
    to.lighting = from.flags.lighting;
    to.shadows = from.flags.shadows;
    to.shadow_volumes = from.flags.shadow_volumes;
    to.reflections = from.flags.reflections;
    to.blurs = from.flags.blur;
    to.outlines = from.flags.outline;
    to.texts = from.flags.text;
    write_struct(view, to, "breve_view");
  });
}

breve_status breve_world_light(const breve_world* world, size_t index, breve_light* light) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(light, "light");
    if (index >= breve::kLightCount) fail(BREVE_ERROR_NOT_FOUND, "there is no light " + std::to_string(index));
    const breve::LightState& from = view_of(*world).lights[index];
    copy_to(light->location, from.position);
    copy_to(light->ambient, from.ambient);
    copy_to(light->diffuse, from.diffuse);
    copy_to(light->specular, from.specular);
  });
}

breve_status breve_world_text(const breve_world* world, size_t index, breve_text* text) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(text, "text");
    if (index >= breve::kOverlayTextCount) fail(BREVE_ERROR_NOT_FOUND, "there is no text " + std::to_string(index));
    const breve::OverlayText& from = view_of(*world).texts[index];
    text->text = from.text.c_str();
    text->location[0] = from.x, text->location[1] = from.y;
    copy_to(text->color, from.color);
  });
}

breve_status breve_drawing_commands(const breve_world* world, breve_object drawing, breve_draw* commands,
                                    size_t capacity, size_t* count) {
  static_assert(static_cast<int>(breve::DrawCommand::Kind::EndPolygon) == BREVE_DRAW_END_POLYGON);
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    // A drawing that was not drawn on yet has no native data.
    const auto& instance = object_of_kind(*world, drawing, "Drawing");
    const auto* found = breve::steve::resource_of<breve::DrawingResource>(*world->machine, &instance);
    const std::pmr::deque<breve::DrawCommand> none;
    copy_list(found ? found->commands : none, commands, capacity, count, "commands",
              [](const breve::DrawCommand& from) {
                breve_draw to{};
                to.kind = static_cast<std::uint32_t>(from.kind);
                to.style = from.style;
                copy_to(to.from, from.from);
                copy_to(to.to, from.vector);
                to.value = from.value;
                return to;
              });
  });
}

breve_status breve_line_state(const breve_world* world, breve_object line, breve_line* state) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(state, "state");
    const auto& instance = object_of_kind(*world, line, "Line");
    const auto* from = breve::steve::resource_of<breve::LineResource>(*world->machine, &instance);
    const breve::LineResource unconnected;
    if (!from) from = &unconnected;
    breve_line to{};
    to.from = living(*world, from->from);
    to.to = living(*world, from->to);
    copy_to(to.color, from->color);
    to.alpha = from->alpha;
    to.style = from->style;
    *state = to;
  });
}

breve_status breve_image_pixels(const breve_world* world, breve_object image, void* pixels, size_t capacity,
                                uint32_t* width, uint32_t* height) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (capacity != 0) need(pixels, "pixels");
    need(width, "width");
    need(height, "height");
    const auto& instance = object_of_kind(*world, image, "Image");
    const auto* found = breve::steve::resource_of<breve::ImageResource>(*world->machine, &instance);
    if (found && !found->image.bytes().empty() && found->image.bytes().size() <= capacity)
      std::memcpy(pixels, found->image.bytes().data(), found->image.bytes().size());
    *width = found ? static_cast<std::uint32_t>(found->image.width()) : 0;
    *height = found ? static_cast<std::uint32_t>(found->image.height()) : 0;
  });
}
