// Repetition with a memory of one, and when it is good enough.
#include "runtime/articulated/midpoint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/base/error.hpp"

namespace breve::articulated {

namespace {

constexpr int kMostEvaluations = 6;
constexpr double kShare = 0.3;  // of the tolerance, by which the mean velocity may be off before its last correction
/// The share of a change of the guess in its answer: for an oscillation at w rad/s (w h / 2)^2; beyond it the phase is
/// lost.
constexpr double kMostShare = 0.3;

}  // namespace

Midpoint::Midpoint(System& system, const Tolerance& tolerance)
    : system_(system),
      tolerance_(tolerance),
      q_(system.positions()),
      a_(system.velocities()),
      d_(a_),
      u_(a_),
      change_(a_),
      result_(a_),
      last_change_(a_),
      last_result_(a_) {}

bool Midpoint::step(Instant& at, double h) {
  evaluations_ = 0;
  try {
    if (!find_mean(at, h)) return false;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Numeric) throw;
    return false;
  }
  d_ = h * result_;
  system_.move(at.q, d_, q_);
  at.q = q_;
  at.v += h * a_;
  if (at.mean.size() == a_.size()) at.mean = a_;
  at.t += h;
  return true;
}

bool Midpoint::find_mean(const Instant& at, double h) {
  u_ = at.v;
  const bool guessed = at.mean.size() == u_.size();
  if (guessed) u_ += (0.5 * h) * at.mean;
  for (evaluations_ = 1; evaluations_ <= kMostEvaluations; ++evaluations_) {
    d_ = (0.5 * h) * u_;
    system_.move(at.q, d_, q_);
    system_.acceleration(at.t + 0.5 * h, q_, u_, 0, a_);
    result_ = at.v + (0.5 * h) * a_;
    change_ = result_ - u_;
    const double largest = largest_change();
    if ((guessed || evaluations_ > 1) && largest <= kShare * tolerance_.relative) {
      if (evaluations_ == 2) correct_second(at, h);
      return true;
    }
    // The first two guesses are not corrected: what the rule makes of their difference says how much rotates in a step.
    if (evaluations_ == 2 && change_.norm() > kMostShare * last_change_.norm()) return false;
    // Where the change shrinks by a constant factor, this goes to its end at once.
    double beyond = 0;
    if (evaluations_ > 1) {
      last_change_ -= change_;
      const double square = last_change_.squaredNorm();
      if (square > 0) beyond = change_.dot(last_change_) / square;
    }
    u_ = result_;
    if (beyond != 0) u_ += beyond * (result_ - last_result_);
    last_change_ = change_;
    last_result_ = result_;
  }
  evaluations_ = kMostEvaluations;
  return false;
}

/// An oscillation at w answers an error of the guess with -(w h / 2)^2 of it. One that was answered twice always has
/// the sign that drives the oscillation on. Where springs pull, what the two changes say is left of it is removed.
void Midpoint::correct_second(const Instant& at, double h) {
  double along = 0, square = 0;
  for (int i = 0; i < static_cast<int>(u_.size()); ++i) {
    if (!system_.sprung(i)) continue;
    const double unit = system_.kind(i) == Kind::Angle ? tolerance_.angular_velocity : tolerance_.velocity;
    const double less = (last_change_[i] - change_[i]) / unit;
    along += change_[i] / unit * less;
    square += less * less;
  }
  if (!(square > 0 && along < 0)) return;
  constexpr double kMost = kMostShare / (1 + kMostShare);
  result_ += std::max(along / square, -kMost) * change_;
  a_ = (2 / h) * (result_ - at.v);
}

/// The error of the velocity, by kind and size. Infinite where a number is not finite. Accounts, which change nothing,
/// are taken as right.
double Midpoint::largest_change() {
  double largest = 0;
  for (int i = 0; i < static_cast<int>(u_.size()); ++i) {
    const Kind kind = system_.kind(i);
    if (kind == Kind::Ledger) {
      change_[i] = 0;
      continue;
    }
    const double unit = kind == Kind::Angle ? tolerance_.angular_velocity : tolerance_.velocity;
    const double part = std::abs(change_[i]) / (unit + std::abs(u_[i]));
    if (!std::isfinite(part)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, part);
  }
  return largest;
}

}  // namespace breve::articulated
