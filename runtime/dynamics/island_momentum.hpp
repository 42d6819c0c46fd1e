// Momentum of trees that nothing outside holds. Joint coordinates do not know of it: an integrator keeps it to its own
// order, and impulses between links, applied where the links stood a moment ago, do not quite cancel. So after each
// piece of motion the tree is moved, as one rigid body, to the centre of mass and the momenta that outer impulses and
// gravity give it.
#pragma once

#include <cstdint>

#include "runtime/dynamics/common_motion.hpp"
#include "runtime/dynamics/island_rows.hpp"

namespace breve::island {

/// Whether a tree that nothing outside touches keeps its momenta when it is stopped.
enum class Momenta : bool { Take, Keep };

/// What moving positions gives, J.
struct Given {
  double all = 0;
  double springs = 0;  // of that, to springs of trees and between trees
};

/// Whose motion pays for what was given: that of trees with closed loops, of all trees, or also of the bodies without
/// joints in their island.
enum class Payers : std::uint8_t { Looped, Trees, All };

class Momentum {
 public:
  Momentum(State& state, Rows& rows);

  void begin_try() { touched_ = false; }
  void note_touched() { touched_ = touched_from_outside(); }
  bool touched_from_outside() const;

  /// Each tree as it moves with one of the velocities that are kept for it.
  /// @param now  that of its state
  void note(articulated::Vector Tree::*velocity, bool now);
  // After note(), trees get what outer impulses give them:
  void give_impulses(double moved_h);  // those of rows that were not predicted, which moved positions for moved_h
  void give_impacts();                 // those of impacts
  void give_positions(double moved_h, std::span<const std::uint8_t> movers);  // to some movers, and no velocity
  void give_pushes(double moved_h, std::span<const contact::Push> pushes);    // those that push overlap apart, likewise
  bool pushes_itself() const;

  double moving(Payers payers) const;
  void take_from_all(double part, Payers payers);
  void undo_gain(double part, bool told, Payers payers);
  Common common_of_free_bodies() const;
  void slow_free_bodies(const Common& common, double taken);
  double stop(Clustered& one, Momenta momenta, double h);
  void coast(double h);

 private:
  /// Impulse on a tree from outside, and about its centre of mass.
  struct Outer {
    Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
  };
  enum class Velocities : bool { Stay, Change };
  static bool pays(const Clustered& one, Payers payers);
  double shorten(const Clustered& one, double part, bool held);
  Common paying_free_bodies(Payers payers) const;
  template <class Impulse>
  void sum_outer(const Impulse& impulse_of);
  void give(std::size_t tree, double moved_h, Velocities velocities);

  State& state_;
  Rows& rows_;
  std::pmr::vector<Outer> outer_;  // of trees
  bool touched_ = false;           // something outside was, in a sub-step of this try
};

}  // namespace breve::island
