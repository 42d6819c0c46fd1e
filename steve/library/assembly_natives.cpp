// Natives of Link and MultiBody: what joints connect, as a whole.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "steve/library/joints.hpp"
#include "steve/library/ledger_values.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

/// The root of a MultiBody that must have one.
Instance& need_root(Machine& machine, Instance& self) {
  Instance* root = root_of(machine, self);
  if (!root) Machine::fail(RunErrorKind::NullObject, name_of(self) + " has no root (give it one with set-root first)");
  return *root;
}

BodyIndex root_body(Machine& machine, Instance& self) { return body_of(machine, need_root(machine, self)); }

ListCell* list_of(Machine& machine, const std::vector<Instance*>& objects) {
  ListCell* list = machine.heap().list(static_cast<std::uint32_t>(objects.size()));
  for (Instance* object : objects) machine.heap().push(*list, Value::of(Tag::Object, object));
  return list;
}

// --- Link -----------------------------------------------------------------------------------------------------------

/// A Mobile already; its material and its physics are in force from the start.
void link_init(Machine& machine, Instance& self) {
  const BodyIndex body = body_of(machine, self);
  Material& material = bodies_of(machine).material(body);
  constexpr double kLink = 0.2;
  material.restitution = material.friction = kLink;
  if (Slot* is_set = library_slot(machine, self, "Real", "materialIsSet")) is_set->i = 1;
  bodies_of(machine).set_physics(body, true);
}

Instance* link_get_multibody(Machine& machine, Instance& self) { return multibody_of(machine, body_of(machine, self)); }

// --- MultiBody: what belongs to it ----------------------------------------------------------------------------------

Instance* multibody_set_root(Machine& machine, Instance& self, Instance* root) {
  set_root(machine, self, root);
  return &self;
}

Instance* multibody_get_root(Machine& machine, Instance& self) { return root_of(machine, self); }

ListCell* multibody_links(Machine& machine, Instance& self) { return list_of(machine, links_of(machine, self)); }
ListCell* multibody_joints(Machine& machine, Instance& self) { return list_of(machine, joints_of(machine, self)); }

ListCell* multibody_objects(Machine& machine, Instance& self) {
  std::vector<Instance*> parts = links_of(machine, self);
  const std::vector<Instance*> joints = joints_of(machine, self);
  parts.insert(parts.end(), joints.begin(), joints.end());
  return list_of(machine, parts);
}

ListCell* multibody_colliding(Machine& machine, Instance& self) {
  const std::vector<Instance*> links = links_of(machine, self);
  std::vector<Instance*> found;
  for (const Instance* link : links)
    for (const ObjectId id : counted_touching(machine, link->id)) {
      machine.charge_for(links.size() + found.size());
      Instance* other = machine.instance(id);
      const bool known = std::find(links.begin(), links.end(), other) != links.end() ||
                         std::find(found.begin(), found.end(), other) != found.end();
      if (!known) found.push_back(other);
    }
  return list_of(machine, found);
}

/// Links last: a link takes its joints with it.
void multibody_free_all(Machine& machine, Instance& self) {
  std::vector<Instance*> parts = joints_of(machine, self);
  for (Instance* link : links_of(machine, self)) parts.push_back(link);
  std::vector<ObjectId> ids;
  for (const Instance* part : parts) ids.push_back(part->id);
  for (const ObjectId id : ids)
    if (Instance* part = machine.instance(id)) machine.free_instance(*part);
}

// --- MultiBody: where it is and how it moves ------------------------------------------------------------------------

Vector3 multibody_get_location(Machine& machine, Instance& self) {
  return bodies_of(machine).location(root_body(machine, self));
}

/// Let the root's own method rotate or move the root, then take the whole assembly there.
void move_by_root(Machine& machine, Instance& self, std::string_view selector, std::span<const Value> arguments) {
  Instance& root = need_root(machine, self);
  const BodyIndex body = body_of(machine, root);
  Bodies& bodies = bodies_of(machine);
  const Vector3 location = bodies.location(body);
  const Quaternion orientation = bodies.orientation(body);
  machine.call(root, selector, arguments);
  if (!root.live()) return;
  const Vector3 goal = bodies.location(body);
  const Quaternion goal_orientation = bodies.orientation(body);
  bodies.set_location(body, location);
  bodies.set_orientation(body, orientation);
  charge_for_assembly(machine, body);
  dynamics_of(machine).move_assembly(body, goal, goal_orientation);
}

void multibody_move(Machine& machine, Instance& self, Vector3 to) {
  const Value argument = Value::of(to);
  move_by_root(machine, self, "move", std::span(&argument, 1));
}

void multibody_rotate(Machine& machine, Instance& self, Vector3 axis, double radians) {
  const Value arguments[] = {Value::of(axis), Value::of(radians)};
  move_by_root(machine, self, "rotate", arguments);
}

void multibody_relative_rotate(Machine& machine, Instance& self, Vector3 axis, double radians) {
  const Value arguments[] = {Value::of(axis), Value::of(radians)};
  move_by_root(machine, self, "relative-rotate", arguments);
}

void multibody_set_rotation(Machine& machine, Instance& self, Matrix3 rotation) {
  const Value argument = Value::of(Tag::Matrix, machine.heap().matrix(rotation));
  move_by_root(machine, self, "set-rotation-matrix", std::span(&argument, 1));
}

void multibody_set_euler_angles(Machine& machine, Instance& self, Vector3 angles) {
  const Value argument = Value::of(angles);
  move_by_root(machine, self, "set-rotation-euler-angles", std::span(&argument, 1));
}

void multibody_point(Machine& machine, Instance& self, Vector3 vertex, Vector3 direction) {
  const Value arguments[] = {Value::of(vertex), Value::of(direction)};
  move_by_root(machine, self, "point", arguments);
}

/// A change even if it is the value that is there: what is not changed would be free in the strike that follows.
Vector3 changed(const Vector3& now, Vector3 wanted) {
  if (wanted == now) wanted.x() = std::nextafter(wanted.x(), std::numeric_limits<double>::infinity());
  return wanted;
}

/// Let the root move so and all links with it, as one rigid body; joints go on as they did. An assembly that the world
/// holds moves as near to that as it can.
void set_velocity_of_all(Machine& machine, BodyIndex root, const Vector3& velocity, const Vector3& spin) {
  Mechanics& dynamics = dynamics_of(machine);
  Bodies& bodies = bodies_of(machine);
  const auto links = dynamics.links_of(root);
  constexpr std::size_t kOfLink = 16;  // units of work: the velocities of joints are found anew from those of all links
  machine.charge(kOfLink * links.size());
  dynamics.take_changes();
  const Vector3 center = bodies.location(root);
  const Vector3 more = velocity - bodies.velocity(root), more_spin = spin - bodies.rotational_velocity(root);
  for (const BodyIndex link : links) {
    const Vector3 now = bodies.velocity(link), now_spin = bodies.rotational_velocity(link);
    bodies.set_velocity(link, changed(now, now + more + more_spin.cross(bodies.location(link) - center)));
    bodies.set_rotational_velocity(link, changed(now_spin, now_spin + more_spin));
  }
  dynamics.take_changes();
}

void multibody_set_velocity(Machine& machine, Instance& self, Vector3 velocity) {
  finite(velocity, "set-velocity: the velocity");
  const BodyIndex root = root_body(machine, self);
  set_velocity_of_all(machine, root, velocity, bodies_of(machine).rotational_velocity(root));
}

void multibody_set_rotational_velocity(Machine& machine, Instance& self, Vector3 velocity) {
  finite(velocity, "set-rotational-velocity: the velocity");
  const BodyIndex root = root_body(machine, self);
  set_velocity_of_all(machine, root, bodies_of(machine).velocity(root), velocity);
}

double multibody_get_mass(Machine& machine, Instance& self) {
  double mass = 0;
  for (const Instance* link : links_of(machine, self)) mass += bodies_of(machine).mass(body_of(machine, *link));
  return mass;
}

Vector3 multibody_center_of_mass(Machine& machine, Instance& self) {
  const Bodies& bodies = bodies_of(machine);
  double mass = 0;
  Vector3 sum = Vector3::Zero();
  for (const Instance* link : links_of(machine, self)) {
    const BodyIndex body = body_of(machine, *link);
    const Vector3 own = bodies.physics(body) ? bodies.mass_properties(body).center_of_mass : Vector3(0, 0, 0);
    mass += bodies.mass(body);
    sum += bodies.mass(body) * (bodies.location(body) + bodies.orientation(body) * own);
  }
  return mass > 0 ? Vector3(sum / mass) : multibody_get_location(machine, self);
}

template <bool Maximum>
Vector3 multibody_bound(Machine& machine, Instance& self) {
  Eigen::AlignedBox3d box = bodies_of(machine).bounds(root_body(machine, self));
  for (const Instance* link : links_of(machine, self)) {
    const BodyIndex body = body_of(machine, *link);
    charge_for_bounds(machine, body);
    box.extend(bodies_of(machine).bounds(body));
  }
  return Maximum ? box.max() : box.min();
}

// --- MultiBody: contacts, accuracy, energy --------------------------------------------------------------------------

template <bool On>
void multibody_self_collisions(Machine& machine, Instance& self) {
  dynamics_of(machine).set_self_collisions(root_body(machine, self), On);
}

void multibody_self_collision_parameters(Machine& machine, Instance& self, double erp, double cfm) {
  warn_if_flat(machine, "self-softness",
               "set-self-collision-parameters has no effect in a flat world: contacts are rigid; a Spring is soft");
  dynamics_of(machine).set_self_collision_parameters(root_body(machine, self), erp, cfm);
}

std::int32_t multibody_check_self_penetration(Machine& machine, Instance& self) {
  const BodyIndex root = root_body(machine, self);
  charge_for_assembly(machine, root);
  if (!dynamics_of(machine).self_collisions(root)) return 0;
  const std::uint64_t links = dynamics_of(machine).links_of(root).size();
  constexpr std::uint64_t kOfPair = 32;
  machine.charge(kOfPair * (links * links / 2));
  return dynamics_of(machine).self_penetrations(root) != 0;
}

void multibody_set_accuracy(Machine& machine, Instance& self, Text rung) {
  const Rung named = rung_named(view(rung));
  dynamics_of(machine).set_accuracy(root_body(machine, self), accuracy_of(named));
}

Text multibody_get_accuracy(Machine& machine, Instance& self) {
  const BodyIndex root = root_body(machine, self);
  charge_for_assembly(machine, root);
  return machine.heap().string(name_of(dynamics_of(machine).accuracy(root).rung));
}

Energy assembly_energy(Machine& machine, Instance& self) {
  const BodyIndex root = root_body(machine, self);
  charge_for_assembly(machine, root);
  return dynamics_of(machine).energy(root);
}

double multibody_get_energy(Machine& machine, Instance& self) { return assembly_energy(machine, self).total(); }
double multibody_get_residual(Machine& machine, Instance& self) { return assembly_energy(machine, self).residual; }
double multibody_get_motor_work(Machine& machine, Instance& self) { return assembly_energy(machine, self).motor_work; }
double multibody_get_contact_loss(Machine& machine, Instance& self) {
  return contact_loss_of(assembly_energy(machine, self));
}
HashCell* multibody_get_ledger(Machine& machine, Instance& self) {
  return ledger_value(machine, assembly_energy(machine, self));
}

constexpr Native kAssemblyNatives[] = {
    native<link_init>("link.init"),
    native<link_get_multibody>("link.get-multibody"),
    native<multibody_set_root>("multi-body.set-root"),
    native<multibody_get_root>("multi-body.get-root"),
    native<multibody_links>("multi-body.get-all-connected-links"),
    native<multibody_joints>("multi-body.get-all-connected-joints"),
    native<multibody_objects>("multi-body.get-all-connected-objects"),
    native<multibody_colliding>("multi-body.get-colliding-objects"),
    native<multibody_free_all>("multi-body.free-all-connected-objects"),
    native<multibody_get_location>("multi-body.get-location"),
    native<multibody_move>("multi-body.move"),
    native<multibody_rotate>("multi-body.rotate"),
    native<multibody_relative_rotate>("multi-body.relative-rotate"),
    native<multibody_set_rotation>("multi-body.set-rotation-matrix"),
    native<multibody_set_euler_angles>("multi-body.set-rotation-euler-angles"),
    native<multibody_point>("multi-body.point"),
    native<multibody_set_velocity>("multi-body.set-velocity"),
    native<multibody_set_rotational_velocity>("multi-body.set-rotational-velocity"),
    native<multibody_get_mass>("multi-body.get-mass"),
    native<multibody_center_of_mass>("multi-body.get-center-of-mass"),
    native<multibody_bound<true>>("multi-body.get-bound-maximum"),
    native<multibody_bound<false>>("multi-body.get-bound-minimum"),
    native<multibody_self_collisions<true>>("multi-body.enable-self-collisions"),
    native<multibody_self_collisions<false>>("multi-body.disable-self-collisions"),
    native<multibody_self_collision_parameters>("multi-body.set-self-collision-parameters"),
    native<multibody_check_self_penetration>("multi-body.check-self-penetration"),
    native<multibody_set_accuracy>("multi-body.set-accuracy"),
    native<multibody_get_accuracy>("multi-body.get-accuracy"),
    native<multibody_get_energy>("multi-body.get-energy"),
    native<multibody_get_residual>("multi-body.get-energy-residual"),
    native<multibody_get_motor_work>("multi-body.get-motor-work"),
    native<multibody_get_contact_loss>("multi-body.get-contact-loss"),
    native<multibody_get_ledger>("multi-body.get-energy-ledger"),
};

}  // namespace

std::span<const Native> assembly_natives() { return kAssemblyNatives; }

}  // namespace breve::steve
