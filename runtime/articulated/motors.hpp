// Motors with limits. A motor that looks ahead (Loads::motor_time) depends on the acceleration, and each acceleration
// on all motors: which of them are at their limit is a linear complementarity problem. Its matrix is the inverse of the
// mass matrix and something on the diagonal, so that there is one solution, and it has no jumps: step control relies on
// that.
#pragma once

#include "runtime/articulated/forward_dynamics.hpp"

namespace breve::articulated {

/// Adds what one joint's motor does to data.tau and data.diagonal: its whole force if it does not look ahead (lag 0),
/// else by data.at_limit.
void add_motor(const Loads& loads, const Drive& drive, const Body& body, const State& state, double lag, Data& data);

/// Before the first solve: which motors are taken to be at their limit.
void begin_motors(const Model& model, const Loads& loads, MotorGuess guess, Data& data);

/// What a motor gives after the last solve, N*m or N, with the joint's rate `v` and its derivative `a` there.
/// @param shared  how many velocities share its limit
double motor_force(const Loads& loads, const Drive& drive, int velocity, int shared, double v, double a, double lag,
                   const Data& data);

/// Looks for the motors at their limit, one solve after the other. Those of ball joints that are there take some more,
/// for the direction of their couple (ball_motors.hpp).
/// Source: Judice and Pires 1994, block principal pivoting for bounded linear complementarity problems.
class MotorSearch {
 public:
  /// After a solve: true if some motor gave more than its limit, or was held at it and need not be. data.at_limit and
  /// data.held, or the gains of ball joints, are then others, and the solve is to be repeated.
  bool changes(const Model& model, const Loads& loads, const State& state, double step, Data& data);

 private:
  int wrong_ = 1 << 30;  // the fewest so far
  int spare_ = 0;        // rounds in which all that are wrong may change though they did not become fewer
  int rounds_ = 0;
  int corrections_ = 0;  // of ball joints' motors
};

}  // namespace breve::articulated
