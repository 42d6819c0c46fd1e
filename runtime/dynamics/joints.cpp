// The table of joints: making, breaking, placing the child, driving.
#include <algorithm>
#include <cmath>

#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/inverse_dynamics.hpp"
#include "runtime/dynamics/core.hpp"
#include "runtime/mechanics/members.hpp"

namespace breve {

namespace {

/// The joint is one of its two bodies', in the order of creation.
void attach(Dynamics::Core& core, JointIndex joint) {
  const JointEntry& entry = core.joints[joint];
  for (const BodyIndex end : {entry.is.child, entry.is.parent}) {
    if (end == kNoBody) continue;
    core.touch_tree(end);
    insert_joint(core.joints, joint, core.entry(end).joints);
  }
}

}  // namespace

JointEntry& Dynamics::Core::at(JointIndex joint) {
  if (joint >= joints.size() || !joints[joint].used) fail_no_joint();
  return joints[joint];
}

void Dynamics::Core::collect(BodyIndex body, std::pmr::vector<BodyIndex>& out) {
  out.clear();
  out.push_back(body);
  if (!find(body)) return;
  ++search;
  find(body)->mark = search;
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (const JointIndex index : find(out[i])->joints) {
      const JointDescription& is = joints[index].is;
      const BodyIndex other = is.parent == out[i] ? is.child : is.parent;
      // A body that does not move by itself connects nothing.
      if (other == kNoBody || !bodies->dynamic(other) || find(other)->mark == search) continue;
      find(other)->mark = search;
      out.push_back(other);
    }
  }
}

bool Dynamics::Core::held_by_world(BodyIndex body) {
  std::pmr::vector<BodyIndex> all(memory);
  collect(body, all);
  for (const BodyIndex one : all) {
    if (!find(one)) continue;
    for (const JointIndex index : find(one)->joints) {
      const JointDescription& is = joints[index].is;
      if (is.parent == kNoBody || !bodies->dynamic(is.parent) || !bodies->dynamic(is.child)) return true;
    }
  }
  return false;
}

void Dynamics::Core::move_rigidly(std::span<const BodyIndex> some, const Pose& from, const Pose& to) {
  const Quaternion rotation = (to.orientation * from.orientation.conjugate()).normalized();
  for (const BodyIndex body : some) {
    const Vector3 arm = bodies->location(body) - from.location;
    bodies->set_location(body, to.location + rotation * arm);
    bodies->set_orientation(body, rotation * bodies->orientation(body));
  }
}

void Dynamics::Core::place_child(JointEntry& joint) {
  JointDescription& is = joint.is;
  const Pose parent = is.parent == kNoBody ? Pose{} : pose(is.parent);
  const Pose now = pose(is.child);
  if (is.keep_rotation) is.relative_rotation = relative_rotation_that_keeps(is, between(is).first);
  Pose wanted = pose_at_zero(is, parent);
  if (is.keep_rotation) {
    wanted.location += wanted.orientation * is.child_point - now.orientation * is.child_point;
    wanted.orientation = now.orientation;
  }
  std::pmr::vector<BodyIndex> all(memory);
  collect(is.child, all);
  if (is.parent != kNoBody && std::find(all.begin(), all.end(), is.parent) != all.end()) {
    joint.loop = true;
    return;
  }
  if (held_by_world(is.child)) {
    joint.loop = true;
    return;
  }
  joint.loop = false;
  if (wanted.location == now.location && wanted.orientation.coeffs() == now.orientation.coeffs()) return;
  move_rigidly(all, now, wanted);
}

void Dynamics::Core::touch_tree(BodyIndex body) {
  near.wake(body);
  if (const BodyEntry* known = find(body); known && known->tree != kNone) drop_tree(known->tree);
  graph_changed = true;
}

JointIndex Dynamics::link(const JointDescription& description, ObjectId owner) {
  Core& c = core();
  check(description, *c.bodies);
  check_reach(description);
  c.sync_changes();
  reserve_free(c.joints, c.free_joints);
  JointEntry made;
  made.used = true;
  made.owner = owner;
  made.is = description;
  made.is.relative_rotation.normalize();
  made.is.normal.stableNormalize();
  BodyIndex ends[2] = {description.child, description.parent};
  for (const BodyIndex end : ends) {
    if (end == kNoBody) continue;
    BodyEntry& entry = c.entry(end);
    entry.joints.reserve(entry.joints.size() + 1);
  }
  for (const BodyIndex end : ends)
    if (end != kNoBody && c.bodies->kind(end) != BodyKind::Stationary) c.bodies->set_physics(end, true);
  c.place_child(made);  // the last that may be refused
  const JointIndex index = take_slot(c.joints, c.free_joints);
  made.serial = c.next_serial++;
  for (const BodyIndex end : ends) {
    if (end == kNoBody) continue;
    c.touch_tree(end);
    c.entry(end).joints.push_back(index);
  }
  c.joints[index] = made;
  c.note_joined(index);
  return index;
}

void Dynamics::Core::note_joined(JointIndex joint) {
  // From now on whoever moves one of them moves all.
  std::pmr::vector<BodyIndex> all(memory);
  for (const BodyIndex end : {joints[joint].is.child, joints[joint].is.parent}) {
    if (end == kNoBody || !bodies->dynamic(end) || (find(end)->known && find(end)->tree != kNone)) continue;
    if (!find(end)->known) note_written(end);
  }
  if (joints[joint].loop) return;
  collect(joints[joint].is.child, all);
  for (const BodyIndex body : all) note_written(body);
}

void Dynamics::Core::detach(JointIndex index) {
  JointEntry& joint = joints[index];
  for (const BodyIndex end : {joint.is.child, joint.is.parent}) {
    if (end == kNoBody) continue;
    touch_tree(end);
    std::erase(entry(end).joints, index);
    if (!needs_tree(end)) entry(end).known = false;
  }
}

void Dynamics::unlink(JointIndex joint) {
  Core& c = core();
  c.at(joint);
  c.sync_changes();
  c.detach(joint);
  c.joints[joint] = JointEntry();
  c.free_joints.push_back(joint);
}

void Dynamics::relink(JointIndex joint, const JointDescription& description) {
  Core& c = core();
  c.at(joint);
  check(description, *c.bodies);
  check_reach(description);
  c.sync_changes();
  c.detach(joint);
  JointEntry changed = c.joints[joint];
  changed.is = description;
  changed.is.relative_rotation.normalize();
  changed.is.normal.stableNormalize();
  changed.tree = kNone;
  changed.link = -1;
  for (const BodyIndex end : {description.child, description.parent})
    if (end != kNoBody && c.bodies->kind(end) != BodyKind::Stationary) c.bodies->set_physics(end, true);
  try {
    c.place_child(changed);
  } catch (...) {
    attach(c, joint);
    throw;
  }
  c.joints[joint] = changed;
  attach(c, joint);
  c.note_joined(joint);
}

const JointRecord* Dynamics::joint_record(JointIndex joint) const {
  return core_ && joint < core_->joints.size() && core_->joints[joint].used ? &core_->joints[joint] : nullptr;
}

std::size_t Dynamics::joint_count() const { return core_ ? core_->joints.size() - core_->free_joints.size() : 0; }

JointReaction Dynamics::reaction(JointIndex joint) const {
  if (!core_) fail_no_joint();
  core_->take_changes();
  const JointEntry& entry = core_->at(joint);
  return entry.tree == kNone ? JointReaction() : core_->react(entry);
}

JointReaction Dynamics::Core::react(const JointEntry& joint) {
  Tree& tree = *trees[joint.tree];
  set_loads(tree, accuracy_of(joint.is.child), 0);
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    tree.loads.wrenches[i].force += tree.links[i].contact.force;
    tree.loads.wrenches[i].couple += tree.links[i].contact.couple;
  }
  if (tree.loads.tau.size() == 0) tree.loads.tau.setZero(tree.model.velocities());
  tree.loads.tau += tree.limit_force;
  articulated::Vector acceleration = articulated::forward_dynamics(tree.model, tree.data, tree.state, tree.loads, 0);
  JointReaction of_loop;
  if (!tree.loops.empty()) {
    hold(tree, acceleration.data(), true, false);
    of_loop = push_by_loops(tree, static_cast<JointIndex>(&joint - joints.data()));
  }
  if (joint.link < 0) return of_loop;
  articulated::Vector tau(tree.model.velocities());
  articulated::inverse_dynamics(tree.model, tree.data, tree.state, acceleration, tree.loads, tau);
  // The wrench through the joint on the tree's side beyond it, about the joint's point.
  const articulated::Work& work = tree.data.of(joint.link);
  const double sign = joint.flipped ? -1 : 1;
  return {sign * work.force, sign * work.couple};
}

void Dynamics::set_drive(JointIndex joint, const JointDrive& drive) {
  Core& c = core();
  JointEntry& entry = c.at(joint);
  check(drive, entry.is.kind);
  const bool had_motor = entry.drive.strength_limit > 0;
  JointDrive set = drive;
  set.strength_limit = std::clamp(drive.strength_limit, 0.0, strength_hard_limit(joint));
  if (c.near.asleep(entry.is.child) && !members::same(set, entry.drive)) c.near.wake(entry.is.child);
  entry.drive = set;
  if (entry.tree != kNone) c.trees[entry.tree]->changed = true;  // its spring may hold more or less
  // The integrator keeps the impulse of each motor.
  if (had_motor != (entry.drive.strength_limit > 0)) c.integrators_changed = true;
}

}  // namespace breve
