// Distance and overlap of cylinders and capsules from anything convex. Balls have closed forms. Where the middle of
// what is nearest lies over a face, that face decides. Else the nearest points of the cores tell, if they are apart.
// Where they touch, the separation along a normal is climbed: moved apart along it, the solids have nearest points,
// whose direction separates no worse. Near a maximum this converges as fast as the curvature is small.
#include <algorithm>
#include <cmath>

#include "runtime/solid/gap.hpp"
#include "runtime/solid/triangle.hpp"

namespace breve {

namespace {

constexpr double kLift = 1e-2;       // of the smaller radius: how far apart the solids are held while climbing
constexpr double kShrink = 0.2;      // of a core: a shallower overlap shows its normal when the core is made smaller
constexpr double kLineSlope = 1e-2;  // sine below which a side faces the other solid as a line
constexpr double kTold = 1e-10;      // of the sizes: nearest points that are closer do not tell a direction
constexpr int kMostClimbs = 60;

/// How far apart two solids are along a normal from b toward a.
double separation(const Placed& a, const Placed& b, const Vector3& normal) {
  return -a.reach(-normal) - b.reach(normal);
}

/// A ball against a cylinder or capsule.
Gap ball_round_gap(const Placed& ball, const Placed& b) {
  const Round& round = b.round;
  const Vector3 p = b.rotation.transpose() * (ball.location - b.location);
  const double along = p[round.axis];
  Vector3 outward = p;
  outward[round.axis] = 0;
  const double far = outward.norm();
  outward = far > 0 ? Vector3(outward / far) : Vector3(Vector3::Unit((round.axis + 1) % 3));
  const Vector3 end = std::copysign(1.0, along) * Vector3::Unit(round.axis);
  const double over = std::abs(along) - round.half, beside = far - round.radius;

  Vector3 normal = outward, surface = p;
  double distance = beside;
  if (round.is_capsule()) {
    const Vector3 core = std::clamp(along, -round.half, round.half) * Vector3::Unit(round.axis);
    const double length = (p - core).norm();
    if (length > 0) normal = (p - core) / length;
    distance = length - round.radius;
  } else if (over > 0 && beside > 0) {
    distance = std::hypot(over, beside);
    normal = (over * end + beside * outward) / distance;
  } else if (over > beside) {
    distance = over;
    normal = end;
  }
  surface = p - distance * normal;
  Gap gap;
  gap.normal = b.rotation * normal;
  gap.distance = distance - ball.radius;
  gap.on_a = ball.location - ball.radius * gap.normal;
  gap.on_b = b.location + b.rotation * surface;
  return gap;
}

/// Fill in a gap whose lowest point of a, `low`, stands over the face with this outward normal.
void take_face(const Vector3& normal, double distance, const Vector3& low, Gap& gap) {
  gap = Gap{};
  gap.normal = normal;
  gap.distance = distance;
  gap.on_a = low;
  gap.on_b = low - distance * normal;
}

/// Does a face of the polyhedron b decide? Apart it does if the lowest point of a stands over it; overlapping, if that
/// point is at least as deep below all other faces: no shorter way takes it out.
bool face_decides(const Placed& a, const Placed& b, Gap& gap) {
  Placed local = a;
  local.location = b.rotation.transpose() * (a.location - b.location);
  local.rotation = b.rotation.transpose() * a.rotation;
  double highest = -std::numeric_limits<double>::infinity();
  const Plane* top = nullptr;
  for (const Plane& plane : b.solid->planes) {
    const double height = -local.reach(-plane.normal) - plane.offset;
    if (height <= highest) continue;
    highest = height;
    top = &plane;
  }
  const Vector3 low = local.middle(-top->normal);
  const Vector3 foot = highest > 0 ? Vector3(low - highest * top->normal) : low;
  const double most = std::min(highest, 0.0);
  for (const Plane& plane : b.solid->planes)
    if (&plane != top && plane.normal.dot(foot) - plane.offset > most) return false;
  take_face(b.rotation * top->normal, highest, b.location + b.rotation * low, gap);
  return true;
}

/// The same for the caps of a cylinder b.
bool cap_decides(const Placed& a, const Placed& b, Gap& gap) {
  if (!b.round.is_cylinder()) return false;
  const Vector3 normal = (a.location - b.location).dot(b.axis()) >= 0 ? b.axis() : Vector3(-b.axis());
  const Vector3 low = a.middle(-normal), from = low - b.location;
  const double height = normal.dot(from) - b.round.half;
  const double beside = (from - normal.dot(from) * normal).norm() - b.round.radius;
  const double most = std::min(height, 0.0);
  if (beside > most || -height - 2 * b.round.half > most) return false;
  take_face(normal, height, low, gap);
  return true;
}

/// Does a cap of the cylinder a decide, over or under which the lowest corner of the triangle b is? As cap_decides().
bool cap_takes(const Placed& a, const Placed& b, Gap& gap) {
  if (!a.round.is_cylinder()) return false;
  Vector3 cap = a.axis();
  if (cap.dot((b.vertex(0) + b.vertex(1) + b.vertex(2)) / 3 - a.location) < 0) cap = -cap;
  Vector3 corner = b.vertex(0);
  for (const int i : {1, 2})
    if (cap.dot(b.vertex(i) - corner) < 0) corner = b.vertex(i);
  const Vector3 from = corner - a.location;
  const double height = cap.dot(from) - a.round.half;
  const double beside = (from - cap.dot(from) * cap).norm() - a.round.radius;
  if (beside > std::min(height, 0.0) || -height > a.round.half) return false;
  take_face(-cap, height, corner - height * cap, gap);
  return true;
}

/// Is a point in a cylinder or capsule?
bool holds(const Placed& solid, const Vector3& point) {
  const Vector3 from = point - solid.location;
  const double along = solid.axis().dot(from), half = solid.round.half;
  if (solid.round.is_cylinder())
    return std::abs(along) <= half && (from - along * solid.axis()).norm() <= solid.round.radius;
  return (from - std::clamp(along, -half, half) * solid.axis()).norm() <= solid.round.radius;
}

Placed moved(const Placed& solid, const Vector3& by) {
  Placed there = solid;
  there.location += by;
  return there;
}

/// A core that is smaller all around.
Placed shrunk(const Placed& solid) {
  Placed smaller = solid;
  Round& round = smaller.round;
  if (!round.is_round()) return smaller;
  const double by = kShrink * (round.is_cylinder() ? std::min(round.radius, round.half) : round.half);
  round.half -= by;
  if (round.is_cylinder()) round.radius -= by;
  return smaller;
}

Placed polygons_of(const Placed& solid) {
  Placed polygons = solid;
  polygons.round = {};
  return polygons;
}

/// A normal to climb from, where the cores overlap.
Vector3 rough_normal(const Placed& a, const Placed& b) {
  Gap gap;
  if (separated(shrunk(a), shrunk(b), gap) && gap.distance > kClose * (a.radius + b.radius)) return gap.normal;
  if (!a.round.is_capsule() || !b.round.is_capsule()) return best_axis(polygons_of(a), polygons_of(b), 0).normal;
  const Vector3 product = a.axis().cross(b.axis());
  return product.norm() > kLineSlope ? Vector3(product.normalized()) : Vector3(a.rotation.col((a.round.axis + 1) % 3));
}

/// Climb to the normal next to `gap.normal` along which the solids are farthest apart, until that is so but for the
/// round-off of nearest points.
void climb(const Placed& a, const Placed& b, Gap& gap) {
  const double lift_to = kLift * std::min(a.radius, b.radius), margin = a.round.margin() + b.round.margin();
  gap.distance = separation(a, b, gap.normal);
  Vector3 normal = gap.normal;
  double distance = gap.distance;
  for (int i = 0; i < kMostClimbs; ++i) {
    const double lift = lift_to - distance - margin;
    Gap apart;
    if (!separated(a, moved(b, -lift * normal), apart)) break;
    distance = separation(a, b, apart.normal);
    if (i > 0 && distance <= gap.distance) break;
    gap.on_a = apart.on_a - a.round.margin() * apart.normal;
    gap.on_b = apart.on_b + lift * normal + b.round.margin() * apart.normal;
    gap.normal = normal = apart.normal;
    gap.distance = distance;
  }
}

/// The lines of sides that face the other solid; a gap has both edges or none.
void note_lines(const Placed& a, const Placed& b, Gap& gap) {
  const auto line = [&](const Placed& solid, const Vector3& on, Vector3& start, Vector3& edge) {
    if (!solid.round.is_round()) return !edge.isZero(0);
    const Vector3 axis = solid.axis();
    if (std::abs(axis.dot(gap.normal)) > kLineSlope) return false;
    edge = 2 * solid.round.half * axis;
    start = on - (axis.dot(on - solid.location) + solid.round.half) * axis;
    return true;
  };
  const bool both = line(a, gap.on_a, gap.start_a, gap.edge_a) && line(b, gap.on_b, gap.start_b, gap.edge_b);
  if (!both) gap.edge_a = gap.edge_b = Vector3::Zero();
}

/// The nearest points of cores that are well apart, brought to the surfaces.
void leave_cores(const Placed& a, const Placed& b, Gap& gap) {
  gap.on_a -= a.round.margin() * gap.normal;
  gap.on_b += b.round.margin() * gap.normal;
  gap.distance -= a.round.margin() + b.round.margin();
}

/// The gap of two solids that are neither balls nor decided by a face.
Gap general_gap(const Placed& a, const Placed& b, double enough) {
  Gap gap;
  const double margin = a.round.margin() + b.round.margin();
  const bool apart = separated(a, b, gap, enough + margin);
  if (apart && gap.distance > kClose * (a.radius + b.radius)) {
    leave_cores(a, b, gap);
  } else {
    if (!apart || gap.distance < kTold * (a.radius + b.radius)) gap.normal = rough_normal(a, b);
    climb(a, b, gap);
  }
  note_lines(a, b, gap);
  return gap;
}

}  // namespace

Gap round_gap(const Placed& a, const Placed& b, double enough) {
  if (a.solid == nullptr) return ball_round_gap(a, b);
  if (b.solid == nullptr) return flipped(ball_round_gap(b, a));
  Gap gap;
  if ((!b.round.is_round() && face_decides(a, b, gap)) || cap_decides(a, b, gap)) return gap;
  if ((!a.round.is_round() && face_decides(b, a, gap)) || cap_decides(b, a, gap)) return flipped(gap);
  return general_gap(a, b, enough);
}

Gap round_triangle_gap(const Placed& a, const Placed& b, double enough) {
  const Vector3 corner = b.vertex(0);
  Vector3 normal = b.rotation * b.solid->planes[0].normal;
  if (!b.outer && normal.dot(a.location - corner) < 0) normal = -normal;
  const Vector3 low = a.middle(-normal);
  const double height = normal.dot(low - corner);
  const auto over_edge = [&](int i) {
    const Vector3 from = b.vertex(i), along = b.vertex((i + 1) % 3) - from;
    return (b.rotation * b.solid->planes[0].normal).dot(along.cross(low - from)) >= 0;
  };
  Gap gap;
  // Behind the plane it overlaps for certain only where it also reaches to the other side.
  const bool over = over_edge(0) && over_edge(1) && over_edge(2);
  if (over && height >= 0) {
    take_face(normal, height, low, gap);
    return gap;
  }
  if (cap_takes(a, b, gap)) {
    const double back = gap.distance;
    if (back >= 0 || gap.normal.dot(normal) >= 0) return gap;
    take_face(normal, height, low, gap);
    if (b.outer && backward(gap.distance, back, std::min(a.radius, b.radius))) {
      gap.back = back;
      return gap;
    }
  }
  if (over && holds(a, low - height * normal)) {
    take_face(normal, height, low, gap);
    return gap;
  }
  const double margin = a.round.margin();
  const bool apart = separated(a, b, gap, std::max(enough, kClose * a.radius) + margin);
  if (apart && gap.distance > kClose * a.radius) {
    leave_cores(a, b, gap);
  } else {
    // The way out leads to the side of the normal.
    if (!apart || gap.distance < kTold * a.radius || gap.normal.dot(normal) < 0) gap.normal = normal;
    climb(a, b, gap);
    if (gap.normal.dot(normal) < 0) {
      const double back = gap.distance;
      take_face(normal, height, low, gap);
      if (b.outer && backward(gap.distance, back, std::min(a.radius, b.radius))) gap.back = back;
    }
  }
  note_lines(a, b, gap);
  return gap;
}

}  // namespace breve
