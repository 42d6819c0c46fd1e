// A joint at positions p1, p2, p3 has R_child = R_parent E relative_rotation, where the excursion E rotates by -p1, -p2
// and -p3 about its axes.
#include "runtime/mechanics/joint_axes.hpp"

#include <algorithm>
#include <cmath>

namespace breve {

Quaternion rotation_about(const Vector3& axis, double angle) { return Quaternion(Eigen::AngleAxisd(angle, axis)); }

double angle_about(const Quaternion& rotation, const Vector3& axis) {
  const double along = rotation.vec().dot(axis);
  // Half a revolution about an axis across this one: round-off has no angle.
  constexpr double kNone = 1e-12;
  if (std::hypot(along, rotation.w()) < kNone) return 0;
  return 2 * std::atan2(rotation.w() < 0 ? -along : along, std::abs(rotation.w()));
}

JointVector euler_angles(const JointAxes& axes, const Quaternion& rotation) {
  Eigen::Matrix3d basis;
  basis << axes.first, axes.second, axes.third;
  const Eigen::Matrix3d e = basis.transpose() * rotation.toRotationMatrix() * basis;
  return {std::atan2(e(1, 2), e(2, 2)), -std::asin(std::clamp(e(0, 2), -1.0, 1.0)), std::atan2(e(0, 1), e(0, 0))};
}

JointAxes axes_of(const JointDescription& is) {
  JointAxes axes;
  axes.first = is.normal;
  const bool given = is.other_axis != Vector3::Zero();
  const Vector3 from = given ? is.other_axis : is.parent_point;
  // The direction across the normal nearest to it; any, if there is none.
  Vector3 across = from - from.dot(is.normal) * is.normal;
  constexpr double kNone = 1e-9;
  if (!(across.norm() > kNone * from.norm()) || !(across.norm() > 0)) across = is.normal.unitOrthogonal();
  across.stableNormalize();
  if (is.kind == JointKind::Universal && given) {
    axes.second = across;
    axes.third = is.normal.cross(across);
  } else {
    axes.third = across;
    axes.second = across.cross(is.normal);
  }
  return axes;
}

namespace {

/// The part of an excursion that the joint can make.
Quaternion allowed(const JointDescription& is, const Quaternion& excursion) {
  switch (is.kind) {
    case JointKind::Revolute: return rotation_about(is.normal, angle_about(excursion, is.normal));
    case JointKind::Universal: {
      const JointAxes axes = axes_of(is);
      // A joint carries its second axis only about the first, whatever its second angle is. Such an excursion is
      // allowed as it is; Euler's angles may be singular there.
      constexpr double kNone = 1e-9;
      if (std::abs(axes.first.dot(excursion * axes.second)) < kNone) return excursion;
      const JointVector angles = euler_angles(axes, excursion);
      return rotation_about(axes.first, -angles[0]) * rotation_about(axes.second, -angles[1]);
    }
    case JointKind::Ball: return excursion;
    case JointKind::Prismatic:
    case JointKind::Fixed: break;
  }
  return Quaternion::Identity();
}

}  // namespace

Quaternion relative_rotation_that_keeps(const JointDescription& is, const Quaternion& rotation) {
  const Quaternion excursion = rotation * is.relative_rotation.conjugate();
  const Quaternion kept = (allowed(is, excursion).conjugate() * rotation).normalized();
  constexpr double kRoundOff = 1e-9;  // rad
  return kept.angularDistance(is.relative_rotation) < kRoundOff ? is.relative_rotation : kept;
}

}  // namespace breve
