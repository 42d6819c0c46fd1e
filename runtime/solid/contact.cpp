// Closest points of two solids: which method serves which pair.
#include "runtime/solid/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/solid/gap.hpp"
#include "runtime/solid/place.hpp"
#include "runtime/solid/surface_pair.hpp"
#include "runtime/solid/triangle.hpp"

namespace breve {

namespace {

Gap polyhedra_gap(const Placed& a, const Placed& b) {
  const double size = a.radius + b.radius;
  Gap gap;
  const bool apart = separated(a, b, gap);
  if (apart && gap.distance > kClose * size) return gap;
  Gap axis = best_axis(a, b, apart ? gap.distance : 0);
  if (apart && axis.distance < gap.distance - kAgree * size) return gap;
  place_witnesses(a, b, axis);
  return axis;
}

}  // namespace

Gap flipped(const Gap& gap) {
  Gap other = gap;
  std::swap(other.on_a, other.on_b);
  std::swap(other.edge_a, other.edge_b);
  std::swap(other.start_a, other.start_b);
  other.normal = -gap.normal;
  return other;
}

// The witnesses of the two solids moved apart along the normal, then brought back.
void place_witnesses(const Placed& a, const Placed& b, Gap& gap) {
  const double lift = 0.25 * std::min(a.radius, b.radius) - gap.distance;
  Placed lowered = b;
  lowered.location -= lift * gap.normal;
  Gap apart;
  if (separated(a, lowered, apart)) {
    gap.on_a = apart.on_a;
    gap.on_b = apart.on_b + lift * gap.normal;
  } else {
    gap.on_a = gap.on_b = a.extreme(-gap.normal);
  }
}

Placed place(const Shape& shape, const Pose& pose) {
  const bool ball = shape.kind() == ShapeKind::Sphere;  // a surface stands for its hull, or nothing
  return {ball ? nullptr : &shape.polyhedron(),
          shape.bounding_radius(),
          pose.location,
          pose.orientation.toRotationMatrix(),
          false,
          false,
          shape.round()};
}

Gap find_gap(const Placed& a, const Placed& b) {
  if (b.flat) return triangle_gap(a, b);
  if (a.flat) return flipped(triangle_gap(b, a));
  if (a.round.is_round() || b.round.is_round()) return round_gap(a, b);
  if (a.solid == nullptr && b.solid == nullptr) return balls_gap(a, b);
  if (a.solid == nullptr) return ball_gap(a, b);
  if (b.solid == nullptr) return flipped(ball_gap(b, a));
  return polyhedra_gap(a, b);
}

namespace {

/// With a limit as surface_gap has.
Contact find_contact(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, double limit,
                     NarrowCounters* counters) {
  // Coordinates relative to a keep digits far from the origin.
  Placed at = place(a, pa), other = place(b, pb);
  other.location = pb.location - pa.location;
  at.location.setZero();
  const bool surface = is_surface(a) || is_surface(b);
  const Gap gap = surface ? surface_gap(a, at, b, other, limit, counters) : find_gap(at, other);
  return {pa.location + (gap.on_a + gap.on_b) / 2, gap.normal, gap.distance};
}

}  // namespace

Contact closest(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb) {
  return find_contact(a, pa, b, pb, std::numeric_limits<double>::infinity(), nullptr);
}

bool closest_within(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, double limit, Contact& contact,
                    NarrowCounters* counters) {
  // Spheres around both that are apart settle it, a hair farther than round-off; also refuses numbers that are not
  // finite. A solid deep in the ground may be outside the sphere around the surface.
  const bool ground = a.kind() == ShapeKind::HeightField || b.kind() == ShapeKind::HeightField;
  const double reach = (a.bounding_radius() + b.bounding_radius()) * (1 + 1e-12) + std::max(limit, 0.0);
  if (!ground && !((pa.location - pb.location).squaredNorm() <= reach * reach)) return false;
  const Contact found = find_contact(a, pa, b, pb, limit, counters);
  if (!(found.distance <= limit)) return false;
  contact = found;
  return true;
}

Pose pose_at(const Motion& motion, double t) {
  Pose pose{motion.start.location + t * motion.velocity, motion.start.orientation};
  const double rate = motion.rotational_velocity_world.stableNorm();
  if (rate > 0) {
    const Quaternion rotation(Eigen::AngleAxisd(rate * t, motion.rotational_velocity_world / rate));
    pose.orientation = (rotation * pose.orientation).normalized();
  }
  return pose;
}

double touch_tolerance(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb) {
  // Sizes: the geometry's own round-off. Places: that of poses that were rounded after a step.
  constexpr double kOfSize = 1e-12, kOfCoordinate = 16 * std::numeric_limits<double>::epsilon();
  const double coordinate = std::max(pa.location.cwiseAbs().maxCoeff(), pb.location.cwiseAbs().maxCoeff());
  return kOfSize * (a.bounding_radius() + b.bounding_radius()) + kOfCoordinate * coordinate;
}

}  // namespace breve
