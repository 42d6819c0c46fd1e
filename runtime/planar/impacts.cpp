// Where the next first touch is: Box2D's search for the time of impact, refined on the path that the step will take.
// The sub-step is cut there, for pairs with a handler, and for pairs that bounce while there are few bodies.
#include <box2d/b2_distance.h>
#include <box2d/b2_time_of_impact.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/contact/impact_law.hpp"
#include "runtime/planar/core.hpp"

namespace breve {

namespace {

constexpr float kSkip = 3 * b2_linearSlop;  // what Box2D's search lets things overlap by

struct Proxy {
  b2DistanceProxy proxy;
  float radius;
  Proxy(const b2Fixture* fixture, int child) {
    proxy.Set(const_cast<b2Fixture*>(fixture)->GetShape(), child);
    radius = proxy.m_radius;
  }
};

/// Gap of two shapes at given places; closest points of their cores.
double gap_between(const Proxy& a, const b2Transform& at_a, const Proxy& b, const b2Transform& at_b,
                   b2DistanceOutput* where = nullptr) {
  b2DistanceInput in;
  in.proxyA = a.proxy;
  in.proxyB = b.proxy;
  in.transformA = at_a;
  in.transformB = at_b;
  in.useRadii = false;
  b2SimplexCache cache;
  cache.count = 0;
  b2DistanceOutput out;
  b2Distance(&out, &cache, &in);
  if (where) *where = out;
  return double{out.distance} - double{a.radius} - double{b.radius};
}

}  // namespace

/// Where a body is after t seconds of the coming step, if nothing touches it.
b2Transform Planar::Core::transform_after(const FlatBody& flat, double t) const {
  const b2Body& b = *flat.b2;
  if ((flat.fixed && !flat.driven) || !b.IsAwake()) return b.GetTransform();
  const b2Vec2 v = b.GetLinearVelocity(), c = b.GetWorldCenter();
  double x = c.x + t * v.x, y = c.y + t * v.y;
  if (!flat.fixed && flat.free_flight()) {
    const Vector2 pull = (settings.gravity.head<2>() + flat.force / flat.mass.mass) / settings.unit;
    x += t * t / 2 * pull.x();
    y += t * t / 2 * pull.y();
  }
  b2Transform at;
  at.q.Set(static_cast<float>(b.GetAngle() + t * b.GetAngularVelocity()));
  at.p = b2Vec2(static_cast<float>(x), static_cast<float>(y)) - b2Mul(at.q, b.GetLocalCenter());
  return at;
}

/// More than points of two bodies come together within dt, length units.
double Planar::Core::most_approach(const FlatBody& a, const FlatBody& b, double dt) const {
  const b2Vec2 v = a.b2->GetLinearVelocity() - b.b2->GetLinearVelocity();
  double most = dt * double{v.Length()} + double{b2_linearSlop};
  for (const FlatBody* flat : {&a, &b}) {
    const double spin = std::abs(double{flat->b2->GetAngularVelocity()});
    if (flat->fixed && spin > 0) return std::numeric_limits<double>::infinity();
    most += dt * spin * flat->reach;
    if (!flat->fixed)
      most += dt * dt / 2 * (settings.gravity.norm() + flat->force.norm() / flat->mass.mass) / settings.unit;
  }
  return most;
}

void Planar::Core::consider(b2Fixture* a, int child_a, b2Fixture* b, int child_b, bool handled, double dt, Hit& best,
                            bool& found) {
  const FlatBody &x = of(a->GetBody()), &y = of(b->GetBody());
  const BodyPair pair = std::minmax(x.body, y.body);
  if (handled && met.count(pair) != 0) {
    if (near_enough(pair)) return;
    met.erase(pair);
  }
  ++counters.searches;
  constexpr std::uint64_t kUnits = 20;  // of work
  counters.work += kUnits;
  const Proxy pa(a, child_a), pb(b, child_b);
  if (gap_between(pa, a->GetBody()->GetTransform(), pb, b->GetBody()->GetTransform()) > most_approach(x, y, dt)) return;
  b2TOIInput in;
  in.proxyA = pa.proxy;
  in.proxyB = pb.proxy;
  in.proxyA.m_radius += kSkip;  // the search ends where the surfaces meet
  const auto sweep = [&](const FlatBody& flat) {
    b2Sweep s;
    s.localCenter = flat.b2->GetLocalCenter();
    const b2Transform end = transform_after(flat, dt);
    s.c0 = flat.b2->GetWorldCenter();
    s.c = b2Mul(end, s.localCenter);
    s.a0 = flat.b2->GetAngle();
    const bool moves = (!flat.fixed || flat.driven) && flat.b2->IsAwake();
    s.a = moves ? static_cast<float>(s.a0 + dt * flat.b2->GetAngularVelocity()) : s.a0;
    s.alpha0 = 0;
    return s;
  };
  in.sweepA = sweep(x);
  in.sweepB = sweep(y);
  in.tMax = 1;
  b2TOIOutput out;
  b2TimeOfImpact(&out, &in);
  if (out.state == b2TOIOutput::e_separated) return;
  const auto gap_at = [&](double t) { return gap_between(pa, transform_after(x, t), pb, transform_after(y, t)); };
  double t = out.state == b2TOIOutput::e_overlapped ? 0 : double{out.t} * dt;
  // Newton's method on the path of the step.
  const double little = 0.01 * dt;
  double rate = 0;
  for (int i = 0; i < 4; ++i) {
    const double gap = gap_at(t);
    rate = t >= little ? (gap - gap_at(t - little)) / little : (gap_at(t + little) - gap) / little;
    if (!(rate < 0)) {
      if (gap > 0) return;  // they pass
      break;
    }
    const double next = t - gap / rate;
    if (next > dt) return;
    t = std::max(0.0, next);
    if (t == 0 && gap <= 0) break;
  }
  const double moves_on = gap_at(std::min(dt, t + little)) - gap_at(t);
  if (t == 0 && !(moves_on < 0)) return;  // they part
  if (found && (best.t < t || (best.t == t && best.pair <= pair))) return;
  best = {a, b, child_a, child_b, t, handled, kNoJoint, pair, -rate};
  found = true;
}

/// Whether anybody waits for first touches at their moments.
bool Planar::Core::handlers() const { return client->locates() && client->any_handled(); }

/// Whether what bounces is met at its moment: each impact is a step of all that steps, so where there are many bodies,
/// impacts that nobody waits for are met late.
bool Planar::Core::few() const {
  constexpr int kShare = 256;
  if (!settings.accuracy.locate_impacts && joints.empty()) return false;
  return awake > 0 && located < kShare / awake;
}

/// Whether the moment of a rebound is looked for on every rung: what joints hold swings back from where it was met, and
/// an impact that keeps most of the energy would give or take some where it comes late.
bool Planar::Core::swings_back(const FlatBody& a, const FlatBody& b, double restitution) {
  constexpr double kMost = 0.5;  // of the energy
  return (a.jointed || b.jointed) && restitution * restitution > kMost;
}

/// f(a, child of a, b, child of b, whether somebody waits for it) for pairs of shapes that may touch within dt.
template <class F>
void Planar::Core::each_approach(double dt, const Sought& sought, const F& f) {
  for (b2Contact* contact = b2->GetContactList(); contact; contact = contact->GetNext()) {
    if (contact->IsTouching()) continue;
    b2Fixture *a = contact->GetFixtureA(), *b = contact->GetFixtureB();
    if (!a->GetBody()->IsAwake() && !b->GetBody()->IsAwake()) continue;
    refresh(contact);
    const float known = contact->GetRestitution();
    const bool handled = sought.handled && known >= 2, bounces = sought.bounces && std::fmod(known, 2.0F) > 0;
    if (!handled && !bounces) continue;
    const FlatBody &x = of(a->GetBody()), &y = of(b->GetBody());
    const bool sought_now = settings.accuracy.locate_impacts || swings_back(x, y, std::fmod(double{known}, 2.0));
    if (!handled && !(sought_now && approach_fast(x, y, dt))) continue;
    f(a, contact->GetChildIndexA(), b, contact->GetChildIndexB(), handled);
  }
}

bool Planar::Core::find_hit(double dt, const Sought& sought, Hit& best) {
  if (!sought.handled && !sought.bounces) return false;
  bool found = false;
  each_approach(dt, sought, [&](b2Fixture* a, int child_a, b2Fixture* b, int child_b, bool handled) {
    consider(a, child_a, b, child_b, handled, dt, best, found);
  });
  if (sought.handled)
    for (FlatBody& flat : slots)
      if (flat.body != kNoBody && !flat.fixed && flat.b2->IsAwake()) look_around(flat, dt, best, found);
  return found;
}

/// Bodies that bounce within dt, one of two, and children of joints that reach their limits.
std::pmr::vector<BodyIndex> Planar::Core::meeting(double dt) {
  std::pmr::vector<BodyIndex> found(memory);
  if (few())
    each_approach(dt, {false, true}, [&](b2Fixture* a, int child_a, b2Fixture* b, int child_b, bool) {
      const FlatBody &x = of(a->GetBody()), &y = of(b->GetBody());
      Hit hit;
      bool hits = false;
      consider(a, child_a, b, child_b, false, dt, hit, hits);
      if (hits) found.push_back(x.fixed ? y.body : x.body);
    });
  for (const FlatJoint& joint : joints) {
    double t = 0;
    if (joint.used && joint.b2 && stops_within(joint, dt, t)) found.push_back(joint.is.child);
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Whether two bodies that would bounce come faster than where nothing bounces any more.
bool Planar::Core::approach_fast(const FlatBody& a, const FlatBody& b, double dt) const {
  const b2Vec2 v = a.b2->GetLinearVelocity() - b.b2->GetLinearVelocity();
  const double spin = std::abs(a.b2->GetAngularVelocity()) + std::abs(b.b2->GetAngularVelocity());
  const double fall = settings.gravity.norm() * dt;
  return v.Length() * settings.unit + spin * settings.unit > std::max(contact::kRestingApproach * settings.unit, fall);
}

/// What Box2D does not know yet to be near: it looks at the way of the last step.
void Planar::Core::look_around(FlatBody& flat, double dt, Hit& best, bool& found) {
  const b2Transform end = transform_after(flat, dt);
  const b2Vec2 way = end.p - flat.b2->GetPosition();
  if (way.Length() < 0.5F * b2_aabbExtension && std::abs(flat.b2->GetAngularVelocity()) * dt < 0.05) return;
  struct Finder : b2QueryCallback {
    std::pmr::vector<b2Fixture*> seen;
    explicit Finder(std::pmr::memory_resource* memory) : seen(memory) {}
    bool ReportFixture(b2Fixture* fixture) override {
      seen.push_back(fixture);
      return true;
    }
  };
  for (b2Fixture* own = flat.b2->GetFixtureList(); own; own = own->GetNext()) {
    b2AABB box, last;
    own->GetShape()->ComputeAABB(&box, flat.b2->GetTransform(), 0);
    own->GetShape()->ComputeAABB(&last, end, 0);
    box.Combine(last);
    Finder finder(memory);
    b2->QueryAABB(&finder, box);
    std::sort(finder.seen.begin(), finder.seen.end(), [this](b2Fixture* p, b2Fixture* q) {
      return std::pair(of(p->GetBody()).body, number_of(p)) < std::pair(of(q->GetBody()).body, number_of(q));
    });
    finder.seen.erase(std::unique(finder.seen.begin(), finder.seen.end()), finder.seen.end());
    for (b2Fixture* other : finder.seen) {
      const FlatBody& to = of(other->GetBody());
      if (to.body == flat.body || !client->handled(flat.body, to.body) || !pushes(flat.body, to.body, *client))
        continue;
      bool known = false;
      for (b2ContactEdge* edge = flat.b2->GetContactList(); edge && !known; edge = edge->next)
        known = edge->other == to.b2;
      if (known) continue;
      for (int child = 0; child < other->GetShape()->GetChildCount(); ++child)
        consider(own, 0, other, child, true, dt, best, found);
    }
  }
}

bool Planar::Core::near_enough(const BodyPair& pair) const {
  const FlatBody *a = find(pair.first), *b = find(pair.second);
  if (!a || !b) return false;
  constexpr double kApart = 0.5 * b2_linearSlop;
  for (b2Fixture* x = a->b2->GetFixtureList(); x; x = x->GetNext())
    for (b2Fixture* y = b->b2->GetFixtureList(); y; y = y->GetNext())
      for (int i = 0; i < x->GetShape()->GetChildCount(); ++i)
        for (int k = 0; k < y->GetShape()->GetChildCount(); ++k)
          if (gap_between(Proxy(x, i), a->b2->GetTransform(), Proxy(y, k), b->b2->GetTransform()) < kApart) return true;
  return false;
}

// --- at the moment --------------------------------------------------------------------------------------------------

namespace {

/// Box2D's order of two shapes in a contact: profiles, polygons, circles.
int rank(const b2Fixture& fixture) {
  const b2Shape::Type type = fixture.GetType();
  return type == b2Shape::e_chain ? 0 : type == b2Shape::e_polygon ? 1 : 2;
}

/// Contact points of two shapes, in Box2D's order, up to a little apart; its own manifolds know only what overlaps.
int touch_points(b2Fixture& fa, b2Fixture& fb, int child, b2WorldManifold& where) {
  constexpr float kReach = 2 * b2_linearSlop;
  const b2Shape *a = fa.GetShape(), *b = fb.GetShape();
  const b2Transform &xa = fa.GetBody()->GetTransform(), &xb = fb.GetBody()->GetTransform();
  b2Manifold manifold;
  manifold.pointCount = 0;
  if (b->GetType() == b2Shape::e_circle) {
    b2CircleShape circle = static_cast<const b2CircleShape&>(*b);
    circle.m_radius += kReach;
    if (a->GetType() == b2Shape::e_circle) {
      b2CollideCircles(&manifold, static_cast<const b2CircleShape*>(a), xa, &circle, xb);
    } else if (a->GetType() == b2Shape::e_polygon) {
      b2CollidePolygonAndCircle(&manifold, static_cast<const b2PolygonShape*>(a), xa, &circle, xb);
    } else {
      b2EdgeShape edge;
      static_cast<const b2ChainShape*>(a)->GetChildEdge(&edge, child);
      b2CollideEdgeAndCircle(&manifold, &edge, xa, &circle, xb);
    }
  } else {
    b2PolygonShape polygon = static_cast<const b2PolygonShape&>(*b);
    polygon.m_radius += kReach;
    if (a->GetType() == b2Shape::e_polygon) {
      b2CollidePolygons(&manifold, static_cast<const b2PolygonShape*>(a), xa, &polygon, xb);
    } else {
      b2EdgeShape edge;
      static_cast<const b2ChainShape*>(a)->GetChildEdge(&edge, child);
      b2CollideEdgeAndPolygon(&manifold, &edge, xa, &polygon, xb);
    }
  }
  where.Initialize(&manifold, xa, a->m_radius, xb, b->m_radius);
  return manifold.pointCount;
}

}  // namespace

Contact Planar::Core::contact_between(b2Fixture* a, int child_a, b2Fixture* b, int child_b, bool flipped) const {
  b2DistanceOutput where;
  const double gap = gap_between(Proxy(a, child_a), a->GetBody()->GetTransform(), Proxy(b, child_b),
                                 b->GetBody()->GetTransform(), &where);
  b2Vec2 normal = where.pointA - where.pointB, point = 0.5F * (where.pointA + where.pointB);
  const bool swapped = rank(*b) < rank(*a);
  b2WorldManifold manifold;
  const int points = swapped ? touch_points(*b, *a, child_b, manifold) : touch_points(*a, *b, child_a, manifold);
  if (points > 0) {
    normal = swapped ? manifold.normal : -manifold.normal;
    point = points == 2 ? 0.5F * (manifold.points[0] + manifold.points[1]) : manifold.points[0];
  }
  const double length = normal.Length();
  Contact contact;
  contact.point = from_b2(point);
  contact.normal = length > 0 ? Vector3(normal.x / length, normal.y / length, 0) : Vector3(0, 1, 0);
  if (flipped) contact.normal = -contact.normal;
  contact.distance = gap * settings.unit;
  return contact;
}

void Planar::Core::deliver(const Hit& hit, double moment) {
  b2Fixture *a = hit.a, *b = hit.b;
  int child_a = hit.child_a;
  const BodyIndex x = of(a->GetBody()).body, y = of(b->GetBody()).body;
  ++counters.impacts;
  if (hit.handled) {
    write_back_all();
    const bool flipped = client->serial(x) > client->serial(y);
    const Contact contact = contact_between(a, child_a, b, hit.child_b, flipped);
    const std::uint32_t number_a = number_of(a), number_b = number_of(b);
    met[std::minmax(x, y)] = true;
    client->impact(flipped ? y : x, flipped ? x : y, contact, moment);
    sync();
    // The handler may have freed them, or given them other shapes.
    if (!b2 || !find(x) || !find(y) || !pushes(x, y, *client)) return;
    a = fixture_of(x, number_a, static_cast<std::uint32_t>(child_a));
    b = fixture_of(y, number_b, static_cast<std::uint32_t>(hit.child_b));
    if (!a || !b) return;
  }
  if (rank(*b) < rank(*a)) {
    std::swap(a, b);
    child_a = hit.child_b;
  }
  b2WorldManifold where;
  const int points = touch_points(*a, *b, child_a, where);
  FlatBody &first = of(a->GetBody()), &second = of(b->GetBody());
  if (points > 0 && collide(first, second, where, points)) spread(first, second);
}

}  // namespace breve
