// Many worlds of one program, on the threads of the runtime or of the host.
#include <atomic>
#include <thread>

#include "internal.hpp"

namespace breve::host {

namespace {

/// One batch while it runs. Tasks share nothing but what is constant, and whether to go on.
class Batch {
 public:
  Batch(std::shared_ptr<RuntimeState> state, std::shared_ptr<const steve::Program> program, const breve_batch& wanted,
        const breve_world_config& config, breve_outcome* outcomes)
      : state_(std::move(state)),
        program_(std::move(program)),
        wanted_(wanted),
        config_(config),
        first_(state_->worlds),
        outcomes_(outcomes) {
    // Ids of a world follow from its number, which must not depend on which thread comes first.
    state_->worlds += static_cast<std::uint32_t>(wanted.count);
  }

  /// World `index` from its making to its end. Throws nothing.
  void run(std::size_t index) noexcept {
    breve_outcome outcome{};
    outcome.status = BREVE_ERROR_INTERRUPTED;
    if (!ended_.load(std::memory_order_relaxed)) run_world(index, outcome);
    if (outcomes_) outcomes_[index] = outcome;
  }

 private:
  void run_world(std::size_t index, breve_outcome& outcome) noexcept {
    breve_world_config config = config_;
    config.seed = wanted_.first_seed + index;
    if (wanted_.prepare) wanted_.prepare(wanted_.user, index, &config);
    breve_world* world = nullptr;
    ErrorRecord error;
    breve_status status =
        make_world(state_, first_ + static_cast<std::uint32_t>(index), program_, &config, error, &world);
    if (world) {
      world->in_batch = true;
      if (!wanted_.begin || wanted_.begin(wanted_.user, index, world)) status = step_to_the_end(*world);
      outcome.iterations = breve_world_iteration(world);
      outcome.time = breve_world_time(world);
      if (wanted_.hashes) (void)breve_world_hash(world, &outcome.hash);
    }
    outcome.status = static_cast<std::uint32_t>(status);
    const breve_error* const why = world ? breve_world_last_error(world) : error.view();
    if (status != BREVE_OK && wanted_.failed && why) wanted_.failed(wanted_.user, index, why);
    if (wanted_.end && !wanted_.end(wanted_.user, index, world, &outcome))
      ended_.store(true, std::memory_order_relaxed);
    if (world) world->in_batch = false;
    (void)breve_world_destroy(world);
  }

  breve_status step_to_the_end(breve_world& world) const noexcept {
    for (std::uint64_t done = 0; wanted_.iterations == 0 || done < wanted_.iterations; ++done) {
      if (breve_world_ended(&world)) break;
      const breve_status status = breve_world_step(&world);
      if (status != BREVE_OK) return status;
    }
    return BREVE_OK;
  }

  const std::shared_ptr<RuntimeState> state_;
  const std::shared_ptr<const steve::Program> program_;
  const breve_batch wanted_;
  const breve_world_config config_;
  const std::uint32_t first_;
  breve_outcome* const outcomes_;
  std::atomic<bool> ended_{false};
};

/// What one job of the host runs.
struct Job {
  Batch* batch = nullptr;
  std::size_t index = 0;
};

void run_job(void* job) {
  const auto& one = *static_cast<Job*>(job);
  one.batch->run(one.index);
}

void check_batch(const breve_batch& batch) {
  for (const bool reserved : batch.reserved)
    if (reserved) fail(BREVE_ERROR_ARGUMENT, "a reserved field is not false");
  constexpr std::uint32_t kMostWorkers = 256;
  constexpr std::size_t kMostWorlds = 0x7fffffffU;
  if (batch.workers > kMostWorkers) fail(BREVE_ERROR_ARGUMENT, "breve_batch.workers must be at most 256");
  if (batch.count > kMostWorlds) fail(BREVE_ERROR_ARGUMENT, "breve_batch.count must be at most 2147483647");
  if ((batch.jobs.enqueue == nullptr) != (batch.jobs.wait == nullptr))
    fail(BREVE_ERROR_ARGUMENT, "breve_batch.jobs needs both enqueue and wait, or neither");
}

void run_all(Batch& batch, const breve_batch& wanted, Workers& workers) {
  if (!wanted.jobs.enqueue) {
    const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
    const int threads = static_cast<int>(wanted.workers != 0 ? wanted.workers : cores);
    workers.run(threads, wanted.count, [&batch](std::size_t index) { batch.run(index); });
    return;
  }
  std::vector<Job> jobs(wanted.count);
  for (std::size_t i = 0; i < jobs.size(); ++i) jobs[i] = {&batch, i};
  for (Job& job : jobs) wanted.jobs.enqueue(wanted.jobs.user, run_job, &job);
  wanted.jobs.wait(wanted.jobs.user);
}

}  // namespace
}  // namespace breve::host

using namespace breve::host;

breve_status breve_batch_run(breve_runtime* runtime, const breve_program* program, const breve_batch* batch,
                             breve_outcome* outcomes) {
  if (!runtime) return BREVE_ERROR_ARGUMENT;
  return guard(runtime->error, [&] {
    need(program, "program");
    need(batch, "batch");
    const breve_batch wanted = read_config(batch, breve_batch_default(), "breve_batch");
    check_batch(wanted);
    const auto config = read_config(wanted.config, breve_world_config_default(), "breve_world_config");
    check_world_config(config);
    const CreationScope busy(*runtime);
    Batch all(runtime->state, program->program, wanted, config, outcomes);
    run_all(all, wanted, runtime->state->workers);
  });
}
