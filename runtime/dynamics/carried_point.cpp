// Points of round bodies are found again by the normal.
#include "runtime/dynamics/carried_point.hpp"

#include <cmath>
#include <optional>

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

}  // namespace breve::island
