// One triangle: how far it is from a ball or a polyhedron, and the shortest way out of an overlap that is allowed.
// Apart, the general methods serve; a triangle's edges lie between opposite faces, so its axes are sought here.
#include "runtime/solid/triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace breve {

namespace {

constexpr double kParallel = 1e-9;  // sine below which two edges give no axis
constexpr double kSideways = 1e-9;  // of a direction that still counts as not going backward
constexpr double kFar = std::numeric_limits<double>::infinity();

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

  /// No corner that is lowest is higher over the planes of a solid that look along a node's directions and whose
  /// opposites lead outward. Once that is not above `least` the rest does not matter.
  double height(const FaceTree::Node& node, double least) const {
    if (node.along(-side.normal) < -2 * kSideways) return -kFar;
    double lowest = kFar;
    for (std::size_t i = 0; i < 3 && lowest > least; ++i)
      lowest = std::min(lowest, node.outside + node.along(corner[i] - node.point));
    return lowest;
  }

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

/// Some faces or edges of a solid, unless they are too many.
struct Few {
  std::array<std::uint32_t, 256> number;
  std::size_t count = 0;
  bool fits = true;

  void add(std::uint32_t one) {
    fits = fits && count < number.size();
    if (fits) number[count++] = one;
  }
  std::span<const std::uint32_t> all() const { return {number.data(), count}; }
};

/// The best axis found so far, in the frame of a, from the triangle toward a.
struct Axis {
  double distance = -kFar;
  Vector3 normal = Vector3::UnitY();
  int edge_a = -1, edge_b = -1;
  double worth = -kFar;  // what separates no better does not matter

  double to_beat() const { return std::max(distance, worth); }
};

/// @param round_off  of heights, m
/// @param seen       faces of a solid with a tree of them: every edge that may be worth a look is at one of these
void try_faces(const Polyhedron& a, int from, const Local& t, double round_off, Axis& best, Few& seen) {
  const double low = t.side.normal.dot(a.vertices[at(a.farthest(-t.side.normal, from))]);
  best.distance = low - t.side.offset;
  best.normal = t.side.normal;
  double least = best.to_beat() - round_off;
  std::uint32_t found = 0;  // of equals the first face; the triangle's own side comes before all
  const auto look = [&](std::uint32_t face) {
    const Plane& plane = a.planes[face];
    const double d =
        std::min({plane.normal.dot(t.corner[0]), plane.normal.dot(t.corner[1]), plane.normal.dot(t.corner[2])}) -
        plane.offset;
    if (!(d > best.distance || (d == best.distance && face < found))) return;
    if (plane.normal.dot(t.side.normal) > kSideways) return;
    best.distance = d;
    best.normal = -plane.normal;
    least = best.to_beat() - round_off;
    found = face;
  };
  if (a.looks.empty()) {
    for (std::uint32_t face = 0; face < a.planes.size(); ++face) look(face);
    return;
  }
  a.looks.search(
      least, [&](const FaceTree::Node& node) { return t.height(node, least); },
      [&](std::uint32_t face) {
        seen.add(face);
        look(face);
      });
}

/// No axis at an edge between two normals that may be taken separates better than `to_beat`, for one corner is not
/// higher along any of them: its height over the planes that roll about the edge is largest at an end of the way,
/// unless it lies between.
bool edge_cannot_beat(const Vector3& left, const Vector3& right, const Vector3& start, const Local& t, double to_beat) {
  if (left.dot(t.side.normal) > 2 * kSideways && right.dot(t.side.normal) > 2 * kSideways) return true;
  const double cosine = left.dot(right);
  return std::any_of(t.corner.begin(), t.corner.end(), [&](const Vector3& corner) {
    const Vector3 beyond = corner - start;
    const double l = left.dot(beyond), r = right.dot(beyond);
    return l <= to_beat && r <= to_beat && (r <= cosine * l || l <= cosine * r);
  });
}

/// Products of edges that lie on the solid's Gauss map and in the half-plane over the triangle's edge.
void try_edge(const Polyhedron& a, std::size_t e, const Local& t, const Eigen::AlignedBox3d& around, double slack,
              Axis& best) {
  const Edge& edge = a.edges[e];
  const Vector3 &start = a.vertices[at(edge.a)], &end = a.vertices[at(edge.b)];
  const Vector3 &left = a.planes[at(edge.left)].normal, &right = a.planes[at(edge.right)].normal;
  if (edge_cannot_beat(left, right, start, t, best.to_beat())) return;
  const double reach = std::max(0.0, -best.distance) + slack;
  const Eigen::AlignedBox3d box(start.cwiseMin(end) - Vector3::Constant(reach),
                                start.cwiseMax(end) + Vector3::Constant(reach));
  if (best.distance < 0 && !box.intersects(around)) return;
  const Vector3 along = end - start;
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
    best = {d, m, static_cast<int>(e), static_cast<int>(k), best.worth};
  }
}

/// The edges at these faces that may beat the best axis, ascending.
Few promising_edges(const Polyhedron& a, const Local& t, double to_beat, const Few& seen) {
  Few out;
  out.fits = seen.fits;
  for (const std::uint32_t face : seen.all()) {
    for (const std::uint32_t e : a.looks.edges_of(face)) {
      const Edge& edge = a.edges[e];
      const Vector3 &left = a.planes[face].normal, &right = a.planes[at(edge.right)].normal;
      if (!edge_cannot_beat(left, right, a.vertices[at(edge.a)], t, to_beat)) out.add(e);
    }
  }
  std::sort(out.number.begin(), out.number.begin() + static_cast<std::ptrdiff_t>(out.count));
  return out;
}

/// @param seen  by try_faces
void try_edges(const Polyhedron& a, const Local& t, double slack, const Few& seen, Axis& best) {
  Eigen::AlignedBox3d around;
  for (const Vector3& p : t.corner) around.extend(p);
  if (!a.looks.empty()) {
    const Few edges = promising_edges(a, t, best.to_beat(), seen);
    if (edges.fits) {
      for (const std::uint32_t e : edges.all()) try_edge(a, e, t, around, slack, best);
      return;
    }
  }
  for (std::size_t e = 0; e < a.edges.size(); ++e) try_edge(a, e, t, around, slack, best);
}

/// What the planes of a solid of few faces say about a triangle before the nearest points are sought.
enum class Told { Nothing, Overlap, Distance, Beyond };  // Distance: exact, at a corner over the inside of a face

/// The face that the triangle is highest over, how high its lowest corner is there, and which corner that is.
struct OverFace {
  double distance = -kFar;
  std::size_t face = 0, corner = 0;
};

/// A warped face of a script is lower than its plane.
bool is_planar(const Placed& a, double hair) {
  if (a.hints != nullptr && a.hints->planar) return *a.hints->planar;
  const Polyhedron& solid = *a.solid;
  bool planar = true;
  for (std::size_t f = 0; f < solid.faces.size(); ++f)
    for (const int v : solid.faces[f])
      planar = planar && solid.planes[f].normal.dot(solid.vertices[at(v)]) >= solid.planes[f].offset - hair;
  if (a.hints != nullptr) a.hints->planar = planar;
  return planar;
}

Told ask_planes(const Placed& placed, const Local& t, double beyond, double hair, OverFace& best) {
  constexpr std::size_t kFewFaces = 32;
  const Polyhedron& a = *placed.solid;
  if (a.planes.size() > kFewFaces) return Told::Nothing;
  std::array<bool, 3> inside{true, true, true};
  for (std::size_t f = 0; f < a.planes.size(); ++f) {
    OverFace here{kFar, f, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const double height = a.planes[f].normal.dot(t.corner[k]) - a.planes[f].offset;
      inside[k] = inside[k] && height < -hair;
      if (height < here.distance) here.distance = height, here.corner = k;
    }
    if (here.distance > best.distance) best = here;
  }
  if (best.distance > beyond) return Told::Beyond;
  if (!is_planar(placed, hair)) return Told::Nothing;
  if (inside[0] || inside[1] || inside[2]) return Told::Overlap;
  if (best.distance <= hair) return Told::Nothing;
  // Over the inside of the face nothing is nearer.
  const Vector3 foot = t.corner[best.corner] - best.distance * a.planes[best.face].normal;
  for (std::size_t f = 0; f < a.planes.size(); ++f)
    if (f != best.face && a.planes[f].normal.dot(foot) > a.planes[f].offset) return Told::Nothing;
  return Told::Distance;
}

/// Where a solid and a triangle are nearest if a corner of this is over a face of that.
void take_corner(const Placed& a, const Placed& b, const OverFace& over, Gap& gap) {
  gap.distance = over.distance;
  gap.normal = -(a.rotation * a.solid->planes[over.face].normal);
  gap.on_b = b.vertex(static_cast<int>(over.corner));
  gap.on_a = gap.on_b + over.distance * gap.normal;
}

/// How far apart they are along the direction that told the last triangle apart, which is often next to this one.
double along_last(const Placed& a, const Local& t) {
  if (a.hints == nullptr || a.hints->apart.isZero(0)) return -kFar;
  const Vector3& n = a.hints->apart;
  const double high = n.dot(a.solid->vertices[at(a.last = a.solid->farthest(n, a.last))]);
  return std::min({n.dot(t.corner[0]), n.dot(t.corner[1]), n.dot(t.corner[2])}) - high;
}

/// Is a corner of the triangle deeper than `hair` below all faces of a solid that has a tree of them?
bool has_corner_within(const Polyhedron& a, const Local& t, double hair) {
  if (a.looks.empty()) return false;
  return std::any_of(t.corner.begin(), t.corner.end(), [&](const Vector3& corner) {
    double least = -hair;
    a.looks.search(
        least, [&](const FaceTree::Node& node) { return node.outside + node.along(corner - node.point); },
        [&](std::uint32_t face) {
          if (a.planes[face].normal.dot(corner) - a.planes[face].offset >= -hair) least = kFar;
        });
    return least < kFar;
  });
}

/// As `separated`, by cheaper means where these tell. `over` is written if the solid has few faces.
Told measure(const Placed& a, const Placed& b, const Local& local, double far, double hair, OverFace& over, Gap& gap) {
  const Told told = ask_planes(a, local, far + hair, hair, over);
  if (told == Told::Beyond) gap.distance = over.distance;
  if (told == Told::Distance) take_corner(a, b, over, gap);
  if (told != Told::Nothing) return told;
  const double least = along_last(a, local);
  if (least > far + hair) {
    gap.distance = least;
    return Told::Beyond;
  }
  if (least <= 0 && has_corner_within(*a.solid, local, hair)) return Told::Overlap;
  if (!separated(a, b, gap, far)) return Told::Overlap;
  if (gap.distance <= far) return Told::Nothing;
  if (a.hints != nullptr) a.hints->apart = -(a.rotation.transpose() * gap.normal);
  return Told::Beyond;
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

namespace {

/// Not backward is a way back that has at least this length.
double least_backward(double out, double size) {
  constexpr double kShallow = 1e-3, kFarShorter = 0.1;
  return std::min(kFarShorter * out, std::max(-kShallow * size, out * (1 - 1e-9)));
}

}  // namespace

bool backward(double out, double back, double size) { return back > least_backward(out, size); }

void complete(const Placed& a, const Placed& b, TriangleGap& gap) {
  if (!gap.lacks_points) return;
  place_witnesses(a, b, gap);
  gap.lacks_points = false;
}

Gap triangle_gap(const Placed& a, const Placed& b, double enough) {
  TriangleGap gap = triangle_distance(a, b, enough);
  complete(a, b, gap);
  return gap;
}

TriangleGap triangle_distance(const Placed& a, const Placed& b, double enough) {
  if (a.solid == nullptr) return TriangleGap{ball_triangle(a, b)};
  if (a.round.is_round()) return TriangleGap{round_triangle_gap(a, b, enough)};
  constexpr double kHair = 1e-13;  // as in `separated`
  const double size = a.radius, hair = kHair * (a.radius + b.radius + (a.location - b.location).norm());
  const double far = std::max(enough, kClose * size);
  const Local local(a, b);
  TriangleGap gap;
  OverFace over;
  const Told told = measure(a, b, local, far, hair, over, gap);
  const bool apart = told != Told::Overlap;
  if (over.distance > -kFar) gap.face = {over.distance, static_cast<int>(over.face)};
  if (apart && gap.distance > kClose * size) return gap;
  Axis axis;
  const double slack = 1e-4 * size;
  Few seen;
  try_faces(*a.solid, a.last, local, hair, axis, seen);
  // Nothing separates better than a distance.
  if (told != Told::Distance) try_edges(*a.solid, local, slack, seen, axis);
  if (apart && axis.distance < gap.distance - kAgree * size) return gap;
  TriangleGap out;
  out.lacks_points = true;
  out.face = gap.face;
  out.normal = a.rotation * axis.normal;
  out.distance = axis.distance;
  constexpr double kStraight = 0.9;  // cosine from which the way leads out through the face
  if (b.outer && axis.distance < 0 && axis.normal.dot(local.side.normal) < kStraight) {
    // A side of a solid that stands on `a` with its lower edge: the face beyond that edge has the contact.
    Axis back;
    back.worth = least_backward(axis.distance, std::min(a.radius, b.radius));
    const Local turned = local.turned();
    Few seen_back;
    try_faces(*a.solid, a.last, turned, hair, back, seen_back);
    try_edges(*a.solid, turned, slack, seen_back, back);
    if (backward(axis.distance, back.distance, std::min(a.radius, b.radius))) out.back = back.distance;
  }
  if (axis.edge_a >= 0) {
    const Edge& edge = a.solid->edges[at(axis.edge_a)];
    out.start_a = a.vertex(edge.a);
    out.edge_a = a.vertex(edge.b) - out.start_a;
    out.start_b = b.vertex(axis.edge_b);
    out.edge_b = b.vertex((axis.edge_b + 1) % 3) - out.start_b;
  }
  return out;
}

}  // namespace breve
