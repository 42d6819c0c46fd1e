// Springs between points of two bodies: massless, passing through everything.
#pragma once

#include <cstdint>

#include "runtime/base/ids.hpp"
#include "runtime/base/math.hpp"
#include "runtime/kinematics/bodies.hpp"

namespace breve {

using SpringIndex = std::uint32_t;
inline constexpr SpringIndex kNoSpring = 0xffffffffU;

enum class SpringMode : std::uint8_t { Both, ExpandOnly, ContractOnly };

/// With d from the point on a to the point on b and u the rate of |d|: F = strength (|d| - length) + damping u,
/// positive pulling together, cut at +-maximum. Expand-only gives nothing while |d| > length, contract-only nothing
/// while |d| < length.
struct SpringDescription {
  BodyIndex a = kNoBody, b = kNoBody;
  Vector3 point_a = Vector3::Zero(), point_b = Vector3::Zero();  // each in its body's own frame, m
  double length = 0;                                             // m, >= 0
  double strength = 100;                                         // N/m, >= 0
  double damping = 0.01;                                         // N*s/m, >= 0
  double maximum_force = 0;                                      // N; 0: no bound
  SpringMode mode = SpringMode::Both;
};

/// Error{Argument} naming the property that is not finite or below 0.
void check(const SpringDescription& is);

/// What a spring between bodies does now.
struct SpringPull {
  Vector3 direction = Vector3::Zero();  // unit, from a to b
  double force = 0;                     // N, positive pulls together
  double energy = 0;                    // J, stored
  double loss = 0;                      // W, in its damper
};
/// @param way   from the point on a to the point on b, m
/// @param rate  of that, m/s
SpringPull pull_of(const SpringDescription& is, const Vector3& way, const Vector3& rate);

}  // namespace breve
