// The axes of a joint and the angles of a rotation about them, for joints in space and in a flat world.
#pragma once

#include "runtime/mechanics/joint.hpp"

namespace breve {

/// The axes of a joint in the parent's frame; unit length, right-handed. For a ball they are those of Euler's angles at
/// zero.
struct JointAxes {
  Vector3 first, second, third;
};
/// The normal must have unit length.
JointAxes axes_of(const JointDescription& is);

/// A rotation by `angle` about `axis`, which has unit length.
Quaternion rotation_about(const Vector3& axis, double angle);
/// Angle of the part of a rotation that is about `axis`, -pi to pi; 0 if it has none.
double angle_about(const Quaternion& rotation, const Vector3& axis);
/// Euler's angles of a rotation, with the signs of joint positions.
JointVector euler_angles(const JointAxes& axes, const Quaternion& rotation);

/// The relative rotation with which a child that stands at `rotation` to its parent need not be rotated. The part of
/// the child's rotation that the joint can make stays the position of the joint, counted from is.relative_rotation as
/// before. The part that it cannot make is added to the relative rotation, unless it is only round-off.
/// @param is        its normal has unit length
/// @param rotation  R_parent^-1 R_child
Quaternion relative_rotation_that_keeps(const JointDescription& is, const Quaternion& rotation);

}  // namespace breve
