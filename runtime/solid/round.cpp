// Closed forms of cylinders and capsules.
#include "runtime/solid/round.hpp"

#include <algorithm>
#include <numbers>

namespace breve {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr int kSides = 32;     // of the polygons that show one
constexpr int kRingsHalf = 6;  // of each round end of a capsule, its rim included

/// A point at `along` the axis and (u, w) across it. Right-handed for axes 1 and 2.
Vector3 point_about(int axis, double along, double u, double w) {
  return axis == 1 ? Vector3(u, along, w) : Vector3(u, -w, along);
}

void add_circle(const Round& round, double along, double radius, std::pmr::vector<Vector3>& out) {
  for (int i = 0; i < kSides; ++i) {
    const double angle = (i + 0.5) * 2 * std::numbers::pi / kSides;
    out.push_back(point_about(round.axis, along, radius * std::cos(angle), radius * std::sin(angle)));
  }
}

/// The part of `v` across the axis.
Vector3 across(const Round& round, const Vector3& v) {
  Vector3 part = v;
  part[round.axis] = 0;
  return part;
}

}  // namespace

Vector3 Round::extreme(const Vector3& direction) const {
  Vector3 point = core(direction);
  if (!is_capsule()) return point;
  const double length = direction.norm();
  if (length > 0) point += radius / length * direction;
  return point;
}

Vector3 Round::core(const Vector3& direction) const {
  Vector3 point = Vector3::Zero();
  if (is_cylinder()) {
    point = across(*this, direction);
    const double length = point.norm();
    if (length > 0) point *= radius / length;
  }
  point[axis] = direction[axis] >= 0 ? half : -half;
  return point;
}

Vector3 Round::middle(const Vector3& direction) const {
  constexpr double kFlat = 1e-9;
  Vector3 bent = direction;
  const double length = direction.norm();
  if (is_cylinder() && across(*this, bent).norm() < kFlat * length) bent = Vector3::Unit(axis) * direction[axis];
  Vector3 point = extreme(bent);
  if (std::abs(direction[axis]) < kFlat * length) point[axis] = 0;
  return point;
}

Moments moments(const Round& round) {
  const double r = round.radius, h = round.half, pi = std::numbers::pi;
  // The part between the ends is a cylinder; the two round ends are half balls, moved along the axis by h.
  const double cylinder = 2 * h * pi * r * r, ball = round.is_capsule() ? 4 * pi / 3 * r * r * r : 0;
  const double along = cylinder * h * h / 3 + ball * (r * r / 5 + h * h + 0.75 * h * r);
  const double across_axis = cylinder * r * r / 4 + ball * r * r / 5;
  Moments sum{cylinder + ball, Vector3::Zero(), Matrix3::Zero()};
  sum.second.diagonal().setConstant(across_axis);
  sum.second(round.axis, round.axis) = along;
  return sum;
}

void place_corners(const Round& round, std::pmr::vector<Vector3>& corners) {
  corners.clear();
  if (round.is_cylinder()) {
    add_circle(round, -round.half, round.radius, corners);
    add_circle(round, round.half, round.radius, corners);
    return;
  }
  const auto latitude = [](int i) { return i * std::numbers::pi / 2 / kRingsHalf; };
  for (int i = kRingsHalf - 1; i >= 0; --i)
    add_circle(round, -round.half - round.radius * std::sin(latitude(i)), round.radius * std::cos(latitude(i)),
               corners);
  for (int i = 0; i < kRingsHalf; ++i)
    add_circle(round, round.half + round.radius * std::sin(latitude(i)), round.radius * std::cos(latitude(i)), corners);
  corners.push_back(point_about(round.axis, -round.half - round.radius, 0, 0));
  corners.push_back(point_about(round.axis, round.half + round.radius, 0, 0));
}

Polyhedron make_polygons(const Round& round) {
  Polyhedron solid;
  place_corners(round, solid.vertices);
  const int rings = round.is_cylinder() ? 2 : 2 * kRingsHalf, top = (rings - 1) * kSides, low_pole = rings * kSides;
  std::pmr::vector<int> low_cap, high_cap;
  for (int i = 0; i < kSides; ++i) {
    const int next = (i + 1) % kSides;
    low_cap.push_back(i);
    high_cap.push_back(top + kSides - 1 - i);
    for (int ring = 0; ring + 1 < rings; ++ring) {
      const int here = ring * kSides, above = here + kSides;
      solid.faces.push_back({here + i, above + i, above + next, here + next});
    }
    if (round.is_cylinder()) continue;
    solid.faces.push_back({low_pole, i, next});
    solid.faces.push_back({low_pole + 1, top + next, top + i});
  }
  if (round.is_cylinder()) {
    solid.faces.push_back(low_cap);
    solid.faces.push_back(high_cap);
  }
  connect(solid);
  update_planes(solid);
  return solid;
}

double enter_ball(double radius, const Vector3& origin, const Vector3& direction) {
  const double a = direction.squaredNorm(), b = origin.dot(direction);
  const double c = (origin.norm() - radius) * (origin.norm() + radius);
  if (c <= 0) return 0;
  // |o x d|^2 = a |o|^2 - b^2 has no cancellation for rays that graze.
  const double discriminant = a * radius * radius - origin.cross(direction).squaredNorm();
  if (b >= 0 || discriminant < 0) return kNever;
  return c / (-b + std::sqrt(discriminant));
}

namespace {

/// When the ray is within `radius` of the axis: from the first to the second, which are infinite along the axis.
bool within_tube(const Round& round, const Vector3& origin, const Vector3& direction, double& first, double& last) {
  const Vector3 o = across(round, origin), d = across(round, direction);
  const double a = d.squaredNorm(), b = o.dot(d), c = (o.norm() - round.radius) * (o.norm() + round.radius);
  if (a == 0) {
    first = -kNever;
    last = kNever;
    return c <= 0;
  }
  const double discriminant = a * round.radius * round.radius - o.cross(d).squaredNorm();
  if (discriminant < 0) return false;
  // The root without cancellation, and the other from the product of both.
  const double far = b > 0 ? -b - std::sqrt(discriminant) : -b + std::sqrt(discriminant);
  const double one = far / a, other = far != 0 ? c / far : one;
  first = std::min(one, other);
  last = std::max(one, other);
  return true;
}

bool within_slab(const Round& round, const Vector3& origin, const Vector3& direction, double& first, double& last) {
  const double o = origin[round.axis], d = direction[round.axis];
  first = -kNever;
  last = kNever;
  if (d == 0) return std::abs(o) <= round.half;
  first = (-std::copysign(round.half, d) - o) / d;
  last = (std::copysign(round.half, d) - o) / d;
  return true;
}

}  // namespace

double enter(const Round& round, const Vector3& origin, const Vector3& direction) {
  double tube_first, tube_last, slab_first, slab_last, least = kNever;
  if (within_tube(round, origin, direction, tube_first, tube_last) &&
      within_slab(round, origin, direction, slab_first, slab_last)) {
    const double first = std::max({0.0, tube_first, slab_first}), last = std::min(tube_last, slab_last);
    if (first <= last) least = first;
  }
  if (!round.is_capsule()) return least;
  for (const double end : {-round.half, round.half})
    least = std::min(least, enter_ball(round.radius, origin - end * Vector3::Unit(round.axis), direction));
  return least;
}

Vector3 half_extent(const Round& round, const Matrix3& rotation) {
  Vector3 half;
  for (int i = 0; i < 3; ++i) {
    const Vector3 direction = rotation.row(i).transpose();
    half[i] = direction.dot(round.extreme(direction));
  }
  return half;
}

}  // namespace breve
