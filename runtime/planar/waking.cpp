// Bodies that move without forces in a flat world, and the waking of sleeping bodies.
#include <algorithm>
#include <cmath>

#include "runtime/planar/core.hpp"

namespace breve {

namespace {

/// Whether Box2D's numbers can follow it: what it strikes would be nowhere else.
bool can_follow(const Vector3& velocity, double spin) {
  constexpr double kFastest = 1e9;  // units/s, rad/s: a square of it is a float still
  return velocity.norm() < kFastest && std::abs(spin) < kFastest;
}

}  // namespace

/// Bodies moved by scripts move in the coming h seconds from where they were to where the arrays have them.
void Planar::Core::place_drivers(double h) {
  for (FlatBody& flat : slots) {
    if (flat.body == kNoBody || !flat.fixed || !flat.solid) continue;
    const bool moving = bodies->moving(flat.body) &&
                        can_follow(bodies->velocity(flat.body), bodies->rotational_velocity(flat.body).z());
    if (!moving && !flat.driven) continue;
    flat.driven = moving;
    const Vector3 velocity = moving ? bodies->velocity(flat.body) : Vector3(Vector3::Zero());
    const double spin = moving ? bodies->rotational_velocity(flat.body).z() : 0;
    if (flat.b2->GetType() != b2_kinematicBody) flat.b2->SetType(b2_kinematicBody);
    const b2Vec2 back = to_b2(h * velocity);
    flat.b2->SetTransform(position_of(flat.body) - back, static_cast<float>(flat.b2->GetAngle() - h * spin));
    note_placed(flat);
    flat.b2->SetLinearVelocity(to_b2(velocity));
    flat.b2->SetAngularVelocity(static_cast<float>(spin));
    flat.b2->SetAwake(true);
  }
}

/// Also one that an image holds and that has not stepped since.
void Planar::Core::wake(BodyIndex body) {
  if (FrozenBody* one = find_frozen(body)) {
    one->awake = true;
    one->still = 0;
  }
  if (FlatBody* flat = find(body); flat && !flat->fixed) flat->b2->SetAwake(true);
}

FrozenBody* Planar::Core::find_frozen(BodyIndex body) {
  if (!frozen) return nullptr;
  const auto found = std::lower_bound(frozen->bodies.begin(), frozen->bodies.end(), body,
                                      [](const FrozenBody& one, BodyIndex index) { return one.body < index; });
  return found != frozen->bodies.end() && found->body == body ? &*found : nullptr;
}

void Planar::Core::wake_all() {
  for (FlatBody& flat : slots)
    if (flat.body != kNoBody) wake(flat.body);
  if (!frozen) return;
  for (FrozenBody& one : frozen->bodies) wake(one.body);
}

void Planar::Core::wake_ends(const FlatSpring& spring) {
  wake(spring.is.a);
  wake(spring.is.b);
}

void Planar::Core::wake_touching(FlatBody& flat) {
  for (b2ContactEdge* edge = flat.b2->GetContactList(); edge; edge = edge->next) edge->other->SetAwake(true);
}

/// Wakes the bodies that may touch this one at its current position.
void Planar::Core::wake_met(const FlatBody& flat) {
  struct Waker : b2QueryCallback {
    bool ReportFixture(b2Fixture* fixture) override {
      fixture->GetBody()->SetAwake(true);
      return true;
    }
  } waker;
  for (b2Fixture* fixture = flat.b2->GetFixtureList(); fixture; fixture = fixture->GetNext())
    for (int32 child = 0; child < fixture->GetShape()->GetChildCount(); ++child) {
      b2AABB box;
      fixture->GetShape()->ComputeAABB(&box, flat.b2->GetTransform(), child);
      b2->QueryAABB(&waker, box);
    }
}

}  // namespace breve
