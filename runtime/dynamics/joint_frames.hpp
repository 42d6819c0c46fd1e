// What a joint is in a tree: its type, frame and axes for the articulated model in either direction, and joint
// positions and rates of the model's numbers and back. The tree may go from the parent to the child, or the other way.
#pragma once

#include "runtime/articulated/model.hpp"
#include "runtime/articulated/state.hpp"
#include "runtime/mechanics/joint_axes.hpp"

namespace breve {

/// Type, axes and rotation of the model's joint. `outer` is the orientation of the frame that the tree comes from, if
/// that is not a link: the orientation of a body that holds the tree, or the identity.
void describe_joint(const JointDescription& is, bool flipped, const Quaternion& outer, articulated::Link& link);

/// The model's numbers for a relative rotation and shift of two bodies, as near as the joint allows.
/// @param turn   child's orientation relative to the parent's: R_parent^-1 R_child
/// @param shift  of the child's point from the parent's point, in the parent's frame, m
/// @param last   the joint's position as last known, from which full rotations are counted
void read_joint(const JointDescription& is, bool flipped, const Quaternion& rotation, const Vector3& shift,
                const JointVector& last, double* q);

JointVector joint_position(const JointDescription& is, bool flipped, const double* q);
JointVector joint_velocity(const JointDescription& is, bool flipped, const double* q, const double* v);
/// The rate of one position by each of the model's velocities; entries beyond these are of no use.
Vector3 joint_velocity_row(const JointDescription& is, bool flipped, const double* q, int axis);
/// The inverses: numbers of the model from positions and rates.
void put_joint_position(const JointDescription& is, bool flipped, const JointVector& position, double* q);
void put_joint_velocity(const JointDescription& is, bool flipped, const double* q, const JointVector& rate, double* v);
/// A ball joint's numbers from the child's rotation and spin relative to the parent's frame at zero, in the parent's
/// axes.
void put_ball(const JointDescription& is, bool flipped, const Quaternion& rotation, const Vector3& spin, double* q,
              double* v);
/// From one position of a joint to another, both in the model's numbers: a spring in the joint pulls back along it. For
/// a ball joint it is the rotation vector, in the axes of the joint's child in the tree, rad.
Vector3 joint_deflection(JointKind kind, const double* from, const double* to);
/// The model's joint force of forces `f` about or along the joint's axes as they stand now.
void put_joint_force(const JointDescription& is, bool flipped, const double* q, const JointVector& f, double* tau);

/// Position of a joint that is in no tree, from its bodies.
JointVector joint_position_between(const JointDescription& is, const Quaternion& rotation, const Vector3& shift,
                                   const JointVector& last);

}  // namespace breve
