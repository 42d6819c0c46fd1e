// Collisions: the impulse of two bodies, with all that joints connect them with, by the laws of runtime/contact; and
// how it spreads through bodies that touch, pair by pair, the fastest approach first.
#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/contact/impact_law.hpp"
#include "runtime/planar/response.hpp"

namespace breve {

namespace {

using Vector = Response::Vector;

/// One point at which two bodies meet. The normal goes from a to b; impulses are those on b.
struct Point {
  Vector2 where, arm_a, arm_b, before, impulse = Vector2::Zero();
};

Vector2 speed_at(const FlatBody& flat, const Vector2& arm) {
  return vector_of(flat.b2->GetLinearVelocity()) + double{flat.b2->GetAngularVelocity()} * left_of(arm);
}

/// Newton's restitution and Coulomb's cone at two points, by sweeps over both.
void solve_two(const Response& response, FlatBody& a, FlatBody& b, std::array<Point, 2>& points, const Vector2& n,
               double mu, double e) {
  const Vector2 t = left_of(n);
  for (Point& p : points) p.impulse.setZero();
  Vector change = Vector::Zero(response.size());
  const auto relative = [&](const Point& p) {
    return Vector2(p.before + response.at_point(b, p.arm_b, change) - response.at_point(a, p.arm_a, change));
  };
  for (int sweep = 0; sweep < 60; ++sweep)
    for (Point& p : points)
      for (const Vector2& along : {n, t}) {
        const Vector unit = response.answer(p.arm_a, p.arm_b, along);
        const double gives = along.dot(response.at_point(b, p.arm_b, unit) - response.at_point(a, p.arm_a, unit));
        if (!(gives > 0)) continue;
        const bool normal = along == n;
        const double wanted = normal ? std::max(0.0, -e * n.dot(p.before)) : 0;
        const double had = along.dot(p.impulse);
        double next = had + (wanted - along.dot(relative(p))) / gives;
        const double bound = mu * std::max(0.0, n.dot(p.impulse));
        next = normal ? std::max(0.0, next) : std::clamp(next, -bound, bound);
        p.impulse += (next - had) * along;
        change += (next - had) * unit;
      }
}

double gain_of(const Response& response, FlatBody& a, FlatBody& b, const std::array<Point, 2>& points) {
  Vector change = Vector::Zero(response.size());
  for (const Point& p : points) change += response.answer(p.arm_a, p.arm_b, p.impulse);
  double gain = 0;
  for (const Point& p : points) {
    const Vector2 after = p.before + response.at_point(b, p.arm_b, change) - response.at_point(a, p.arm_a, change);
    gain += p.impulse.dot(p.before + after) / 2;
  }
  return gain;
}

/// Those of Box2D's points that touch, with the speed at which b leaves a there. Returns how many.
int take_points(FlatBody& a, FlatBody& b, const b2WorldManifold& where, int count, std::array<Point, 2>& points) {
  int used = 0;
  double deepest = where.separations[0];
  if (count == 2) deepest = std::min(deepest, double{where.separations[1]});
  for (int i = 0; i < count; ++i) {
    // A box that lands on its corner touches there alone.
    constexpr double kTogether = 0.25 * b2_linearSlop;
    if (where.separations[i] > deepest + kTogether) continue;
    Point& p = points[static_cast<std::size_t>(used++)];
    p.where = vector_of(where.points[i]);
    p.arm_a = p.where - vector_of(a.b2->GetWorldCenter());
    p.arm_b = p.where - vector_of(b.b2->GetWorldCenter());
    p.before = speed_at(b, p.arm_b) - speed_at(a, p.arm_a);
  }
  return used;
}

void solve_one(const Response& response, FlatBody& a, FlatBody& b, Point& p, const Vector2& n,
               const contact::Law& law) {
  Matrix3 W = Matrix3::Zero();
  for (int i = 0; i < 2; ++i) {
    const Vector unit = response.answer(p.arm_a, p.arm_b, i == 0 ? Vector2(1, 0) : Vector2(0, 1));
    W.col(i).head<2>() = response.at_point(b, p.arm_b, unit) - response.at_point(a, p.arm_a, unit);
  }
  p.impulse = contact::impact_impulse(W, {p.before.x(), p.before.y(), 0}, {n.x(), n.y(), 0}, law).head<2>();
}

/// Two points at once, with as much restitution as gains no energy.
void solve_both(const Response& response, FlatBody& a, FlatBody& b, std::array<Point, 2>& points, const Vector2& n,
                const contact::Law& law) {
  for (const double part : {1.0, 0.75, 0.5, 0.25, 0.0}) {
    solve_two(response, a, b, points, n, law.dynamic_friction, part * law.restitution);
    if (!(gain_of(response, a, b, points) > 0)) return;
  }
  // Sweeps over cones that are wide and coupled need not come to an end; without friction they do.
  solve_two(response, a, b, points, n, 0, 0);
}

}  // namespace

/// Approaches slower than this rest, m/s. What rests on something takes up the speed of a sub-step's fall.
double Planar::Core::slowest_bounce(const contact::Law& law) const {
  constexpr double kLeast = 1e-6;
  return std::max({law.restitution_threshold, settings.gravity.norm() * step_length, kLeast});
}

/// Between something that a script moves and a wall a body would rebound ever faster: it does so a few times, and then
/// is pushed.
bool Planar::Core::squeezed(const FlatBody& a, const FlatBody& b) {
  constexpr int kFew = 3;
  return (a.driven && b.driver_strikes >= kFew) || (b.driven && a.driver_strikes >= kFew);
}

bool Planar::Core::collide(FlatBody& a, FlatBody& b, const b2WorldManifold& where, int count) {
  if (squeezed(a, b)) return false;
  const Vector2 n = vector_of(where.normal).normalized();
  std::array<Point, 2> points;
  double fastest = 0;
  const int used = take_points(a, b, where, count, points);
  for (int i = 0; i < used; ++i) fastest = std::max(fastest, -n.dot(points[static_cast<std::size_t>(i)].before));
  const contact::Law law = law_of(a, b);
  const double u = settings.unit;
  if (used == 0 || !(fastest * u > slowest_bounce(law))) return false;
  const Response response(*this, &a, &b);
  if (response.size() == 0) return false;
  const double before = response.kinetic();
  if (response.holds()) {
    // Box2D's solver leaves velocities that the joints do not quite allow: what they forbid would be multiplied.
    response.give(response.allowed(response.velocities()));
    for (int i = 0; i < used; ++i) {
      Point& p = points[static_cast<std::size_t>(i)];
      p.before = speed_at(b, p.arm_b) - speed_at(a, p.arm_a);
    }
  }
  if (used == 1)
    solve_one(response, a, b, points[0], n, law);
  else
    solve_both(response, a, b, points, n, law);
  Vector change = Vector::Zero(response.size());
  Vector2 sum = Vector2::Zero(), middle = Vector2::Zero();
  for (int i = 0; i < used; ++i) {
    const Point& p = points[static_cast<std::size_t>(i)];
    change += response.answer(p.arm_a, p.arm_b, p.impulse);
    sum += p.impulse;
    middle += p.where / used;
  }
  if (sum == Vector2::Zero()) return false;
  double driven = 0;  // what scripts' bodies give
  for (int i = 0; i < used; ++i) {
    const Point& p = points[static_cast<std::size_t>(i)];
    if (a.driven) driven += p.impulse.dot(speed_at(a, p.arm_a)) * u * u;
    if (b.driven) driven -= p.impulse.dot(speed_at(b, p.arm_b)) * u * u;
  }
  response.give(change);
  a.driver_strikes += b.driven ? 1 : 0;
  b.driver_strikes += a.driven ? 1 : 0;
  if (stepping) {
    driven_work += driven;
  } else {
    ledger.script_work += driven;
    ledger.contact_loss += driven + (before - response.kinetic()) * u * u;
  }
  Impact impact;
  impact.a = bodies->owner(b.body);
  impact.b = bodies->owner(a.body);
  impact.time = now;
  impact.point = Vector3(middle.x(), middle.y(), 0) * u;
  impact.normal = {n.x(), n.y(), 0};
  impact.impulse = Vector3(sum.x(), sum.y(), 0) * u;
  impacts.push_back(impact);
  return true;
}

namespace {

/// A contact of a body that was struck. While an impact spreads only velocities change.
struct Reached {
  b2Contact* contact;
  b2Body *a, *b;
  b2Vec2 point, normal;
  double slowest;       // m/s, that bounces
  double approach = 0;  // m/s

  void look(double unit) {
    const b2Vec2 v = b->GetLinearVelocityFromWorldPoint(point) - a->GetLinearVelocityFromWorldPoint(point);
    approach = -double{b2Dot(v, normal)} * unit;
  }
  bool touches(const b2Body* x, const b2Body* y) const { return a == x || a == y || b == x || b == y; }
};

}  // namespace

void Planar::Core::spread(FlatBody& a, FlatBody& b) {
  std::pmr::vector<b2Body*> struck(memory);
  std::pmr::vector<Reached> reached(memory);
  const auto strike = [&](b2Body* body) {
    if (std::find(struck.begin(), struck.end(), body) != struck.end()) return;
    struck.push_back(body);
    if (of(body).fixed) return;
    for (const b2ContactEdge* edge = body->GetContactList(); edge; edge = edge->next) {
      b2Contact* contact = edge->contact;
      if (!contact->IsTouching() || contact->GetManifold()->pointCount == 0) continue;
      refresh(contact);
      if (!(std::fmod(contact->GetRestitution(), 2.0F) > 0)) continue;
      b2WorldManifold where;
      contact->GetWorldManifold(&where);
      b2Body *const x = contact->GetFixtureA()->GetBody(), *const y = contact->GetFixtureB()->GetBody();
      reached.push_back({contact, x, y, where.points[0], where.normal, slowest_bounce(law_of(of(x), of(y)))});
      reached.back().look(settings.unit);
    }
  };
  strike(a.b2);
  strike(b.b2);
  constexpr int kMost = 64;
  for (int i = 0; i < kMost; ++i) {
    const Reached* fastest = nullptr;
    double speed = 0;
    for (const Reached& one : reached) {
      if (!(one.approach > std::max(speed, one.slowest)) || squeezed(of(one.a), of(one.b))) continue;
      speed = one.approach;
      fastest = &one;
    }
    if (!fastest) return;
    b2Body *const x = fastest->a, *const y = fastest->b;
    b2WorldManifold where;
    fastest->contact->GetWorldManifold(&where);
    if (!collide(of(x), of(y), where, fastest->contact->GetManifold()->pointCount)) return;
    const bool others = of(x).jointed || of(y).jointed;
    for (Reached& one : reached)
      if (others || one.touches(x, y)) one.look(settings.unit);
    strike(x);
    strike(y);
  }
}

}  // namespace breve
