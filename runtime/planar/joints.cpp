// Joints of a flat world: the table, and what Box2D's joints make of each. Positions are positive when the parent turns
// or moves along the normal relative to the child; Box2D's are those of the second body, the child, so they are the
// negatives where the normal is +z.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "runtime/base/error.hpp"
#include "runtime/mechanics/joint_axes.hpp"
#include "runtime/mechanics/members.hpp"
#include "runtime/planar/core.hpp"

namespace breve {

namespace {

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorCode::Argument, what); }

constexpr double kInPlane = 1e-9;

void need_in_plane(const Vector3& v, const char* what, JointKind kind) {
  if (std::abs(v.z()) > kInPlane * std::max(1.0, v.norm()))
    refuse(fmt::format("{} joint: {} is ({}, {}, {}), but this world is flat: z must be 0", name_of(kind), what, v.x(),
                       v.y(), v.z()));
}

}  // namespace

FlatJoint& Planar::Core::at(JointIndex joint) {
  if (joint >= joints.size() || !joints[joint].used) fail_no_joint();
  return joints[joint];
}

void Planar::Core::check_flat(const JointDescription& is) const {
  check(is, *bodies);
  if (is.kind == JointKind::Universal || is.kind == JointKind::Ball)
    refuse(fmt::format("a {} joint rotates about axes outside the plane, but this world is flat: use a RevoluteJoint",
                       name_of(is.kind)));
  need_in_plane(is.parent_point, "the parent's point", is.kind);
  need_in_plane(is.child_point, "the child's point", is.kind);
  const Quaternion rotation = is.relative_rotation.normalized();
  if (std::hypot(rotation.x(), rotation.y()) > kInPlane)
    refuse(fmt::format("{} joint: the relative rotation is not about z, but this world is flat", name_of(is.kind)));
  if (is.kind == JointKind::Revolute && is.normal.head<2>().norm() > kInPlane * is.normal.norm())
    refuse(
        fmt::format("revolute joint: the normal is ({}, {}, {}), but this world is flat: bodies rotate about z only, "
                    "the normal must be (0, 0, 1) or (0, 0, -1)",
                    is.normal.x(), is.normal.y(), is.normal.z()));
  if (is.kind == JointKind::Prismatic) need_in_plane(is.normal, "the normal", is.kind);
}

namespace {

JointDescription flattened(JointDescription is) {
  is.relative_rotation.normalize();
  is.relative_rotation = Quaternion(is.relative_rotation.w(), 0, 0, is.relative_rotation.z()).normalized();
  is.parent_point.z() = is.child_point.z() = 0;
  if (is.kind == JointKind::Revolute) is.normal = {0, 0, is.normal.z() < 0 ? -1.0 : 1.0};
  if (is.kind == JointKind::Prismatic) {
    is.normal.z() = 0;
    is.normal.stableNormalize();
  }
  return is;
}

}  // namespace

void Planar::Core::place_child(FlatJoint& joint) {
  JointDescription& is = joint.is;
  const Pose parent = is.parent == kNoBody ? Pose{} : pose(is.parent);
  const Pose now_at = pose(is.child);
  if (is.keep_rotation)
    is.relative_rotation = relative_rotation_that_keeps(is, parent.orientation.conjugate() * now_at.orientation);
  Pose wanted = pose_at_zero(is, parent);
  if (is.keep_rotation) {
    wanted.location += wanted.orientation * is.child_point - now_at.orientation * is.child_point;
    wanted.orientation = now_at.orientation;
  }
  std::pmr::vector<BodyIndex> all(memory);
  collect(is.child, all);
  const bool connected = is.parent != kNoBody && std::find(all.begin(), all.end(), is.parent) != all.end();
  joint.loop = connected || held_by_world(is.child);
  if (!joint.loop) move_rigidly(all, now_at, wanted);
  joint.position = 0;
  joint.position = read_position(joint);
}

namespace {

/// A body with a list of joints is an anchor: one for which a joint was refused must not stay one.
void drop_empty_lists(Planar::Core& core, std::span<const BodyIndex> bodies) {
  for (const BodyIndex body : bodies)
    if (const auto found = core.joints_at.find(body); found != core.joints_at.end() && found->second.empty())
      core.joints_at.erase(found);
}

/// The joint is one of its two bodies', in the order of creation.
void attach(Planar::Core& core, JointIndex joint) {
  const FlatJoint& entry = core.joints[joint];
  for (const BodyIndex end : {entry.is.child, entry.is.parent}) {
    if (end == kNoBody) continue;
    insert_joint(core.joints, joint, core.joints_at.try_emplace(end).first->second);
  }
}

}  // namespace

JointIndex Planar::link(const JointDescription& description, ObjectId owner) {
  Core& c = *core_;
  c.check_flat(description);
  check_reach(description);
  take_changes();
  reserve_free(c.joints, c.free_joints);
  FlatJoint made;
  made.used = true;
  made.owner = owner;
  made.is = flattened(description);
  const BodyIndex ends[2] = {description.child, description.parent};
  for (const BodyIndex end : ends)
    if (end != kNoBody) c.joints_at.try_emplace(end).first->second.reserve(c.joints_at.at(end).size() + 1);
  if (c.free_joints.empty()) c.joints.reserve(c.joints.size() + 1);
  for (const BodyIndex end : ends)
    if (end != kNoBody && c.bodies->kind(end) != BodyKind::Stationary) c.bodies->set_physics(end, true);
  try {
    c.place_child(made);
  } catch (...) {
    drop_empty_lists(c, ends);
    throw;
  }
  made.serial = c.next_serial++;
  const JointIndex index = take_slot(c.joints, c.free_joints);
  c.joints[index] = made;
  for (const BodyIndex end : ends)
    if (end != kNoBody) c.joints_at.at(end).push_back(index);
  c.members_changed = true;
  ++c.rules;
  c.ensure_world();  // so that a body moved from now on takes the others along
  return index;
}

void Planar::Core::detach(JointIndex index) {
  FlatJoint& joint = joints[index];
  drop_b2(joint);
  for (const BodyIndex end : {joint.is.child, joint.is.parent}) {
    const auto found = joints_at.find(end);
    if (end == kNoBody || found == joints_at.end()) continue;
    std::erase(found->second, index);
    if (found->second.empty()) joints_at.erase(found);
    wake(end);
  }
  if (frozen) std::erase_if(frozen->joints, [&](const FrozenJoint& one) { return one.joint == index; });
  members_changed = true;
  ++rules;
}

void Planar::unlink(JointIndex joint) {
  Core& c = *core_;
  c.at(joint);
  c.detach(joint);
  c.joints[joint] = FlatJoint();
  c.free_joints.push_back(joint);
}

void Planar::relink(JointIndex joint, const JointDescription& description) {
  Core& c = *core_;
  c.at(joint);
  c.check_flat(description);
  check_reach(description);
  take_changes();
  c.detach(joint);
  FlatJoint& changed = c.joints[joint];
  const JointDescription before = changed.is;
  changed.is = flattened(description);
  for (const BodyIndex end : {description.child, description.parent})
    if (end != kNoBody && c.bodies->kind(end) != BodyKind::Stationary) c.bodies->set_physics(end, true);
  try {
    c.place_child(changed);
  } catch (...) {
    changed.is = before;
    attach(c, joint);
    throw;
  }
  attach(c, joint);
  c.ensure_world();
}

const JointRecord* Planar::joint_record(JointIndex joint) const {
  return joint < core_->joints.size() && core_->joints[joint].used ? &core_->joints[joint] : nullptr;
}

std::size_t Planar::joint_count() const { return core_->joints.size() - core_->free_joints.size(); }

void Planar::set_drive(JointIndex joint, const JointDrive& drive) {
  FlatJoint& entry = core_->at(joint);
  check(drive, entry.is.kind);
  JointDrive set = drive;
  set.strength_limit = std::clamp(drive.strength_limit, 0.0, strength_hard_limit(joint));
  if (asleep(entry.is.child) && !members::same(set, entry.drive)) core_->wake(entry.is.child);
  entry.drive = set;
  core_->put_drive(entry);
}

// --- where it stands ------------------------------------------------------------------------------------------------

double Planar::Core::read_position(const FlatJoint& joint) const {
  const JointDescription& is = joint.is;
  if (is.kind == JointKind::Fixed) return 0;
  const Pose parent = is.parent == kNoBody ? Pose{} : pose(is.parent), child = pose(is.child);
  if (is.kind == JointKind::Revolute) {
    const double rotation = angle_of(child.orientation) - angle_of(parent.orientation) - angle_of(is.relative_rotation);
    return joint.position + std::remainder(-sense(is) * rotation - joint.position, 2 * M_PI);
  }
  const Vector3 way =
      child.location + child.orientation * is.child_point - parent.location - parent.orientation * is.parent_point;
  return -way.dot(parent.orientation * is.normal);
}

double Planar::Core::read_velocity(const FlatJoint& joint) const {
  const JointDescription& is = joint.is;
  const bool world = is.parent == kNoBody || !bodies->dynamic(is.parent);
  const Vector3 none = Vector3::Zero();
  const Vector3 parent_spin = world ? none : bodies->rotational_velocity(is.parent);
  if (is.kind == JointKind::Revolute) return -sense(is) * (bodies->rotational_velocity(is.child).z() - parent_spin.z());
  if (is.kind != JointKind::Prismatic) return 0;
  const Pose parent = is.parent == kNoBody ? Pose{} : pose(is.parent), child = pose(is.child);
  const Vector3 arm = child.orientation * is.child_point, point = child.location + arm;
  const Vector3 of_child = bodies->velocity(is.child) + bodies->rotational_velocity(is.child).cross(arm);
  // The parent carries the axis along.
  const Vector3 of_parent =
      world ? none : Vector3(bodies->velocity(is.parent) + parent_spin.cross(point - parent.location));
  return -(of_child - of_parent).dot(parent.orientation * is.normal);
}

double Planar::Core::gap(const FlatJoint& joint) const {
  const JointDescription& is = joint.is;
  const Pose parent = is.parent == kNoBody ? Pose{} : pose(is.parent), child = pose(is.child);
  Vector3 way =
      child.location + child.orientation * is.child_point - parent.location - parent.orientation * is.parent_point;
  if (is.kind == JointKind::Prismatic) {
    const Vector3 axis = parent.orientation * is.normal;
    way -= way.dot(axis) * axis;
  }
  return way.norm();
}

}  // namespace breve
