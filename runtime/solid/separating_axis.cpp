// Overlap of two polyhedra by separating axes (Gottschalk 1996): the normals of faces, and the products of two edges
// whose arcs cross on the Gauss map (Gregorius 2013), for only those are faces of the Minkowski difference.
// Two things keep solids of hundreds of faces cheap. A face cannot win if a vertex met before lies too deep below it.
// And the deepest points of two edges are no farther apart than the depth, so edges farther apart are passed over. Of
// thousands of edges those whose arcs may cross are found on the Gauss map.
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "runtime/solid/gap.hpp"

namespace breve {

namespace {

// A product of edges must beat the faces by this much of the size: a face is the steadier normal.
constexpr double kEdgeHandicap = 1e-12;
// Below this sine the product of two edges is so uncertain that its separation is measured on the solids instead.
constexpr double kNearlyParallel = 1e-4;
constexpr double kParallel = 1e-12;
constexpr double kNear = 1e-4;  // of the sizes: up to such gaps edges are looked at

/// Do the arcs of two edges cross on the Gauss map of a - b? Source: Gregorius 2013, "The separating axis test".
bool arcs_cross(const Plane& a1, const Plane& a2, const Vector3& edge_a, const Vector3& b1, const Vector3& b2,
                const Vector3& edge_b) {
  const double cba = b1.dot(edge_a), dba = b2.dot(edge_a);
  const double adc = -a1.normal.dot(edge_b), bdc = -a2.normal.dot(edge_b);
  return cba * dba < 0 && adc * bdc < 0 && cba * bdc > 0;
}

/// The last few vertices that were deepest under some face.
class Deepest {
 public:
  /// Nothing can be higher over a plane than its lowest known vertex.
  double bound(const Plane& plane) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count_; ++i) least = std::min(least, plane.normal.dot(known_[i]));
    return least - plane.offset;
  }
  void add(const Vector3& p) {
    known_[next_] = p;
    next_ = (next_ + 1) % known_.size();
    count_ = std::max(count_, next_ == 0 ? known_.size() : next_);
  }

 private:
  std::array<Vector3, 8> known_;
  std::size_t count_ = 0, next_ = 0;
};

Eigen::AlignedBox3d grown(const Vector3& p, const Vector3& q, double by) {
  return {p.cwiseMin(q) - Vector3::Constant(by), p.cwiseMax(q) + Vector3::Constant(by)};
}

}  // namespace

namespace {

/// The best cap of a cylinder, with b of any kind except a ball.
FaceAxis best_cap(const Placed& a, const Placed& b) {
  const auto over = [&](int cap) {
    const Vector3 normal = cap_normal(a, cap);
    return FaceAxis{-b.reach(-normal) - normal.dot(a.location) - a.round.half, cap};
  };
  const FaceAxis low = over(0), high = over(1);
  return low.distance > high.distance ? low : high;
}

}  // namespace

FaceAxis best_face(const Placed& a, const Placed& b) {
  if (a.round.is_capsule()) return {-std::numeric_limits<double>::infinity(), 0};
  if (a.round.is_cylinder()) return best_cap(a, b);
  const Matrix3 rotation = a.rotation.transpose() * b.rotation;
  const Vector3 shift = a.rotation.transpose() * (b.location - a.location);
  Deepest deepest;
  FaceAxis best{-std::numeric_limits<double>::infinity(), 0};
  int lowest = 0;  // vertex of b under the last face, from where the next search starts
  for (std::size_t f = 0; f < a.solid->planes.size(); ++f) {
    const Plane& plane = a.solid->planes[f];
    if (deepest.bound(plane) <= best.distance) continue;
    lowest = b.solid->farthest(-(rotation.transpose() * plane.normal), lowest);
    const Vector3 point = shift + rotation * b.solid->vertices[at(lowest)];
    deepest.add(point);
    const double distance = plane.normal.dot(point) - plane.offset;
    if (distance > best.distance) best = {distance, static_cast<int>(f)};
  }
  return best;
}

bool best_edges(const Placed& a, const Placed& b, double to_beat, double apart, EdgeAxis& best) {
  if (to_beat >= std::max(0.0, apart) + kAgree * (a.radius + b.radius)) return false;
  // Edges in the frame of a.
  const Matrix3 rotation = a.rotation.transpose() * b.rotation;
  const Vector3 shift = a.rotation.transpose() * (b.location - a.location);
  const Polyhedron &sa = *a.solid, &sb = *b.solid;
  Eigen::AlignedBox3d around_a;
  for (const Vector3& v : sa.vertices) around_a.extend(v);
  const double slack = kNear * (a.radius + b.radius);
  bool found = false;
  std::vector<std::uint32_t> crossing;  // edges of a whose arcs may cross that of the edge of b; of many edges
  int summit = 0;                       // vertex of a from where the next search starts
  for (std::size_t ib = 0; ib < sb.edges.size(); ++ib) {
    const Edge& eb = sb.edges[ib];
    const Vector3 start_b = shift + rotation * sb.vertices[at(eb.a)], end_b = shift + rotation * sb.vertices[at(eb.b)];
    const Eigen::AlignedBox3d around_b = grown(start_b, end_b, std::max(0.0, -to_beat) + slack);
    if (to_beat < 0 && !around_a.intersects(around_b)) continue;
    const Vector3 edge_b = end_b - start_b;
    const Vector3 b1 = rotation * sb.planes[at(eb.left)].normal, b2 = rotation * sb.planes[at(eb.right)].normal;
    const auto look = [&](std::size_t ia) {
      const Edge& ea = sa.edges[ia];
      const Vector3 &start_a = sa.vertices[at(ea.a)], &end_a = sa.vertices[at(ea.b)];
      if (to_beat < 0 && !around_b.intersects(grown(start_a, end_a, 0))) return;
      const Vector3 edge_a = end_a - start_a;
      if (!arcs_cross(sa.planes[at(ea.left)], sa.planes[at(ea.right)], edge_a, b1, b2, edge_b)) return;
      Vector3 outward = edge_a.cross(edge_b);
      const double length = outward.norm(), sides = edge_a.norm() * edge_b.norm();
      if (length <= kParallel * sides) return;
      outward /= length;
      if (outward.dot(sa.planes[at(ea.left)].normal + sa.planes[at(ea.right)].normal) < 0) outward = -outward;
      double distance = outward.dot(start_b - start_a);
      if (distance <= to_beat) return;
      const Vector3 normal = -(a.rotation * outward);
      if (length < kNearlyParallel * sides) distance = -a.reach(-normal) - b.reach(normal);
      if (distance <= to_beat) return;
      to_beat = distance;
      best = {distance, static_cast<int>(ia), static_cast<int>(ib), normal};
      found = true;
    };
    if (sa.arcs.empty()) {
      for (std::size_t ia = 0; ia < sa.edges.size(); ++ia) look(ia);
      continue;
    }
    // No axis on the arc separates better than the vertex of a that is farthest along its middle allows.
    const ArcBall arc = ArcBall::between(-b1, -b2);
    summit = sa.farthest(arc.middle, summit);
    const Vector3 beyond = start_b - sa.vertices[at(summit)];
    if (arc.middle.dot(beyond) + arc.reach * beyond.norm() + kAgree * (a.radius + b.radius) <= to_beat) continue;
    sa.arcs.meeting(arc, crossing);
    for (const std::uint32_t ia : crossing) look(ia);
  }
  return found;
}

Gap best_axis(const Placed& a, const Placed& b, double apart) {
  const FaceAxis of_a = best_face(a, b), of_b = best_face(b, a);
  Gap best;
  const bool take_a = of_a.distance >= of_b.distance;
  best.distance = take_a ? of_a.distance : of_b.distance;
  best.normal = take_a ? Vector3(-(a.rotation * a.solid->planes[at(of_a.face)].normal))
                       : Vector3(b.rotation * b.solid->planes[at(of_b.face)].normal);
  EdgeAxis edges;
  if (best_edges(a, b, best.distance + kEdgeHandicap * (a.radius + b.radius), apart, edges)) {
    const Edge &ea = a.solid->edges[at(edges.edge_a)], &eb = b.solid->edges[at(edges.edge_b)];
    best.distance = edges.distance;
    best.normal = edges.normal;
    best.start_a = a.vertex(ea.a);
    best.start_b = b.vertex(eb.a);
    best.edge_a = a.vertex(ea.b) - best.start_a;
    best.edge_b = b.vertex(eb.b) - best.start_b;
  }
  return best;
}

}  // namespace breve
