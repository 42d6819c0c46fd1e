// The guard of a flat world: what has gone wrong by the end of a step, and what is done about it. More sub-steps are
// for the whole world, since Box2D steps it as one; they go back when nothing has been wrong for a while.
#include <algorithm>
#include <cmath>

#include "runtime/planar/core.hpp"

namespace breve {

void Planar::Core::intervene(BodyIndex body, GuardReason reason, double value, double moment, GuardAction action) {
  if (settings.guard == GuardMode::Off) return;
  Intervention one;
  one.iteration = iteration;
  one.time = moment;
  one.body = body == kNoBody ? ObjectId{} : bodies->owner(body);
  one.reason = reason;
  one.action = action;
  one.value = value;
  interventions.push_back(one);
}

void Planar::Core::rest(FlatBody& flat) {
  // Where it was when its numbers were numbers.
  flat.b2->SetTransform(to_b2(flat.location), static_cast<float>(angle_of(flat.orientation)));
  flat.b2->SetLinearVelocity(b2Vec2(0, 0));
  flat.b2->SetAngularVelocity(0);
  bodies->set_motion(flat.body, flat.location, flat.orientation, Vector3::Zero(), Vector3::Zero());
  note_known(flat);
}

void Planar::Core::watch(double moment) {
  constexpr int kMostDoublings = 4;
  constexpr double kGap = 0.02;  // of the smaller body's width: further than this a joint has opened
  const bool refines = settings.guard == GuardMode::Refine || settings.guard == GuardMode::Rest;
  const GuardAction action = refines && refined < kMostDoublings ? GuardAction::Refined : GuardAction::Reported;
  bool wrong = false;
  for (FlatBody& flat : slots) {
    if (flat.body == kNoBody || flat.fixed || !flat.b2->IsAwake()) continue;
    const b2Vec2 at = flat.b2->GetPosition(), v = flat.b2->GetLinearVelocity();
    const float all = at.x + at.y + v.x + v.y + flat.b2->GetAngle() + flat.b2->GetAngularVelocity();
    if (std::isfinite(all)) continue;
    intervene(flat.body, GuardReason::NotFinite, all, moment, GuardAction::Rested);
    rest(flat);
  }
  for (const FlatJoint& joint : joints) {
    if (!joint.used || !joint.b2 || joint.ring) continue;
    double width = find(joint.is.child)->thickness;
    if (const FlatBody* parent = joint.is.parent == kNoBody ? nullptr : find(joint.is.parent); parent && !parent->fixed)
      width = std::min(width, parent->thickness);
    const double open = gap(joint);
    if (!(open > std::max(kGap * 2 * width, 2.0 * b2_linearSlop) * settings.unit)) continue;
    wrong = true;
    intervene(joint.is.child, GuardReason::NoSolution, open, moment, action);
  }
  constexpr std::uint64_t kSeldom = 4;  // steps: looking at every contact costs as much as a part of solving it
  if (iteration % kSeldom == 0)
    for (b2Contact* contact = b2->GetContactList(); contact; contact = contact->GetNext()) {
      if (!contact->IsTouching()) continue;
      const FlatBody &a = of(contact->GetFixtureA()->GetBody()), &b = of(contact->GetFixtureB()->GetBody());
      b2WorldManifold where;
      contact->GetWorldManifold(&where);
      const double depth = -std::min(
          where.separations[0], contact->GetManifold()->pointCount > 1 ? where.separations[1] : where.separations[0]);
      const double bound = 0.25 * std::min(a.thickness, b.thickness) + 4 * b2_linearSlop;
      if (!(depth > bound)) continue;
      wrong = true;
      intervene(b.fixed ? a.body : b.body, GuardReason::Penetration, depth * settings.unit, moment, action);
    }
  constexpr int kCalm = 240;  // steps without anything wrong, after which the doublings are taken back one by one
  calm = wrong ? 0 : calm + 1;
  if (wrong && refines && refined < kMostDoublings) ++refined;
  if (calm >= kCalm && refined > 0) {
    --refined;
    calm = 0;
  }
}

}  // namespace breve
