// One place for signs: the joint's position is positive when the parent goes along +axis relative to the child.
#include "runtime/dynamics/joint_frames.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "runtime/articulated/rotation.hpp"

namespace breve {

namespace {

using articulated::JointType;

double near(double angle, double last) {
  constexpr double kRevolution = 2 * 3.14159265358979323846;
  return angle + kRevolution * std::round((last - angle) / kRevolution);
}

/// E with R_child = R_parent E relative_rotation, of a joint at these positions.
Quaternion excursion(const JointDescription& is, const JointVector& position) {
  const JointAxes axes = axes_of(is);
  return rotation_about(axes.first, -position[0]) * rotation_about(axes.second, -position[1]) *
         rotation_about(axes.third, -position[2]);
}

Quaternion ball_excursion(const JointDescription& is, bool flipped, const double* q) {
  const Quaternion rotation(q[0], q[1], q[2], q[3]);
  return flipped ? rotation.conjugate() : is.relative_rotation * rotation * is.relative_rotation.conjugate();
}

/// Columns: rate of the child's spin relative to the parent, parent's frame, by each position's rate.
Eigen::Matrix3d ball_rates(const JointAxes& axes, const JointVector& position) {
  const Quaternion first = rotation_about(axes.first, -position[0]);
  const Quaternion second = first * rotation_about(axes.second, -position[1]);
  Eigen::Matrix3d rates;
  rates << -axes.first, -(first * axes.second), -(second * axes.third);
  return rates;
}

// A volume of the three columns of rates below which their inverse is found with care: near the singular angle.
constexpr double kSingular = 1e-3;

/// A row of the inverse of rates, times their volume.
Vector3 dual(const Eigen::Matrix3d& rates, int axis) {
  return rates.col((axis + 1) % 3).cross(rates.col((axis + 2) % 3));
}

/// The model's ball velocity: spin of the tree's child relative to its parent in the child's axes, from the spin of the
/// joint's child relative to its parent in the joint's parent's axes; as a matrix.
Eigen::Matrix3d to_model(const JointDescription& is, bool flipped, const double* q) {
  if (flipped) return -Eigen::Matrix3d::Identity();  // the parent's spin relative to the child, in the parent's axes
  const Quaternion child = ball_excursion(is, false, q) * is.relative_rotation;
  return child.conjugate().toRotationMatrix();
}

}  // namespace

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
      const double second = -angle_about(rotation_about(axes.first, first) * excursion, axes.second);
      return {near(first, last[0]), near(second, last[1]), 0};
    }
    case JointKind::Ball: return euler_angles(axes, excursion);
    case JointKind::Fixed: break;
  }
  return JointVector::Zero();
}

JointVector joint_position(const JointDescription& is, bool flipped, const double* q) {
  switch (is.kind) {
    case JointKind::Revolute:
    case JointKind::Prismatic: return {q[0], 0, 0};
    case JointKind::Universal: return flipped ? JointVector{q[1], q[0], 0} : JointVector{q[0], q[1], 0};
    case JointKind::Ball: return euler_angles(axes_of(is), ball_excursion(is, flipped, q));
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
      const Vector3 first = dual(rates, 0);
      const double volume = first.dot(rates.col(0));
      if (!(std::abs(volume) > kSingular)) return rates.fullPivLu().solve(spin);
      return Vector3(first.dot(spin), dual(rates, 1).dot(spin), dual(rates, 2).dot(spin)) / volume;
    }
    case JointKind::Fixed: break;
  }
  return JointVector::Zero();
}

Vector3 joint_velocity_row(const JointDescription& is, bool flipped, const double* q, int axis) {
  if (is.kind != JointKind::Ball) return Vector3::Unit(is.kind == JointKind::Universal && flipped ? 1 - axis : axis);
  const Eigen::Matrix3d spins = to_model(is, flipped, q).transpose();
  const Eigen::Matrix3d rates = ball_rates(axes_of(is), joint_position(is, flipped, q));
  const Vector3 across = dual(rates, axis);
  const double volume = across.dot(rates.col(axis));
  if (std::abs(volume) > kSingular) return spins.transpose() * across / volume;
  const auto careful = rates.fullPivLu();
  Vector3 row;
  for (int k = 0; k < 3; ++k) row[k] = careful.solve(spins.col(k))[axis];
  return row;
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
