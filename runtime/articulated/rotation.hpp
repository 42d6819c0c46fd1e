// Rotations as a group: the logarithm, inverse of rotation_by, and the derivative that lets a Runge-Kutta method keep
// its order on it.
#pragma once

#include <cmath>

#include "runtime/base/math.hpp"
#include "runtime/base/rotation_vector.hpp"

namespace breve::articulated {

/// The rotation vector of a unit quaternion, of length at most pi.
inline Vector3 logarithm(const Quaternion& q) {
  const double s = q.vec().norm();
  const double sign = q.w() < 0 ? -1 : 1;
  const double w = std::abs(q.w());
  const double factor = s < 1e-6 ? 2 / w - 2 * s * s / (3 * w * w * w) : 2 * std::atan2(s, w) / s;
  return sign * factor * q.vec();
}

/// The rate of `d` in R(t) = R0 exp(d(t)) when the body rotates with `spin` (own axes): the inverse of the right
/// Jacobian of exp. Source: Iserles et al. 2000, section 2.6; Hairer, Lubich, Wanner 2006, III.4 (sums in closed form).
inline Vector3 rate_of_rotation_vector(const Vector3& d, const Vector3& spin) {
  const double square = d.squaredNorm();
  double c = 1.0 / 12 + square / 720 + square * square / 30240;
  if (square > 2.5e-3) {
    const double half = 0.5 * std::sqrt(square);
    c = (1 - half / std::tan(half)) / square;
  }
  const Vector3 across = d.cross(spin);
  return spin + 0.5 * across + c * d.cross(across);
}

/// The rotation vector whose exp is Cayley's (1 - [d]x/2)^-1 (1 + [d]x/2): same axis, angle 2 atan(|d|/2).
inline Vector3 cayley(const Vector3& d) {
  const double half = 0.5 * d.norm();
  const double factor = half < 1e-4 ? 1 - half * half / 3 : std::atan(half) / half;
  return factor * d;
}

}  // namespace breve::articulated
