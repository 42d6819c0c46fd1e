// Joint forces from springs and dampers; explicit, or linearly implicit at a step's end. Motors: motors.cpp.
#include "runtime/articulated/loads.hpp"

#include <cmath>

#include "runtime/articulated/data.hpp"
#include "runtime/articulated/motors.hpp"

namespace breve::articulated {

namespace {

const Vector& rest_of(const Loads& loads, const Data& data) { return loads.rest.size() ? loads.rest : data.rest; }

}  // namespace

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
