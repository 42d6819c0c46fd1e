// Joint by joint over q and v; only ball and free joints have anything curved.
#include "runtime/articulated/state.hpp"

#include "runtime/articulated/rotation.hpp"

namespace breve::articulated {

namespace {

/// Where the rotation of a ball or free joint lies in q and v.
struct Rotation {
  int q, v;
};

/// Calls f(Turn) for each joint that has a quaternion.
template <class F>
void for_each_rotation(const Model& model, F f) {
  for (const Body& body : model.bodies()) {
    if (body.type == JointType::Ball) f(Rotation{body.q, body.v});
    if (body.type == JointType::Free) f(Rotation{body.q + 3, body.v + 3});
  }
}

/// Calls f(q, v, count) for each run of coordinates that simply add.
template <class F>
void for_each_flat(const Model& model, F f) {
  for (const Body& body : model.bodies()) {
    switch (body.type) {
      case JointType::Revolute:
      case JointType::Prismatic: f(body.q, body.v, 1); break;
      case JointType::Universal: f(body.q, body.v, 2); break;
      case JointType::Free: f(body.q, body.v, 3); break;
      case JointType::Ball:
      case JointType::Fixed: break;
    }
  }
}

Quaternion quaternion_at(const Vector& q, int i) { return {q[i], q[i + 1], q[i + 2], q[i + 3]}; }

void put_quaternion(const Quaternion& r, int i, Vector& q) {
  q[i] = r.w(), q[i + 1] = r.x(), q[i + 2] = r.y(), q[i + 3] = r.z();
}

}  // namespace

State neutral_state(const Model& model) {
  State state{Vector::Zero(model.positions()), Vector::Zero(model.velocities())};
  for_each_rotation(model, [&](Rotation t) { state.q[t.q] = 1; });
  return state;
}

void move(const Model& model, const Vector& q, const Vector& d, Vector& out) {
  for_each_flat(model, [&](int iq, int iv, int n) {
    for (int k = 0; k < n; ++k) out[iq + k] = q[iq + k] + d[iv + k];
  });
  for_each_rotation(model, [&](Rotation t) {
    const Quaternion rotated = quaternion_at(q, t.q) * rotation_by(d.segment<3>(t.v));
    put_quaternion(rotated.normalized(), t.q, out);
  });
}

void difference(const Model& model, const Vector& from, const Vector& to, Vector& d) {
  for_each_flat(model, [&](int iq, int iv, int n) {
    for (int k = 0; k < n; ++k) d[iv + k] = to[iq + k] - from[iq + k];
  });
  for_each_rotation(model, [&](Rotation t) {
    d.segment<3>(t.v) = logarithm(quaternion_at(from, t.q).conjugate() * quaternion_at(to, t.q));
  });
}

void rate_of_move(const Model& model, const Vector& d, const Vector& v, Vector& out) {
  out = v;
  for_each_rotation(
      model, [&](Rotation t) { out.segment<3>(t.v) = rate_of_rotation_vector(d.segment<3>(t.v), v.segment<3>(t.v)); });
}

void bend_to_cayley(const Model& model, Vector& d) {
  for_each_rotation(model, [&](Rotation t) { d.segment<3>(t.v) = cayley(d.segment<3>(t.v)); });
}

}  // namespace breve::articulated
