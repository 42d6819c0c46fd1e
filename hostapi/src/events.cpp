// What happened in an iteration, as lists for the host, and as calls of its listener.
#include "physical.hpp"

using namespace breve::host;
using breve::BodyIndex;
using breve::Events;
using breve::ObjectId;

namespace {

static_assert(int{BREVE_EVENT_CONTACT} == int{Events::kContacts} && int{BREVE_EVENT_LIFE} == int{Events::kLives} &&
              int{BREVE_EVENT_ANNOUNCEMENT} == int{Events::kAnnouncements} &&
              int{BREVE_EVENT_SLEEP} == int{Events::kSleep});

/// Of one that is perhaps gone: its ticket was kept.
breve_object handle_of_gone(const breve_world& world, ObjectId id, std::uint32_t ticket) {
  const std::uint64_t generation = (ticket - 1 + std::uint64_t{world.first_generation}) % kGenerations + 1;
  return {id.index, static_cast<std::uint32_t>(generation)};
}

breve_contact contact_of(const breve_world& world, const breve::ContactEvent& event) {
  breve_contact to{};
  to.phase = static_cast<std::uint32_t>(event.phase);
  to.a = handle_of_gone(world, event.a, event.ticket_a);
  to.b = handle_of_gone(world, event.b, event.ticket_b);
  copy_to(to.point, event.point);
  copy_to(to.normal, event.normal);
  to.distance = event.distance;
  copy_to(to.impulse, event.impulse);
  return to;
}

breve_life life_of(const breve_world& world, const breve::LifeEvent& event) {
  return {handle_of_gone(world, event.object, event.ticket), world.program->cls(event.cls).name.c_str(), event.born};
}

breve_announcement announcement_of(const breve_world& world, const breve::AnnouncementEvent& event) {
  return {handle_of_gone(world, event.announcer, event.ticket), event.time, event.message.c_str()};
}

breve_nap nap_of(const breve_world& world, const breve::SleepEvent& event) {
  return {handle_of_gone(world, event.object, event.ticket), event.asleep};
}

/// A list of the world's events, or an empty one.
template <class Event, class Out, class Convert>
void read_events(const breve_world& world, std::pmr::vector<Event> Events::*list, Out* out, std::size_t capacity,
                 std::size_t* count, const char* what, Convert convert) {
  const Events* events = std::as_const(*world.world).gathered();
  if (events) {
    copy_list(events->*list, out, capacity, count, what, convert);
    return;
  }
  if (capacity != 0) need(out, what);
  need(count, "count");
  *count = 0;
}

}  // namespace

breve_status breve_world_set_events(breve_world* world, uint32_t kinds) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if ((kinds & ~std::uint32_t{Events::kAll}) != 0)
      fail(BREVE_ERROR_ARGUMENT, "kinds is " + std::to_string(kinds) + ", which has bits of no breve_event");
    if (kinds != 0 || world->world->gathered()) world->world->events().want(kinds);
  });
}

uint32_t breve_world_events(const breve_world* world) {
  if (!world) return 0;
  const Events* events = std::as_const(*world->world).gathered();
  return events ? events->wanted() : 0;
}

breve_status breve_world_watch_contacts(breve_world* world, const char* class_name, bool on) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const auto& watched = class_named(*world, class_name);
    for (const auto& cls : world->program->classes())
      if (cls->derives_from(watched)) world->world->events().watch(cls->id, on);
  });
}

breve_status breve_object_watch_contacts(breve_world* world, breve_object object, bool on) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    live_body(*world, object);
    world->world->events().watch(live_id(*world, object), on);
  });
}

breve_status breve_world_contacts(const breve_world* world, breve_contact* contacts, size_t capacity, size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    read_events(*world, &Events::contacts, contacts, capacity, count, "contacts",
                [&](const breve::ContactEvent& event) { return contact_of(*world, event); });
  });
}

breve_status breve_world_lives(const breve_world* world, breve_life* lives, size_t capacity, size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    read_events(*world, &Events::lives, lives, capacity, count, "lives",
                [&](const breve::LifeEvent& event) { return life_of(*world, event); });
  });
}

breve_status breve_world_announcements(const breve_world* world, breve_announcement* announcements, size_t capacity,
                                       size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    read_events(*world, &Events::announcements, announcements, capacity, count, "announcements",
                [&](const breve::AnnouncementEvent& event) { return announcement_of(*world, event); });
  });
}

breve_status breve_world_naps(const breve_world* world, breve_nap* naps, size_t capacity, size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    read_events(*world, &Events::sleeps, naps, capacity, count, "naps",
                [&](const breve::SleepEvent& event) { return nap_of(*world, event); });
  });
}

breve_status breve_object_contacts_watched(const breve_world* world, breve_object object, bool* watched) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(watched, "watched");
    live_body(*world, object);
    const Events* events = std::as_const(*world->world).gathered();
    *watched = events && events->watched(live_id(*world, object), live_instance(*world, object).cls->id);
  });
}

breve_status breve_object_contact_force(const breve_world* world, breve_object object, breve_object other,
                                        double force[3]) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(force, "force");
    const BodyIndex body = live_body(*world, object);
    const BodyIndex with = is_null(other) ? breve::kNoBody : live_body(*world, other);
    if (with == body) fail(BREVE_ERROR_ARGUMENT, "an object has no contact with itself");
    copy_to(force, std::as_const(*world->world).mechanics().contact_force(body, with));
  });
}

// --- the listener -----------------------------------------------------------------------------------------------------

std::uint32_t Listener::kinds() const {
  std::uint32_t kinds = 0;
  if (functions_.contact) kinds |= Events::kContacts;
  if (functions_.life) kinds |= Events::kLives;
  if (functions_.announcement) kinds |= Events::kAnnouncements;
  if (functions_.nap) kinds |= Events::kSleep;
  return kinds;
}

template <class Event>
void Listener::call(void (*function)(void*, breve_world*, const Event*), const Event& event) {
  if (!function) return;
  const CallbackScope callback(world_);
  function(functions_.user, &world_, &event);
}

void Listener::contact(const breve::ContactEvent& event) { call(functions_.contact, contact_of(world_, event)); }
void Listener::life(const breve::LifeEvent& event) { call(functions_.life, life_of(world_, event)); }
void Listener::announcement(const breve::AnnouncementEvent& event) {
  call(functions_.announcement, announcement_of(world_, event));
}
void Listener::sleep(const breve::SleepEvent& event) { call(functions_.nap, nap_of(world_, event)); }
void Listener::intervention(const breve::Intervention& event) { call(functions_.intervention, to_host(world_, event)); }

breve_status breve_world_set_listener(breve_world* world, const breve_listener* listener) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need_idle(*world, "breve_world_set_listener");
    const breve_listener functions = read_config(listener, breve_listener_default(), "breve_listener");
    breve::World& inner = *world->world;
    if (!listener && !inner.gathered()) return;
    Events& events = inner.events();
    events.listen(nullptr, 0, 0);
    world->listener.reset();
    if (!listener) return;
    world->listener.emplace(*world, functions);
    events.listen(&*world->listener, world->listener->kinds(), inner.mechanics().interventions().size());
  });
}

breve_status breve_world_listener(const breve_world* world, breve_listener* listener) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const breve_listener functions = world->listener ? world->listener->functions() : breve_listener_default();
    write_struct(listener, functions, "breve_listener");
  });
}
