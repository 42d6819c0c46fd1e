// Choice of the scheme, and the short ones: Euler's and Verlet's.
#include "runtime/articulated/integrator.hpp"

#include <fmt/format.h>

#include <cmath>

#include "runtime/articulated/method.hpp"
#include "runtime/base/error.hpp"

namespace breve::articulated {

namespace {

using Method = Integrator::Method;

/// Both of Euler's schemes that need no equation solved; they differ in the velocity that moves the positions.
class Euler final : public Method {
 public:
  Euler(System& system, const Settings& settings, bool new_velocity)
      : Method(system, settings), new_velocity_(new_velocity), a_(system.velocities()), d_(system.velocities()) {}

  void step(Instant& at, double h) override {
    evaluate(at.t, at.q, at.v, settings_.implicit_joints ? h : 0, a_);
    if (new_velocity_) at.v += h * a_;
    d_ = h * at.v;
    system_.move(at.q, d_, at.q);
    if (!new_velocity_) at.v += h * a_;
    at.t += h;
  }

 private:
  const bool new_velocity_;
  Vector a_, d_;
};

/// Half kick, drift, half kick. The second kick needs the velocity that it makes; the explicit guess v0 + h a0 for it
/// errs by h^2 and keeps the order, where the half-way velocity would not.
class Verlet final : public Method {
 public:
  Verlet(System& system, const Settings& settings)
      : Method(system, settings),
        a_(system.velocities()),
        half_(system.velocities()),
        d_(system.velocities()),
        q_(system.positions()) {}

  void step(Instant& at, double h) override {
    evaluate(at.t, at.q, at.v, 0, a_);
    half_ = at.v + (0.5 * h) * a_;
    d_ = h * half_;
    system_.move(at.q, d_, q_);
    d_ = at.v + h * a_;
    evaluate(at.t + h, q_, d_, 0, a_);
    at.v = half_ + (0.5 * h) * a_;
    at.q = q_;
    at.t += h;
  }

 private:
  Vector a_, half_, d_, q_;
};

std::unique_ptr<Method> make(System& system, Scheme scheme, const Settings& settings) {
  switch (scheme) {
    case Scheme::ExplicitEuler: return std::make_unique<Euler>(system, settings, false);
    case Scheme::SemiImplicitEuler: return std::make_unique<Euler>(system, settings, true);
    case Scheme::VelocityVerlet: return std::make_unique<Verlet>(system, settings);
    case Scheme::ImplicitEuler:
    case Scheme::ImplicitMidpoint: return make_implicit(system, scheme, settings);
    case Scheme::RungeKutta4:
      if (settings.refine) return make_guarded(system, settings);
      [[fallthrough]];
    case Scheme::Fehlberg4:
    case Scheme::Fehlberg5: return make_runge_kutta(system, scheme, settings);
    case Scheme::FehlbergAdaptive: return make_adaptive(system, settings);
  }
  throw Error(ErrorCode::Argument, fmt::format("there is no integrator with number {}", static_cast<int>(scheme)));
}

}  // namespace

Integrator::Integrator(System& system, Scheme scheme, const Settings& settings)
    : system_(system), method_(make(system, scheme, settings)) {}
Integrator::~Integrator() = default;
Integrator::Integrator(Integrator&&) noexcept = default;

void Integrator::step(Instant& at, double h) {
  if (!(h > 0) || !std::isfinite(h))
    throw Error(ErrorCode::Argument, fmt::format("an integration step is {} s (must be finite and > 0)", h));
  if (at.q.size() != system_.positions() || at.v.size() != system_.velocities())
    throw Error(ErrorCode::Argument, fmt::format("the state has {} positions and {} velocities, the system {} and {}",
                                                 at.q.size(), at.v.size(), system_.positions(), system_.velocities()));
  method_->count = {};
  method_->step(at, h);
}

const StepCount& Integrator::count() const { return method_->count; }

}  // namespace breve::articulated
