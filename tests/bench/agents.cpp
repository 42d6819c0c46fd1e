// Discrete models in steve beside the same models in plain C++, in one run: flocking, segregation and predator-prey
// with the rules and sizes of the common comparison of agent-based frameworks (Datseris, Vahdati and DuBois, 2022),
// Life and Gray-Scott. Claims: flocking at most 6 times, segregation 20, predator-prey 15 for each animal and step;
// Life by the built-in rule and Gray-Scott 1.5; Life with a rule in steve at most 150 ns a cell. Exits 1 if one does
// not hold, or if the two do not come to about the same result.
//
// Usage: bench_agents [NAME]...
#include <algorithm>
#include <breve/breve.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "agents_plain.hpp"

namespace {

struct Model {
  const char* name;
  int steps;
  plain::Outcome (*plain)(int steps);
  double most;       // times the C++ program
  double most_ns;    // for each item and step; 0: no claim
  double items;      // in a step; 0: the result counts those of all steps
  double tolerance;  // of the result, relative: the random numbers are not the same
};

constexpr Model kModels[] = {
    {"flocking", 100, plain::flocking, 6, 0, 400, 0.35},
    {"segregation", 20, plain::segregation, 20, 0, 8000, 0.02},
    {"wolf_sheep", 100, plain::wolf_sheep, 15, 0, 0, 0.25},
    {"life_rule", 10, plain::life, 1e9, 150, 512 * 512, 0.05},
    {"life_totalistic", 200, plain::life, 1.5, 0, 512 * 512, 0.05},
    {"gray_scott", 100, plain::gray_scott, 1.5, 0, 512 * 512, 1e-9},
};

constexpr int kRepetitions = 15;  // the fastest counts: the others were disturbed

plain::Outcome in_steve(breve::Runtime& runtime, const Model& model) {
  const std::string name = std::string(BREVE_AGENTS_FOLDER "/") + model.name + ".tz";
  std::ifstream in(name);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const auto program = runtime.compile(name.c_str(), text.c_str()).or_throw();
  auto world = runtime.world(program, breve_world_config_default()).or_throw();
  const double begin = plain::now();
  for (int i = 0; i < model.steps; ++i) world.step().or_throw();
  const double end = plain::now();
  breve_value result{};
  const breve_status status = breve_object_call(world.get(), world.controller(), "get-result", nullptr, 0, &result);
  if (status != BREVE_OK) throw std::runtime_error(breve_world_last_error(world.get())->text);
  return {result.as.number, end - begin};
}

/// True if its claims hold.
bool measure(breve::Runtime& runtime, const Model& model) {
  plain::Outcome ours{0, 1e30}, theirs{0, 1e30};
  for (int i = 0; i < kRepetitions; ++i) {
    const plain::Outcome a = in_steve(runtime, model), b = model.plain(model.steps);
    ours = {a.result, std::min(a.seconds, ours.seconds)};
    theirs = {b.result, std::min(b.seconds, theirs.seconds)};
  }
  const auto each = [&](const plain::Outcome& o) {
    return 1e9 * o.seconds / (model.items > 0 ? model.items * model.steps : o.result);
  };
  const double ratio = each(ours) / each(theirs);
  const bool alike = std::abs(ours.result - theirs.result) <= model.tolerance * std::abs(theirs.result);
  const bool holds = alike && ratio <= model.most && (model.most_ns == 0 || each(ours) <= model.most_ns);
  std::printf("| %s | %d | %.4g | %.4g | %.1f | %.1f | %.2f |%s%s\n", model.name, model.steps, ours.result,
              theirs.result, each(ours), each(theirs), ratio, alike ? "" : " other results",
              holds ? "" : " CLAIM BROKEN");
  std::fflush(stdout);
  return holds;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    auto runtime = breve::Runtime::create().or_throw();
    bool holds = true;
    std::printf("ns of processor time for each agent, animal or cell and step:\n\n");
    std::printf("| model | steps | result, steve | C++ | ns, steve | ns, C++ | ratio |\n");
    std::printf("| --- | --- | --- | --- | --- | --- | --- |\n");
    for (const Model& model : kModels) {
      const bool wanted = count < 2 || std::any_of(arguments + 1, arguments + count,
                                                   [&](const char* name) { return std::string(name) == model.name; });
      if (wanted) holds = measure(runtime, model) && holds;
    }
    return holds ? 0 : 1;
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return 1;
  }
}
