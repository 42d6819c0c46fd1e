// Overlap of two polyhedra by separating axes (Gottschalk 1996): the normals of faces, and the products of two edges
// whose arcs cross on the Gauss map (Gregorius 2013), for only those are faces of the Minkowski difference.
#include <cmath>
#include <limits>

#include "runtime/solid/gap.hpp"

namespace breve {

namespace {

// A product of edges must beat the faces by this much of the size: a face is the steadier normal.
constexpr double kEdgeHandicap = 1e-12;
// Below this sine the product of two edges is so uncertain that its separation is measured on the solids instead.
constexpr double kNearlyParallel = 1e-4;
constexpr double kParallel = 1e-12;

/// Best of the face normals of `a`, all in world axes. `outward` has a's normals; the gap's normal is its opposite.
void try_faces(const Placed& a, const Placed& b, bool flip, Gap& best) {
  for (const Plane& plane : a.solid->planes) {
    const Vector3 outward = a.rotation * plane.normal;
    const double distance = -b.reach(-outward) - (plane.offset + outward.dot(a.location));
    if (distance > best.distance) {
      best.distance = distance;
      best.normal = flip ? outward : Vector3(-outward);
    }
  }
}

/// Do the arcs of two edges cross on the Gauss map of a - b? Source: Gregorius 2013, "The separating axis test".
bool arcs_cross(const Plane& a1, const Plane& a2, const Vector3& edge_a, const Vector3& b1, const Vector3& b2,
                const Vector3& edge_b) {
  const double cba = b1.dot(edge_a), dba = b2.dot(edge_a);
  const double adc = -a1.normal.dot(edge_b), bdc = -a2.normal.dot(edge_b);
  return cba * dba < 0 && adc * bdc < 0 && cba * bdc > 0;
}

}  // namespace

Gap best_axis(const Placed& a, const Placed& b) {
  Gap best;
  best.distance = -std::numeric_limits<double>::infinity();
  try_faces(a, b, false, best);
  try_faces(b, a, true, best);

  // Edges in the frame of a.
  const Matrix3 turn = a.rotation.transpose() * b.rotation;
  const Vector3 shift = a.rotation.transpose() * (b.location - a.location);
  const Polyhedron &sa = *a.solid, &sb = *b.solid;
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  const double handicap = kEdgeHandicap * (a.radius + b.radius);
  double to_beat = best.distance + handicap;
  for (const Edge& eb : sb.edges) {
    const Vector3 start_b = shift + turn * sb.vertices[at(eb.a)];
    const Vector3 edge_b = shift + turn * sb.vertices[at(eb.b)] - start_b;
    const Vector3 b1 = turn * sb.planes[at(eb.left)].normal, b2 = turn * sb.planes[at(eb.right)].normal;
    for (const Edge& ea : sa.edges) {
      const Vector3 edge_a = sa.vertices[at(ea.b)] - sa.vertices[at(ea.a)];
      if (!arcs_cross(sa.planes[at(ea.left)], sa.planes[at(ea.right)], edge_a, b1, b2, edge_b)) continue;
      Vector3 outward = edge_a.cross(edge_b);
      const double length = outward.norm(), sides = edge_a.norm() * edge_b.norm();
      if (length <= kParallel * sides) continue;
      outward /= length;
      // The origin of a is inside a.
      if (outward.dot(sa.vertices[at(ea.a)]) < 0) outward = -outward;
      double distance = outward.dot(start_b - sa.vertices[at(ea.a)]);
      if (distance <= to_beat) continue;
      const Vector3 normal = -(a.rotation * outward);
      if (length < kNearlyParallel * sides) distance = -a.reach(-normal) - b.reach(normal);
      if (distance <= to_beat) continue;
      to_beat = distance;
      best.distance = distance;
      best.normal = normal;
      best.edge_a = a.rotation * edge_a;
      best.edge_b = a.rotation * edge_b;
    }
  }
  return best;
}

}  // namespace breve
