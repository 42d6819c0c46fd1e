// How velocities at contacts, limits and loops depend on the velocity of a tree: one row of the Jacobian at a time.
#pragma once

#include "runtime/dynamics/core.hpp"

namespace breve {

/// Adds to `j` (nv) how the velocity of a link's point along `axis` (or its spin about it) depends on v; the tree's
/// links are placed.
void add_point_row(const Tree& tree, int link, const Vector3& point, const Vector3& axis, bool angular, double sign,
                   double* j);
/// Writes the same of a loop's row, and nothing else, into `j`. Zero where the tree itself keeps what the row holds (a
/// plane loop its plane): round-off there, taken for a direction to push in, would push without bound.
void fill_loop_row(const Tree& tree, const LoopRows& loop, const LoopRow& row, double* j);
/// Likewise of a joint's limit: how its gap grows.
void fill_limit_row(const Tree& tree, const JointEntry& joint, int axis, double sign, double* j);

}  // namespace breve
