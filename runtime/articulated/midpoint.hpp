// The implicit midpoint rule by repetition, for steps that are short beside what moves.
#pragma once

#include "runtime/articulated/integrator.hpp"

namespace breve::articulated {

/// Finds the mean velocity u of a step, u = v + h/2 a(q moved by h/2 u, u, t + h/2), by putting each guess into the
/// right side, and takes from the last two what seems to be left of the error. The rule has order 2 and neither gains
/// nor loses energy in the long run, which makes a step of some three evaluations as good for walkers as one of six.
/// Source: Anderson 1965 (repetition with a memory of one).
class Midpoint {
 public:
  Midpoint(System& system, const Tolerance& tolerance);

  /// One step of h seconds. False, and `at` as it was, if repeating does not bring u to within a part of the tolerance
  /// soon, if something rotates too far in the step, or if the system has no acceleration somewhere.
  bool step(Instant& at, double h);
  int evaluations() const { return evaluations_; }  // in the last step()

 private:
  bool find_mean(const Instant& at, double h);
  double largest_change();
  void correct_second(const Instant& at, double h);

  System& system_;
  const Tolerance tolerance_;
  int evaluations_ = 0;
  Vector q_, a_, d_;
  Vector u_, change_;                 // the guess, and how the rule changes it
  Vector result_;                     // the guess with the change
  Vector last_change_, last_result_;  // of the guess before
};

}  // namespace breve::articulated
