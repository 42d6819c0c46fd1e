// The course of the direct solver: near the last step's impulses some sweeps and Newton's method; else the
// interior-point method, then Newton's for the last digits.
//
// An exact law has no derivative where bodies touch at more points than they need, so Newton's method is given rows
// with the law p = project(centre - stiffness * error), which is exact once the centre is the impulse itself. For a
// fixed centre, v = v* + R p(J v) is a system as large as the number of velocities, however many contacts there are,
// and its derivative I + R D J is regular. A few steps solve it; then the impulses are the next centre. Redundant
// contacts share a load as the impulses did that it began with. Sources: Rockafellar 1976 (the proximal point
// algorithm); Alart and Curnier 1991 (projections and their derivatives).
#include "runtime/contact/direct.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/contact/aside.hpp"
#include "runtime/contact/interior.hpp"
#include "runtime/contact/newton.hpp"
#include "runtime/contact/pack.hpp"
#include "runtime/contact/sweep.hpp"

namespace breve::contact {

namespace {

constexpr int kFirstCentres = 4, kLastCentres = 10;
// How near Newton's method is tried again, of the speed that the rows have to stop. The first is often enough, and
// what is redundant then shares its loads evenly.
constexpr double kNear[] = {1e-4, 1e-6, 0};
// How much stiffer than its own response a row is towards its centre: the higher, the fewer centres do, and the nearer
// to the solution the first one has to be. A box whose corners are off by 1e-6 of what its weight does in a step shares
// its load only at 1e6.
constexpr double kFirstStiffness = 1e3, kLeastStiffness = 0.1, kMostStiffness = 1e8;
constexpr double kRoundOff = 1e-15;  // of velocities at rows, per unit
// How near Newton's method has to begin, of the largest change, times the cube of the number of points: from farther
// it failed in 95 of 100 islands of 30 to 500 points that move, whatever they were made of. Small ones reach farther.
constexpr double kReach = 0.5;

/// Impulses that stop fast or heavy bodies are not known better than to this share of what they change.
constexpr double kRelative = 2e-12;

}  // namespace

double largest_change(const Workspace& work) {
  double largest = 0;
  for (const Point& c : work.points) largest = std::max(largest, c.impulse[0] * c.response.nn);
  for (const PackedScalar& row : work.scalars) largest = std::max(largest, std::abs(row.impulse) * row.response);
  return largest;
}

double attainable(const Workspace& work, double tolerance) { return tolerance + kRelative * largest_change(work); }

namespace {

/// Centres from the impulses of the island: stiffer while that goes well, softer where it does not.
/// @param most      centres
/// @param failures  as many may come to nothing
/// @param left      the violation; in and out
/// @return          whether it is within the tolerance; the island is at the best centre in any case
bool approach(Newton& newton, const Workspace& work, double stiffness, int most, int failures, double tolerance,
              LinearSolves& solves, double& left) {
  newton.begin();
  newton.keep();
  // Round-off of velocities, this much larger in the impulses, is not to be seen.
  const double stiffest = std::min(kMostStiffness, attainable(work, tolerance) / (kRoundOff * largest_change(work)));
  stiffness = std::clamp(stiffness, kLeastStiffness, stiffest);
  for (int i = 0; i < most && !solves.spent(); ++i) {
    const bool settled = newton.settle(stiffness, tolerance, solves);
    const double now = newton.take();
    if (now < left) {
      const bool fast = now < 0.03 * left;
      left = now;
      newton.keep();
      if (left <= attainable(work, tolerance)) return true;
      if (settled) {
        stiffness = std::min(stiffest, stiffness * (fast ? 3 : 100));
        continue;
      }
    }
    newton.restore();
    stiffness *= 0.1;
    if (--failures < 0 || stiffness < kLeastStiffness) break;
  }
  newton.restore();
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

bool within_reach(const Workspace& work, double left) {
  const double points = std::max(1.0, static_cast<double>(work.points.size()));
  return left * points * points * points <= kReach * largest_change(work);
}

bool enough_from_far(const Workspace& work, const LinearSolves& solves) {
  constexpr int kInterior = 12, kPoints = 8;
  const bool rests = !(largest_change(work) > 0);
  return solves.left() >= kInterior + (rests ? 0 : static_cast<int>(work.points.size()) / kPoints);
}

namespace {

constexpr int kNearSweeps = 24;

/// Sweeps from the last step's impulses. Feet far apart hardly feel one another: some sweeps solve them, or come so
/// near that Newton's method converges from there. All of them cost as much as a few of its steps, so none is too slow.
void sweep_near(Workspace& work, double tolerance, int most) {
  Sweeps sweeps(work, true);
  for (int i = 0; i < most; ++i)
    if (sweeps.next() <= 0.1 * tolerance || sweeps.diverge()) return;
}

/// As solve_direct(), of the points that there are.
double solve_all(Workspace& work, double tolerance, LinearSolves& solves, bool& solved) {
  double best = violation(work);
  solved = best <= attainable(work, tolerance);
  if (solved) return best;
  if (largest_change(work) > 0) {
    sweep_near(work, tolerance, kNearSweeps);
    best = violation(work);
    solved = best <= attainable(work, tolerance);
    if (solved) return best;
  }
  Equations equations(work);
  if (!equations.fits()) return best;
  const std::size_t rows = equations.rows();
  double* room = equations.begin(Newton::numbers(rows) + Interior::numbers(rows) + rows);
  double* const start = room + Newton::numbers(rows) + Interior::numbers(rows);
  Newton newton(work, equations, room);
  if (largest_change(work) > 0)
    solved = approach(newton, work, kFirstStiffness, kFirstCentres, 0, tolerance, solves, best);
  if (solved || !enough_from_far(work, solves)) return best;
  equations.get_impulses(start);
  Interior interior(work, equations, room + Newton::numbers(rows));
  for (const double part : kNear) {
    double left = interior.solve(std::max(part * interior.speed(), attainable(work, tolerance)), solves);
    const double stiffness = 0.5 * largest_change(work) / left;
    solved = approach(newton, work, stiffness, kLastCentres, part > 0 ? 1 : 2, tolerance, solves, left) ||
             left <= attainable(work, tolerance);
    if (left < best) {
      best = left;
      equations.get_impulses(start);
    }
    if (solved || solves.spent()) break;
  }
  equations.take(start);
  solved = best <= attainable(work, tolerance);  // impulses that were thrown far are known too badly to be one
  return best;
}

/// Trees with an impulse to begin at. Among free bodies the sweeps that tell which points carry nothing take longer
/// than what they save.
bool may_be_lean(const Workspace& work) { return !work.condensed && !is_plain(work) && largest_change(work) > 0; }

}  // namespace

double solve_direct(Workspace& work, double tolerance, bool lean, LinearSolves& solves, bool& solved) {
  constexpr int kTries = 3, kLook = 4;  // sweeps that tell what carries nothing
  if (!lean || !may_be_lean(work)) return solve_all(work, tolerance, solves, solved);
  double left = violation(work);
  solved = left <= attainable(work, tolerance);
  if (solved) return left;
  sweep_near(work, tolerance, kLook);
  Aside aside(work);
  for (int i = 0; i < kTries && aside.take(); ++i) {
    left = solve_all(work, tolerance, solves, solved);
    if (!aside.call_back(attainable(work, tolerance))) return left;
    if (!solved) break;
  }
  return solve_all(work, tolerance, solves, solved);
}

}  // namespace breve::contact
