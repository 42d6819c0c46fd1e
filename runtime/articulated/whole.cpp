// Sums over the links, and the six numbers of the root that move them all.
#include "runtime/articulated/whole.hpp"

#include "runtime/articulated/kinematics.hpp"

namespace breve::articulated {

namespace {

/// The inertia of a mass at `arm`.
Symmetric3 of_point(double mass, const Vector3& arm) {
  Symmetric3 inertia = Symmetric3::identity(mass * arm.squaredNorm());
  inertia.subtract_outer(mass * arm, arm);
  return inertia;
}

}  // namespace

void Whole::add(const Whole& other) {
  const double sum = mass + other.mass;
  const Vector3 both = (mass * center + other.mass * other.center) / sum;
  const Vector3 own = center - both, others = other.center - both;
  spin += other.spin + own.cross(momentum) + others.cross(other.momentum);
  inertia += other.inertia;
  inertia += of_point(mass, own);
  inertia += of_point(other.mass, others);
  momentum += other.momentum;
  center = both;
  mass = sum;
}

Whole measure_whole(const Model& model, const Data& data) {
  Whole whole;
  whole.mass = model.mass();
  // About the root's origin first: far from the world's no digits are lost.
  const Vector3 from = data.motion_of(0).origin;
  Vector3 moment = Vector3::Zero();
  for (int i = 0; i < model.size(); ++i) {
    const Body& body = model.body(i);
    const Work& w = data.of(i);
    const Vector3 arm = com_position(model, data, i) - from, push = body.mass * com_velocity(model, data, i);
    const Symmetric3 inertia = body.inertia_com.rotated(w.rotation);
    moment += body.mass * arm;
    whole.momentum += push;
    whole.spin += inertia * w.spin + arm.cross(push);
    whole.inertia += inertia;
    whole.inertia += of_point(body.mass, arm);
  }
  const Vector3 center = moment / whole.mass;
  whole.center = from + center;
  whole.spin -= center.cross(whole.momentum);
  whole.inertia += of_point(-whole.mass, center);
  return whole;
}

void move_whole(const Model& model, const Data& data, const Vector3& way, const Vector3& velocity, const Vector3& spin,
                const Vector3& center, State& state) {
  const Body& root = model.body(0);
  const Vector3 arm = data.motion_of(0).origin - center;
  state.q.segment<3>(root.q) += root.rotation.transpose() * way;
  state.v.segment<3>(root.v) += root.rotation.transpose() * (velocity + spin.cross(arm));
  state.v.segment<3>(root.v + 3) += data.of(0).rotation.transpose() * spin;
}

}  // namespace breve::articulated
