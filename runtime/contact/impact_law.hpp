// The impulse of one collision at a point: the algebraic law of Chatterjee and Ruina, which cannot create energy.
#pragma once

#include "runtime/base/math.hpp"
#include "runtime/contact/law.hpp"

namespace breve::contact {

/// The impulse on a, its opposite acting on b. After it n.v+ = -e n.v-, |P_t| <= mu P_n, and the kinetic energy is not
/// above what it was, for 0 <= e <= 1 and |e_t| <= 1.
///
/// With P_I the normal impulse that stops the approach without friction, and P_II the impulse that stops all relative
/// motion at the point, P = (1 + e) P_I + kappa (P_II - P_I). kappa is 1 + e_t, or less so that P lies on the cone. A
/// point that sticks may use the static coefficient; one that slides has the dynamic one.
///
/// @param W   dv = W P: symmetric, positive semidefinite, 1/kg, world axes. May be singular: the part of the velocity
///            that no impulse can change is left as it is, and nothing is done if none can change the approach
/// @param v   velocity of a's point less that of b's, m/s, world axes
/// @param n   unit, from b toward a
/// @return    N*s; zero if the points do not approach
/// Source: Chatterjee and Ruina 1998, "A new algebraic rigid-body collision law based on impulse space considerations".
Vector3 impact_impulse(const Matrix3& W, const Vector3& v, const Vector3& n, const Law& law);

/// Two unit vectors that complete `n` to a right-handed frame (n, t1, t2). Deterministic, continuous but at one n.
void tangents(const Vector3& n, Vector3& t1, Vector3& t2);

}  // namespace breve::contact
