// How the chain of calls of a run-time error is laid out.
#pragma once

#include <string>
#include <vector>

namespace breve::steve {

struct TraceLine;

/// One line a call, innermost first; recursions without end are folded, and the middle of a long chain is left out.
/// @param trace  outermost first
std::string trace_text(const std::vector<TraceLine>& trace);

}  // namespace breve::steve
