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
  if (member.kind == JointKind::Fixed) return;
  const WarmJoint warm = core_.warm_of(joint);
  const auto note = [&](const auto* b, double strength) {
    const bool holds = b->IsMotorEnabled() && std::abs(double{warm.motor}) < kFull * strength * dt;
    if (b->IsLimitEnabled() && warm.lower > 0) member.low = double{b->GetLowerLimit()};
    if (b->IsLimitEnabled() && warm.upper > 0) member.high = double{b->GetUpperLimit()};
    member.locked = holds || member.low > -JointDrive::kNoLimit || member.high < JointDrive::kNoLimit;
    member.strength = b->IsMotorEnabled() ? strength * dt : 0;
    member.target = double{b->GetMotorSpeed()};
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
void Planar::Core::Assembly::aim(std::size_t index, double dt) {
  Member& member = joints_[index];
  if (!member.locked || !member.limited()) return;
  const double travel = travel_of(index, before_);
  member.target = member.low > -JointDrive::kNoLimit ? -std::max(travel - member.low, 0.0) / dt
                                                     : std::max(member.high - travel, 0.0) / dt;
}

/// The position of a joint along its own axis, as Box2D counts it.
double Planar::Core::Assembly::travel_of(std::size_t index, std::span<const FlatPose> poses) const {
  const Member& member = joints_[index];
  const auto [parent, child] = ends_of(index, poses);
  if (member.kind == JointKind::Revolute) return child.angle - parent.angle - member.reference;
  const Vector2 way = child.point(member.child_point) - parent.point(member.parent_point);
  return way.dot(parent.rotated(member.axis));
}

/// Motors that would need more than their strength, and limits that would pull, are released. Whether there were any.
bool Planar::Core::Assembly::release() {
  bool any = false;
  for (Member& member : joints_) {
    if (!member.locked || member.kind == JointKind::Fixed) continue;
    const double given = member.impulse[member.free_row()];
    const bool lower = member.low > -JointDrive::kNoLimit, upper = member.high < JointDrive::kNoLimit;
    const bool pulls = (lower && !upper && given < 0) || (upper && !lower && given > 0);
    const bool weak = !lower && !upper && std::abs(given) > member.strength;
    if (!pulls && !weak) continue;
    member.locked = false;
    member.load = std::copysign(weak ? member.strength : 0, given);
    any = true;
  }
  return any;
}

}  // namespace breve
