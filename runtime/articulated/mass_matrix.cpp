// The composite-rigid-body algorithm: each joint's unit motion, the force that this takes, at all joints inward of it.
#include "runtime/articulated/mass_matrix.hpp"

#include "runtime/articulated/joints.hpp"

namespace breve::articulated {

namespace {

/// One column: joint rate `k` of link `i` at 1, against the joints from `i` to the root.
void fill_column(const Model& model, const Data& data, int i, int k, Vector& unit, Vector& column,
                 Eigen::MatrixXd& mass) {
  const Body& body = model.body(i);
  const Work& w = data.of(i);
  Vector3 spin = Vector3::Zero(), way = Vector3::Zero();
  unit[k] = 1;
  add_joint_motion(body, w, data.wide_of(body), unit.data(), spin, way);
  unit[k] = 0;
  Vector3 couple = w.inertia.couple(spin, way), force = w.inertia.force(spin, way);
  for (int j = i; j >= 0; j = model.body(j).parent) {
    const Body& inner = model.body(j);
    joint_force(inner, data.of(j), data.wide_of(inner), couple, force, column.data());
    for (int m = inner.v; m < inner.v + velocity_count(inner.type); ++m) mass(k, m) = mass(m, k) = column[m];
    couple += data.of(j).offset.cross(force);
  }
}

}  // namespace

void mass_matrix(const Model& model, Data& data, const Vector& q, Eigen::MatrixXd& mass) {
  mass.setZero(model.velocities(), model.velocities());
  data.leave();
  for (int i = 0; i < model.size(); ++i) {
    const Body& body = model.body(i);
    Work& w = data.of(i);
    place(body, data.of(body.parent), q.data(), w, data.wide_of(body));
    w.inertia.set_rigid(body.inertia.rotated(w.rotation), w.rotation * body.moment, body.mass);
  }
  for (int i = model.size() - 1; i >= 0; --i)
    if (model.body(i).parent >= 0)
      data.of(model.body(i).parent).inertia.add_shifted(data.of(i).inertia, data.of(i).offset);
  Vector& unit = data.deflection;
  unit.setZero();
  for (int i = 0; i < model.size(); ++i)
    for (int k = model.body(i).v; k < model.body(i).v + velocity_count(model.body(i).type); ++k)
      fill_column(model, data, i, k, unit, data.held, mass);
}

}  // namespace breve::articulated
