// The space between two convex solids: the working types of the narrow phase, behind contact.hpp.
#pragma once

#include <limits>
#include <optional>

#include "runtime/solid/polyhedron.hpp"
#include "runtime/solid/round.hpp"

namespace breve {

// Closer than this fraction of the sizes, the direction between closest points loses digits to cancellation; the
// normal of the facing features keeps them all.
constexpr double kClose = 1e-5;
constexpr double kAgree = 1e-14;  // round-off of either, relative to the sizes

/// What earlier triangles showed about a solid.
struct TriangleHints {
  Vector3 apart = Vector3::Zero();  // the direction that told the last one apart, in the solid's frame
  std::optional<bool> planar{};     // are all faces flat to round-off? Once somebody wanted to know
};

/// A solid at a pose: a ball if `solid` is null, a cylinder or capsule if `round` is one (`solid` then is the polygons
/// that show it), else a polyhedron.
struct Placed {
  const Polyhedron* solid = nullptr;
  double radius = 0;  // of the ball; of the bounding sphere otherwise
  Vector3 location = Vector3::Zero();
  Matrix3 rotation = Matrix3::Identity();
  bool flat = false;   // a triangle of a surface: `solid` has its two sides
  bool outer = false;  // a triangle of a surface that bounds a solid: the way out of an overlap is outward
  Round round{};
  mutable int last = 0;            // vertex that was found last: the next search begins there
  TriangleHints* hints = nullptr;  // of who measures triangles, one after the other; may be null

  Vector3 vertex(int index) const { return location + rotation * solid->vertices[static_cast<std::size_t>(index)]; }
  /// The vertex of a polyhedron farthest along `direction` (world).
  int support(const Vector3& direction) const { return last = solid->farthest(rotation.transpose() * direction, last); }
  /// The point of a polyhedron, cylinder or capsule farthest along `direction`.
  Vector3 extreme(const Vector3& direction) const;
  /// The same; of a line or cap that is farthest as a whole its middle.
  Vector3 middle(const Vector3& direction) const;
  /// max over a polyhedron, cylinder or capsule of direction . p
  double reach(const Vector3& direction) const { return direction.dot(extreme(direction)); }
  Vector3 axis() const { return rotation.col(round.axis); }  // of a cylinder or capsule
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
  // If b is a triangle (Placed::outer) that is left backward, so that another has the contact: the distance of that
  // way, which is negative. Else 0.
  double back = 0;
};

/// Distance of two polyhedra or cylinders that are apart, or of the axes of capsules. False if they touch or overlap:
/// `gap` is then not written.
/// @param enough  once they are known to be farther apart than this, `gap` has only a distance, which is a lower bound
///                beyond it, and the normal along which it is one
bool separated(const Placed& a, const Placed& b, Gap& gap, double enough = std::numeric_limits<double>::infinity());

/// The face of `a` over which `b` is highest, or least deep: a separation along its normal. Minus infinity of a
/// capsule. `b` is no cylinder or capsule if `a` is a polyhedron.
struct FaceAxis {
  double distance;
  int face;
};
FaceAxis best_face(const Placed& a, const Placed& b);
/// A cylinder's faces are its caps: 0 at the lower end of the axis, 1 at the upper.
inline Vector3 cap_normal(const Placed& cylinder, int cap) {
  return cap == 1 ? cylinder.axis() : Vector3(-cylinder.axis());
}
/// The outward normal of a face of a polyhedron or cylinder, world.
inline Vector3 face_normal(const Placed& solid, int face) {
  if (solid.round.is_cylinder()) return cap_normal(solid, face);
  return solid.rotation * solid.solid->planes[at(face)].normal;
}

/// The two edges whose product separates better than `to_beat`; false if none does. `normal` from b toward a.
/// Exact for an overlap and for gaps up to 1e-4 of the sizes; a lower bound beyond.
/// @param apart  how far apart the solids are, <= 0 if they overlap: no axis separates better
struct EdgeAxis {
  double distance;
  int edge_a = -1, edge_b = -1;
  Vector3 normal = Vector3::UnitY();
};
bool best_edges(const Placed& a, const Placed& b, double to_beat, double apart, EdgeAxis& best);

/// The axis on which two polyhedra are farthest apart or overlap least. Fills normal, distance and edges only; the
/// distance is exact for an overlap and a lower bound otherwise. `apart` as for best_edges.
Gap best_axis(const Placed& a, const Placed& b, double apart);

/// A ball (a) and a polyhedron (b), and the same for two balls.
Gap ball_gap(const Placed& ball, const Placed& b);
Gap balls_gap(const Placed& a, const Placed& b);

/// Two solids of which one is a cylinder or capsule. Apart, the distance is exact to some 1e-14 of the sizes; an
/// overlap is left by the shortest way that is next to the one of the polygons that show both.
/// @param enough  as in `separated`
Gap round_gap(const Placed& a, const Placed& b, double enough = std::numeric_limits<double>::infinity());
/// The same of a cylinder or capsule (a) and a triangle; see triangle_gap.
Gap round_triangle_gap(const Placed& a, const Placed& b, double enough);

/// Fill in the deepest points of an overlap along the normal that `gap` has.
void place_witnesses(const Placed& a, const Placed& b, Gap& gap);

/// The same with the roles of a and b exchanged.
Gap flipped(const Gap& gap);

/// Any two solids of which at most one is flat, dispatched to the above. Exact to some 1e-15 of the sizes.
Gap find_gap(const Placed& a, const Placed& b);

}  // namespace breve
