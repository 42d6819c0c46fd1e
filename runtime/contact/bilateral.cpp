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

double solve_bilateral(Workspace& work, double tolerance, Meter* meter, bool& solved) {
  constexpr int kRefinements = 3;            // of what round-off leaves
  constexpr std::uint64_t kOperations = 64;  // in a unit of work
  const std::size_t m = work.scalars.size();
  double left = violation(work);
  solved = left <= attainable(work, tolerance);
  if (solved) return left;
  if (meter) meter->add(m * m * m / (3 * kOperations) + 1);
  work.numbers.resize(m * m + 2 * m);
  work.indices.resize(m);
  double *const matrix = work.numbers.data(), *const scale = matrix + m * m, *const step = scale + m;
  std::copy(work.answers.begin(), work.answers.end(), matrix);
  for (std::size_t i = 0; i < m; ++i) matrix[i * m + i] += work.scalars[i].softness;
  Semidefinite equations(static_cast<int>(m), matrix, scale, work.indices.data());
  equations.factorize({0, meter ? meter->end() : nullptr});
  for (int i = 0; i <= kRefinements && !solved; ++i) {
    for (std::size_t k = 0; k < m; ++k) {
      const PackedScalar& row = work.scalars[k];
      step[k] = row.bias - velocity(work, row) - row.softness * row.impulse;
    }
    equations.solve(step);
    add(work, step, 1);
    const double now = violation(work);
    if (!(now < left)) {
      add(work, step, -1);
      break;
    }
    left = now;
    solved = left <= attainable(work, tolerance);
  }
  return left;
}

}  // namespace breve::contact
