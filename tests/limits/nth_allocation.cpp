// Fails the n-th allocation of what a host does, for n = 1, 2, 3 ... until nothing fails any more. Each failure must be
// BREVE_ERROR_MEMORY from the call in progress; the world must be usable after it, nothing may leak, and the runtime
// must work as before.
//
// A run is tried in parts, so that what comes before a part is not done anew for each of its allocations: the program
// of `world` and `image` is compiled once.
//
// Usage: nth_allocation PART [STRIDE]    every STRIDE-th allocation of the part; without it: every one.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

#include "counted_new.hpp"
#include "everything.hpp"

using namespace limits;

namespace {

struct Part {
  const char* name;
  bool (*before)(Run& run);  // nothing fails; null: nothing
  bool (*tried)(Run& run);
  bool (*load)(Run& run) = load_everything;  // the program that all runs of the part share
};

bool from_nothing(Run& run) { return make_runtime(run) && run_everything(run); }
bool compile(Run& run) { return make_runtime(run) && load_grammar(run); }

constexpr Part kParts[] = {
    {"compile", nullptr, compile},
    {"world", make_runtime, use_world},
    {"image", [](Run& run) { return make_runtime(run) && make_two_worlds(run); }, use_images},
    {"physics", [](Run& run) { return make_runtime(run) && make_library_world(run); }, use_physics, load_library},
    {"everything", nullptr, from_nothing},
};

int complaints = 0;

void complain(std::uint64_t n, const Run& run, const char* what) {
  std::printf("allocation %llu: %s\n    in %s (%s:%d): %s\n", static_cast<unsigned long long>(n), what, run.call,
              run.file, run.line, breve_status_name(run.status));
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

/// Does the runtime work? Now and then everything is tried, else a little: compiled anew if compiling has failed.
bool works(Run& run, const Run& little, std::uint64_t n, bool compiled) {
  if (n % 97 == 0) return run_everything(run);
  run.program = little.program;
  return (compiled || load_a_little(run)) && run_a_little(run);
}

/// The part of a new run with the n-th allocation failing. False once there is no n-th.
bool fail_at(const Part& part, const Run& shared, const Run& little, std::uint64_t n) {
  const std::size_t blocks = live_blocks(), given = given_blocks();
  Run run;
  run.program = shared.program;
  if (part.before != nullptr && !part.before(run)) complain(0, run, "what comes before the part fails");
  fail_allocation(n);
  const bool through = part.tried(run);
  const bool hit = failed(), nothrow = failed_nothrow();
  fail_allocation(0);
  if (through && hit && !nothrow) complain(n, run, "the failure was swallowed");
  if (!through && !hit) complain(n, run, "the part fails by itself");
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
    if (!works(again, little, n, part.before != nullptr)) complain(n, again, "the runtime is spoilt");
    end_run(again);
    breve_runtime_destroy(run.runtime);
    run.runtime = nullptr;
  }
  remove_files();
  if (live_blocks() != blocks || given_blocks() != given) complain(n, run, "a leak");
  return hit;
}

/// Every stride-th allocation of the part. How many there were.
std::uint64_t fail_all(const Part& part, const Run& shared, const Run& little, std::uint64_t stride) {
  std::uint64_t tried = 0;
  for (std::uint64_t n = stride; fail_at(part, shared, little, n); n += stride) ++tried;
  return tried;
}

}  // namespace

int main(int count, char** arguments) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  const Part* part = nullptr;
  for (const Part& p : kParts)
    if (count > 1 && std::strcmp(p.name, arguments[1]) == 0) part = &p;
  const std::uint64_t stride = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1;
  if (part == nullptr || stride == 0) {
    std::printf("usage: nth_allocation compile|world|image|physics|everything [STRIDE]\n");
    return 2;
  }
  // What the C++ library makes once is made.
  for (int warm_up = 0; warm_up < 2; ++warm_up) {
    Run run;
    if (!from_nothing(run)) {
      complain(0, run, "the run fails by itself");
      return 1;
    }
    end_run(run);
    breve_runtime_destroy(run.runtime);
  }
  Run shared, little;
  if (!make_runtime(shared) || !part->load(shared) || !make_runtime(little) || !load_a_little(little)) return 1;
  const std::uint64_t tried = fail_all(*part, shared, little, stride);
  std::printf("%s: failed %llu allocations, %d complaints\n", part->name, static_cast<unsigned long long>(tried),
              complaints);
  for (Run* run : {&shared, &little}) {
    end_run(*run);
    breve_runtime_destroy(run->runtime);
  }
  return complaints == 0 ? 0 : 1;
}
