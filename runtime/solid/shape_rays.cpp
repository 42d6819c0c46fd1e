// Rays against shapes, and the point of a surface in a direction.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/base/error.hpp"
#include "runtime/solid/shape_geometry.hpp"

namespace breve {

namespace {

/// The farthest point of a surface on a ray from the origin; the origin itself if it meets none.
Vector3 last_point(const Surface& surface, double reach, const Vector3& unit) {
  const double beyond = 2 * reach;
  double t;
  Facet hit;
  if (!surface.raycast(beyond * unit, -unit, t, hit) || t > beyond) return Vector3::Zero();
  return (beyond - t) * unit;
}

}  // namespace

Vector3 Shape::point_on(const Vector3& direction) const {
  if (!direction.allFinite()) {
    throw Error(ErrorCode::Argument, fmt::format("a direction is {} (must be finite)", show(direction)));
  }
  const Vector3 unit = direction.stableNormalized();
  if (unit.squaredNorm() < 0.5) return Vector3::Zero();
  if (kind() == ShapeKind::Sphere) return radius() * unit;
  if (surface() != nullptr) return last_point(*surface(), bounding_radius(), unit);
  if (round().is_round()) {
    const double beyond = 2 * bounding_radius();  // the way back meets the surface, since the origin is inside
    return (beyond - enter(round(), beyond * unit, -unit)) * unit;
  }
  double distance = std::numeric_limits<double>::infinity();
  for (const Plane& plane : polyhedron().planes) {
    const double rise = plane.normal.dot(unit);
    if (rise > 0) distance = std::min(distance, plane.offset / rise);
  }
  return distance * unit;
}

namespace {

/// Where origin + t direction enters the intersection of half-spaces: t >= 0, or infinity (Cyrus and Beck, 1978).
double enter_planes(const std::pmr::vector<Plane>& planes, const Vector3& origin, const Vector3& direction) {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  double first = 0, last = kMiss;
  for (const Plane& plane : planes) {
    const double height = plane.normal.dot(origin) - plane.offset;
    const double rise = plane.normal.dot(direction);
    if (rise < 0) {
      first = std::max(first, height / -rise);
    } else if (rise > 0) {
      last = std::min(last, -height / rise);
    } else if (height > 0) {
      return kMiss;
    }
  }
  return first <= last ? first : kMiss;
}

}  // namespace

bool Shape::raycast(const Vector3& origin, const Vector3& direction, double& fraction) const {
  if (!origin.allFinite() || !direction.allFinite()) {
    throw Error(ErrorCode::Argument,
                fmt::format("a ray from {} along {} (must be finite)", show(origin), show(direction)));
  }
  if (surface() != nullptr) {
    Facet hit;
    if (!surface()->inside(origin)) return surface()->raycast(origin, direction, fraction, hit);
    fraction = 0;
    return true;
  }
  const double t = kind() == ShapeKind::Sphere ? enter_ball(radius(), origin, direction)
                   : round().is_round()        ? enter(round(), origin, direction)
                                               : enter_planes(polyhedron().planes, origin, direction);
  if (!std::isfinite(t)) return false;
  fraction = t;
  return true;
}

}  // namespace breve
