// Calls of worlds: making and ending them, time, input, snapshots, what they cost, changes of what runs.
#include <cmath>
#include <cstddef>

#include "call_functions.hpp"

namespace breve::fuzz {

namespace call_worlds {

constexpr std::size_t kMostWorlds = 4;

// --- making and ending -----------------------------------------------------------------------------------------------

/// Limits that let every call end soon, and now and then something that no world can have.
breve_world_config draw_config(Caller& c) {
  static constexpr std::size_t kMemory[] = {64u << 20, 64u << 20, 64u << 20, 8u << 20, 2u << 20, 100'000, 1};
  breve_world_config config = breve_world_config_default();
  config.seed = c.choose().below(100);
  config.memory_limit = c.choose().one_of(kMemory);
  config.budget = c.chance(80) ? 20'000 : 200;
  config.call_budget = c.chance(50) ? 2'000 : 0;
  config.physics_budget = 100'000;
  config.depth_limit = c.chance(40) ? 40 : 0;
  config.advance_limit = static_cast<std::uint32_t>(1 + c.choose().below(5));
  config.nesting_limit = c.chance(30) ? static_cast<std::uint32_t>(c.choose().below(6)) : 0;
  config.strict = c.chance(10);
  config.verbose = c.chance(20);
  config.coarse_random = c.chance(20);
  config.profile = c.chance(20);
  if (c.chance(40)) config.trace = c.trace(), config.trace_user = &c;
  config.user = &c;
  config.accuracy = "fast";
  return config;
}

/// One field of a configuration that a world may refuse.
void draw_field(Caller& c, breve_world_config& config) {
  static constexpr breve_setting kSettings[] = {{"number", "7"}, {"nothing", "1"}, {nullptr, "1"}, {"number", nullptr}};
  static constexpr std::size_t kSizes[] = {0, 1, offsetof(breve_world_config, settings), sizeof config + 8, SIZE_MAX};
  static constexpr double kSteps[] = {0.01, 0.5, 1, -1, INFINITY, NAN};
  switch (c.choose().below(9)) {
    case 0: config.struct_size = c.choose().one_of(kSizes); break;
    case 1: config.iteration_step = c.choose().one_of(kSteps); break;
    case 2: config.integration_step = c.choose().one_of(kSteps); break;
    case 3: config.accuracy = c.chance(50) ? nullptr : "nothing"; break;
    case 4: config.length_unit = c.number(); break;
    case 5: config.dimension = static_cast<std::uint32_t>(c.choose().below(5)); break;
    case 6: config.reserved[1] = true, c.expect_refusal(); break;
    case 7:
      config.settings = c.chance(80) ? kSettings : nullptr;
      config.setting_count = c.choose().below(5);
      break;
    default: config.patience = c.chance(50) ? 1e-9 : c.number(); break;
  }
}

breve_status world_create(Caller& c) {
  static constexpr const char* kArguments[] = {"program", "one", "two"};
  breve_runtime* runtime = c.runtime();
  const breve_program* program = c.program();
  breve_world_config config = draw_config(c);
  if (c.chance(70)) config.arguments = kArguments, config.argument_count = c.choose().below(4);
  const bool spoiled = c.chance(25);
  if (spoiled) draw_field(c, config);
  if (c.worlds().size() >= kMostWorlds) config.struct_size = 1, c.expect_refusal();
  const bool defaults = config.struct_size == sizeof config && !spoiled && c.chance(3);
  Out<breve_world*> made(c);
  const breve_status status = made.after(breve_world_create(runtime, program, defaults ? nullptr : &config, made.to()));
  if (made && !defaults) c.keep(*made);
  // Without limits it could run for ever.
  if (made && defaults) require(breve_world_destroy(*made) == BREVE_OK, "a new world cannot be destroyed");
  return status;
}

breve_status world_destroy(Caller& c) {
  if (c.worlds().size() < 2 || c.chance(60)) return breve_world_destroy(nullptr);
  breve_world* world = c.choose().one_of(c.worlds());
  const breve_status status = breve_world_destroy(world);
  if (status == BREVE_OK) std::erase(c.worlds(), world);
  return status;
}

/// The user data of worlds and objects.
const int mark = 0;
void* const kept = const_cast<int*>(&mark);

breve_status world_user(Caller& c) {
  const breve_world* world = c.world();
  const void* user = breve_world_user(world);
  require(user == (world ? &c : nullptr) || (world && user == kept) || (!user && c.called_back()),
          "another user of a world");
  return BREVE_OK;
}
breve_status world_last_error(Caller& c) {
  const breve_world* world = c.world();
  const breve_error* error = breve_world_last_error(world);
  require(world || !error, "an error of no world");
  if (error) read_text(error->text);
  return BREVE_OK;
}

// --- time ------------------------------------------------------------------------------------------------------------

breve_status world_step(Caller& c) { return breve_world_step(c.world()); }
breve_status world_advance(Caller& c) {
  static constexpr double kSeconds[] = {0, 0.1, 0.3, 1e300, -1, INFINITY, NAN};
  breve_world* world = c.world();
  const double seconds = c.choose().one_of(kSeconds);
  if (!(seconds >= 0 && std::isfinite(seconds))) c.expect_refusal();
  Out<double> fraction(c, true);
  const breve_status status = fraction.after(breve_world_advance(world, seconds, fraction.to()));
  if (fraction) require(*fraction >= 0 && *fraction < 1, "a fraction is not in [0, 1)");
  return status;
}
breve_status world_time(Caller& c) {
  const breve_world* world = c.world();
  const double time = breve_world_time(world);
  require(world ? time >= 0 : time == 0, "a time is wrong");
  return BREVE_OK;
}
breve_status world_iteration(Caller& c) {
  const breve_world* world = c.world();
  const std::uint64_t iteration = breve_world_iteration(world);
  require(world || iteration == 0, "iterations of no world");
  return BREVE_OK;
}
breve_status world_iteration_step(Caller& c) {
  const breve_world* world = c.world();
  const double step = breve_world_iteration_step(world);
  require(world ? step > 0 : step == 0, "a step is wrong");
  return BREVE_OK;
}
breve_status world_ended(Caller& c) {
  const breve_world* world = c.world();
  const bool ended = breve_world_ended(world);
  require(world || !ended, "no world has ended");
  return BREVE_OK;
}
breve_status world_paused(Caller& c) {
  const breve_world* world = c.world();
  const bool paused = breve_world_paused(world);
  require(world || !paused, "no world is paused");
  return BREVE_OK;
}
breve_status world_set_paused(Caller& c) {
  breve_world* world = c.world();
  const bool paused = c.chance(30);
  const breve_status status = breve_world_set_paused(world, paused);
  if (status == BREVE_OK) require(breve_world_paused(world) == paused, "a world is not paused as requested");
  return status;
}
breve_status world_seed(Caller& c) {
  const breve_world* world = c.world();
  const std::uint64_t seed = breve_world_seed(world);
  require(world || seed == 0, "a seed of no world");
  return BREVE_OK;
}
breve_status world_random(Caller& c) {
  breve_world* world = c.world();
  Out<double> number(c);
  const breve_status status = number.after(breve_world_draw_random(world, number.to()));
  if (number) require(*number >= 0 && *number < 1, "a random number is not in [0, 1)");
  return status;
}
breve_status world_charge(Caller& c) {
  breve_world* world = c.world();
  return breve_world_charge(world, c.choose().below(100));
}
breve_status world_has_budget(Caller& c) {
  breve_world_has_budget(c.world());
  return BREVE_OK;
}
breve_status world_print(Caller& c) {
  breve_world* world = c.world();
  const char* text = c.text_or_null("fuzz");
  return breve_world_print(world, text, text ? c.choose().below(5) : 1);
}
breve_status world_methods(Caller& c) {
  static constexpr const char* kNames[] = {"Control", "Mobile", "Chatter", "Nobody"};
  breve_world* world = c.world();
  Room<breve_method_info> methods(c, c.capacity());
  Out<std::size_t> count(c);
  const char* name = c.text_or_null(c.choose().one_of(kNames));
  const breve_status status =
      count.after(breve_world_methods(world, name, methods.to(), methods.capacity(), count.to()));
  methods.after(status, count ? *count : 0);
  for (const breve_method_info& method : methods.written()) {
    read_text(method.class_name), read_text(method.name);
    for (std::size_t i = 0; i < method.keyword_count; ++i) read_text(method.keywords[i]);
  }
  return status;
}
breve_status world_set_user(Caller& c) { return breve_world_set_user(c.world(), kept, nullptr); }
breve_status object_set_user(Caller& c) {
  breve_world* world = c.world();
  return breve_object_set_user(world, c.object(world), kept, nullptr);
}
breve_status object_user(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world);
  Out<void*> user(c);
  const breve_status status = user.after(breve_object_user(world, object, user.to()));
  if (user) require(*user == nullptr || *user == kept, "data of an object that nobody gave");
  return status;
}
breve_status world_set_state(Caller& c) {
  breve_world* world = c.world();
  breve_state state = breve_state_default();
  if (c.chance(20)) state.struct_size = c.struct_size(sizeof state);
  return breve_world_set_state(world, c.text_or_null("fuzz"), c.chance(50) ? &state : nullptr);
}
breve_status world_state(Caller& c) {
  breve_world* world = c.world();
  require(breve_world_state(world, c.text_or_null("fuzz")) == nullptr, "state of the host that has no data");
  return BREVE_OK;
}
breve_status world_memory(Caller& c) {
  breve_world* world = c.world();
  const std::size_t size = c.choose().below(1000);
  breve_world_release(world, breve_world_allocate(world, size), size);
  return BREVE_OK;
}
breve_status world_interrupt(Caller& c) {
  if (c.chance(30)) breve_world_interrupt(c.world());
  return BREVE_OK;
}

// --- input -----------------------------------------------------------------------------------------------------------

breve_status world_key(Caller& c) {
  static constexpr const char* kKeys[] = {"a", "a", "up", "", "ab", "\xc3\xa4", "\x01"};
  breve_world* world = c.world();
  const char* key = c.text_or_null(c.choose().one_of(kKeys));
  return breve_world_queue_key(world, key, c.chance(60));
}
breve_status world_click(Caller& c) {
  breve_world* world = c.world();
  return breve_world_queue_click(world, c.object_or_null(world));
}
breve_status world_menu_items(Caller& c) {
  breve_world* world = c.world();
  Room<breve_menu_item> items(c, c.capacity());
  Out<std::size_t> count(c);
  const breve_status status = count.after(breve_world_menu_items(world, items.to(), items.capacity(), count.to()));
  items.after(status, count ? *count : 0);
  for (const breve_menu_item& item : items.written()) {
    read_text(item.title), read_text(item.method);
    c.keep(item.item);
  }
  return status;
}
breve_status world_choose(Caller& c) {
  breve_world* world = c.world();
  return breve_world_queue_choice(world, c.object(world, "MenuItem"));
}

// --- snapshots -------------------------------------------------------------------------------------------------------

breve_status world_hash(Caller& c) {
  const breve_world* world = c.world();
  Out<std::uint64_t> hash(c);
  return hash.after(breve_world_hash(world, hash.to()));
}
breve_status world_snapshot(Caller& c) {
  static constexpr std::size_t kMostImages = 6;
  const breve_world* world = c.world();
  Out<std::size_t> size(c);
  breve_status status = size.after(breve_world_snapshot(world, nullptr, 0, size.to()));
  if (!size) return status;
  std::string image(c.chance(90) ? *size : *size / 2, '\0');
  Out<std::size_t> again(c);
  status = again.after(breve_world_snapshot(world, image.data(), image.size(), again.to()));
  if (!again || *again > image.size()) return status;
  if (c.images().size() < kMostImages)
    c.images().push_back(image);
  else
    c.images()[c.choose().below(kMostImages)] = image;
  return status;
}
breve_status world_restore(Caller& c) {
  breve_world* world = c.world();
  // A copy: a callback may take another image.
  std::string image = c.images().empty() ? "no image" : c.choose().one_of(c.images());
  if (c.chance(10)) image.resize(c.choose().below(image.size() + 1));
  const bool null = c.chance(3);
  if (null) c.expect_refusal();
  return breve_world_restore(world, null ? nullptr : image.data(), image.size());
}

// --- what it costs ---------------------------------------------------------------------------------------------------

breve_status world_effects(Caller& c) {
  const breve_world* world = c.world();
  Room<breve_effect> effects(c, c.capacity());
  Out<std::size_t> count(c);
  const breve_status status = count.after(breve_world_effects(world, effects.to(), effects.capacity(), count.to()));
  effects.after(status, count ? *count : 0);
  for (const breve_effect& effect : effects.written()) read_text(effect.name), read_text(effect.reason);
  return status;
}
breve_status world_stats(Caller& c) {
  const breve_world* world = c.world();
  Out<breve_stats> stats(c);
  stats.set_size(c.struct_size(sizeof(breve_stats)));
  return stats.after(breve_world_stats(world, stats.to()));
}
breve_status world_profile_start(Caller& c) {
  breve_world* world = c.world();
  const breve_trace_fn trace = c.chance(50) ? c.trace() : nullptr;
  return breve_world_profile_start(world, trace, &c);
}
breve_status world_profile_stop(Caller& c) { return breve_world_profile_stop(c.world()); }
breve_status world_profile_count(Caller& c) {
  breve_world* world = c.world();
  Out<std::size_t> count(c);
  return count.after(breve_world_profile_node_count(world, count.to()));
}
breve_status world_profile_node(Caller& c) {
  breve_world* world = c.world();
  std::size_t count = 0;
  const bool counted = breve_world_profile_node_count(world, &count) == BREVE_OK;
  const std::size_t index = c.chance(10) ? c.word() : c.choose().below(count + 1);
  if (counted && index >= count) c.expect_refusal();
  Out<breve_profile_node> node(c);
  const breve_status status = node.after(breve_world_profile_node(world, index, node.to()));
  if (node)
    for (const char* text : {node->class_name, node->name, node->file}) read_text(text);
  return status;
}
breve_status world_profile_cost(Caller& c) {
  breve_world* world = c.world();
  Out<double> seconds(c);
  return seconds.after(breve_world_profile_cost(world, seconds.to()));
}

breve_status world_is_profiled(Caller& c) {
  const breve_world* world = c.world();
  require(world || !breve_world_is_profiled(nullptr), "no world is profiled");
  (void)breve_world_is_profiled(world);
  c.accept_null();
  return BREVE_OK;
}
breve_status world_profile_enter(Caller& c) {
  static constexpr breve_place kPlaces[] = {{"turn", "ship.lua", 7}, {"look", "ship.lua", 0}, {nullptr, "ship.lua", 1}};
  breve_world* world = c.world();
  const char* class_name = c.chance(50) ? "Ship" : nullptr;
  const std::size_t which = c.choose().below(4);
  return breve_world_profile_enter(world, class_name, which < 3 ? &kPlaces[which] : nullptr);
}
breve_status world_profile_leave(Caller& c) { return breve_world_profile_leave(c.world()); }
breve_status world_profile_line(Caller& c) {
  breve_world* world = c.world();
  return breve_world_profile_line(world, static_cast<std::uint32_t>(c.word()));
}

// --- changing what runs ----------------------------------------------------------------------------------------------

breve_status world_reload(Caller& c) {
  breve_world* world = c.world();
  return breve_world_reload(world, c.program());
}

constexpr Statuses kProfile = kNotFound | kBusy;

constexpr Function kFunctions[] = {
    {"breve_world_create", world_create, kScript},
    {"breve_world_destroy", world_destroy, kBusy},
    {"breve_world_user", world_user, kPlain},
    {"breve_world_last_error", world_last_error, kPlain},
    {"breve_world_has_budget", world_has_budget, kPlain},
    {"breve_world_print", world_print, kScript},
    {"breve_world_methods", world_methods, kNotFound},
    {"breve_world_set_user", world_set_user},
    {"breve_object_set_user", object_set_user, kStale},
    {"breve_object_user", object_user, kStale},
    {"breve_world_set_state", world_set_state, kBusy},
    {"breve_world_state", world_state, kPlain},
    {"breve_world_allocate", world_memory, kPlain},
    {"breve_world_release", world_memory, kPlain},
    {"breve_world_step", world_step, kScript, 12},
    {"breve_world_advance", world_advance, kScript, 2},
    {"breve_world_time", world_time, kPlain},
    {"breve_world_iteration", world_iteration, kPlain},
    {"breve_world_iteration_step", world_iteration_step, kPlain},
    {"breve_world_ended", world_ended, kPlain},
    {"breve_world_paused", world_paused, kPlain},
    {"breve_world_set_paused", world_set_paused},
    {"breve_world_seed", world_seed, kPlain},
    {"breve_world_draw_random", world_random},
    {"breve_world_charge", world_charge, kScript},
    {"breve_world_interrupt", world_interrupt, kPlain},
    {"breve_world_queue_key", world_key, 0, 2},
    {"breve_world_queue_click", world_click, kStale},
    {"breve_world_menu_items", world_menu_items},
    {"breve_world_queue_choice", world_choose, kStale},
    {"breve_world_hash", world_hash, kBusy},
    {"breve_world_snapshot", world_snapshot, kBusy, 3},
    {"breve_world_restore", world_restore, kBusy | kImage, 3},
    {"breve_world_effects", world_effects},
    {"breve_world_stats", world_stats},
    {"breve_world_profile_start", world_profile_start, kBusy},
    {"breve_world_profile_stop", world_profile_stop, kProfile},
    {"breve_world_profile_node_count", world_profile_count, kProfile},
    {"breve_world_profile_node", world_profile_node, kProfile},
    {"breve_world_profile_cost", world_profile_cost, kProfile},
    {"breve_world_reload", world_reload, kBusy | kReload},
    {"breve_world_is_profiled", world_is_profiled, kPlain},
    {"breve_world_profile_enter", world_profile_enter, kBusy},
    {"breve_world_profile_leave", world_profile_leave, kBusy},
    {"breve_world_profile_line", world_profile_line},
};

}  // namespace call_worlds

std::span<const Function> world_functions() { return call_worlds::kFunctions; }

}  // namespace breve::fuzz
