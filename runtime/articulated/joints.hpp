// What each type of joint does in each pass of the algorithms. One switch a pass and link: types are known, so that the
// zeros and the symmetry of every case are used; nothing here is virtual or allocates.
#pragma once

#include <cmath>

#include "runtime/articulated/data.hpp"

namespace breve::articulated {

/// Rotation matrix of the quaternion at `q` (w,x,y,z). Orthogonal for any length but zero.
inline Matrix3 rotation_matrix(const double* q) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  const double s = 2 / (w * w + x * x + y * y + z * z);
  Matrix3 m;
  m << 1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),  //
      s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x),   //
      s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y);
  return m;
}

/// Rotation by the joint's first angle, in the parent's axes.
inline Matrix3 rotated(const Body& body, double angle) {
  return body.rotation + std::sin(angle) * body.rotation_sin + std::cos(angle) * body.rotation_cos;
}

/// From q: rotation, offset, axis.
inline void place(const Body& body, const Work& parent, const double* q, Work& w, WideWork& wide) {
  q += body.q;
  w.offset.noalias() = parent.rotation * body.position;
  switch (body.type) {
    case JointType::Revolute:
      w.rotation.noalias() = parent.rotation * rotated(body, q[0]);
      w.axis.noalias() = w.rotation * body.axis;
      break;
    case JointType::Prismatic:
      w.rotation.noalias() = parent.rotation * body.rotation;
      w.axis.noalias() = w.rotation * body.axis;
      w.offset += q[0] * w.axis;
      break;
    case JointType::Universal: {
      const Matrix3 first = parent.rotation * rotated(body, q[0]);
      w.axis.noalias() = first * body.axis;
      wide.axis2.noalias() = first * body.axis2;
      w.rotation.noalias() = first * Eigen::AngleAxisd(q[1], body.axis2).toRotationMatrix();
      break;
    }
    case JointType::Ball: {
      const Matrix3 frame = parent.rotation * body.rotation;
      w.rotation.noalias() = frame * rotation_matrix(q);
      break;
    }
    case JointType::Free:
      w.offset += body.rotation * Vector3(q[0], q[1], q[2]);
      w.rotation.noalias() = body.rotation * rotation_matrix(q + 3);
      break;
    case JointType::Fixed: w.rotation.noalias() = parent.rotation * body.rotation; break;
  }
}

/// The motion of a joint at rates `x` (nv), added to its link's rotational and its origin's linear motion.
inline void add_joint_motion(const Body& body, const Work& w, const WideWork& wide, const double* x, Vector3& spin,
                             Vector3& way) {
  x += body.v;
  switch (body.type) {
    case JointType::Revolute: spin += x[0] * w.axis; break;
    case JointType::Prismatic: way += x[0] * w.axis; break;
    case JointType::Universal: spin += x[0] * w.axis + x[1] * wide.axis2; break;
    case JointType::Ball: spin += w.rotation * Vector3(x[0], x[1], x[2]); break;
    case JointType::Free:
      way += body.rotation * Vector3(x[0], x[1], x[2]);
      spin += w.rotation * Vector3(x[3], x[4], x[5]);
      break;
    case JointType::Fixed: break;
  }
}

/// From v, after `place`: spin and the accelerations that come of motion alone.
inline void move(const Body& body, const Work& parent, const double* v, Work& w, const WideWork& wide) {
  v += body.v;
  const Vector3& spin = parent.spin;
  w.bias_acc = spin.cross(spin.cross(w.offset));
  switch (body.type) {
    case JointType::Revolute: {
      const Vector3 own = v[0] * w.axis;
      w.spin = spin + own;
      w.bias_alpha = spin.cross(own);
      break;
    }
    case JointType::Prismatic:
      w.spin = spin;
      w.bias_alpha.setZero();
      w.bias_acc += 2 * v[0] * spin.cross(w.axis);
      break;
    case JointType::Universal: {
      const Vector3 first = v[0] * w.axis, second = v[1] * wide.axis2;
      w.spin = spin + first + second;
      w.bias_alpha = spin.cross(first) + (spin + first).cross(second);
      break;
    }
    case JointType::Ball: {
      const Vector3 own = w.rotation * Vector3(v[0], v[1], v[2]);
      w.spin = spin + own;
      w.bias_alpha = spin.cross(own);
      break;
    }
    case JointType::Free:
      w.spin.noalias() = w.rotation * Vector3(v[3], v[4], v[5]);
      w.bias_alpha.setZero();
      break;
    case JointType::Fixed:
      w.spin = spin;
      w.bias_alpha.setZero();
      break;
  }
}

/// The part of a couple and a force at the link's origin that the joint does not take up, written to `tau` (nv).
inline void joint_force(const Body& body, const Work& w, const WideWork& wide, const Vector3& couple,
                        const Vector3& force, double* tau) {
  tau += body.v;
  switch (body.type) {
    case JointType::Revolute: tau[0] = w.axis.dot(couple); break;
    case JointType::Prismatic: tau[0] = w.axis.dot(force); break;
    case JointType::Universal:
      tau[0] = w.axis.dot(couple);
      tau[1] = wide.axis2.dot(couple);
      break;
    case JointType::Ball: Eigen::Map<Vector3>{tau}.noalias() = w.rotation.transpose() * couple; break;
    case JointType::Free:
      Eigen::Map<Vector3>{tau}.noalias() = body.rotation.transpose() * force;
      Eigen::Map<Vector3>{tau + 3}.noalias() = w.rotation.transpose() * couple;
      break;
    case JointType::Fixed: break;
  }
}

}  // namespace breve::articulated
