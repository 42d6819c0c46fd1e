// Rebounds of bodies in flight. Box2D moves a body back to where it struck, up to 0.015 length units inside the other
// one, with the velocity that it has at the end of the sub-step, and looks at bodies that move only when they overlap:
// heights of rebounds would err by as much. So bodies that touch nothing take a sub-step in which they rebound by
// themselves, along the parabolas between their impacts, together with those in flight that they may meet. As no other
// body takes part, many may bounce in one sub-step.
#include "runtime/planar/flights.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "runtime/planar/doors.hpp"

namespace breve {

namespace {

constexpr std::size_t kMostTogether = 32;  // bodies: larger crowds are left to Box2D

/// Calls f for each shape, or edge of a profile, whose roomy box meets a box.
template <class F>
struct ProxyFinder {
  const b2BroadPhase& phase;
  const F& f;
  bool QueryCallback(int proxy) {
    const auto& found = *static_cast<const b2FixtureProxy*>(phase.GetUserData(proxy));
    f(found.fixture, found.childIndex);
    return true;
  }
};

}  // namespace

Planar::Core::Flight::Flight(Core& core) : core_(core), bodies_(core.memory), near_(core.memory) {}

/// Nothing but gravity and constant forces acts on it.
bool Planar::Core::Flight::may_fly(const FlatBody& flat) {
  return flat.body != kNoBody && !flat.fixed && !flat.set_apart && !flat.flown && !flat.forced && flat.solid &&
         flat.free_flight() && flat.torque == 0 && flat.b2->IsAwake();
}

Vector2 Planar::Core::Flight::acceleration(const FlatBody& flat) const {
  return (core_.settings.gravity.head<2>() + flat.force / flat.mass.mass) / core_.settings.unit;
}

/// The velocity that a body gains in t seconds.
b2Vec2 Planar::Core::Flight::gained(const FlatBody& flat, double t) const {
  const Vector2 v = t * acceleration(flat);
  return {static_cast<float>(v.x()), static_cast<float>(v.y())};
}

/// What a shape passes over within t seconds.
b2AABB Planar::Core::Flight::passed_over(const FlatBody& flat, b2Fixture& own, double t) const {
  const b2Body& b = *flat.b2;
  b2AABB box;
  own.GetShape()->ComputeAABB(&box, b.GetTransform(), 0);
  const auto h = static_cast<float>(t);
  const b2Vec2 way = h * (b.GetLinearVelocity() + 0.5F * gained(flat, t)), bend = h / 8 * gained(flat, t);
  // The path bends beyond its chord, and corners rotate.
  const float rotation = std::min(1.0F, h * std::abs(b.GetAngularVelocity()));
  const b2Vec2 room = b2Abs(bend) + static_cast<float>(flat.reach) * rotation * b2Vec2(1, 1);
  box.lowerBound += b2Min(way, b2Vec2(0, 0)) - room;
  box.upperBound += b2Max(way, b2Vec2(0, 0)) + room;
  return box;
}

/// Whether two bodies may come together within t seconds: those that fly side by side do not.
bool Planar::Core::Flight::approach(const FlatBody& a, const FlatBody& b, double t) const {
  const b2Vec2 apart = b.b2->GetWorldCenter() - a.b2->GetWorldCenter();
  b2Vec2 v = b.b2->GetLinearVelocity() - a.b2->GetLinearVelocity();
  if (a.has_force || b.has_force) v += 0.5F * (gained(b, t) - gained(a, t));
  const auto near = static_cast<float>(a.reach + b.reach + t * double{v.Length()});
  return b2Dot(apart, apart) < near * near;
}

/// Whether a body in flight may take part from the start.
bool Planar::Core::Flight::take_in(FlatBody& flat) {
  if (std::find(bodies_.begin(), bodies_.end(), &flat) != bodies_.end()) return true;
  if (begun_ || bodies_.size() >= kMostTogether || !may_fly(flat)) return false;
  flat.looked_at = true;
  bodies_.push_back(&flat);
  return true;
}

void Planar::Core::Flight::add(FlatBody& flat, b2Fixture* own, const b2AABB& box, b2Fixture* other, int child,
                               double t) {
  FlatBody& met = core_.of(other->GetBody());
  if (!alone_ || &met == &flat) return;
  const bool still = met.fixed && !met.driven;
  if (met.fixed ? !b2TestOverlap(roomy_box(*core_.b2, *other, child), box) : !approach(flat, met, t)) return;
  alone_ = !core_.client->handled(flat.body, met.body) && (still || take_in(met));
  if (!still && met.body < flat.body)
    near_.push_back({other, own, 0});
  else
    near_.push_back({own, other, child});
}

/// Shapes that a body may meet within t seconds.
void Planar::Core::Flight::look_around(FlatBody& flat, double t) {
  const b2BroadPhase& phase = core_.b2->GetContactManager().m_broadPhase;
  for (b2Fixture* own = flat.b2->GetFixtureList(); own && alone_; own = own->GetNext()) {
    const b2AABB box = passed_over(flat, *own, t);
    // Box2D has a contact of all that its roomy box meets.
    if (roomy_box(*core_.b2, *own, 0).Contains(box)) {
      for (b2ContactEdge* edge = flat.b2->GetContactList(); edge; edge = edge->next) {
        b2Contact& contact = *edge->contact;
        if (contact.GetFixtureA() == own)
          add(flat, own, box, contact.GetFixtureB(), contact.GetChildIndexB(), t);
        else if (contact.GetFixtureB() == own)
          add(flat, own, box, contact.GetFixtureA(), contact.GetChildIndexA(), t);
      }
      continue;
    }
    const auto tell = [&](b2Fixture* other, int child) {
      const FlatBody& met = core_.of(other->GetBody());
      if (&met != &flat && core_.pushes(flat.body, met.body, *core_.client)) add(flat, own, box, other, child, t);
    };
    ProxyFinder<decltype(tell)> finder{phase, tell};
    phase.Query(&finder, box);
  }
}

/// The next impact within t seconds, if there is one. The bodies are no longer alone if they may meet anything else.
void Planar::Core::Flight::find_impact(double t) {
  found_ = false;
  near_.clear();
  for (std::size_t i = 0; i < bodies_.size() && alone_; ++i) look_around(*bodies_[i], t);
  if (!alone_) return;
  const auto key = [this](const Near& one) {
    return std::tuple(core_.of(one.a->GetBody()).body, number_of(one.a), core_.of(one.b->GetBody()).body,
                      number_of(one.b), one.child);
  };
  std::sort(near_.begin(), near_.end(), [&key](const Near& p, const Near& q) { return key(p) < key(q); });
  for (std::size_t i = 0; i < near_.size(); ++i)
    if (i == 0 || key(near_[i]) != key(near_[i - 1]))
      core_.consider(near_[i].a, 0, near_[i].b, near_[i].child, false, t, hit_, found_);
}

bool Planar::Core::Flight::bounces() const {
  const contact::Law law = core_.law_of(core_.of(hit_.a->GetBody()), core_.of(hit_.b->GetBody()));
  return law.restitution > 0 && hit_.closing * core_.settings.unit > core_.slowest_bounce(law);
}

bool Planar::Core::Flight::rebounds(FlatBody& first, double dt) {
  bodies_.clear();
  alone_ = true;
  begun_ = false;
  if (!take_in(first)) return false;
  find_impact(dt);
  return alone_ && found_ && bounces();
}

void Planar::Core::Flight::move(FlatBody& flat, double t) const {
  b2Body& b = *flat.b2;
  const b2Transform at = core_.transform_after(flat, t);
  b.SetTransform(at.p, static_cast<float>(b.GetAngle() + t * b.GetAngularVelocity()));
  b.SetLinearVelocity(b.GetLinearVelocity() + gained(flat, t));
}

double Planar::Core::Flight::take(double dt) {
  constexpr std::size_t kMost = 8;  // impacts for each body: what rattles between walls is left to Box2D
  const double start = core_.now;
  double left = dt;
  begun_ = true;
  for (std::size_t i = 0; i < kMost * bodies_.size() && alone_ && found_ && bounces(); ++i) {
    for (FlatBody* flat : bodies_) move(*flat, hit_.t);
    left -= hit_.t;
    core_.now = start + dt - left;
    core_.deliver(hit_, core_.now);
    find_impact(left);
  }
  core_.now = start;
  const bool ends = alone_ && !found_;
  for (FlatBody* flat : bodies_) {
    if (ends) move(*flat, left);
    flat->flown = true;
  }
  return ends ? 0 : left;
}

/// What rebounds in flight takes its sub-step. Returns what is left of it where that ends in a touch.
std::pmr::vector<Planar::Core::Unfinished> Planar::Core::take_flights(double dt) {
  std::pmr::vector<Unfinished> unfinished(memory);
  for (FlatBody& flat : slots) flat.flown = flat.looked_at = flat.forced = false;
  const auto force = [this](BodyIndex body) {
    if (FlatBody* flat = find(body)) flat->forced = true;
  };
  for (const BodyIndex body : force_methods) force(body);
  for (const FlatSpring& spring : springs)
    if (spring.used)
      for (const BodyIndex body : {spring.is.a, spring.is.b}) force(body);
  Flight flight(*this);
  for (FlatBody& flat : slots) {
    if (flat.looked_at || worn() || !flight.rebounds(flat, dt)) continue;
    const double left = flight.take(dt);
    if (left == 0) continue;
    unfinished.push_back({left, std::pmr::vector<BodyIndex>(memory)});
    for (const FlatBody* one : flight.bodies()) unfinished.back().bodies.push_back(one->body);
  }
  return unfinished;
}

}  // namespace breve
