// Two polyhedra: by their faces, by two edges, or by the exact nearest points, in this order of preference.
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/solid/pair.hpp"

namespace breve {

namespace {

// Edges count as parallel below this sine, and touch along a stretch then.
constexpr double kSideBySide = 0.02;

struct EdgeLine {
  Vector3 start, along;
};

EdgeLine line_of(const Placed& solid, int index) {
  const Edge& edge = solid.solid->edges[static_cast<std::size_t>(index)];
  const Vector3 start = solid.vertex(edge.a);
  return {start, solid.vertex(edge.b) - start};
}

ContactPoint point_between(const Vector3& on_a, const Vector3& on_b, const Vector3& normal, std::uint32_t feature) {
  return {on_a, on_b, normal.dot(on_a - on_b), feature};
}

/// The two ends of the stretch over which parallel edges run beside one another; false if they do not, or if neither
/// end is as near as `farthest`: the edges are then nearest elsewhere.
bool side_by_side(const EdgeLine& a, const EdgeLine& b, double farthest, std::uint32_t feature, Manifold& out) {
  const double square = a.along.squaredNorm();
  const double s0 = (b.start - a.start).dot(a.along) / square, s1 = s0 + b.along.dot(a.along) / square;
  const double low = std::max(0.0, std::min(s0, s1)), high = std::min(1.0, std::max(s0, s1));
  if (!(high > low)) return false;
  out.count = 2;
  for (int k = 0; k < 2; ++k) {
    const double s = k == 0 ? low : high;
    const Vector3 on_a = a.start + s * a.along, on_b = b.start + (s - s0) / (s1 - s0) * b.along;
    out.points[static_cast<std::size_t>(k)] =
        point_between(on_a, on_b, out.normal, feature_name(feature, static_cast<std::uint32_t>(k), 0));
  }
  if (out.points[1].distance < out.points[0].distance) std::swap(out.points[0], out.points[1]);
  return out.points[0].distance <= farthest;
}

/// One point where the gap is narrowest, or two if parallel edges face one another there.
bool gap_manifold(const ConvexPair& pair, const Gap& gap, Manifold& out) {
  pair.remember(gap.normal, kNearestPoint);
  if (gap.distance >= pair.margin) return false;
  out.normal = gap.normal;
  const double sides = gap.edge_a.norm() * gap.edge_b.norm();
  const bool sides_known = gap.distance > 0 || pair.a.round.is_round() || pair.b.round.is_round();
  if (sides_known && sides > 0 && gap.edge_a.cross(gap.edge_b).norm() < kSideBySide * sides &&
      side_by_side({gap.start_a, gap.edge_a}, {gap.start_b, gap.edge_b}, gap.distance + pair.slack.preference,
                   kNearestPoint, out)) {
    if (out.points[1].distance >= pair.margin) out.count = 1;
    return true;
  }
  out.count = 1;
  out.points[0] = {gap.on_a, gap.on_b, gap.distance, kNearestPoint};
  return true;
}

/// They overlap, or are less than a hair apart: the steadiest of the axes that separate nearly best.
bool overlap_manifold(const ConvexPair& pair, const FaceAxis& of_a, const FaceAxis& of_b, bool take_a, double apart,
                      Manifold& out) {
  const double face = take_a ? of_a.distance : of_b.distance, preference = pair.slack.preference;
  EdgeAxis edges;
  if (best_edges(pair.a, pair.b, face + preference, apart, edges)) {
    const std::uint32_t feature = kEdges | (feature_name(kEdges, static_cast<std::uint32_t>(edges.edge_a),
                                                         static_cast<std::uint32_t>(edges.edge_b)) &
                                            ~kEdges);
    pair.remember(edges.normal, feature);
    if (edges.distance >= pair.margin) return false;
    const EdgeLine a = line_of(pair.a, edges.edge_a), b = line_of(pair.b, edges.edge_b);
    return edge_manifold(a.start, a.along, b.start, b.along, edges.normal, edges.distance, preference, feature, out) ||
           nearest_manifold(pair, out);
  }
  if (face_manifold(pair, take_a ? Owner::A : Owner::B, take_a ? of_a.face : of_b.face, out) &&
      out.points[0].distance <= face + preference) {
    return true;
  }
  return nearest_manifold(pair, out);
}

/// The face of `own` that looks at the other along `toward`, and how far the other is over it; minus infinity if none
/// looks that way.
FaceAxis facing(const Placed& own, const Placed& other, const Vector3& toward) {
  constexpr double kFacing = 0.99;
  constexpr FaceAxis kNone{-std::numeric_limits<double>::infinity(), 0};
  if (own.round.is_capsule()) return kNone;
  const int face = own.round.is_cylinder() ? (toward.dot(own.axis()) > 0 ? 1 : 0) : face_along(own, toward);
  const Vector3 normal = face_normal(own, face);
  if (normal.dot(toward) < kFacing) return kNone;
  return {-other.reach(-normal) - own.reach(normal), face};
}

}  // namespace

bool round_manifold(const ConvexPair& pair, Manifold& out) {
  const Gap gap = round_gap(pair.a, pair.b);
  pair.remember(gap.normal, kNearestPoint);
  if (gap.distance >= pair.margin) return false;
  const FaceAxis of_a = facing(pair.a, pair.b, -gap.normal), of_b = facing(pair.b, pair.a, gap.normal);
  const double preference = pair.slack.preference;
  const bool a_first = pair.a.radius >= pair.b.radius;
  const bool take_a = of_a.distance + (a_first ? preference / 2 : 0) >= of_b.distance + (a_first ? 0 : preference / 2);
  const FaceAxis& face = take_a ? of_a : of_b;
  if (face.distance >= gap.distance - preference && face_manifold(pair, take_a ? Owner::A : Owner::B, face.face, out) &&
      out.points[0].distance <= gap.distance + preference) {
    return true;
  }
  return gap_manifold(pair, gap, out);
}

bool ConvexPair::apart_by_cache() const {
  if (cache == nullptr) return false;
  if (counters != nullptr) ++counters->pairs;
  if (cache->axis.isZero(0)) return false;
  if (counters != nullptr) ++counters->warm;
  if (cache->apart == 0) return false;
  const Vector3 n = a.rotation * cache->axis;
  // A hair more than round-off, so that the answer is the same as without the axis.
  const double hair = 1e-12 * (a.radius + b.radius);
  const double low_a = a.solid == nullptr ? -a.radius : -a.reach(-n);
  const double high_b = b.solid == nullptr ? n.dot(b.location) + b.radius : b.reach(n);
  if (low_a - high_b < margin + hair) return false;
  if (counters != nullptr) ++counters->separate;
  return true;
}

bool edge_manifold(const Vector3& start_a, const Vector3& edge_a, const Vector3& start_b, const Vector3& edge_b,
                   const Vector3& normal, double distance, double preference, std::uint32_t feature, Manifold& out) {
  out.normal = normal;
  const double aa = edge_a.squaredNorm(), bb = edge_b.squaredNorm(), ab = edge_a.dot(edge_b);
  const double square = aa * bb - ab * ab;
  if (square < kSideBySide * kSideBySide * aa * bb) {
    // Apart, their product is not a reliable axis: the nearest points decide.
    return distance <= 0 && side_by_side({start_a, edge_a}, {start_b, edge_b}, distance + preference, feature, out);
  }
  const Vector3 r = start_b - start_a;
  const double s = (bb * edge_a.dot(r) - ab * edge_b.dot(r)) / square;
  const double t = (ab * edge_a.dot(r) - aa * edge_b.dot(r)) / square;
  constexpr double kOver = 1e-9;  // of the length: round-off beyond the ends
  if (s < -kOver || s > 1 + kOver || t < -kOver || t > 1 + kOver) return false;
  out.count = 1;
  const Vector3 on_a = start_a + s * edge_a;
  out.points[0] = {on_a, on_a - distance * normal, distance, feature};
  return true;
}

bool face_manifold(const ConvexPair& pair, Owner owner, int index, Manifold& out) {
  const Placed &own = owner == Owner::A ? pair.a : pair.b, &other = owner == Owner::A ? pair.b : pair.a;
  PlacedFace reference, incident;
  place_face(own, index, reference);
  place_facing(other, -reference.normal, incident);
  return clip_faces(reference, incident, owner, pair.margin, pair.slack.rim, out);
}

bool nearest_manifold(const ConvexPair& pair, Manifold& out) {
  return gap_manifold(pair, find_gap(pair.a, pair.b), out);
}

bool polyhedra_manifold(const ConvexPair& pair, Manifold& out) {
  Gap gap;
  const double size = pair.a.radius + pair.b.radius;
  const bool apart = separated(pair.a, pair.b, gap);
  if (apart && gap.distance >= pair.margin) return gap_manifold(pair, gap, out);
  const FaceAxis of_a = best_face(pair.a, pair.b), of_b = best_face(pair.b, pair.a);
  const auto name = [](std::uint32_t kind, int face) { return kind | static_cast<std::uint32_t>(face); };
  const double preference = pair.slack.preference;
  const bool a_first = pair.a.radius >= pair.b.radius;
  const double value_a =
      of_a.distance + (a_first ? preference / 2 : 0) + (pair.remembers(name(kFaceOfA, of_a.face)) ? preference / 4 : 0);
  const double value_b =
      of_b.distance + (a_first ? 0 : preference / 2) + (pair.remembers(name(kFaceOfB, of_b.face)) ? preference / 4 : 0);
  const bool take_a = value_a >= value_b;
  const double face = take_a ? of_a.distance : of_b.distance;
  const auto remember_face = [&] {
    const Polyhedron& solid = take_a ? *pair.a.solid : *pair.b.solid;
    const int index = take_a ? of_a.face : of_b.face;
    const Vector3 outward = (take_a ? pair.a : pair.b).rotation * solid.planes[static_cast<std::size_t>(index)].normal;
    pair.remember(take_a ? Vector3(-outward) : outward, name(take_a ? kFaceOfA : kFaceOfB, index));
  };
  remember_face();
  if (face >= pair.margin) return false;
  if (!apart || gap.distance <= kClose * size)
    return overlap_manifold(pair, of_a, of_b, take_a, apart ? gap.distance : 0, out);
  if (face >= gap.distance - preference &&
      face_manifold(pair, take_a ? Owner::A : Owner::B, take_a ? of_a.face : of_b.face, out) &&
      out.points[0].distance <= gap.distance + preference) {
    return true;
  }
  return gap_manifold(pair, gap, out);
}

}  // namespace breve
