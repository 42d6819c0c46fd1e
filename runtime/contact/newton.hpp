// Newton's method of the direct solver on Coulomb's law around one centre; direct.cpp moves the centre.
#pragma once

#include "runtime/contact/direct.hpp"
#include "runtime/contact/equations.hpp"

namespace breve::contact {

class Newton {
 public:
  static std::size_t numbers(std::size_t rows) { return 7 * rows; }

  /// @param room  for numbers(rows)
  Newton(Workspace& work, Equations& equations, double* room);
  void begin();  // the first centre are the impulses of the island

  /// Steps for v = v* + R q, q = p(J v).
  /// @return whether q and p agree within a tenth of `tolerance`, or as near as round-off allows
  bool settle(double stiffness, double tolerance, LinearSolves& solves);

  /// The impulses p become those of the island, and the next centre. @return the violation, m/s
  double take();

  // A set of impulses to come back to.
  void keep() { equations_.get_impulses(kept_); }
  void restore();

 private:
  void project_all(double length);  // p_ at the row velocities u_ - length du_
  double misfit(double length) const;
  bool find_step();
  double search(double here);

  Workspace& work_;
  Equations& equations_;
  std::size_t rows_;
  double stiffness_ = 1;
  // For the rows: the centre; p(J v); impulses kept; q with v = v* + R q; its step; J v, and that of the step.
  double *centre_, *p_, *kept_, *q_, *dq_, *u_, *du_;
};

}  // namespace breve::contact
