// One contact of a sweep, in its own axes.
#pragma once

#include <algorithm>
#include <cmath>

#include "runtime/contact/workspace.hpp"

namespace breve::contact {

/// The contact's new impulse by the velocity there, `change` being what is added to the old one.
/// @return the largest change of its velocity
inline double visit(Point& c, const double u[3], double change[3]) {
  constexpr int kNewtonPerVisit = 2;  // of the direction of sliding; the next sweep goes on from there
  const LocalMatrix& W = c.response;
  double* p = c.impulse;
  const double old0 = p[0], old1 = p[1], old2 = p[2];
  // The velocity as it were without this contact's impulse, less what is wanted. Softness is in W.
  const double u0[3] = {u[0] - c.bias - (W.nn - c.softness) * old0 - W.n1 * old1 - W.n2 * old2,
                        u[1] - W.n1 * old0 - W.s11 * old1 - W.s12 * old2,
                        u[2] - W.n2 * old0 - W.s12 * old1 - W.s22 * old2};
  sweep_cone(W, c.inverse, u0, c.friction, kNewtonPerVisit, false, p);
  change[0] = p[0] - old0;
  change[1] = p[1] - old1;
  change[2] = p[2] - old2;
  return std::max({std::abs(change[0]) * W.nn, std::abs(change[1]) * W.s11, std::abs(change[2]) * W.s22});
}

}  // namespace breve::contact
