// The chain of calls at a moment: what is said about each call, and how the chain is laid out.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "steve/code/foreign.hpp"
#include "steve/code/program.hpp"
#include "steve/machine/report.hpp"

namespace breve::steve {

/// A method that runs, as reports see it.
struct ActiveCall {
  const MethodInfo* method;
  const Instance* self;
  const Slot* registers;  // of the method: its parameters come first
  Span span;              // of what it is running
};

/// @param calls   outermost first
/// @param places  MachineHost::places; may be empty
std::vector<TraceLine> trace_of(std::span<const ActiveCall> calls, const Program& program,
                                const std::function<std::vector<ForeignPlace>(std::size_t depth)>& places);

/// One line a call, innermost first; recursions without end are folded, and the middle of a long chain is left out.
/// @param trace  outermost first
std::string trace_text(const std::vector<TraceLine>& trace);

}  // namespace breve::steve
