// Rotation vectors: axis times angle, rad. The exponential map from them to unit quaternions.
#pragma once

#include <cmath>

#include "runtime/base/math.hpp"

namespace breve {

/// The rotation by a rotation vector: its exponential, as a unit quaternion.
inline Quaternion rotation_by(const Vector3& rotation_vector) {
  const double angle = rotation_vector.norm();
  // sin(x/2)/x, by its series where the quotient would lose digits.
  const double factor = angle < 1e-4 ? 0.5 - angle * angle / 48 : std::sin(0.5 * angle) / angle;
  return {std::cos(0.5 * angle), factor * rotation_vector.x(), factor * rotation_vector.y(),
          factor * rotation_vector.z()};
}

}  // namespace breve
