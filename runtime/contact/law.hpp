// How two materials meet: the numbers of one contact, combined from those of its two bodies.
#pragma once

#include "runtime/kinematics/bodies.hpp"

namespace breve::contact {

/// What the impact law and the solver need to know about a pair of surfaces.
struct Law {
  double restitution = 0;             // normal, 0..1
  double tangential_restitution = 0;  // -1..1
  double static_friction = 0;         // >= dynamic_friction
  double dynamic_friction = 0;
  double restitution_threshold = 0;  // m/s; slower approaches do not bounce
};

/// An approach slower than this does not bounce under `set-e`, length units of the world per second.
inline constexpr double kRestingApproach = 0.05;

/// The law of a pair. Each of friction and restitution is decided for itself:
/// - both bodies set it by `set-friction` (`set-restitution`): the geometric mean of each coefficient (the maximum of
///   each number), exactly;
/// - otherwise mu = 1 + (mu1 + mu2) / 2, static and dynamic alike, and e = (e1 + e2) / 2, ignored below
/// kRestingApproach. A body that set the exact kind then counts with what `set-mu` and `set-e` left on it: the two
/// kinds
///   of number mean different things, and a mean of both would be neither.
/// Numbers are brought into the ranges of Law: those in which no impact gains energy.
/// @param unit  the world's length unit, m
Law combine(const Material& a, const Material& b, double unit = 1);

}  // namespace breve::contact
