// Rows of Jacobians.
#include "runtime/dynamics/jacobians.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/articulated/joints.hpp"
#include "runtime/dynamics/joint_frames.hpp"

namespace breve {

void add_point_row(const Tree& tree, int link, const Vector3& point, const Vector3& axis, bool angular, double sign,
                   double* j) {
  using articulated::JointType;
  for (int i = link; i >= 0; i = tree.model.body(i).parent) {
    const articulated::Body& body = tree.model.body(i);
    const articulated::Work& work = tree.data.of(i);
    const Vector3 linear = angular ? Vector3(Vector3::Zero()) : Vector3(sign * axis);
    const Vector3 rotation =
        angular ? Vector3(sign * axis) : Vector3((point - tree.data.motion_of(i).origin).cross(linear));
    double* at = j + body.v;
    // A push along the axis rotates nothing: round-off there, taken for a lever, would rotate it without bound.
    constexpr double kRoundOff = 1e-13;
    switch (body.type) {
      case JointType::Revolute: {
        const double lever = work.axis.dot(rotation);
        const Vector3& origin = tree.data.motion_of(i).origin;
        if (angular || std::abs(lever) > kRoundOff * (point - origin).lpNorm<1>()) at[0] += lever;
        break;
      }
      case JointType::Prismatic: at[0] += work.axis.dot(linear); break;
      case JointType::Universal:
        at[0] += work.axis.dot(rotation);
        at[1] += tree.data.wide_of(body).axis2.dot(rotation);
        break;
      case JointType::Ball: Eigen::Map<Vector3>{at} += work.rotation.transpose() * rotation; break;
      case JointType::Free:
        Eigen::Map<Vector3>{at} += body.rotation.transpose() * linear;
        Eigen::Map<Vector3>{at + 3} += work.rotation.transpose() * rotation;
        break;
      case JointType::Fixed: break;
    }
  }
}

namespace {

/// What a row's column would be by itself if nothing cancelled: arms for what rotates, 1 for what slides.
double natural_size(const Tree& tree, int link, const LoopRow& row, int column) {
  using articulated::JointType;
  const JointType type = tree.model.body(link).type;
  if (row.angular || type == JointType::Prismatic || (type == JointType::Free && column < 3)) return 1;
  const Vector3& origin = tree.data.motion_of(link).origin;
  return std::max((row.on_child - origin).norm(), (row.on_parent - origin).norm());
}

}  // namespace

void fill_loop_row(const Tree& tree, const LoopRows& loop, const LoopRow& row, double* j) {
  constexpr double kRoundOff = 1e-9;  // of the natural size; arms far from the world's origin have fewer digits
  const int n = tree.model.velocities();
  std::fill(j, j + n, 0.0);
  if (loop.child >= 0) add_point_row(tree, loop.child, row.on_child, row.axis, row.angular, 1, j);
  if (loop.parent >= 0) add_point_row(tree, loop.parent, row.on_parent, row.axis, row.angular, -1, j);
  for (int i = 0; i < tree.model.size(); ++i) {
    const articulated::Body& body = tree.model.body(i);
    for (int k = 0; k < articulated::velocity_count(body.type); ++k)
      if (std::abs(j[body.v + k]) > kRoundOff * natural_size(tree, i, row, k)) return;
  }
  std::fill(j, j + n, 0.0);
}

void fill_limit_row(const Tree& tree, const JointEntry& joint, int axis, double sign, double* j) {
  std::fill(j, j + tree.model.velocities(), 0.0);
  const articulated::Body& body = tree.model.body(joint.link);
  const Vector3 rates = joint_velocity_row(joint.is, joint.flipped, tree.state.q.data() + body.q, axis);
  for (int k = 0; k < articulated::velocity_count(body.type); ++k) j[body.v + k] = sign * rates[k];
}

}  // namespace breve
