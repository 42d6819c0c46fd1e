// Calls of what a game loop needs beside steps, and of batches.
#include <algorithm>
#include <cmath>

#include "call_functions.hpp"

namespace breve::fuzz {

namespace call_steps {

breve_status set_iteration_step(Caller& c) {
  breve_world* world = c.world();
  const double seconds = c.chance(80) ? 0.01 + 0.05 * static_cast<double>(c.word() % 4) : c.number();
  if (!std::isfinite(seconds) || !(seconds > 0)) c.expect_refusal();
  // A step of a million sub-steps is allowed, and takes too long here.
  return breve_world_set_iteration_step(world, std::isfinite(seconds) ? std::min(seconds, 1.0) : seconds);
}
breve_status integration_step(Caller& c) {
  const breve_world* world = c.world();
  const double seconds = breve_world_integration_step(world);
  require((seconds > 0) == (world != nullptr), "an integration step is not positive");
  c.accept_null();
  return BREVE_OK;
}
breve_status set_integration_step(Caller& c) {
  breve_world* world = c.world();
  const double seconds = c.chance(80) ? 0.01 + 0.05 * static_cast<double>(c.word() % 4) : c.number();
  if (!std::isfinite(seconds) || !(seconds > 0)) c.expect_refusal();
  return breve_world_set_integration_step(world, seconds > 0 && seconds < 0.001 ? 0.001 : seconds);
}
breve_status time_scale(Caller& c) {
  const breve_world* world = c.world();
  const double scale = breve_world_time_scale(world);
  require(scale >= 0 && (world || scale == 0), "a time scale is negative");
  c.accept_null();
  return BREVE_OK;
}
breve_status set_time_scale(Caller& c) {
  breve_world* world = c.world();
  const double scale = c.chance(80) ? 0.5 * static_cast<double>(c.word() % 4) : c.number();
  if (!std::isfinite(scale) || scale < 0) c.expect_refusal();
  return breve_world_set_time_scale(world, std::isfinite(scale) ? std::min(scale, 4.0) : scale);
}
breve_status interpolated(Caller& c) {
  const breve_world* world = c.world();
  require(world || !breve_world_interpolated(nullptr), "no world keeps poses");
  (void)breve_world_interpolated(world);
  c.accept_null();
  return BREVE_OK;
}
breve_status set_interpolated(Caller& c) { return breve_world_set_interpolated(c.world(), c.chance(80)); }

breve_status objects_interpolated(Caller& c) {
  const breve_world* world = c.world();
  std::vector<breve_object> all(c.word() % 5);
  for (breve_object& one : all) one = c.object(world, "Real");
  const double fraction = c.chance(90) ? 0.25 * static_cast<double>(c.word() % 5) : c.number();
  if (!(fraction >= 0 && fraction <= 1)) c.expect_refusal();
  const std::uint32_t property = c.chance(90) ? c.word() % 3 : c.word();
  constexpr std::uint32_t kWidths[] = {3, 4, 7};
  std::vector<double> numbers(7 * all.size(), 0.5);
  const breve_array array{numbers.data(), 0, BREVE_NUMBER_DOUBLE, property < 3 ? kWidths[property] : 3};
  if (property >= 3) c.expect_refusal();
  return breve_objects_interpolated(world, all.data(), all.size(), fraction, property, &array);
}

// --- batches: on this thread, which all callbacks belong to ----------------------------------------------------------

struct Run {
  Caller* caller;
  std::vector<std::pair<void (*)(void*), void*>> waiting;
};

void enqueue(void* user, void (*run)(void* job), void* job) { static_cast<Run*>(user)->waiting.emplace_back(run, job); }
void wait(void* user) {
  for (const auto& [run, job] : static_cast<Run*>(user)->waiting) run(job);
}
void prepare(void* user, size_t, breve_world_config* config) {
  config->budget = 20'000;
  config->memory_limit = 64U << 20U;
  if (static_cast<Run*>(user)->caller->chance(5)) config->struct_size = 3;
}
bool begin(void* user, size_t, breve_world* world) {
  require(world != nullptr, "a batch begins a world that there is not");
  return static_cast<Run*>(user)->caller->chance(80);
}
bool end(void* user, size_t, breve_world* world, const breve_outcome* outcome) {
  require(outcome != nullptr, "a batch ends a world without an outcome");
  require(world != nullptr || outcome->status != BREVE_OK, "a world was not made, and nothing is wrong");
  return static_cast<Run*>(user)->caller->chance(90);
}

breve_status batch_run(Caller& c) {
  breve_runtime* runtime = c.runtime();
  const breve_program* program = c.program();
  Run run{&c, {}};
  breve_batch batch = breve_batch_default();
  batch.struct_size = c.struct_size(sizeof batch);
  batch.count = c.word() % 4;
  batch.iterations = 1 + c.word() % 3;
  // A struct that ends before the iterations asks for worlds that never end.
  if (batch.struct_size < offsetof(breve_batch, iterations) + sizeof batch.iterations) batch.count = 0;
  batch.workers = 1;
  batch.hashes = c.chance(50);
  batch.user = &run;
  batch.prepare = prepare;
  if (c.chance(70)) batch.begin = begin;
  if (c.chance(70)) batch.end = end;
  if (c.chance(30)) batch.jobs = {&run, enqueue, wait};
  if (c.chance(3)) batch.jobs.enqueue = nullptr, batch.jobs.wait = wait, c.expect_refusal();
  if (c.chance(3)) batch.reserved[1] = true, c.expect_refusal();
  if (c.chance(3)) batch.workers = 257, c.expect_refusal();
  std::vector<breve_outcome> outcomes(batch.count);
  return breve_batch_run(runtime, program, &batch, c.chance(80) ? outcomes.data() : nullptr);
}

constexpr Function kFunctions[] = {
    {"breve_world_set_iteration_step", set_iteration_step},
    {"breve_world_integration_step", integration_step, kPlain},
    {"breve_world_set_integration_step", set_integration_step},
    {"breve_world_time_scale", time_scale, kPlain},
    {"breve_world_set_time_scale", set_time_scale},
    {"breve_world_interpolated", interpolated, kPlain},
    {"breve_world_set_interpolated", set_interpolated, 0, 2},
    {"breve_objects_interpolated", objects_interpolated, kBody, 3},
    {"breve_batch_run", batch_run},
};

}  // namespace call_steps

std::span<const Function> step_functions() { return call_steps::kFunctions; }

}  // namespace breve::fuzz
