// The laws of single rows as projections with a derivative, for Newton's method.
#pragma once

#include "runtime/contact/workspace.hpp"

namespace breve::contact {

/// Along the tangents, the larger of the two responses.
double tangential_response(const Point& c);

/// Coulomb's law around a centre: the impulse centre - stiffness * error, its normal part not negative, its tangential
/// part not longer than that allows. `stiffness` is in units of the row's own.
Slope project(const Point& c, const double centre[3], const double u[3], double stiffness, double p[3]);

/// A scalar row: clamped between its bounds. @return the derivative, as `nn` of a contact
double project(const PackedScalar& row, double centre, double u, double stiffness, double& p);

/// dq -= D du.
inline void apply_slope(const Slope& D, const double du[3], double dq[3]) {
  dq[0] -= D.nn * du[0] + D.n1 * du[1] + D.n2 * du[2];
  dq[1] -= D.t1n * du[0] + D.t11 * du[1] + D.t12 * du[2];
  dq[2] -= D.t2n * du[0] + D.t21 * du[1] + D.t22 * du[2];
}

}  // namespace breve::contact
