// Points of round bodies are found again by the normal, and those between two bodies by their curvatures.
#include "runtime/dynamics/carried_point.hpp"

#include <cmath>
#include <optional>

#include "runtime/contact/impact_law.hpp"

namespace breve::island {

namespace {

/// The axis of a round body, unit vectors: where the body was, and where it is.
struct Axis {
  Vector3 from, to;
};

Axis axis_of(const Shape& shape, const Pose& from, const Pose& to) {
  const Vector3 own = Vector3::Unit(shape.round().axis);
  return {from.orientation * own, to.orientation * own};
}

Vector3 shortest(const Axis& axis, const Vector3& arm) { return Quaternion::FromTwoVectors(axis.from, axis.to) * arm; }

/// A capsule's point lies its radius from the axis, along the normal.
std::optional<Vector3> on_capsule(const Round& round, const Axis& axis, const Vector3& normal, const Vector3& arm) {
  constexpr double kOff = 1e-3;  // of the radius: it touches elsewhere, as with its side at a corner
  const Vector3 out = std::copysign(round.radius, arm.dot(normal)) * normal, core = arm - out;
  const double along = core.dot(axis.from);
  if ((core - along * axis.from).norm() > kOff * round.radius) return std::nullopt;
  return along * axis.to + out;
}

/// A cylinder's lies on its rim, or on its side, where the plane of the axis and the normal cuts it.
std::optional<Vector3> on_cylinder(const Axis& axis, const Vector3& normal, const Vector3& arm) {
  constexpr double kFlat = 1e-2;   // rad: it stands on its cap
  constexpr double kBeside = 0.1;  // of the distance from the axis, off that plane: it touches elsewhere
  const Vector3 n = std::copysign(1.0, arm.dot(normal)) * normal;
  const Vector3 before = n - n.dot(axis.from) * axis.from, after = n - n.dot(axis.to) * axis.to;
  const double sine = before.norm(), sine_after = after.norm();
  if (!(sine > kFlat && sine_after > kFlat)) return std::nullopt;
  const double along = arm.dot(axis.from), out = arm.dot(before) / sine;
  const Vector3 beside = axis.from.cross(before) / sine;
  const double off = arm.dot(beside);
  if (!(std::abs(off) < kBeside * out)) return std::nullopt;
  return along * axis.to + (out * after + off * axis.to.cross(after)) / sine_after;
}

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;
using Tangents = Eigen::Matrix<double, 3, 2>;

constexpr double kSharp = 1e6;  // the curvature of an edge, relative to that of the whole body

/// 1/m, of the surface of a body that is round about `axis`, in the tangent plane at an arm from its origin.
Matrix2 curvature(const Round& round, const Vector3& axis, const Vector3& normal, const Vector3& arm,
                  const Tangents& plane) {
  constexpr double kFlat = 1e-2;  // rad: it touches with its side, or a cap
  const double lean = std::abs(normal.dot(axis)), sine = std::sqrt(std::max(0.0, 1 - lean * lean));
  if (round.is_capsule() && std::abs(arm.dot(axis) - round.radius * normal.dot(axis)) >= round.half)
    return Matrix2::Identity() / round.radius;
  if (sine < kFlat) return Matrix2::Zero();
  const Vector2 around = plane.transpose() * axis.cross(normal) / sine;
  Matrix2 all = (sine / round.radius) * around * around.transpose();
  if (round.is_cylinder() && lean > kFlat) {
    const Vector2 across(-around.y(), around.x());
    all += (kSharp / round.radius) * across * across.transpose();
  }
  return all;
}

/// The same of a body with faces: none within one, much across an edge, much in both directions at a corner. Surfaces
/// count as flat.
Matrix2 curvature(const Shape& shape, const Vector3& arm, const Quaternion& orientation, const Tangents& plane) {
  constexpr double kOn = 1e-3;     // of the radius: the point lies on a face
  constexpr double kFacing = 0.1;  // rad: a face that points along the normal
  const double radius = shape.bounding_radius();
  const Vector3 own = orientation.conjugate() * arm;
  Matrix2 all = Matrix2::Zero();
  if (shape.surface()) return all;
  for (const Plane& face : shape.polyhedron().planes) {
    if (std::abs(face.normal.dot(own) - face.offset) > kOn * radius) continue;
    const Vector2 side = plane.transpose() * (orientation * face.normal);
    if (side.squaredNorm() > kFacing * kFacing) all += side.normalized() * side.normalized().transpose();
  }
  return (kSharp / radius) * all;
}

Matrix2 curvature(const Carrier& one, const Vector3& normal, const Tangents& plane) {
  if (!is_round(one.shape)) return curvature(one.shape, one.taken - one.to.location, one.to.orientation, plane);
  if (one.shape.kind() == ShapeKind::Sphere) return Matrix2::Identity() / one.shape.radius();
  const Round& round = one.shape.round();
  const Vector3 axis = one.to.orientation * Vector3::Unit(round.axis), arm = one.taken - one.to.location;
  return curvature(round, axis, std::copysign(1.0, arm.dot(normal)) * normal, arm, plane);
}

}  // namespace

bool is_round(const Shape& shape) { return shape.kind() == ShapeKind::Sphere || shape.round().is_round(); }

Vector3 carried_by(const Shape& shape, const Vector3& point, const Pose& from, const Pose& to) {
  const Vector3 arm = point - from.location;
  if (!is_round(shape)) return to.location + to.orientation * (from.orientation.conjugate() * arm);
  if (shape.kind() == ShapeKind::Sphere) return point + to.location - from.location;
  return to.location + shortest(axis_of(shape, from, to), arm);
}

Vector3 carried_by(const Shape& shape, const Vector3& point, const Vector3& normal, const Pose& from, const Pose& to) {
  const Round& round = shape.round();
  if (!round.is_round()) return carried_by(shape, point, from, to);
  const Vector3 arm = point - from.location;
  const Axis axis = axis_of(shape, from, to);
  const std::optional<Vector3> found =
      round.is_capsule() ? on_capsule(round, axis, normal, arm) : on_cylinder(axis, normal, arm);
  return to.location + found.value_or(shortest(axis, arm));
}

Meeting carried_between(const Carrier& a, const Carrier& b, const Vector3& normal) {
  constexpr double kLeast = 1e-9;  // of the larger curvature: where both are flat, they meet in the middle
  Vector3 first, second;
  contact::tangents(normal, first, second);
  Tangents plane;
  plane << first, second;
  Matrix2 on_a = curvature(a, normal, plane), on_b = curvature(b, normal, plane);
  const double least = kLeast * (on_a.trace() + on_b.trace());
  const Vector3 apart = b.taken - a.taken, middle = 0.5 * (a.taken + b.taken);
  if (!(least > 0)) return {middle, normal};
  on_a.diagonal().array() += least;
  on_b.diagonal().array() += least;
  const Vector2 x = plane.transpose() * apart;
  // Edges that are nearly parallel cross anywhere: their point stays between where the two bodies took it.
  Vector2 on = (on_a + on_b).inverse() * (on_b * x);
  const double off = (on - 0.5 * x).norm(), most = 0.5 * x.norm();
  if (off > most) on = 0.5 * x + most / off * (on - 0.5 * x);
  const Vector3 point = middle + plane * (on - 0.5 * x);
  if (!is_round(a.shape) || !is_round(b.shape)) return {point, normal};
  // Rims that meet cross, and have the normal of both.
  constexpr double kRound = 1 + 1e-6;
  const Vector2 tilt = on_a * on;
  const bool rims = tilt.norm() * std::min(a.shape.radius(), b.shape.radius()) > kRound * x.norm();
  return {point, rims ? normal : Vector3((normal - plane * tilt).normalized())};
}

}  // namespace breve::island
