// Fails the n-th allocation of a run that uses everything, for n = 1, 2, 3 ... until a run gets through. Each failure
// must be BREVE_ERROR_MEMORY from the call in progress; the world must be usable after it, nothing may leak, and the
// runtime must do the whole run afterwards.
//
// Usage: nth_allocation ALL STRIDE    every n up to ALL, then every STRIDE-th. ALL 0: all there are.
#include <cstdio>
#include <cstdlib>

#include "counted_new.hpp"
#include "everything.hpp"

using namespace limits;

namespace {

int complaints = 0;

void complain(std::uint64_t n, const Run& run, const char* what) {
  std::printf("allocation %llu: %s\n    in %s (everything.cpp:%d): %s\n", static_cast<unsigned long long>(n), what,
              run.call, run.line, breve_status_name(run.status));
  const breve_error* error = run.world ? breve_world_last_error(run.world) : nullptr;
  if (error == nullptr) error = breve_runtime_last_error(run.runtime);
  if (error != nullptr) std::printf("    %s", error->text);
  std::fflush(stdout);
  if (++complaints >= 20) std::exit(1);
}

/// The world after a failed call: it may be stepped, looked at, and saved.
void check_world(std::uint64_t n, Run run) {
  std::uint64_t hash = 0;
  std::size_t size = 0;
  run.call = "the world after the failure";
  for (int i = 0; i < 2 && run.status == BREVE_OK; ++i) run.status = breve_world_step(run.world);
  if (run.status == BREVE_OK) run.status = breve_world_hash(run.world, &hash);
  if (run.status == BREVE_OK) run.status = breve_world_snapshot(run.world, nullptr, 0, &size);
  if (run.status != BREVE_OK) complain(n, run, "the world is not usable");
}

/// One run with the n-th allocation failing. False once there is no n-th.
bool fail_at(std::uint64_t n, bool whole_run_after) {
  const std::size_t blocks = live_blocks(), given = given_blocks();
  Run run;
  fail_allocation(n);
  const bool through = run_everything(run);
  const bool hit = failed(), nothrow = failed_nothrow();
  fail_allocation(0);
  if (through && hit && !nothrow) complain(n, run, "the failure was swallowed");
  if (!through && !hit) complain(n, run, "the run fails by itself");
  if (!through && hit && run.status != BREVE_ERROR_MEMORY) complain(n, run, "another status");
  if (run.world != nullptr) {
    Run after = run;
    after.status = BREVE_OK;
    check_world(n, after);
  }
  end_run(run);
  if (run.runtime != nullptr) {
    Run again;
    again.runtime = run.runtime;
    if (!(whole_run_after ? run_everything(again) : run_a_little(again))) complain(n, again, "the runtime is spoilt");
    end_run(again);
    breve_runtime_destroy(run.runtime);
    run.runtime = nullptr;
  }
  if (live_blocks() != blocks || given_blocks() != given) complain(n, run, "a leak");
  return hit;
}

}  // namespace

int main(int count, char** arguments) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const std::uint64_t all = count > 1 ? std::strtoull(arguments[1], nullptr, 10) : 0;
  const std::uint64_t stride = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1;
  for (int warm_up = 0; warm_up < 2; ++warm_up) {  // what the C++ library makes once is made
    Run run;
    fail_allocation(0);
    if (!run_everything(run)) {
      complain(0, run, "the run fails by itself");
      return 1;
    }
    std::printf("%llu allocations in a whole run\n", static_cast<unsigned long long>(allocations()));
    end_run(run);
    breve_runtime_destroy(run.runtime);
  }
  std::uint64_t n = 1, tried = 0;
  while (fail_at(n, n % 97 == 0)) {
    ++tried;
    n += all == 0 || n < all ? 1 : stride;
  }
  std::printf("failed %llu of them: %d complaints\n", static_cast<unsigned long long>(tried), complaints);
  return complaints == 0 ? 0 : 1;
}
