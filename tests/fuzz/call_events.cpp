// Calls of what says which events are gathered and of their lists; of logs, debug drawings and plugins.
#include <cmath>

#include "breve/sound.h"
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

breve_status contacts_watched(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  Out<bool> watched(c);
  return watched.after(breve_object_contacts_watched(world, object, watched.to()));
}
breve_status contact_force(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  const breve_object other = c.chance(50) ? breve_object{} : c.object_or_null(world, "Real");
  Out<double[3]> force(c);
  const breve_status status =
      force.after(breve_object_contact_force(world, object, other, force.to() ? *force.to() : nullptr));
  if (force) require(std::isfinite((*force)[1]), "a contact carries a force beyond numbers");
  return status;
}
breve_status set_listener(Caller& c) {
  breve_world* world = c.world();
  breve_listener listener = c.listener();
  if (c.chance(10)) listener.struct_size = c.struct_size(sizeof listener);
  if (c.chance(30)) listener.contact = nullptr, listener.life = nullptr;
  return breve_world_set_listener(world, c.chance(20) ? nullptr : &listener);
}
breve_status listener(Caller& c) {
  const breve_world* world = c.world();
  Out<breve_listener> filled(c);
  filled.set_size(c.struct_size(sizeof(breve_listener)));
  return filled.after(breve_world_listener(world, filled.to()));
}

// --- logs and lines --------------------------------------------------------------------------------------------------

void append(void* sink, const char* bytes, std::size_t size) { static_cast<std::string*>(sink)->append(bytes, size); }
void discard(void* sink, const char* bytes, std::size_t size) {
  const std::string copy(bytes, size);
  require(sink == nullptr && copy.size() == size, "a log is written to another sink");
}

/// Recordings end in their own time, or with their world.
breve_status record_start(Caller& c) {
  breve_world* world = c.world();
  const bool null = c.chance(5);
  if (null || breve_world_recording(world)) c.expect_refusal();
  return breve_world_record_start(world, null ? nullptr : discard, nullptr);
}
breve_status record_stop(Caller& c) { return breve_world_record_stop(c.world()); }
breve_status recording(Caller& c) {
  const breve_world* world = c.world();
  require(world || !breve_world_recording(nullptr), "no world is recorded");
  (void)breve_world_recording(world);
  c.accept_null();
  return BREVE_OK;
}
breve_status record_input(Caller& c) {
  char bytes[4] = {1, 2, 3, 4};
  return breve_world_record_input(c.world(), bytes, c.word() % 5);
}

/// A log of two steps, perhaps damaged, replayed.
breve_status replay(Caller& c) {
  breve_world* world = c.world();
  std::string log;
  if (world && c.chance(70) && breve_world_record_start(world, append, &log) == BREVE_OK) {
    (void)breve_world_step(world);
    if (c.chance(50)) (void)breve_world_queue_key(world, "a", true);
    (void)breve_world_step(world);
    (void)breve_world_record_stop(world);
  }
  if (!log.empty() && c.chance(40)) log[c.word() % log.size()] ^= 4;
  if (!log.empty() && c.chance(20)) log.resize(c.word() % log.size());
  Out<breve_replay> result(c);
  const auto after = [](void*, breve_world* running) { return breve_world_time(running) >= 0; };
  if (breve_world_recording(world)) c.expect_refusal();
  const breve_status status = breve_world_replay(world, log.data(), log.size(), after, nullptr, result.to());
  return result.after(status);
}

breve_status debug_draw(Caller& c) {
  const breve_world* world = c.world();
  breve_debug_draw draw = breve_debug_draw_default();
  if (c.chance(10)) draw.struct_size = c.struct_size(sizeof draw);
  draw.parts = c.chance(90) ? c.word() % 256 : c.word();
  draw.segments = c.chance(90) ? 3 + c.word() % 8 : c.word();
  draw.impulse_scale = c.number();
  draw.line = [](void*, const double*, const double*, const double* rgba) { require(rgba[3] >= 0, "no colour"); };
  if (c.chance(50)) draw.point = [](void*, const double*, const double*) {};
  draw.text = [](void*, const double*, const char* text, const double*) { read_text(text); };
  if (draw.struct_size != sizeof draw) return breve_world_debug_draw(world, &draw);
  if (draw.parts > 255 || draw.segments < 3 || draw.segments > 256 || !std::isfinite(draw.impulse_scale))
    c.expect_refusal();
  return breve_world_debug_draw(world, &draw);
}

breve_status sound(Caller& c) {
  const breve_world* world = c.world();
  const double time = c.number(), rate = c.chance(80) ? 44100 : c.number();
  float samples[16];
  if (!std::isfinite(time) || !(rate >= 1000 && rate <= 1e6)) c.expect_refusal();
  return breve_world_sound(world, time, rate, samples, c.word() % 9);
}

breve_status network_open(Caller& c) {
  const bool null = c.chance(20);
  breve_network_config config = breve_network_config_default();
  if (!null) {
    config.timeout = c.chance(80) ? 1 : c.number();
    config.most_bytes = c.word() % 1000;
    if (c.chance(20)) config.address = c.chance(50) ? "::1" : "nowhere";
    if (!(config.timeout > 0 && config.timeout <= 3600) || config.most_bytes == 0 ||
        (config.address && config.address[0] == 'n'))
      c.expect_refusal();
  }
  Out<breve_network> network(c);
  const breve_status status = network.after(breve_network_open(null ? nullptr : &config, network.to()));
  if (network) require(breve_network_release(network.to()) == BREVE_OK, "a network is not released");
  return status;
}
breve_status network_release(Caller&) { return breve_network_release(nullptr); }

breve_status plugin_open(Caller& c) {
  Out<breve_plugin> plugin(c);
  // A library that every Linux has, with a function that is there, and is not called.
  const bool there = c.chance(70);
  const breve_status status =
      plugin.after(breve_plugin_open(c.text_or_null(there ? "libm.so.6" : "/nowhere/plugin.so"),
                                     c.text_or_null(there ? "cos" : "start"), plugin.to(), nullptr, nullptr));
  if (plugin) plugin->close(plugin->library);
  return status;
}

constexpr Function kFunctions[] = {
    {"breve_world_record_start", record_start, kBusy | kUnsupported},
    {"breve_world_record_stop", record_stop, kBusy},
    {"breve_world_recording", recording, kPlain},
    {"breve_world_record_input", record_input, kImage},
    {"breve_world_replay", replay, kBusy | kImage},
    {"breve_world_debug_draw", debug_draw, kScriptError},
    {"breve_world_sound", sound},
    {"breve_network_open", network_open, kUnsupported},
    {"breve_network_release", network_release},
    {"breve_plugin_open", plugin_open, kFile | kNotFound | kUnsupported},
    {"breve_world_set_events", set_events, 0, 2},
    {"breve_world_events", events, kPlain},
    {"breve_world_watch_contacts", watch_class, kNotFound},
    {"breve_object_watch_contacts", watch_object, kBody},
    {"breve_world_contacts", contacts},
    {"breve_world_lives", lives},
    {"breve_world_announcements", announcements},
    {"breve_world_naps", naps},
    {"breve_object_contacts_watched", contacts_watched, kBody},
    {"breve_object_contact_force", contact_force, kBody},
    {"breve_world_set_listener", set_listener, kBusy},
    {"breve_world_listener", listener},
};

}  // namespace call_events

std::span<const Function> event_functions() { return call_events::kFunctions; }

}  // namespace breve::fuzz
