// The direct solver for small islands: Newton's method on all rows at once, to tolerance.
#pragma once

#include "runtime/base/meter.hpp"
#include "runtime/contact/workspace.hpp"

namespace breve::contact {

/// Linear solves: how many there were, and how many there may be.
struct LinearSolves {
  int made = 0, most = 0;
  std::uint64_t units = 0;  // of work, each
  Meter* meter = nullptr;   // null: nobody counts

  void make() {
    ++made;
    if (meter) meter->add(units);
  }
  int left() const { return meter && meter->over() ? 0 : most - made; }
  bool spent() const { return left() <= 0; }
};

/// Solve the packed island from the impulses it has. Velocities and impulses of `work` are those of the best iterate,
/// consistent with each other, inside cones and bounds.
/// @param lean    points without an impulse may be set aside meanwhile: two solutions of one island then differ by as
///                much as the tolerance lets them
/// @param solves  grows; where they are spent, the best of what they gave is the result
/// @param solved  whether the violation is within the tolerance, or as near to it as round-off allows
/// @return        the violation left, m/s
double solve_direct(Workspace& work, double tolerance, bool lean, LinearSolves& solves, bool& solved);

/// Whether there are enough solves for the interior-point method. It begins from far: fewer lead nowhere, and large
/// islands take more, unless nothing has an impulse yet: the bodies then nearly always begin at rest.
bool enough_from_far(const Workspace& work, const LinearSolves& solves);

/// Whether Newton's method may converge from the island's impulses, whose violation is `left`, m/s.
bool within_reach(const Workspace& work, double left);

/// By how much the worst row violates its law, m/s: the distance to the projected point of a step of the row alone.
double violation(const Workspace& work);

/// The violation that round-off leaves of a tolerance, m/s.
double attainable(const Workspace& work, double tolerance);

/// What the strongest impulse does to the velocity at its row, m/s: what a violation is to be compared with.
double largest_change(const Workspace& work);

}  // namespace breve::contact
