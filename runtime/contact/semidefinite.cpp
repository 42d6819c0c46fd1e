// Cholesky's method with complete pivoting.
#include "runtime/contact/semidefinite.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

namespace breve::contact {

void Semidefinite::factorize(const WorkBound& bound) {
  constexpr double kDependent = 1e-11;  // of a pivot, rows being scaled to 1
  for (int i = 0; i < m_; ++i) {
    order_[i] = i;
    scale_[i] = a_[i * m_ + i] > 0 ? 1 / std::sqrt(a_[i * m_ + i]) : 0;
  }
  for (int i = 0; i < m_; ++i)
    for (int k = 0; k < m_; ++k) a_[i * m_ + k] *= scale_[i] * scale_[k];
  for (rank_ = 0; rank_ < m_; ++rank_) {
    bound.poll();
    int best = rank_;
    for (int i = rank_ + 1; i < m_; ++i)
      if (at(i, i) > at(best, best)) best = i;
    std::swap(order_[rank_], order_[best]);
    if (!(at(rank_, rank_) > kDependent)) break;
    at(rank_, rank_) = std::sqrt(at(rank_, rank_));
    for (int i = rank_ + 1; i < m_; ++i) at(i, rank_) /= at(rank_, rank_);
    for (int i = rank_ + 1; i < m_; ++i)
      for (int k = rank_ + 1; k <= i; ++k) at(i, k) = at(k, i) = at(i, k) - at(i, rank_) * at(k, rank_);
  }
}

void Semidefinite::solve(double* b) const {
  for (int i = 0; i < m_; ++i) b[i] *= scale_[i];
  for (int i = 0; i < rank_; ++i) {
    for (int k = 0; k < i; ++k) b[order_[i]] -= at(i, k) * b[order_[k]];
    b[order_[i]] /= at(i, i);
  }
  for (int i = rank_ - 1; i >= 0; --i) {
    for (int k = i + 1; k < rank_; ++k) b[order_[i]] -= at(k, i) * b[order_[k]];
    b[order_[i]] /= at(i, i);
  }
  for (int i = rank_; i < m_; ++i) b[order_[i]] = 0;
  for (int i = 0; i < m_; ++i) b[i] *= scale_[i];
}

/// A = L L^T with as many columns as A has rank: x = L (L^T L)^-2 L^T b.
/// Source: Courrieu 2005 (the pseudoinverse by a Cholesky factor of full rank).
void Semidefinite::solve_least(double* b, double* room) const {
  double *const gram = room, *const y = room + rank_ * rank_;
  for (int i = 0; i < m_; ++i) b[i] *= scale_[i];
  for (int k = 0; k < rank_; ++k) {
    y[k] = 0;
    for (int i = k; i < m_; ++i) y[k] += at(i, k) * b[order_[i]];
    for (int l = 0; l <= k; ++l) {
      gram[k * rank_ + l] = 0;
      for (int i = k; i < m_; ++i) gram[k * rank_ + l] += at(i, k) * at(i, l);
    }
  }
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Map<Square> lower(gram, rank_, rank_);
  Eigen::Map<Eigen::VectorXd> shares(y, rank_);
  const Eigen::LLT<Eigen::Ref<Square>, Eigen::Lower> factor(lower);
  for (int i = 0; i < 2; ++i) factor.solveInPlace(shares);
  for (int i = 0; i < m_; ++i) {
    b[order_[i]] = 0;
    for (int k = 0; k < std::min(i + 1, rank_); ++k) b[order_[i]] += at(i, k) * y[k];
  }
  for (int i = 0; i < m_; ++i) b[i] *= scale_[i];
}

}  // namespace breve::contact
