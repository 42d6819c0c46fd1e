// Natives of Mobile: motion, physics, geometry of a body that moves.
#include <cmath>

#include "steve/library/joints.hpp"
#include "steve/library/tables.hpp"
#include "steve/library/vector_native.hpp"

namespace breve::steve {

namespace {

void mobile_init(Machine& machine, Instance& self) {
  embody(machine, self, is_library_kind(self, "Link") ? BodyKind::Link : BodyKind::Mobile);
}

Instance* mobile_register(Machine& machine, Instance& self, Instance* shape) {
  machine.warn_once("mobile.register", "'register' of Mobile is the old name of 'set-shape'");
  const Value argument = Value::of(Tag::Object, shape);
  machine.call(self, "set-shape", std::span(&argument, 1));
  return &self;
}

// --- motion ----------------------------------------------------------------------------------------------------------

using Getter = const Vector3& (Bodies::*)(BodyIndex) const;
using Setter = void (Bodies::*)(BodyIndex, const Vector3&);

template <Getter Get>
Vector3 get(Machine& machine, Instance& self) {
  return (bodies_of(machine).*Get)(body_of(machine, self));
}

template <Setter Set>
void set(Machine& machine, Instance& self, Vector3 value) {
  (bodies_of(machine).*Set)(body_of(machine, self), value);
}

/// The rotation about an axis of any length; the identity for a zero axis.
Quaternion rotation_about(const Vector3& axis, double radians) {
  finite(axis, "a rotation's axis");
  finite(radians, "a rotation's angle");
  const double length = axis.stableNorm();
  return length == 0 ? Quaternion::Identity() : Quaternion(Eigen::AngleAxisd(radians, axis / length));
}

void mobile_rotate(Machine& machine, Instance& self, Vector3 axis, double radians) {
  const Quaternion rotation = rotation_about(axis, radians);
  const BodyIndex body = body_of(machine, self);
  if (axis.isZero(0)) return;
  machine.world().leave(body);
  bodies_of(machine).set_orientation(body, rotation);
  follow_moved(machine, body);
}

void mobile_relative_rotate(Machine& machine, Instance& self, Vector3 axis, double radians) {
  const Quaternion rotation = rotation_about(axis, radians);
  const BodyIndex body = body_of(machine, self);
  machine.world().leave(body);
  bodies_of(machine).set_orientation(body, rotation * bodies_of(machine).orientation(body));
  follow_moved(machine, body);
}

void mobile_offset(Machine& machine, Instance& self, Vector3 displacement) {
  const BodyIndex body = body_of(machine, self);
  const Vector3 location = bodies_of(machine).location(body) + displacement;
  machine.world().leave(body);
  bodies_of(machine).set_location(body, location.allFinite() ? machine.world().space().inside(location) : location);
  follow_moved(machine, body);
}

// --- physics ---------------------------------------------------------------------------------------------------------

template <bool On>
void set_physics(Machine& machine, Instance& self) {
  bodies_of(machine).set_physics(body_of(machine, self), On);
}

// A force method, which runs at stages that may be tried again, pushes by what it yields alone.

void mobile_add_force(Machine& machine, Instance& self, Vector3 force) {
  machine.refuse_in_stage("push a body");
  machine.world().add_force(body_of(machine, self), force, Vector3::Zero(), nullptr);
}
void mobile_add_force_at_point(Machine& machine, Instance& self, Vector3 force, Vector3 point) {
  machine.refuse_in_stage("push a body");
  machine.world().add_force(body_of(machine, self), force, Vector3::Zero(), &point);
}
void mobile_add_torque(Machine& machine, Instance& self, Vector3 torque) {
  machine.refuse_in_stage("push a body");
  machine.world().add_force(body_of(machine, self), Vector3::Zero(), torque, nullptr);
}
void mobile_add_impulse(Machine& machine, Instance& self, Vector3 impulse) {
  machine.refuse_in_stage("push a body");
  machine.world().add_impulse(body_of(machine, self), impulse, nullptr);
}
void mobile_add_impulse_at_point(Machine& machine, Instance& self, Vector3 impulse, Vector3 point) {
  machine.refuse_in_stage("push a body");
  machine.world().add_impulse(body_of(machine, self), impulse, &point);
}
void mobile_wake(Machine& machine, Instance& self) { machine.world().wake(body_of(machine, self)); }

/// Hooks around dragging: physics does not move a body that the user holds.
void mobile_suspend_physics(Machine& machine, Instance& self) {
  const BodyIndex body = body_of(machine, self);
  Slot* suspended = library_slot(machine, self, "Mobile", "physicsSuspended");
  if (!suspended || !bodies_of(machine).physics(body)) return;
  bodies_of(machine).set_physics(body, false);
  suspended->i = 1;
}

void mobile_resume_physics(Machine& machine, Instance& self) {
  const BodyIndex body = body_of(machine, self);
  Slot* suspended = library_slot(machine, self, "Mobile", "physicsSuspended");
  if (!suspended || suspended->i == 0) return;
  suspended->i = 0;
  bodies_of(machine).set_physics(body, true);
}

double mobile_get_mass(Machine& machine, Instance& self) { return bodies_of(machine).mass(body_of(machine, self)); }

// --- geometry --------------------------------------------------------------------------------------------------------

double mobile_get_distance(Machine& machine, Instance& self, Instance* other) {
  const BodyIndex body = body_of(machine, self);
  const BodyIndex to = body_of(machine, must_live(other, "get-distance: the object"));
  return machine.world().space().offset(bodies_of(machine).location(body), bodies_of(machine).location(to)).norm();
}

Vector3 mobile_transform(Machine& machine, Instance& self, Vector3 v) {
  return bodies_of(machine).rotation(body_of(machine, self)).transpose() * v;
}

Vector3 mobile_get_bound_maximum(Machine& machine, Instance& self) {
  const BodyIndex body = body_of(machine, self);
  charge_for_bounds(machine, body);
  return bodies_of(machine).bounds(body).max();
}

Vector3 mobile_get_bound_minimum(Machine& machine, Instance& self) {
  const BodyIndex body = body_of(machine, self);
  charge_for_bounds(machine, body);
  return bodies_of(machine).bounds(body).min();
}

/// Are two links of one assembly tested against each other at all?
bool tested(const Mechanics& dynamics, BodyIndex a, BodyIndex b) {
  return dynamics.self_collisions(a) && !dynamics.jointed(a, b);
}

ListCell* mobile_get_colliding_objects(Machine& machine, Instance& self) {
  const BodyIndex body = body_of(machine, self);
  const Mechanics& dynamics = machine.world().mechanics();
  const auto touching = counted_touching(machine, self.id);
  ListCell* list = machine.heap().list(0);
  for (const ObjectId id : touching) {
    const BodyIndex other = machine.world().body(id);
    if (dynamics.jointed(body, other)) continue;
    if (dynamics.same_assembly(body, other) && !tested(dynamics, body, other)) continue;
    machine.heap().push(*list, Value::of(Tag::Object, machine.instance(id)));
  }
  return list;
}

std::int32_t mobile_check_for_self_penetrations(Machine& machine, Instance& self) {
  const BodyIndex body = body_of(machine, self);
  const Mechanics& dynamics = machine.world().mechanics();
  for (const ObjectId id : counted_touching(machine, self.id)) {
    const BodyIndex other = machine.world().body(id);
    if (dynamics.same_assembly(body, other) && tested(dynamics, body, other)) return 1;
  }
  return 0;
}

void mobile_set_force_method(Machine& machine, Instance& self, std::int32_t on) {
  machine.world().mechanics().set_force_method(body_of(machine, self), on != 0);
}

constexpr Native kMobileNatives[] = {
    native<mobile_add_force>("mobile.add-force"),
    native<mobile_add_force_at_point>("mobile.add-force-at-point"),
    native<mobile_add_torque>("mobile.add-torque"),
    native<mobile_add_impulse>("mobile.add-impulse"),
    native<mobile_add_impulse_at_point>("mobile.add-impulse-at-point"),
    native<mobile_wake>("mobile.wake"),
    native<mobile_init>("mobile.init"),
    native<mobile_register>("mobile.register"),
    native<set_physics<true>>("mobile.enable-physics"),
    native<set_physics<false>>("mobile.disable-physics"),
    native<mobile_suspend_physics>("mobile.suspend-physics"),
    native<mobile_resume_physics>("mobile.resume-physics"),
    native<mobile_get_mass>("mobile.get-mass"),
    native<set<&Bodies::set_force>>("mobile.set-force"),
    vector_native<get<&Bodies::force>>("mobile.get-force"),
    native<set<&Bodies::set_torque>>("mobile.set-torque"),
    vector_native<get<&Bodies::torque>>("mobile.get-torque"),
    native<mobile_set_force_method>("mobile.use-force-method"),
    native<mobile_rotate>("mobile.rotate"),
    native<mobile_relative_rotate>("mobile.relative-rotate"),
    native<mobile_offset>("mobile.offset"),
    native<set<&Bodies::set_velocity>>("mobile.set-velocity"),
    vector_native<get<&Bodies::velocity>>("mobile.get-velocity"),
    native<set<&Bodies::set_acceleration>>("mobile.set-acceleration"),
    vector_native<get<&Bodies::acceleration>>("mobile.get-acceleration"),
    native<set<&Bodies::set_rotational_velocity>>("mobile.set-rotational-velocity"),
    vector_native<get<&Bodies::rotational_velocity>>("mobile.get-rotational-velocity"),
    native<set<&Bodies::set_rotational_acceleration>>("mobile.set-rotational-acceleration"),
    native<mobile_get_distance>("mobile.get-distance"),
    native<mobile_transform>("mobile.transform"),
    native<mobile_get_bound_maximum>("mobile.get-bound-maximum"),
    native<mobile_get_bound_minimum>("mobile.get-bound-minimum"),
    native<mobile_get_colliding_objects>("mobile.check-for-penetrations"),
    native<mobile_get_colliding_objects>("mobile.get-colliding-objects"),
    native<mobile_check_for_self_penetrations>("mobile.check-for-self-penetrations"),
};

}  // namespace

std::span<const Native> mobile_natives() { return kMobileNatives; }

}  // namespace breve::steve
