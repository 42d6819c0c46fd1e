// The calls of a host that uses all of breve.h.
#include "everything.hpp"

#include <array>
#include <cstdio>
#include <cstring>

#include "counted_new.hpp"
#include "programs.hpp"
#include "try.hpp"

namespace limits {

namespace {

bool make_world(Run& run) {
  breve_world_config config = breve_world_config_default();
  static const char* const arguments[] = {"everything.tz", "an argument that is not short at all"};
  config.arguments = arguments;
  config.argument_count = 2;
  TRY(breve_world_create(run.runtime, run.program, &config, &run.world));
  return true;
}

bool load(Run& run, const char* name) {
  TRY(breve_program_load(run.runtime, name, &run.loaded));
  run.program = run.loaded;
  return true;
}

bool step(Run& run, int times) {
  for (int i = 0; i < times; ++i) TRY(breve_world_step(run.world));
  return true;
}

bool use_values(Run& run) {
  breve_world* world = run.world;
  const breve_object controller = breve_world_controller(world);
  breve_value list, hash, element, keys;
  std::size_t size = 0;
  TRY(breve_list_create(world, &list));
  for (int i = 0; i < 5; ++i) {
    element = breve_value_string("an element that is a string of some length");
    TRY(breve_list_push(world, &list, &element));
  }
  TRY(breve_list_get(world, &list, 3, &element));
  TRY(breve_hash_create(world, &hash));
  for (int i = 0; i < 9; ++i) {
    const breve_value key = breve_value_int(i);
    TRY(breve_hash_set(world, &hash, &key, &list));
  }
  TRY(breve_hash_keys(world, &hash, &keys));
  TRY(breve_list_size(world, &keys, &size));
  TRY(breve_object_set(world, controller, "table", &hash));
  TRY(breve_object_get(world, controller, "table", &hash));
  element = breve_value_string("a title set by the host, longer than most");
  TRY(breve_object_set(world, controller, "title", &element));
  TRY(breve_object_get(world, controller, "frame", &element));
  TRY(breve_object_get(world, controller, "words", &element));
  const char* text = nullptr;
  TRY(breve_value_text(world, &element, &text));
  return true;
}

bool use_calls(Run& run) {
  breve_world* world = run.world;
  const breve_object controller = breve_world_controller(world);
  breve_value note, result;
  TRY(breve_object_get(world, controller, "note", &note));
  const breve_keyword keyword{"text", breve_value_string("what the host gives to the note")};
  TRY(breve_object_call(world, note.as.object, "give", &keyword, 1, &result));
  const char* const names[] = {"text", "twice"};
  breve_selector selector;
  TRY(breve_world_prepare(world, "give", names, 2, &selector));
  const breve_value arguments[] = {keyword.value, breve_value_int(3)};
  TRY(breve_object_call_prepared(world, note.as.object, selector, arguments, 2, &result));
  TRY(breve_object_call(world, controller, "work-with-text", nullptr, 0, nullptr));
  TRY(breve_world_queue_key(world, "a", true));
  TRY(breve_world_queue_key(world, "left", false));
  TRY(breve_world_queue_click(world, note.as.object));
  breve_menu_item items[4];
  std::size_t count = 0;
  TRY(breve_world_menu_items(world, items, 4, &count));
  TRY(breve_world_queue_choice(world, items[0].item));
  return true;
}

bool use_objects(Run& run) {
  breve_world* world = run.world;
  breve_object walkers[16], made;
  std::size_t count = 0;
  TRY(breve_world_objects(world, "Walkers", walkers, 16, &count));
  TRY(breve_object_create(world, "Walker", &made));
  breve_pose pose;
  TRY(breve_object_pose(world, made, &pose));
  pose.location[0] = 1;
  pose.rotation[1] = 0.5;
  TRY(breve_object_set_pose(world, made, &pose));
  const double one[4] = {1, 0.5, 0.25, 0.5};
  TRY(breve_object_set_velocity(world, made, one));
  TRY(breve_object_set_rotational_velocity(world, made, one));
  TRY(breve_object_set_color(world, made, one));
  TRY(breve_world_step(world));
  TRY(breve_object_free(world, made));
  TRY(breve_object_create(world, "Spark", &made));
  return true;
}

}  // namespace

bool make_runtime(Run& run) {
  breve_runtime_config config = counted_config();
  config.resolve_module = resolve_program;
  config.print = [](void*, breve_world*, breve_channel, const char*, std::size_t) {};
  config.add_path = [](void*, const char*) {};
  breve_files files{};
  TRY(breve_files_add_directory(".", true, 0, &files));
  config.files = files;
  const breve_status made = breve_runtime_create(&config, &run.runtime);
  breve_files_release(&files);
  TRY(made);
  return true;
}

bool load_everything(Run& run) { return load(run, "everything.tz"); }
bool load_grammar(Run& run) { return load(run, "grammar.tz"); }

bool make_second_world(Run& run) {
  const breve_world_config config = breve_world_config_default();
  TRY(breve_world_create(run.runtime, run.program, &config, &run.second));
  return true;
}

bool make_two_worlds(Run& run) { return make_world(run) && step(run, 1) && make_second_world(run); }

bool use_world(Run& run) {
  if (!make_world(run) || !step(run, 3) || !use_values(run) || !use_calls(run) || !use_objects(run)) return false;
  TRY(breve_world_advance(run.world, 0.15, nullptr));
  return true;
}

bool use_images(Run& run) {
  static std::array<unsigned char, 1 << 20> image;
  std::size_t size = 0;
  std::uint64_t hash = 0;
  TRY(breve_world_snapshot(run.world, image.data(), image.size(), &size));
  TRY(breve_world_hash(run.world, &hash));
  breve_object made;  // so that there is something to undo
  TRY(breve_object_create(run.world, "Note", &made));
  TRY(breve_world_restore(run.world, image.data(), size));
  TRY(breve_world_restore(run.second, image.data(), size));
  TRY(breve_world_step(run.second));
  breve_effect effects[32];
  std::size_t count = 0;
  TRY(breve_world_effects(run.world, effects, 32, &count));
  breve_stats stats = breve_stats_default();
  TRY(breve_world_stats(run.world, &stats));
  return true;
}

bool run_everything(Run& run) {
  return load_everything(run) && use_world(run) && make_second_world(run) && use_images(run);
}
bool load_a_little(Run& run) { return load(run, "little.tz"); }
bool run_a_little(Run& run) { return make_world(run) && step(run, 2); }

void remove_files() {
  for (const char* file : {"limits_made.txt", "limits_made.png", "limits_made.xml", "limits_note.xml"})
    std::remove(file);
}

void end_run(Run& run) {
  breve_world_destroy(run.world);
  breve_world_destroy(run.second);
  breve_program_destroy(run.loaded);
  run.world = run.second = nullptr;
  run.program = run.loaded = nullptr;
}

}  // namespace limits
