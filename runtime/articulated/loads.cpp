// Joint forces from springs and dampers; explicit, or linearly implicit at a step's end. Motors: motors.cpp.
#include "runtime/articulated/loads.hpp"

#include <fmt/format.h>

#include <cmath>

#include "runtime/articulated/data.hpp"
#include "runtime/articulated/motors.hpp"
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
  if (loads.reacts) data.tau += loads.reaction;
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
    if (drive.motor_gain > 0) add_motor(loads, drive, body, state, motor_lag(loads, step), data);
  }
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
