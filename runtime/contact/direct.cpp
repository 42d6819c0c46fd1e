// The centres of the direct solver: a proximal method around Newton's.
//
// An exact law has no derivative where bodies touch at more points than they need, so each row is given the law
// p = project(centre - stiffness * error), which is exact once the centre is the impulse itself. For a fixed centre,
// v = v* + R p(J v) is a system as large as the number of velocities, however many contacts there are, and its
// derivative I + R D J is regular. A few steps solve it; then the impulses are the next centre. Redundant contacts
// share a load as their warm start did. Sources: Rockafellar 1976 (the proximal point algorithm); Alart and Curnier
// 1991 (projections and their derivatives); Acary, Cadoux, Lemarechal and Malick 2011 (a series of convex problems).
#include "runtime/contact/direct.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/contact/newton.hpp"
#include "runtime/contact/pack.hpp"

namespace breve::contact {

namespace {

constexpr int kCentres = 30;
constexpr int kFinalCentres = 8;
// How much stiffer than its own response a row is towards its centre: high enough that few centres do, low enough that
// round-off of velocities, this much larger in the impulses, does no harm.
constexpr double kStiffness = 1e3, kLeastStiffness = 0.1, kMostStiffness = 1e5;

/// Impulses that stop fast or heavy bodies are not known better than to this share of what they change.
constexpr double kRelative = 2e-11;

double attainable(const Workspace& work, double tolerance) {
  double largest = 0;
  for (const Point& c : work.points) largest = std::max(largest, c.impulse[0] * c.response.nn);
  for (const PackedScalar& row : work.scalars) largest = std::max(largest, std::abs(row.impulse) * row.response);
  return tolerance + kRelative * largest;
}

/// Centres of the convex law; each time a few of Coulomb's law from there, which converge at once when they are near.
bool run(Newton& newton, const Workspace& work, double tolerance, int& solves, double& best) {
  const auto done = [&](double left) {
    if (!(left < best)) return false;
    best = left;
    newton.keep_best();
    return best <= attainable(work, tolerance);
  };
  double base = kStiffness, before = best;
  for (int centre = 0; centre < kCentres; ++centre) {
    newton.keep();
    if (!newton.settle(Around::Convex, base, tolerance, solves)) {
      newton.restore();
      base *= 0.1;
      if (base < kLeastStiffness) return false;
      continue;
    }
    double last = newton.take();
    if (done(last)) return true;
    newton.keep();
    if (last > 0.3 * before) base = std::min(kMostStiffness, base * 10);
    before = last;
    double stiffness = base;
    for (int k = 0; k < kFinalCentres; ++k) {
      newton.settle(Around::Coulomb, stiffness, tolerance, solves);
      const double left = newton.take();
      if (done(left)) return true;
      if (!(left < 0.5 * last)) break;
      if (left > 0.03 * last) stiffness = std::min(kMostStiffness, stiffness * 10);
      last = left;
    }
    newton.restore();
  }
  return false;
}

}  // namespace

double violation(const Workspace& work) {
  double worst = 0;
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    const Point& c = work.points[i];
    if (!(c.response.nn > 0)) continue;
    double u[3], p[3];
    velocity(work, i, u);
    const double error = u[0] - c.bias + c.softness * c.impulse[0];
    worst = std::max(worst, std::abs(std::min(error, c.impulse[0] * c.response.nn)));
    const double response = tangential_response(c);
    if (c.friction == 0 || !(response > 0)) continue;
    p[0] = c.impulse[0];
    p[1] = c.impulse[1] - u[1] / response;
    p[2] = c.impulse[2] - u[2] / response;
    clip_to_cone(c.friction, p);
    worst = std::max(worst, response * std::hypot(p[1] - c.impulse[1], p[2] - c.impulse[2]));
  }
  for (const PackedScalar& row : work.scalars) {
    if (!(row.response > 0)) continue;
    const double error = velocity(work, row) - row.bias + row.softness * row.impulse;
    worst = std::max(
        worst, row.response * std::abs(row.impulse - std::clamp(row.impulse - error / row.response, row.lo, row.hi)));
  }
  return worst;
}

double solve_direct(Workspace& work, double tolerance, int& solves, bool& solved) {
  double best = violation(work);
  solved = best <= attainable(work, tolerance);
  if (solved) return best;
  Newton newton(work);
  if (!newton.fits()) return best;
  newton.begin();
  solved = run(newton, work, tolerance, solves, best);
  newton.restore_best();
  return best;
}

}  // namespace breve::contact
