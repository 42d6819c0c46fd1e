// The classic scheme and Fehlberg's pair at fixed steps.
#include "runtime/articulated/runge_kutta.hpp"

#include <cmath>

#include "runtime/base/error.hpp"

namespace breve::articulated {

const Tableau kClassic = {4, {0, 0.5, 0.5, 1}, {{{}, {0.5}, {0, 0.5}, {0, 0, 1}}}};
const Weights kClassicWeights = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};

// Source: Fehlberg 1969, table III.
const Tableau kFehlberg = {6,
                           {0, 1.0 / 4, 3.0 / 8, 12.0 / 13, 1, 1.0 / 2},
                           {{{},
                             {1.0 / 4},
                             {3.0 / 32, 9.0 / 32},
                             {1932.0 / 2197, -7200.0 / 2197, 7296.0 / 2197},
                             {439.0 / 216, -8, 3680.0 / 513, -845.0 / 4104},
                             {-8.0 / 27, 2, -3544.0 / 2565, 1859.0 / 4104, -11.0 / 40}}}};
const Weights kFehlbergWeights4 = {25.0 / 216, 0, 1408.0 / 2565, 2197.0 / 4104, -1.0 / 5, 0};
const Weights kFehlbergWeights5 = {16.0 / 135, 0, 6656.0 / 12825, 28561.0 / 56430, -9.0 / 50, 2.0 / 55};

Stages::Stages(System& system, const Tableau& tableau)
    : system_(system),
      tableau_(tableau),
      rates_d_(static_cast<std::size_t>(tableau.stages), Vector::Zero(system.velocities())),
      rates_v_(rates_d_),
      q_(system.positions()),
      v_(system.velocities()),
      d_(system.velocities()) {}

void Stages::sum(const double* weights, int count, double h, Vector& d, Vector& dv) const {
  d.setZero();
  dv.setZero();
  for (int i = 0; i < count; ++i) {
    if (weights[i] == 0) continue;
    d += (h * weights[i]) * rates_d_[static_cast<std::size_t>(i)];
    dv += (h * weights[i]) * rates_v_[static_cast<std::size_t>(i)];
  }
}

namespace {

class RungeKutta final : public Integrator::Method {
 public:
  RungeKutta(System& system, const Settings& settings, const Tableau& tableau, const Weights& weights)
      : Method(system, settings),
        stages_(system, tableau),
        weights_(weights),
        d_(system.velocities()),
        dv_(system.velocities()) {}

  void step(Instant& at, double h) override {
    stages_.run(at.t, at.q, at.v, h,
                [this](double t, const Vector& q, const Vector& v, Vector& a) { evaluate(t, q, v, 0, a); });
    stages_.sum(weights_, h, d_, dv_);
    system_.move(at.q, d_, at.q);
    at.v += dv_;
    at.t += h;
  }

 private:
  Stages stages_;
  const Weights& weights_;
  Vector d_, dv_;
};

/// The classic scheme as long as it is good (Settings::refine).
class Guarded final : public Integrator::Method {
 public:
  Guarded(System& system, const Settings& settings)
      : Method(system, settings),
        stages_(system, kClassic),
        d_(system.velocities()),
        dv_(system.velocities()),
        fine_(make_adaptive(system, settings)) {}

  void step(Instant& at, double h) override {
    if (good(at, h)) {
      stages_.sum(kClassicWeights, h, d_, dv_);
      system_.move(at.q, d_, at.q);
      at.v += dv_;
      at.t += h;
      return;
    }
    fine_->count = {};
    fine_->step(at, h);
    count.evaluations += fine_->count.evaluations;
    count.rejected += 1 + fine_->count.rejected;
  }

 private:
  bool good(const Instant& at, double h) {
    bool first = true, smooth = true;
    std::uint64_t piece = 0;
    try {
      stages_.run(at.t, at.q, at.v, h, [&](double t, const Vector& q, const Vector& v, Vector& a) {
        evaluate(t, q, v, 0, a);
        if (first) piece = system_.piece();
        first = false;
        smooth = smooth && system_.piece() == piece;
      });
    } catch (const Error& error) {
      if (error.code() != ErrorCode::Numeric) throw;
      return false;
    }
    if (!smooth) return false;
    const Tolerance& allowed = settings_.tolerance;
    const Vector &second = stages_.acceleration(1), &third = stages_.acceleration(2);
    for (int i = 0; i < static_cast<int>(second.size()); ++i) {
      const double unit = system_.kind(i) == Kind::Angle ? allowed.angular_velocity : allowed.velocity;
      const double differs = h / 3 * std::abs(third[i] - second[i]);
      if (!(differs <= allowed.relative * (unit + std::abs(at.v[i])))) return false;
    }
    return true;
  }

  Stages stages_;
  Vector d_, dv_;
  std::unique_ptr<Integrator::Method> fine_;
};

}  // namespace

std::unique_ptr<Integrator::Method> make_guarded(System& system, const Settings& settings) {
  return std::make_unique<Guarded>(system, settings);
}

std::unique_ptr<Integrator::Method> make_runge_kutta(System& system, Scheme scheme, const Settings& settings) {
  if (scheme == Scheme::RungeKutta4) return std::make_unique<RungeKutta>(system, settings, kClassic, kClassicWeights);
  const Weights& weights = scheme == Scheme::Fehlberg4 ? kFehlbergWeights4 : kFehlbergWeights5;
  return std::make_unique<RungeKutta>(system, settings, kFehlberg, weights);
}

}  // namespace breve::articulated
