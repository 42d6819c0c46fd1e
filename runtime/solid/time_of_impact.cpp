// First touch of two moving solids by conservative advancement (Mirtich 1996), with bounds of second order.
// At each stop the closest points give a direction n. Let n turn at some constant rate; then along n every vertex moves
// as f + f' t + r, |r| <= M t^2 / 2, and the gap stays open until the lowest of these parabolas reaches zero. Any rate
// is valid; the one that follows the touching features makes the last stops converge like Newton's method, where the
// classical bound on speeds converges only linearly. Several rates are tried and the longest safe step is taken.
#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/solid/contact.hpp"
#include "runtime/solid/gap.hpp"
#include "runtime/solid/place.hpp"

namespace breve {

namespace {

constexpr double kShortestStep = 1e-13;  // of the interval: why the loop ends even if every bound is lost to round-off
constexpr int kMaxStops = 4000;          // a touch is reported if even these do not decide: never missed
constexpr int kMaxPairs = 64;
constexpr int kNewtonSteps = 8;

/// Two bodies at one moment, seen from the origin of a.
struct Scene {
  Placed a, b;       // a.location is zero
  Vector3 velocity;  // of b relative to a
  Vector3 spin_a, spin_b;
};

/// Vertices of one body along the turning direction: value and rate of each, and the extreme at a later time.
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
    Line best{};
    double least = std::numeric_limits<double>::infinity();
    const Vector3 later = sign * (value + t * rate);
    for (const Vector3& r : body.solid->vertices) {
      const double height = later.dot(r);
      if (height >= least) continue;
      least = height;
      best = {value.dot(r), rate.dot(r)};
    }
    return {best.value + value0, best.rate + rate0};
  }
};

/// Bound on |second derivative| of n . r for a vertex r of a body, with n turning at `turn` and the body at `spin`.
double bend(const Placed& body, const Vector3& n, const Vector3& turn, const Vector3& spin) {
  if (body.solid == nullptr || turn == spin) return 0;
  if (turn.isZero(0)) return spin.cross(n).norm() * spin.norm() * body.radius;
  const double rate = turn.norm() + spin.norm();
  return rate * rate * body.radius;
}

/// A time up to which the gap along `n`, turning at `turn`, stays above `target`; `span` if it is so for all of it.
double safe_time(const Scene& s, const Vector3& n, const Vector3& turn, double target, double span) {
  const Vector3 n_rate = turn.cross(n);
  const Along a{s.a, s.a.rotation.transpose() * n, s.a.rotation.transpose() * (n_rate + n.cross(s.spin_a)), 0, 0};
  const Along b{s.b, s.b.rotation.transpose() * n, s.b.rotation.transpose() * (n_rate + n.cross(s.spin_b)),
                n.dot(s.b.location), n_rate.dot(s.b.location) + n.dot(s.velocity)};
  const double w = turn.norm(), v = s.velocity.norm();
  const double curve = bend(s.a, n, turn, s.spin_a) + bend(s.b, n, turn, s.spin_b) +
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

/// The rate at which a plane turns that keeps both edges in it: its normal n stays perpendicular to each.
Vector3 turn_with_edges(const Gap& gap, const Scene& s) {
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
  std::array<Vector3, 4> turns{Vector3::Zero(), s.spin_a, s.spin_b, s.spin_a};
  if (!gap.edge_a.isZero(0)) turns[3] = turn_with_edges(gap, s);
  double longest = 0;
  for (std::size_t i = 0; i < turns.size() && longest < span; ++i) {
    const bool tried = std::find(turns.begin(), turns.begin() + static_cast<std::ptrdiff_t>(i), turns[i]) !=
                       turns.begin() + static_cast<std::ptrdiff_t>(i);
    if (!tried) longest = std::max(longest, safe_time(s, gap.normal, turns[i], target, span));
  }
  return longest;
}

/// When two balls moving apart by `x` at relative velocity `v` are `reach` apart for the first time; infinity: never.
/// The discriminant is taken from the cross product, which keeps its digits for balls that graze.
double balls_meet(const Vector3& x, const Vector3& v, double reach) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double c = (x.norm() - reach) * (x.norm() + reach);
  if (c <= 0) return 0;
  const double approach = -x.dot(v);
  const double discriminant = v.squaredNorm() * reach * reach - x.cross(v).squaredNorm();
  if (approach <= 0 || discriminant < 0) return kNever;
  return c / (approach + std::sqrt(discriminant));
}

class Advancement {
 public:
  Advancement(const Shape& a, const Motion& ma, const Shape& b, const Motion& mb, double h)
      : a_(a), b_(b), ma_(ma), mb_(mb), h_(h) {
    const Pose end_a = pose_at(ma, h), end_b = pose_at(mb, h);
    tolerance_ = std::max(touch_tolerance(a, ma.start, b, mb.start), touch_tolerance(a, end_a, b, end_b));
  }

  bool run(double& t, Contact& contact);

 private:
  bool both_round() const { return a_.kind() == ShapeKind::Sphere && b_.kind() == ShapeKind::Sphere; }
  Scene scene(double t) const;
  bool touches(double t, Gap& gap) const {
    const Scene s = scene(t);
    gap = find_gap(s.a, s.b);
    return gap.distance <= tolerance_;
  }
  double refined(double t, Gap gap) const;
  void report(double t, Contact& contact) const { contact = closest(a_, pose_at(ma_, t), b_, pose_at(mb_, t)); }

  const Shape &a_, &b_;
  const Motion &ma_, &mb_;
  double h_;
  double tolerance_;
};

Scene Advancement::scene(double t) const {
  Scene s{place(a_, pose_at(ma_, t)), place(b_, pose_at(mb_, t)), mb_.velocity - ma_.velocity,
          ma_.rotational_velocity_world, mb_.rotational_velocity_world};
  s.a.location.setZero();
  s.b.location = mb_.start.location - ma_.start.location + t * s.velocity;
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

bool Advancement::run(double& t, Contact& contact) {
  Gap gap;
  if (touches(0, gap)) return false;
  const Scene start = scene(0);
  const double reach = a_.bounding_radius() + b_.bounding_radius();
  double now = balls_meet(start.b.location, start.velocity, reach);
  if (both_round() && now <= h_) {
    t = now;
    report(t, contact);
    return true;
  }
  // What touches at the end must not count as touching from the start in the next interval: it is a hit at h.
  const bool decided = both_round() || now > h_;
  now = decided ? h_ : now * (1 - 1e-12);
  for (int stop = 0; stop < kMaxStops; ++stop) {
    if (touches(now, gap)) {
      t = refined(now, gap);
      report(t, contact);
      return true;
    }
    if (now >= h_) return false;
    const double left = h_ - now;
    now = std::min(h_, now + std::max(longest_safe_time(scene(now), gap, tolerance_ / 2, left), kShortestStep * h_));
  }
  t = now;
  report(t, contact);
  return true;
}

}  // namespace

bool time_of_impact(const Shape& a, const Motion& ma, const Shape& b, const Motion& mb, double h, double& t,
                    Contact& contact) {
  if (!(h > 0)) return false;
  return Advancement(a, ma, b, mb, h).run(t, contact);
}

}  // namespace breve
