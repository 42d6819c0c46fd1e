// Cutting shapes at z = 0, and outlines into convex pieces.
#include "runtime/planar/outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "runtime/base/error.hpp"
#include "runtime/solid/surface.hpp"

namespace breve {

namespace {

using Points = std::pmr::vector<Vector2>;

double orientation(const Vector2& a, const Vector2& b, const Vector2& c) { return cross(b - a, c - b); }
bool before(const Vector2& a, const Vector2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); }

/// The convex hull, counter-clockwise, without corners on straight lines (Andrew 1979).
Points hull_of(Points points) {
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  Points hull(points.get_allocator());
  if (points.size() < 3) return hull;
  const double size = (points.back() - points.front()).squaredNorm();
  const auto add = [&](const Vector2& p, std::size_t least) {
    constexpr double kStraight = 1e-12;
    while (hull.size() >= least && orientation(hull[hull.size() - 2], hull.back(), p) <= kStraight * size)
      hull.pop_back();
    hull.push_back(p);
  };
  for (const Vector2& p : points) add(p, 2);
  const std::size_t lower = hull.size() + 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  hull.pop_back();
  return hull;
}

/// Where an edge crosses z = 0. From either end the same number comes out.
Vector2 crossing(Vector3 a, Vector3 b) {
  if (std::tie(b.x(), b.y(), b.z()) < std::tie(a.x(), a.y(), a.z())) std::swap(a, b);
  if (a.z() == 0) return a.head<2>();
  if (b.z() == 0) return b.head<2>();
  const double t = a.z() / (a.z() - b.z());
  return (a + t * (b - a)).head<2>();
}

Points cut_polyhedron(const Polyhedron& solid, std::pmr::memory_resource* memory) {
  Points points(memory);
  for (const auto& face : solid.faces)
    for (std::size_t i = 0; i < face.size(); ++i) {
      const auto corner = [&](std::size_t k) -> const Vector3& {
        return solid.vertices[static_cast<std::size_t>(face[k % face.size()])];
      };
      const Vector3 &a = corner(i), &b = corner(i + 1);
      if (a.z() == 0) points.emplace_back(a.x(), a.y());
      if ((a.z() < 0) != (b.z() < 0) && a.z() != 0 && b.z() != 0) points.push_back(crossing(a, b));
    }
  return hull_of(std::move(points));
}

/// The segments in which facets cross z = 0, the solid to their left. A corner at z = 0 counts as above.
struct Slicer final : FacetVisitor {
  std::pmr::vector<std::pair<Vector2, Vector2>> segments;
  explicit Slicer(std::pmr::memory_resource* memory) : segments(memory) {}
  void visit(const Facet& facet) override {
    Vector2 found[2];
    int count = 0;
    for (int i = 0; i < 3; ++i) {
      const Vector3 &a = facet.corner[static_cast<std::size_t>(i)],
                    &b = facet.corner[static_cast<std::size_t>((i + 1) % 3)];
      if ((a.z() < 0) != (b.z() < 0) && count < 2) found[count++] = crossing(a, b);
    }
    if (count < 2 || found[0] == found[1]) return;
    const Vector2 along(-facet.normal.y(), facet.normal.x());
    if (along.dot(found[1] - found[0]) < 0) std::swap(found[0], found[1]);
    segments.emplace_back(found[0], found[1]);
  }
};

/// Segments joined end to end, in the order of their first points.
std::pmr::vector<Points> joined(std::pmr::vector<std::pair<Vector2, Vector2>> segments,
                                std::pmr::memory_resource* memory) {
  std::sort(segments.begin(), segments.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? before(a.first, b.first) : before(a.second, b.second);
  });
  std::pmr::vector<bool> used(segments.size(), false, memory);
  std::pmr::vector<bool> reached(segments.size(), false, memory);
  const auto next_of = [&](const Vector2& end) {
    return static_cast<std::size_t>(
        std::lower_bound(segments.begin(), segments.end(), end,
                         [](const auto& s, const Vector2& p) { return before(s.first, p); }) -
        segments.begin());
  };
  for (const auto& segment : segments) {
    const std::size_t next = next_of(segment.second);
    if (next < segments.size() && segments[next].first == segment.second) reached[next] = true;
  }
  std::pmr::vector<Points> lines(memory);
  // What begins nowhere first, so that open lines start at their ends; then the rings.
  for (const bool open : {true, false})
    for (std::size_t i = 0; i < segments.size(); ++i) {
      if (used[i] || (open && reached[i])) continue;
      Points line(memory);
      line.push_back(segments[i].first);
      for (std::size_t at = i; at < segments.size() && !used[at];) {
        used[at] = true;
        line.push_back(segments[at].second);
        const std::size_t next = next_of(line.back());
        if (next >= segments.size() || segments[next].first != line.back()) break;
        at = next;
      }
      lines.push_back(std::move(line));
    }
  return lines;
}

double area_of(const Points& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) sum += cross(ring[i], ring[(i + 1) % ring.size()]);
  return sum / 2;
}

bool in_triangle(const Vector2& p, const Vector2& a, const Vector2& b, const Vector2& c) {
  return orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0;
}

using Corners = std::pmr::vector<std::size_t>;

/// Triangles of a simple ring, counter-clockwise.
std::pmr::vector<Corners> triangles_of(const Points& ring, std::pmr::memory_resource* memory) {
  std::pmr::vector<Corners> triangles(memory);
  Corners left(memory);
  for (std::size_t i = 0; i < ring.size(); ++i) left.push_back(i);
  while (left.size() >= 3) {
    std::size_t ear = left.size();
    for (std::size_t i = 0; i < left.size() && ear == left.size(); ++i) {
      const std::size_t a = left[(i + left.size() - 1) % left.size()], b = left[i], c = left[(i + 1) % left.size()];
      if (orientation(ring[a], ring[b], ring[c]) <= 0) continue;
      const bool empty = std::none_of(left.begin(), left.end(), [&](std::size_t p) {
        return p != a && p != b && p != c && in_triangle(ring[p], ring[a], ring[b], ring[c]);
      });
      if (empty) ear = i;
    }
    if (ear == left.size()) break;  // what is left has no area
    const std::size_t a = left[(ear + left.size() - 1) % left.size()], c = left[(ear + 1) % left.size()];
    triangles.push_back(Corners({a, left[ear], c}, memory));
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return triangles;
}

bool is_convex(const Points& ring, const Corners& corners) {
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (orientation(ring[corners[i]], ring[corners[(i + 1) % corners.size()]],
                    ring[corners[(i + 2) % corners.size()]]) < 0)
      return false;
  return true;
}

/// Two pieces that share an edge as one, if that is convex and small enough; else empty.
Corners merged(const Points& ring, const Corners& a, const Corners& b) {
  Corners one(a.get_allocator());
  if (a.size() + b.size() - 2 > Outline::kMostCorners) return one;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k) {
      if (a[i] != b[(k + 1) % b.size()] || a[(i + 1) % a.size()] != b[k]) continue;
      for (std::size_t n = 0; n < a.size(); ++n) one.push_back(a[(i + 1 + n) % a.size()]);
      for (std::size_t n = 0; n + 2 < b.size(); ++n) one.push_back(b[(k + 2 + n) % b.size()]);
      if (!is_convex(ring, one)) one.clear();
      return one;
    }
  return one;
}

std::pmr::vector<Points> convex_pieces(const Points& ring, std::pmr::memory_resource* memory) {
  std::pmr::vector<Corners> pieces = triangles_of(ring, memory);
  for (bool again = true; again;) {
    again = false;
    for (std::size_t i = 0; i < pieces.size(); ++i)
      for (std::size_t k = i + 1; k < pieces.size(); ++k) {
        Corners one = merged(ring, pieces[i], pieces[k]);
        if (one.empty()) continue;
        pieces[i] = std::move(one);
        pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(k));
        again = true;
        k = i;
      }
  }
  std::pmr::vector<Points> found(memory);
  for (const Corners& piece : pieces) {
    Points points(memory);
    for (const std::size_t corner : piece) points.push_back(ring[corner]);
    found.push_back(hull_of(std::move(points)));
  }
  return found;
}

[[noreturn]] void no_outline() {
  throw Error(ErrorCode::Argument,
              "the shape does not reach the plane z = 0 of its own frame, so it has no cross-section in a flat world");
}

void add_polygon(Outline& outline, Points points, std::pmr::memory_resource* memory) {
  if (points.size() < 3) return;
  FlatPiece piece(memory);
  piece.kind = FlatPiece::Kind::Polygon;
  piece.points = std::move(points);
  outline.thickness = std::min(outline.thickness, half_width(piece.points));
  outline.pieces.push_back(std::move(piece));
}

/// A convex polygon of any number of corners as a fan of polygons that have few enough.
void add_convex(Outline& outline, const Points& polygon, std::pmr::memory_resource* memory) {
  for (std::size_t first = 1; first + 1 < polygon.size(); first += Outline::kMostCorners - 2) {
    Points part(memory);
    part.push_back(polygon[0]);
    const std::size_t end = std::min(polygon.size(), first + Outline::kMostCorners - 1);
    for (std::size_t i = first; i < end; ++i) part.push_back(polygon[i]);
    add_polygon(outline, std::move(part), memory);
  }
}

void cut_surface(Outline& outline, const Surface& surface, std::pmr::memory_resource* memory) {
  Slicer slicer(memory);
  Eigen::AlignedBox3d plane = surface.bounds();
  // Corners at z = 0 count as above: what crosses lies below.
  constexpr double kBelow = 1e-9;
  plane.max().z() = 0;
  plane.min().z() = -kBelow * surface.bounds().sizes().norm();
  surface.under(plane, slicer);
  for (Points& line : joined(std::move(slicer.segments), memory)) {
    const bool closed = line.size() > 3 && line.front() == line.back();
    if (closed) {
      line.pop_back();
      if (!(area_of(line) > 0))
        throw Error(ErrorCode::Argument, "the outline of the mesh at z = 0 has a hole, which a flat world cannot have");
      for (Points& piece : convex_pieces(line, memory)) add_polygon(outline, std::move(piece), memory);
      continue;
    }
    FlatPiece piece(memory);
    piece.kind = FlatPiece::Kind::Profile;
    piece.points = std::move(line);
    outline.pieces.push_back(std::move(piece));
    outline.solid = false;
  }
}

void add_circle(Outline& outline, const Vector2& center, double radius, std::pmr::memory_resource* memory) {
  FlatPiece circle(memory);
  circle.center = center;
  circle.radius = radius;
  outline.thickness = std::min(outline.thickness, radius);
  outline.pieces.push_back(std::move(circle));
}

/// About z a disc; else along y a rectangle, with a disc at either end of a capsule.
void add_round(Outline& outline, const Round& round, std::pmr::memory_resource* memory) {
  if (round.axis == 2) return add_circle(outline, Vector2::Zero(), round.radius, memory);
  const double r = round.radius, h = round.half;
  add_polygon(outline, Points({{-r, -h}, {r, -h}, {r, h}, {-r, h}}, memory), memory);
  if (!round.is_capsule()) return;
  for (const double end : {-h, h}) add_circle(outline, Vector2(0, end), r, memory);
}

}  // namespace

double half_width(const Points& polygon) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2 along = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized();
    double most = 0;
    for (const Vector2& p : polygon) most = std::max(most, cross(along, p - polygon[i]));
    least = std::min(least, most / 2);
  }
  return least;
}

Points shrunk(const Points& polygon, double margin) {
  Points left = polygon;
  for (std::size_t i = 0; i < polygon.size() && !left.empty(); ++i) {
    const Vector2& from = polygon[i];
    const Vector2 along = (polygon[(i + 1) % polygon.size()] - from).normalized();
    const auto depth = [&](const Vector2& p) { return cross(along, p - from) - margin; };
    Points kept(polygon.get_allocator());
    for (std::size_t k = 0; k < left.size(); ++k) {
      const Vector2 &a = left[k], &b = left[(k + 1) % left.size()];
      const double da = depth(a), db = depth(b);
      if (da >= 0) kept.push_back(a);
      if ((da < 0) != (db < 0)) kept.push_back(a + da / (da - db) * (b - a));
    }
    left = std::move(kept);
  }
  return hull_of(std::move(left));
}

Outline outline_of(const Shape& shape, std::pmr::memory_resource* memory) {
  Outline outline(memory);
  outline.thickness = std::numeric_limits<double>::infinity();
  if (shape.kind() == ShapeKind::Sphere) {
    add_circle(outline, Vector2::Zero(), shape.radius(), memory);
  } else if (shape.round().is_round()) {
    add_round(outline, shape.round(), memory);
  } else if (shape.surface()) {
    cut_surface(outline, *shape.surface(), memory);
  } else {
    const auto& corners = shape.polyhedron().vertices;
    add_convex(outline, cut_polyhedron(shape.polyhedron(), memory), memory);
    const auto [low, high] = std::minmax_element(corners.begin(), corners.end(),
                                                 [](const Vector3& a, const Vector3& b) { return a.z() < b.z(); });
    if (outline.pieces.empty() && low->z() < 0 && high->z() > 0)
      throw Error(ErrorCode::Argument,
                  "the outline of the shape at z = 0 is a line to double precision: make it wider or less long");
  }
  if (outline.pieces.empty()) no_outline();
  return outline;
}

}  // namespace breve
