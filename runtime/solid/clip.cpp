// The incident face is cut by the sides of the reference face (Sutherland and Hodgman 1974), in the plane of the
// latter. Each corner remembers the two edges it lies on, so that it keeps its name while these two stay the same.
#include "runtime/solid/clip.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace breve {

namespace {

constexpr std::size_t kMostCut = 2 * kMostCorners;
constexpr int kSide = kMostCorners;  // edge numbers from here on are sides of the reference face

/// A corner of the cut polygon: (x, y) in the reference plane, height above it, and the edges before and behind it.
struct CutCorner {
  double x, y, height;
  int before, behind;
};

struct CutPolygon {
  std::array<CutCorner, kMostCut> corner;
  int count = 0;

  void add(const CutCorner& c) {
    if (count < static_cast<int>(kMostCut)) corner[static_cast<std::size_t>(count++)] = c;
  }
  const CutCorner& operator[](int i) const { return corner[static_cast<std::size_t>(i)]; }
};

/// Axes and origin in the reference plane.
struct Frame {
  Vector3 origin, x, y, normal;

  Vector3 place(double u, double v, double height) const { return origin + u * x + v * y + height * normal; }
};

/// False if nothing is cut off: `out` is then not written. Two corners are a line, not a polygon.
bool cut(const CutPolygon& in, double ax, double ay, double nx, double ny, double rim, int side, CutPolygon& out) {
  const auto inside = [&](const CutCorner& c) { return (c.x - ax) * nx + (c.y - ay) * ny + rim; };
  double least = inside(in[0]);
  for (int i = 1; i < in.count; ++i) least = std::min(least, inside(in[i]));
  if (least >= 0) return false;
  out.count = 0;
  double here = inside(in[0]);
  const int edges = in.count > 2 ? in.count : in.count - 1;
  for (int i = 0; i < edges; ++i) {
    const CutCorner& p = in[i];
    const CutCorner& q = in[i + 1 < in.count ? i + 1 : 0];
    const double next = inside(q);
    if (here >= 0) out.add(p);
    if ((here >= 0) != (next >= 0)) {
      const double t = here / (here - next);
      CutCorner c{p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.height + t * (q.height - p.height), p.behind, side};
      if (here < 0) std::swap(c.before, c.behind);
      out.add(c);
    }
    here = next;
  }
  if (edges < in.count && here >= 0) out.add(in[edges]);
  return true;
}

/// The corners of a convex polygon that span much: the farthest along a slanting line, the farthest from it, and the
/// farthest from their diagonal on either side. The line is slanting so that no two corners of a regular polygon tie.
int select(const CutPolygon& polygon, std::array<int, kMostPoints>& chosen) {
  if (polygon.count <= kMostPoints) {
    for (int i = 0; i < polygon.count; ++i) chosen[static_cast<std::size_t>(i)] = i;
    return polygon.count;
  }
  constexpr double kSlant = 0.37;
  const auto farthest = [&](auto&& measure) {
    int best = 0;
    double most = measure(polygon[0]);
    for (int i = 1; i < polygon.count; ++i) {
      const double here = measure(polygon[i]);
      if (here > most) {
        most = here;
        best = i;
      }
    }
    return best;
  };
  const int first = farthest([](const CutCorner& c) { return c.x + kSlant * c.y; });
  const CutCorner p = polygon[first];
  const int second =
      farthest([&](const CutCorner& c) { return (c.x - p.x) * (c.x - p.x) + (c.y - p.y) * (c.y - p.y); });
  const double dx = polygon[second].x - p.x, dy = polygon[second].y - p.y;
  const auto side = [&](const CutCorner& c) { return dx * (c.y - p.y) - dy * (c.x - p.x); };
  chosen = {first, farthest([&](const CutCorner& c) { return -side(c); }), second, farthest(side)};
  // On a straight line of corners a side has none but the ends.
  int count = 0;
  for (const int c : chosen) {
    if (std::find(chosen.begin(), chosen.begin() + count, c) == chosen.begin() + count) {
      chosen[static_cast<std::size_t>(count++)] = c;
    }
  }
  return count;
}

/// A point deeper than the chosen ones by more than `slack` takes the place of its nearest; the deepest comes first.
void keep_deepest(const CutPolygon& polygon, double slack, std::array<int, kMostPoints>& chosen, int count) {
  int deepest = 0;
  for (int i = 1; i < polygon.count; ++i) {
    if (polygon[i].height < polygon[deepest].height) deepest = i;
  }
  int at = -1, nearest = 0;
  double least = 0;
  for (int k = 0; k < count; ++k) {
    const int c = chosen[static_cast<std::size_t>(k)];
    const double square =
        std::pow(polygon[c].x - polygon[deepest].x, 2) + std::pow(polygon[c].y - polygon[deepest].y, 2);
    if (k == 0 || square < least) {
      least = square;
      nearest = k;
    }
    if (at < 0 || polygon[c].height < polygon[chosen[static_cast<std::size_t>(at)]].height) at = k;
  }
  if (polygon[chosen[static_cast<std::size_t>(at)]].height > polygon[deepest].height + slack) {
    at = nearest;
    chosen[static_cast<std::size_t>(at)] = deepest;
  }
  std::swap(chosen[0], chosen[static_cast<std::size_t>(at)]);
}

/// Named by vertices and edges of the incident solid, whichever of its faces they were found on.
std::uint32_t name(const PlacedFace& reference, const PlacedFace& incident, Owner owner, const CutCorner& c) {
  const auto vertex = [&](int edge) {
    return static_cast<std::uint32_t>(incident.vertex[static_cast<std::size_t>(edge % incident.count)]);
  };
  const std::uint32_t kind = (static_cast<std::uint32_t>(reference.index) << 3) | (owner == Owner::A ? 0U : 1U);
  const bool from_side = c.before >= kSide, to_side = c.behind >= kSide;
  if (from_side && to_side) {
    const int low = std::min(c.before, c.behind), high = std::max(c.before, c.behind);
    return feature_name(kind | 2, static_cast<std::uint32_t>(low), static_cast<std::uint32_t>(high));
  }
  if (!from_side && !to_side) return feature_name(kind | 4, vertex(c.behind), 0);
  const int edge = from_side ? c.behind : c.before, side = from_side ? c.before : c.behind;
  const std::uint32_t u = vertex(edge), v = vertex(edge + 1);
  return feature_name(kind | 6, static_cast<std::uint32_t>(side), feature_name(6, std::min(u, v), std::max(u, v)));
}

}  // namespace

Slack slack_of(double radius_a, double radius_b) {
  constexpr double kPreference = 1e-3, kRim = 1e-4;
  const double size = std::min(radius_a, radius_b);
  return {kPreference * size, kRim * size};
}

std::uint32_t feature_name(std::uint32_t kind, std::uint32_t first, std::uint32_t second) {
  std::uint64_t word =
      (static_cast<std::uint64_t>(kind) * 0x9e3779b97f4a7c15ULL) ^ (static_cast<std::uint64_t>(first) << 32 | second);
  word = (word ^ (word >> 31)) * 0xbf58476d1ce4e5b9ULL;
  return static_cast<std::uint32_t>(word >> 32);
}

namespace {

constexpr int kLineName = 1 << 20, kCapName = kLineName + 2, kTiltedCapName = kCapName + 2 * kMostCorners;

/// A cap as a polygon. Its corners stay with the body while it is level with what `toward` is the direction of, to
/// 1e-4 of its radius; else the first is the farthest along `toward`.
void place_cap(const Placed& cylinder, int cap, const Vector3& toward, PlacedFace& out) {
  constexpr double kLevel = 1e-4;
  const Vector3 normal = cap_normal(cylinder, cap);
  Vector3 first = toward - normal.dot(toward) * normal;
  const double slope = first.norm();
  const bool level = slope < kLevel;
  first = level ? Vector3(cylinder.rotation.col((cylinder.round.axis + 1) % 3)) : Vector3(first / slope);
  const Vector3 second = normal.cross(first), center = cylinder.location + cylinder.round.half * normal;
  out.normal = normal;
  out.index = cap;
  out.count = kMostCorners;
  for (int i = 0; i < kMostCorners; ++i) {
    const double angle = i * 2 * std::numbers::pi / kMostCorners;
    out.corner[at(i)] = center + cylinder.round.radius * (std::cos(angle) * first + std::sin(angle) * second);
    out.vertex[at(i)] = (level ? kCapName : kTiltedCapName) + cap * kMostCorners + i;
  }
}

/// The line of a side along `direction`, between the points of both ends that are farthest.
void place_line(const Placed& solid, const Vector3& direction, PlacedFace& out) {
  const Vector3 axis = solid.axis();
  Vector3 outward = direction;
  if (solid.round.is_cylinder()) outward = (direction - direction.dot(axis) * axis).normalized();
  out.normal = direction;
  out.index = 0;
  out.count = 2;
  for (int i = 0; i < 2; ++i) {
    out.corner[at(i)] = solid.location + (2 * i - 1) * solid.round.half * axis + solid.round.radius * outward;
    out.vertex[at(i)] = kLineName + i;
  }
}

}  // namespace

void place_facing(const Placed& solid, const Vector3& direction, PlacedFace& out) {
  if (!solid.round.is_round()) return place_face(solid, face_along(solid, direction), out);
  const double along = direction.dot(solid.axis());
  if (solid.round.is_cylinder() && std::abs(along) > std::numbers::sqrt2 / 2)
    place_cap(solid, along > 0 ? 1 : 0, direction, out);
  else
    place_line(solid, direction, out);
}

void place_face(const Placed& solid, int index, PlacedFace& out) {
  if (solid.round.is_cylinder()) return place_cap(solid, index, cap_normal(solid, index), out);
  const auto& face = solid.solid->faces[static_cast<std::size_t>(index)];
  const int corners = static_cast<int>(face.size());
  out.normal = solid.rotation * solid.solid->planes[static_cast<std::size_t>(index)].normal;
  out.index = index;
  out.count = std::min(corners, kMostCorners);
  for (int i = 0; i < out.count; ++i) {
    const int v = face[static_cast<std::size_t>(static_cast<long>(i) * corners / out.count)];
    out.vertex[static_cast<std::size_t>(i)] = v;
    out.corner[static_cast<std::size_t>(i)] = solid.vertex(v);
  }
}

namespace {

constexpr double kEqual = 1e-6;  // of directions: of faces that look alike the first

/// The same of a solid with a tree of faces: the first of those that come so near to the best.
int face_along_in(const Polyhedron& solid, const Vector3& local) {
  const auto bound = [&](const FaceTree::Node& node) { return node.along(local); };
  double most = -2;
  solid.looks.search(most, bound,
                     [&](std::uint32_t face) { most = std::max(most, solid.planes[face].normal.dot(local)); });
  const double least = most - kEqual;
  std::size_t best = solid.planes.size();
  solid.looks.search(least, bound, [&](std::uint32_t face) {
    if (face < best && solid.planes[face].normal.dot(local) >= least) best = face;
  });
  return static_cast<int>(best);
}

}  // namespace

int face_along(const Placed& solid, const Vector3& direction) {
  const Vector3 local = solid.rotation.transpose() * direction;
  if (!solid.solid->looks.empty()) return face_along_in(*solid.solid, local);
  int best = 0;
  double most = -2;
  for (std::size_t f = 0; f < solid.solid->planes.size(); ++f) {
    const double along = solid.solid->planes[f].normal.dot(local);
    if (along > most + kEqual) {
      most = along;
      best = static_cast<int>(f);
    }
  }
  return best;
}

bool clip_faces(const PlacedFace& reference, const PlacedFace& incident, Owner owner, double margin, double rim,
                Manifold& out) {
  const auto corner = [&](int i) -> const Vector3& {
    return reference.corner[static_cast<std::size_t>(i < reference.count ? i : i - reference.count)];
  };
  const Vector3& n = reference.normal;
  const Vector3 x = (corner(1) - corner(0)).normalized();
  const Frame frame{corner(0), x, n.cross(x), n};
  out.normal = owner == Owner::A ? Vector3(-n) : n;

  CutPolygon one, two;
  CutPolygon *from = &one, *to = &two;
  for (int i = 0; i < incident.count; ++i) {
    const Vector3 p = incident.corner[static_cast<std::size_t>(i)] - frame.origin;
    one.add({p.dot(frame.x), p.dot(frame.y), p.dot(n), i > 0 ? i - 1 : incident.count - 1, i});
  }
  double ax = 0, ay = 0;
  for (int side = 0; side < reference.count && from->count > 0; ++side) {
    const Vector3 end = corner(side + 1) - frame.origin;
    const double bx = end.dot(frame.x), by = end.dot(frame.y);
    const double length = std::sqrt((bx - ax) * (bx - ax) + (by - ay) * (by - ay));
    if (cut(*from, ax, ay, -(by - ay) / length, (bx - ax) / length, rim, kSide + side, *to)) std::swap(from, to);
    ax = bx;
    ay = by;
  }
  CutPolygon& low = *to;
  low.count = 0;
  for (int i = 0; i < from->count; ++i) {
    if ((*from)[i].height < margin) low.add((*from)[i]);
  }
  if (low.count == 0) return false;

  std::array<int, kMostPoints> chosen{};
  out.count = select(low, chosen);
  keep_deepest(low, rim, chosen, out.count);
  for (int k = 0; k < out.count; ++k) {
    const CutCorner& c = low[chosen[static_cast<std::size_t>(k)]];
    ContactPoint& point = out.points[static_cast<std::size_t>(k)];
    const Vector3 on_reference = frame.place(c.x, c.y, 0), on_incident = frame.place(c.x, c.y, c.height);
    point.on_a = owner == Owner::A ? on_reference : on_incident;
    point.on_b = owner == Owner::A ? on_incident : on_reference;
    point.distance = c.height;
    point.feature = name(reference, incident, owner, c);
  }
  return true;
}

void select_points(std::span<const ContactPoint> all, double slack, Manifold& out) {
  const Vector3& n = out.normal;
  const Vector3 x = n.cross(std::abs(n.x()) < 0.7 ? Vector3::UnitX() : Vector3::UnitY()).normalized(), y = n.cross(x);
  CutPolygon points;
  for (const ContactPoint& p : all) points.add({p.on_a.dot(x), p.on_a.dot(y), p.distance, 0, 0});
  std::array<int, kMostPoints> chosen{};
  out.count = select(points, chosen);
  keep_deepest(points, slack, chosen, out.count);
  for (int k = 0; k < out.count; ++k) {
    out.points[static_cast<std::size_t>(k)] = all[static_cast<std::size_t>(chosen[static_cast<std::size_t>(k)])];
  }
}

}  // namespace breve
