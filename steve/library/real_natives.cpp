// Natives of Real, Stationary: pose, shape, material, neighbours, collisions.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <span>

#include "steve/library/joints.hpp"
#include "steve/library/library.hpp"
#include "steve/library/resources.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"
#include "steve/library/vector_native.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

// --- pose ------------------------------------------------------------------------------------------------------------

void real_set_target(Machine& machine, Instance& self, Vector3 location) {
  const BodyIndex body = body_of(machine, self);
  machine.world().set_target(body, &location, nullptr);
}

void real_set_target_rotation(Machine& machine, Instance& self, Matrix3 rotation) {
  const BodyIndex body = body_of(machine, self);
  constexpr double kOrthonormal = 1e-6;
  const double off = (rotation * rotation.transpose() - Matrix3::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= kOrthonormal) || !(rotation.determinant() > 0))
    throw Error(ErrorCode::Argument, "set-target-rotation: the matrix must be a rotation");
  const Quaternion orientation(Eigen::Matrix3d{rotation});
  machine.world().set_target(body, nullptr, &orientation);
}

void real_move(Machine& machine, Instance& self, Vector3 location) {
  const BodyIndex body = body_of(machine, self);
  // A matrix that is not finite is refused unchanged.
  machine.world().leave(body);
  bodies_of(machine).set_location(body, location.allFinite() ? machine.world().space().inside(location) : location);
  follow_moved(machine, body);
}

Vector3 real_get_location(Machine& machine, Instance& self) {
  return bodies_of(machine).location(body_of(machine, self));
}

Vector3 real_get_offset(Machine& machine, Instance& self, Instance* other) {
  const BodyIndex body = body_of(machine, self);
  const BodyIndex to = body_of(machine, must_live(other, "get-offset: the object"));
  return machine.world().space().offset(bodies_of(machine).location(body), bodies_of(machine).location(to));
}

Vector3 real_get_offset_to_point(Machine& machine, Instance& self, Vector3 point) {
  return machine.world().space().offset(bodies_of(machine).location(body_of(machine, self)), point);
}

MatrixCell* real_get_rotation(Machine& machine, Instance& self) {
  return machine.heap().matrix(bodies_of(machine).rotation(body_of(machine, self)));
}

void real_set_rotation(Machine& machine, Instance& self, Matrix3 rotation) {
  const BodyIndex body = body_of(machine, self);
  machine.world().leave(body);
  bodies_of(machine).set_rotation(body, rotation);
  follow_moved(machine, body);
}

void real_set_rotation_around(Machine& machine, Instance& self, Vector3 axis, double radians) {
  finite(axis, "a rotation's axis");
  finite(radians, "a rotation's angle");
  const BodyIndex body = body_of(machine, self);
  const double length = axis.stableNorm();
  if (length == 0) return;
  machine.world().leave(body);
  bodies_of(machine).set_orientation(body, Quaternion(Eigen::AngleAxisd(radians, axis / length)));
  follow_moved(machine, body);
}

void real_set_rotation_euler_angles(Machine& machine, Instance& self, Vector3 angles) {
  finite(angles, "Euler angles");
  const Quaternion rotation = Eigen::AngleAxisd(angles.z(), Vector3::UnitZ()) *
                              Eigen::AngleAxisd(angles.y(), Vector3::UnitY()) *
                              Eigen::AngleAxisd(angles.x(), Vector3::UnitX());
  const BodyIndex body = body_of(machine, self);
  machine.world().leave(body);
  bodies_of(machine).set_orientation(body, rotation);
  follow_moved(machine, body);
}

void real_point(Machine& machine, Instance& self, Vector3 vertex, Vector3 direction) {
  finite(vertex, "point: the vertex");
  finite(direction, "point: the direction");
  const double vertex_length = vertex.stableNorm(), direction_length = direction.stableNorm();
  const BodyIndex body = body_of(machine, self);
  if (vertex_length == 0 || direction_length == 0) return;
  const Vector3 from = vertex / vertex_length, to = direction / direction_length;
  const Vector3 axis = from.cross(to);
  const double sine = axis.norm();
  // Below this the axis is round-off: the two are parallel or opposite.
  constexpr double kParallel = 1e-12, kParallelAngle = 0.01;
  Eigen::AngleAxisd rotation(std::atan2(sine, from.dot(to)), axis / sine);
  if (sine < kParallel) {
    // Bodies of a flat world rotate about z only, and a vertex in the plane is no such axis.
    const bool flat = machine.world().dimension() == 2;
    rotation = flat ? Eigen::AngleAxisd(from.dot(to) < 0 ? std::numbers::pi : 0, Vector3::UnitZ())
                    : Eigen::AngleAxisd(kParallelAngle, from);
  }
  machine.world().leave(body);
  bodies_of(machine).set_orientation(body, Quaternion(rotation));
  follow_moved(machine, body);
}

// --- shape -----------------------------------------------------------------------------------------------------------

const std::shared_ptr<Shape>& geometry_of(Machine& machine, Instance* shape, std::string_view selector) {
  const Instance& live = must_live(shape, std::string(selector) + ": the shape");
  const ShapeResource* resource = resource_of<ShapeResource>(machine, &live);
  if (!resource || !resource->shape)
    Machine::fail(RunErrorKind::NullObject, std::string(selector) + ": " + name_of(live) +
                                                " has no geometry (give it some with init-with first)");
  return resource->shape;
}

void real_set_collision_shape(Machine& machine, Instance& self, Instance* shape) {
  bodies_of(machine).set_collision_shape(body_of(machine, self), geometry_of(machine, shape, "set-collision-shape"));
  set_library_object(machine, self, "Real", "collisionShape", shape);
}

void real_set_display_shape(Machine& machine, Instance& self, Instance* shape) {
  bodies_of(machine).set_display_shape(body_of(machine, self), geometry_of(machine, shape, "set-display-shape"));
  set_library_object(machine, self, "Real", "displayShape", shape);
}

Instance* real_set_shape(Machine& machine, Instance& self, Instance* shape) {
  constexpr std::uint64_t kOfShape = 4;  // loop iterations: boxes, masses and two variables are set anew
  machine.charge(kOfShape);
  const std::shared_ptr<Shape>& geometry = geometry_of(machine, shape, "set-shape");
  const BodyIndex body = body_of(machine, self);
  bodies_of(machine).set_collision_shape(body, geometry);
  bodies_of(machine).set_display_shape(body, geometry);
  set_library_object(machine, self, "Real", "collisionShape", shape);
  set_library_object(machine, self, "Real", "displayShape", shape);
  return &self;
}

Vector3 real_raytrace(Machine& machine, Instance& self, Vector3 start, Vector3 direction) {
  finite(start, "raytrace: the location");
  finite(direction, "raytrace: the direction");
  const Bodies& bodies = bodies_of(machine);
  const BodyIndex body = body_of(machine, self);
  const std::shared_ptr<Shape>& shape = bodies.collision_shape(body);
  if (!shape) Machine::fail(RunErrorKind::NullObject, "raytrace: " + name_of(self) + " has no shape");
  const Matrix3 rotation = bodies.rotation(body);
  double fraction = 0;
  const bool hit = shape->raycast(rotation.transpose() * (start - bodies.location(body)),
                                  rotation.transpose() * direction, fraction);
  return hit ? Vector3(direction * fraction) : Vector3(0, 0, 0);
}

// --- material --------------------------------------------------------------------------------------------------------

/// The first call of set-e or set-mu sends both script values; the one not given is 0.2, or 0 on a fixed body.
Material& scripted_material(Machine& machine, Instance& self) {
  const BodyIndex body = body_of(machine, self);
  Material& material = bodies_of(machine).material(body);
  Slot* is_set = library_slot(machine, self, "Real", "materialIsSet");
  if (is_set && is_set->i == 0) {
    is_set->i = 1;
    const double other = bodies_of(machine).kind(body) == BodyKind::Stationary ? 0.0 : 0.2;
    material.restitution = material.friction = other;
  }
  return material;
}

void real_set_e(Machine& machine, Instance& self, double e) {
  scripted_material(machine, self).restitution = finite(e, "set-e");
}

void real_set_e_tangential(Machine&, Instance&, double) {}

void real_set_mu(Machine& machine, Instance& self, double mu) {
  scripted_material(machine, self).friction = finite(mu, "set-mu");
}

/// @throws Error{Argument} naming the coefficient unless low <= value <= high
double within(double value, double low, double high, const char* what) {
  if (value >= low && value <= high) return value;
  throw Error(ErrorCode::Argument, std::string(what) + " is " + fmt::to_string(value) + ", not between " +
                                       fmt::to_string(low) + " and " + fmt::to_string(high));
}

void real_set_friction(Machine& machine, Instance& self, double at_rest, double in_motion) {
  constexpr double kMost = 1e6;
  within(at_rest, 0, kMost, "set-friction: the static coefficient");
  within(in_motion, 0, kMost, "set-friction: the dynamic coefficient");
  Material& material = bodies_of(machine).material(body_of(machine, self));
  material.static_friction = at_rest;
  material.dynamic_friction = in_motion;
}

void real_set_restitution(Machine& machine, Instance& self, double normal, double tangential, double threshold) {
  within(normal, 0, 1, "set-restitution: the normal coefficient");
  within(tangential, -1, 1, "set-restitution: the tangential coefficient");
  within(threshold, 0, 1e6, "set-restitution: the threshold");
  Material& material = bodies_of(machine).material(body_of(machine, self));
  material.normal_restitution = normal;
  material.tangential_restitution = tangential;
  material.restitution_threshold = threshold;
}

// --- neighbours ------------------------------------------------------------------------------------------------------

void real_set_neighborhood_size(Machine& machine, Instance& self, double radius) {
  bodies_of(machine).set_neighborhood_size(body_of(machine, self), radius);
}

double real_get_neighborhood_size(Machine& machine, Instance& self) {
  return bodies_of(machine).neighborhood_size(body_of(machine, self));
}

ListCell* real_get_neighbors(Machine& machine, Instance& self) {
  body_of(machine, self);
  if (!machine.world().effects()[EffectId::Neighbors].active) [[unlikely]]
    machine.warn_once("get-neighbors",
                      "get-neighbors finds no neighbors before 'update-neighbors' of the controller is called");
  const std::span<const std::uint64_t> neighbors = machine.world().neighbor_users(self.id);
  constexpr std::uint64_t kOfNeighbor = 4;  // elements: to find it, and to list it
  machine.charge_for(kOfNeighbor * neighbors.size());
  ListCell* list = machine.heap().list(static_cast<std::uint32_t>(neighbors.size()));
  for (const std::uint64_t neighbor : neighbors)
    machine.heap().push(*list, Value::of(Tag::Object, reinterpret_cast<Instance*>(neighbor)));
  return list;
}

// --- collisions ------------------------------------------------------------------------------------------------------

void real_handle_collisions(Machine& machine, Instance& self, Text type, Text method) {
  const ClassInfo* other = class_named(machine, type, "handle-collisions");
  if (!machine.responds(*self.cls, view(method))) {
    machine.report_unknown_method(Severity::Error, self, view(method), "the collision handler is not registered");
    return;
  }
  if (other) machine.world().handle_collisions(self.cls->id, other->id, view(method), self.id);
}

void real_ignore_collisions(Machine& machine, Instance& self, Text type) {
  const ClassInfo* other = class_named(machine, type, "ignore-collisions");
  if (other) machine.world().ignore_collisions(self.cls->id, other->id);
}

// --- Stationary ------------------------------------------------------------------------------------------------------

void stationary_init(Machine& machine, Instance& self) {
  embody(machine, self, BodyKind::Stationary);
  Instance* controller = machine.controller();
  const MethodInfo* texture = controller ? machine.find_method(*controller->cls, "get-stationary-texture", 0) : nullptr;
  if (!texture) return;
  const Value image = machine.call(*controller, *texture);
  if (image.tag != Tag::Object || !self.live()) return;
  set_library_object(machine, self, "Real", "textureImage", image.object());
  bodies_of(machine).appearance(body_of(machine, self)).texture = machine.id_of(image.object());
}

constexpr Native kRealNatives[] = {
    native<real_move>("real.move"),
    native<real_set_target>("real.set-target"),
    native<real_set_target_rotation>("real.set-target-rotation"),
    vector_native<real_get_location>("real.get-location"),
    vector_native<real_get_offset>("real.get-offset"),
    vector_native<real_get_offset_to_point>("real.get-offset-to-point"),
    native<real_get_rotation>("real.get-rotation"),
    native<real_get_rotation>("real.get-rotation-matrix"),
    native<real_set_rotation>("real.set-rotation"),
    native<real_set_rotation>("real.set-rotation-matrix"),
    native<real_set_rotation_around>("real.set-rotation-around"),
    native<real_set_rotation_euler_angles>("real.set-rotation-euler-angles"),
    native<real_point>("real.point"),
    native<real_set_shape>("real.set-shape"),
    native<real_set_collision_shape>("real.set-collision-shape"),
    native<real_set_display_shape>("real.set-display-shape"),
    native<real_raytrace>("real.raytrace"),
    native<real_set_e>("real.set-e"),
    native<real_set_e_tangential>("real.set-eT"),
    native<real_set_mu>("real.set-mu"),
    native<real_set_friction>("real.set-friction"),
    native<real_set_restitution>("real.set-restitution"),
    native<real_set_neighborhood_size>("real.set-neighborhood-size"),
    native<real_get_neighborhood_size>("real.get-neighborhood-size"),
    native<real_get_neighbors>("real.get-neighbors"),
    native<real_handle_collisions>("real.handle-collisions"),
    native<real_ignore_collisions>("real.ignore-collisions"),
    native<stationary_init>("stationary.init"),
};

}  // namespace

void embody(Machine& machine, Instance& self, BodyKind kind) {
  machine.world().embody(self.id, kind);
  const std::string_view variable = kind == BodyKind::Link ? "genericLinkShape" : "genericShape";
  Instance* controller = machine.controller();
  Instance* shape = controller ? library_object(machine, *controller, "Control", variable) : nullptr;
  if (resource_of<ShapeResource>(machine, shape)) real_set_shape(machine, self, shape);
}

std::span<const Native> real_natives() { return kRealNatives; }

}  // namespace breve::steve
