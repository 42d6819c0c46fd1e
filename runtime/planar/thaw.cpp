// From an image's data to Box2D's world.
#include <algorithm>

#include "runtime/planar/core.hpp"
#include "runtime/planar/doors.hpp"

namespace breve {

/// Box2D's world as it was when the image was taken, with the bodies and joints that it knew. Others it gets to know in
/// the next step, as in the world that was saved.
void Planar::Core::thaw_world() {
  const double kept_base = base;  // the image has it
  make_world();
  try {
    thaw();
  } catch (...) {
    drop_world();  // half of it would be another world than the image's
    base = kept_base;
    throw;
  }
  base = kept_base;
}

void Planar::Core::thaw() {
  if (slot_of.size() < bodies->index_end()) slot_of.resize(bodies->index_end(), kNoSlot);
  for (const FrozenBody& one : frozen->bodies)
    if (bodies->dynamic(one.body) || bodies->driver(one.body) || joints_at.count(one.body) != 0) add_member(one.body);
  order_bodies();
  held.hold(expected_bytes() + frozen->contacts.size() * kPerContact);
  thaw_bodies();
  thaw_joints();
  thaw_contacts();
  for (const FrozenBody& one : frozen->bodies) {
    FlatBody* flat = find(one.body);
    if (!flat || flat->b2->GetType() == b2_staticBody) continue;
    flat->b2->SetAwake(one.awake);
    sleep_time(*flat->b2) = one.still;
  }
  frozen.reset();
  bodies->touch_rigid();
}

void Planar::Core::thaw_bodies() {
  for (const FrozenBody& one : frozen->bodies) {
    FlatBody* flat = find(one.body);
    if (!flat) continue;
    if (flat->fixed && one.kinematic) flat->b2->SetType(b2_kinematicBody);
    flat->driven = flat->fixed && one.driven;
    flat->pulled = one.pulled;
    placed -= flat->placed ? 1 : 0;
    flat->placed = one.placed;
    placed += flat->placed ? 1 : 0;
    flat->b2->SetTransform(b2Vec2(one.x, one.y), one.angle);
    set_sweep(*flat->b2, b2Vec2(one.center_x, one.center_y), b2Vec2(one.before_x, one.before_y), one.angle_before);
    flat->b2->SetLinearVelocity(b2Vec2(one.vx, one.vy));
    flat->b2->SetAngularVelocity(one.spin);
    flat->location = one.location;
    flat->velocity = one.velocity;
    flat->spin = one.rotational_velocity;
    flat->orientation = one.orientation;
    flat->force = Vector2(one.force_x, one.force_y);
    flat->torque = one.torque;
  }
  // Bodies that were fast have wide boxes; many of them, in an image that somebody made up, would pair all with all.
  constexpr std::size_t kPairsOfWide = 1 << 20;
  std::size_t wide_left = kPairsOfWide / std::max<std::size_t>(1, frozen->bodies.size());
  for (const FrozenBox& one : frozen->boxes) {
    b2Fixture* fixture = fixture_of(one.body, one.fixture, one.child);
    if (!fixture) continue;
    b2AABB box, tight;
    box.lowerBound = {one.low_x, one.low_y};
    box.upperBound = {one.high_x, one.high_y};
    const auto child = static_cast<int>(one.child);
    fixture->GetShape()->ComputeAABB(&tight, fixture->GetBody()->GetTransform(), child);
    b2AABB widest = tight;
    constexpr float kWidest = 6 * b2_maxTranslation;  // Box2D looks ahead by four ways of a step, and has moved one
    widest.lowerBound -= b2Vec2(kWidest, kWidest);
    widest.upperBound += b2Vec2(kWidest, kWidest);
    if (!box.IsValid() || !box.Contains(tight)) continue;  // no box of this world
    const bool wide = !widest.Contains(box);
    if (wide && wide_left == 0) continue;
    wide_left -= wide ? 1 : 0;
    set_roomy_box(*b2, *fixture, child, box);
  }
}

void Planar::Core::thaw_joints() {
  for (const FrozenJoint& one : frozen->joints) {
    FlatJoint& joint = joints[one.joint];
    const bool held = find(joint.is.child) && (joint.is.parent == kNoBody || find(joint.is.parent));
    if (!joint.used || joint.b2 || !held) continue;
    make_b2(joint, one.reference);
    joint.loose = one.loose;
    put_drive(joint);
    set_warm(joint, one.warm);
  }
}

void Planar::Core::thaw_contacts() {
  thawing = true;
  for (const FrozenContact& one : frozen->contacts) {
    b2Fixture* a = fixture_of(one.key.a, one.key.fixture_a, one.key.child_a);
    b2Fixture* b = fixture_of(one.key.b, one.key.fixture_b, one.key.child_b);
    if (!a || !b) continue;
    b2Contact* contact = add_contact(*b2, *a, static_cast<int>(one.key.child_a), *b, static_cast<int>(one.key.child_b));
    if (!contact) continue;
    contact->SetFriction(one.friction);
    if (!one.touching) continue;
    b2Manifold manifold = one.manifold;
    manifold.type = static_cast<b2Manifold::Type>(one.type);
    set_touching(*contact, manifold);
    for (const b2Fixture* fixture : {a, b}) ++of(fixture->GetBody()).touching;
  }
  order_contacts();
  thawing = false;
}

/// A shape of a body; null if there is none of this number, or if it has no such edge.
b2Fixture* Planar::Core::fixture_of(BodyIndex body, std::uint32_t number, std::uint32_t child) const {
  const FlatBody* flat = find(body);
  if (!flat) return nullptr;
  for (b2Fixture* fixture = flat->b2->GetFixtureList(); fixture; fixture = fixture->GetNext())
    if (number_of(fixture) == number)
      return child < static_cast<std::uint32_t>(fixture->GetShape()->GetChildCount()) ? fixture : nullptr;
  return nullptr;
}

}  // namespace breve
