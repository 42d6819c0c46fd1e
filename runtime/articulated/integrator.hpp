// Steps in time. One interface for all schemes and for any second-order system.
#pragma once

#include <memory>
#include <vector>

#include "runtime/articulated/system.hpp"
#include "runtime/base/error.hpp"

namespace breve::articulated {

enum class Scheme {
  ExplicitEuler,      // order 1
  SemiImplicitEuler,  // order 1: velocity first, positions with the new one
  ImplicitEuler,      // order 1, damps; solved by Newton's method
  VelocityVerlet,     // order 2: half kick, drift, half kick
  ImplicitMidpoint,   // order 2, keeps quadratic invariants; solved by Newton's method
  RungeKutta4,        // order 4
  Fehlberg4,          // order 4: the lower member of Fehlberg's pair, fixed step
  Fehlberg5,          // order 5: the higher member, fixed step
  FehlbergAdaptive,   // order 5, with the difference of the two as error estimate and steps to keep it small
};

/// The tolerances of the schemes with step control.
/// How far a run of FehlbergAdaptive over some seconds may be wrong (a single step may by a thousandth of it, and not
/// less than round-off). Positions by the kind of coordinate, velocities by kind and size.
struct Tolerance {
  double relative = 1e-8;        // error allowed per unit, and part of the velocity
  double angle = 1;              // rad, what counts as one unit
  double length = 1;             // m
  double angular_velocity = 1;   // rad/s
  double velocity = 1;           // m/s
  double smallest_step = 1e-12;  // s; a step that would have to be smaller is an error
};

struct Settings {
  Tolerance tolerance;
  int most_attempts = 100'000;  // of step control; more are an error: TooFast
  /// Euler's two explicit schemes treat stiff internal forces (joint springs, dampers, motors) as linearly implicit,
  /// which keeps them stable at any stiffness. Off: the textbook's schemes.
  bool implicit_joints = false;
  /// RungeKutta4 leaves a step to FehlbergAdaptive where its two middle stages, which stand at the same time, disagree:
  /// where h / 3 times the difference of their accelerations (what a scheme of order 3 of the same stages would change)
  /// is more than the tolerance of the velocity; and where its stages lie on different pieces of the forces.
  /// ImplicitMidpoint is composed of five steps to order 4. Off: the textbook's schemes.
  bool refine = false;
};

/// Step control gave up, since the motion needs more attempts than it may make. The state is as it was.
struct TooFast : Error {
  using Error::Error;
};

/// What the last step took.
struct StepCount {
  int evaluations = 0;  // of the acceleration
  int rejected = 0;     // steps that were tried again with a smaller size
};

class Integrator {
 public:
  /// `system` outlives the integrator. All memory is taken here; a step allocates nothing.
  Integrator(System& system, Scheme scheme, const Settings& settings = {});
  ~Integrator();
  Integrator(Integrator&&) noexcept;

  /// One step of `h` seconds; FehlbergAdaptive takes as many as it needs to get exactly there, and keeps the size that
  /// it would use next in `at.step`.
  /// @throws Error{Argument} if h is not a finite number > 0 or a size is not the system's; Error{Numeric} if the
  /// system
  ///         has no acceleration somewhere, an implicit equation has no solution that Newton's method finds, steps
  ///         become smaller than allowed, or too many of them are needed. `at` is then unchanged but for `step`.
  void step(Instant& at, double h);

  const StepCount& count() const;  // of the last step()

  class Method;  // one scheme

 private:
  System& system_;
  std::unique_ptr<Method> method_;
};

}  // namespace breve::articulated
