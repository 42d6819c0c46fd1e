// What a world does and what it costs: effects and counters.
#include <algorithm>

#include "physical.hpp"

using namespace breve::host;

breve_status breve_world_effects(const breve_world* world, breve_effect* effects, size_t capacity, size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (capacity != 0) need(effects, "effects");
    need(count, "count");
    const auto& all = world->world->effects().all();
    auto& kept = world->effect_texts;
    std::pmr::vector<std::pair<std::pmr::string, std::pmr::string>> texts(kept.get_allocator());
    for (const auto& e : all) texts.emplace_back(e.name, e.active ? e.reason : std::string_view());
    kept.swap(texts);
    for (std::size_t i = 0; i < std::min(capacity, all.size()); ++i) {
      const auto& e = all[i];
      const auto asked_by = world->world->alive(e.asked_by) ? e.asked_by : breve::ObjectId{};
      effects[i] = {kept[i].first.c_str(),
                    kept[i].second.c_str(),
                    e.active,
                    e.since,
                    handle_of(*world, asked_by),
                    e.items,
                    e.calls,
                    e.bytes,
                    e.seconds};
    }
    *count = all.size();
  });
}

breve_status breve_world_stats(const breve_world* world, breve_stats* stats) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const auto& w = std::as_const(*world->world);
    breve_stats s{};
    s.iterations = w.iteration();
    s.time = w.time();
    s.objects = w.object_count();
    s.bodies = w.bodies().size();
    s.heap_cells = world->machine->heap().live_cells();
    s.memory_used = world->meter.used();
    s.memory_peak = world->meter.peak();
    s.memory_limit = world->meter.limit();
    s.errors = world->errors;
    s.warnings = world->warnings;
    write_struct(stats, s, "breve_stats");
  });
}
