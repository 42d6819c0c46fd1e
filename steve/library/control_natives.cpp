// Natives of Control that move the simulation: the clock, the step, selection, the main camera and its pans.
#include <algorithm>
#include <vector>

#include "steve/library/motors.hpp"
#include "steve/library/pictures.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

ViewState& view_of(Machine& machine) { return machine.world().view(); }

// --- clock and step --------------------------------------------------------------------------------------------------

/// Where a watched object is: its body's centre, or what its get-location says. False if it has neither.
bool location_of(Machine& machine, ObjectId id, Vector3& location) {
  World& world = machine.world();
  if (world.has_body(id)) {
    location = world.bodies().location(world.body(id));
    return true;
  }
  Instance* object = machine.instance(id);
  const MethodInfo* method = object ? machine.find_method(*object->cls, "get-location", 0) : nullptr;
  if (!method) return false;
  const Value value = machine.call(*object, *method);
  if (value.tag != Tag::Vector) return false;
  location = value.vector();
  return true;
}

/// Keep a camera's target on the object it watches; stop when that object is gone.
void follow(Machine& machine, CameraState& camera) {
  if (!camera.watched) return;
  if (!machine.world().alive(camera.watched)) {
    camera.watched = {};
    return;
  }
  Vector3 location;
  const ObjectId watched = camera.watched;
  if (location_of(machine, watched, location)) camera.set_target(location);
}

void control_iterate(Machine& machine, Instance& self) {
  // An archive of the controller gives a second object of its class. There is one clock.
  if (&self != machine.controller()) return;
  ViewState& view = view_of(machine);
  follow(machine, view.camera);
  if (!view.frozen) {
    // A sub-step looks at each object.
    const std::uint64_t steps = machine.world().substeps();
    machine.charge(steps);
    machine.charge_for(steps * machine.world().object_count());
    check_motors(machine);
    Mechanics& mechanics = machine.world().mechanics();
    const bool over = mechanics.over();
    const std::uint64_t done = mechanics.counters().work;
    machine.world().advance_bodies();
    // Physics that has used up its own budget goes on coarsely, and unbounded: a loop pays for that.
    constexpr std::uint64_t kUnitsPerIteration = 2;
    if (over) machine.charge((machine.world().mechanics().counters().work - done) / kUnitsPerIteration);
    machine.poll();  // physics ends early, and leaves it to others to say so
  }
  if (view.offset_pan.steps > 0) view.camera.set_offset(view.offset_pan.advance(view.camera.offset));
  if (view.target_pan.steps > 0) view.camera.set_target(view.target_pan.advance(view.camera.target));
  if (view.offset_pan.steps <= 0) view.frozen = false;
  if (view.flags.recording)
    view.flags.recording = write_frame(machine, "movie", static_cast<std::int64_t>(machine.world().iteration()),
                                       "toggle-recording-to-movie");
}

double control_get_time(Machine& machine, Instance&) { return machine.world().time(); }
void control_end_simulation(Machine& machine, Instance&) { machine.world().request_end(); }
void control_pause(Machine& machine, Instance&) { machine.world().set_paused(true); }
void control_unpause(Machine& machine, Instance&) { machine.world().set_paused(false); }
void control_set_iteration_step(Machine& machine, Instance&, double seconds) {
  machine.world().set_iteration_step(seconds);
}
double control_get_iteration_step(Machine& machine, Instance&) { return machine.world().iteration_step(); }
void control_set_integration_step(Machine& machine, Instance&, double seconds) {
  machine.world().set_integration_step(seconds);
}
double control_get_integration_step(Machine& machine, Instance&) { return machine.world().integration_step(); }
Value control_get_random_seed(Machine& machine, Instance&) {
  const std::uint64_t seed = machine.host().seed;
  if (seed > std::uint64_t{std::numeric_limits<std::int32_t>::max()}) return Value::of(static_cast<double>(seed));
  return Value::of(static_cast<std::int32_t>(seed));
}

void control_update_neighbors(Machine& machine, Instance&) {
  machine.charge(machine.world().object_count());
  machine.world().update_neighbors();
}

// --- how far space goes
// ------------------------------------------------------------------------------------------------

template <Ending Kind>
void control_close_space(Machine& machine, Instance& self, Vector3 low, Vector3 high) {
  const char* selector = Kind == Ending::Wrap ? "wrap-space" : "wall-space";
  finite(low, std::string(selector) + ": from");
  finite(high, std::string(selector) + ": to");
  if (!(high.array() > low.array()).any() || (high.array() < low.array()).any())
    throw Error(ErrorCode::Argument, std::string(selector) +
                                         ": `from` must be below `to` along at least one axis, and above it "
                                         "along none");
  for (int axis = 0; axis < 3; ++axis)
    if (low[axis] < high[axis]) machine.world().set_space(axis, Kind, low[axis], high[axis], self.id);
}

void control_open_space(Machine& machine, Instance&) {
  for (int axis = 0; axis < 3; ++axis) machine.world().set_space(axis, Ending::Open, 0, 0);
}

Vector3 control_get_space_size(Machine& machine, Instance&) {
  const Extent& space = machine.world().space();
  Vector3 size;
  for (int axis = 0; axis < 3; ++axis) size[axis] = space.axis(axis).high - space.axis(axis).low;
  return size;
}

void control_set_impact_timing(Machine& machine, Instance&, Text mode) {
  if (view(mode) != "impact" && view(mode) != "step")
    throw Error(ErrorCode::Argument,
                "set-impact-timing: no mode '" + std::string(view(mode)) + "'; the modes are \"impact\" and \"step\"");
  machine.world().set_impact_timing(view(mode) == "impact");
}

// --- selection and input ---------------------------------------------------------------------------------------------

/// Axes and bounds of a body, or of all links of a MultiBody.
void show_selected(Machine& machine, ObjectId id, bool selected) {
  World& world = machine.world();
  Instance* object = machine.instance(id);
  if (!object) return;
  std::vector<Instance*> shown{object};
  if (is_library_kind(*object, "MultiBody")) shown = links_of(machine, *object);
  for (const Instance* one : shown) {
    if (!world.has_body(one->id)) continue;
    Appearance& look = world.bodies().appearance(world.body(one->id));
    look.axis = selected;
    look.bounding_box = selected;
  }
}

/// A click on a link selects its MultiBody.
Instance* selected_by(Machine& machine, Instance* object) {
  if (!object || !object->live() || !is_library_kind(*object, "Link")) return object;
  Instance* whole = multibody_of(machine, body_of(machine, *object));
  return whole ? whole : object;
}

void control_click(Machine& machine, Instance&, Instance* object) {
  ViewState& view = view_of(machine);
  show_selected(machine, view.selection, false);
  view.selection = machine.id_of(selected_by(machine, object));
  show_selected(machine, view.selection, true);
}

Instance* control_get_selection(Machine& machine, Instance&) { return machine.instance(view_of(machine).selection); }

Instance* control_get_drag_object(Machine& machine, Instance&) {
  World& world = machine.world();
  Instance* selection = machine.instance(view_of(machine).selection);
  if (!selection || is_library_kind(*selection, "MultiBody")) return selection;
  if (!world.has_body(selection->id)) return nullptr;
  return world.bodies().kind(world.body(selection->id)) == BodyKind::Stationary ? nullptr : selection;
}

std::int32_t control_get_mouse_x(Machine& machine, Instance&) { return view_of(machine).mouse_x; }
std::int32_t control_get_mouse_y(Machine& machine, Instance&) { return view_of(machine).mouse_y; }

// --- main camera -----------------------------------------------------------------------------------------------------

void control_watch(Machine& machine, Instance&, Instance* object) {
  CameraState& camera = view_of(machine).camera;
  camera.watched = machine.id_of(object);
  follow(machine, camera);
}

void control_aim_camera(Machine& machine, Instance&, Vector3 target) {
  ViewState& view = view_of(machine);
  view.camera.set_target(target);
  view.target_pan.steps = 0;
}

Vector3 control_get_camera_target(Machine& machine, Instance&) { return view_of(machine).camera.target; }

void control_offset_camera(Machine& machine, Instance&, Vector3 offset) {
  ViewState& view = view_of(machine);
  view.camera.set_offset(offset);
  view.offset_pan.steps = 0;
}

Vector3 control_get_camera_offset(Machine& machine, Instance&) { return view_of(machine).camera.offset; }

/// The pan toward `goal` in `steps` increments; fewer than 2: none, and the caller goes there at once.
Pan pan_to(const Vector3& goal, std::int32_t steps) {
  if (!goal.allFinite()) throw Error(ErrorCode::Argument, "the goal of a camera pan must be finite");
  return {goal, steps < 2 ? 0 : steps};
}

void control_pan_camera_offset(Machine& machine, Instance&, Vector3 goal, std::int32_t steps) {
  ViewState& view = view_of(machine);
  view.offset_pan = pan_to(goal, steps);
  if (view.offset_pan.steps == 0) view.camera.set_offset(goal);
}

void control_bullet_pan_camera_offset(Machine& machine, Instance& self, Vector3 goal, std::int32_t steps) {
  control_pan_camera_offset(machine, self, goal, steps);
  view_of(machine).frozen = view_of(machine).offset_pan.steps > 0;
}

void control_pan_camera_target(Machine& machine, Instance&, Vector3 goal, std::int32_t steps) {
  ViewState& view = view_of(machine);
  view.target_pan = pan_to(goal, steps);
  if (view.target_pan.steps == 0) view.camera.set_target(goal);
}

void control_point_camera(Machine& machine, Instance& self, Vector3 target, Vector3 offset) {
  control_aim_camera(machine, self, target);
  if (!offset.isZero(0)) control_offset_camera(machine, self, offset);
}

void control_pivot_camera(Machine& machine, Instance&, double pitch, double yaw) {
  CameraState& camera = view_of(machine).camera;
  camera.set_angles(camera.pitch + pitch, camera.yaw + yaw);
}

void control_set_camera_rotation(Machine& machine, Instance&, double pitch, double yaw) {
  view_of(machine).camera.set_angles(pitch, yaw);
}

void control_zoom_camera(Machine& machine, Instance&, double distance) {
  view_of(machine).camera.set_distance(distance);
}

void control_set_z_clip(Machine& machine, Instance&, std::int32_t distance) {
  view_of(machine).camera.set_far_plane(distance);
}

constexpr Native kControlNatives[] = {
    native<control_iterate>("control.iterate"),
    native<control_get_time>("control.get-time"),
    native<control_end_simulation>("control.end-simulation"),
    native<control_pause>("control.pause"),
    native<control_unpause>("control.unpause"),
    native<control_set_iteration_step>("control.set-iteration-step"),
    native<control_get_iteration_step>("control.get-iteration-step"),
    native<control_set_integration_step>("control.set-integration-step"),
    native<control_get_integration_step>("control.get-integration-step"),
    native<control_get_random_seed>("control.get-random-seed"),
    native<control_update_neighbors>("control.update-neighbors"),
    native<control_close_space<Ending::Wrap>>("control.wrap-space"),
    native<control_close_space<Ending::Wall>>("control.wall-space"),
    native<control_open_space>("control.open-space"),
    native<control_get_space_size>("control.get-space-size"),
    native<control_set_impact_timing>("control.set-impact-timing"),
    native<control_click>("control.click"),
    native<control_get_selection>("control.get-selection"),
    native<control_get_drag_object>("control.get-drag-object"),
    native<control_get_mouse_x>("control.get-mouse-x-coordinate"),
    native<control_get_mouse_y>("control.get-mouse-y-coordinate"),
    native<control_watch>("control.watch"),
    native<control_aim_camera>("control.aim-camera"),
    native<control_aim_camera>("control.set-camera-target"),
    native<control_get_camera_target>("control.get-camera-target"),
    native<control_offset_camera>("control.offset-camera"),
    native<control_offset_camera>("control.set-camera-offset"),
    native<control_get_camera_offset>("control.get-camera-offset"),
    native<control_pan_camera_offset>("control.pan-camera-offset"),
    native<control_bullet_pan_camera_offset>("control.bullet-pan-camera-offset"),
    native<control_pan_camera_target>("control.pan-camera-target"),
    native<control_point_camera>("control.point-camera"),
    native<control_pivot_camera>("control.pivot-camera"),
    native<control_set_camera_rotation>("control.set-camera-rotation"),
    native<control_zoom_camera>("control.zoom-camera"),
    native<control_set_z_clip>("control.set-z-clip"),
};

}  // namespace

std::span<const Native> control_natives() { return kControlNatives; }

}  // namespace breve::steve
