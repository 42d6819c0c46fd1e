// One iteration of a world, and the stages of a sub-step within it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/space/walls.hpp"
#include "runtime/world/parts.hpp"
#include "runtime/world/push_scope.hpp"

namespace breve {

namespace {

/// Sets a flag for a scope.
class Flag {
 public:
  explicit Flag(bool& flag) : flag_(flag) { flag_ = true; }
  ~Flag() { flag_ = false; }
  Flag(const Flag&) = delete;
  Flag& operator=(const Flag&) = delete;

 private:
  bool& flag_;
};

/// Lets the clock read another time for a scope.
class MomentOf {
 public:
  MomentOf(double& clock, double moment) : clock_(clock), before_(clock) { clock_ = moment; }
  ~MomentOf() { clock_ = before_; }
  MomentOf(const MomentOf&) = delete;
  MomentOf& operator=(const MomentOf&) = delete;

 private:
  double& clock_;
  double before_;
};

constexpr std::uint32_t bit(EffectId id) { return 1U << static_cast<unsigned>(id); }

void require_step(std::string_view name, double seconds) {
  if (std::isfinite(seconds) && seconds > 0) return;
  throw Error(ErrorCode::Argument, fmt::format("the {} must be finite and > 0, but is {}", name, seconds));
}

}  // namespace

void World::Clock::advance(double seconds) {
  const double step = seconds - residue;
  const double sum = time + step;
  residue = (sum - time) - step;
  time = sum;
}

void World::set_iteration_step(double seconds) {
  require_step("iteration step", seconds);
  clock_.iteration_step = seconds;
}

void World::set_integration_step(double seconds) {
  require_step("integration step", seconds);
  clock_.integration_step = seconds;
}

void World::step() {
  if (stepping_) throw Error(ErrorCode::Busy, "a step cannot be taken from inside a step");
  const Flag stepping(stepping_);
  const StageScope iteration("iteration", observer_);
  Parts& parts = *parts_;
  parts.effects.begin_step();
  const auto tell = [this] {
    if (events_ && events_->listened()) tell_events();
  };
  tell();
  if (events_) events_->begin();
  parts.dynamics->begin_iteration(clock_.iteration, physics_bound_);
  deliver_input();
  tell();
  parts.objects.join();
  if (behaviour_) {
    Effect& script = parts.effects[EffectId::Script];
    const StageScope stage(script, observer_);
    const auto& first = parts.objects.iterating();
    const auto& second = parts.objects.post_iterating();
    const bool any = !first.empty() || !second.empty();
    if (any) parts.effects.turn_on(EffectId::Script, clock_.iteration, first.empty() ? second[0] : first[0]);
    for (const ObjectId id : first) {
      if (!alive(id)) continue;
      ++script.calls, ++script.items;
      behaviour_->iterate(id);
      tell();
    }
    for (const ObjectId id : second) {
      if (!alive(id)) continue;
      ++script.calls, ++script.items;
      behaviour_->post_iterate(id);
      tell();
    }
  }
  run_scheduled();
  if (behaviour_) behaviour_->end_of_iteration();
  gather_events();
  tell();
  ++clock_.iteration;
  count_bytes();
}

void World::deliver_input() {
  if (parts_->input.empty()) return;
  const StageScope stage(parts_->effects[EffectId::Input], observer_);
  // Input that arrives from inside a handler, or that an error leaves behind, waits for the next step.
  for (std::size_t left = parts_->input.size(); left > 0; --left) {
    InputEvent event = std::move(parts_->input.front());
    parts_->input.pop_front();
    if (!alive(event.object)) {
      if (event.kind == InputEvent::Kind::Menu) continue;
      event.object = {};
    }
    ++parts_->effects[EffectId::Input].calls;
    if (behaviour_) behaviour_->input(event);
  }
}

void World::run_scheduled() {
  Parts& parts = *parts_;
  if (parts.schedule.size() == 0) return;
  Effect& effect = parts.effects[EffectId::Schedule];
  const StageScope stage(effect, observer_);
  const double until = parts.exact_schedule ? clock_.time : clock_.time + clock_.iteration_step;
  Schedule::Entry entry;
  while (parts.schedule.take_due(parts.objects, until, entry)) {
    ++effect.calls;
    const MomentOf moment(clock_.time, entry.when);
    if (behaviour_) behaviour_->scheduled(entry.target, parts.names.text(entry.method));
    if (events_ && events_->listened()) tell_events();
  }
  effect.items = parts.schedule.size();
}

void World::count_bytes() {
  Effects& effects = parts_->effects;
  effects[EffectId::Motion].bytes = bodies_->bytes();
  effects[EffectId::Collision].bytes = parts_->collisions.bytes();
  effects[EffectId::Neighbors].bytes = parts_->near.bytes();
  effects[EffectId::Schedule].bytes = parts_->schedule.bytes();
  effects[EffectId::Notifications].bytes = parts_->notifications.bytes();
  effects[EffectId::Script].bytes = parts_->objects.bytes();
  if (effects[EffectId::Queries].active) effects[EffectId::Queries].bytes = parts_->queries.bytes();
}

// --- bodies ---------------------------------------------------------------------------------------------------------

void World::advance_bodies() {
  if (advancing_) throw Error(ErrorCode::Busy, "the bodies cannot be advanced from inside a collision handler");
  const Flag advancing(advancing_);
  // A program may set other steps from inside a handler: they hold from the next iteration on.
  const double iteration = clock_.iteration_step;
  const std::uint64_t count = substeps();
  parts_->aim_at_targets();
  {
    const Parts::PushScope pushes(*parts_);
    run_substeps(iteration / static_cast<double>(count), count);
  }
  parts_->reach_targets();
  parts_->count_dynamics();
  clock_.advance(iteration);
}

std::uint64_t World::substeps() const {
  // 0.06 / 0.02 is a little more than 3: the tolerance keeps rounding from making a sub-step.
  constexpr double kTolerance = 1e-9;
  constexpr double kMostSubsteps = 1e9;
  const double exact = clock_.iteration_step / clock_.integration_step;
  if (!(exact <= kMostSubsteps)) {
    throw Error(ErrorCode::Argument, fmt::format("an iteration step of {} s has too many integration steps of {} s",
                                                 clock_.iteration_step, clock_.integration_step));
  }
  return static_cast<std::uint64_t>(std::max(1.0, std::ceil(exact - kTolerance)));
}

void World::run_substeps(double h, std::uint64_t count) {
  Parts& parts = *parts_;
  try {
    for (std::uint64_t i = 0, taken = 1; i < count; i += taken) {
      // What physics has no work left for is taken at once.
      taken = parts.dynamics->over() ? count - i : 1;
      if (i != 0) parts.expect(0);
      const double length = static_cast<double>(taken) * h;
      parts.share = static_cast<double>(taken) / static_cast<double>(count - i);
      parts.substep_start = clock_.time + static_cast<double>(i) * h;
      parts.judge_pairs(length);
      const std::uint32_t signature = parts.signature();
      if (signature != parts.stage_signature) parts.rebuild_stages(signature);
      for (const Parts::Stage& stage : parts.stages) {
        Effect& effect = parts.effects[stage.effect];
        const StageScope scope(effect, observer_);
        ++effect.calls;
        effect.items += stage.items(parts);
        ++parts.moved;  // handlers that ask see the middle of a stage
        stage.run(parts, length);
        ++parts.moved;
      }
    }
  } catch (...) {
    parts.collisions.abandon();
    parts.dynamics->abandon();
    throw;
  }
}

/// What the stage that moves rigid bodies consists of, for the list of effects: they share its stage and its time.
void World::Parts::count_dynamics() {
  const Mechanics::Census census = dynamics->census();
  const DynamicsCounters& counted = dynamics->counters();
  const struct {
    EffectId id;
    bool on;
    ObjectId asked_by;
    std::uint64_t items, calls;
  } all[] = {
      {EffectId::Articulation, census.joints != 0, census.first_joint, census.joints, counted.evaluations},
      {EffectId::JointLimits, census.limits != 0, census.first_limit, census.limits, counted.limits},
      {EffectId::Motors, census.motors != 0, census.first_motor, census.motors, counted.evaluations},
      {EffectId::Springs, census.springs != 0, census.first_spring, census.springs, counted.evaluations},
      {EffectId::Contact, census.pairs != 0, census.first_pair, counted.contacts, counted.pairs},
      {EffectId::Friction, census.rough != 0, census.first_rough, census.rough, counted.contacts},
      {EffectId::Restitution, census.bouncing != 0, census.first_bouncing, census.bouncing, counted.impacts},
      {EffectId::Sleeping, dynamics->sleeping(), {}, census.asleep, census.asleep},
      {EffectId::EnergyLedger, census.bodies != 0, world->bodies_->first_rigid(), census.bodies, counted.sub_steps},
  };
  for (const auto& one : all) {
    Effect& effect = effects[one.id];
    if (one.on)
      effects.turn_on(one.id, world->clock_.iteration, one.asked_by);
    else
      effects.turn_off(one.id);
    effect.items = one.items;
    effect.calls = one.calls;
  }
  // The flat world keeps its joints in one structure with its bodies.
  effects[world->dimension() == 2 ? EffectId::Rigid : EffectId::Articulation].bytes = dynamics->bytes();
}

std::uint32_t World::Parts::signature() const {
  const Bodies& bodies = *world->bodies_;
  std::uint32_t bits = 0;
  if (bodies.translating() != 0) bits |= bit(EffectId::Motion);
  if (bodies.rotating() != 0) bits |= bit(EffectId::Rotation);
  if (bodies.rigid() != 0) bits |= bit(EffectId::Rigid);
  if (bodies.rigid() != 0 && dynamics->gravity() != Vector3::Zero()) bits |= bit(EffectId::Gravity);
  if (handlers.any_handler() && bodies.size() != 0) {
    bits |= bit(EffectId::Collision);
    if (at_impact) bits |= bit(EffectId::TimeOfImpact);
  }
  if (!space.open() && (bits & (bit(EffectId::Motion) | bit(EffectId::Rigid))) != 0) bits |= bit(EffectId::Bounds);
  return bits;
}

/// Whatever has left space comes back into it: after collisions, which look at whole paths.
void World::Parts::bring_inside() {
  Bodies& bodies = *world->bodies_;
  std::uint64_t& brought = effects[EffectId::Bounds].items;
  const auto bring = [&](BodyIndex body) {
    Vector3 location = bodies.location(body), velocity = bodies.velocity(body);
    if (space.holds(location) || !location.allFinite()) return false;
    space.bring_inside(location, velocity);
    bodies.set_location(body, location);
    if (velocity != bodies.velocity(body)) bodies.set_velocity(body, velocity);
    return true;
  };
  if (bodies.translating() != 0)
    for (const BodyIndex body : bodies.translating_bodies()) brought += bring(body) ? 1U : 0U;
  if (bodies.rigid() == 0) return;
  for (const BodyIndex body : bodies.rigid_bodies())
    if (!space.holds(bodies.location(body))) brought += bring_assembly(body) ? 1U : 0U;
}

/// Bodies that joints connect come back as one when the first of them, in the order of indices, has left: all are
/// moved by the same offset. A wall reflects the velocity of their centre of mass, and leaves how they move about it.
/// An assembly that is attached to the world, or to something that does not move, stays where it is.
bool World::Parts::bring_assembly(BodyIndex body) {
  Bodies& bodies = *world->bodies_;
  const std::pmr::vector<BodyIndex> links = dynamics->links_of(body);
  const auto moves = [&bodies](BodyIndex one) { return one != kNoBody && bodies.dynamic(one); };
  if (*std::find_if(links.begin(), links.end(), moves) != body || !bodies.location(body).allFinite()) return false;
  const std::pmr::vector<JointIndex> joints = dynamics->joints_of(body);
  for (const JointIndex joint : joints) {
    const JointDescription& is = dynamics->joint(joint);
    if (!moves(is.parent) || !moves(is.child)) return false;
  }
  double mass = 0;
  Vector3 momentum = Vector3::Zero(), force = Vector3::Zero();
  for (const BodyIndex link : links) {
    const MassProperties& solid = bodies.mass_properties(link);
    const Vector3 arm = bodies.orientation(link) * solid.center_of_mass;
    mass += solid.mass;
    momentum += solid.mass * (bodies.velocity(link) + bodies.rotational_velocity(link).cross(arm));
    force += bodies.force(link);
  }
  const Vector3 pull = dynamics->gravity() + force / mass, came = momentum / mass;
  Vector3 location = bodies.location(body), goes = came;
  throw_back(space, location, goes, pull);
  for (int i = 0; i < 3; ++i) {
    // Only what goes on outward is thrown back: a limb may have swung the first body out.
    const bool inward = (location[i] - space.axis(i).low < space.axis(i).high - location[i]) == (came[i] > 0);
    if (pull[i] == 0 && inward) goes[i] = came[i];
  }
  if (joints.empty())
    bodies.set_location(body, location);
  else
    dynamics->move_assembly(body, location, bodies.orientation(body));
  const Vector3 change = goes - came;
  if (change == Vector3::Zero()) return true;
  for (const BodyIndex link : links) bodies.set_velocity(link, bodies.velocity(link) + change);
  if (!joints.empty()) dynamics->take_changes();
  return true;
}

ObjectId World::Parts::who_asked(EffectId effect) const {
  switch (effect) {
    case EffectId::Motion: return world->bodies_->first_translating();
    case EffectId::Rotation: return world->bodies_->first_rotating();
    case EffectId::Rigid:
    case EffectId::Gravity: return world->bodies_->first_rigid();
    default: return first_handler;
  }
}

void World::Parts::rebuild_stages(std::uint32_t signature) {
  for (const EffectId id : {EffectId::Motion, EffectId::Rotation, EffectId::Rigid, EffectId::Gravity,
                            EffectId::Collision, EffectId::TimeOfImpact}) {
    if ((signature & bit(id)) != 0) {
      effects.turn_on(id, world->clock_.iteration, who_asked(id));
    } else {
      effects.turn_off(id);
    }
  }
  stages.clear();
  const bool collide = (signature & bit(EffectId::Collision)) != 0;
  if (collide) {
    stages.push_back({EffectId::Collision,
                      [](World::Parts& p, double) {
                        p.collisions.begin(
                            p, p.handlers.revision() + p.dynamics->rules() + p.world->bodies_->physics_revision(),
                            p.space);
                      },
                      [](const World::Parts&) { return std::size_t{0}; }});
  }
  if ((signature & bit(EffectId::Motion)) != 0) {
    stages.push_back({EffectId::Motion, [](World::Parts& p, double h) { p.world->bodies_->translate(h); },
                      [](const World::Parts& p) { return p.world->bodies_->translating(); }});
  }
  if ((signature & bit(EffectId::Rotation)) != 0) {
    stages.push_back({EffectId::Rotation, [](World::Parts& p, double h) { p.world->bodies_->rotate(h); },
                      [](const World::Parts& p) { return p.world->bodies_->rotating(); }});
  }
  if ((signature & bit(EffectId::Rigid)) != 0) {
    stages.push_back({EffectId::Rigid,
                      [](World::Parts& p, double h) { p.dynamics->advance(p, p.substep_start, h, p.share); },
                      [](const World::Parts& p) { return p.world->bodies_->rigid(); }});
  }
  if (collide) {
    stages.push_back({EffectId::Collision,
                      [](World::Parts& p, double h) {
                        p.collisions.finish(p, p.substep_start, h, p.dynamics->gravity(), p.at_impact);
                        const CollisionStage::Counters counted = p.collisions.take_counters();
                        p.effects[EffectId::TimeOfImpact].calls += counted.searches;
                        p.effects[EffectId::TimeOfImpact].items += counted.impacts;
                        p.effects[EffectId::TimeOfImpact].held += counted.held;
                        p.effects[EffectId::Collision].items += counted.pairs;
                      },
                      [](const World::Parts&) { return std::size_t{0}; }});
  }
  if ((signature & bit(EffectId::Bounds)) != 0) {
    stages.push_back({EffectId::Bounds, [](World::Parts& p, double) { p.bring_inside(); },
                      [](const World::Parts&) { return std::size_t{0}; }});
  }
  stage_signature = signature;
}

// --- the world as the collision stage sees it -----------------------------------------------------------------------

bool World::Parts::takes_part(BodyIndex body) const {
  return handlers.takes_part(objects.at(world->bodies_->owner(body)).cls);
}

bool World::Parts::reported(BodyIndex a, BodyIndex b) const {
  // What dynamics pushes apart it reports itself, at the impact and before its impulse.
  return handled(a, b) && !dynamics->pushes(a, b, *this);
}

bool World::Parts::handled(BodyIndex a, BodyIndex b) const {
  return handlers.handled(objects.at(world->bodies_->owner(a)).cls, objects.at(world->bodies_->owner(b)).cls) &&
         meets(a, b);
}

bool World::Parts::ignored(BodyIndex a, BodyIndex b) const {
  return handlers.ignored(objects.at(world->bodies_->owner(a)).cls, objects.at(world->bodies_->owner(b)).cls) ||
         !meets(a, b) || passes(a, b);
}

Vector3 World::Parts::stage_force(BodyIndex body, double time, std::uint64_t draw) {
  if (!world->behaviour_) return Vector3::Zero();
  ++moved;
  const MomentOf clock(world->clock_.time, time);
  return world->behaviour_->stage_force(world->bodies_->owner(body), time, draw);
}

std::uint64_t World::Parts::serial(BodyIndex body) const { return objects.at(world->bodies_->owner(body)).serial; }

void World::Parts::touched(BodyIndex a, BodyIndex b, const Contact& found, double moment) {
  if (!world->behaviour_) return;
  ++moved;
  Contact contact = found;
  if (world->dimension() == 2) {
    // Solids that meet along edges across the plane have a point anywhere on them.
    contact.point.z() = contact.normal.z() = 0;
    contact.normal.stableNormalize();
  }
  const ObjectId first = world->bodies_->owner(a);
  const ObjectId second = world->bodies_->owner(b);
  const ClassId first_class = objects.at(first).cls;
  const ClassId second_class = objects.at(second).cls;
  const MomentOf clock(world->clock_.time, moment);
  const NameId of_first = handlers.method(first_class, second_class);
  if (of_first != kNoName &&
      world->behaviour_->collided(first, second, names.text(of_first), contact.point, contact.normal)) {
    return;
  }
  if (!objects.alive(first) || !objects.alive(second)) return;
  const NameId of_second = handlers.method(second_class, first_class);
  // Between two of one class both sides have the same method, and each is called with the other.
  if (of_second != kNoName) {
    world->behaviour_->collided(second, first, names.text(of_second), contact.point, -contact.normal);
  }
}

}  // namespace breve
