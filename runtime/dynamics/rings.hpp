// A joint that closes a ring, as relations between the motions of its two bodies: what a joint of a tree gives for
// nothing. Positions are kept closed by a projection after each sub-step.
#pragma once

#include <array>

#include "runtime/dynamics/tree.hpp"

namespace breve {

struct RingRow {
  Vector3 axis = Vector3::Zero();  // unit, world: along it the child may not move relative to the parent
  bool angular = false;
  Vector3 on_child = Vector3::Zero(), on_parent = Vector3::Zero();  // world, m; of a linear row
  double error = 0;                                                 // how far it is open along the axis, m or rad
};

struct RingRows {
  int child = -1, parent = -1;  // links of the tree; -1: what does not move by itself
  int count = 0;
  std::array<RingRow, kMostRingRows> rows;
  bool universal = false;
  Vector3 first = Vector3::Zero(), second = Vector3::Zero();  // of a universal joint: its axes, which stay square

  void add(const RingRow& row) { rows[static_cast<std::size_t>(count++)] = row; }
};

}  // namespace breve
