// Decides for each pair whether it collides: by bits, excluded pairs, open sides, and the answers of the objects and
// the host when they are asked.
#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/world/parts.hpp"

namespace breve {

void World::set_filter(BodyIndex body, const CollisionFilter& filter) {
  bodies_->set_filter(body, filter);
  wake_around(body);
}

bool World::set_collides(ObjectId a, ObjectId b, bool on) {
  if (a == b) throw Error(ErrorCode::Argument, "an object does not collide with itself");
  parts_->objects.at(a);
  parts_->objects.at(b);
  if (!parts_->pairs.exclude(a, b, !on)) return false;
  parts_->handlers.note_change();
  for (const ObjectId id : {a, b})
    if (has_body(id)) wake_around(body(id));
  return true;
}

bool World::collides(ObjectId a, ObjectId b) const { return !parts_->pairs.excluded(a, b); }

void World::set_pair_judge(PairJudge* judge) { parts_->judge = judge; }

/// What lies on it, asleep, may have lost its ground.
void World::wake_around(BodyIndex body) {
  if (bodies_->rigid() == 0 || !mechanics().sleeping()) return;
  // With room for the gap that solvers leave.
  Eigen::AlignedBox3d box = bodies_->bounds(body);
  const Vector3 room = Vector3::Constant(0.05 * bodies_->collision_shape(body)->bounding_radius());
  box.min() -= room;
  box.max() += room;
  const std::pmr::vector<BodyIndex> found(parts_->queries.boxes(scene(), box), memory_);
  for (const BodyIndex one : found)
    if (bodies_->dynamic(one)) bodies_->touch({&one, 1});
}

Queries& World::queries() { return parts_->queries; }

Queries::Scene World::scene() {
  return {*bodies_, parts_->space, parts_->moved,
          [](const void* parts, BodyIndex body) { return static_cast<const Parts*>(parts)->serial(body); },
          parts_.get()};
}

Queries::Scene World::scene_of_script() {
  Queries::Scene asked = scene();
  asked.work = [](const void* parts, std::uint64_t units) { static_cast<const Parts*>(parts)->charge(units); };
  asked.ended = physics_bound_.ended;
  return asked;
}

/// Neither pushed nor reported.
bool World::Parts::denied(ObjectId a, ObjectId b) const {
  if (!pairs.any()) return false;
  if (pairs.excluded(a, b)) return true;
  const PairRules::Decision* decision = pairs.decided(a, b);
  return decision != nullptr && decision->denied;
}

bool World::Parts::meets(BodyIndex a, BodyIndex b) const {
  const Bodies& bodies = *world->bodies_;
  if (bodies.filtered() && !bodies.filter(a).meets(bodies.filter(b))) return false;
  return !denied(bodies.owner(a), bodies.owner(b));
}

/// They meet, but neither stops the other.
bool World::Parts::passes(BodyIndex a, BodyIndex b) const {
  const Bodies& bodies = *world->bodies_;
  if (!bodies.filtered()) return false;
  if (bodies.filter(a).sensor || bodies.filter(b).sensor) return true;
  const PairRules::Decision* decision = pairs.decided(bodies.owner(a), bodies.owner(b));
  return decision != nullptr && decision->passing;
}

namespace {

/// The bounds with all that a body may reach in h seconds.
Eigen::AlignedBox3d within_reach(const Bodies& bodies, BodyIndex body, const Vector3& gravity, double h) {
  Eigen::AlignedBox3d box = bodies.bounds(body);
  const double radius = bodies.collision_shape(body)->bounding_radius();
  Vector3 room = (bodies.velocity(body).cwiseAbs() + h * gravity.cwiseAbs()) * (2 * h);
  room += Vector3::Constant(0.05 * radius + std::min(bodies.rotational_velocity(body).norm() * h, 2.0) * radius);
  box.min() -= room;
  box.max() += room;
  return box;
}

double fastest_of(const Bodies& bodies) {
  double most = 0;
  for (const std::pmr::vector<BodyIndex>* some : {&bodies.rigid_bodies(), &bodies.translating_bodies()})
    for (const BodyIndex body : *some) most = std::max(most, bodies.velocity(body).norm());
  return most;
}

}  // namespace

/// Each object is asked once while they are near, in the order of creation. The answering code may do anything.
void World::Parts::ask(ObjectId one, ObjectId other) {
  const bool first = PairRules::is_first(one, other);
  {
    PairRules::Decision& decision = pairs.decision(one, other);
    bool& asked = first ? decision.asked_first : decision.asked_second;
    if (asked || decision.denied) return;
    asked = true;
  }
  ++effects[EffectId::Filters].items;
  const bool accepted = (judge == nullptr || judge->accepts(one, other)) &&
                        (!objects.alive(one) || !objects.alive(other) || world->behaviour_ == nullptr ||
                         world->behaviour_->may_collide(one, other));
  if (accepted || !objects.alive(one) || !objects.alive(other)) return;
  pairs.decision(one, other).denied = true;
  handlers.note_change();
}

/// A body that comes through the open side passes until it is clear of the gate, on the gate's closed side.
void World::Parts::let_pass(BodyIndex gate, BodyIndex other) {
  constexpr double kClosed = 0.7071;  // within 45 degrees of the closed side's normal
  const Bodies& bodies = *world->bodies_;
  PairRules::Decision& decision = pairs.decision(bodies.owner(gate), bodies.owner(other));
  const Shape &of_gate = *bodies.collision_shape(gate), &of_other = *bodies.collision_shape(other);
  const Pose at{bodies.location(gate), bodies.orientation(gate)};
  const Contact contact = closest(of_other, {bodies.location(other), bodies.orientation(other)}, of_gate, at);
  const Vector3 closed = (at.orientation * bodies.filter(gate).one_way).stableNormalized();
  const bool above = contact.normal.dot(closed) > kClosed;
  // Solvers let what rests sink in a little: that is not from below.
  const double slack = 0.02 * std::min(of_gate.bounding_radius(), of_other.bounding_radius());
  const bool passing = decision.passing ? !(above && contact.distance > 0) : !(above && contact.distance > -slack);
  if (passing == decision.passing) return;
  decision.passing = passing;
  handlers.note_change();
}

void World::Parts::judge_pairs(double h) {
  Bodies& bodies = *world->bodies_;
  if (bodies.picky().empty()) {
    if (!pairs.any()) return;
    pairs.begin();
    if (pairs.finish()) handlers.note_change();
    effects.turn_off(EffectId::Filters);
    return;
  }
  effects.turn_on(EffectId::Filters, world->clock_.iteration, bodies.owner(bodies.picky().front()));
  const StageScope stage(effects[EffectId::Filters], world->observer_);
  ++effects[EffectId::Filters].calls;
  pairs.begin();
  const Vector3 gravity = dynamics->gravity();
  const Vector3 others = Vector3::Constant((fastest_of(bodies) + h * gravity.norm()) * 2 * h);
  // The answering code may free and create bodies, so both lists are copies.
  std::pmr::vector<BodyIndex> picky(bodies.picky(), stages.get_allocator());
  std::sort(picky.begin(), picky.end(), [this](BodyIndex x, BodyIndex y) { return serial(x) < serial(y); });
  std::pmr::vector<ObjectId> owners(stages.get_allocator());
  for (const BodyIndex body : picky) owners.push_back(bodies.owner(body));
  for (const ObjectId one : owners) {
    if (!objects.alive(one) || objects.at(one).body == kNoBody) continue;
    const BodyIndex body = objects.at(one).body;
    const Eigen::AlignedBox3d box = within_reach(bodies, body, gravity, h);
    if (!box.min().allFinite() || !box.max().allFinite()) continue;
    std::pmr::vector<ObjectId> near(stages.get_allocator());
    for (const BodyIndex other : queries.boxes(world->scene(), {box.min() - others, box.max() + others}))
      if (other != body && bodies.filter(body).meets(bodies.filter(other)) &&
          within_reach(bodies, other, gravity, h).intersects(box))
        near.push_back(bodies.owner(other));
    for (const ObjectId two : near) {
      if (!objects.alive(one) || !objects.alive(two)) continue;
      pairs.decision(one, two).seen = true;
      if (bodies.filter(body).asks) ask(one, two);
      if (!objects.alive(one) || !objects.alive(two) || bodies.filter(body).one_way.isZero(0)) continue;
      if (bodies.dynamic(objects.at(two).body)) let_pass(body, objects.at(two).body);
    }
  }
  if (pairs.finish()) handlers.note_change();
}

}  // namespace breve
