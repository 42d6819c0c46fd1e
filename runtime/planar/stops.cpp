// Limits of joints that give back speed. Box2D's limits stop what reaches them; where a joint has a restitution and
// comes fast, its limit is off until it is there: the sub-step is cut at that moment, and an impulse in the joint's own
// coordinate turns it round, which all that joints connect answers.
#include <algorithm>
#include <cmath>

#include "runtime/planar/response.hpp"

namespace breve {

namespace {

constexpr double kThere = 1e-5;  // rad or length units: nearer than this is at the limit

/// The end of its range that a joint moves toward, in Box2D's units: rad or length units.
struct End {
  double gap = 0;   // what is left; negative beyond it
  double rate = 0;  // of the gap; negative while it comes
  double bend = 0;  // of the rate
};

template <class Joint>
bool find_end(const Joint& b, double at, double rate, double bend, bool bounded, End& end) {
  if (!bounded || rate == 0) return false;
  end = rate < 0 ? End{at - double{b.GetLowerLimit()}, rate, bend} : End{double{b.GetUpperLimit()} - at, -rate, -bend};
  return true;
}

template <class Joint>
bool keeps_within(const Joint& b, double at, double goes) {
  return at + std::min(goes, 0.0) > double{b.GetLowerLimit()} && at + std::max(goes, 0.0) < double{b.GetUpperLimit()};
}

bool end_ahead(const FlatJoint& joint, double rate, End& end) {
  const JointDrive& drive = joint.drive;
  if (!joint.used || !joint.b2 || !(drive.limit_restitution > 0) || joint.is.kind == JointKind::Fixed) return false;
  const bool bounded = std::isfinite(drive.low[0]) || std::isfinite(drive.high[0]);
  if (joint.is.kind == JointKind::Revolute) {
    const auto& b = *static_cast<const b2RevoluteJoint*>(joint.b2);
    return find_end(b, b.GetJointAngle(), rate, joint.bend, bounded, end);
  }
  const auto& b = *static_cast<const b2PrismaticJoint*>(joint.b2);
  return find_end(b, b.GetJointTranslation(), rate, joint.bend, bounded, end);
}

void set_limit(FlatJoint& joint, bool on) {
  if (joint.is.kind == JointKind::Revolute)
    static_cast<b2RevoluteJoint*>(joint.b2)->EnableLimit(on);
  else
    static_cast<b2PrismaticJoint*>(joint.b2)->EnableLimit(on);
}

/// From the centre of mass of a body, of either end, to the child's point of a joint.
Vector2 arm_of(const FlatJoint& joint, const FlatBody& flat) {
  const b2Vec2 at = joint.b2->GetAnchorB(), center = flat.b2->GetWorldCenter();
  return {double{at.x} - center.x, double{at.y} - center.y};
}

}  // namespace

/// Slower than this a joint rests at its limit, rad/s or length units/s: what it takes up in a sub-step.
double Planar::Core::slowest_rebound(const FlatJoint& joint) const {
  constexpr double kLeast = 1e-3;
  const double reach =
      joint.is.kind == JointKind::Revolute ? bodies->collision_shape(joint.is.child)->bounding_radius() : settings.unit;
  return std::max({std::abs(joint.bend) * step_length, settings.gravity.norm() * step_length / reach, kLeast});
}

/// Whether a joint that moves on as it does now reaches neither of its limits within dt.
bool Planar::Core::keeps_within_limits(const FlatJoint& joint, double dt) const {
  const double goes = dt * joint_rate(joint);
  if (joint.is.kind == JointKind::Revolute) {
    const auto& b = *static_cast<const b2RevoluteJoint*>(joint.b2);
    return keeps_within(b, b.GetJointAngle(), goes);
  }
  const auto& b = *static_cast<const b2PrismaticJoint*>(joint.b2);
  return keeps_within(b, b.GetJointTranslation(), goes);
}

/// Limits that are to bounce what comes now are off; `bounce` false: none.
void Planar::Core::set_stops(bool bounce) {
  for (FlatJoint& joint : joints) {
    if (!steps(joint)) continue;
    End end;
    const double rate = joint.used && joint.b2 && joint.drive.limit_restitution > 0 ? joint_rate(joint) : 0;
    const bool loose = bounce && end_ahead(joint, rate, end) && -end.rate > slowest_rebound(joint);
    if (loose == joint.loose) continue;
    joint.loose = loose;
    if (joint.b2 && joint.is.kind != JointKind::Fixed)
      set_limit(joint, !loose && has_limits(joint.drive, joint.is.kind));
  }
}

/// Whether a joint reaches a limit, at which it bounces, t seconds from now and before dt is over.
bool Planar::Core::stops_within(const FlatJoint& joint, double dt, double& t) const {
  if (!(joint.drive.limit_restitution > 0) || !joint.b2->GetBodyB()->IsAwake()) return false;
  End end;
  if (!end_ahead(joint, joint_rate(joint), end) || !(-end.rate > slowest_rebound(joint))) return false;
  t = 0;
  if (end.gap > kThere) {
    // On `fast` only few of them: each is a step of all that steps.
    constexpr int kShare = 256;
    if (!settings.accuracy.locate_impacts && !(awake > 0 && located < kShare / awake)) return false;
    // Box2D moves by the velocity at the end of a step: gap + rate t + bend t^2.
    const double root = end.rate * end.rate - 4 * end.bend * end.gap;
    if (!(root >= 0)) return false;
    t = 2 * end.gap / (std::sqrt(root) - end.rate);
  }
  return t < dt;
}

/// The joint that reaches its limit first within dt, if it does so before what was found already.
bool Planar::Core::find_stop(double dt, bool found, Hit& best) const {
  for (JointIndex index = 0; index < joints.size(); ++index) {
    const FlatJoint& joint = joints[index];
    double t = 0;
    if (!joint.used || !joint.b2 || !stops_within(joint, dt, t) || (found && best.t <= t)) continue;
    best = Hit{};
    best.t = t;
    best.stop = index;
    found = true;
  }
  return found;
}

/// Turns round the joint that has come to its limit: the impulse is a torque, or a force along its axis, on both ends.
void Planar::Core::rebound(JointIndex index) {
  FlatJoint& joint = joints[index];
  FlatBody* child = find(joint.is.child);
  FlatBody* parent = joint.is.parent == kNoBody ? nullptr : find(joint.is.parent);
  const Response response(*this, parent, child);
  const double before = response.kinetic();
  // Box2D's solver leaves velocities that the joints do not quite allow: what they forbid would be multiplied.
  response.give(response.allowed(response.velocities()));
  End end;
  const double rate = joint_rate(joint);
  if (end_ahead(joint, rate, end) && end.gap <= kThere) {
    Response::Vector change;
    double yields = 0;
    if (joint.is.kind == JointKind::Revolute) {
      change = response.answer_rotation();
      yields = response.spin(*child, change) - (parent ? response.spin(*parent, change) : 0);
    } else {
      const Vector2 axis = axis_of(joint);
      const Vector2 arm = arm_of(joint, *child), other = parent ? arm_of(joint, *parent) : Vector2::Zero();
      change = response.answer(other, arm, axis);
      yields = axis.dot(response.at_point(*child, arm, change) -
                        (parent ? response.at_point(*parent, other, change) : Vector2::Zero()));
    }
    if (yields > 0) response.give(-(1 + joint.drive.limit_restitution) * rate / yields * change);
  }
  // A limit gives nothing: that would be round-off of single precision.
  ledger.limit_loss += std::max(0.0, before - response.kinetic()) * settings.unit * settings.unit;
  spread(*child, parent ? *parent : *child);
}

}  // namespace breve
