// Cholesky's method with complete pivoting.
#include "runtime/contact/semidefinite.hpp"

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

}  // namespace breve::contact
