// Solved over the rows, by the matrix W that says how they answer one another.
#include "runtime/contact/bilateral.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/contact/direct.hpp"
#include "runtime/contact/pack.hpp"
#include "runtime/contact/semidefinite.hpp"

namespace breve::contact {

bool is_bilateral(const Workspace& work) {
  return work.points.empty() && std::all_of(work.scalars.begin(), work.scalars.end(), [](const PackedScalar& row) {
           return std::isinf(row.lo) && std::isinf(row.hi);
         });
}

namespace {

/// Adds to the impulses of all rows `share` of what `step` says.
void add(Workspace& work, const double* step, double share) {
  for (std::size_t i = 0; i < work.scalars.size(); ++i) {
    PackedScalar& row = work.scalars[i];
    row.impulse += share * step[i];
    push(work, row, share * step[i]);
  }
}

}  // namespace

BilateralSolution solve_bilateral(Workspace& work, double tolerance, Meter* meter) {
  constexpr int kRefinements = 3;            // of what round-off leaves
  constexpr std::uint64_t kOperations = 64;  // in a unit of work
  const std::size_t m = work.scalars.size();
  BilateralSolution found{violation(work), false, false};
  const auto attained = [&] { return found.left <= attainable(work, tolerance); };
  found.solved = attained();
  if (found.solved) return found;
  if (meter) meter->add(m * m * m / (3 * kOperations) + 1);
  work.numbers.resize(2 * m * m + 3 * m);
  work.indices.resize(m);
  double *const matrix = work.numbers.data(), *const scale = matrix + m * m, *const step = scale + m;
  std::copy(work.answers.begin(), work.answers.end(), matrix);
  for (std::size_t i = 0; i < m; ++i) matrix[i * m + i] += work.scalars[i].softness;
  Semidefinite equations(static_cast<int>(m), matrix, scale, work.indices.data());
  equations.factorize({0, meter ? meter->end() : nullptr});
  const auto errors = [&] {
    for (std::size_t k = 0; k < m; ++k) {
      const PackedScalar& row = work.scalars[k];
      step[k] = row.bias - velocity(work, row) - row.softness * row.impulse;
    }
  };
  for (int i = 0; i <= kRefinements && !found.solved; ++i) {
    errors();
    equations.solve(step);
    add(work, step, 1);
    const double now = violation(work);
    if (!(now < found.left)) {
      add(work, step, -1);
      break;
    }
    found.left = now;
    found.solved = attained();
  }
  if (found.solved || !equations.dependent()) return found;
  // A solver that goes on from here presses one row against another ever more.
  errors();
  equations.solve_least(step, step + m);
  add(work, step, 1);
  found.left = violation(work);
  found.solved = attained();
  found.contradictory = !found.solved;
  return found;
}

}  // namespace breve::contact
