// The laws of single rows as projections with a derivative, for Newton's method.
#pragma once

#include "runtime/contact/workspace.hpp"

namespace breve::contact {

/// How p depends on the velocity at its contact: dp = -D du.
struct Slope {
  double nn = 0, n1 = 0, n2 = 0;
  double t1n = 0, t2n = 0;  // friction's limit follows the normal impulse
  double t11 = 0, t12 = 0, t22 = 0;
};

/// Along the tangents, the larger of the two responses.
double tangential_response(const Point& c);

/// Coulomb's law around a centre: the impulse centre - stiffness * error, its normal part not negative, its tangential
/// part not longer than that allows. `stiffness` is in units of the row's own.
Slope project(const Point& c, const double centre[3], const double u[3], double stiffness, double p[3]);

/// The same for the convex law: projection on the cone as a whole, of a velocity with `lift` added to its normal part.
/// With lift = mu |u_t| what it holds for is Coulomb's law (de Saxce and Feng 1998); with any fixed lift the impulses
/// are those of a least energy, which Newton's method finds from anywhere.
Slope project_convex(const Point& c, const double centre[3], const double u[3], double lift, double stiffness,
                     double p[3]);

/// A scalar row: clamped between its bounds. @return the derivative, as `nn` of a contact
double project(const PackedScalar& row, double centre, double u, double stiffness, double& p);

}  // namespace breve::contact
