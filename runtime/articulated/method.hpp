// The inside of an integrator: one class a scheme, with the vectors that it works in.
#pragma once

#include "runtime/articulated/integrator.hpp"

namespace breve::articulated {

class Integrator::Method {
 public:
  Method(System& system, const Settings& settings) : settings_(settings), system_(system) {}
  virtual ~Method() = default;

  /// Moves `at` by h; leaves it as it was if it throws.
  virtual void step(Instant& at, double h) = 0;

  StepCount count;

 protected:
  void evaluate(double t, const Vector& q, const Vector& v, double step, Vector& a) {
    ++count.evaluations;
    system_.acceleration(t, q, v, step, a);
  }

  const Settings settings_;
  System& system_;
};

// KEEP IN STEP: Scheme.
std::unique_ptr<Integrator::Method> make_runge_kutta(System& system, Scheme scheme, const Settings& settings);
std::unique_ptr<Integrator::Method> make_adaptive(System& system, const Settings& settings);
std::unique_ptr<Integrator::Method> make_guarded(System& system, const Settings& settings);
std::unique_ptr<Integrator::Method> make_implicit(System& system, Scheme scheme, const Settings& settings);

}  // namespace breve::articulated
