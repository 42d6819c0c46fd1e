// Random passive creatures on a plane.
#pragma once

#include "world.hpp"

namespace breve::reference {

struct Habits {
  bool limits = false;   // joints rotate by less than 0.6 rad to either side
  double rebound = 0;    // of those limits
  double threshold = 0;  // m/s, of restitution
};

/// Dropped on a plane, with the guard on `report`: energy may never be above that at the start by 1 %, which is
/// expected. Prints what was; returns the interventions.
std::uint64_t drop_creatures(breve_rung rung, int count, double seconds, const Habits& habits = {});

/// The same, until most lie on the plane. Prints and returns what one second more is like.
struct Lying {
  std::uint64_t impacts = 0;
  double lost = 0;  // J
};
Lying drop_and_lie(breve_rung rung, int count, double seconds);

}  // namespace breve::reference
