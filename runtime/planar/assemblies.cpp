// Bodies that joints connect, as a whole: who belongs, how it is moved, what holds for it.
#include <fmt/format.h>

#include <algorithm>

#include "runtime/base/error.hpp"
#include "runtime/planar/core.hpp"

namespace breve {

void Planar::Core::collect(BodyIndex body, std::pmr::vector<BodyIndex>& out) const {
  out.clear();
  out.push_back(body);
  std::pmr::vector<BodyIndex> known({body}, memory);  // sorted
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto found = joints_at.find(out[i]);
    if (found == joints_at.end()) continue;
    for (const JointIndex index : found->second) {
      const JointDescription& is = joints[index].is;
      const BodyIndex other = is.parent == out[i] ? is.child : is.parent;
      // A body that does not move by itself connects nothing.
      if (other == kNoBody || !bodies->dynamic(other)) continue;
      const auto position = std::lower_bound(known.begin(), known.end(), other);
      if (position != known.end() && *position == other) continue;
      known.insert(position, other);
      out.push_back(other);
    }
  }
}

/// The bodies on the child's side of a joint: the assembly without the joint.
void Planar::Core::collect_beyond(JointIndex joint, std::pmr::vector<BodyIndex>& out) {
  FlatJoint& entry = joints[joint];
  const BodyIndex held = entry.is.parent;
  entry.is.parent = kNoBody;
  std::pmr::vector<JointIndex>* of = held == kNoBody ? nullptr : &joints_at.at(held);
  if (of) std::erase(*of, joint);
  collect(entry.is.child, out);
  entry.is.parent = held;
  if (of) insert_joint(joints, joint, *of);
}

bool Planar::Core::jointed(BodyIndex a, BodyIndex b) const {
  const auto found = joints_at.find(a);
  if (found == joints_at.end()) return false;
  return std::any_of(found->second.begin(), found->second.end(), [&](JointIndex index) {
    const JointDescription& is = joints[index].is;
    return (is.parent == a && is.child == b) || (is.parent == b && is.child == a);
  });
}

bool Planar::Core::held_by_world(BodyIndex body) const {
  std::pmr::vector<BodyIndex> all(memory);
  collect(body, all);
  for (const BodyIndex one : all) {
    const auto found = joints_at.find(one);
    if (found == joints_at.end()) continue;
    for (const JointIndex index : found->second) {
      const JointDescription& is = joints[index].is;
      if (is.parent == kNoBody || !bodies->dynamic(is.parent) || !bodies->dynamic(is.child)) return true;
    }
  }
  return false;
}

void Planar::Core::move_rigidly(std::span<const BodyIndex> some, const Pose& from, const Pose& to) {
  if (from.location == to.location && from.orientation.coeffs() == to.orientation.coeffs()) return;
  const Quaternion rotation = (to.orientation * from.orientation.conjugate()).normalized();
  for (const BodyIndex body : some) {
    const Vector3 arm = bodies->location(body) - from.location;
    bodies->set_location(body, to.location + rotation * arm);
    bodies->set_orientation(body, rotation * bodies->orientation(body));
    if (FlatBody* flat = find(body); flat && !flat->fixed) {
      const double before = kinetic_of(*flat);
      push_pose(*flat);
      push_velocity(*flat, flat->velocity, flat->spin.z());
      ledger.script_work += kinetic_of(*flat) - before;
      flat->location = bodies->location(body);
      flat->orientation = bodies->orientation(body);
    }
  }
}

/// Moves what is beyond a joint with its child, from one pose of that to another. The rates of all joints stay as they
/// are: what moves against the parent does so in directions that rotate with it.
void Planar::Core::place_beyond(std::span<const BodyIndex> some, BodyIndex parent, const Pose& from, const Pose& to) {
  if (from.location == to.location && from.orientation.coeffs() == to.orientation.coeffs()) return;
  const bool moves = parent != kNoBody && bodies->dynamic(parent);
  const auto carried = [&](BodyIndex body) -> Vector3 {
    if (!moves) return Vector3::Zero();
    return bodies->velocity(parent) +
           bodies->rotational_velocity(parent).cross(bodies->location(body) - bodies->location(parent));
  };
  for (const BodyIndex body : some) bodies->set_velocity(body, bodies->velocity(body) - carried(body));
  move_rigidly(some, from, to);
  const Quaternion rotation = (to.orientation * from.orientation.conjugate()).normalized();
  for (const BodyIndex body : some) bodies->set_velocity(body, rotation * bodies->velocity(body) + carried(body));
  if (b2) give_velocities(some);
}

/// `leader` was moved from there to where it is: all that joints connect with it goes along, including points of the
/// world that it hangs on.
void Planar::Core::follow(BodyIndex leader, const Pose& from) {
  std::pmr::vector<BodyIndex> all(memory);
  collect(leader, all);
  const Pose to = pose(leader);
  const Quaternion rotation = (to.orientation * from.orientation.conjugate()).normalized();
  move_rigidly(std::span<const BodyIndex>(all).subspan(1), from, to);
  for (const BodyIndex body : all) {
    const auto found = joints_at.find(body);
    if (found == joints_at.end()) continue;
    for (const JointIndex index : found->second) {
      JointDescription& is = joints[index].is;
      if (is.parent != kNoBody) continue;
      is.parent_point = to.location + rotation * (is.parent_point - from.location);
      is.relative_rotation = (rotation * is.relative_rotation).normalized();
      if (is.kind == JointKind::Prismatic) is.normal = rotation * is.normal;
      if (!joints[index].b2) continue;
      drop_b2(joints[index]);
      make_b2(joints[index]);
    }
  }
}

/// Numbers of the assemblies that bodies belong to, for the filter of contacts. A body without joints has none.
void Planar::Core::number_assemblies() {
  articulations_known = false;
  for (FlatBody& flat : slots) {
    flat.assembly = kNoSlot;
    flat.looped = false;
    flat.jointed = flat.body != kNoBody && joints_at.count(flat.body) != 0;
  }
  std::pmr::vector<BodyIndex> all(memory);
  for (std::uint32_t i = 0; i < slots.size(); ++i) {
    if (slots[i].body == kNoBody || !slots[i].jointed || slots[i].fixed || slots[i].assembly != kNoSlot) continue;
    collect(slots[i].body, all);
    const bool looped = has_loops(all);
    for (const BodyIndex body : all)
      if (FlatBody* flat = find(body)) flat->assembly = i, flat->looped = looped;
  }
}

/// Bodies of an assembly have more joints than would connect them, and what they hang on, without a loop.
bool Planar::Core::has_loops(std::span<const BodyIndex> all) const {
  std::size_t ends = 0, outer = 0;  // of joints, at these bodies and elsewhere
  for (const BodyIndex body : all)
    for (const JointIndex index : joints_at.at(body)) {
      const JointDescription& is = joints[index].is;
      const BodyIndex other = is.parent == body ? is.child : is.parent;
      ++(other == kNoBody || !bodies->dynamic(other) ? outer : ends);
    }
  const std::size_t tree = all.size() - (outer > 0 ? 0 : 1);
  return ends / 2 + outer > tree;
}

const AssemblySettings* Planar::Core::settings_of(BodyIndex body, bool (*wanted)(const AssemblySettings&)) const {
  if (own.empty()) return nullptr;
  std::pmr::vector<BodyIndex> all(memory);
  collect(body, all);
  std::sort(all.begin(), all.end());
  for (const BodyIndex one : all) {
    const auto found = own.find(one);
    if (found != own.end() && wanted(found->second)) return &found->second;
  }
  return nullptr;
}

bool Planar::Core::pushes(BodyIndex a, BodyIndex b, const MechanicsClient& asked) const {
  if (!bodies->dynamic(a) && !bodies->dynamic(b)) return false;
  const bool solid_a = bodies->dynamic(a) || bodies->driver(a);
  const bool solid_b = bodies->dynamic(b) || bodies->driver(b);
  if (!solid_a || !solid_b || asked.ignored(a, b)) return false;
  if (joints_at.empty()) return true;
  if (jointed(a, b)) return false;
  const FlatBody *x = find(a), *y = find(b);
  if (!x || !y || x->assembly == kNoSlot || x->assembly != y->assembly) return true;
  const AssemblySettings* found = settings_of(a, [](const AssemblySettings& s) { return s.has_self; });
  return found && found->self_collisions;
}

// --- the face -------------------------------------------------------------------------------------------------------

bool Planar::jointed(BodyIndex a, BodyIndex b) const { return core_->jointed(a, b); }

bool Planar::same_assembly(BodyIndex a, BodyIndex b) const {
  if (a == b) return true;
  const std::pmr::vector<BodyIndex> all = links_of(a);
  return std::binary_search(all.begin(), all.end(), b);
}

std::pmr::vector<BodyIndex> Planar::links_of(BodyIndex body) const {
  std::pmr::vector<BodyIndex> all(memory_);
  core_->collect(body, all);
  std::sort(all.begin(), all.end());
  return all;
}

std::pmr::vector<JointIndex> Planar::joints_of(BodyIndex body) const {
  std::pmr::vector<JointIndex> all(memory_);
  for (const BodyIndex link : links_of(body)) {
    const auto found = core_->joints_at.find(link);
    if (found != core_->joints_at.end()) all.insert(all.end(), found->second.begin(), found->second.end());
  }
  sort_joints(core_->joints, all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void Planar::move_assembly(BodyIndex body, const Vector3& location, const Quaternion& orientation) {
  Core& c = *core_;
  take_changes();
  const Pose from = c.pose(body);
  c.bodies->allowed_orientation(orientation);  // all or nothing
  c.bodies->set_location(body, location);
  c.bodies->set_orientation(body, orientation);
  if (c.joints_at.count(body) == 0) return;
  if (c.b2) return c.push_changes();
  c.follow(body, from);
}

void Planar::set_assembly_velocity(BodyIndex body, const Vector3& velocity, const Vector3& spin) {
  check_motion(velocity, spin);
  Core& c = *core_;
  c.bodies->allowed_velocity(velocity);  // all or nothing, of all links
  c.bodies->allowed_spin(spin);
  take_changes();
  const Vector3 center = c.bodies->location(body);
  const std::pmr::vector<BodyIndex> links = links_of(body);
  for (const BodyIndex link : links) {
    const Vector3 arm = c.bodies->location(link) - center;
    c.bodies->set_velocity(link, velocity + spin.cross(arm));
    c.bodies->set_rotational_velocity(link, spin);
  }
  if (!c.b2) return;
  c.give_velocities(links);
  c.allow_velocities(body);
}

void Planar::moved(BodyIndex body) {
  if (core_->joints_at.count(body) != 0) take_changes();
}

std::size_t Planar::self_penetrations(BodyIndex body) const {
  if (!self_collisions(body)) return 0;
  const std::pmr::vector<BodyIndex> links = links_of(body);
  std::size_t count = 0;
  for (std::size_t i = 0; i < links.size(); ++i)
    for (std::size_t k = i + 1; k < links.size(); ++k) {
      const BodyIndex a = links[i], b = links[k];
      if (jointed(a, b)) continue;
      const Shape &x = *core_->bodies->collision_shape(a), &y = *core_->bodies->collision_shape(b);
      // Box2D's bodies rest with an overlap of its slop.
      count += closest(x, core_->pose(a), y, core_->pose(b)).distance < -2 * b2_linearSlop * core_->settings.unit;
    }
  return count;
}

// --- settings of an assembly ----------------------------------------------------------------------------------------

const AssemblySettings* Planar::settings_of(BodyIndex body, bool (*wanted)(const AssemblySettings&)) const {
  return core_->settings_of(body, wanted);
}

void Planar::set_self_collision_parameters(BodyIndex, double erp, double cfm) {
  check_softness_within(erp, cfm);  // Box2D has neither
}

}  // namespace breve
