// Rays and points against one shape, in world axes.
#include "runtime/solid/probe.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/solid/place.hpp"
#include "runtime/solid/surface_pair.hpp"

namespace breve {

namespace {

/// The outward normal of a cylinder or capsule at a point of its surface, own frame.
Vector3 normal_at(const Round& round, const Vector3& point) {
  const double height = point[round.axis];
  Vector3 out = point;
  if (round.is_capsule()) {
    out[round.axis] = height - std::clamp(height, -round.half, round.half);
    return out.stableNormalized();
  }
  out[round.axis] = 0;
  const double across = out.norm();
  if (std::abs(height) - round.half < across - round.radius) return out / across;
  Vector3 cap = Vector3::Zero();
  cap[round.axis] = height < 0 ? -1 : 1;
  return cap;
}

/// The normal of the face through which a ray comes in at `point`, own frame.
Vector3 entered_face(const Polyhedron& solid, const Vector3& point, const Vector3& way) {
  double highest = -std::numeric_limits<double>::infinity();
  Vector3 normal = -way.stableNormalized();
  for (const Plane& plane : solid.planes) {
    const double height = plane.normal.dot(point) - plane.offset;
    if (!(plane.normal.dot(way) < 0) || height <= highest) continue;
    highest = height;
    normal = plane.normal;
  }
  return normal;
}

/// With `normal` zero where the ray starts inside.
bool meet_surface(const Surface& surface, const Vector3& origin, const Vector3& way, double& fraction,
                  Vector3& normal) {
  if (surface.inside(origin)) {
    fraction = 0;
    normal.setZero();
    return true;
  }
  Facet facet;
  if (!surface.raycast(origin, way, fraction, facet)) return false;
  normal = facet.normal.dot(way) > 0 ? Vector3(-facet.normal) : facet.normal;
  return true;
}

}  // namespace

bool meet_ray(const Shape& shape, const Pose& pose, const Vector3& start, const Vector3& way, double most,
              RayHit& hit) {
  const Matrix3 rotation = pose.orientation.toRotationMatrix();
  const Vector3 origin = rotation.transpose() * (start - pose.location), along = rotation.transpose() * way;
  double fraction = 0;
  Vector3 normal = Vector3::Zero();
  if (shape.surface() != nullptr) {
    if (!meet_surface(*shape.surface(), origin, along, fraction, normal)) return false;
  } else {
    if (!shape.raycast(origin, along, fraction)) return false;
    const Vector3 point = origin + fraction * along;
    // A ray that starts inside, or on the surface, has no face by which it came.
    if (fraction > 0) {
      if (shape.kind() == ShapeKind::Sphere)
        normal = point.stableNormalized();
      else
        normal =
            shape.round().is_round() ? normal_at(shape.round(), point) : entered_face(shape.polyhedron(), point, along);
    }
  }
  if (!(fraction <= most)) return false;
  hit.fraction = fraction;
  hit.point = start + fraction * way;
  hit.normal = normal.isZero(0) ? Vector3(-way.stableNormalized()) : Vector3(rotation * normal);
  return true;
}

bool nearest_to(const Shape& shape, const Pose& pose, const Vector3& point, double limit, Contact& found,
                NarrowCounters* counters) {
  // A ball without a radius, at the origin: coordinates relative to the point keep digits far from it.
  const Placed ball;
  Placed solid = place(shape, pose);
  solid.location = pose.location - point;
  const auto gap = [&] {
    if (!is_surface(shape)) return find_gap(ball, solid);
    const std::shared_ptr<Shape> stand_in = Shape::sphere(1);  // only its kind is looked at
    return surface_gap(*stand_in, ball, shape, solid, limit, counters);
  }();
  if (!(gap.distance <= limit)) return false;
  found = {point + gap.on_b, gap.normal, gap.distance};
  return true;
}

}  // namespace breve
