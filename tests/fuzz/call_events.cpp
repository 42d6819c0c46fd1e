// Calls of what says which events are gathered, and of their lists.
#include "call_functions.hpp"

namespace breve::fuzz {

namespace call_events {

breve_status set_events(Caller& c) {
  breve_world* world = c.world();
  const std::uint32_t kinds = c.chance(90) ? c.word() % 16 : c.word();
  if (kinds > 15) c.expect_refusal();
  return breve_world_set_events(world, kinds);
}
breve_status events(Caller& c) {
  const breve_world* world = c.world();
  const std::uint32_t kinds = breve_world_events(world);
  require(kinds < 16 && (world || kinds == 0), "a world gathers events of no kind");
  c.accept_null();
  return BREVE_OK;
}
breve_status watch_class(Caller& c) {
  breve_world* world = c.world();
  const char* name = c.class_name();
  return breve_world_watch_contacts(world, name, c.chance(80));
}
breve_status watch_object(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  return breve_object_watch_contacts(world, object, c.chance(80));
}

/// A list of events, of which each is looked at.
template <class Event, auto kRead, class Look>
breve_status read(Caller& c, Look look) {
  const breve_world* world = c.world();
  Room<Event> events(c, c.capacity());
  Out<std::size_t> count(c);
  const breve_status status = count.after(kRead(world, events.to(), events.capacity(), count.to()));
  events.after(status, count ? *count : 0);
  for (const Event& event : events.written()) look(event);
  return status;
}

breve_status contacts(Caller& c) {
  return read<breve_contact, breve_world_contacts>(c, [&](const breve_contact& contact) {
    require(contact.phase <= BREVE_PHASE_END, "a contact has no phase");
    c.keep(contact.a), c.keep(contact.b);
  });
}
breve_status lives(Caller& c) {
  return read<breve_life, breve_world_lives>(c, [&](const breve_life& life) {
    read_text(life.class_name);
    c.keep(life.object);
  });
}
breve_status announcements(Caller& c) {
  return read<breve_announcement, breve_world_announcements>(c, [&](const breve_announcement& announcement) {
    read_text(announcement.message);
    c.keep(announcement.announcer);
  });
}
breve_status naps(Caller& c) {
  return read<breve_nap, breve_world_naps>(c, [&](const breve_nap& nap) { c.keep(nap.object); });
}

constexpr Function kFunctions[] = {
    {"breve_world_set_events", set_events, 0, 2},
    {"breve_world_events", events, kPlain},
    {"breve_world_watch_contacts", watch_class, kNotFound},
    {"breve_object_watch_contacts", watch_object, kBody},
    {"breve_world_contacts", contacts},
    {"breve_world_lives", lives},
    {"breve_world_announcements", announcements},
    {"breve_world_naps", naps},
};

}  // namespace call_events

std::span<const Function> event_functions() { return call_events::kFunctions; }

}  // namespace breve::fuzz
