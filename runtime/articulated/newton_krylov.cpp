// Newton's outer iteration with halving, GMRES with Givens rotations inside.
#include "runtime/articulated/newton_krylov.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace breve::articulated {

namespace {

constexpr int kMostIterations = 40;  // of Newton's method; 4 to 6 are usual
constexpr int kMostHalvings = 12;    // of one correction
constexpr int kMostDimensions = 60;  // of a Krylov space; a larger one pays only for very stiff systems
constexpr double kForcing = 1e-5;    // accuracy of each linear solve; finer than differences allow would be wasted
constexpr double kDifference =
    1.5e-8;                         // square root of round-off: balances cutting and rounding errors of a difference
constexpr double kAccepted = 1e-9;  // residual, relative to its terms, that counts as a solution

}  // namespace

NewtonKrylov::NewtonKrylov(int size)
    : most_(std::min(size, kMostDimensions)),
      f_(size),
      trial_(size),
      direction_(size),
      best_(size),
      basis_(size, most_ + 1),
      upper_(most_ + 1, most_),
      cosines_(most_),
      sines_(most_),
      right_(most_ + 1) {}

bool NewtonKrylov::solve(Residual& equation, Vector& z, double scale) {
  equation.residual(z, f_);
  double norm = f_.norm();
  for (int i = 0; i < kMostIterations && norm > 0 && std::isfinite(norm); ++i) {
    find_direction(equation, z, norm);
    best_ = z;
    double factor = 1, trial = std::numeric_limits<double>::infinity();
    for (int k = 0; k < kMostHalvings && !(trial < norm); ++k, factor *= 0.5) {
      z = best_ + factor * direction_;
      equation.residual(z, f_);
      trial = f_.norm();
      if (norm <= kAccepted * scale) break;  // at round-off there is nothing to search for
    }
    if (!(trial < norm)) {
      z = best_;
      break;
    }
    const bool stalled = norm <= kAccepted * scale && trial > 0.25 * norm;
    norm = trial;
    if (stalled) break;
  }
  return norm <= kAccepted * scale;
}

/// GMRES for J direction = -f.
void NewtonKrylov::find_direction(Residual& equation, const Vector& z, double norm) {
  basis_.col(0) = f_ / -norm;
  right_.setZero();
  right_[0] = norm;
  const double difference = kDifference * (1 + z.norm());
  int k = 0;
  for (double left = norm; k < most_ && left > kForcing * norm; ++k) {
    const bool exhausted = !extend_basis(equation, z, k, difference);
    left = rotate_column(k);
    if (exhausted) {
      ++k;
      break;
    }
  }
  direction_.setZero();
  for (int i = k - 1; i >= 0; --i) {
    double y = right_[i];
    for (int j = i + 1; j < k; ++j) y -= upper_(i, j) * right_[j];
    right_[i] = upper_(i, i) != 0 ? y / upper_(i, i) : 0;
    direction_ += right_[i] * basis_.col(i);
  }
}

/// Adds J times the last basis vector, made orthogonal. Returns false if it brings no new direction.
bool NewtonKrylov::extend_basis(Residual& equation, const Vector& z, int k, double difference) {
  trial_ = z + difference * basis_.col(k);
  auto next = basis_.col(k + 1);
  equation.residual(trial_, best_);
  next = (best_ - f_) / difference;
  const double whole = next.norm();
  for (int i = 0; i <= k; ++i) {
    upper_(i, k) = basis_.col(i).dot(next);
    next -= upper_(i, k) * basis_.col(i);
  }
  upper_(k + 1, k) = next.norm();
  if (!(upper_(k + 1, k) > 1e-14 * whole)) return false;
  next /= upper_(k + 1, k);
  return true;
}

/// Turns column k upper triangular; returns the residual that is left.
double NewtonKrylov::rotate_column(int k) {
  for (int i = 0; i < k; ++i) {
    const double a = upper_(i, k), b = upper_(i + 1, k);
    upper_(i, k) = cosines_[i] * a + sines_[i] * b;
    upper_(i + 1, k) = cosines_[i] * b - sines_[i] * a;
  }
  const double length = std::hypot(upper_(k, k), upper_(k + 1, k));
  cosines_[k] = length > 0 ? upper_(k, k) / length : 1;
  sines_[k] = length > 0 ? upper_(k + 1, k) / length : 0;
  upper_(k, k) = length;
  right_[k + 1] = -sines_[k] * right_[k];
  right_[k] *= cosines_[k];
  return std::abs(right_[k + 1]);
}

}  // namespace breve::articulated
