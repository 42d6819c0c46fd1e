// Events of an iteration: the lists, and how the world fills them.
#include "runtime/world/events.hpp"

#include <algorithm>

#include "runtime/world/parts.hpp"

namespace breve {

Events::Events(std::pmr::memory_resource* memory)
    : contacts(memory),
      lives(memory),
      sleeps(memory),
      announcements(memory),
      touching(memory),
      asleep(memory),
      objects_(memory),
      classes_(memory) {}

void Events::want(std::uint32_t kinds) {
  wanted_ = kinds;
  drop_unwanted();
}

void Events::drop_unwanted() {
  if (!wants(kContacts)) contacts.clear(), touching.clear(), told_.contacts = 0;
  if (!wants(kLives)) lives.clear(), told_.lives = 0;
  if (!wants(kAnnouncements)) announcements.clear(), told_.announcements = 0;
  if (!wants(kSleep)) sleeps.clear(), asleep.clear(), told_.sleeps = 0;
}

void Events::listen(EventListener* listener, std::uint32_t kinds, std::size_t interventions) {
  listener_ = listener;
  heard_ = listener ? kinds : 0;
  drop_unwanted();
  told_ = {contacts.size(), lives.size(), sleeps.size(), announcements.size(), interventions};
}

void Events::watch(ObjectId object, bool on) {
  const std::pair<std::uint32_t, std::uint32_t> key(object.index, object.generation);
  if (on)
    objects_.insert(key);
  else
    objects_.erase(key);
}

void Events::watch(ClassId cls, bool on) {
  if (on)
    classes_.insert(cls);
  else
    classes_.erase(cls);
}

bool Events::watched(ObjectId object, ClassId cls) const {
  return classes_.contains(cls) || objects_.contains({object.index, object.generation});
}

std::pmr::set<ClassId> Events::reclassed(std::span<const ClassChange> classes) const {
  std::pmr::set<ClassId> now(classes_.get_allocator());
  for (const ClassId cls : classes_)
    if (cls < classes.size() && classes[cls].to != kNoClass) now.insert(classes[cls].to);
  return now;
}

void Events::begin() {
  const auto keep_untold = [this](auto& list, std::size_t told) {
    const std::size_t known = listener_ ? std::min(told, list.size()) : list.size();
    list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(known));
  };
  contacts.clear();
  sleeps.clear();
  keep_untold(lives, told_.lives);
  keep_untold(announcements, told_.announcements);
  told_ = {};
}

void Events::clear() {
  contacts.clear();
  lives.clear();
  sleeps.clear();
  announcements.clear();
  told_ = {};
}

bool Events::untold(std::size_t interventions) const {
  return listener_ &&
         (told_.lives < lives.size() || told_.announcements < announcements.size() ||
          told_.interventions < interventions || told_.contacts < contacts.size() || told_.sleeps < sleeps.size());
}

void Events::tell(const std::function<std::span<const Intervention>()>& interventions) {
  // A callback may make events, which moves the lists, or set that none are wanted, which empties them.
  const auto each = [this](const auto& list, std::size_t& told, const auto& call) {
    for (const std::size_t end = list.size(); listener_ && told < std::min(end, list.size());) {
      const auto& event = list[told++];
      call(event);
    }
  };
  each(lives, told_.lives, [this](LifeEvent event) { listener_->life(event); });
  each(announcements, told_.announcements, [this](const AnnouncementEvent& event) {
    listener_->announcement({event.announcer, event.ticket, event.time,
                             std::pmr::string(event.message, announcements.get_allocator().resource())});
  });
  each(contacts, told_.contacts, [this](ContactEvent event) { listener_->contact(event); });
  each(sleeps, told_.sleeps, [this](SleepEvent event) { listener_->sleep(event); });
  for (const std::size_t end = interventions().size();
       listener_ && told_.interventions < std::min(end, interventions().size());) {
    const Intervention event = interventions()[told_.interventions++];
    listener_->intervention(event);
  }
}

std::size_t Events::bytes() const {
  constexpr std::size_t kNode = 4 * sizeof(void*);  // of a tree's entry, beside what it holds
  return sizeof(Events) + contacts.capacity() * sizeof(ContactEvent) + lives.capacity() * sizeof(LifeEvent) +
         sleeps.capacity() * sizeof(SleepEvent) + announcements.capacity() * sizeof(AnnouncementEvent) +
         touching.size() * (sizeof(Pair) + sizeof(ContactEvent) + kNode) + asleep.size() * (sizeof(ObjectId) + kNode) +
         objects_.size() * (sizeof(ObjectId) + kNode) + classes_.size() * (sizeof(ClassId) + kNode);
}

// --- what the world writes down -------------------------------------------------------------------------------------

Events& World::events() {
  if (!events_) events_ = make_in<Events>(memory_, memory_);
  return *events_;
}

/// Two solids touch up to a gap that solvers leave where bodies rest, and touch until it is some more: what trembles
/// does not begin and end all the time.
bool World::Parts::touches_now(BodyIndex a, BodyIndex b, bool before, Contact& contact) const {
  constexpr double kBegins = 1e-4, kEnds = 1e-3;  // of the smaller one's radius
  const Bodies& bodies = *world->bodies_;
  const Shape &of_a = *bodies.collision_shape(a), &of_b = *bodies.collision_shape(b);
  const double size = std::min(of_a.bounding_radius(), of_b.bounding_radius());
  Pose other = pose_of(bodies, b);
  other.location += space.image(bodies.location(a), other.location);
  return closest_within(of_a, pose_of(bodies, a), of_b, other, (before ? kEnds : kBegins) * size, contact);
}

/// All contacts of one body that is watched, into `now`.
void World::Parts::find_contacts(BodyIndex body, std::pmr::map<Events::Pair, ContactEvent>& now) {
  const Bodies& bodies = *world->bodies_;
  Eigen::AlignedBox3d box = bodies.bounds(body);
  if (!box.min().allFinite() || !box.max().allFinite()) return;
  const Vector3 slack = Vector3::Constant(1e-3 * bodies.collision_shape(body)->bounding_radius());
  box.min() -= slack;
  box.max() += slack;
  for (const BodyIndex other : queries.boxes(world->scene(), box)) {
    if (other == body || !bodies.filter(body).meets(bodies.filter(other))) continue;
    const bool first = serial(body) < serial(other);
    const BodyIndex a = first ? body : other, b = first ? other : body;
    const ObjectId one = bodies.owner(a), two = bodies.owner(b);
    if (denied(one, two)) continue;
    const Events::Pair key(serial(a), serial(b));
    if (now.contains(key)) continue;
    Contact contact;
    const bool before = world->events_->touching.contains(key);
    if (!touches_now(a, b, before, contact)) continue;
    now.emplace(key, ContactEvent{before ? ContactEvent::Phase::Persist : ContactEvent::Phase::Begin, one, two,
                                  objects.ticket(one), objects.ticket(two), contact.point, contact.normal,
                                  contact.distance, Vector3::Zero()});
  }
}

/// Impacts of the iteration count to their pair, which touched in it even if it is apart by now.
void World::Parts::add_impulses(std::pmr::map<Events::Pair, ContactEvent>& now) {
  for (const Impact& impact : dynamics->impacts()) {
    if (!objects.alive(impact.a) || !objects.alive(impact.b)) continue;
    const ObjectTable::Slot &one = objects.at(impact.a), &two = objects.at(impact.b);
    if (!world->events_->watched(impact.a, one.cls) && !world->events_->watched(impact.b, two.cls)) continue;
    const bool first = one.serial < two.serial;
    const ObjectId a = first ? impact.a : impact.b, b = first ? impact.b : impact.a;
    const double sign = first ? 1 : -1;
    const Events::Pair key(std::min(one.serial, two.serial), std::max(one.serial, two.serial));
    const bool before = world->events_->touching.contains(key);
    const ContactEvent event{before ? ContactEvent::Phase::Persist : ContactEvent::Phase::Begin,
                             a,
                             b,
                             objects.ticket(a),
                             objects.ticket(b),
                             impact.point,
                             sign * impact.normal,
                             0,
                             Vector3::Zero()};
    now.try_emplace(key, event).first->second.impulse += sign * impact.impulse;
  }
}

void World::Parts::gather_contacts() {
  Events& events = *world->events_;
  std::pmr::map<Events::Pair, ContactEvent> now(events.touching.get_allocator());
  if (events.any_class_watched()) {
    for (const ObjectId id : objects.order())
      if (objects.alive(id) && objects.at(id).body != kNoBody && events.watched(id, objects.at(id).cls))
        find_contacts(objects.at(id).body, now);
  } else {
    for (const auto& [index, generation] : events.watched_objects()) {
      const ObjectId id{index, generation};
      if (objects.alive(id) && objects.at(id).body != kNoBody) find_contacts(objects.at(id).body, now);
    }
  }
  add_impulses(now);
  // Both are sorted by the same key: what has ended stands among the others, in order.
  auto old = events.touching.begin();
  const auto ended = [&](auto at) {
    ContactEvent event = at->second;
    event.phase = ContactEvent::Phase::End;
    event.impulse.setZero();
    events.contacts.push_back(event);
  };
  for (const auto& [key, event] : now) {
    for (; old != events.touching.end() && old->first < key; ++old) ended(old);
    if (old != events.touching.end() && old->first == key) ++old;
    events.contacts.push_back(event);
  }
  for (; old != events.touching.end(); ++old) ended(old);
  events.touching.swap(now);
}

void World::Parts::gather_sleep() {
  Events& events = *world->events_;
  const Bodies& bodies = *world->bodies_;
  std::pmr::map<std::uint64_t, ObjectId> now(events.asleep.get_allocator());
  if (dynamics->sleeping())
    for (const BodyIndex body : bodies.rigid_bodies())
      if (dynamics->asleep(body)) now.emplace(serial(body), bodies.owner(body));
  for (const auto& [slot, object] : events.asleep)
    if (!now.contains(slot) && objects.alive(object)) events.sleeps.push_back({object, objects.ticket(object), false});
  for (const auto& [slot, object] : now)
    if (!events.asleep.contains(slot)) events.sleeps.push_back({object, objects.ticket(object), true});
  events.asleep.swap(now);
}

void World::gather_events() {
  if (!events_ || !events_->wants_any()) return;
  Effect& effect = parts_->effects[EffectId::Events];
  parts_->effects.turn_on(EffectId::Events, clock_.iteration, {});
  const StageScope stage(effect, observer_);
  if (events_->wants(Events::kContacts) && events_->any_watched()) parts_->gather_contacts();
  if (events_->wants(Events::kSleep)) parts_->gather_sleep();
  ++effect.calls;
  effect.items +=
      events_->contacts.size() + events_->lives.size() + events_->sleeps.size() + events_->announcements.size();
  effect.bytes = events_->bytes();
}

void World::tell_events() {
  if (!events_->untold(parts_->dynamics->interventions().size())) return;
  parts_->effects.turn_on(EffectId::Events, clock_.iteration, {});
  const StageScope stage(parts_->effects[EffectId::Events], observer_);
  events_->tell([this] { return parts_->dynamics->interventions(); });
}

/// After a restore: what touches or sleeps now began before.
void World::look_again() {
  if (!events_) return;
  events_->clear();
  events_->touching.clear();
  events_->asleep.clear();
  if (events_->wants(Events::kContacts) && events_->any_watched()) parts_->gather_contacts();
  if (events_->wants(Events::kSleep)) parts_->gather_sleep();
  events_->clear();
}

}  // namespace breve
