// Which motors are at their limit.
#include "runtime/articulated/motors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/articulated/ball_motors.hpp"

namespace breve::articulated {

namespace {

double motor_speed(const Loads& loads, int i) { return loads.motor_speed.size() ? loads.motor_speed[i] : 0; }

/// Shortens `force` to the motor's limit; a ball joint's couple as a whole.
template <class V>
void limit_force(double limit, V force) {
  const double size = force.norm();
  if (size > limit) force *= limit / size;
}

signed char& at_limit(Data& data, int velocity) { return data.at_limit[static_cast<std::size_t>(velocity)]; }

/// What a motor would give if it had no limit goes to data.deflection, a place to work in.
/// @return  the part of a force that round-off may be
double ask(const Loads& loads, const Drive& drive, const State& state, double lag, int first, int count, Data& data) {
  double most = 0;
  for (int k = first; k < first + count; ++k) {
    const double speed = motor_speed(loads, k), ahead = lag * data.acceleration[k];
    data.deflection[k] = drive.motor_gain * (speed - state.v[k] - ahead);
    most = std::max(most, std::abs(speed) + std::abs(state.v[k]) + std::abs(ahead));
  }
  constexpr double kRoundOff = 16 * std::numeric_limits<double>::epsilon();
  return kRoundOff * (drive.motor_gain * most + drive.motor_limit);
}

/// True if the motor is where the last solve took it to be.
bool settled(const Loads& loads, const Drive& drive, const State& state, double lag, int first, int count, Data& data) {
  const double slack = ask(loads, drive, state, lag, first, count, data);
  const auto wanted = data.deflection.segment(first, count);
  if (!at_limit(data, first)) return !(wanted.norm() > drive.motor_limit + slack);
  if (count > 1) return true;  // correct_ball_motors() finds out
  const double held = data.held[first], side = held < 0 ? -1 : 1;
  return held == 0 ? wanted[0] != 0 : side * wanted[0] >= drive.motor_limit - slack;
}

/// Takes it to be where it was not: data.deflection is what it would give without a limit.
void exchange(const Drive& drive, int first, int count, Data& data) {
  const bool hold = !at_limit(data, first);
  if (count > 1) {
    for (int k = first; k < first + count; ++k) at_limit(data, k) = hold;
    data.balls.gains.segment(first, count).setConstant(drive.motor_gain);
    return;
  }
  at_limit(data, first) = !hold ? 0 : data.deflection[first] < 0 ? -1 : 1;
  data.held[first] = data.deflection[first];
  if (hold) limit_force(drive.motor_limit, data.held.segment(first, 1));
}

}  // namespace

void add_motor(const Loads& loads, const Drive& drive, const Body& body, const State& state, double lag, Data& data) {
  for_each_motor(body, [&](int first, int count) {
    auto force = data.deflection.segment(first, count);  // a place to work in: the springs are done with it
    for (int k = 0; k < count; ++k) force[k] = drive.motor_gain * (motor_speed(loads, first + k) - state.v[first + k]);
    if (lag == 0) {
      limit_force(drive.motor_limit, force);
      data.tau.segment(first, count) += force;
    } else if (at_limit(data, first) && count > 1) {
      const double gain = data.balls.gains[first];
      data.tau.segment(first, count) += gain / drive.motor_gain * force;
      data.diagonal.segment(first, count).array() += lag * gain;
    } else if (at_limit(data, first)) {
      data.tau.segment(first, count) += data.held.segment(first, count);
    } else {
      data.tau.segment(first, count) += force;
      data.diagonal.segment(first, count).array() += lag * drive.motor_gain;
    }
  });
}

void begin_motors(const Model& model, const Loads& loads, MotorGuess guess, Data& data) {
  if (guess == MotorGuess::None) std::fill(data.at_limit.begin(), data.at_limit.end(), 0);
  for_each_motor(model, loads, [&](const Drive& drive, int first, int count) {
    if (count == 1) data.held[first] = at_limit(data, first) * drive.motor_limit;
    // Drives may be others than they were.
    for (int k = first; count > 1 && k < first + count; ++k)
      if (!(data.balls.gains[k] < drive.motor_gain)) at_limit(data, k) = 0;
  });
}

double motor_force(const Loads& loads, const Drive& drive, int velocity, int shared, double v, double a, double lag,
                   const Data& data) {
  const bool limited = data.at_limit[static_cast<std::size_t>(velocity)] != 0;
  if (limited && shared == 1) return data.held[velocity];
  const double gain = limited ? data.balls.gains[velocity] : drive.motor_gain;
  return gain * (motor_speed(loads, velocity) - v - lag * a);
}

bool MotorSearch::changes(const Model& model, const Loads& loads, const State& state, double step, Data& data) {
  constexpr int kMostCorrections = 60;  // four to six are usual, and some more from afar
  constexpr double kRough = 0.1;        // of its limit: before others are judged by it
  const double lag = motor_lag(loads, step);
  const double error = error_of_ball_motors(model, loads, state, lag, data);
  const bool correctable = error > 0 && corrections_ < kMostCorrections;
  const auto correct = [&] {
    ++corrections_;
    correct_ball_motors(model, loads, state, lag, data);
    return true;
  };
  if (correctable && error > kRough) return correct();
  int wrong = 0, last = -1, motors = 0;
  for_each_motor(model, loads, [&](const Drive& drive, int first, int count) {
    ++motors;
    if (settled(loads, drive, state, lag, first, count, data)) return;
    ++wrong;
    last = first;
  });
  if (wrong == 0) return correctable && correct();
  // Where round-off decides, both answers are right.
  if (++rounds_ > 8 + 4 * motors) return false;
  constexpr int kSpare = 4;
  bool all = true;
  if (wrong < wrong_) {
    wrong_ = wrong;
    spare_ = kSpare;
  } else if (spare_ > 0) {
    --spare_;
  } else {
    all = false;  // one at a time, always the last: that ends
  }
  for_each_motor(model, loads, [&](const Drive& drive, int first, int count) {
    if (!all && first != last) return;
    if (!settled(loads, drive, state, lag, first, count, data)) exchange(drive, first, count, data);
  });
  // Ball joints that have come to their limit are far from the gain that gives it.
  return error_of_ball_motors(model, loads, state, lag, data) > 0 ? correct() : true;
}

}  // namespace breve::articulated
