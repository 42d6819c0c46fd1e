// World: objects, bodies and the registries around them. The step is in step.cpp, images are in world_image.cpp.
#include "runtime/world/world.hpp"

#include <fmt/format.h>

#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/dynamics/dynamics.hpp"
#ifndef BREVE_WITHOUT_PLANAR
#include "runtime/planar/planar.hpp"
#endif
#include "runtime/world/parts.hpp"

namespace breve {

World::Parts::Parts(World& owner, std::pmr::memory_resource* memory)
    : world(&owner),
      objects(memory),
      names(memory),
      schedule(memory),
      notifications(memory),
      handlers(memory),
      pairs(memory),
      collisions(memory, *owner.bodies_),
      dynamics(make_in<Dynamics>(memory, memory, *owner.bodies_)),
      stages(memory),
      targets(memory),
      target_places(memory),
      pushes(memory),
      left(memory),
      queries(memory),
      near(memory),
      input(memory),
      loaders(memory) {}

World::World(std::pmr::memory_resource* memory, std::uint64_t seed)
    : memory_(memory),
      bodies_(make_in<Bodies>(memory, memory)),
      parts_(make_in<Parts>(memory, *this, memory)),
      random_(seed),
      view_(memory) {}

World::~World() = default;

void World::set_behaviour(Behaviour* behaviour) { behaviour_ = behaviour; }

// --- objects --------------------------------------------------------------------------------------------------------

ObjectId World::create(ClassId cls, std::uint64_t user, bool iterates, bool post_iterates) {
  const ObjectId id = parts_->objects.create(cls, user, iterates, post_iterates);
  if (events_ && events_->wants(Events::kLives)) events_->lives.push_back({id, ticket(id), cls, true});
  return id;
}

void World::release(ObjectId id) {
  Parts& parts = *parts_;
  const ObjectTable::Slot& slot = parts.objects.at(id);
  if (slot.body != kNoBody) {
    parts.collisions.forget(slot.body);
    parts.dynamics->forget(slot.body);
    bodies_->remove(slot.body);
    parts.objects.set_body(id, kNoBody);
  }
  if (slot.events != 0) parts.schedule.forget(parts.objects, id);
  parts.notifications.forget(id);
  parts.pairs.forget(id);
  if (events_) events_->forget(id);
  if (events_ && events_->wants(Events::kLives)) events_->lives.push_back({id, ticket(id), slot.cls, false});
  parts.near.forget(id);
  parts.objects.release(id);
}

bool World::alive(ObjectId id) const { return parts_->objects.alive(id); }
std::uint32_t World::ticket(ObjectId id) const { return parts_->objects.ticket(id); }
ObjectId World::holder(std::uint32_t index, std::uint32_t ticket) const {
  return parts_->objects.holder(index, ticket);
}
std::span<const ObjectHandle> World::handles() const { return parts_->objects.handles(); }
std::uint64_t World::user(ObjectId id) const { return parts_->objects.at(id).user; }
void World::set_user(ObjectId id, std::uint64_t user) {
  parts_->objects.set_user(id, user);
  parts_->near.set_user(id, user);
}
bool World::runs(ObjectId id, bool iterates, bool post_iterates) const {
  const ObjectTable::Slot& slot = parts_->objects.at(id);
  return slot.iterates == iterates && slot.post_iterates == post_iterates;
}
ClassId World::class_of(ObjectId id) const { return parts_->objects.at(id).cls; }
std::size_t World::object_count() const { return parts_->objects.count(); }

std::pmr::vector<ObjectId> World::objects() const {
  std::pmr::vector<ObjectId> live(memory_);
  live.reserve(parts_->objects.count());
  for (const ObjectId id : parts_->objects.order()) {
    if (parts_->objects.alive(id)) live.push_back(id);
  }
  return live;
}

void World::attach(ObjectId id, std::unique_ptr<Resource> resource) {
  // The old one goes after the new one is in place: its destructor may look at the world.
  std::swap(parts_->objects.at(id).resource, resource);
}

Resource* World::resource(ObjectId id) const {
  return parts_->objects.alive(id) ? parts_->objects.at(id).resource.get() : nullptr;
}

void World::add_resource_kind(std::string_view kind, ResourceLoader loader) {
  parts_->loaders.insert_or_assign(std::pmr::string(kind, memory_), loader);
}

// --- bodies ---------------------------------------------------------------------------------------------------------

void World::embody(ObjectId id, BodyKind kind) {
  if (parts_->objects.at(id).body != kNoBody) throw Error(ErrorCode::Argument, "the object already has a body");
  parts_->objects.set_body(id, bodies_->add(kind, id));
}

bool World::has_body(ObjectId id) const { return parts_->objects.alive(id) && parts_->objects.at(id).body != kNoBody; }

BodyIndex World::body(ObjectId id) const {
  const BodyIndex body = parts_->objects.at(id).body;
  if (body == kNoBody) throw Error(ErrorCode::Argument, "the object has no body in the world");
  return body;
}

std::pmr::vector<ObjectId> World::touching(ObjectId id) {
  const BodyIndex self = body(id);
  const Queries::Scene asked = scene_of_script();
  const std::pmr::vector<BodyIndex> near(parts_->queries.boxes(asked, bodies_->bounds(self)), memory_);
  std::pmr::vector<ObjectId> found(memory_);
  for (const BodyIndex other : near) {
    const bool solvable = bodies_->kind(other) == BodyKind::Stationary || bodies_->physics(other);
    if (other != self && solvable && parts_->queries.meet(asked, self, other)) found.push_back(bodies_->owner(other));
  }
  return found;
}

// --- neighbours -----------------------------------------------------------------------------------------------------

void World::update_neighbors() {
  Parts& parts = *parts_;
  const StageScope stage(parts.effects[EffectId::Neighbors], observer_);
  parts.near.clear(parts.objects.slot_count());
  parts.effects.turn_on(EffectId::Neighbors, clock_.iteration, {});
  for (const ObjectId id : parts.objects.order()) {
    if (!parts.objects.alive(id)) continue;
    const ObjectTable::Slot& slot = parts.objects.at(id);
    const BodyIndex body = slot.body;
    if (body == kNoBody || !bodies_->location(body).allFinite()) continue;
    constexpr double kUnset = 0.00001;  // what a radius nobody set counts as
    const double radius = bodies_->neighborhood_size(body);
    parts.near.add(id, slot.user, parts.space.inside(bodies_->location(body)), radius == 0 ? kUnset : radius);
  }
  parts.near.close(parts.space);
  ++parts.effects[EffectId::Neighbors].calls;
}

// Answers that are only looked up are not timed: reading the clock would cost as much.

const std::pmr::vector<ObjectId>& World::neighbors(ObjectId id) {
  Effect& effect = parts_->effects[EffectId::Neighbors];
  ++effect.items;
  if (parts_->near.answered()) return parts_->near.neighbors(id);
  const StageScope stage(effect, observer_);
  return parts_->near.neighbors(id);
}

std::span<const std::uint64_t> World::neighbor_users(ObjectId id) {
  Effect& effect = parts_->effects[EffectId::Neighbors];
  ++effect.items;
  if (parts_->near.answered()) return parts_->near.users(id);
  const StageScope stage(effect, observer_);
  return parts_->near.users(id);
}

// --- how far space goes ----------------------------------------------------------------------------------------------

void World::set_space(int axis, Ending edge, double low, double high, ObjectId asked_by) {
  // Wherever else z were brought to, it would not be 0 any more.
  if (dimension() == 2 && axis == 2 && edge != Ending::Open && !(low <= 0 && 0 < high))
    throw Error(ErrorCode::Argument,
                "the bounds of space along z do not include 0, but this world is flat: z must be 0");
  parts_->space.set(axis, edge, low, high);
  if (parts_->space.open())
    parts_->effects.turn_off(EffectId::Bounds);
  else
    parts_->effects.turn_on(EffectId::Bounds, clock_.iteration, asked_by);
}

const Extent& World::space() const { return parts_->space; }

// --- schedule -------------------------------------------------------------------------------------------------------

bool World::schedule(ObjectId target, std::string_view method, double when, double interval) {
  if (!std::isfinite(when) || !std::isfinite(interval) || interval < 0) {
    throw Error(ErrorCode::Argument,
                fmt::format("a call of '{}' cannot be scheduled at time {} with interval {}", method, when, interval));
  }
  parts_->objects.at(target);
  if (when <= clock_.time) {
    if (!(interval > 0)) return false;
    when = clock_.time + interval;
  }
  parts_->schedule.add(parts_->objects, target, parts_->names.intern(method), when, interval);
  parts_->effects.turn_on(EffectId::Schedule, clock_.iteration, target);
  return true;
}

std::size_t World::unschedule(ObjectId target, std::string_view method, double when) {
  const NameId name = method.empty() ? kNoName : parts_->names.find(method);
  if (!method.empty() && name == kNoName) return 0;
  return parts_->schedule.remove(parts_->objects, target, name, when,
                                 [this](std::uint64_t units) { parts_->work(units); });
}

void World::set_stable_schedule(bool stable) { parts_->schedule.set_stable(stable); }
void World::set_exact_schedule(bool exact) { parts_->exact_schedule = exact; }
std::size_t World::scheduled_count() const { return parts_->schedule.size(); }

// --- notifications --------------------------------------------------------------------------------------------------

void World::observe(ObjectId observer, ObjectId announcer, std::string_view message, std::string_view method) {
  parts_->objects.at(observer);
  parts_->objects.at(announcer);
  const NameId text = parts_->names.intern(message);
  parts_->notifications.observe(parts_->objects, announcer, {observer, text, parts_->names.intern(method)});
  parts_->effects.turn_on(EffectId::Notifications, clock_.iteration, observer);
}

std::size_t World::unobserve(ObjectId observer, ObjectId announcer, std::string_view message) {
  const NameId text = parts_->names.find(message);
  if (text == kNoName || !alive(announcer)) return 0;
  return parts_->notifications.unobserve(observer, announcer, text);
}

void World::announce(ObjectId announcer, std::string_view message) {
  parts_->objects.at(announcer);
  if (events_ && events_->wants(Events::kAnnouncements))
    events_->announcements.push_back({announcer, ticket(announcer), clock_.time, std::pmr::string(message, memory_)});
  const NameId text = parts_->names.find(message);
  if (text == kNoName || !behaviour_) return;
  // A copy: handlers may observe, unobserve, free anyone, and announce again.
  std::pmr::vector<Notifications::Registration> wanted(memory_);
  parts_->notifications.collect(parts_->objects, announcer, text, wanted);
  if (wanted.empty()) return;
  const StageScope stage("notifications", observer_);
  for (const auto& registration : wanted) {
    if (!alive(registration.observer)) continue;
    ++parts_->effects[EffectId::Notifications].calls;
    behaviour_->notified(registration.observer, parts_->names.text(registration.method), announcer, message);
  }
}

// --- collision handlers, input, effects -----------------------------------------------------------------------------

void World::handle_collisions(ClassId owner, ClassId other, std::string_view method, ObjectId asked_by) {
  parts_->handlers.handle(owner, other, parts_->names.intern(method));
  if (!parts_->first_handler) parts_->first_handler = asked_by;
}

void World::ignore_collisions(ClassId owner, ClassId other) { parts_->handlers.ignore(owner, other); }
std::vector<World::CollisionRule> World::collision_rules(ClassId owner) const {
  std::vector<CollisionRule> rules;
  parts_->handlers.for_each_of(owner, [&](ClassId other, NameId method, bool ignored) {
    rules.push_back({other, method == kNoName ? std::string_view() : parts_->names.text(method), ignored});
  });
  return rules;
}
void World::set_impact_timing(bool at_impact) { parts_->at_impact = at_impact; }

void World::begin_call() { parts_->dynamics->begin_call(physics_bound_); }

void World::set_gravity(const Vector3& gravity) { parts_->dynamics->set_gravity(gravity); }
const Vector3& World::gravity() const { return parts_->dynamics->gravity(); }

Mechanics& World::mechanics() { return *parts_->dynamics; }
const Mechanics& World::mechanics() const { return *parts_->dynamics; }

void World::flatten() {
  if (bodies_->flat()) return;
  const Mechanics& before = *parts_->dynamics;
  if (bodies_->rigid() != 0 || before.joint_count() != 0 || before.census().springs != 0)
    throw Error(ErrorCode::Argument,
                "the world cannot become flat: it has bodies with physics, joints or springs already; make it flat "
                "first (its controller a PlanarControl, or breve_world_config.dimension = 2)");
#ifdef BREVE_WITHOUT_PLANAR
  throw Error(ErrorCode::Argument, "flat worlds are not a part of this breve: it was built with BREVE_WITH_PLANAR=OFF");
#else
  auto flat = make_in<Planar>(memory_, memory_, *bodies_);
  flat->take_settings(before);
  bodies_->flatten();
  parts_->dynamics = std::move(flat);
#endif
}

void World::queue_input(InputEvent event) {
  parts_->input.push_back(std::move(event));
  parts_->effects.turn_on(EffectId::Input, clock_.iteration, {});
}

const Effects& World::effects() const { return parts_->effects; }

StageScope World::work(EffectId id, ObjectId asked_by, std::uint64_t items) {
  Effect& effect = parts_->effects[id];
  parts_->effects.turn_on(id, clock_.iteration, asked_by);
  ++effect.calls;
  effect.items += items;
  return {effect, observer_};
}

StageScope World::asked_by_host(EffectId id) {
  Effect& effect = parts_->effects[id];
  parts_->effects.turn_on(id, clock_.iteration, {});
  ++effect.calls;
  ++effect.items;
  return {effect, nullptr};
}

}  // namespace breve
