// Profiles of worlds: the machine's profiler, started, stopped and read.
#include <algorithm>

#include "internal.hpp"

namespace breve::host {

namespace {

breve_profile_node view_of(const steve::ProfileNode& node) {
  // KEEP IN STEP: steve::ProfileKind, breve_profile_kind.
  static_assert(static_cast<int>(steve::ProfileKind::Act) == BREVE_PROFILE_ACT);
  return {node.parent,       static_cast<breve_profile_kind>(node.kind),
          node.class_name,   node.name,
          node.file,         node.line,
          node.call_line,    node.calls,
          node.self_seconds, node.total_seconds};
}

/// Hands events to the host, which must not run script meanwhile.
steve::Profiler::Trace tracer(breve_world& world, breve_trace_fn trace, void* user) {
  if (!trace) return {};
  return [&world, trace, user](const steve::TraceEvent& event) {
    const auto& callee = event.callee;
    const breve_trace_event e{event.begins,
                              static_cast<breve_profile_kind>(callee.kind),
                              event.seconds,
                              callee.class_name,
                              callee.name,
                              callee.file,
                              callee.line,
                              callee.call_line,
                              world.world->iteration()};
    world.tracing = true;
    trace(user, &e);
    world.tracing = false;
    world.references.forget_all();
  };
}

steve::Profiler& profiler_of(const breve_world& world) {
  if (!world.profiler) fail(BREVE_ERROR_NOT_FOUND, "this world has no profile: breve_world_profile_start starts one");
  return *world.profiler;
}

void need_no_trace(const breve_world& world, const char* function) {
  if (world.tracing)
    fail(BREVE_ERROR_BUSY, std::string(function) + " was called by the breve_trace_fn of this profile");
}

}  // namespace

void start_profile(breve_world& world, breve_trace_fn trace, void* user) {
  world.machine->set_profiler(nullptr);
  world.profiler.reset();
  world.profiler.emplace(world.program, &world.meter, tracer(world, trace, user));
  world.machine->set_profiler(&*world.profiler);
}

}  // namespace breve::host

using namespace breve::host;

breve_status breve_world_profile_start(breve_world* world, breve_trace_fn trace, void* user) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need_idle(*world, "breve_world_profile_start");
    start_profile(*world, trace, user);
  });
}

breve_status breve_world_profile_stop(breve_world* world) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need_idle(*world, "breve_world_profile_stop");
    auto& profiler = profiler_of(*world);
    world->machine->set_profiler(nullptr);
    profiler.stop();
    if (profiler.out_of_memory())
      fail(BREVE_ERROR_MEMORY,
           "the profile ended before the run: the world ran out of memory for it. Raise the world's limit");
  });
}

breve_status breve_world_profile_node_count(const breve_world* world, size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(count, "count");
    need_idle(*world, "breve_world_profile_node_count");
    *count = profiler_of(*world).node_count();
  });
}

breve_status breve_world_profile_node(const breve_world* world, size_t index, breve_profile_node* node) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(node, "node");
    need_idle(*world, "breve_world_profile_node");
    auto& profiler = profiler_of(*world);
    if (index >= profiler.node_count())
      fail(BREVE_ERROR_NOT_FOUND, "the profile has " + std::to_string(profiler.node_count()) + " nodes");
    *node = view_of(profiler.node(index));
  });
}

breve_status breve_world_profile_cost(const breve_world* world, double* seconds) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(seconds, "seconds");
    need_idle(*world, "breve_world_profile_cost");
    *seconds = profiler_of(*world).overhead_seconds();
  });
}

bool breve_world_is_profiled(const breve_world* world) {
  return world && world->profiler && world->profiler->recording();
}

breve_status breve_world_profile_enter(breve_world* world, const char* class_name, const breve_place* place) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(place, "place");
    need(place->function, "place.function");
    need(place->file, "place.file");
    need_no_trace(*world, "breve_world_profile_enter");
    if (world->profiler)
      world->profiler->enter_code(place, class_name ? class_name : "", place->function, place->file, place->line);
  });
}

breve_status breve_world_profile_leave(breve_world* world) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need_no_trace(*world, "breve_world_profile_leave");
    if (world->profiler) world->profiler->leave_code();
  });
}

breve_status breve_world_profile_line(breve_world* world, uint32_t line) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  if (world->profiler) world->profiler->set_foreign_line(line);
  return BREVE_OK;
}
