// What the guard looks for in an island: numbers that are not finite, unexplained energy, and bodies that rotate or are
// damped too fast for their sub-steps.
#pragma once

#include "runtime/dynamics/island_state.hpp"

namespace breve::island {

class Watch {
 public:
  explicit Watch(State& state) : state_(state) {}

  BodyIndex not_finite() const;  // the first that shows it
  /// @param residual  J, that a step left unexplained
  /// @param turnover  J, of which it may be a small part
  /// @param sums      J, of which the residual has the round-off: stored as the step began, and pressed by rows
  Trouble judge(double residual, double turnover, double sums) const;
  /// The energy that a step of h seconds may leave unexplained, J.
  double tolerated(double turnover, double h) const;
  Trouble foresee(double h);
  void shorten_sub_steps(double h);

 private:
  Trouble fastest_rotation(double h) const;
  double driven_swing(double h) const;
  bool find_fast_springs(double h);
  bool has_rows(const Clustered& one) const;
  Trouble strongest_damper(double h) const;

  State& state_;
};

}  // namespace breve::island
