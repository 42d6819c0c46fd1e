// The sweeps of the iterative solver. The loop over free bodies is the hot one of a pile: nothing but arithmetic in it.
#include "runtime/contact/sweep.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/contact/pack.hpp"

namespace breve::contact {

namespace {

/// Of the direction of sliding in one visit; the next sweep goes on from there.
constexpr int kNewtonPerVisit = 2;

/// The contact's new impulse, `change` being what is added to the old one.
/// @return the largest change of its velocity
inline double visit(Point& c, double u[3], double change[3]) {
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

double sweep_scalars(Workspace& work) {
  double largest = 0;
  for (PackedScalar& row : work.scalars) {
    if (!(row.response > 0)) continue;
    const double error = velocity(work, row) + row.softness * row.impulse - row.bias;
    const double next = std::clamp(row.impulse - error / row.response, row.lo, row.hi);
    if (!std::isfinite(next)) continue;
    const double change = next - row.impulse;
    row.impulse = next;
    push(work, row, change);
    largest = std::max(largest, std::abs(change) * row.response);
  }
  return largest;
}

}  // namespace

void push_all(Workspace& work) {
  for (std::size_t i = 0; i < work.points.size(); ++i)
    if (work.points[i].impulse[0] > 0) push(work, i, work.points[i].impulse);
  for (const PackedScalar& row : work.scalars)
    if (row.impulse != 0) push(work, row, row.impulse);
}

double visit_point(Workspace& work, std::size_t point) {
  double u[3], change[3];
  velocity(work, point, u);
  const double moved = visit(work.points[point], u, change);
  if (moved > 0) push(work, point, change);
  return moved;
}

double sweep(Workspace& work, bool backward) {
  double largest = sweep_scalars(work);
  Packed* const movers = work.movers.data();
  double u[3], change[3];
  const std::size_t count = work.points.size();
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t i = backward ? count - 1 - n : n;
    Point& c = work.points[i];
    if (!c.plain || work.condensed) {
      largest = std::max(largest, visit_point(work, i));
      continue;
    }
    Packed &a = movers[c.a], &b = movers[c.b];
    plain_velocity(c, a, b, u);
    const double moved = visit(c, u, change);
    if (!(moved > 0)) continue;
    plain_push(c, a, b, change);
    largest = std::max(largest, moved);
  }
  return largest;
}

namespace {

/// gain = linear + quadratic for the impulses as they are; s times the impulses give s linear + s^2 quadratic.
void parts_of_gain(const Workspace& work, double& linear, double& quadratic) {
  linear = quadratic = 0;
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    const Point& c = work.points[i];
    if (!(c.impulse[0] > 0)) continue;
    const double* before = work.sides[i].free_velocity;
    double u[3];
    velocity(work, i, u);
    linear += c.impulse[0] * (before[0] - c.bias) + c.impulse[1] * before[1] + c.impulse[2] * before[2];
    quadratic += 0.5 * (c.impulse[0] * (u[0] - before[0] + c.softness * c.impulse[0]) +
                        c.impulse[1] * (u[1] - before[1]) + c.impulse[2] * (u[2] - before[2]));
  }
  for (const PackedScalar& row : work.scalars) {
    if (row.impulse == 0) continue;
    const double u = velocity(work, row);
    linear += row.impulse * (row.free_velocity - row.bias);
    quadratic += 0.5 * row.impulse * (u - row.free_velocity + row.softness * row.impulse);
  }
}

}  // namespace

double gain(const Workspace& work) {
  double linear = 0, quadratic = 0;
  parts_of_gain(work, linear, quadratic);
  return linear + quadratic;
}

void hold_energy(Workspace& work) {
  double linear = 0, quadratic = 0;
  parts_of_gain(work, linear, quadratic);
  if (!(linear + quadratic > 0)) return;
  const double keep = quadratic > 0 ? std::clamp(-0.5 * linear / quadratic, 0.0, 1.0) : 0.0;
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    double* p = work.points[i].impulse;
    const double change[3] = {(keep - 1) * p[0], (keep - 1) * p[1], (keep - 1) * p[2]};
    push(work, i, change);
    for (int k = 0; k < 3; ++k) p[k] += change[k];
  }
  for (PackedScalar& row : work.scalars) {
    const double change = (keep - 1) * row.impulse;
    push(work, row, change);
    row.impulse += change;
  }
}

}  // namespace breve::contact
