// Where a tree of bodies is and how it moves, in joint coordinates; and steps on that curved space.
#pragma once

#include "runtime/articulated/model.hpp"
#include "runtime/articulated/vector.hpp"

namespace breve::articulated {

struct State {
  Vector q;  // (nq): rad, m, unit quaternions (w,x,y,z); see JointType
  Vector v;  // (nv): rad/s, m/s
};

/// All joints at zero, at rest.
State neutral_state(const Model& model);

/// q moved along the tangent `d` (nv): angles and ways add, quaternions become q * exp(d) and have unit length again.
/// A free joint's position moves by the first three of its numbers. `out` may be q. No allocation.
void move(const Model& model, const Vector& q, const Vector& d, Vector& out);

/// The tangent d (nv) with move(from, d) = to; rotations by the shorter way. No allocation.
void difference(const Model& model, const Vector& from, const Vector& to, Vector& d);

/// The rate of d in q(t) = move(q0, d(t)), where the velocity is v: v but for rotations. No allocation.
void rate_of_move(const Model& model, const Vector& d, const Vector& v, Vector& out);

/// Replaces the rotation vectors in the tangent `d` by those of Cayley's map; with it the implicit midpoint rule keeps
/// the angular momentum of a free body in the world, and not only its size. No allocation.
void bend_to_cayley(const Model& model, Vector& d);

}  // namespace breve::articulated
