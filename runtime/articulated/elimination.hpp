// How the articulated-body algorithm takes a joint out of the equations: its own inertia is inverted, and the
// links beyond it act on the parent's side only in the directions in which the joint is stiff. Source: Featherstone
// 2008, section 7.2 (equations 7.36 to 7.44), written for world axes and each type of joint.
#pragma once

#include "runtime/articulated/joints.hpp"

namespace breve::articulated {

/// A pivot this small against the largest possible one has no correct digit left: two units of round-off.
constexpr double kSingular = 4e-16;

/// Lets `effective` rotate freely about an axis. `added` is added to its inertia there. Returns false if that is
/// singular.
inline bool release(const Vector3& axis, double added, double least, ArticulatedInertia& effective,
                    Vector3& pull_couple, Vector3& pull_force, double& inverse) {
  pull_couple = effective.a * axis;
  pull_force.noalias() = effective.b.transpose() * axis;
  const double inertia = axis.dot(pull_couple) + added;
  if (!(inertia > least)) return false;
  inverse = 1 / inertia;
  effective.subtract_dyad(pull_couple, pull_force, inverse);
  return true;
}

/// Transforms the articulated inertia `effective` of a link into the effective one across its joint, and keeps what
/// `carry` and `respond` need. `diagonal` (nv) is added to the joint's own inertia. Returns false if that inertia is
/// singular.
inline bool reduce(const Body& body, const double* diagonal, Work& w, WideWork& wide, ArticulatedInertia& effective) {
  diagonal += body.v;
  switch (body.type) {
    case JointType::Revolute:
      return release(w.axis, diagonal[0], kSingular * effective.a.trace(), effective, w.pull_couple, w.pull_force,
                     w.inverse);
    case JointType::Prismatic: {
      w.pull_couple.noalias() = effective.b * w.axis;
      w.pull_force = effective.c * w.axis;
      const double inertia = w.axis.dot(w.pull_force) + diagonal[0];
      if (!(inertia > kSingular * effective.c.trace())) return false;
      w.inverse = 1 / inertia;
      effective.subtract_dyad(w.pull_couple, w.pull_force, w.inverse);
      return true;
    }
    case JointType::Universal: {
      // One axis after the other, as if a revolute joint sat on a revolute joint.
      const double least = kSingular * effective.a.trace();
      if (!release(w.axis, diagonal[0], least, effective, w.pull_couple, w.pull_force, w.inverse)) return false;
      wide.coupling = wide.axis2.dot(w.pull_couple);
      return release(wide.axis2, diagonal[1], least, effective, wide.pull2_couple, wide.pull2_force, wide.inverse2);
    }
    case JointType::Ball: {
      wide.added = diagonal[0];
      Symmetric3 own = effective.a;
      own += Symmetric3::identity(wide.added);
      if (!invert(own, wide.inverse)) return false;
      const Matrix3 gain = wide.inverse.matrix() * effective.b;
      const Matrix3 loss = effective.b.transpose() * gain;
      effective.c.xx -= loss(0, 0), effective.c.xy -= loss(0, 1), effective.c.xz -= loss(0, 2);
      effective.c.yy -= loss(1, 1), effective.c.yz -= loss(1, 2), effective.c.zz -= loss(2, 2);
      // a - a (a + d)^-1 a = d (1 - d (a + d)^-1); zero but for the implicit part d.
      const double d = wide.added;
      const Symmetric3& i = wide.inverse;
      effective.a = {d * (1 - d * i.xx), -d * d * i.xy, -d * d * i.xz,
                     d * (1 - d * i.yy), -d * d * i.yz, d * (1 - d * i.zz)};
      effective.b = d * gain;
      return true;
    }
    case JointType::Free: {
      if (!invert(effective.c, wide.inverse_mass)) return false;
      const Matrix3 shift = effective.b * wide.inverse_mass.matrix() * effective.b.transpose();
      Symmetric3 own = effective.a;
      own.xx -= shift(0, 0), own.xy -= shift(0, 1), own.xz -= shift(0, 2);
      own.yy -= shift(1, 1), own.yz -= shift(1, 2), own.zz -= shift(2, 2);
      return invert(own, wide.inverse);
    }
    case JointType::Fixed: return true;
  }
  return false;
}

/// Takes the joint's forces `tau` (nv; null: none) into account: keeps what is left of them for acceleration, and
/// transforms torque and force that the link needs into those that come through the joint.
inline void carry(const Body& body, const double* tau, Work& w, WideWork& wide, Vector3& couple, Vector3& force) {
  const auto given = [&](int k) { return tau ? tau[body.v + k] : 0.0; };
  switch (body.type) {
    case JointType::Revolute:
    case JointType::Prismatic: {
      const Vector3& effective = body.type == JointType::Revolute ? couple : force;
      w.push = given(0) - w.axis.dot(effective);
      const double rate = w.push * w.inverse;
      couple += rate * w.pull_couple;
      force += rate * w.pull_force;
      break;
    }
    case JointType::Universal: {
      w.push = given(0) - w.axis.dot(couple);
      const double rate = w.push * w.inverse;
      couple += rate * w.pull_couple;
      force += rate * w.pull_force;
      wide.push2 = given(1) - wide.axis2.dot(couple);
      const double rate2 = wide.push2 * wide.inverse2;
      couple += rate2 * wide.pull2_couple;
      force += rate2 * wide.pull2_force;
      break;
    }
    case JointType::Ball: {
      wide.push_couple = w.rotation * Vector3(given(0), given(1), given(2)) - couple;
      const Vector3 rate = wide.inverse * wide.push_couple;
      couple += wide.push_couple - wide.added * rate;
      force += w.inertia.b.transpose() * rate;
      break;
    }
    case JointType::Free:
      wide.push_force = body.rotation * Vector3(given(0), given(1), given(2)) - force;
      wide.push_couple = w.rotation * Vector3(given(3), given(4), given(5)) - couple;
      force += wide.push_force;
      couple += wide.push_couple;
      break;
    case JointType::Fixed: break;
  }
}

/// The joint's accelerations (nv), where its link would have `rotation` and `way` if they were zero; adds them to both.
inline void respond(const Body& body, const Work& w, const WideWork& wide, Vector3& spin, Vector3& way, double* x) {
  x += body.v;
  switch (body.type) {
    case JointType::Revolute:
      x[0] = w.inverse * (w.push - w.pull_couple.dot(spin) - w.pull_force.dot(way));
      spin += x[0] * w.axis;
      break;
    case JointType::Prismatic:
      x[0] = w.inverse * (w.push - w.pull_couple.dot(spin) - w.pull_force.dot(way));
      way += x[0] * w.axis;
      break;
    case JointType::Universal:
      x[1] = wide.inverse2 * (wide.push2 - wide.pull2_couple.dot(spin) - wide.pull2_force.dot(way));
      x[0] = w.inverse * (w.push - w.pull_couple.dot(spin) - w.pull_force.dot(way) - wide.coupling * x[1]);
      spin += x[0] * w.axis + x[1] * wide.axis2;
      break;
    case JointType::Ball: {
      const Vector3 own = wide.inverse * (wide.push_couple - w.inertia.couple(spin, way));
      Eigen::Map<Vector3>{x}.noalias() = w.rotation.transpose() * own;
      spin += own;
      break;
    }
    case JointType::Free: {
      // Its parent is the world: turn is zero, and way what gravity takes off.
      const Vector3 force = wide.push_force - w.inertia.c * way;
      const Vector3 own = wide.inverse * (wide.push_couple - w.inertia.b * (way + wide.inverse_mass * force));
      const Vector3 along = wide.inverse_mass * (force - w.inertia.b.transpose() * own);
      Eigen::Map<Vector3>{x}.noalias() = body.rotation.transpose() * along;
      Eigen::Map<Vector3>{x + 3}.noalias() = w.rotation.transpose() * own;
      spin += own;
      way += along;
      break;
    }
    case JointType::Fixed: break;
  }
}

}  // namespace breve::articulated
