// Inverse dynamics: from accelerations to the joint forces that make them.
#pragma once

#include "runtime/articulated/data.hpp"
#include "runtime/articulated/loads.hpp"

namespace breve::articulated {

/// Joint forces by the recursive Newton-Euler algorithm: those that, as loads.tau, make forward_dynamics give
/// `acceleration`. loads.tau itself is not read; gravity, wrenches and drives are.
/// @param acceleration  (nv), time derivative of v
/// @param tau           (nv), N*m or N; may not be loads.tau
/// Source: Featherstone 2008, table 5.1, in world axes. Cost O(links). No allocation.
void inverse_dynamics(const Model& model, Data& data, const State& state, const Vector& acceleration,
                      const Loads& loads, Vector& tau);

}  // namespace breve::articulated
