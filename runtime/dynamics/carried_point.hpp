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

}  // namespace breve::island
