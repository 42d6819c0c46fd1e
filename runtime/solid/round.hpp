// Solids of revolution: cylinders and capsules, exact. Their properties in the own frame, behind shape.hpp.
#pragma once

#include <cmath>
#include <limits>

#include "runtime/solid/polyhedron.hpp"

namespace breve {

enum class RoundKind : std::uint8_t { None, Cylinder, Capsule };

/// About the axis of number `axis` through the origin. `half`: from the origin to a cap's centre, or to the centre of a
/// capsule's round end.
struct Round {
  RoundKind kind = RoundKind::None;
  int axis = 1;
  double radius = 0, half = 0;

  bool is_round() const { return kind != RoundKind::None; }
  bool is_cylinder() const { return kind == RoundKind::Cylinder; }
  bool is_capsule() const { return kind == RoundKind::Capsule; }
  /// The point that is farthest along `direction`, which need not be a unit vector; of a line or cap an end or its
  /// middle.
  Vector3 extreme(const Vector3& direction) const;
  /// The same, but the middle of a line or cap that is within 1e-9 of being farthest as a whole.
  Vector3 middle(const Vector3& direction) const;
  /// The same of the core: a capsule's axis without its radius; a cylinder as it is.
  Vector3 core(const Vector3& direction) const;
  /// What the core leaves out all around.
  double margin() const { return is_capsule() ? radius : 0; }
};

/// Moments at density 1.
Moments moments(const Round& round);
/// The polygons that show one, and stand for it where an approximate normal will do; corners lie on the surface.
Polyhedron make_polygons(const Round& round);
/// New corners for the same polygons.
void place_corners(const Round& round, std::pmr::vector<Vector3>& corners);
/// Where origin + t direction enters: t >= 0, or infinity.
double enter(const Round& round, const Vector3& origin, const Vector3& direction);
/// Half the edges of the box about the origin that holds it once it is rotated.
Vector3 half_extent(const Round& round, const Matrix3& rotation);

/// Where origin + t direction enters a ball about the origin: t >= 0, or infinity.
double enter_ball(double radius, const Vector3& origin, const Vector3& direction);

}  // namespace breve
