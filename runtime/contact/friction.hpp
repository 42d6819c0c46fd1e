// Which points of a solved island slide and so have the dynamic coefficient, where that differs from the static one.
#pragma once

#include <span>

#include "runtime/contact/solver.hpp"

namespace breve::contact {

/// Every point is first solved with its static coefficient. After a solve, one that slid gets the dynamic one; so does
/// one that could hold, but was sliding when the step began and goes on sliding under the dynamic coefficient. One of
/// these that comes to rest after all gets the static one back, for good.
/// @return true if some coefficient changed: solve again
bool settle_friction(std::span<const Row> rows, double tolerance, Workspace& work);

}  // namespace breve::contact
