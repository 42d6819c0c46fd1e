// Works of rows against one another, and sweeps over what presses and over friction, in turns.
#include "runtime/contact/wedge.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/contact/pack.hpp"

namespace breve::contact {

namespace {

/// A force that is constant over the sub-step works along the mean of the velocities before and after.
double work_of(double impulse, double before, double after) { return 0.5 * impulse * (before + after); }

/// The energy that a row alone would take or give.
double energy_alone(double before, double wanted, double response) {
  const double change = before - wanted;
  return response > 0 ? 0.5 * change * change / response : 0;
}

/// The largest change of a row's own velocity by its impulse, and the largest that a row has to stop.
struct Speeds {
  double most = 0, stopped = 0;
};

Speeds read_speeds(const Workspace& work) {
  Speeds is;
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    const Point& c = work.points[i];
    is.most = std::max(is.most, c.impulse[0] * c.response.nn);
    is.stopped = std::max(is.stopped, std::abs(work.sides[i].free_velocity[0] - c.bias));
  }
  for (const PackedScalar& row : work.scalars)
    is.stopped = std::max(is.stopped, std::abs(row.free_velocity - row.bias));
  return is;
}

}  // namespace

bool thrown(const Workspace& work, bool converged) {
  // A heavy load, or thrown; and what leaves no more than round-off of what is to be stopped, if that is not slow.
  constexpr double kGreat = 100, kSenseless = 1e10;
  constexpr double kSlow = 1e-3;            // m/s
  const Speeds speeds = read_speeds(work);  // this is quick
  if (speeds.most <= kGreat * speeds.stopped) return false;
  if (!(speeds.most <= kSenseless * std::max(speeds.stopped, kSlow))) return true;
  const double most = converged ? 1000 : 100;
  double sum = 0, gross = 0, alone = 0;
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    const Point& c = work.points[i];
    const double* before = work.sides[i].free_velocity;
    alone += energy_alone(before[0], c.bias, c.response.nn);
    if (!(c.impulse[0] > 0)) continue;
    double u[3];
    velocity(work, i, u);
    const double along = work_of(c.impulse[0], before[0], u[0]);
    const double across = work_of(c.impulse[1], before[1], u[1]) + work_of(c.impulse[2], before[2], u[2]);
    sum += along + across;
    gross += std::abs(along) + std::abs(across);
  }
  for (const PackedScalar& row : work.scalars) {
    alone += energy_alone(row.free_velocity, row.bias, row.response);
    if (row.impulse != 0) sum += work_of(row.impulse, row.free_velocity, velocity(work, row));
  }
  return gross > most * (std::abs(sum) + alone) || !std::isfinite(gross);
}

void forget_impulses(Workspace& work) {
  for (Point& c : work.points) std::fill_n(c.impulse, 3, 0.0);
  for (PackedScalar& row : work.scalars) row.impulse = 0;
  restore_velocities(work);
}

namespace {

/// @return  the largest change of a row's velocity
double press(Workspace& work) {
  double moved = 0;
  for (PackedScalar& row : work.scalars) {
    if (!(row.response > 0)) continue;
    const double error = velocity(work, row) + row.softness * row.impulse - row.bias;
    const double next = std::clamp(row.impulse - error / row.response, row.lo, row.hi), change = next - row.impulse;
    row.impulse = next;
    push(work, row, change);
    moved = std::max(moved, std::abs(change) * row.response);
  }
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    Point& c = work.points[i];
    if (!(c.response.nn > 0)) continue;
    double u[3];
    velocity(work, i, u);
    double held[3] = {c.impulse[0] - (u[0] - c.bias + c.softness * c.impulse[0]) / c.response.nn, c.impulse[1],
                      c.impulse[2]};
    clip_to_cone(c.friction, held);
    const double change[3] = {held[0] - c.impulse[0], held[1] - c.impulse[1], held[2] - c.impulse[2]};
    std::copy_n(held, 3, c.impulse);
    push(work, i, change);
    moved = std::max(moved, std::abs(change[0]) * c.response.nn);
  }
  return moved;
}

/// @return  the largest change of a point's velocity of sliding
double rub(Workspace& work) {
  double moved = 0;
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    Point& c = work.points[i];
    const double response = c.response.s11 + c.response.s22;  // no less than along any direction
    if (!(response > 0)) continue;
    double u[3];
    velocity(work, i, u);
    double held[3] = {c.impulse[0], c.impulse[1] - u[1] / response, c.impulse[2] - u[2] / response};
    clip_to_cone(c.friction, held);
    const double change[3] = {0, held[1] - c.impulse[1], held[2] - c.impulse[2]};
    std::copy_n(held, 3, c.impulse);
    push(work, i, change);
    moved = std::max(moved, response * std::hypot(change[1], change[2]));
  }
  return moved;
}

}  // namespace

int solve_staggered(Workspace& work, double tolerance) {
  constexpr int kPresses = 100, kRubs = 10, kTurns = 2;
  int sweeps = 0;
  const auto settle = [&](auto&& sweep, int most) {
    for (int i = 0; i < most; ++i, ++sweeps)
      if (sweep(work) <= tolerance) return;
  };
  settle(press, kPresses);
  for (int turn = 0; turn < kTurns; ++turn) {
    settle(rub, kRubs);
    settle(press, kPresses);
  }
  return sweeps;
}

}  // namespace breve::contact
