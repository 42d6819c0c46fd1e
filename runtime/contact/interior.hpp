// The interior-point method of the direct solver: it comes near the solution from anywhere, in some twenty steps.
#pragma once

#include "runtime/contact/direct.hpp"
#include "runtime/contact/equations.hpp"

namespace breve::contact {

/// Each row has a pair of numbers or vectors whose product is to be zero: x, what it pushes with, and y, the velocity
/// left to it, both in the interior of their cones. All products are made smaller together. Coulomb's law is that of a
/// pair of second-order cones once mu |u_t| is added to the normal velocity (de Saxce and Feng 1998); this part is
/// followed by tangents. Rows that are redundant or about to change their state do no harm.
/// Source: Nesterov and Todd 1997 (the scaling); Acary, Armand, Nguyen and Shpakovych 2023 (friction).
class Interior {
 public:
  static std::size_t numbers(std::size_t rows) { return 9 * rows; }

  /// @param room  for numbers(rows)
  Interior(Workspace& work, Equations& equations, double* room);
  /// Goes on from where it stands until the violation is within the goal or nothing helps any more.
  /// @return the violation, m/s, of the impulses and velocities that the island then has
  double solve(double goal, LinearSolves& solves);
  double speed() const { return speed_; }  // m/s, what the rows have to stop

 private:
  /// How far along the step both stay in their cones.
  struct Lengths {
    double x = 1e9, y = 1e9;
  };
  void begin();
  void read();
  double gap() const;
  void prepare_point(std::size_t i, double target);
  void prepare_cone(std::size_t i, double target, double error);
  void prepare_scalar(std::size_t i, double target);
  void finish_point(std::size_t i, Lengths& lengths);
  void finish_scalar(std::size_t i, double target, Lengths& lengths);
  bool step(double target, Lengths& lengths);

  Workspace& work_;
  Equations& equations_;
  std::size_t rows_, scalars_;  // numbers; where those of scalar rows begin
  double pairs_ = 0;            // products that there are
  double speed_ = 0;
  double last_ = 0.9;  // length of the last step; the first takes off a tenth
  int steps_ = 0;
  // For the rows: x; y (of a scalar row that of its lower bound); z (of a scalar row's upper bound); steps of these;
  // the impulses, and their steps as far as they are known before the velocities; velocities at the rows.
  double *x_, *y_, *z_, *dx_, *dy_, *dz_, *q_, *r_, *u_;
};

}  // namespace breve::contact
