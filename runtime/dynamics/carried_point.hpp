// Where a point of contact is once its body has moved.
#pragma once

#include "runtime/solid/contact.hpp"
#include "runtime/solid/shape.hpp"

namespace breve::island {

bool is_round(const Shape& shape);

/// The point of a body that stood at `from`, once it is at `to`. A body that is round about an axis rotates about it
/// without taking its point along, so that only the shortest rotation of the axis counts; a ball has no axis to rotate.
Vector3 carried_by(const Shape& shape, const Vector3& point, const Pose& from, const Pose& to);

/// The same where it touches along a normal: a round body's point stays where it reaches farthest along that, however
/// its axis rotates.
/// @param normal  world, a unit vector of either direction
Vector3 carried_by(const Shape& shape, const Vector3& point, const Vector3& normal, const Pose& from, const Pose& to);

/// A body that takes its point of contact along.
struct Carrier {
  const Shape& shape;
  Pose to;        // where it is now
  Vector3 taken;  // world: where it took the point that was touched, by carried_by() along the normal
};

/// Where two bodies touch, once both have moved: world; the normal is a unit vector from b toward a.
struct Meeting {
  Vector3 point, normal;
};

/// The point of contact moves less along the more curved of two surfaces, and the normal follows: for relative motion x
/// of two surfaces of curvatures A and B in the tangent plane, the point moves by (A + B)^-1 B x on A, and the normal
/// tilts by A (A + B)^-1 B x (Montana 1988: the kinematics of contact and grasp). A face has no curvature, and an edge
/// or corner more than anything round; between bodies with faces the normal stays.
/// @param normal  world, a unit vector from b toward a, as it was
Meeting carried_between(const Carrier& a, const Carrier& b, const Vector3& normal);

}  // namespace breve::island
