// A joint that closes a loop, as relations between the motions of its two bodies: what a joint of a tree gives for
// nothing. Positions are kept closed by a projection after each sub-step.
#pragma once

#include <array>

#include "runtime/dynamics/tree.hpp"

namespace breve {

struct LoopRow {
  Vector3 axis = Vector3::Zero();  // unit, world: along it the child may not move relative to the parent
  bool angular = false;
  Vector3 on_child = Vector3::Zero(), on_parent = Vector3::Zero();  // world, m; of a linear row
  double error = 0;                                                 // how far it is open along the axis, m or rad
};

struct LoopRows {
  int child = -1, parent = -1;  // links of the tree; -1: what does not move by itself
  int count = 0;
  std::array<LoopRow, kMostLoopRows> rows;
  bool universal = false;
  Vector3 first = Vector3::Zero(), second = Vector3::Zero();  // of a universal joint: its axes, which stay square

  void add(const LoopRow& row) { rows[static_cast<std::size_t>(count++)] = row; }
};

}  // namespace breve
