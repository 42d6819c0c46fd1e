// The articulated-body algorithm: out (where, how fast), in (inertias and forces), out (accelerations).
#include "runtime/articulated/forward_dynamics.hpp"

#include <fmt/format.h>

#include <utility>

#include "runtime/articulated/elimination.hpp"
#include "runtime/articulated/motors.hpp"
#include "runtime/base/error.hpp"

namespace breve::articulated {

namespace {

[[noreturn]] void singular(const Model& model, int link) {
  throw Error(ErrorCode::Numeric,
              model.name(link) + ": the inertia that its joint moves is singular, or its state is not a number");
}

/// A rigid link, its gyroscopic forces and what pushes it.
void load(const Body& body, const Wrench* wrench, Work& w) {
  const Vector3 moment = w.rotation * body.moment;
  const Symmetric3 inertia = body.inertia.rotated(w.rotation);
  w.inertia.set_rigid(inertia, moment, body.mass);
  w.couple = w.spin.cross(inertia * w.spin);
  w.force = w.spin.cross(w.spin.cross(moment));
  if (!wrench) return;
  const Vector3 arm = w.rotation * body.com;
  w.couple -= wrench->couple + arm.cross(wrench->force);
  w.force -= wrench->force;
}

/// @param stands  links stand and rotate as they are to
void outward(const Model& model, Data& data, const State& state, const Loads& loads, bool stands) {
  if (!stands) data.leave();
  const double *q = state.q.data(), *v = state.v.data();
  const Wrench* wrench = loads.wrenches.empty() ? nullptr : loads.wrenches.data();
  Work* link = data.work.data();
  for (const Body& body : model.bodies()) {
    Work& w = *++link;
    if (!stands) {
      const Work& parent = data.of(body.parent);
      WideWork& wide = data.wide_of(body);
      place(body, parent, q, w, wide);
      move(body, parent, v, w, wide);
    }
    load(body, wrench ? wrench++ : nullptr, w);
  }
}

void inward(const Model& model, Data& data) {
  const double *tau = data.tau.data(), *diagonal = data.diagonal.data();
  for (int i = model.size() - 1; i >= 0; --i) {
    const Body& body = model.body(i);
    Work& w = data.of(i);
    WideWork& wide = data.wide_of(body);
    ArticulatedInertia effective = w.inertia;
    if (!reduce(body, diagonal, w, wide, effective)) singular(model, i);
    Vector3 couple = w.couple, force = w.force;
    carry(body, tau, w, wide, couple, force);
    Work& parent = data.of(body.parent);
    if (body.type != JointType::Free) {
      couple += effective.couple(w.bias_alpha, w.bias_acc);
      force += effective.force(w.bias_alpha, w.bias_acc);
      if (body.parent >= 0) parent.inertia.add_shifted(effective, w.offset);
    }
    parent.couple += couple + w.offset.cross(force);
    parent.force += force;
  }
}

void accelerate(const Model& model, Data& data) {
  double* x = data.acceleration.data();
  Work* link = data.work.data();
  for (const Body& body : model.bodies()) {
    Work& w = *++link;
    const Work& parent = data.of(body.parent);
    w.alpha = parent.alpha + w.bias_alpha;
    w.acc = parent.acc + parent.alpha.cross(w.offset) + w.bias_acc;
    respond(body, w, data.wide_of(body), w.alpha, w.acc, x);
  }
}

void start(Data& data, const Loads& loads) {
  Work& world = data.work.front();
  world.couple.setZero();
  world.force.setZero();
  world.acc = -loads.gravity;
}

}  // namespace

const Vector& forward_dynamics(const Model& model, Data& data, const State& state, const Loads& loads, double step,
                               MotorGuess guess) {
  const bool motors = motor_lag(loads, step) > 0 && !loads.drives.empty();
  if (motors) begin_motors(model, loads, guess, data);
  MotorSearch search;
  bool stands = data.stands_at(state);
  do {
    start(data, loads);
    gather_joint_forces(model, loads, state, step, data);
    outward(model, data, state, loads, std::exchange(stands, true));
    inward(model, data);
    accelerate(model, data);
  } while (motors && search.changes(model, loads, state, step, data));
  if (!data.acceleration.allFinite())
    for (int i = 0; i < model.size(); ++i)
      if (!data.acceleration.segment(model.body(i).v, velocity_count(model.body(i).type)).allFinite())
        throw Error(ErrorCode::Numeric, model.name(i) + ": its acceleration is not finite");
  return data.acceleration;
}

void factorize(const Model& model, Data& data, const State& state, const Loads& loads, double step) {
  gather_joint_forces(model, loads, state, step, data);
  const bool stands = data.stands_at(state.q);
  if (!stands) data.leave();
  Work* link = data.work.data();
  for (const Body& body : model.bodies()) {
    Work& w = *++link;
    if (!stands) place(body, data.of(body.parent), state.q.data(), w, data.wide_of(body));
    const Vector3 moment = w.rotation * body.moment;
    w.inertia.set_rigid(body.inertia.rotated(w.rotation), moment, body.mass);
  }
  for (int i = model.size() - 1; i >= 0; --i) {
    const Body& body = model.body(i);
    Work& w = data.of(i);
    ArticulatedInertia effective = w.inertia;
    if (!reduce(body, data.diagonal.data(), w, data.wide_of(body), effective)) singular(model, i);
    if (body.parent >= 0) data.of(body.parent).inertia.add_shifted(effective, w.offset);
  }
}

}  // namespace breve::articulated
