// Bodies, drawings, lines, cameras and lights of a world as a scene.
#include "runtime/world/show.hpp"

#include <typeinfo>

#include "runtime/store/image_resource.hpp"
#include "runtime/world/drawing.hpp"

namespace breve {

namespace {

constexpr float kAxisWidth = 2;  // pixels
const Vector4f kBoundsColor(1.0F, 0.85F, 0.2F, 1.0F);
const Vector4f kNeighborColor(1.0F, 1.0F, 1.0F, 0.45F);

template <class R>
const R* resource_as(const World& world, ObjectId id) {
  const Resource* resource = world.resource(id);
  return resource && typeid(*resource) == typeid(R) ? static_cast<const R*>(resource) : nullptr;
}

// --- bodies ----------------------------------------------------------------------------------------------------------

Transform transform_of(const Vector3f& location, const Matrix3& rotation, const Vector3f& scale) {
  Transform transform;
  transform.leftCols<3>() = rotation.cast<float>() * scale.asDiagonal();
  transform.col(3) = location;
  return transform;
}

void show_axes(const Matrix3& rotation, const Vector3f& center, float length, SceneBuilder& to) {
  const Vector4f colors[] = {{0.9F, 0.2F, 0.2F, 1}, {0.2F, 0.75F, 0.25F, 1}, {0.25F, 0.4F, 0.95F, 1}};
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3f way = rotation.col(axis).cast<float>() * length;
    to.scene().lines.push_back({center, center + way, colors[axis], kAxisWidth, 0xffff});
  }
}

void show_neighbors(World& world, ObjectId id, const Vector3f& center, SceneBuilder& to) {
  for (const ObjectId other : world.neighbors(id)) {
    if (!world.has_body(other)) continue;
    to.scene().lines.push_back({center, drawable(world.bodies().location(world.body(other))), kNeighborColor});
  }
}

void show_sprite(const World& world, const Appearance& look, ObjectId image, bool glow, SceneSprite sprite,
                 SceneBuilder& to) {
  sprite.texture = show_image(world, image, to);
  if (sprite.texture == kNoTexture) return;
  sprite.heading = static_cast<float>(look.bitmap_heading);
  sprite.glow = glow;
  to.scene().sprites.push_back(sprite);
}

void show_body(World& world, ObjectId id, SceneBuilder& to) {
  const Bodies& bodies = world.bodies();
  const BodyIndex body = world.body(id);
  const Appearance& look = bodies.appearance(body);
  const auto& shape = bodies.display_shape(body);
  if (!shape) return;
  const Vector3f center = drawable(bodies.location(body));
  const float radius = drawable(shape->bounding_radius());
  if (!look.label.empty()) to.scene().labels.push_back({id, center + Vector3f(0, radius, 0), look.label});
  if (look.bounding_box) {
    const Eigen::AlignedBox3d box = shape->bounds(bodies.rotation(body));
    to.add_box(center + drawable(Vector3(box.min())), center + drawable(Vector3(box.max())), kBoundsColor);
  }
  if (look.axis) show_axes(bodies.rotation(body), center, 1.5F * radius, to);
  if (look.neighbor_lines) show_neighbors(world, id, center, to);
  if (!look.visible) return;
  const Vector4f color = color_of(look.color, look.alpha);
  SceneSprite sprite{id, center, 2 * radius, 0, color};
  if (look.lightmap) show_sprite(world, look, look.lightmap, true, sprite, to);
  if (look.as_point) {
    sprite.point = true;
    sprite.size = 4;
    to.scene().sprites.push_back(sprite);
    return;
  }
  if (look.bitmap) return show_sprite(world, look, look.bitmap, false, sprite, to);
  if (look.lightmap) return;
  const MeshUse mesh = to.mesh(*shape);
  SceneInstance instance{id, transform_of(center, bodies.rotation(body), mesh.scale), color};
  instance.mesh = mesh.mesh;
  instance.texture = show_image(world, look.texture, to);
  instance.texture_scale = {drawable(look.texture_scale_x), drawable(look.texture_scale_y)};
  instance.shadow = look.shadows;
  instance.fixed = bodies.kind(body) == BodyKind::Stationary;
  to.scene().instances.push_back(instance);
}

// --- what scripts draw -----------------------------------------------------------------------------------------------

void show_polygon(std::vector<Vector3f>& corners, const Vector4f& color, SceneBuilder& to) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    for (const Vector3f& corner : {corners[0], corners[i], corners[i + 1]})
      to.scene().triangles.push_back({corner, color});
  corners.clear();
}

void show_drawing(const DrawingResource& drawing, SceneBuilder& to) {
  SceneLine line{Vector3f::Zero(), Vector3f::Zero(), {0, 0, 0, 1}, 1, 0xffff};
  std::vector<Vector3f> polygon;
  for (const DrawCommand& command : drawing.commands) {
    if (command.kind != DrawCommand::Kind::PolygonPoint) show_polygon(polygon, line.color, to);
    switch (command.kind) {
      case DrawCommand::Kind::Color: line.color = color_of(command.vector, command.value); break;
      case DrawCommand::Kind::LineWidth: line.width = drawable(command.value); break;
      case DrawCommand::Kind::LineStyle: line.pattern = command.style; break;
      case DrawCommand::Kind::PolygonPoint: polygon.push_back(drawable(command.vector)); break;
      case DrawCommand::Kind::EndPolygon: break;
      case DrawCommand::Kind::Line:
        line.from = drawable(command.from);
        line.to = drawable(command.vector);
        if (line.color.w() > 0) to.scene().lines.push_back(line);
    }
  }
  show_polygon(polygon, line.color, to);
}

void show_line(const World& world, const LineResource& line, SceneBuilder& to) {
  if (!world.has_body(line.from) || !world.has_body(line.to)) return;
  const Bodies& bodies = world.bodies();
  to.scene().lines.push_back({drawable(bodies.location(world.body(line.from))),
                              drawable(bodies.location(world.body(line.to))), color_of(line.color, line.alpha), 1.5F,
                              line.style});
}

// --- cameras, lights, backdrop ---------------------------------------------------------------------------------------

/// As Control and PhysicalControl leave it: then the program has not said what it wants to see.
bool is_untouched(const ViewState& view) {
  const CameraState& camera = view.camera;
  const bool at_first = camera.offset == Vector3(0, 0, 30) || camera.offset == Vector3(0, 10, 30);
  return at_first && camera.target == Vector3(0, 0, 0) && !camera.watched && view.offset_pan.steps == 0 &&
         view.target_pan.steps == 0;
}

SceneCamera camera_of(const CameraState& state) {
  SceneCamera camera;
  camera.target = state.target;
  camera.offset = state.offset;
  camera.pitch = state.pitch;
  camera.yaw = state.yaw;
  camera.field_of_view = state.field_of_view;
  camera.far_plane = state.far_plane;
  camera.text = state.text;
  return camera;
}

void show_main_camera(const World& world, SceneBuilder& to) {
  SceneCamera camera = camera_of(world.view().camera);
  camera.automatic = is_untouched(world.view());
  camera.orthographic = world.dimension() == 2;
  if (camera.orthographic) {
    // The plane is seen from straight ahead, wherever the camera was put.
    camera.pitch = camera.yaw = 0;
    camera.offset = {0, 0, camera.offset.norm()};
  }
  to.scene().cameras.push_back(camera);
}

void show_window(ObjectId id, const CameraResource& resource, SceneBuilder& to) {
  if (resource.main) return;
  SceneCamera camera = camera_of(resource.state);
  camera.object = id;
  camera.x = resource.state.x;
  camera.y = resource.state.y;
  camera.width = resource.state.width;
  camera.height = resource.state.height;
  to.scene().cameras.push_back(camera);
}

/// What the light exposure source sees, in a window at the lower left.
void show_exposure(const World& world, SceneBuilder& to) {
  const LightExposureState& light = world.view().light_exposure;
  if (!light.drawing || world.dimension() == 2) return;
  constexpr double kWindow = 96, kMargin = 6;  // pixels
  CameraState state;
  state.set_offset(light.source.norm() > 0 ? light.source : Vector3(0, 1, 0));
  state.set_far_plane(4 * state.distance() + 1000);
  SceneCamera camera = camera_of(state);
  camera.text = false;
  camera.x = camera.y = kMargin;
  camera.width = camera.height = kWindow;
  to.scene().cameras.push_back(camera);
}

/// Light 0 is on; another one once a program has placed or coloured it.
void show_lights(const ViewState& view, SceneBuilder& to) {
  const LightState none;
  for (std::size_t i = 0; i < view.lights.size(); ++i) {
    const LightState& light = view.lights[i];
    const bool same = light.position == none.position && light.ambient == none.ambient &&
                      light.diffuse == none.diffuse && light.specular == none.specular;
    if (i > 0 && same) continue;
    to.scene().lights.push_back({light.position, color_of(light.ambient, 1).head<3>(),
                                 color_of(light.diffuse, 1).head<3>(), color_of(light.specular, 1).head<3>()});
  }
}

void show_backdrop(const World& world, SceneBuilder& to) {
  const BackdropState& state = world.view().backdrop;
  SceneBackdrop& backdrop = to.scene().backdrop;
  backdrop.color = color_of(state.color, 1).head<3>();
  backdrop.texture = show_image(world, state.texture, to);
  backdrop.scroll_x = drawable(state.scroll_x * static_cast<double>(world.iteration()));
  backdrop.scroll_y = drawable(state.scroll_y * static_cast<double>(world.iteration()));
  backdrop.mountains = state.mountains;
  if (!state.skybox.empty())
    for (std::size_t i = 0; i < state.sides.size(); ++i) backdrop.skybox[i] = show_image(world, state.sides[i], to);
  const FogState& fog = world.view().fog;
  to.scene().fog = {fog.enabled, drawable(fog.start), drawable(fog.end), drawable(fog.intensity),
                    color_of(fog.color, 1).head<3>()};
}

void show_flags(const ViewState& view, SceneBuilder& to) {
  const DrawingFlags& flags = view.flags;
  to.scene().flags = {flags.lighting,
                      (flags.shadows && flags.shadow_catcher) || flags.shadow_volumes,
                      flags.reflections && flags.shadow_catcher,
                      flags.outline,
                      flags.text,
                      flags.blur,
                      drawable(flags.blur_factor),
                      drawable(view.text_scale),
                      view.clears,
                      flags.every_frame};
  for (const OverlayText& text : view.texts) {
    if (text.text.empty()) continue;
    to.scene().texts.push_back(
        {std::string(text.text), drawable(text.x), drawable(text.y), color_of(text.color, 1).head<3>()});
  }
}

}  // namespace

std::uint32_t show_image(const World& world, ObjectId image, SceneBuilder& scene) {
  const auto* resource = image ? resource_as<ImageResource>(world, image) : nullptr;
  if (!resource) return kNoTexture;
  return scene.texture(image, resource->image.width(), resource->image.height(), resource->image.bytes());
}

void show(World& world, SceneBuilder& scene) {
  Scene& to = scene.scene();
  to.dimension = world.dimension();
  to.time = world.time();
  to.iteration = world.iteration();
  show_main_camera(world, scene);
  show_lights(world.view(), scene);
  show_backdrop(world, scene);
  show_flags(world.view(), scene);
  for (const ObjectId id : world.objects()) {
    if (world.has_body(id)) show_body(world, id, scene);
    if (const auto* camera = resource_as<CameraResource>(world, id)) show_window(id, *camera, scene);
    if (const auto* drawing = resource_as<DrawingResource>(world, id)) show_drawing(*drawing, scene);
    if (const auto* line = resource_as<LineResource>(world, id)) show_line(world, *line, scene);
  }
  show_exposure(world, scene);
}

}  // namespace breve
