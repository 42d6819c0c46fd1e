// Symmetric, positive semidefinite equations, as of rows that may depend on one another.
#pragma once

#include "runtime/base/meter.hpp"

namespace breve::contact {

/// A = A^T of m x m numbers, row by row, factorised in place by Cholesky's method with the largest pivot next. Rows
/// that depend on others get nothing.
class Semidefinite {
 public:
  /// @param a      is overwritten, and outlives this, as do the other two
  /// @param scale  room for m numbers
  /// @param order  likewise
  Semidefinite(int m, double* a, double* scale, int* order) : m_(m), a_(a), scale_(scale), order_(order) {}

  void factorize(const WorkBound& bound);
  /// b becomes the solution of A x = b; of rows that depend on others, 0.
  void solve(double* b) const;
  /// If rows that depend on others contradict them: b becomes the x that leaves the least of A x - b, rows being scaled
  /// to 1, and the shortest such x. O(m^3).
  /// @param room  for m (m + 1) numbers
  void solve_least(double* b, double* room) const;
  bool dependent() const { return rank_ < m_; }

 private:
  double& at(int i, int k) const { return a_[order_[i] * m_ + order_[k]]; }

  int m_, rank_ = 0;
  double *a_, *scale_;
  int* order_;
};

}  // namespace breve::contact
