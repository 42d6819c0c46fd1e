// What a joint between two bodies is, as scripts and hosts describe it: kind, points, normal, and
// the numbers that drive, spring and bound it. How a tree of bodies uses it is in trees.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

#include "runtime/base/ids.hpp"
#include "runtime/base/math.hpp"
#include "runtime/kinematics/bodies.hpp"
#include "runtime/solid/contact.hpp"

namespace breve {

using JointIndex = std::uint32_t;
inline constexpr JointIndex kNoJoint = 0xffffffffU;

enum class JointKind : std::uint8_t { Revolute, Prismatic, Fixed, Universal, Ball };

/// Axes that a joint moves about or along: 1, 1, 0, 2, 3.
constexpr int axis_count(JointKind kind) {
  constexpr int kCounts[] = {1, 1, 0, 2, 3};
  return kCounts[static_cast<int>(kind)];
}

/// "revolute", "prismatic", "fixed", "universal", "ball": for messages.
std::string_view name_of(JointKind kind);

/// Which two bodies, and where. Position and velocity of a joint are positive when the *parent* rotates or moves along
/// +axis relative to the child, so the child along -axis. Axes of a universal joint: `normal`, fixed in the parent, and
/// parent_point x normal, fixed in the child (some perpendicular of the normal, if that is zero). For a ball
/// joint: Euler's angles about the normal (parent), a derived axis, and the direction of parent_point without its part
/// along the normal (child).
struct JointDescription {
  JointKind kind = JointKind::Revolute;
  BodyIndex parent = kNoBody;                // kNoBody: the world
  BodyIndex child = kNoBody;                 // a body, always
  Vector3 parent_point = Vector3::Zero();    // in the parent's own frame, in the world's if there is no parent; m
  Vector3 child_point = Vector3::Zero();     // in the child's own frame, m
  Quaternion relative_rotation{1, 0, 0, 0};  // at zero the child stands at parent rotation x this
  Vector3 normal = Vector3::UnitX();         // in the parent's frame; made unit length; not read for Fixed
  // Axes of the parent's frame that are to be taken instead of those that parent_point gives: the second axis of a
  // universal joint, the third of a ball's angles. Zero: from parent_point. What of it is along the normal is taken
  // off.
  Vector3 other_axis = Vector3::Zero();
  // use-current-relative-rotation: the child is moved, but not rotated. The part of its rotation that the joint cannot
  // make is added to relative_rotation when it is linked.
  bool keep_rotation = false;
};

/// One number for each axis of a joint; those that the joint has not are 0.
using JointVector = Vector3;

/// What drives and bounds a joint. All finite; each axis for itself, but for a strength limit, which a ball's three
/// axes share.
struct JointDrive {
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

  JointVector motor_speed = Vector3::Zero();       // rad/s or m/s that the motor aims at
  double strength_limit = 0;                       // N*m or N that it may use for that; 0: no motor
  double double_strength = 0;                      // of the double spring: added to the motor's speed, 1/s
  double double_max = 0, double_min = 0;           // rad or m; nothing is added within
  double damping = 0;                              // N*m*s/rad or N*s/m
  double stiffness = 0;                            // of a spring in the joint, N*m/rad or N/m
  JointVector rest = Vector3::Zero();              // where that is slack, rad or m
  JointVector force = Vector3::Zero();             // N*m or N along the axes, until replaced
  JointVector low = Vector3::Constant(-kNoLimit);  // limits of the position, rad or m; low <= high
  JointVector high = Vector3::Constant(kNoLimit);
  double limit_restitution = 0;  // at the limits, 0 to 1
};

/// Error{Argument} naming the property: a child that is not a body or is Stationary, parent and child the same, a
/// point, rotation or normal that is not finite or has no direction.
void check(const JointDescription& is, const Bodies& bodies);
/// Error{Argument} if a point is farther away than 1e15 m: moments of inertia about a joint have products of such
/// lengths, which farther away are no longer finite. Asked where bodies are linked; the point of a joint to the world
/// then goes wherever its child is moved.
void check_reach(const JointDescription& is);
/// Error{Argument} naming the number that is not finite, negative where it must not be, or a low limit above a high
/// one.
void check(const JointDrive& drive, JointKind kind);

/// Some axis of the joint has a limit.
bool has_limits(const JointDrive& drive, JointKind kind);

/// Where the child's body stands when the joint is at zero.
Pose pose_at_zero(const JointDescription& is, const Pose& parent);

/// What a joint gives.
struct JointReaction {
  Vector3 force = Vector3::Zero();   // on the child, world axes, N
  Vector3 torque = Vector3::Zero();  // on the child about the joint's point, world axes, N*m
};

}  // namespace breve
