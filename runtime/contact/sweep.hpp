// Block projected Gauss-Seidel: each contact in turn takes the exact impulse of its cone, given all others.
#pragma once

#include <cstddef>

#include "runtime/contact/workspace.hpp"

namespace breve::contact {

/// Push every row by the impulse it starts with.
void push_all(Workspace& work);

/// A series of sweeps: scalar rows, then contacts, each in the order given, then in the opposite one, and so on by
/// turns. So a load goes up a stack as fast as down, and no side is always the last. With momentum the impulses go on
/// between sweeps as they did before: high stacks take a fraction of the sweeps then. While it lives, impulses of
/// contacts are not to be read; they are in their cones after it.
/// Source: Silcowitz, Niebe and Erleben 2010 (nonsmooth nonlinear conjugate gradients: the share of the way is the
/// ratio of what the last two sweeps changed, and they begin anew where that is above 1). Here it is 1 up to 1.2: a
/// high stack needs that.
class Sweeps {
 public:
  Sweeps(Workspace& work, bool momentum);
  ~Sweeps();
  Sweeps(const Sweeps&) = delete;
  Sweeps& operator=(const Sweeps&) = delete;

  /// One more. @return the largest change of velocity that a row made at itself, m/s
  double next();
  /// Impulses grow without end, as they may where friction turns what it holds against itself (Painleve).
  bool diverge() const;

 private:
  enum class Kind { Any, Plain, Normals };
  static Kind kind_of(const Workspace& work);

  double share() const;
  void go_on(double share);
  Moved sweep(bool backward);

  Workspace& work_;
  const Kind kind_;
  const bool momentum_;
  int count_ = 0;
  double energy_first_ = 0, energy_before_ = 0, energy_ = 0;  // J, of the changes of the first and the last two
};

/// One contact of a sweep. @return the largest change of its velocity, m/s
double visit_point(Workspace& work, std::size_t point);

/// The gain is what the impulses do to the kinetic energy, less what the biases demand, J: with p the impulses, u the
/// velocities, half of p.(u without + u with) - p.bias + softness p^2 / 2. It is not positive for any exact solution.
/// If it is positive, shorten all impulses by the one factor that makes it least; cones and bounds contain what is
/// shorter. So even a solve that was stopped early adds no energy.
void hold_energy(Workspace& work);

}  // namespace breve::contact
