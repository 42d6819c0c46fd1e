// What Box2D's joints make of ours: their ends, motors and limits, and the impulses that a step starts from.
#include <algorithm>
#include <cmath>

#include "runtime/planar/core.hpp"
#include "runtime/planar/doors.hpp"

namespace breve {

namespace {

/// Protected members of Box2D's joints, whose impulses it does not give away otherwise.
struct RevoluteDoor : b2RevoluteJoint {
  static constexpr auto impulse = &RevoluteDoor::m_impulse;
  static constexpr auto motor = &RevoluteDoor::m_motorImpulse;
  static constexpr auto lower = &RevoluteDoor::m_lowerImpulse;
  static constexpr auto upper = &RevoluteDoor::m_upperImpulse;
};
struct PrismaticDoor : b2PrismaticJoint {
  static constexpr auto impulse = &PrismaticDoor::m_impulse;
  static constexpr auto motor = &PrismaticDoor::m_motorImpulse;
  static constexpr auto lower = &PrismaticDoor::m_lowerImpulse;
  static constexpr auto upper = &PrismaticDoor::m_upperImpulse;
};
struct WeldDoor : b2WeldJoint {
  static constexpr auto impulse = &WeldDoor::m_impulse;
};

template <class Door, class Joint>
WarmJoint read(const Joint* b) {
  WarmJoint warm;
  warm.x = (b->*Door::impulse).x;
  warm.y = (b->*Door::impulse).y;
  warm.motor = b->*Door::motor;
  warm.lower = b->*Door::lower;
  warm.upper = b->*Door::upper;
  return warm;
}

template <class Door, class Joint>
void write(Joint* b, const WarmJoint& warm) {
  b->*Door::impulse = b2Vec2(warm.x, warm.y);
  b->*Door::motor = warm.motor;
  b->*Door::lower = warm.lower;
  b->*Door::upper = warm.upper;
}

}  // namespace

/// With its angle now as its position with all full rotations, whatever the two bodies have made.
void Planar::Core::make_b2(FlatJoint& joint) {
  const JointDescription& is = joint.is;
  const double parent = is.parent == kNoBody ? 0 : double{find(is.parent)->b2->GetAngle()};
  const double at_zero = double{find(is.child)->b2->GetAngle()} - parent, wanted = angle_of(is.relative_rotation);
  double reference = at_zero;
  if (is.kind == JointKind::Revolute)
    reference = at_zero + sense(is) * joint.position;
  else if (!is.keep_rotation)
    reference = at_zero - std::remainder(at_zero - wanted, 2 * M_PI);
  make_b2(joint, static_cast<float>(reference));
}

float Planar::Core::reference_of(const FlatJoint& joint) {
  if (joint.is.kind == JointKind::Revolute) return static_cast<b2RevoluteJoint*>(joint.b2)->GetReferenceAngle();
  if (joint.is.kind == JointKind::Prismatic) return static_cast<b2PrismaticJoint*>(joint.b2)->GetReferenceAngle();
  return static_cast<b2WeldJoint*>(joint.b2)->GetReferenceAngle();
}

/// @param reference  rad, the angle of the child in the parent where the joint's position is zero
void Planar::Core::make_b2(FlatJoint& joint, float reference) {
  const JointDescription& is = joint.is;
  b2Body* child = find(is.child)->b2;
  b2Body* parent = is.parent == kNoBody ? ground : find(is.parent)->b2;
  const auto make = [&](auto def) {
    def.bodyA = parent;
    def.bodyB = child;
    def.localAnchorA = to_b2(is.parent_point);
    def.localAnchorB = to_b2(is.child_point);
    def.collideConnected = false;
    def.referenceAngle = reference;
    def.userData.pointer = static_cast<std::uintptr_t>(&joint - joints.data());
    if constexpr (requires { def.localAxisA; })
      def.localAxisA = b2Vec2(static_cast<float>(is.normal.x()), static_cast<float>(is.normal.y()));
    joint.b2 = b2->CreateJoint(&def);
  };
  if (is.kind == JointKind::Revolute)
    make(b2RevoluteJointDef());
  else if (is.kind == JointKind::Prismatic)
    make(b2PrismaticJointDef());
  else
    make(b2WeldJointDef());
  joints_made = true;
  // Box2D would end them in its next step; until then impacts would be looked for in them.
  for (b2ContactEdge* edge = child->GetContactList(); edge != nullptr;) {
    b2ContactEdge* const next = edge->next;
    if (edge->other == parent) end_contact(*b2, *edge->contact);
    edge = next;
  }
  joint.loose = false;
  put_drive(joint);
  child->SetAwake(true);
  if (parent != ground) parent->SetAwake(true);
}

void Planar::Core::drop_b2(FlatJoint& joint) {
  if (joint.b2) b2->DestroyJoint(joint.b2);
  joint.b2 = nullptr;
}

void Planar::Core::put_drive(FlatJoint& joint) {
  if (!joint.b2 || joint.is.kind == JointKind::Fixed) return;
  const JointDrive& drive = joint.drive;
  const double sign = joint.is.kind == JointKind::Revolute ? -sense(joint.is) : -1;
  const double u = joint.is.kind == JointKind::Revolute ? 1 : settings.unit;
  double low = sign > 0 ? drive.low[0] : -drive.high[0], high = sign > 0 ? drive.high[0] : -drive.low[0];
  constexpr double kFar = 1e6;  // rad or length units: no stop
  low = std::clamp(low / u, -kFar, kFar);
  high = std::clamp(high / u, -kFar, kFar);
  double speed = drive.motor_speed[0];
  if (drive.double_strength != 0) {
    const double at = read_position(joint);
    const double least = std::min(drive.double_min, drive.double_max),
                 most = std::max(drive.double_min, drive.double_max);
    speed += drive.double_strength * (std::clamp(at, least, most) - at);
  }
  const auto set = [&](auto* b) {
    b->SetLimits(static_cast<float>(low), static_cast<float>(high));
    b->EnableLimit(has_limits(joint.drive, joint.is.kind) && !joint.loose);
    b->EnableMotor(drive.strength_limit > 0);
    b->SetMotorSpeed(static_cast<float>(sign * speed / u));
  };
  if (joint.is.kind == JointKind::Revolute) {
    auto* b = static_cast<b2RevoluteJoint*>(joint.b2);
    set(b);
    b->SetMaxMotorTorque(static_cast<float>(drive.strength_limit / (settings.unit * settings.unit)));
  } else {
    auto* b = static_cast<b2PrismaticJoint*>(joint.b2);
    set(b);
    b->SetMaxMotorForce(static_cast<float>(drive.strength_limit / settings.unit));
  }
}

Vector2 Planar::Core::axis_of(const FlatJoint& joint) const {
  const auto* b = static_cast<const b2PrismaticJoint*>(joint.b2);
  const b2Vec2 axis = const_cast<b2PrismaticJoint*>(b)->GetBodyA()->GetWorldVector(b->GetLocalAxisA());
  return Vector2(axis.x, axis.y).normalized();
}

WarmJoint Planar::Core::warm_of(const FlatJoint& joint) const {
  if (joint.is.kind == JointKind::Revolute) return read<RevoluteDoor>(static_cast<b2RevoluteJoint*>(joint.b2));
  if (joint.is.kind == JointKind::Prismatic) return read<PrismaticDoor>(static_cast<b2PrismaticJoint*>(joint.b2));
  const b2Vec3& impulse = static_cast<b2WeldJoint*>(joint.b2)->*WeldDoor::impulse;
  WarmJoint warm;
  warm.x = impulse.x;
  warm.y = impulse.y;
  warm.angular = impulse.z;
  return warm;
}

void Planar::Core::set_warm(FlatJoint& joint, const WarmJoint& warm) {
  if (joint.is.kind == JointKind::Revolute)
    write<RevoluteDoor>(static_cast<b2RevoluteJoint*>(joint.b2), warm);
  else if (joint.is.kind == JointKind::Prismatic)
    write<PrismaticDoor>(static_cast<b2PrismaticJoint*>(joint.b2), warm);
  else
    static_cast<b2WeldJoint*>(joint.b2)->*WeldDoor::impulse = b2Vec3(warm.x, warm.y, warm.angular);
}

}  // namespace breve
