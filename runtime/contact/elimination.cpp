// Elimination within the envelope of the rows: the cost is n times the square of the band for a stack in order.
#include "runtime/contact/elimination.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/contact/lanes.hpp"

namespace breve::contact {

namespace {

/// Columns that are eliminated before what is right of them: each number there is then read and written a quarter as
/// often.
constexpr int kPanel = 4;

/// The panel that begins at column `first`.
struct Panel {
  int first, end;
  Panel(int n, int begin) : first(begin), end(std::min(n, begin + kPanel)) {}
};

/// Subtracts the rows of a panel, times the factors that are in `row`, from it.
void subtract(const BandMatrix& matrix, const Panel& panel, double* row, int last) {
  if (panel.end - panel.first == kPanel) {
    const double* factors = row + panel.first;
    const double a = factors[0], b = factors[1], c = factors[2], d = factors[3];
    const double *of_a = matrix.row(panel.first), *of_b = matrix.row(panel.first + 1),
                 *of_c = matrix.row(panel.first + 2), *of_d = matrix.row(panel.first + 3);
    for (int j = panel.end; j < last; ++j) row[j] = row[j] - a * of_a[j] - b * of_b[j] - c * of_c[j] - d * of_d[j];
    return;
  }
  for (int k = panel.first; k < panel.end; ++k)
    for (int j = panel.end; j < last; ++j) row[j] -= row[k] * matrix.row(k)[j];
}

}  // namespace

BandMatrix::BandMatrix(int size, int band) : size_(size), band_(band + kPanel - 1) {
  const bool whole = 3 * band_ + 1 >= size;
  if (whole) band_ = size;
  // A row holds what is up to a band before the diagonal and up to two behind it. Rows that are exchanged take factors
  // of their panel with them: the band is as much wider.
  const int width = whole ? size : 3 * band_ + 1;
  stride_ = whole ? size : width - 1;
  shift_ = whole ? 0 : band_;
  numbers_ = static_cast<std::size_t>(size) * static_cast<std::size_t>(width);
}

void BandMatrix::clear() const { std::fill_n(numbers_at_, numbers_, 0.0); }

namespace {

/// Gaussian elimination with partial pivoting, panel by panel.
class Factorization {
 public:
  Factorization(const BandMatrix& matrix, std::span<int> pivots, std::span<int> ends)
      : matrix_(matrix), n_(matrix.size()), pivots_(pivots), ends_(ends) {}

  bool run() {
    for (int i = 0; i < n_; ++i) {
      int last = std::min(n_, i + matrix_.band() + 1);
      while (last > i + 1 && row(i)[last - 1] == 0) --last;
      end(i) = last;
    }
    for (int k = 0; k < n_; k += kPanel) {
      const Panel panel(n_, k);
      for (int c = panel.first; c < panel.end; ++c)
        if (!eliminate_within(panel, c)) return false;
      finish(panel);
    }
    return true;
  }

 private:
  double* row(int i) const { return matrix_.row(i); }
  int& end(int i) const { return ends_[static_cast<std::size_t>(i)]; }
  int below(int column) const { return std::min(n_, column + matrix_.band() + 1); }

  /// Column c of the rows below it, as far as the panel goes. Rows are exchanged with the factors that they have in the
  /// panel.
  bool eliminate_within(const Panel& panel, int c) {
    int pivot = c;
    for (int i = c + 1; i < below(c); ++i)
      if (std::abs(row(i)[c]) > std::abs(row(pivot)[c])) pivot = i;
    pivots_[static_cast<std::size_t>(c)] = pivot;
    if (pivot != c) {
      std::swap_ranges(row(c) + panel.first, row(c) + std::max(end(c), end(pivot)), row(pivot) + panel.first);
      std::swap(end(c), end(pivot));
    }
    const double* top = row(c);
    if (!std::isfinite(top[c]) || top[c] == 0) return false;
    const double inverse = 1 / top[c];
    for (int i = c + 1; i < below(c); ++i) {
      double* line = row(i);
      if (line[c] == 0) continue;
      const double factor = line[c] *= inverse;
      for (int j = c + 1; j < panel.end; ++j) line[j] -= factor * top[j];
      end(i) = std::max(end(i), end(c));
    }
    return true;
  }

  /// The columns right of a panel.
  void finish(const Panel& panel) {
    int last = panel.end;
    for (int k = panel.first; k < panel.end; ++k) {
      for (int q = panel.first; q < k; ++q) {
        const double factor = row(k)[q];
        if (factor == 0) continue;
        for (int j = panel.end; j < end(q); ++j) row(k)[j] -= factor * row(q)[j];
      }
      last = std::max(last, end(k));
    }
    for (int i = panel.end; i < below(panel.first); ++i) {
      const double* factors = row(i) + panel.first;
      if (std::any_of(factors, factors + (panel.end - panel.first), [](double factor) { return factor != 0; }))
        subtract(matrix_, panel, row(i), last);
    }
  }

  const BandMatrix& matrix_;
  int n_;
  std::span<int> pivots_, ends_;
};

}  // namespace

namespace {

/// The same for a small matrix, column by column, rows being exchanged as a whole.
bool factorize_small(const BandMatrix& matrix, std::span<int> pivots) {
  const int n = matrix.size();
  for (int c = 0; c < n; ++c) {
    int pivot = c;
    for (int i = c + 1; i < n; ++i)
      if (std::abs(matrix.row(i)[c]) > std::abs(matrix.row(pivot)[c])) pivot = i;
    pivots[static_cast<std::size_t>(c)] = pivot;
    double* const top = matrix.row(c);
    if (pivot != c) std::swap_ranges(top, top + n, matrix.row(pivot));
    if (!std::isfinite(top[c]) || top[c] == 0) return false;
    const double inverse = 1 / top[c];
    for (int i = c + 1; i < n; ++i) {
      double* const line = matrix.row(i);
      if (line[c] == 0) continue;
      line[c] *= inverse;
      add_multiple(-line[c], top + c + 1, n - c - 1, line + c + 1);
    }
  }
  return true;
}

void substitute_small(const BandMatrix& factors, std::span<const int> pivots, double* b) {
  const int n = factors.size();
  for (int c = 0; c < n; ++c) std::swap(b[c], b[pivots[static_cast<std::size_t>(c)]]);
  for (int i = 1; i < n; ++i) {
    const double* row = factors.row(i);
    for (int k = 0; k < i; ++k) b[i] -= row[k] * b[k];
  }
  for (int i = n - 1; i >= 0; --i) {
    const double* row = factors.row(i);
    double sum = b[i];
    for (int k = i + 1; k < n; ++k) sum -= row[k] * b[k];
    b[i] = sum / row[i];
  }
}

}  // namespace

bool factorize(const BandMatrix& matrix, std::span<int> pivots, std::span<int> ends) {
  if (matrix.small()) return factorize_small(matrix, pivots);
  return Factorization(matrix, pivots, ends).run();
}

void substitute(const BandMatrix& factors, std::span<const int> pivots, std::span<const int> ends,
                std::span<double> b) {
  if (factors.small()) return substitute_small(factors, pivots, b.data());
  const int n = factors.size();
  const auto at = [&](int i) -> double& { return b[static_cast<std::size_t>(i)]; };
  for (int k = 0; k < n; k += kPanel) {
    const Panel panel(n, k);
    for (int c = panel.first; c < panel.end; ++c) std::swap(at(c), at(pivots[static_cast<std::size_t>(c)]));
    const int below = std::min(n, panel.first + factors.band() + 1);
    for (int i = panel.first + 1; i < below; ++i)
      for (int c = panel.first; c < std::min(i, panel.end); ++c) at(i) -= factors.row(i)[c] * at(c);
  }
  for (int i = n - 1; i >= 0; --i) {
    const double* row = factors.row(i);
    double sum = at(i);
    for (int j = i + 1; j < ends[static_cast<std::size_t>(i)]; ++j) sum -= row[j] * at(j);
    at(i) = sum / row[i];
  }
}

}  // namespace breve::contact
