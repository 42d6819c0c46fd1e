// A tree of bodies, or several, seen as one body: what forces between its links cannot change.
#pragma once

#include "runtime/articulated/data.hpp"

namespace breve::articulated {

/// Mass, centre of mass, momentum, and angular momentum and inertia about the centre of mass; world axes.
struct Whole {
  double mass = 0;                     // kg
  Vector3 center = Vector3::Zero();    // m
  Vector3 momentum = Vector3::Zero();  // kg*m/s
  Vector3 spin = Vector3::Zero();      // kg*m^2/s
  Symmetric3 inertia;                  // kg*m^2

  /// Both together.
  void add(const Whole& other);
};

/// After forward_kinematics on `data`. Cost O(links). No allocation.
Whole measure_whole(const Model& model, const Data& data);

/// Moves a tree with a free root as one rigid body: by `way`, and changes its velocities by those of a rigid motion
/// whose point at `center` has `velocity`. Joints stay as they are. `data` is that of the state before.
void move_whole(const Model& model, const Data& data, const Vector3& way, const Vector3& velocity, const Vector3& spin,
                const Vector3& center, State& state);

}  // namespace breve::articulated
