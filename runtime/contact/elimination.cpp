// Elimination within the envelope of the rows: the cost is n times the square of the band for a stack in order.
#include "runtime/contact/elimination.hpp"

#include <algorithm>
#include <cmath>

namespace breve::contact {

bool eliminate(std::span<double> matrix, std::span<double> b, std::span<int> ends) {
  const int n = static_cast<int>(b.size());
  const auto row = [&](int i) { return matrix.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(n); };
  const auto end = [&](int i) -> int& { return ends[static_cast<std::size_t>(i)]; };
  for (int i = 0; i < n; ++i) {
    int last = n;
    while (last > i + 1 && row(i)[last - 1] == 0) --last;
    end(i) = last;
  }
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(row(i)[k]) > std::abs(row(pivot)[k])) pivot = i;
    if (pivot != k) {
      std::swap_ranges(row(k) + k, row(k) + n, row(pivot) + k);
      std::swap(b[static_cast<std::size_t>(k)], b[static_cast<std::size_t>(pivot)]);
      std::swap(end(k), end(pivot));
    }
    const double* top = row(k);
    if (!std::isfinite(top[k]) || top[k] == 0) return false;
    const double inverse = 1 / top[k];
    const int last = end(k);
    for (int i = k + 1; i < n; ++i) {
      double* below = row(i);
      if (below[k] == 0) continue;
      const double factor = below[k] * inverse;
      for (int j = k + 1; j < last; ++j) below[j] -= factor * top[j];
      b[static_cast<std::size_t>(i)] -= factor * b[static_cast<std::size_t>(k)];
      end(i) = std::max(end(i), last);
    }
  }
  for (int i = n - 1; i >= 0; --i) {
    double sum = b[static_cast<std::size_t>(i)];
    for (int j = i + 1; j < end(i); ++j) sum -= row(i)[j] * b[static_cast<std::size_t>(j)];
    b[static_cast<std::size_t>(i)] = sum / row(i)[i];
  }
  return true;
}

}  // namespace breve::contact
