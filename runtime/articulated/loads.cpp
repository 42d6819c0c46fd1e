// Joint forces from springs, dampers and motors; explicit, or linearly implicit at a step's end.
#include "runtime/articulated/loads.hpp"

#include <fmt/format.h>

#include <cmath>

#include "runtime/articulated/data.hpp"
#include "runtime/base/error.hpp"

namespace breve::articulated {

namespace {

void need_size(const char* what, Eigen::Index has, int needed) {
  if (has != 0 && has != needed)
    throw Error(ErrorCode::Argument, fmt::format("{}: {} given, the model needs {}", what, has, needed));
}

void check_drive(const Model& model, int link, const Drive& drive) {
  const std::pair<double, const char*> numbers[] = {{drive.stiffness, "stiffness"},
                                                    {drive.damping, "damping"},
                                                    {drive.motor_gain, "gain of the motor"},
                                                    {drive.motor_limit, "limit of the motor"}};
  for (const auto& [value, what] : numbers) {
    if (!std::isfinite(value) || value < 0)
      throw Error(ErrorCode::Argument,
                  fmt::format("{}: {} of its joint is {} (must be finite and >= 0)", model.name(link), what, value));
    if (value > 0 && model.body(link).type == JointType::Free)
      throw Error(ErrorCode::Argument, fmt::format("{}: a free joint has no {}", model.name(link), what));
  }
}

/// Shortens `force` to the motor's limit; a ball joint's couple as a whole. Returns whether it was too long.
template <class V>
bool limit_force(double limit, V force) {
  const double size = force.norm();
  if (!(size > limit)) return false;
  force *= limit / size;
  return true;
}

/// Of a universal joint each motor has the limit for itself, of a ball joint all three share it.
template <class F>
bool for_each_motor(const Body& body, F f) {
  if (body.type == JointType::Ball) return f(body.v, 3);
  bool any = false;
  for (int k = 0; k < velocity_count(body.type); ++k) any = f(body.v + k, 1) || any;
  return any;
}

double motor_speed(const Loads& loads, int i) { return loads.motor_speed.size() ? loads.motor_speed[i] : 0; }

void add_motor(const Loads& loads, const Drive& drive, const Body& body, const State& state, double lag, bool held,
               Data& data) {
  for_each_motor(body, [&](int first, int count) {
    auto force = data.deflection.segment(first, count);  // a place to work in: the springs are done with it
    for (int k = 0; k < count; ++k) force[k] = drive.motor_gain * (motor_speed(loads, first + k) - state.v[first + k]);
    if (lag == 0) {
      limit_force(drive.motor_limit, force);
      data.tau.segment(first, count) += force;
    } else if (held) {
      data.tau.segment(first, count) += data.held.segment(first, count);
    } else {
      data.tau.segment(first, count) += force;
      data.diagonal.segment(first, count).array() += lag * drive.motor_gain;
    }
    return false;
  });
}

const Vector& rest_of(const Loads& loads, const Data& data) { return loads.rest.size() ? loads.rest : data.rest; }

}  // namespace

void check_loads(const Model& model, const Loads& loads) {
  if (!loads.gravity.allFinite()) throw Error(ErrorCode::Argument, "gravity is not finite");
  need_size("joint forces", loads.tau.size(), model.velocities());
  need_size("wrenches on links", static_cast<Eigen::Index>(loads.wrenches.size()), model.size());
  need_size("drives of joints", static_cast<Eigen::Index>(loads.drives.size()), model.size());
  need_size("rest positions", loads.rest.size(), model.positions());
  need_size("motor speeds", loads.motor_speed.size(), model.velocities());
  for (int i = 0; i < model.size(); ++i) {
    const Body& body = model.body(i);
    const int n = velocity_count(body.type);
    const auto at = static_cast<std::size_t>(i);
    const bool finite =
        (!loads.tau.size() || loads.tau.segment(body.v, n).allFinite()) &&
        (!loads.motor_speed.size() || loads.motor_speed.segment(body.v, n).allFinite()) &&
        (!loads.rest.size() || loads.rest.segment(body.q, position_count(body.type)).allFinite()) &&
        (loads.wrenches.empty() || (loads.wrenches[at].couple.allFinite() && loads.wrenches[at].force.allFinite()));
    if (!finite)
      throw Error(ErrorCode::Argument, model.name(i) + ": a force, rest position or motor speed is not finite");
    if (!loads.drives.empty()) check_drive(model, i, loads.drives[at]);
  }
}

void gather_joint_forces(const Model& model, const Loads& loads, const State& state, double step, Data& data) {
  if (loads.tau.size())
    data.tau = loads.tau;
  else
    data.tau.setZero();
  data.diagonal.setZero();
  if (loads.drives.empty()) return;
  difference(model, rest_of(loads, data), state.q, data.deflection);
  for (int i = 0; i < model.size(); ++i) {
    const Body& body = model.body(i);
    const auto at = static_cast<std::size_t>(i);
    const Drive& drive = loads.drives[at];
    for (int k = body.v; k < body.v + velocity_count(body.type); ++k) {
      data.tau[k] -= drive.stiffness * (data.deflection[k] + step * state.v[k]) + drive.damping * state.v[k];
      data.diagonal[k] += step * (drive.damping + step * drive.stiffness);
    }
    if (drive.motor_gain > 0)
      add_motor(loads, drive, body, state, motor_lag(loads, step), data.at_limit[at] != 0, data);
  }
}

bool hold_motors(const Model& model, const Loads& loads, const State& state, double step, Data& data) {
  const double lag = motor_lag(loads, step);
  bool any = false;
  for (int i = 0; i < model.size(); ++i) {
    const Body& body = model.body(i);
    const auto at = static_cast<std::size_t>(i);
    const Drive& drive = loads.drives[at];
    if (!(drive.motor_gain > 0) || data.at_limit[at]) continue;
    const bool beyond = for_each_motor(body, [&](int first, int count) {
      for (int k = first; k < first + count; ++k)
        data.held[k] = drive.motor_gain * (motor_speed(loads, k) - state.v[k] - lag * data.acceleration[k]);
      return limit_force(drive.motor_limit, data.held.segment(first, count));
    });
    data.at_limit[at] = beyond;
    any = any || beyond;
  }
  return any;
}

double spring_energy(const Model& model, const Loads& loads, const Vector& q, Data& data) {
  if (loads.drives.empty()) return 0;
  difference(model, rest_of(loads, data), q, data.deflection);
  double energy = 0;
  for (int i = 0; i < model.size(); ++i) {
    const Body& body = model.body(i);
    const double square = data.deflection.segment(body.v, velocity_count(body.type)).squaredNorm();
    energy += 0.5 * loads.drives[static_cast<std::size_t>(i)].stiffness * square;
  }
  return energy;
}

}  // namespace breve::articulated
