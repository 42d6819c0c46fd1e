// The sweeps over W: a row that changes changes the velocities of all.
#include "runtime/contact/normals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace breve::contact {

namespace {

NormalRow normal_of(const Point& c) {
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  return {c.impulse[0], c.bias, c.softness, c.response.nn, 0, kNoLimit, 0, 0};
}

NormalRow normal_of(const PackedScalar& row) {
  return {row.impulse, row.bias, row.softness, row.response, row.lo, row.hi, 0, 0};
}

void push(Workspace& work, std::size_t row, double impulse) {
  const std::size_t n = work.normals.size();
  add_multiple(impulse, &work.normal_answers[row * n], static_cast<int>(n), work.normal_rates.data());
}

void visit(Workspace& work, std::size_t i, Moved& moved) {
  NormalRow& row = work.normals[i];
  row.step = 0;
  if (!(row.response > 0)) return;
  const double error = work.normal_rates[i] + row.softness * row.impulse - row.bias;
  const double next = std::clamp(row.impulse - error / row.response, row.lo, row.hi);
  const double change = next - row.impulse;
  if (change == 0 || !std::isfinite(next)) return;
  row.impulse = next;
  row.step = change;
  push(work, i, change);
  moved.largest = std::max(moved.largest, std::abs(change) * row.response);
  moved.energy += change * change * row.response;
}

}  // namespace

void enter_normals(Workspace& work) {
  work.normals.clear();
  for (const Point& c : work.points) work.normals.push_back(normal_of(c));
  for (const PackedScalar& row : work.scalars) work.normals.push_back(normal_of(row));
  work.normal_rates.assign(work.normals.size(), 0.0);
  for (std::size_t i = 0; i < work.normals.size(); ++i)
    if (work.normals[i].impulse != 0) push(work, i, work.normals[i].impulse);
}

void leave_normals(Workspace& work) {
  const NormalRow* row = work.normals.data();
  for (Point& c : work.points) c.impulse[0] = row++->impulse;
  for (PackedScalar& scalar : work.scalars) scalar.impulse = row++->impulse;
}

Moved sweep_normals(Workspace& work, bool backward) {
  Moved moved;
  const std::size_t points = work.points.size();
  for (std::size_t i = points; i < work.normals.size(); ++i) visit(work, i, moved);
  for (std::size_t i = 0; i < points; ++i) visit(work, backward ? points - 1 - i : i, moved);
  return moved;
}

void go_on_normals(Workspace& work, double share) {
  for (std::size_t i = 0; i < work.normals.size(); ++i) {
    NormalRow& row = work.normals[i];
    const double more = share * row.way;
    row.way = more + row.step;
    if (more == 0) continue;
    row.impulse += more;
    push(work, i, more);
  }
}

}  // namespace breve::contact
