// Rows without bounds, as of loops alone: their law is one system of linear equations, which is solved at once.
#pragma once

#include "runtime/base/meter.hpp"
#include "runtime/contact/workspace.hpp"

namespace breve::contact {

/// No row has a bound, and there is no contact.
bool is_bilateral(const Workspace& work);

struct BilateralSolution {
  double left;         // m/s, the violation
  bool solved;         // that is within the tolerance, or as near to it as round-off allows
  bool contradictory;  // rows depend on one another and ask for different things: as little as possible is left
};

/// Solves such rows of a condensed island, from the impulses that it has. They are those of the best iterate.
BilateralSolution solve_bilateral(Workspace& work, double tolerance, Meter* meter);

}  // namespace breve::contact
