// The guard of a flat world: what has gone wrong by the end of a step, and what is done about it. More sub-steps are
// for the whole world; they go back when nothing has been wrong for a while.
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/base/error.hpp"
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

/// Those of its contacts and joints in the last step may be no numbers, or are what threw it.
void Planar::Core::forget_impulses(const FlatBody& flat) {
  for (b2ContactEdge* edge = flat.b2->GetContactList(); edge; edge = edge->next)
    for (b2ManifoldPoint& point : edge->contact->GetManifold()->points) point.normalImpulse = point.tangentImpulse = 0;
  for (FlatJoint& joint : joints)
    if (joint.used && joint.b2 && (joint.b2->GetBodyA() == flat.b2 || joint.b2->GetBodyB() == flat.b2))
      set_warm(joint, {});
}

namespace {

/// At rest there, also where Box2D has made its numbers infinite.
void hold_at(b2Body& b, const b2Vec2& position, float angle) {
  b.SetTransform(position, angle);
  if (b.GetType() == b2_staticBody) {
    // Its velocities cannot be set; a change of type makes them zero.
    b.SetType(b2_kinematicBody);
    b.SetType(b2_staticBody);
  }
  b.SetLinearVelocity(b2Vec2(0, 0));
  b.SetAngularVelocity(0);
}

}  // namespace

void Planar::Core::rest(FlatBody& flat) {
  // Where it was when its numbers were numbers.
  bodies->set_motion(flat.body, flat.location, flat.orientation, Vector3::Zero(), Vector3::Zero());
  note_known(flat);
  hold_still(flat);
}

/// In Box2D, where the arrays have it.
void Planar::Core::hold_still(FlatBody& flat) {
  hold_at(*flat.b2, position_of(flat.body), static_cast<float>(angle_of(flat.orientation)));
  forget_impulses(flat);
}

namespace {

constexpr int kMostDoublings = 4;
constexpr int kWindow = 16;  // steps, in which energy is watched

bool refines(GuardMode mode) { return mode == GuardMode::Refine || mode == GuardMode::Rest; }

}  // namespace

GuardAction Planar::Core::remedy() const {
  return refines(settings.guard) && refined < kMostDoublings ? GuardAction::Refined : GuardAction::Reported;
}

/// The body that has most energy of motion.
FlatBody* Planar::Core::liveliest() {
  FlatBody* found = nullptr;
  double most = -1;
  for (FlatBody& flat : slots) {
    if (flat.body == kNoBody || flat.fixed) continue;
    const double has = motion_of(flat);
    if (!(has > most)) continue;
    most = has;
    found = &flat;
  }
  return found;
}

/// What single precision may add to the energy of springs in the steps of a window. A length between points at x is
/// exact to a part of 1e-7 of x, which is a change of F dx + k dx^2 / 2, at random in each sub-step, and of c dx^2 / h
/// in a damper, always a loss: it damps motion that rounding takes away.
double Planar::Core::rounding_of_springs() const {
  constexpr double kSingle = std::numeric_limits<float>::epsilon();
  const auto reach = [this](BodyIndex body, const Vector3& point) {
    const double angle = std::abs(angle_of(bodies->orientation(body)));
    return bodies->location(body).norm() + point.norm() * (1 + angle);
  };
  double sum = 0, damped = 0;
  for (const FlatSpring& spring : springs) {
    if (!spring.used || !bodies->used(spring.is.a) || !bodies->used(spring.is.b)) continue;
    const double dx = kSingle * (reach(spring.is.a, spring.is.point_a) + reach(spring.is.b, spring.is.point_b));
    sum += std::abs(spring.force) * dx + 0.5 * spring.is.strength * dx * dx;
    damped += spring.is.damping * dx * dx;
  }
  for (const FlatJoint& joint : joints) {
    if (!joint.used || !(joint.drive.stiffness + joint.drive.damping > 0)) continue;
    double far = std::abs(read_position(joint));
    if (joint.is.kind == JointKind::Prismatic) far += reach(joint.is.child, joint.is.child_point);
    const double dx = kSingle * (1 + far);
    sum += std::abs(joint.pull) * dx + 0.5 * joint.drive.stiffness * dx * dx;
    damped += joint.drive.damping * dx * dx;
  }
  const double count = kWindow * (sub_steps() << refined);
  return std::sqrt(count) * sum + (last_step > 0 ? count * damped / last_step : 0);
}

/// Unexplained energy. Where motion reverses hardly anything moves, and a first-order rule errs by as
/// much: so it is compared with the most that moved in the last steps. Whether something is wrong.
bool Planar::Core::watch_energy(const Balance& before, double moment) {
  constexpr double kResidual = 0.1,
                   kResidualFast = 1;  // as runtime/dynamics; the fast rung is not meant to keep energy
  constexpr double kTiny = 1e-6;       // of what is stored: single precision
  if (settings.guard == GuardMode::Off) return false;
  const Balance after = balance(springs_known);
  const double in = after.works - before.works, out = after.losses - before.losses;
  const double gain = after.stored - before.stored - in + out - std::max(pushed, 0.0);
  if (watched.steps >= kWindow) watched = {};
  ++watched.steps;
  watched.gain += gain;
  watched.kinetic = std::max({watched.kinetic, before.kinetic, after.kinetic});
  watched.turnover += std::abs(in) + std::abs(out);
  watched.slack = std::max(watched.slack, before.slack + rounding_of_springs());
  const double most = settings.accuracy.rung == Rung::Fast ? kResidualFast : kResidual;
  const double bound = most * (watched.kinetic + watched.turnover) + watched.slack + kTiny * std::abs(before.stored);
  if (!(watched.gain > bound)) return false;
  FlatBody* shows = liveliest();
  if (!shows) return false;
  GuardAction action = remedy();
  if (action == GuardAction::Reported && settings.guard == GuardMode::Rest) {
    // Refining did not help: the body, with all that hangs on it, ends where it is.
    std::pmr::vector<BodyIndex> all(memory);
    collect(shows->body, all);
    for (const BodyIndex body : all)
      if (FlatBody* flat = find(body); flat && !flat->fixed) rest(*flat);
    action = GuardAction::Rested;
  }
  intervene(shows->body, GuardReason::Residual, watched.gain, moment, action);
  watched = {};
  return true;
}

/// The deepest overlap of each body: there are as many overlaps in a crowd as pairs. Whether there are any.
bool Planar::Core::tell_overlaps(double moment, GuardAction action) {
  std::pmr::vector<double> deepest(memory);  // by body
  for (b2Contact* contact = b2->GetContactList(); contact; contact = contact->GetNext()) {
    if (!contact->IsTouching()) continue;
    const FlatBody &a = of(contact->GetFixtureA()->GetBody()), &b = of(contact->GetFixtureB()->GetBody());
    b2WorldManifold where;
    contact->GetWorldManifold(&where);
    const double depth = -std::min(
        where.separations[0], contact->GetManifold()->pointCount > 1 ? where.separations[1] : where.separations[0]);
    if (!(depth > 0.25 * std::min(a.thickness, b.thickness) + 4 * b2_linearSlop)) continue;
    deepest.resize(slot_of.size());
    double& most = deepest[b.fixed ? a.body : b.body];
    most = std::max(most, depth);
  }
  for (BodyIndex body = 0; body < deepest.size(); ++body)
    if (deepest[body] > 0) intervene(body, GuardReason::Penetration, deepest[body] * settings.unit, moment, action);
  return !deepest.empty();
}

/// Puts bodies whose numbers are not finite where they were. Whether there were any.
bool Planar::Core::rest_spoiled(double moment) {
  BodyIndex lost = kNoBody;
  for (FlatBody& flat : slots) {
    if (flat.body == kNoBody || flat.fixed || !flat.b2->IsAwake()) continue;
    if (is_finite(*flat.b2)) continue;
    intervene(flat.body, GuardReason::NotFinite, 0, moment, GuardAction::Rested);
    rest(flat);
    lost = flat.body;
  }
  if (lost == kNoBody) return false;
  // A number that is not finite spreads to all that such a body touches, and to what its joints hang on.
  for (FlatBody& flat : slots)
    if (flat.body != kNoBody && flat.fixed && !is_finite(*flat.b2)) hold_still(flat);
  if (!is_finite(*ground)) hold_at(*ground, b2Vec2(0, 0), 0);
  return true;
}

void Planar::Core::watch(double moment, bool wrong) {
  constexpr double kGap = 0.02;  // of the smaller body's width: further than this a joint has opened
  const GuardAction action = remedy();
  if (rest_spoiled(moment) && settings.guard == GuardMode::Off)
    throw Error(
        ErrorCode::Numeric,
        "a position or velocity in a flat world is no longer finite; the body was put back to where it was, at rest. "
        "The guard would have reported it (set-guard, breve_world_set_guard)");
  for (const FlatJoint& joint : joints) {
    if (!joint.used || !joint.b2 || joint.loop) continue;
    double width = find(joint.is.child)->thickness;
    if (const FlatBody* parent = joint.is.parent == kNoBody ? nullptr : find(joint.is.parent); parent && !parent->fixed)
      width = std::min(width, parent->thickness);
    const double open = gap(joint);
    if (!(open > std::max(kGap * 2 * width, 2.0 * b2_linearSlop) * settings.unit)) continue;
    wrong = true;
    intervene(joint.is.child, GuardReason::OpenJoint, open, moment, action);
  }
  constexpr std::uint64_t kSeldom = 4;  // steps: looking at every contact costs as much as a part of solving it
  if (iteration % kSeldom == 0 && tell_overlaps(moment, action)) wrong = true;
  constexpr int kCalm = 240;  // steps without anything wrong, after which the doublings are taken back one by one
  calm = wrong ? 0 : calm + 1;
  if (wrong && action == GuardAction::Refined) ++refined;
  if (calm >= kCalm && refined > 0) {
    --refined;
    calm = 0;
  }
}

}  // namespace breve
