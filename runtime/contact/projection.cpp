// Projections of the direct solver; where a row has no response it has no impulse.
#include "runtime/contact/projection.hpp"

#include <algorithm>
#include <cmath>

namespace breve::contact {

double tangential_response(const Point& c) { return std::max(c.response.s11, c.response.s22); }

Slope project(const Point& c, const double centre[3], const double u[3], double stiffness, double p[3]) {
  Slope slope;
  p[0] = p[1] = p[2] = 0;
  if (!(c.response.nn > 0)) return slope;
  const double rho_n = stiffness / c.response.nn;
  const double soft = 1 / (1 + rho_n * c.softness);
  const double normal = (centre[0] - rho_n * (u[0] - c.bias)) * soft;
  if (!(normal > 0)) return slope;
  p[0] = normal;
  slope.nn = rho_n * soft;
  const double response = tangential_response(c);
  if (c.friction == 0 || !(response > 0)) return slope;
  const double rho_t = stiffness / response;
  const double z1 = centre[1] - rho_t * u[1], z2 = centre[2] - rho_t * u[2];
  const double length = std::sqrt(z1 * z1 + z2 * z2), radius = c.friction * normal;
  if (length <= radius) {
    p[1] = z1;
    p[2] = z2;
    slope.t11 = slope.t22 = rho_t;
    return slope;
  }
  const double x = z1 / length, y = z2 / length;
  p[1] = radius * x;
  p[2] = radius * y;
  const double rotation = rho_t * radius / length;
  slope.t1n = c.friction * slope.nn * x;
  slope.t2n = c.friction * slope.nn * y;
  slope.t11 = rotation * y * y;
  slope.t12 = slope.t21 = -rotation * x * y;
  slope.t22 = rotation * x * x;
  return slope;
}

double project(const PackedScalar& row, double centre, double u, double stiffness, double& p) {
  p = 0;
  if (!(row.response > 0)) return 0;
  const double rho = stiffness / row.response;
  const double soft = 1 / (1 + rho * row.softness);
  const double z = (centre - rho * (u - row.bias)) * soft;
  p = std::clamp(z, row.lo, row.hi);
  return p == z ? rho * soft : 0;
}

}  // namespace breve::contact
