// In which order a direct solve eliminates the velocities of an island's movers, and what it will cost: known before
// anything is solved.
#pragma once

#include "runtime/contact/workspace.hpp"

namespace breve::contact {

/// Orders the movers so that those that share rows are near one another, and numbers their velocities in that order:
/// work.indices gets the first number of each packed mover. Where the island is condensed it does nothing.
/// Source: Cuthill and McKee 1969, reversed (George 1971). Deterministic.
/// @param most  operations that one elimination may take: where it is clear without an order that it takes more,
///              nothing is ordered
/// @return      the operations of one elimination, rows included, or what they are at least
double order_elimination(Workspace& work, double most);

/// Operations of one sweep over all rows.
double sweep_operations(const Workspace& work);

}  // namespace breve::contact
