// One triangle: how far it is from a ball or a polyhedron, and the shortest way out of an overlap that is allowed.
// Apart, the general methods serve; a triangle's edges lie between opposite faces, so its axes are sought here.
#include "runtime/solid/triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace breve {

namespace {

constexpr double kParallel = 1e-9;  // sine below which two edges give no axis
constexpr double kSideways = 1e-9;  // of a direction that still counts as not going backward

/// The point of a triangle nearest to p. Source: Ericson 2005, "Real-Time Collision Detection", 5.1.5.
Vector3 nearest_on(const std::array<Vector3, 3>& corner, const Vector3& p) {
  const Vector3 &a = corner[0], &b = corner[1], &c = corner[2];
  const Vector3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const double sum = va + vb + vc;
  return a + vb / sum * ab + vc / sum * ac;
}

/// The side of the triangle that a way out leads to, and the height of a's origin over the plane; in the frame of a.
struct Side {
  Vector3 normal;
  double offset;  // normal . corner
};

/// The triangle in the frame of a.
struct Local {
  std::array<Vector3, 3> corner;
  Side side;

  /// With the other side.
  Local turned() const {
    Local other = *this;
    other.side = {-side.normal, -side.offset};
    return other;
  }

  Local(const Placed& a, const Placed& b) {
    const Matrix3 rotation = a.rotation.transpose() * b.rotation;
    const Vector3 shift = a.rotation.transpose() * (b.location - a.location);
    for (std::size_t i = 0; i < 3; ++i) corner[i] = shift + rotation * b.solid->vertices[i];
    side.normal = rotation * b.solid->planes[0].normal;
    side.offset = side.normal.dot(corner[0]);
    // The origin of a is 0 here.
    if (!b.outer && side.offset > 0) {
      side.normal = -side.normal;
      side.offset = -side.offset;
    }
  }
};

Gap ball_triangle(const Placed& ball, const Placed& b) {
  const Local local(ball, b);
  const Vector3 q = nearest_on(local.corner, Vector3::Zero());
  const double length = q.norm(), height = -local.side.offset;
  Vector3 normal = length > 1e-12 * ball.radius ? Vector3(-q / length) : local.side.normal;
  double distance = length - ball.radius;
  // Behind the face of a solid, not beside it, and not so deep that they do not touch: out through the face.
  if (b.outer && height < 0 && length <= -height * (1 + 1e-9) && length < ball.radius) {
    normal = local.side.normal;
    distance = height - ball.radius;
  }
  Gap gap;
  gap.normal = ball.rotation * normal;
  gap.distance = distance;
  gap.on_a = ball.location - ball.radius * gap.normal;
  gap.on_b = ball.location + ball.rotation * q;
  return gap;
}

/// The best axis found so far, in the frame of a, from the triangle toward a.
struct Axis {
  double distance = -std::numeric_limits<double>::infinity();
  Vector3 normal = Vector3::UnitY();
  int edge_a = -1, edge_b = -1;
};

void try_faces(const Polyhedron& a, int from, const Local& t, Axis& best) {
  const double low = t.side.normal.dot(a.vertices[at(a.farthest(-t.side.normal, from))]);
  best.distance = low - t.side.offset;
  best.normal = t.side.normal;
  for (const Plane& plane : a.planes) {
    if (plane.normal.dot(t.side.normal) > kSideways) continue;
    const double d =
        std::min({plane.normal.dot(t.corner[0]), plane.normal.dot(t.corner[1]), plane.normal.dot(t.corner[2])}) -
        plane.offset;
    if (d > best.distance) {
      best.distance = d;
      best.normal = -plane.normal;
    }
  }
}

/// Products of edges that lie on the solid's Gauss map and in the half-plane over the triangle's edge.
void try_edges(const Polyhedron& a, const Local& t, double slack, Axis& best) {
  Eigen::AlignedBox3d around;
  for (const Vector3& p : t.corner) around.extend(p);
  for (std::size_t e = 0; e < a.edges.size(); ++e) {
    const Edge& edge = a.edges[e];
    const Vector3 &start = a.vertices[at(edge.a)], &end = a.vertices[at(edge.b)];
    const double reach = std::max(0.0, -best.distance) + slack;
    const Eigen::AlignedBox3d box(start.cwiseMin(end) - Vector3::Constant(reach),
                                  start.cwiseMax(end) + Vector3::Constant(reach));
    if (best.distance < 0 && !box.intersects(around)) continue;
    const Vector3 along = end - start;
    const Vector3 &left = a.planes[at(edge.left)].normal, &right = a.planes[at(edge.right)].normal;
    const Vector3 rim_left = left.cross(along), rim_right = along.cross(right);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3& corner = t.corner[k];
      const Vector3 rim = t.corner[(k + 1) % 3] - corner;
      Vector3 m = along.cross(rim);
      const double length = m.norm();
      if (length <= kParallel * along.norm() * rim.norm()) continue;
      m /= length;
      // Away from the inside of the triangle.
      if (m.dot(t.corner[(k + 2) % 3] - corner) > 0) m = -m;
      if (m.dot(t.side.normal) < -kSideways) continue;
      // Between the normals of the two faces: -m is where the edge is the solid's farthest.
      if (rim_left.dot(m) < 0 || rim_right.dot(m) < 0) continue;
      const double d = m.dot(start - corner);
      if (d <= best.distance + slack * 1e-8) continue;
      best = {d, m, static_cast<int>(e), static_cast<int>(k)};
    }
  }
}

}  // namespace

TriangleSolid::TriangleSolid()
    : memory_(bytes_.data(), bytes_.size(), std::pmr::null_memory_resource()), solid_(&memory_) {
  solid_.vertices.resize(3);
  solid_.faces.resize(2);
  solid_.faces[0].assign({0, 1, 2});
  solid_.faces[1].assign({0, 2, 1});
  solid_.planes.resize(2);
  solid_.edges.assign({{0, 1, 0, 1}, {1, 2, 0, 1}, {2, 0, 0, 1}});
}

void TriangleSolid::set(const Facet& facet) {
  facet_ = facet;
  radius_ = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    solid_.vertices[i] = facet.corner[i];
    radius_ = std::max(radius_, facet.corner[i].norm());
  }
  solid_.planes[0] = {facet.normal, facet.normal.dot(facet.corner[0])};
  solid_.planes[1] = {-facet.normal, -solid_.planes[0].offset};
}

bool backward(double out, double back, double size) {
  constexpr double kShallow = 1e-3, kFarShorter = 0.1;
  return back > kFarShorter * out || (back > -kShallow * size && back > out * (1 - 1e-9));
}

Gap triangle_gap(const Placed& a, const Placed& b, double enough) {
  if (a.solid == nullptr) return ball_triangle(a, b);
  if (a.round.is_round()) return round_triangle_gap(a, b, enough);
  const double size = a.radius;
  Gap gap;
  const bool apart = separated(a, b, gap, std::max(enough, kClose * size));
  if (apart && gap.distance > kClose * size) return gap;
  const Local local(a, b);
  Axis axis;
  try_faces(*a.solid, a.last, local, axis);
  try_edges(*a.solid, local, 1e-4 * size, axis);
  if (apart && axis.distance < gap.distance - kAgree * size) return gap;
  Gap out;
  out.normal = a.rotation * axis.normal;
  out.distance = axis.distance;
  constexpr double kStraight = 0.9;  // cosine from which the way leads out through the face
  if (b.outer && axis.distance < 0 && axis.normal.dot(local.side.normal) < kStraight) {
    // A side of a solid that stands on `a` with its lower edge: the face beyond that edge has the contact.
    Axis back;
    const Local turned = local.turned();
    try_faces(*a.solid, a.last, turned, back);
    try_edges(*a.solid, turned, 1e-4 * size, back);
    if (backward(axis.distance, back.distance, std::min(a.radius, b.radius))) out.back = back.distance;
  }
  if (axis.edge_a >= 0) {
    const Edge& edge = a.solid->edges[at(axis.edge_a)];
    out.start_a = a.vertex(edge.a);
    out.edge_a = a.vertex(edge.b) - out.start_a;
    out.start_b = b.vertex(axis.edge_b);
    out.edge_b = b.vertex((axis.edge_b + 1) % 3) - out.start_b;
  }
  place_witnesses(a, b, out);
  return out;
}

}  // namespace breve
