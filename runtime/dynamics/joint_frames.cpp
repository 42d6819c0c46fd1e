// One place for signs: the joint's position is positive when the parent goes along +axis relative to the child.
#include "runtime/dynamics/joint_frames.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "runtime/articulated/rotation.hpp"

namespace breve {

namespace {

using articulated::JointType;

Quaternion about(const Vector3& axis, double angle) { return Quaternion(Eigen::AngleAxisd(angle, axis)); }

/// Angle of the part of a rotation that is about `axis`, -pi to pi.
double angle_about(const Quaternion& rotation, const Vector3& axis) {
  const double along = rotation.vec().dot(axis);
  return 2 * std::atan2(rotation.w() < 0 ? -along : along, std::abs(rotation.w()));
}

double near(double angle, double last) {
  constexpr double kRevolution = 2 * 3.14159265358979323846;
  return angle + kRevolution * std::round((last - angle) / kRevolution);
}

/// E with R_child = R_parent E relative_rotation, of a joint at these positions.
Quaternion excursion(const JointDescription& is, const JointVector& position) {
  const JointAxes axes = axes_of(is);
  return about(axes.first, -position[0]) * about(axes.second, -position[1]) * about(axes.third, -position[2]);
}

/// Euler's angles of E, with signs of joint positions.
JointVector euler(const JointAxes& axes, const Quaternion& excursion) {
  Eigen::Matrix3d basis;
  basis << axes.first, axes.second, axes.third;
  const Eigen::Matrix3d e = basis.transpose() * excursion.toRotationMatrix() * basis;
  return {std::atan2(e(1, 2), e(2, 2)), -std::asin(std::clamp(e(0, 2), -1.0, 1.0)), std::atan2(e(0, 1), e(0, 0))};
}

Quaternion ball_excursion(const JointDescription& is, bool flipped, const double* q) {
  const Quaternion rotation(q[0], q[1], q[2], q[3]);
  return flipped ? rotation.conjugate() : is.relative_rotation * rotation * is.relative_rotation.conjugate();
}

/// Columns: rate of the child's spin relative to the parent, parent's frame, by each position's rate.
Eigen::Matrix3d ball_rates(const JointAxes& axes, const JointVector& position) {
  const Quaternion first = about(axes.first, -position[0]);
  const Quaternion second = first * about(axes.second, -position[1]);
  Eigen::Matrix3d rates;
  rates << -axes.first, -(first * axes.second), -(second * axes.third);
  return rates;
}

/// The model's ball velocity: spin of the tree's child relative to its parent in the child's axes, from the spin of the
/// joint's child relative to its parent in the joint's parent's axes; as a matrix.
Eigen::Matrix3d to_model(const JointDescription& is, bool flipped, const double* q) {
  if (flipped) return -Eigen::Matrix3d::Identity();  // the parent's spin relative to the child, in the parent's axes
  const Quaternion child = ball_excursion(is, false, q) * is.relative_rotation;
  return child.conjugate().toRotationMatrix();
}

}  // namespace

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

void describe_joint(const JointDescription& is, bool flipped, const Quaternion& outer, articulated::Link& link) {
  static constexpr JointType kTypes[] = {JointType::Revolute, JointType::Prismatic, JointType::Fixed,
                                         JointType::Universal, JointType::Ball};
  link.type = kTypes[static_cast<int>(is.kind)];
  const Quaternion back = is.relative_rotation.conjugate();
  link.rotation = (outer * (flipped ? back : is.relative_rotation)).normalized();
  if (is.kind == JointKind::Fixed) return;
  const JointAxes axes = axes_of(is);
  if (flipped) {
    link.axis = is.kind == JointKind::Universal ? axes.second : axes.first;
    link.axis2 = axes.first;
  } else {
    link.axis = -(back * axes.first);
    link.axis2 = -(back * axes.second);
  }
}

void read_joint(const JointDescription& is, bool flipped, const Quaternion& rotation, const Vector3& shift,
                const JointVector& last, double* q) {
  put_joint_position(is, flipped, joint_position_between(is, rotation, shift, last), q);
  if (is.kind != JointKind::Ball) return;
  const Quaternion excursion = rotation * is.relative_rotation.conjugate();
  const Quaternion model =
      flipped ? excursion.conjugate() : is.relative_rotation.conjugate() * excursion * is.relative_rotation;
  q[0] = model.w(), q[1] = model.x(), q[2] = model.y(), q[3] = model.z();
}

JointVector joint_position_between(const JointDescription& is, const Quaternion& rotation, const Vector3& shift,
                                   const JointVector& last) {
  const JointAxes axes = is.kind == JointKind::Fixed ? JointAxes{} : axes_of(is);
  const Quaternion excursion = rotation * is.relative_rotation.conjugate();
  switch (is.kind) {
    case JointKind::Revolute: return {near(-angle_about(excursion, axes.first), last[0]), 0, 0};
    case JointKind::Prismatic: return {-axes.first.dot(shift), 0, 0};
    case JointKind::Universal: {
      // E = Rot(first, -p0) Rot(second, -p1): the second axis is where E took it only by the first rotation.
      const Vector3 carried = excursion * axes.second;
      const Vector3 third = axes.first.cross(axes.second);
      const double first = -std::atan2(carried.dot(third), carried.dot(axes.second));
      const double second = -angle_about(about(axes.first, first) * excursion, axes.second);
      return {near(first, last[0]), near(second, last[1]), 0};
    }
    case JointKind::Ball: return euler(axes, excursion);
    case JointKind::Fixed: break;
  }
  return JointVector::Zero();
}

JointVector joint_position(const JointDescription& is, bool flipped, const double* q) {
  switch (is.kind) {
    case JointKind::Revolute:
    case JointKind::Prismatic: return {q[0], 0, 0};
    case JointKind::Universal: return flipped ? JointVector{q[1], q[0], 0} : JointVector{q[0], q[1], 0};
    case JointKind::Ball: return euler(axes_of(is), ball_excursion(is, flipped, q));
    case JointKind::Fixed: break;
  }
  return JointVector::Zero();
}

JointVector joint_velocity(const JointDescription& is, bool flipped, const double* q, const double* v) {
  switch (is.kind) {
    case JointKind::Revolute:
    case JointKind::Prismatic: return {v[0], 0, 0};
    case JointKind::Universal: return flipped ? JointVector{v[1], v[0], 0} : JointVector{v[0], v[1], 0};
    case JointKind::Ball: {
      const Vector3 spin = to_model(is, flipped, q).transpose() * Vector3(v[0], v[1], v[2]);
      const Eigen::Matrix3d rates = ball_rates(axes_of(is), joint_position(is, flipped, q));
      return rates.fullPivLu().solve(spin);
    }
    case JointKind::Fixed: break;
  }
  return JointVector::Zero();
}

void put_joint_position(const JointDescription& is, bool flipped, const JointVector& position, double* q) {
  switch (is.kind) {
    case JointKind::Revolute:
    case JointKind::Prismatic: q[0] = position[0]; break;
    case JointKind::Universal:
      q[0] = position[flipped ? 1 : 0];
      q[1] = position[flipped ? 0 : 1];
      break;
    case JointKind::Ball: {
      const Quaternion e = excursion(is, position);
      const Quaternion model = flipped ? e.conjugate() : is.relative_rotation.conjugate() * e * is.relative_rotation;
      q[0] = model.w(), q[1] = model.x(), q[2] = model.y(), q[3] = model.z();
      break;
    }
    case JointKind::Fixed: break;
  }
}

void put_ball(const JointDescription& is, bool flipped, const Quaternion& rotation, const Vector3& spin, double* q,
              double* v) {
  const Quaternion& rest = is.relative_rotation;
  const Quaternion model = flipped ? rotation.conjugate() : rest.conjugate() * rotation * rest;
  q[0] = model.w(), q[1] = model.x(), q[2] = model.y(), q[3] = model.z();
  Eigen::Map<Vector3>{v}.noalias() = to_model(is, flipped, q) * spin;
}

void put_joint_velocity(const JointDescription& is, bool flipped, const double* q, const JointVector& rate, double* v) {
  switch (is.kind) {
    case JointKind::Revolute:
    case JointKind::Prismatic: v[0] = rate[0]; break;
    case JointKind::Universal:
      v[0] = rate[flipped ? 1 : 0];
      v[1] = rate[flipped ? 0 : 1];
      break;
    case JointKind::Ball: {
      const Eigen::Matrix3d rates = ball_rates(axes_of(is), joint_position(is, flipped, q));
      Eigen::Map<Vector3>{v}.noalias() = to_model(is, flipped, q) * (rates * rate);
      break;
    }
    case JointKind::Fixed: break;
  }
}

Vector3 joint_deflection(JointKind kind, const double* from, const double* to) {
  if (kind == JointKind::Ball)
    return articulated::logarithm(Quaternion(from[0], from[1], from[2], from[3]).conjugate() *
                                  Quaternion(to[0], to[1], to[2], to[3]));
  Vector3 way = Vector3::Zero();
  for (int i = 0; i < axis_count(kind); ++i) way[i] = to[i] - from[i];
  return way;
}

void put_joint_force(const JointDescription& is, bool flipped, const double* q, const JointVector& f, double* tau) {
  switch (is.kind) {
    case JointKind::Revolute:
    case JointKind::Prismatic: tau[0] = f[0]; break;
    case JointKind::Universal:
      tau[0] = f[flipped ? 1 : 0];
      tau[1] = f[flipped ? 0 : 1];
      break;
    case JointKind::Ball: {
      // A couple about each of the three axes as they stand now, on the child along -axis; not the dual of the rates,
      // which would grow without bound near the singular angle.
      const Eigen::Matrix3d axes = ball_rates(axes_of(is), joint_position(is, flipped, q));
      Eigen::Map<Vector3>{tau}.noalias() = to_model(is, flipped, q) * (axes * f);
      break;
    }
    case JointKind::Fixed: break;
  }
}

}  // namespace breve
