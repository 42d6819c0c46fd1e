// The sweeps of the iterative solver, and the energy that the impulses make.
#include "runtime/contact/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/contact/normals.hpp"
#include "runtime/contact/pack.hpp"
#include "runtime/contact/plain.hpp"
#include "runtime/contact/visit.hpp"

namespace breve::contact {

namespace {

void sweep_scalars(Workspace& work, Moved& moved) {
  for (PackedScalar& row : work.scalars) {
    row.step = 0;
    if (!(row.response > 0)) continue;
    const double error = velocity(work, row) + row.softness * row.impulse - row.bias;
    const double next = std::clamp(row.impulse - error / row.response, row.lo, row.hi);
    if (!std::isfinite(next)) continue;
    const double change = next - row.impulse;
    row.impulse = next;
    row.step = change;
    push(work, row, change);
    moved.largest = std::max(moved.largest, std::abs(change) * row.response);
    moved.energy += change * change * row.response;
  }
}

}  // namespace

void push_all(Workspace& work) {
  for (std::size_t i = 0; i < work.points.size(); ++i)
    if (work.points[i].impulse[0] > 0) push(work, i, work.points[i].impulse);
  for (const PackedScalar& row : work.scalars)
    if (row.impulse != 0) push(work, row, row.impulse);
}

double visit_point(Workspace& work, std::size_t point) {
  Point& c = work.points[point];
  double u[3];
  velocity(work, point, u);
  const double moved = visit(c, u, c.step);
  if (moved > 0) push(work, point, c.step);
  return moved;
}

namespace {

Moved sweep(Workspace& work, bool backward) {
  Moved moved;
  sweep_scalars(work, moved);
  const std::size_t count = work.points.size();
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t i = backward ? count - 1 - n : n;
    moved.largest = std::max(moved.largest, visit_point(work, i));
    const Point& c = work.points[i];
    const LocalMatrix& W = c.response;
    moved.energy += c.step[0] * c.step[0] * W.nn + c.step[1] * c.step[1] * W.s11 + c.step[2] * c.step[2] * W.s22;
  }
  return moved;
}

void go_on(Workspace& work, double share) {
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    Point& c = work.points[i];
    double more[3];
    for (int k = 0; k < 3; ++k) {
      more[k] = share * c.way[k];
      c.way[k] = more[k] + c.step[k];
      c.impulse[k] += more[k];
    }
    if (more[0] != 0 || more[1] != 0 || more[2] != 0) push(work, i, more);
  }
  for (PackedScalar& row : work.scalars) {
    const double more = share * row.way;
    row.way = more + row.step;
    row.impulse += more;
    if (more != 0) push(work, row, more);
  }
}

}  // namespace

Sweeps::Sweeps(Workspace& work, bool momentum) : work_(work), kind_(kind_of(work)), momentum_(momentum) {
  if (kind_ == Kind::Plain) enter_plain(work_);
  if (kind_ == Kind::Normals) enter_normals(work_);
  if (kind_ != Kind::Any) return;
  for (Point& c : work_.points) std::fill_n(c.way, 3, 0.0);
  for (PackedScalar& row : work_.scalars) row.way = 0;
}

Sweeps::~Sweeps() {
  if (kind_ == Kind::Plain) leave_plain(work_);
  if (kind_ == Kind::Normals) leave_normals(work_);
}

Sweeps::Kind Sweeps::kind_of(const Workspace& work) {
  if (work.by_normals) return Kind::Normals;
  return !work.condensed && is_plain(work) ? Kind::Plain : Kind::Any;
}

void Sweeps::go_on(double share) {
  switch (kind_) {
    case Kind::Plain: return go_on_plain(work_, share);
    case Kind::Normals: return go_on_normals(work_, share);
    case Kind::Any: return contact::go_on(work_, share);
  }
}

Moved Sweeps::sweep(bool backward) {
  switch (kind_) {
    case Kind::Plain: return sweep_plain(work_, backward);
    case Kind::Normals: return sweep_normals(work_, backward);
    default: return contact::sweep(work_, backward);
  }
}

/// The share of the last change, for the sweep that follows.
double Sweeps::share() const {
  // Where friction is strong against what turns away from it, and in clumps, momentum may throw impulses ever farther.
  constexpr double kMore = 1.2, kThrown = 4;
  const double least = std::min(energy_first_, energy_before_);
  if (energy_ >= kMore * energy_before_ || energy_ >= kThrown * least) return 0;
  return std::min(1.0, energy_ / energy_before_);
}

bool Sweeps::diverge() const {
  constexpr double kFar = 1e4;
  return energy_ > kFar * energy_first_;
}

double Sweeps::next() {
  if (momentum_ && count_ > 0) go_on(share());
  const bool backward = count_++ % 2 == 1;
  const Moved moved = sweep(backward);
  energy_before_ = std::exchange(energy_, moved.energy);
  if (count_ == 1) energy_first_ = energy_;
  return moved.largest;
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
