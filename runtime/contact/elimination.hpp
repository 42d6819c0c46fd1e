// Gaussian elimination with partial pivoting that skips what is zero: stacked bodies couple with their neighbours only.
#pragma once

#include <span>

namespace breve::contact {

/// Solve A x = b in place: `b` becomes x, `matrix` (n x n, row-major) is destroyed.
/// @param ends  n numbers of workspace
/// @return      false if a pivot vanishes or is not finite; b is then of no use
bool eliminate(std::span<double> matrix, std::span<double> b, std::span<int> ends);

}  // namespace breve::contact
