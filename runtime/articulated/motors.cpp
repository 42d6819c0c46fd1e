// Which motors are at their limit.
#include "runtime/articulated/motors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace breve::articulated {

namespace {

double motor_speed(const Loads& loads, int i) { return loads.motor_speed.size() ? loads.motor_speed[i] : 0; }

/// Shortens `force` to the motor's limit; a ball joint's couple as a whole.
template <class V>
void limit_force(double limit, V force) {
  const double size = force.norm();
  if (size > limit) force *= limit / size;
}

/// Each motor of a universal joint has the limit for itself, the three of a ball joint share it: first velocity and
/// count of each.
template <class F>
void for_each_motor(const Body& body, F f) {
  if (body.type == JointType::Ball) return f(body.v, 3);
  for (int k = body.v; k < body.v + velocity_count(body.type); ++k) f(k, 1);
}

template <class F>
void for_each_motor(const Model& model, const Loads& loads, F f) {
  for (int i = 0; i < model.size(); ++i) {
    const Drive& drive = loads.drives[static_cast<std::size_t>(i)];
    if (drive.motor_gain > 0) for_each_motor(model.body(i), [&](int first, int count) { f(drive, first, count); });
  }
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
  const auto held = data.held.segment(first, count);
  const double size = held.norm();
  return size == 0 ? wanted.norm() > 0 : wanted.dot(held) / size >= drive.motor_limit - slack;
}

/// Takes it to be where it was not: data.deflection is what it would give without a limit.
void exchange(const Drive& drive, int first, int count, Data& data) {
  const bool hold = !at_limit(data, first);
  for (int k = first; k < first + count; ++k) {
    at_limit(data, k) = !hold ? 0 : data.deflection[k] < 0 ? -1 : 1;
    data.held[k] = data.deflection[k];
  }
  if (hold) limit_force(drive.motor_limit, data.held.segment(first, count));
}

}  // namespace

void add_motor(const Loads& loads, const Drive& drive, const Body& body, const State& state, double lag, Data& data) {
  for_each_motor(body, [&](int first, int count) {
    auto force = data.deflection.segment(first, count);  // a place to work in: the springs are done with it
    for (int k = 0; k < count; ++k) force[k] = drive.motor_gain * (motor_speed(loads, first + k) - state.v[first + k]);
    if (lag == 0) {
      limit_force(drive.motor_limit, force);
      data.tau.segment(first, count) += force;
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
    // Which way a ball joint's couple points, one side does not tell.
    for (int k = first; count > 1 && k < first + count; ++k) at_limit(data, k) = 0;
    if (count == 1) data.held[first] = at_limit(data, first) * drive.motor_limit;
  });
}

bool MotorSearch::changes(const Model& model, const Loads& loads, const State& state, double step, Data& data) {
  const double lag = motor_lag(loads, step);
  int wrong = 0, last = -1, motors = 0;
  for_each_motor(model, loads, [&](const Drive& drive, int first, int count) {
    ++motors;
    if (settled(loads, drive, state, lag, first, count, data)) return;
    ++wrong;
    last = first;
  });
  // Where round-off decides, both answers are right.
  if (wrong == 0 || ++rounds_ > 8 + 4 * motors) return false;
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
  return true;
}

}  // namespace breve::articulated
