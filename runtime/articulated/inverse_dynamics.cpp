// The recursive Newton-Euler algorithm: out (accelerations), in (forces).
#include "runtime/articulated/inverse_dynamics.hpp"

#include "runtime/articulated/joints.hpp"

namespace breve::articulated {

namespace {

/// What a link needs to move as it does: m a, and I alpha + w x I w about the centre of mass, moved to the origin.
void need(const Body& body, const Wrench* wrench, Work& w) {
  const Vector3 arm = w.rotation * body.com;
  const Vector3 acc = w.acc + w.alpha.cross(arm) + w.spin.cross(w.spin.cross(arm));
  // In body axes, where the inertia stands as it is.
  const Vector3 spin = w.rotation.transpose() * w.spin, alpha = w.rotation.transpose() * w.alpha;
  w.force = body.mass * acc;
  w.couple = w.rotation * (body.inertia_com * alpha + spin.cross(body.inertia_com * spin));
  if (wrench) {
    w.force -= wrench->force;
    w.couple -= wrench->couple;
  }
  w.couple += arm.cross(w.force);
}

}  // namespace

void inverse_dynamics(const Model& model, Data& data, const State& state, const Vector& acceleration,
                      const Loads& loads, Vector& tau) {
  const double *q = state.q.data(), *v = state.v.data();
  data.leave();
  Work& world = data.work.front();
  world.couple.setZero();
  world.force.setZero();
  world.acc = -loads.gravity;
  for (int i = 0; i < model.size(); ++i) {
    const Body& body = model.body(i);
    Work& w = data.of(i);
    const Work& parent = data.of(body.parent);
    WideWork& wide = data.wide_of(body);
    place(body, parent, q, w, wide);
    move(body, parent, v, w, wide);
    w.alpha = parent.alpha + w.bias_alpha;
    w.acc = parent.acc + parent.alpha.cross(w.offset) + w.bias_acc;
    add_joint_motion(body, w, wide, acceleration.data(), w.alpha, w.acc);
    need(body, loads.wrenches.empty() ? nullptr : &loads.wrenches[static_cast<std::size_t>(i)], w);
  }
  for (int i = model.size() - 1; i >= 0; --i) {
    const Body& body = model.body(i);
    const Work& w = data.of(i);
    joint_force(body, w, data.wide_of(body), w.couple, w.force, tau.data());
    Work& parent = data.of(body.parent);
    parent.couple += w.couple + w.offset.cross(w.force);
    parent.force += w.force;
  }
  if (loads.drives.empty()) return;
  gather_joint_forces(model, loads, state, 0, data);
  tau -= data.tau;
  if (loads.tau.size()) tau += loads.tau;
}

}  // namespace breve::articulated
