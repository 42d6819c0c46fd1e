// The cost of long work, counted as it is done.
#pragma once

#include <cstdint>
#include <functional>

namespace breve {

/// Called again and again by long work with the cost of its next piece, in units of some 200 ns. It may throw to end
/// the work. Empty: nobody counts.
using CostMeter = std::function<void(std::uint64_t units)>;

}  // namespace breve
