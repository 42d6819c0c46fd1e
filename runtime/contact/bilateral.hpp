// Rows without bounds, as of loops alone: their law is one system of linear equations, which is solved at once.
#pragma once

#include "runtime/base/meter.hpp"
#include "runtime/contact/workspace.hpp"

namespace breve::contact {

/// No row has a bound, and there is no contact.
bool is_bilateral(const Workspace& work);
/// Solves such rows of a condensed island, from the impulses that it has. They are those of the best iterate.
/// @param solved  whether the violation is within the tolerance, or as near to it as round-off allows
/// @return        the violation left, m/s
double solve_bilateral(Workspace& work, double tolerance, Meter* meter, bool& solved);

}  // namespace breve::contact
