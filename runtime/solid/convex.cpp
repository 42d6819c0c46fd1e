// A convex polyhedron from the faces a script gives: corners are merged, faces turned outward, and whatever is not
// a closed convex solid around the origin is refused with the face that is wrong.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/solid/polyhedron.hpp"

namespace breve {

namespace {

// Corners closer than this fraction of the extent are one corner, and a face may be warped by as much: scripts compute
// the same corner in several ways, and literals have some seven digits.
constexpr double kTolerance = 1e-6;
constexpr std::size_t kMaxCorners = 10000;

[[noreturn]] void refuse(const std::string& why) { throw Error(ErrorCode::Argument, "a convex shape " + why); }

/// Largest distance of a corner from the origin along an axis. Refuses corners that are not finite.
double measure(const std::vector<std::vector<Vector3>>& faces) {
  double extent = 0;
  std::size_t corners = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].size() < 3) {
      refuse(fmt::format("has a face {} of {} vertices (must be at least 3)", f, faces[f].size()));
    }
    corners += faces[f].size();
    for (std::size_t i = 0; i < faces[f].size(); ++i) {
      const Vector3& p = faces[f][i];
      if (!p.allFinite()) {
        refuse(fmt::format("has vertex {} of face {} at ({}, {}, {}) (must be finite)", i, f, p.x(), p.y(), p.z()));
      }
      extent = std::max(extent, p.cwiseAbs().maxCoeff());
    }
  }
  if (corners > kMaxCorners) refuse(fmt::format("has {} corners (at most {})", corners, kMaxCorners));
  return extent;
}

int find_or_add(std::pmr::vector<Vector3>& vertices, const Vector3& p, double tolerance) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if ((vertices[i] - p).cwiseAbs().maxCoeff() <= tolerance) return static_cast<int>(i);
  }
  vertices.push_back(p);
  return static_cast<int>(vertices.size()) - 1;
}

/// Merge equal corners; drop a corner that repeats the one before it.
void weld(Polyhedron& solid, const std::vector<std::vector<Vector3>>& faces, double tolerance) {
  for (std::size_t f = 0; f < faces.size(); ++f) {
    std::pmr::vector<int> face;
    for (const Vector3& p : faces[f]) {
      const int v = find_or_add(solid.vertices, p, tolerance);
      if (face.empty() || face.back() != v) face.push_back(v);
    }
    while (face.size() > 1 && face.front() == face.back()) face.pop_back();
    std::pmr::vector<int> sorted = face;
    std::sort(sorted.begin(), sorted.end());
    if (face.size() < 3 || std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
      refuse(fmt::format("has a face {} that intersects itself or has fewer than 3 different vertices", f));
    }
    solid.faces.push_back(std::move(face));
  }
}

/// Turn face `f` counter-clockwise seen from outside; refuse it if some corner of the solid lies beyond it.
void orient(Polyhedron& solid, std::size_t f, const Vector3& inside, double tolerance) {
  Plane& plane = solid.planes[f];
  auto& face = solid.faces[f];
  const auto corner = [&](std::size_t i) -> const Vector3& {
    return solid.vertices[static_cast<std::size_t>(face[i % face.size()])];
  };
  if (plane.normal.squaredNorm() < 0.5) refuse(fmt::format("has a face {} without area", f));
  if (plane.normal.dot(corner(0) - inside) < 0) {
    std::reverse(face.begin(), face.end());
    plane.normal = -plane.normal;
  }
  plane.offset = plane.normal.dot(corner(0));
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (std::abs(plane.normal.dot(corner(i)) - plane.offset) > tolerance) {
      refuse(fmt::format("has a face {} that is not flat", f));
    }
    const Vector3 edge = corner(i + 1) - corner(i);
    if (plane.normal.dot(edge.cross(corner(i + 2) - corner(i + 1))) < -tolerance * edge.norm()) {
      refuse(fmt::format("has a face {} that is not a convex polygon", f));
    }
  }
  for (const Vector3& p : solid.vertices) {
    if (plane.normal.dot(p) - plane.offset > tolerance) {
      refuse(fmt::format("is not convex: ({}, {}, {}) lies outside face {}", p.x(), p.y(), p.z(), f));
    }
  }
  if (plane.offset <= tolerance) refuse(fmt::format("does not contain the origin: it lies outside face {}", f));
}

}  // namespace

Polyhedron make_convex(const std::vector<std::vector<Vector3>>& faces) {
  if (faces.size() < 4) refuse(fmt::format("has {} faces (must be at least 4)", faces.size()));
  const double extent = measure(faces);
  const double tolerance = kTolerance * extent;
  Polyhedron solid;
  weld(solid, faces, tolerance);
  update_planes(solid);
  Vector3 inside = Vector3::Zero();
  for (const Vector3& p : solid.vertices) inside += p / static_cast<double>(solid.vertices.size());
  for (std::size_t f = 0; f < solid.faces.size(); ++f) orient(solid, f, inside, tolerance);
  connect(solid);
  update_planes(solid);
  return solid;
}

}  // namespace breve
