// Contact points of a convex solid on one triangle. What would catch on the seams between triangles is kept off: where
// neighbours are nearly coplanar or fold inward, a contact at their common edge gets the normal of the face.
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/solid/triangle.hpp"

namespace breve {

namespace {

/// Does the part of the triangle that is farthest along `direction` (its own frame) stand out of the surface? A vertex
/// does if one of its two edges here does; the whole face does not.
bool stands_out(const Facet& facet, const Vector3& direction, double tolerance) {
  std::array<double, 3> along{};
  for (std::size_t i = 0; i < 3; ++i) along[i] = direction.dot(facet.corner[i]);
  const double most = *std::max_element(along.begin(), along.end());
  unsigned far = 0;  // bit i: corner i
  for (unsigned i = 0; i < 3; ++i) {
    if (along[i] >= most - tolerance) far |= 1U << i;
  }
  const auto active = [&](unsigned edge) { return (facet.active >> edge & 1U) != 0; };
  if (far == 7) return false;
  for (unsigned e = 0; e < 3; ++e) {
    const unsigned both = 1U << e | 1U << (e + 1) % 3;
    if (far == both) return active(e);
  }
  for (unsigned v = 0; v < 3; ++v) {
    if (far == 1U << v) return active(v) || active((v + 2) % 3);
  }
  return false;
}

/// The triangle as a face that looks along `normal`, which is its own or the opposite one.
void place_triangle(const Placed& b, bool flipped, PlacedFace& out) {
  place_face(b, flipped ? 1 : 0, out);
  out.index = 0;
}

/// Ball: where a seam would rotate the normal a little, the plane of the face is what it touches.
bool ball_on_facet(const ConvexPair& pair, const Facet& facet, const Gap& gap, const Vector3& normal, Manifold& out) {
  out.normal = gap.normal;
  out.count = 1;
  out.points[0] = {gap.on_a, gap.on_b, gap.distance, kNearestPoint};
  const double tolerance = 1e-6 * pair.a.radius;
  if (normal.dot(gap.normal) > 1 - 1e-9 || stands_out(facet, pair.b.rotation.transpose() * gap.normal, tolerance)) {
    return true;
  }
  const double height = normal.dot(pair.a.location - gap.on_b) - pair.a.radius;
  // Where the plane is much nearer than the triangle, another facet is between.
  if (height >= pair.margin || height < gap.distance - pair.slack.preference) return false;
  const Vector3 on_a = pair.a.location - pair.a.radius * normal;
  out.normal = normal;
  out.points[0] = {on_a, on_a - height * normal, height, kNearestPoint};
  return true;
}

/// The face of a polyhedron that a triangle is highest over, as best_face; some other if none is as good as `worth`.
FaceAxis best_face_under(const Placed& a, const Placed& b, double worth) {
  const FaceTree& looks = a.solid->looks;
  if (looks.empty()) return best_face(a, b);
  const Matrix3 rotation = a.rotation.transpose() * b.rotation;
  const Vector3 shift = a.rotation.transpose() * (b.location - a.location);
  std::array<Vector3, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) corners[i] = shift + rotation * b.solid->vertices[i];
  FaceAxis best{-std::numeric_limits<double>::infinity(), 0};
  const double round_off = kAgree * (a.radius + b.radius + shift.norm());
  double least = worth - round_off;
  looks.search(
      least, [&](const FaceTree::Node& node) { return node.height(corners); },
      [&](std::uint32_t face) {
        const Plane& plane = a.solid->planes[face];
        const double distance =
            std::min({plane.normal.dot(corners[0]), plane.normal.dot(corners[1]), plane.normal.dot(corners[2])}) -
            plane.offset;
        const int number = static_cast<int>(face);
        if (!(distance > best.distance || (distance == best.distance && number < best.face))) return;
        best = {distance, number};
        least = std::max(distance, worth) - round_off;
      });
  return best;
}

/// By the face of the solid that is farthest from the triangle, if it is nearly as good an axis as the best.
bool face_of_solid(const ConvexPair& pair, const TriangleGap& gap, Manifold& out) {
  const double worth = gap.distance - pair.slack.preference;
  FaceAxis face = gap.face;
  if (face.face < 0)
    face = pair.a.round.is_round() ? best_face(pair.a, pair.b) : best_face_under(pair.a, pair.b, worth);
  if (face.distance < worth) return false;
  const Vector3 outward = face_normal(pair.a, face.face);
  if (outward.dot(gap.normal) > -0.99) return false;
  PlacedFace reference, incident;
  place_face(pair.a, face.face, reference);
  place_triangle(pair.b, outward.dot(pair.b.rotation * pair.b.solid->planes[0].normal) > 0, incident);
  return clip_faces(reference, incident, Owner::A, pair.margin, pair.slack.rim, out);
}

bool solid_on_facet(const ConvexPair& pair, const Facet& facet, TriangleGap& gap, const Vector3& normal, bool flipped,
                    Manifold& out) {
  const double plane = normal.dot(pair.b.vertex(0));
  const double height = -pair.a.reach(-normal) - plane;
  const double tolerance = 1e-6 * pair.a.radius;
  const bool out_standing = stands_out(facet, pair.b.rotation.transpose() * gap.normal, tolerance);
  if (!out_standing || height >= gap.distance - pair.slack.preference) {
    PlacedFace reference, incident;
    place_triangle(pair.b, flipped, reference);
    place_facing(pair.a, -normal, incident);
    const bool clipped = clip_faces(reference, incident, Owner::B, pair.margin, pair.slack.rim, out);
    // Much deeper than the shortest way out, which leads over a seam: the facet beyond has the contact. A solid that is
    // larger than the surface reaches far behind the plane of a facet that leans much.
    constexpr double kMuch = 0.9;  // cosine
    const bool leans = pair.a.radius > pair.b.radius && normal.dot(gap.normal) < kMuch &&
                       height < gap.distance - 2 * pair.slack.preference;
    const bool face = clipped && !leans && out.points[0].distance >= gap.distance - 2 * pair.slack.preference;
    if (face || !out_standing) return face;
  }
  if (face_of_solid(pair, gap, out)) return true;
  complete(pair.a, pair.b, gap);
  out.normal = gap.normal;
  out.count = 1;
  out.points[0] = {gap.on_a, gap.on_b, gap.distance, kNearestPoint};
  return true;
}

}  // namespace

bool facet_manifold(const ConvexPair& pair, const Facet& facet, bool& near, Manifold& out) {
  constexpr double kBehind = -1e-6;
  TriangleGap gap = triangle_distance(pair.a, pair.b, pair.margin);
  if (gap.distance >= pair.margin) return false;
  near = true;
  if (gap.back != 0) return false;
  Vector3 normal = pair.b.rotation * facet.normal;
  const bool flipped = !pair.b.outer && normal.dot(pair.a.location - pair.b.vertex(0)) < 0;
  if (flipped) normal = -normal;
  if (normal.dot(gap.normal) < kBehind) return false;  // the facet that looks this way has the contact
  const bool found = pair.a.solid == nullptr ? ball_on_facet(pair, facet, gap, normal, out)
                                             : solid_on_facet(pair, facet, gap, normal, flipped, out);
  if (!found) return false;
  for (int i = 0; i < out.count; ++i) {
    ContactPoint& point = out.points[at(i)];
    point.feature = feature_name(0x51, facet.index, point.feature);
  }
  return true;
}

void merge_manifold(const Manifold& more, double rim, Manifold& into) {
  std::array<ContactPoint, 2 * kMostPoints> all;
  int count = 0;
  const auto add = [&](ContactPoint point) {
    point.distance = into.normal.dot(point.on_a - point.on_b);
    for (int i = 0; i < count; ++i) {
      // Triangles that share a corner or an edge have the same points there.
      if ((all[at(i)].on_a - point.on_a).squaredNorm() > 100 * rim * rim) continue;
      if (point.distance < all[at(i)].distance - rim) all[at(i)] = point;
      return;
    }
    all[at(count++)] = point;
  };
  for (int i = 0; i < into.count; ++i) add(into.points[at(i)]);
  for (int i = 0; i < more.count; ++i) add(more.points[at(i)]);
  select_points({all.data(), at(count)}, rim, into);
}

}  // namespace breve
