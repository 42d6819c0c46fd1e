// How the cost of neighbours grows: each agent asks for its neighbours once an iteration, in crowds of 12,500 to
// 100,000 at constant density. Claim: twice the agents cost at most 2.3 times as much, also where they crowd in one
// place or are spread thinly over a wide world. Prints a table; exits 1 if the claim does not hold.
#include <algorithm>
#include <breve/breve.hpp>
#include <cstdio>
#include <ctime>
#include <string>

namespace {

// Argument 1: how many agents. Argument 2: how they stand: uniform, clustered or wide.
constexpr const char* kProgram = R"(
@use Control.
@use Mobile.
Controller Bench.
Control : Bench {
  + variables:
    agents (list).
    total (int).
  + to init:
    n (int).
    side (float).
    agent (object).
    corner (vector).
    kind (string).

    n = (self get-argument at-index 1).
    kind = (self get-argument at-index 2).
    side = exp(log(n) / 3.0).
    agents = n new Agents.
    foreach agent in agents: {
      if kind == "uniform": corner = random[(1.0, 1.0, 1.0)] * side.
      if kind == "clustered": corner = (randomGauss(), randomGauss(), randomGauss()) * (0.3 * side).
      if kind == "wide": corner = random[(1.0, 1.0, 1.0)] * (side * 1000.0).
      agent move to corner.
    }
  + to iterate:
    self update-neighbors.
    super iterate.
  + to note count c (int):
    total += c.
  + to get-total:
    return total.
}
Mobile : Agent (aka Agents) {
  + to init:
    self set-neighborhood-size to 1.2.
  + to iterate:
    controller note count |(self get-neighbors)|.
}
)";

constexpr double kBound = 2.3;   // of twice the agents, over the agents: the promise
constexpr int kIterations = 15;  // the fastest of them counts: the others were disturbed

struct Measured {
  double seconds = 0;    // CPU time of one iteration
  double neighbors = 0;  // per agent
};

Measured measure(breve::Runtime& runtime, const breve::Program& program, int agents, const char* kind) {
  const std::string count = std::to_string(agents);
  const char* const arguments[] = {"neighbors", count.c_str(), kind};
  breve_world_config config = breve_world_config_default();
  config.arguments = arguments;
  config.argument_count = 3;
  auto world = runtime.world(program, config).or_throw();
  world.step().or_throw();
  Measured result{1e30, 0};
  for (int i = 0; i < kIterations; ++i) {
    const std::clock_t start = std::clock();
    world.step().or_throw();
    result.seconds = std::min(result.seconds, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  const double total = world.call(world.controller(), "get-total").or_throw().number();
  result.neighbors = total / agents / (kIterations + 1);
  return result;
}

}  // namespace

int main() {
  bool holds = true;
  try {
    auto runtime = breve::Runtime::create().or_throw();
    const auto program = runtime.compile("neighbors.tz", kProgram).or_throw();
    std::printf("%-10s %8s %14s %16s %8s\n", "world", "agents", "ms/iteration", "neighbours/agent", "ratio");
    for (const char* kind : {"uniform", "clustered", "wide"}) {
      double before = 0;
      for (int agents = 12500; agents <= 100000; agents *= 2) {
        const Measured m = measure(runtime, program, agents, kind);
        std::printf("%-10s %8d %14.2f %16.2f", kind, agents, 1e3 * m.seconds, m.neighbors);
        if (before > 0) {
          const bool good = m.seconds <= kBound * before;
          holds = holds && good;
          std::printf(" %8.2f%s", m.seconds / before, good ? "" : "  above 2.3");
        }
        std::printf("\n");
        before = m.seconds;
      }
    }
  } catch (const breve::Failure& failure) {
    std::fprintf(stderr, "%s", failure.what());
    return 1;
  }
  return holds ? 0 : 1;
}
