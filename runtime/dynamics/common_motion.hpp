// What trees that nothing outside holds have in common: the motion of one rigid body with their mass and momenta.
#pragma once

#include <span>

#include "runtime/articulated/whole.hpp"
#include "runtime/dynamics/tree.hpp"

namespace breve {

/// Mass, centre and momenta of trees together, which are placed for it.
articulated::Whole measure(std::span<Tree* const> trees);

/// Moves trees together, which stand where their data say and are `now`, to what is wanted.
void impose(std::span<Tree* const> trees, const articulated::Whole& now, const articulated::Whole& wanted);

/// That motion; zero for trees that something may hold.
struct Common {
  Vector3 center = Vector3::Zero(), velocity = Vector3::Zero(), spin = Vector3::Zero();
  double energy = 0;  // J, of that motion
  double inner = 0;   // J, of the links among one another
};

/// @param held  something outside may hold them
Common common_of(std::span<Tree* const> trees, bool held = false);

/// The same with the momenta that the trees had when the step began, and what gravity gave them since.
/// @param fall  m/s, by gravity
Common started_with(std::span<Tree* const> trees, const Vector3& fall);

/// Rotates trees whose links stand still among one another as one rigid body for h seconds, with the momenta that they
/// have, by the midpoint rule: with the spin that the same angular momentum gives half-way.
void rotate_freely(std::span<Tree* const> trees, const articulated::Whole& kept, double h);

/// Velocities of the links among one another times `scale`; trees stand where their data say.
void shorten_inner(std::span<Tree* const> trees, const Common& common, double scale);

}  // namespace breve
