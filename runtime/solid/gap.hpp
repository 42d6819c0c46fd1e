// The space between two convex solids: the working types of the narrow phase, behind contact.hpp.
#pragma once

#include "runtime/solid/polyhedron.hpp"

namespace breve {

// Closer than this fraction of the sizes, the direction between closest points loses digits to cancellation; the
// normal of the facing features keeps them all.
constexpr double kClose = 1e-5;
constexpr double kAgree = 1e-14;  // round-off of either, relative to the sizes

/// A solid at a pose: a polyhedron, or a ball if `solid` is null.
struct Placed {
  const Polyhedron* solid = nullptr;
  double radius = 0;  // of the ball; of the bounding sphere otherwise
  Vector3 location = Vector3::Zero();
  Matrix3 rotation = Matrix3::Identity();
  bool flat = false;   // a triangle of a surface: `solid` has its two sides
  bool outer = false;  // a triangle of a surface that bounds a solid: the way out of an overlap is outward

  Vector3 vertex(int index) const { return location + rotation * solid->vertices[static_cast<std::size_t>(index)]; }
  /// The vertex farthest along `direction` (world); of equals the first.
  int support(const Vector3& direction) const;
  /// max over the solid of direction . p
  double reach(const Vector3& direction) const;
};

/// `normal` has unit length and points from b toward a; `distance` < 0 is an overlap. `edge_a` and `edge_b` are the
/// edges that face one another, or zero if other features do; if the solids are apart they run from `start_a`,
/// `start_b`.
struct Gap {
  Vector3 on_a = Vector3::Zero(), on_b = Vector3::Zero();
  Vector3 normal = Vector3::UnitY();
  double distance = 0;
  Vector3 edge_a = Vector3::Zero(), edge_b = Vector3::Zero();
  Vector3 start_a = Vector3::Zero(), start_b = Vector3::Zero();
};

/// Distance of two polyhedra that are apart. False if they touch or overlap: `gap` is then not written.
bool separated(const Placed& a, const Placed& b, Gap& gap);

/// The face of `a` over which `b` is highest, or least deep: a separation along its normal.
struct FaceAxis {
  double distance;
  int face;
};
FaceAxis best_face(const Placed& a, const Placed& b);

/// The two edges whose product separates better than `to_beat`; false if none does. `normal` from b toward a.
/// Exact for an overlap and for gaps up to 1e-4 of the sizes; a lower bound beyond.
struct EdgeAxis {
  double distance;
  int edge_a = -1, edge_b = -1;
  Vector3 normal = Vector3::UnitY();
};
bool best_edges(const Placed& a, const Placed& b, double to_beat, EdgeAxis& best);

/// The axis on which two polyhedra are farthest apart or overlap least. Fills normal, distance and edges only; the
/// distance is exact for an overlap and a lower bound otherwise.
Gap best_axis(const Placed& a, const Placed& b);

/// A ball (a) and a polyhedron (b), and the same for two balls.
Gap ball_gap(const Placed& ball, const Placed& b);
Gap balls_gap(const Placed& a, const Placed& b);

/// Fill in the deepest points of an overlap along the normal that `gap` has.
void place_witnesses(const Placed& a, const Placed& b, Gap& gap);

/// The same with the roles of a and b exchanged.
Gap flipped(const Gap& gap);

/// Any two solids of which at most one is flat, dispatched to the above. Exact to some 1e-15 of the sizes.
Gap find_gap(const Placed& a, const Placed& b);

}  // namespace breve
