// The table of the functions of breve.h that fuzz_call calls, in parts. A function that is added to the header gets an
// entry in one of them: a test compares the table with the header.
#pragma once

#include <span>

#include "caller.hpp"

namespace breve::fuzz {

// What else than BREVE_OK, _ARGUMENT and _MEMORY functions may give.
inline constexpr Statuses kBusy = status_bit(BREVE_ERROR_BUSY), kStale = status_bit(BREVE_ERROR_STALE),
                          kNotFound = status_bit(BREVE_ERROR_NOT_FOUND), kType = status_bit(BREVE_ERROR_TYPE),
                          kScriptError = status_bit(BREVE_ERROR_SCRIPT), kCompile = status_bit(BREVE_ERROR_COMPILE),
                          kFile = status_bit(BREVE_ERROR_FILE), kImage = status_bit(BREVE_ERROR_IMAGE),
                          kUnsupported = status_bit(BREVE_ERROR_UNSUPPORTED), kReload = status_bit(BREVE_ERROR_RELOAD);
/// The function returns its result, and no status: NULL handles give 0, false or NULL, which its call looks at.
inline constexpr Statuses kPlain = Statuses{1} << 31;
/// An object's pose.
inline constexpr Statuses kBody = kStale | status_bit(BREVE_ERROR_NO_BODY);
/// A variable by its name.
inline constexpr Statuses kVariable = kStale | kNotFound | kUnsupported;
/// A value that is passed in.
inline constexpr Statuses kValue = kStale | kUnsupported;
/// "Runs script"; busy from a breve_trace_fn.
inline constexpr Statuses kScript = kScriptError | kBusy | status_bit(BREVE_ERROR_BUDGET) |
                                    status_bit(BREVE_ERROR_DEPTH) | status_bit(BREVE_ERROR_INTERRUPTED);

std::span<const Function> runtime_functions();   // versions, runtimes, programs, lints, files
std::span<const Function> world_functions();     // worlds, input, snapshots, costs, changes
std::span<const Function> object_functions();    // objects and their places
std::span<const Function> bulk_functions();      // many objects at once
std::span<const Function> value_functions();     // values, lists, hashes, variables, calls, statements
std::span<const Function> body_functions();      // shapes, bodies, settings of physics, grids
std::span<const Function> space_functions();     // queries, collision filters
std::span<const Function> event_functions();     // events
std::span<const Function> setting_functions();   // what reads back what was set
std::span<const Function> view_functions();      // what is to be seen, getters
std::span<const Function> step_functions();      // game loops, batches
std::span<const Function> joint_functions();     // joints, springs, what they connect
std::span<const Function> analysis_functions();  // analyses
std::span<const Function> view_functions();      // scenes, views

/// All of them.
std::span<const Function> all_functions();

/// The calls since the process began, one number for each of all_functions().
struct Tally {
  std::size_t calls = 0, succeeded = 0, called_back = 0;
};
std::span<Tally> tallies();

/// What fuzz_call compiles and makes worlds of.
std::span<const std::string_view> call_programs();

}  // namespace breve::fuzz
