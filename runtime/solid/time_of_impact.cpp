// First touch of two moving solids by conservative advancement (Mirtich 1996), with bounds of second order.
// At each stop the closest points give a direction n. Let n rotate at some constant rate; then along n every vertex
// moves as f + f' t + r, |r| <= M t^2 / 2, and the gap stays open until the lowest of these parabolas reaches zero. Any
// rate is valid; the one that follows the touching features makes the last stops converge like Newton's method, where
// the classical bound on speeds converges only linearly. Several rates are tried and the longest safe step is taken.
#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/solid/clearance.hpp"
#include "runtime/solid/contact.hpp"
#include "runtime/solid/gap.hpp"
#include "runtime/solid/place.hpp"
#include "runtime/solid/surface_pair.hpp"
#include "runtime/solid/triangle.hpp"

namespace breve {

namespace {

constexpr double kShortestStep = 1e-13;  // of the interval: why the loop ends even if every bound is lost to round-off
constexpr int kMaxStops = 4000;          // a touch is reported if even these do not decide: never missed
constexpr int kMaxPairs = 64;
constexpr int kNewtonSteps = 8;

/// Two bodies at one moment, seen from the origin of a. A solid of revolution has no points that rotate about its axis,
/// so that only the rest of its spin moves it; that rest rotates itself, by at most `drift` (rad/s^2).
struct Scene {
  Placed a, b;       // a.location is zero
  Vector3 velocity;  // of b relative to a
  Vector3 spin_a, spin_b;
  double drift_a = 0, drift_b = 0;

  void set_spins(const Vector3& of_a, const Vector3& of_b) {
    set_spin(a, of_a, spin_a, drift_a);
    set_spin(b, of_b, spin_b, drift_b);
  }
  static void set_spin(const Placed& body, const Vector3& whole, Vector3& spin, double& drift) {
    spin = whole;
    if (!body.round.is_round()) return;
    const double along = whole.dot(body.axis());
    spin -= along * body.axis();
    drift = std::abs(along) * spin.norm();
  }
};

/// Vertices of one body along the rotating direction: value and rate of each, and the extreme at a later time.
struct Along {
  const Placed& body;
  Vector3 value, rate;  // in the body's frame: f = value . r + value0, f' = rate . r + rate0
  double value0, rate0;

  struct Line {
    double value, rate;
  };
  /// The vertex whose line is lowest (sign = 1) or highest (sign = -1) after t; a ball's centre less its radius.
  Line extreme(double t, double sign) const {
    if (body.solid == nullptr) return {value0 - sign * body.radius, rate0};
    const Vector3 later = sign * (value + t * rate);
    if (body.round.is_round()) {
      const Vector3 r = body.round.core(-later);
      return {value.dot(r) + value0 - sign * body.round.margin(), rate.dot(r) + rate0};
    }
    Line best{};
    double least = std::numeric_limits<double>::infinity();
    for (const Vector3& r : body.solid->vertices) {
      const double height = later.dot(r);
      if (height >= least) continue;
      least = height;
      best = {value.dot(r), rate.dot(r)};
    }
    return {best.value + value0, best.rate + rate0};
  }
};

/// Bound on |second derivative| of n . r for a vertex r of a body, with n rotating at `normal_spin` and the body at
/// `spin`.
double bend(const Placed& body, const Vector3& n, const Vector3& normal_spin, const Vector3& spin, double drift) {
  if (body.solid == nullptr || (normal_spin == spin && drift == 0)) return 0;
  if (normal_spin.isZero(0)) return (spin.cross(n).norm() * spin.norm() + drift) * body.radius;
  const double rate = normal_spin.norm() + spin.norm();
  return (rate * rate + drift) * body.radius;
}

/// A time up to which the gap along `n`, rotating at `normal_spin`, stays above `target`; `span` if it is so for all of
/// it.
double safe_time(const Scene& s, const Vector3& n, const Vector3& normal_spin, double target, double span) {
  const Vector3 n_rate = normal_spin.cross(n);
  const Along a{s.a, s.a.rotation.transpose() * n, s.a.rotation.transpose() * (n_rate + n.cross(s.spin_a)), 0, 0};
  const Along b{s.b, s.b.rotation.transpose() * n, s.b.rotation.transpose() * (n_rate + n.cross(s.spin_b)),
                n.dot(s.b.location), n_rate.dot(s.b.location) + n.dot(s.velocity)};
  const double w = normal_spin.norm(), v = s.velocity.norm();
  const double curve = bend(s.a, n, normal_spin, s.spin_a, s.drift_a) + bend(s.b, n, normal_spin, s.spin_b, s.drift_b) +
                       w * w * (s.b.location.norm() + v * span) + 2 * w * v;
  // The lowest parabola is a minimum of concave functions that is positive at 0: roots from the right fall to the
  // first.
  double t = span;
  for (int pair = 0; pair < kMaxPairs; ++pair) {
    const auto low = a.extreme(t, 1), high = b.extreme(t, -1);
    const double c = low.value - high.value - target, slope = low.rate - high.rate;
    if (c <= 0) return 0;
    if (c + t * (slope - curve * t / 2) >= 0) return t;
    const double root = 2 * c / (std::sqrt(slope * slope + 2 * curve * c) - slope);
    if (!(root < t)) return t;
    t = root;
  }
  return 0;
}

/// The rate at which a plane rotates that keeps both edges in it: its normal n stays perpendicular to each.
Vector3 rotate_with_edges(const Gap& gap, const Scene& s) {
  const Vector3& n = gap.normal;
  const Vector3 x = gap.edge_a.normalized(), z = x.cross(n);
  const double along_x = s.spin_a.cross(n).dot(x);
  const Vector3 e = gap.edge_b.normalized();
  const double ez = e.dot(z);
  if (std::abs(ez) < 1e-3) return s.spin_a;
  const double along_z = (s.spin_b.cross(n).dot(e) - along_x * e.dot(x)) / ez;
  return n.cross(along_x * x + along_z * z);
}

double longest_safe_time(const Scene& s, const Gap& gap, double target, double span) {
  std::array<Vector3, 4> normal_spins{Vector3::Zero(), s.spin_a, s.spin_b, s.spin_a};
  if (!gap.edge_a.isZero(0)) normal_spins[3] = rotate_with_edges(gap, s);
  double longest = 0;
  for (std::size_t i = 0; i < normal_spins.size() && longest < span; ++i) {
    const bool tried = std::find(normal_spins.begin(), normal_spins.begin() + static_cast<std::ptrdiff_t>(i),
                                 normal_spins[i]) != normal_spins.begin() + static_cast<std::ptrdiff_t>(i);
    if (!tried) longest = std::max(longest, safe_time(s, gap.normal, normal_spins[i], target, span));
  }
  return longest;
}

/// When two balls that are `x` apart and move at relative velocity `v` are `reach` apart for the first time; infinity:
/// never. The discriminant is taken from the cross product, which keeps its digits for balls that graze.
double balls_meet(const Vector3& x, const Vector3& v, double reach) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double c = (x.norm() - reach) * (x.norm() + reach);
  if (c <= 0) return 0;
  const double approach = -x.dot(v);
  const double discriminant = v.squaredNorm() * reach * reach - x.cross(v).squaredNorm();
  if (approach <= 0 || discriminant < 0) return kNever;
  return c / (approach + std::sqrt(discriminant));
}

/// The same where products of lengths and speeds are no longer numbers: in other units of both.
/// @return  0 where even these do not tell
double far_balls_meet(const Vector3& x, const Vector3& v, double reach) {
  const double length = std::max(x.cwiseAbs().maxCoeff(), reach), speed = v.cwiseAbs().maxCoeff();
  if (!std::isfinite(length) || !std::isfinite(speed)) return 0;
  const double time = balls_meet(x / length, v / speed, reach / length) * (length / speed);
  return std::isnan(time) ? 0 : time;
}

/// A moving solid, as seen from its own position, and its motion. Only the solid itself is read of `body`.
struct Mover {
  Placed body;
  const Motion& motion;

  Placed at(double t) const {
    const Pose pose = pose_at(motion, t);
    Placed placed = body;
    placed.location = pose.location;
    placed.rotation = pose.orientation.toRotationMatrix();
    return placed;
  }
};

/// Two convex solids, or one and a triangle.
class Advancement {
 public:
  Advancement(const Mover& a, const Mover& b, double tolerance, double h)
      : a_(a), b_(b), h_(h), tolerance_(tolerance) {}

  /// The first touch in (0, h]; not whether they touch already.
  bool run(double& t);

 private:
  bool both_balls() const { return a_.body.solid == nullptr && b_.body.solid == nullptr; }
  Scene scene(double t) const;
  bool touches(double t, Gap& gap) const {
    const Scene s = scene(t);
    gap = find_gap(s.a, s.b);
    return gap.distance <= tolerance_;
  }
  double refined(double t, Gap gap) const;

  Mover a_, b_;
  double h_;
  double tolerance_;
};

Scene Advancement::scene(double t) const {
  Scene s{a_.at(t), b_.at(t), b_.motion.velocity - a_.motion.velocity, Vector3::Zero(), Vector3::Zero()};
  s.set_spins(a_.motion.rotational_velocity_world, b_.motion.rotational_velocity_world);
  s.a.location.setZero();
  s.b.location = b_.motion.start.location - a_.motion.start.location + t * s.velocity;
  return s;
}

/// The last fraction of the way by Newton's method: the gap that counts as touching, closed at the speed of the closest
/// points. It matters for a touch at a shallow angle, where a gap of 1e-12 can be 1e-8 s.
double Advancement::refined(double t, Gap gap) const {
  for (int i = 0; i < kNewtonSteps && gap.distance > 0 && t < h_; ++i) {
    const Scene s = scene(t);
    const Vector3 speed_a = s.spin_a.cross(gap.on_a);
    const Vector3 speed_b = s.velocity + s.spin_b.cross(gap.on_b - s.b.location);
    const double closing = gap.normal.dot(speed_b - speed_a);
    const double next = t + gap.distance / closing;
    Gap then;
    if (!(closing > 0 && next <= h_ && touches(next, then) && then.distance > -tolerance_)) break;
    t = next;
    gap = then;
  }
  return t;
}

bool Advancement::run(double& t) {
  Gap gap;
  if (touches(0, gap)) return false;
  const Scene start = scene(0);
  const double reach = a_.body.radius + b_.body.radius;
  double now = balls_meet(start.b.location, start.velocity, reach);
  if (std::isnan(now)) now = far_balls_meet(start.b.location, start.velocity, reach);
  if (both_balls() && now <= h_) {
    t = now;
    return true;
  }
  // A touch at the end must not count as touching from the start in the next interval: it is a hit at h.
  const bool decided = both_balls() || now > h_;
  now = decided ? h_ : now * (1 - 1e-12);
  for (int stop = 0; stop < kMaxStops; ++stop) {
    if (touches(now, gap)) {
      t = refined(now, gap);
      return true;
    }
    if (now >= h_) return false;
    const double left = h_ - now;
    now = std::min(h_, now + std::max(longest_safe_time(scene(now), gap, tolerance_ / 2, left), kShortestStep * h_));
  }
  t = now;
  return true;
}

/// How far a point of one body, within `radius` of its place, goes in a second as seen from the other body at most. The
/// two are up to `apart` from one another.
double speed_seen(const Mover& body, const Mover& from, double radius, double apart) {
  return (body.motion.velocity - from.motion.velocity).norm() + body.motion.rotational_velocity_world.norm() * radius +
         from.motion.rotational_velocity_world.norm() * (apart + radius);
}

/// A convex solid against the facets it may meet on its way; each that is met shortens the rest of the search.
class FacetAdvancement final : public FacetVisitor {
 public:
  FacetAdvancement(const Mover& convex, const Mover& frame, const Surface& surface, double tolerance, double h)
      : convex_(convex),
        frame_(frame),
        clearance_(convex.body, frame.body, surface.bounds()),
        solid_(surface.solid()),
        tolerance_(tolerance),
        first(h) {
    // The gap to a facet closes no faster than the facet moves as seen from the convex solid, or this as seen from it.
    const double apart = (convex.motion.start.location - frame.motion.start.location).norm() +
                         h * (convex.motion.velocity - frame.motion.velocity).norm();
    speed_ = std::min(speed_seen(convex, frame, convex.body.radius, apart),
                      speed_seen(frame, convex, frame.body.radius, apart));
  }
  bool wants(const Eigen::AlignedBox3d& box) const override { return clearance_.of(box) <= farthest(); }
  void visit(const Facet& facet) override {
    if (clearance_.of_plane(facet) > farthest()) return;
    triangle_.set(facet);
    const Mover triangle{triangle_.placed(frame_.body, solid_), frame_.motion};
    double t;
    if (!Advancement(convex_, triangle, tolerance_, first).run(t)) return;
    found = true;
    first = t;
  }

 private:
  /// Solids farther apart at the start do not meet in time; a hair more than round-off.
  double farthest() const { return (speed_ * first + tolerance_) * (1 + 1e-12); }

  const Mover &convex_, &frame_;
  const Clearance clearance_;  // at the start
  bool solid_;
  double tolerance_, speed_ = 0;
  TriangleSolid triangle_;

 public:
  double first;
  bool found = false;
};

/// All that a convex solid may pass in the frame of the surface: a ball about its place that holds it, along a path
/// that the rotating frame bends; and what is `more` beyond.
Eigen::AlignedBox3d swept(const Mover& convex, const Mover& frame, double h, double more) {
  const double spin = frame.motion.rotational_velocity_world.norm();
  const int pieces = spin > 0 ? 16 : 1;
  const double speed = (convex.motion.velocity - frame.motion.velocity).norm();
  double farthest = 0;
  Eigen::AlignedBox3d box;
  for (int i = 0; i <= pieces; ++i) {
    const double t = h * i / pieces;
    const Placed at = frame.at(t);
    const Vector3 apart = convex.motion.start.location - frame.motion.start.location +
                          t * (convex.motion.velocity - frame.motion.velocity);
    farthest = std::max(farthest, apart.norm());
    box.extend(at.rotation.transpose() * apart);
  }
  // Between two moments a piece of the path leaves the chord by at most its length.
  const double piece = spin > 0 ? (speed + spin * (farthest + speed * h)) * h / pieces : 0;
  const double margin = convex.body.radius * (1 + 1e-12) + piece + more;
  return {box.min() - Vector3::Constant(margin), box.max() + Vector3::Constant(margin)};
}

/// One that does not touch already. What meets no facet on its way touches none at the start either, or is inside.
bool surface_impact(const Shape& a, const Motion& ma, const Shape& b, const Motion& mb, double tolerance, double h,
                    double& t, NarrowCounters* counters) {
  const SurfacePair pair(a, place(a, ma.start), b, place(b, mb.start));
  if (pair.surface == nullptr) return false;
  const Mover whole{pair.convex, pair.convex_is_a ? ma : mb}, frame{pair.frame, pair.convex_is_a ? mb : ma};
  const Eigen::AlignedBox3d way = swept(whole, frame, h, tolerance);
  Contact before;
  if (!pair.surface->meets(way) || closest_within(a, ma.start, b, mb.start, tolerance, before, counters)) return false;
  bool found = false;
  double first = h;
  for (std::size_t i = 0; i < pair.count(); ++i) {
    const Mover convex{pair.moving(i), whole.motion};
    FacetAdvancement search(convex, frame, *pair.surface, tolerance, first);
    pair.surface->under(pair.pieces != nullptr ? swept(convex, frame, first, tolerance) : way, search);
    if (counters != nullptr) counters->add(search.counters);
    found = found || search.found;
    first = search.first;
  }
  if (found) t = first;
  return found;
}

double tolerance_of(const Shape& a, const Motion& ma, const Shape& b, const Motion& mb, double h) {
  return std::max(touch_tolerance(a, ma.start, b, mb.start), touch_tolerance(a, pose_at(ma, h), b, pose_at(mb, h)));
}

}  // namespace

bool stay_apart(const Shape& a, const Motion& ma, const Shape& b, const Motion& mb, double h, const Vector3& axis) {
  if (is_surface(a) || is_surface(b)) return false;
  Scene s{place(a, ma.start), place(b, mb.start), mb.velocity - ma.velocity, Vector3::Zero(), Vector3::Zero()};
  s.set_spins(ma.rotational_velocity_world, mb.rotational_velocity_world);
  s.a.location.setZero();
  s.b.location = mb.start.location - ma.start.location;
  // The bounds are for n from a's lowest to b's highest vertex.
  return safe_time(s, s.a.rotation * axis, Vector3::Zero(), tolerance_of(a, ma, b, mb, h), h) >= h;
}

bool time_of_impact(const Shape& a, const Motion& ma, const Shape& b, const Motion& mb, double h, double& t,
                    Contact& contact, NarrowCounters* counters) {
  if (!(h > 0)) return false;
  const double tolerance = tolerance_of(a, ma, b, mb, h);
  const bool surface = is_surface(a) || is_surface(b);
  const bool hit = surface ? surface_impact(a, ma, b, mb, tolerance, h, t, counters)
                           : Advancement({place(a, ma.start), ma}, {place(b, mb.start), mb}, tolerance, h).run(t);
  if (hit) contact = closest(a, pose_at(ma, t), b, pose_at(mb, t));
  return hit;
}

}  // namespace breve
