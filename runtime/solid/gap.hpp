// The space between two convex solids: the working types of the narrow phase, behind contact.hpp.
#pragma once

#include "runtime/solid/polyhedron.hpp"

namespace breve {

/// A solid at a pose: a polyhedron, or a ball if `solid` is null.
struct Placed {
  const Polyhedron* solid = nullptr;
  double radius = 0;  // of the ball; of the bounding sphere otherwise
  Vector3 location = Vector3::Zero();
  Matrix3 rotation = Matrix3::Identity();

  Vector3 vertex(int index) const { return location + rotation * solid->vertices[static_cast<std::size_t>(index)]; }
  /// The vertex farthest along `direction` (world); of equals the first.
  int support(const Vector3& direction) const;
  /// max over the solid of direction . p
  double reach(const Vector3& direction) const;
};

/// `normal` has unit length and points from b toward a; `distance` < 0 is an overlap. `edge_a` and `edge_b` are the
/// edges that face one another, or zero if other features do.
struct Gap {
  Vector3 on_a = Vector3::Zero(), on_b = Vector3::Zero();
  Vector3 normal = Vector3::UnitY();
  double distance = 0;
  Vector3 edge_a = Vector3::Zero(), edge_b = Vector3::Zero();
};

/// Distance of two polyhedra that are apart. False if they touch or overlap: `gap` is then not written.
bool separated(const Placed& a, const Placed& b, Gap& gap);

/// The axis on which two polyhedra are farthest apart or overlap least. Fills normal, distance and edges only; the
/// distance is exact for an overlap and a lower bound otherwise.
Gap best_axis(const Placed& a, const Placed& b);

/// A ball (a) and a polyhedron (b), and the same for two balls.
Gap ball_gap(const Placed& ball, const Placed& b);
Gap balls_gap(const Placed& a, const Placed& b);

/// Any two solids, dispatched to the above. Exact to some 1e-15 of the sizes.
Gap find_gap(const Placed& a, const Placed& b);

}  // namespace breve
