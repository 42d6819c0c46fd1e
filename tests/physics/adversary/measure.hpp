// Energy and momentum of a creature from its poses and velocities, by the searcher's own masses, inertias and springs.
#pragma once

#include <limits>

#include "creature.hpp"

namespace adversary {

struct State {
  double kinetic = 0, potential = 0, springs = 0;  // J
  Vector3 momentum = Vector3::Zero();              // N s
  Vector3 spin = Vector3::Zero();                  // angular momentum about the centre of mass, N m s
  Vector3 center = Vector3::Zero();                // of mass, m
  double mass = 0;                                 // kg
  int links = 0;
  double roundness = 0;  // kg m2: bound of the moment of inertia about the centre of mass
  double size = 0;       // m: farthest body from the centre of mass
  double told = 0;       // rad or m: how far the positions that joints tell are from the poses
  double terms = 0;      // J, sum of the magnitudes of all terms of total()

  double total() const { return kinetic + potential + springs; }
  /// J, by which total() may be wrong: the place of each link has the round-off of all links before it in the chain.
  double round_off() const { return std::numeric_limits<double>::epsilon() * links * terms; }
  bool finite() const;
};

State measure(Creature& creature);

/// Positions of a joint, from poses alone but for full rotations, which are as the joint reports them.
struct Positions {
  Vector3 q = Vector3::Zero();
  double told = 0;    // the greatest difference to what the joint tells
  double square = 0;  // squared deflection from where the spring in it is slack
};
Positions positions_of(Creature& creature, const Joint& joint);

}  // namespace adversary
