// Box2D's callbacks: who may touch whom, what is known of a contact, and rebounds. Box2D's own restitution, which acts
// on velocities that gravity has changed already and spreads one impact over all that touch, is switched off; a pair
// that comes fast enough collides by the law of runtime/contact when its contact is solved first.
#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/planar/core.hpp"
#include "runtime/planar/doors.hpp"

namespace breve {

namespace {

// The data of a contact are kept where Box2D keeps its restitution, which it never uses here: -1 nothing; else the
// restitution, from 0 to 1, plus 2 if a handler waits for it, plus 4 if its friction at rest is another than in motion.
constexpr float kHandled = 2, kTwoFrictions = 4;

float restitution_of(float known) { return std::fmod(known, kHandled); }
bool two_frictions(float known) { return known >= kTwoFrictions; }

}  // namespace

contact::Law Planar::Core::law_of(const FlatBody& a, const FlatBody& b) const {
  return contact::combine(a.material, b.material, settings.unit);
}

void Planar::Core::refresh(b2Contact* contact) {
  if (contact->GetRestitution() >= 0) return;
  const FlatBody &a = of(contact->GetFixtureA()->GetBody()), &b = of(contact->GetFixtureB()->GetBody());
  const contact::Law law = law_of(a, b);
  float known = static_cast<float>(law.restitution);
  if (client && client->handled(a.body, b.body)) known += kHandled;
  if (law.static_friction != law.dynamic_friction) known += kTwoFrictions;
  contact->SetRestitution(known);
  contact->SetFriction(static_cast<float>(law.dynamic_friction));
}

bool Planar::Core::ShouldCollide(b2Fixture* a, b2Fixture* b) {
  const b2Body *x = a->GetBody(), *y = b->GetBody();
  if (!is_body(x) || !is_body(y) || !(client || thawing)) return false;
  FlatBody &first = of(x), &second = of(y);
  // A body that comes near another which steps at another time meets it when both have stepped.
  if (first.set_apart != second.set_apart && x->GetType() != b2_staticBody && y->GetType() != b2_staticBody) {
    first.missed = any_missed = true;
    return false;
  }
  // In a step Box2D takes first which shape has the lower number in its tree; that depends on what there was before.
  // Shapes of one type that collide have one part each, and of two types the type decides.
  bool swapped = false;
  if (stepping && a->GetType() == b->GetType()) key_of(*a, 0, *b, 0, swapped);
  if (swapped) {
    add_contact(*b2, *b, 0, *a, 0);
    return false;
  }
  try {
    if (!thawing && !pushes(first.body, second.body, *client)) return false;
  } catch (...) {
    failure = std::current_exception();
    return false;
  }
  first.fresh = second.fresh = true;
  ++fresh_contacts;
  return true;
}

/// Whether two bodies come together so fast that sweeps may not stop all that they touch.
bool Planar::Core::lands_hard(b2Contact& contact) const {
  const b2Body &x = *contact.GetFixtureA()->GetBody(), &y = *contact.GetFixtureB()->GetBody();
  const FlatBody &a = of(&x), &b = of(&y);
  const double size = std::min(a.fixed ? b.thickness : a.thickness, b.fixed ? a.thickness : b.thickness);
  const double u = settings.unit, pull = settings.gravity.norm();
  const auto hard = [&](double speed) {
    constexpr double kDeep = 0.05, kHigh = 0.1;  // of half the narrowest width: in a sub-step, and as after a fall
    const bool falls = speed * u > pull * step_length && speed * speed * u / 2 > pull * kHigh * size;
    return falls || speed * step_length > kDeep * size;
  };
  const b2Vec2 v = x.GetLinearVelocity() - y.GetLinearVelocity();
  const double spins =
      a.reach * std::abs(double{x.GetAngularVelocity()}) + b.reach * std::abs(double{y.GetAngularVelocity()});
  if (!hard(double{v.Length()} + spins)) return false;
  b2WorldManifold where;
  contact.GetWorldManifold(&where);
  float approach = 0;
  for (int i = 0; i < contact.GetManifold()->pointCount; ++i) {
    const b2Vec2 point = where.points[i];
    const b2Vec2 slip = x.GetLinearVelocityFromWorldPoint(point) - y.GetLinearVelocityFromWorldPoint(point);
    approach = std::max(approach, b2Dot(slip, where.normal));
  }
  return hard(double{approach});
}

void Planar::Core::BeginContact(b2Contact* contact) {
  for (const b2Fixture* fixture : {contact->GetFixtureA(), contact->GetFixtureB()}) {
    FlatBody& flat = of(const_cast<b2Fixture*>(fixture)->GetBody());
    ++flat.touching;
    if (!flat.kicked) continue;
    // Not in flight after all. Once Box2D has moved it, it is too late to give back what was taken. What springs pull
    // at gets the other half of their impulse even so: what they connect it with does.
    const b2Vec2 now_at = flat.b2->GetLinearVelocity();
    const bool moved = now_at != flat.kicked_velocity;
    if (moved && flat.flies) continue;
    flat.kicked = false;
    if (moved) continue;
    flat.b2->SetLinearVelocity(now_at + flat.kick);
    if (flat.flies) flat.b2->SetAngularVelocity(flat.b2->GetAngularVelocity() + flat.spin_kick);
  }
}

void Planar::Core::EndContact(b2Contact* contact) {
  if (muted) return;
  for (const b2Fixture* fixture : {contact->GetFixtureA(), contact->GetFixtureB()})
    --of(const_cast<b2Fixture*>(fixture)->GetBody()).touching;
}

void Planar::Core::PreSolve(b2Contact* contact, const b2Manifold*) {
  if (muted) return;
  // The host wants the end: this step of Box2D has nothing to solve then, and does nothing but move bodies.
  if (bound.ended && bound.ended->load(std::memory_order_relaxed)) {
    contact->SetEnabled(false);
    return;
  }
  try {
    before_solving(contact);
  } catch (...) {
    failure = std::current_exception();
  }
  if (!landed_hard) landed_hard = lands_hard(*contact);
}

void Planar::Core::rethrow() {
  if (failure) std::rethrow_exception(std::exchange(failure, nullptr));
}

void Planar::Core::before_solving(b2Contact* contact) {
  refresh(contact);
  const float known = contact->GetRestitution();
  if (known == 0) return;
  const bool bounces = restitution_of(known) > 0;
  if (!bounces && !two_frictions(known)) return;
  FlatBody &a = of(contact->GetFixtureA()->GetBody()), &b = of(contact->GetFixtureB()->GetBody());
  b2WorldManifold where;
  contact->GetWorldManifold(&where);
  const int points = contact->GetManifold()->pointCount;
  if (bounces && collide(a, b, where, points)) spread(a, b);
  if (!two_frictions(known)) return;
  const contact::Law law = law_of(a, b);
  const b2Vec2 slip =
      b.b2->GetLinearVelocityFromWorldPoint(where.points[0]) - a.b2->GetLinearVelocityFromWorldPoint(where.points[0]);
  // Slower than this it rests: what gravity would add along a surface in a sub-step is stopped by friction each time.
  constexpr double kRest = 1e-3;  // length units/s
  const bool rests = std::abs(b2Cross(slip, where.normal)) < kRest;
  contact->SetFriction(static_cast<float>(rests ? law.static_friction : law.dynamic_friction));
}

/// Bodies moved by scripts do work on what they touch: the impulses along its velocity.
void Planar::Core::note_driven_work(b2Contact* contact, const b2ContactImpulse& impulse) {
  b2Body *a = contact->GetFixtureA()->GetBody(), *b = contact->GetFixtureB()->GetBody();
  if (!of(a).driven && !of(b).driven) return;
  b2WorldManifold where;
  contact->GetWorldManifold(&where);
  const b2Vec2 along = b2Cross(where.normal, 1.0F);
  for (int i = 0; i < impulse.count; ++i) {
    const b2Vec2 on_b = impulse.normalImpulses[i] * where.normal + impulse.tangentImpulses[i] * along;
    double work = 0;
    if (of(a).driven) work += double{b2Dot(on_b, a->GetLinearVelocityFromWorldPoint(where.points[i]))};
    if (of(b).driven) work -= double{b2Dot(on_b, b->GetLinearVelocityFromWorldPoint(where.points[i]))};
    driven_work += work * settings.unit * settings.unit;
  }
}

/// The force on `body`, from Box2D's contacts or, before Box2D's world is made again, from the impulses of its image.
Vector3 Planar::contact_force(BodyIndex body, BodyIndex other) const {
  const Core& core = *core_;
  Vector2 impulse = Vector2::Zero();
  // The normal points to the body on which the impulse acts, which turns the tangent with it.
  const auto add = [&impulse](const Vector2& normal, double along, double across) {
    impulse += along * normal - across * left_of(normal);
  };
  const auto meant = [&](BodyIndex a, BodyIndex b) {
    return (a == body && (other == kNoBody || b == other)) || (b == body && (other == kNoBody || a == other));
  };
  if (core.frozen) {
    for (const FrozenContact& one : core.frozen->contacts) {
      if (!meant(one.key.a, one.key.b)) continue;
      const BodyIndex from = one.key.a == body ? one.key.b : one.key.a;
      const Bodies& bodies = *core.bodies;
      const Contact found =
          closest(*bodies.collision_shape(body), core.pose(body), *bodies.collision_shape(from), core.pose(from));
      const Vector2 normal = found.normal.head<2>().stableNormalized();
      for (int i = 0; i < one.manifold.pointCount; ++i)
        add(normal, static_cast<double>(one.manifold.points[i].normalImpulse),
            static_cast<double>(one.manifold.points[i].tangentImpulse));
    }
  } else if (core.b2) {
    for (b2Contact* contact = core.b2->GetContactList(); contact; contact = contact->GetNext()) {
      if (!contact->IsTouching()) continue;
      const BodyIndex a = core_->of(contact->GetFixtureA()->GetBody()).body;
      const BodyIndex b = core_->of(contact->GetFixtureB()->GetBody()).body;
      if (!meant(a, b)) continue;
      b2WorldManifold where;
      contact->GetWorldManifold(&where);
      const Vector2 normal = vector_of(where.normal) * (b == body ? 1 : -1);
      const b2Manifold& manifold = *contact->GetManifold();
      for (int i = 0; i < manifold.pointCount; ++i)
        add(normal, static_cast<double>(manifold.points[i].normalImpulse),
            static_cast<double>(manifold.points[i].tangentImpulse));
    }
  }
  if (!(core.last_step > 0)) return Vector3::Zero();
  const Vector2 force = impulse * (core.settings.unit / static_cast<double>(core.last_step));
  return {force.x(), force.y(), 0};
}

void Planar::Core::PostSolve(b2Contact* contact, const b2ContactImpulse* impulse) {
  note_driven_work(contact, *impulse);
  const float mu = contact->GetFriction();
  if (mu == 0) return;
  float sliding = 0;
  for (int i = 0; i < impulse->count; ++i)
    if (std::abs(impulse->tangentImpulses[i]) >= 0.999F * mu * impulse->normalImpulses[i])
      sliding += std::abs(impulse->tangentImpulses[i]);
  if (sliding == 0) return;
  b2WorldManifold where;
  contact->GetWorldManifold(&where);
  const b2Vec2 slip = contact->GetFixtureB()->GetBody()->GetLinearVelocityFromWorldPoint(where.points[0]) -
                      contact->GetFixtureA()->GetBody()->GetLinearVelocityFromWorldPoint(where.points[0]);
  friction += double{sliding} * std::abs(b2Cross(slip, where.normal)) * settings.unit * settings.unit;
}

}  // namespace breve
