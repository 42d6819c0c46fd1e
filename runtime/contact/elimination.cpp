// Elimination within the envelope of the rows: the cost is n times the square of the band for a stack in order.
#include "runtime/contact/elimination.hpp"

#include <algorithm>
#include <cmath>

namespace breve::contact {

BandMatrix::BandMatrix(int size, int band) : size_(size), band_(band) {
  const bool whole = 3 * band + 1 >= size;
  if (whole) band_ = size;
  // A row holds what is up to a band before the diagonal and up to two behind it.
  const int width = whole ? size : 3 * band + 1;
  stride_ = whole ? size : width - 1;
  shift_ = whole ? 0 : band;
  numbers_ = static_cast<std::size_t>(size) * static_cast<std::size_t>(width);
}

void BandMatrix::clear() const { std::fill_n(numbers_at_, numbers_, 0.0); }

bool eliminate(const BandMatrix& matrix, std::span<double> b, std::span<int> ends) {
  const int n = matrix.size();
  const auto row = [&](int i) { return matrix.row(i); };
  const auto end = [&](int i) -> int& { return ends[static_cast<std::size_t>(i)]; };
  for (int i = 0; i < n; ++i) {
    int last = std::min(n, i + matrix.band() + 1);
    while (last > i + 1 && row(i)[last - 1] == 0) --last;
    end(i) = last;
  }
  for (int k = 0; k < n; ++k) {
    const int below_k = std::min(n, k + matrix.band() + 1);
    int pivot = k;
    for (int i = k + 1; i < below_k; ++i)
      if (std::abs(row(i)[k]) > std::abs(row(pivot)[k])) pivot = i;
    if (pivot != k) {
      std::swap_ranges(row(k) + k, row(k) + std::max(end(k), end(pivot)), row(pivot) + k);
      std::swap(b[static_cast<std::size_t>(k)], b[static_cast<std::size_t>(pivot)]);
      std::swap(end(k), end(pivot));
    }
    const double* top = row(k);
    if (!std::isfinite(top[k]) || top[k] == 0) return false;
    const double inverse = 1 / top[k];
    const int last = end(k);
    for (int i = k + 1; i < below_k; ++i) {
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
