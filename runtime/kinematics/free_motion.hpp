// Free rigid motion of one body over one sub-step: no contacts, no joints.
#pragma once

#include "runtime/base/math.hpp"
#include "runtime/base/rotation_vector.hpp"  // for the rotation by h * middle

namespace breve {

/// The spin of a free body after `h` seconds, by the implicit midpoint rule on Euler's equations
/// I w' + w x (I w) = torque. The rule keeps every quadratic invariant: without torque the energy w.Iw/2 and the size
/// of the angular momentum stay, at any step, up to the residual of Newton's method (round-off).
/// @param inertia  about the centre of mass, own frame, positive definite, kg*m^2
/// @param spin     rotational velocity, own frame, rad/s
/// @param torque   own frame, N*m
/// @return         spin after h; `middle` is the mean of both, with which the body rotates
/// Source: Hairer, Lubich, Wanner 2006, IV.2 (quadratic invariants of the implicit midpoint rule).
Vector3 advance_spin(const Matrix3& inertia, const Vector3& spin, const Vector3& torque, double h, Vector3& middle);

}  // namespace breve
