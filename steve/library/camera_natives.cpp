// Natives of Camera. The main camera's state is the view's; any other's is its own resource.
#include <cmath>

#include "runtime/world/camera.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

CameraResource& resource(Machine& machine, Instance& self) { return resource_made<CameraResource>(machine, self); }

CameraState& state(Machine& machine, Instance& self) {
  CameraResource& own = resource(machine, self);
  return own.main ? machine.world().view().camera : own.state;
}

void camera_init(Machine& machine, Instance& self) {
  CameraState& camera = resource(machine, self).state;
  camera.set_target({1, 0, 0});
  camera.set_offset({-1, 0, 0});
}

void camera_become_main(Machine& machine, Instance& self) { resource(machine, self).main = true; }

/// The main camera is aimed by the controller, before it advances the world.
void camera_iterate(Machine& machine, Instance& self) {
  CameraResource& own = resource(machine, self);
  if (own.main || !own.state.watched) return;
  const World& world = machine.world();
  if (!world.alive(own.state.watched))
    own.state.watched = {};
  else if (world.has_body(own.state.watched))
    own.state.set_target(world.bodies().location(world.body(own.state.watched)));
}

void camera_no_effect(Machine&, Instance&) {}
void camera_enable_text(Machine& machine, Instance& self) { state(machine, self).text = true; }
void camera_disable_text(Machine& machine, Instance& self) { state(machine, self).text = false; }

void camera_watch(Machine& machine, Instance& self, Instance* object) {
  state(machine, self).watched = machine.id_of(object);
}

double camera_get_width(Machine& machine, Instance& self) { return state(machine, self).width; }
double camera_get_height(Machine& machine, Instance& self) { return state(machine, self).height; }

void camera_set_size(Machine& machine, Instance& self, double height, double width) {
  if (!(height >= 0) || !(width >= 0) || !std::isfinite(height + width))
    throw Error(ErrorCode::Argument, "a camera's size must be finite and not negative");
  CameraState& camera = state(machine, self);
  camera.height = height;
  camera.width = width;
}

void camera_set_position(Machine& machine, Instance& self, double x, double y) {
  CameraState& camera = state(machine, self);
  camera.x = finite(x, "a camera's position");
  camera.y = finite(y, "a camera's position");
}

void camera_look(Machine& machine, Instance& self, Vector3 target, Vector3 location) {
  CameraState& camera = state(machine, self);
  camera.set_target(target);
  camera.set_offset(location - target);
}

void camera_set_z_clip(Machine& machine, Instance& self, double distance) {
  state(machine, self).set_far_plane(distance);
}

Vector3 camera_get_position(Machine& machine, Instance& self) {
  const CameraState& camera = state(machine, self);
  return resource(machine, self).main ? camera.offset : Vector3(camera.target + camera.offset);
}

Vector3 camera_get_rotation(Machine& machine, Instance& self) {
  const CameraState& camera = state(machine, self);
  return {camera.pitch, camera.yaw, 0};
}

void camera_set_rotation(Machine& machine, Instance& self, double pitch, double yaw) {
  state(machine, self).set_angles(pitch, yaw);
}

void camera_delete(Machine& machine, Instance& self) { resource(machine, self).state.watched = {}; }

constexpr Native kCameraNatives[] = {
    native<camera_init>("camera.init"),
    native<camera_become_main>("camera.become-main-camera"),
    native<camera_iterate>("camera.iterate"),
    native<camera_no_effect>("camera.disable"),
    native<camera_no_effect>("camera.enable"),
    native<camera_enable_text>("camera.enable-text"),
    native<camera_disable_text>("camera.disable-text"),
    native<camera_watch>("camera.watch"),
    native<camera_get_width>("camera.get-width"),
    native<camera_get_height>("camera.get-height"),
    native<camera_set_size>("camera.set-size"),
    native<camera_set_position>("camera.set-position"),
    native<camera_look>("camera.look"),
    native<camera_set_z_clip>("camera.set-z-clip"),
    native<camera_get_position>("camera.get-position"),
    native<camera_get_rotation>("camera.get-rotation"),
    native<camera_set_rotation>("camera.set-rotation"),
    native<camera_delete>("camera.delete"),
};

}  // namespace

std::span<const Native> camera_natives() { return kCameraNatives; }

}  // namespace breve::steve
