// The test's own operator new and delete: every allocation of the process is counted, and the n-th can be made to fail.
// The allocator that the tests give to a runtime counts on the same counter.
#pragma once

#include <cstddef>
#include <cstdint>

#include "breve/breve.h"

namespace limits {

/// Blocks and bytes alive now, by operator new.
std::size_t live_blocks();
std::size_t live_bytes();
/// The same of the allocator given to runtimes.
std::size_t given_blocks();
std::size_t given_bytes();

/// From now on the n-th allocation (1 = the next) fails, and only that one; 0: none.
void fail_allocation(std::uint64_t n);
/// How many were asked for since fail_allocation.
std::uint64_t allocations();
/// Has it failed? `by_nothrow`: it was asked for with std::nothrow, so that its caller may go on without.
bool failed();
bool failed_nothrow();

/// A configuration whose allocator counts here.
breve_runtime_config counted_config();

}  // namespace limits
