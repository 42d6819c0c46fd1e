// What motors and limits do in an assembly that is solved as a whole: which of them decide the rate of their joint is
// what Box2D has found, and what that takes may show that they do not.
#include <algorithm>
#include <cmath>

#include "runtime/planar/assembly.hpp"

namespace breve {

/// Whether a motor below its strength, or a limit, has decided the rate of a joint's own axis.
void Planar::Core::Assembly::note_drive(Member& member, double dt) {
  constexpr double kFull = 0.999;  // of its strength: a force
  const FlatJoint& joint = core_.joints[member.joint];
  member.locked = false;
  member.load = 0;
  member.low = -JointDrive::kNoLimit;
  member.high = JointDrive::kNoLimit;
  member.least = -JointDrive::kNoLimit;
  member.most = JointDrive::kNoLimit;
  member.caught = false;
  member.strength = 0;
  if (member.kind == JointKind::Fixed) return;
  const WarmJoint warm = core_.warm_of(joint);
  const auto note = [&](const auto* b, double strength) {
    const bool holds = b->IsMotorEnabled() && std::abs(double{warm.motor}) < kFull * strength * dt;
    if (b->IsLimitEnabled() || joint.loose) {
      member.least = double{b->GetLowerLimit()};
      member.most = double{b->GetUpperLimit()};
      // Where it is to bounce it is held as soon as it has come there; its motor may drive it back to the other end.
      if (joint.loose) (joint.rate < 0 ? member.least : member.most) = std::copysign(JointDrive::kNoLimit, joint.rate);
      if (warm.lower > 0) member.low = member.least;
      if (warm.upper > 0) member.high = member.most;
    }
    member.locked = holds || member.limited();
    member.strength = b->IsMotorEnabled() ? strength * dt : 0;
    member.target = member.speed = double{b->GetMotorSpeed()};
    if (!member.locked) member.load = double{warm.motor};
  };
  if (member.kind == JointKind::Revolute) {
    const auto* b = static_cast<const b2RevoluteJoint*>(joint.b2);
    note(b, double{b->GetMaxMotorTorque()});
  } else {
    const auto* b = static_cast<const b2PrismaticJoint*>(joint.b2);
    note(b, double{const_cast<b2PrismaticJoint*>(b)->GetMaxMotorForce()});
  }
}

/// A limit is reached at the end of the sub-step and stops its joint there; a motor keeps its speed.
void Planar::Core::Assembly::aim(Member& member, double dt) {
  if (!member.locked || !member.limited()) return;
  member.target = std::isfinite(member.low) ? -std::max(member.travel - member.low, 0.0) / dt
                                            : std::max(member.high - member.travel, 0.0) / dt;
}

/// The position of a joint along its own axis, as Box2D counts it.
double Planar::Core::Assembly::travel_of(std::size_t index, std::span<const FlatPose> poses) const {
  const Member& member = joints_[index];
  const auto [parent, child] = ends_of(index, poses);
  if (member.kind == JointKind::Revolute) return child.angle - parent.angle - member.reference;
  const Vector2 way = child.point(member.child_point) - parent.point(member.parent_point);
  return way.dot(parent.rotated(member.axis));
}

/// What its motor gives a joint that a limit holds: all its strength toward its speed. A motor that is to stand gives
/// what the limit would have to pull.
double Planar::Core::Assembly::motor_share(const Member& member) {
  const double ahead = member.speed - member.target;
  if (ahead != 0) return std::copysign(member.strength, ahead);
  return std::isfinite(member.low) ? -member.strength : member.strength;
}

/// An impulse along a joint's own axis, at these poses.
void Planar::Core::Assembly::push(std::size_t index, double impulse, std::span<const FlatPose> poses) {
  if (impulse == 0) return;
  const auto [of_parent, of_child] = axis_rows(index, poses);
  const JointSystem::Ends& ends = system_.ends(index);
  for (const auto& [end, row] : {std::pair{ends.parent, &of_parent}, {ends.child, &of_child}})
    if (const auto link = static_cast<std::size_t>(end); end >= 0)
      velocities_[link] += impulse * mobility_[link].cwiseProduct(*row);
}

/// The spring and damper of a prismatic joint pull along an axis that rotates with the parent. Forces on its two ends
/// that stayed as they were at first would change the angular momentum, so the joint pushes instead of them.
void Planar::Core::Assembly::take_spring(std::size_t index) {
  Member& member = joints_[index];
  member.spring = 0;
  if (member.kind != JointKind::Prismatic) return;
  member.spring = -core_.joints[member.joint].pull / core_.settings.unit;
  if (member.spring == 0) return;
  const auto [of_parent, of_child] = axis_rows(index, before_);
  const JointSystem::Ends& ends = system_.ends(index);
  for (const auto& [end, row] : {std::pair{ends.parent, &of_parent}, {ends.child, &of_child}})
    if (const auto link = static_cast<std::size_t>(end); end >= 0)
      forces_[link] -= member.spring * mobility_[link].cwiseProduct(*row);
}

/// The part of a joint's spring that acts before its links move.
double Planar::Core::Assembly::early(std::size_t index) const {
  const JointSystem::Ends& ends = system_.ends(index);
  return early(links_[static_cast<std::size_t>(std::max(ends.parent, ends.child))]);
}

/// Motors that would need more than their strength, and limits that would pull, are released. Whether there were any.
bool Planar::Core::Assembly::release() {
  bool any = false;
  for (Member& member : joints_) {
    if (!member.locked || member.kind == JointKind::Fixed) continue;
    const double given = member.impulse[member.free_row()];
    const bool lower = std::isfinite(member.low), upper = std::isfinite(member.high);
    if (lower && upper) continue;
    if (lower || upper) {
      const double share = motor_share(member), side = lower ? 1 : -1;
      if (!(side * (given - share) < 0)) continue;
      member.low = -JointDrive::kNoLimit;
      member.high = JointDrive::kNoLimit;
      member.target = member.speed;
      member.locked = side * share > 0;  // the motor moves it away, but no faster than it is to
      member.load = member.locked ? 0 : share;
    } else if (std::abs(given) > member.strength) {
      member.locked = false;
      member.load = std::copysign(member.strength, given);
    } else {
      continue;
    }
    any = true;
  }
  return any;
}

/// Joints that have come beyond a limit, of which Box2D knew nothing along their curved paths, are held at it. Whether
/// there were any. A joint that was caught and released stays free.
bool Planar::Core::Assembly::catch_up(double dt) {
  bool any = false;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Member& member = joints_[i];
    if (member.limited() || member.caught) continue;
    if (!std::isfinite(member.least) && !std::isfinite(member.most)) continue;
    const double travel = travel_of(i, after_);
    if (travel < member.least)
      member.low = member.least;
    else if (travel > member.most)
      member.high = member.most;
    else
      continue;
    member.locked = member.caught = any = true;
    member.load = 0;
    aim(member, dt);
  }
  return any;
}

}  // namespace breve
