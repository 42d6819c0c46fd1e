// Fehlberg's pair with step control. The higher member goes on; the difference of the two says how far it may be wrong.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/articulated/midpoint.hpp"
#include "runtime/articulated/runge_kutta.hpp"
#include "runtime/base/error.hpp"

namespace breve::articulated {

namespace {

// Source: Hairer, Norsett, Wanner 1993, II.4 (step size control).
constexpr double kSafety = 0.9;
constexpr double kMostGrowth = 5;
constexpr double kMostShrinking = 0.1;
constexpr double kOrder = 5;  // of the estimate's local error

// A tolerance is meant for a run: some thousand steps add up, and what moves chaotically multiplies them. So one step
// may err by this part of it only; measured on double pendulums over ten seconds. Below the finest, round-off would be
// judged.
constexpr double kShareOfStep = 1e-3;
constexpr double kFinest = 1e-15;
// The forces of a closed loop whose links come to lie in one line have a pole there: round-off in what holds it closed
// is divided by the square of the distance, and no step is short enough beside it. The whole step in a few equal parts
// leaps over the pole. Few steps do, so that each may err by the tolerance of a run, or else by this many times that.
constexpr double kMostLeap = 1e3;

// Both members swing a pendulum or a spring up: of z = i y their stability functions have |R|^2 = 1 + c y^6 with c > 0.
// As far beyond the higher member as it lies from the lower, times this, c and the next term are both below 0:
// swings lose a little and never gain. The order is then 4, so only where the tolerance is too coarse for the fifth.
constexpr double kBeyond = 0.6;
constexpr double kCoarse = 1e-3;

class Adaptive final : public Integrator::Method {
 public:
  Adaptive(System& system, const Settings& settings)
      : Method(system, settings),
        relative_(std::max(kShareOfStep * settings.tolerance.relative, kFinest)),
        beyond_(settings.tolerance.relative >= kCoarse ? kBeyond : 0),
        stages_(system, kFehlberg),
        midpoint_(system, settings.tolerance),
        q_(system.positions()),
        v_(system.velocities()),
        d4_(v_),
        dv4_(v_),
        d5_(v_),
        dv5_(v_) {}

  void step(Instant& at, double h) override {
    if (at.slack > 1) {
      const bool moved = midpoint_.step(at, h);
      count.evaluations += midpoint_.evaluations();
      if (moved) return;
    }
    const double end = at.t + h;
    double t = at.t;
    q_ = at.q;
    v_ = at.v;
    // The stored step size may come from a step that an event cut to a sliver.
    double next = at.step > 0 ? std::max(at.step, settings_.tolerance.smallest_step) : h;
    bool rejected = false;
    for (at.attempts = 0; t < end; ++at.attempts) {
      const double left = end - t;
      if (at.spent + at.attempts >= settings_.most_attempts || system_.over()) refuse_cost(at, t, next);
      // Two like steps at the end, rather than a whole one and a sliver.
      const double size = next >= left * (1 - 1e-12) ? left : std::min(next, std::max(0.5 * left, 0.5 * next));
      if (size < std::min(settings_.tolerance.smallest_step, h) || t + size == t) {
        if (!leap(at, h)) refuse(at, t, size);
        next = h;
        break;
      }
      const double error = attempt(t, size) / at.slack;
      double growth = error > 0 ? kSafety * std::pow(error, -1 / kOrder) : kMostGrowth;
      growth = std::clamp(growth, kMostShrinking, rejected ? 1.0 : kMostGrowth);
      rejected = !(error <= 1);
      if (rejected) {
        ++count.rejected;
        next = size * std::min(growth, kSafety);
        continue;
      }
      // A step that was cut short to meet the end says little about the size that would do.
      next = size < next ? std::max(next, size * growth) : size * growth;
      system_.move(q_, d5_, q_);
      v_ += dv5_;
      t = size == left ? end : t + size;
    }
    if (at.mean.size() == v_.size()) at.mean = (v_ - at.v) / h;
    at.t = end;
    at.q = q_;
    at.v = v_;
    at.step = next;
  }

 private:
  /// One step of `h`; its error in units of what is allowed. Infinite where the system has no acceleration.
  double attempt(double t, double h) {
    try {
      stages_.run(t, q_, v_, h,
                  [this](double s, const Vector& q, const Vector& v, Vector& a) { evaluate(s, q, v, 0, a); });
    } catch (const Error& error) {
      if (error.code() != ErrorCode::Numeric) throw;
      return std::numeric_limits<double>::infinity();
    }
    stages_.sum(kFehlbergWeights4, h, d4_, dv4_);
    stages_.sum(kFehlbergWeights5, h, d5_, dv5_);
    double worst = 0;
    for (int i = 0; i < static_cast<int>(v_.size()); ++i) {
      const double ratio = ratio_of(i);
      if (!std::isfinite(ratio)) return std::numeric_limits<double>::infinity();
      worst = std::max(worst, ratio);
    }
    if (beyond_ > 0) {
      d5_ += beyond_ * (d5_ - d4_);
      dv5_ += beyond_ * (dv5_ - dv4_);
    }
    return worst;
  }

  /// The whole step in as few equal parts as err little enough.
  /// @return  whether there is such a number
  bool leap(const Instant& at, double h) {
    for (const double most : {1 / kShareOfStep, kMostLeap / kShareOfStep})
      for (const int parts : {1, 2, 3, 5, 8, 13}) {
        q_ = at.q;
        v_ = at.v;
        const double size = h / parts;
        int done = 0;
        while (done < parts && attempt(at.t + done * size, size) / at.slack <= most) {
          system_.move(q_, d5_, q_);
          v_ += dv5_;
          ++done;
        }
        ++count.rejected;
        if (done == parts) return true;
      }
    return false;
  }

  double ratio_of(int i) const {
    const Tolerance& allowed = settings_.tolerance;
    double way = allowed.length, speed = allowed.velocity;
    if (system_.kind(i) == Kind::Angle) way = allowed.angle, speed = allowed.angular_velocity;
    if (system_.kind(i) == Kind::Ledger) way *= allowed.length, speed *= allowed.length;  // of energy per kg
    speed += std::max(std::abs(v_[i]), std::abs(v_[i] + dv5_[i]));
    return std::max(std::abs(d5_[i] - d4_[i]) / (relative_ * way), std::abs(dv5_[i] - dv4_[i]) / (relative_ * speed));
  }

  [[noreturn]] void refuse(Instant& at, double t, double size) const {
    at.step = size;
    throw Error(
        ErrorCode::Numeric,
        fmt::format("at {} s the step size fell to {} s without reaching the tolerance {}: the forces jump or the "
                    "tolerance is too fine for double precision",
                    t, size, settings_.tolerance.relative));
  }

  [[noreturn]] void refuse_cost(Instant& at, double t, double size) const {
    at.step = size;
    const std::string what =
        fmt::format("at {} s the step size is {} s after {} attempts: the motion is too fast for the tolerance {}", t,
                    size, at.spent + at.attempts, settings_.tolerance.relative);
    if (system_.over()) throw Error(ErrorCode::Numeric, what);
    throw TooFast(ErrorCode::Numeric, what);
  }

  const double relative_;  // error allowed in one step, per unit
  const double beyond_;
  Stages stages_;
  Midpoint midpoint_;
  Vector q_, v_, d4_, dv4_, d5_, dv5_;
};

void check(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value))
    throw Error(ErrorCode::Argument, fmt::format("{} of step control is {} (must be finite and > 0)", what, value));
}

}  // namespace

std::unique_ptr<Integrator::Method> make_adaptive(System& system, const Settings& settings) {
  const Tolerance& tolerance = settings.tolerance;
  check(tolerance.relative, "the tolerance");
  check(tolerance.angle, "the unit of angles");
  check(tolerance.length, "the unit of lengths");
  check(tolerance.angular_velocity, "the unit of angular velocities");
  check(tolerance.velocity, "the unit of velocities");
  check(tolerance.smallest_step, "the smallest step");
  return std::make_unique<Adaptive>(system, settings);
}

}  // namespace breve::articulated
