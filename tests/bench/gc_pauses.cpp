// How long garbage stops a host. A world of a million objects is stepped at 60 iterations a second. Before each step
// the host has a program link 2,000 of the objects anew and give them two new lists each, replace 200, and drop 100
// pairs of objects, lists and hashes in cycles, in each 30th iteration also a ring of 5,000 lists; with a longer one
// the collector of the whole heap runs. In the step itself the program does nothing, so that its time is that of the
// garbage: claim: 99.9 % of the steps take at most 2 ms of processor time. What the calls before take, with the garbage
// that is given back in them, is also printed. Exits 1 if the claim does not hold.
//
// Usage: bench_gc_pauses [OBJECTS [FRAMES [RING [plain]]]]; "plain": the objects have no lists of their own
#include <algorithm>
#include <breve/breve.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr double kClaim = 2;  // ms at 99.9 %
constexpr const char* kProgram = R"(
@use Control.
Controller Town.
Control : Town {
  + variables:
    people (list).
    count, ring, turn, plain (int).
  + to init:
    i (int).
    count = (self get-argument at-index 1).
    ring = (self get-argument at-index 2).
    plain = (self get-argument at-index 3).
    for i = 0, i < count, i++: push (new Person) onto people.
    for i = 0, i < count, i++: people{i} meet friend people{random[count - 1]}.
  + to live:
    i, n (int).
    p (object).
    for i = 0, i < 2000, i++: {
      p = people{random[count - 1]}.
      p meet friend people{random[count - 1]}.
      if !plain: p think about { i, n, { "a passing thought", p } }.
    }
    for i = 0, i < 200, i++: {
      n = random[count - 1].
      free people{n}.
      people{n} = new Person.
      people{n} meet friend people{random[count - 1]}.
    }
    for i = 0, i < 100, i++: self make-knots.
    turn++.
    if ring > 0 && turn % 30 == 0: self make-ring.
  + to make-ring:
    i (int).
    first, last (list).
    first = { 0 }.
    last = first.
    for i = 1, i < ring, i++: last = (self chain next { i } behind last).
    push first onto last.
  + to chain next n (list) behind l (list):
    push n onto l.
    return n.
  + to make-knots:
    a, b (object).
    k (list).
    h (hash).
    a = new Knot. b = new Knot.
    a tie to b. b tie to a.
    k = { 1, 2 }.
    push k onto k.
    h{"list"} = k.
    push h onto k.
}
Object : Person {
  + variables:
    friend (object).
    thoughts (list).
    energy (float).
    place (vector).
  + to meet friend f (object):
    friend = f.
  + to think about what (list):
    energy += 1.
    thoughts = what.
}
Object : Knot {
  + variables:
    other (object).
  + to init:
    self enable-auto-free.
  + to tie to o (object):
    other = o.
}
)";

/// Milliseconds of processor time of this thread.
double now() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

double quantile(std::vector<double> times, double q) {
  std::sort(times.begin(), times.end());
  const auto at = static_cast<std::size_t>(q * static_cast<double>(times.size()));
  return times[std::min(at, times.size() - 1)];
}

void print_row(const char* what, const std::vector<double>& times) {
  std::printf("| %s | %.2f | %.2f | %.2f | %.2f |\n", what, quantile(times, 0.5), quantile(times, 0.99),
              quantile(times, 0.999), quantile(times, 1));
}

/// True if the claim holds.
bool measure(breve::World& world, int warm, int frames) {
  std::vector<double> calls, steps;
  std::uint64_t least = UINT64_MAX, most = 0;
  breve_stats stats{};
  auto next = std::chrono::steady_clock::now();
  for (int i = -warm; i < frames; ++i) {
    const double begin = now();
    world.call(world.controller(), "live").or_throw();
    const double called = now();
    world.step().or_throw();
    const double stepped = now();
    if (i < 0) continue;
    calls.push_back(called - begin);
    steps.push_back(stepped - called);
    stats.struct_size = sizeof stats;
    breve_world_stats(world.get(), &stats);
    least = std::min(least, stats.heap_cells);
    most = std::max(most, stats.heap_cells);
    next = std::max(next + std::chrono::microseconds(16'667), std::chrono::steady_clock::now());
    std::this_thread::sleep_until(next);
  }
  std::printf("%llu objects, %llu to %llu cells, %zu MB, %d iterations at 60 Hz; ms of processor time:\n\n",
              static_cast<unsigned long long>(stats.objects), static_cast<unsigned long long>(least),
              static_cast<unsigned long long>(most), stats.memory_used >> 20, frames);
  std::printf("| what | p50 | p99 | p99.9 | longest |\n| --- | --- | --- | --- | --- |\n");
  print_row("step: all that garbage stops", steps);
  print_row("call before it: the program's own work", calls);
  return quantile(steps, 0.999) <= kClaim;
}

}  // namespace

int main(int count, char** arguments) {
  const std::string objects = count > 1 ? arguments[1] : "1000000";
  const int frames = count > 2 ? std::atoi(arguments[2]) : 2000;
  const std::string cycle = count > 3 ? arguments[3] : "5000";
  const bool plain = count > 4;
  const char* const values[] = {"town.tz", objects.c_str(), cycle.c_str(), plain ? "1" : "0"};
  try {
    auto runtime = breve::Runtime::create().or_throw();
    const auto program = runtime.compile("town.tz", kProgram).or_throw();
    breve_world_config config = breve_world_config_default();
    config.arguments = values;
    config.argument_count = 4;
    auto world = runtime.world(program, config).or_throw();
    // First until nearly all have their lists, and as much goes as comes.
    return measure(world, plain ? 100 : 1500, frames) ? 0 : 1;
  } catch (const breve::Failure& failure) {
    std::fprintf(stderr, "%s", failure.what());
    return 1;
  }
}
