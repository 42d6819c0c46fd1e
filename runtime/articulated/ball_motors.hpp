// Motors of ball joints at their limit. The couple is bounded as a whole, so that its direction is also to be found: of
// all couples within the limit, the one that leaves the least between the joint's rate and what the motor aims at.
// It points along what is left, so that a smaller gain gives it: the one with which it is just the limit.
#pragma once

#include "runtime/articulated/loads.hpp"

namespace breve::articulated {

/// Each motor of a universal joint has the limit for itself, the three of a ball joint share it: first velocity and
/// count of each.
template <class F>
void for_each_motor(const Body& body, F f) {
  if (body.type == JointType::Ball) return f(body.v, 3);
  for (int k = body.v; k < body.v + velocity_count(body.type); ++k) f(k, 1);
}

/// The same for every joint that has a motor.
template <class F>
void for_each_motor(const Model& model, const Loads& loads, F f) {
  for (int i = 0; i < model.size(); ++i) {
    const Drive& drive = loads.drives[static_cast<std::size_t>(i)];
    if (drive.motor_gain > 0) for_each_motor(model.body(i), [&](int first, int count) { f(drive, first, count); });
  }
}

/// After a solve, of those at their limit: by which part of it they give more or less, at most; 0 if that is round-off.
/// @param lag  s, by which motors look ahead, > 0
double error_of_ball_motors(const Model& model, const Loads& loads, const State& state, double lag, Data& data);

/// After that, if it was not 0: gives them the gains with which they would be just at their limit, by one step of
/// Newton's method for 1 / force - 1 / limit, which is nearly linear in 1 / gain. Those that would need their own gain
/// are at their limit no more. The solve is to be repeated.
/// Source: Hebden 1973; More and Sorensen 1983 (for one motor, which is a step within a trust region).
void correct_ball_motors(const Model& model, const Loads& loads, const State& state, double lag, Data& data);

}  // namespace breve::articulated
