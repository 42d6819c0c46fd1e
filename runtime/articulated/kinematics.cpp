// One pass from the roots outward; the rest reads what it left.
#include "runtime/articulated/kinematics.hpp"

#include "runtime/articulated/joints.hpp"

namespace breve::articulated {

void forward_kinematics(const Model& model, Data& data, const State& state) {
  if (data.stands_at(state)) return;
  const bool placed = data.stands_at(state.q);
  const double *q = state.q.data(), *v = state.v.data();
  int i = 0;
  for (const Body& body : model.bodies()) {
    Work& w = data.of(i);
    const Work& parent = data.of(body.parent);
    WideWork& wide = data.wide_of(body);
    if (!placed) place(body, parent, q, w, wide);
    move(body, parent, v, w, wide);
    const Motion& from = data.motion_of(body.parent);
    Motion& to = data.motion_of(i++);
    to.origin = from.origin + w.offset;
    to.velocity = from.velocity + parent.spin.cross(w.offset);
    Vector3 ignored = Vector3::Zero();
    add_joint_motion(body, w, wide, v, ignored, to.velocity);
  }
  data.stand_at(state);
}

Pose pose(const Data& data, int link) { return {data.motion_of(link).origin, data.of(link).rotation}; }

Vector3 com_position(const Model& model, const Data& data, int link) {
  return data.motion_of(link).origin + data.of(link).rotation * model.body(link).com;
}

Vector3 spin(const Data& data, int link) { return data.of(link).spin; }

Vector3 com_velocity(const Model& model, const Data& data, int link) {
  const Work& w = data.of(link);
  return data.motion_of(link).velocity + w.spin.cross(w.rotation * model.body(link).com);
}

Vector3 point_velocity(const Data& data, int link, const Vector3& point) {
  const Motion& motion = data.motion_of(link);
  return motion.velocity + data.of(link).spin.cross(point - motion.origin);
}

Vector3 rotational_acceleration(const Data& data, int link) { return data.of(link).alpha; }

Vector3 com_acceleration(const Model& model, const Data& data, const Loads& loads, int link) {
  const Work& w = data.of(link);
  const Vector3 arm = w.rotation * model.body(link).com;
  return loads.gravity + w.acc + w.alpha.cross(arm) + w.spin.cross(w.spin.cross(arm));
}

}  // namespace breve::articulated
