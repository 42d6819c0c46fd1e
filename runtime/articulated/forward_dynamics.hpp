// Forward dynamics: from forces to accelerations, in time proportional to the number of links.
#pragma once

#include <cstdint>

#include "runtime/articulated/data.hpp"
#include "runtime/articulated/loads.hpp"

namespace breve::articulated {

/// Which motors the search for those at their limit (motors.hpp) takes first to be there: what comes out is the same
/// but for round-off.
enum class MotorGuess : std::uint8_t {
  None,  // nothing is remembered
  Last,  // those of the last call on `data`, which was of a state nearby
};

/// Joint accelerations by the articulated-body algorithm.
/// @param state  q (nq) and v (nv), see JointType; quaternions of unit length
/// @param loads  gravity, joint forces, wrenches, drives
/// @param step   0: all forces at q and v. Above (s): springs, dampers and motors linearly implicit over that step; the
///               result is then the mean acceleration of a semi-implicit Euler step
/// @return       (nv), rad/s^2 and m/s^2, time derivatives of v; valid until the next call on `data`
/// @throws       Error{Numeric} naming the link if an articulated inertia is singular or the state is not finite
/// Leaves in `data` for this q: rotation, offset, axis, inertia (impulse.hpp stands on them), alpha and acc of each
/// link. Source: Featherstone 2008, table 7.1, in world axes with plain accelerations. Cost O(links). No allocation.
const Vector& forward_dynamics(const Model& model, Data& data, const State& state, const Loads& loads, double step = 0,
                               MotorGuess guess = MotorGuess::None);

/// The part of it that depends on q alone: places the links and computes articulated inertias, so that impulse
/// responses can be asked for. `step` as above, with the drives of `loads`. Throws as above. Cost O(links). No
/// allocation.
void factorize(const Model& model, Data& data, const State& state, const Loads& loads, double step = 0);

}  // namespace breve::articulated
