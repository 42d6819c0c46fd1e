// Balls against balls and polyhedra, in closed form.
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/solid/gap.hpp"

namespace breve {

namespace {

// A centre nearer than this (relative) to an edge gives no direction; the plane's normal serves.
constexpr double kOnSurface = 1e-12;

Vector3 nearest_on_segment(const Vector3& p, const Vector3& a, const Vector3& b) {
  const Vector3 d = b - a;
  return a + std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) * d;
}

/// The point of a face nearest to p, a point above its plane by `height`.
Vector3 nearest_on_face(const Polyhedron& solid, std::size_t face, const Vector3& p, double height) {
  const auto& corners = solid.faces[face];
  const Vector3& normal = solid.planes[face].normal;
  const auto corner = [&](std::size_t i) -> const Vector3& {
    return solid.vertices[static_cast<std::size_t>(corners[i % corners.size()])];
  };
  Vector3 nearest = p - height * normal;
  double square = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (normal.dot((corner(i + 1) - corner(i)).cross(p - corner(i))) >= 0) continue;
    const Vector3 q = nearest_on_segment(p, corner(i), corner(i + 1));
    if ((p - q).squaredNorm() < square) {
      square = (p - q).squaredNorm();
      nearest = q;
    }
  }
  return nearest;
}

/// Nearest surface point and outward normal there, in the polyhedron's frame; the distance is < 0 inside.
struct SurfacePoint {
  Vector3 point, normal;
  double distance;
};

SurfacePoint nearest_surface(const Polyhedron& solid, double radius, const Vector3& p) {
  double highest = -std::numeric_limits<double>::infinity();
  std::size_t top = 0;
  for (std::size_t f = 0; f < solid.planes.size(); ++f) {
    const double height = solid.planes[f].normal.dot(p) - solid.planes[f].offset;
    if (height > highest) {
      highest = height;
      top = f;
    }
  }
  const Vector3& normal = solid.planes[top].normal;
  if (highest <= 0) return {p - highest * normal, normal, highest};

  SurfacePoint best{p, normal, std::numeric_limits<double>::infinity()};
  for (std::size_t f = 0; f < solid.planes.size(); ++f) {
    const double height = solid.planes[f].normal.dot(p) - solid.planes[f].offset;
    if (height <= 0 || height >= best.distance) continue;
    const Vector3 q = nearest_on_face(solid, f, p, height);
    const double distance = (p - q).norm();
    if (distance < best.distance) best = {q, normal, distance};
  }
  if (best.distance > kOnSurface * radius) best.normal = (p - best.point) / best.distance;
  return best;
}

}  // namespace

Gap balls_gap(const Placed& a, const Placed& b) {
  const Vector3 apart = a.location - b.location;
  const double length = apart.stableNorm();
  Gap gap;
  if (length > 0) gap.normal = apart / length;
  gap.distance = length - a.radius - b.radius;
  gap.on_a = a.location - a.radius * gap.normal;
  gap.on_b = b.location + b.radius * gap.normal;
  return gap;
}

Gap ball_gap(const Placed& ball, const Placed& b) {
  const Vector3 p = b.rotation.transpose() * (ball.location - b.location);
  const SurfacePoint surface = nearest_surface(*b.solid, b.radius, p);
  Gap gap;
  gap.normal = b.rotation * surface.normal;
  gap.distance = surface.distance - ball.radius;
  gap.on_a = ball.location - ball.radius * gap.normal;
  gap.on_b = b.location + b.rotation * surface.point;
  return gap;
}

}  // namespace breve
