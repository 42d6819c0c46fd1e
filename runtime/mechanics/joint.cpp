// What descriptions of joints must be, in space and in a flat world alike.
#include "runtime/mechanics/joint.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "runtime/base/error.hpp"

namespace breve {

namespace {

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorCode::Argument, what); }

void need_finite(const Vector3& value, std::string_view what) {
  if (!value.allFinite())
    refuse(fmt::format("{} must be finite, but is ({}, {}, {})", what, value.x(), value.y(), value.z()));
}

void need_finite(double value, std::string_view what) {
  if (!std::isfinite(value)) refuse(fmt::format("{} must be finite, but is {}", what, value));
}

void need_positive(double value, std::string_view what) {
  if (!std::isfinite(value) || value < 0) refuse(fmt::format("{} must be finite and >= 0, but is {}", what, value));
}

bool acceptable(const JointDrive& drive, int axes) {
  const auto positive = [](double value) { return std::isfinite(value) && value >= 0; };
  bool good = drive.motor_speed.allFinite() && drive.force.allFinite() && drive.rest.allFinite() &&
              std::isfinite(drive.double_strength) && std::isfinite(drive.double_max) &&
              std::isfinite(drive.double_min) && positive(drive.damping) && positive(drive.stiffness) &&
              !std::isnan(drive.strength_limit) && drive.limit_restitution >= 0 && drive.limit_restitution <= 1;
  for (int i = 0; i < axes; ++i) good = good && drive.low[i] <= drive.high[i];
  return good;
}

/// Why it is not: apart, since words take memory and drives are set in every step.
void explain(const JointDrive& drive, JointKind kind) {
  const auto what = [&](std::string_view property) { return fmt::format("{} joint: {}", name_of(kind), property); };
  need_finite(drive.motor_speed, what("joint velocity"));
  need_finite(drive.force, what("joint force or torque"));
  need_finite(drive.rest, what("rest of the spring"));
  need_finite(drive.double_strength, what("strength of the double spring"));
  need_finite(drive.double_max, what("max of the double spring"));
  need_finite(drive.double_min, what("min of the double spring"));
  need_positive(drive.damping, what("damping"));
  need_positive(drive.stiffness, what("stiffness"));
  if (std::isnan(drive.strength_limit)) refuse(what("strength limit") + " must be a number");
  if (!(drive.limit_restitution >= 0 && drive.limit_restitution <= 1))
    refuse(fmt::format("{} must be from 0 to 1, but is {}", what("restitution of limits"), drive.limit_restitution));
  for (int i = 0; i < axis_count(kind); ++i)
    if (!(drive.low[i] <= drive.high[i]))
      refuse(fmt::format("{} of axis {}: the minimum {} is above the maximum {}", what("limits"), i + 1, drive.low[i],
                         drive.high[i]));
}

}  // namespace

void check(const JointDescription& is, const Bodies& bodies) {
  if (static_cast<int>(is.kind) > static_cast<int>(JointKind::Ball)) refuse("unknown kind of joint");
  const std::string_view kind = name_of(is.kind);
  if (!bodies.used(is.child)) refuse(fmt::format("{} joint: the child is not a body in the world", kind));
  if (bodies.kind(is.child) == BodyKind::Stationary)
    refuse(fmt::format("{} joint: the child is Stationary; make it the parent", kind));
  if (is.parent != kNoBody && !bodies.used(is.parent))
    refuse(fmt::format("{} joint: the parent is not a body in the world", kind));
  if (is.parent == is.child) refuse(fmt::format("{} joint: parent and child are the same body", kind));
  need_finite(is.parent_point, fmt::format("{} joint: the parent's point", kind));
  need_finite(is.child_point, fmt::format("{} joint: the child's point", kind));
  const double norm = is.relative_rotation.norm();
  if (!std::isfinite(norm) || !(norm > 0))
    refuse(fmt::format("{} joint: the relative rotation must be a finite quaternion that is not zero", kind));
  if (is.kind == JointKind::Fixed) return;
  need_finite(is.normal, fmt::format("{} joint: the normal", kind));
  need_finite(is.other_axis, fmt::format("{} joint: the other axis", kind));
  const double length = is.normal.stableNorm();
  if (!(length > 0) || !std::isfinite(length))
    refuse(fmt::format("{} joint: the normal ({}, {}, {}) has no direction", kind, is.normal.x(), is.normal.y(),
                       is.normal.z()));
}

void check_reach(const JointDescription& is) {
  constexpr double kFarthest = 1e15;  // m
  for (const auto& [point, owner] : {std::pair{&is.parent_point, "parent"}, {&is.child_point, "child"}})
    if (!(point->cwiseAbs().maxCoeff() <= kFarthest))
      refuse(fmt::format("{} joint: the {}'s point is ({}, {}, {}), which is farther away than {:g} m",
                         name_of(is.kind), owner, point->x(), point->y(), point->z(), kFarthest));
}

void check(const JointDrive& drive, JointKind kind) {
  if (!acceptable(drive, axis_count(kind))) explain(drive, kind);
}

bool has_limits(const JointDrive& drive, JointKind kind) {
  for (int i = 0; i < axis_count(kind); ++i)
    if (std::isfinite(drive.low[i]) || std::isfinite(drive.high[i])) return true;
  return false;
}

Pose pose_at_zero(const JointDescription& is, const Pose& parent) {
  Pose child;
  child.orientation = (parent.orientation * is.relative_rotation).normalized();
  child.location = parent.location + parent.orientation * is.parent_point - child.orientation * is.child_point;
  return child;
}

}  // namespace breve
