// What scenes of bodies cost beside Bullet and ODE, at the same step of 1/60 s in one run. Claims, as ratios of CPU
// time: `fast` costs at most 0.8 times the faster peer, `balanced` at most 2 times; the slowest of 1,000 iterations
// takes at most 10 times the median one. Flat scenes also have Box2D beside them; breve's flat worlds are made with
// it, so that it is shown and no peer of the claims (bench_planar has one for it). Exits 1 if a claim does not hold.
//   --scene NAME   only that one, or all that begin so; may be repeated
//   --rung NAME    fast or balanced alone
//   --iterations N, --seconds S  how many, 1,000 unless said; how much CPU a side gets at most, 20 unless said
//   --quick        the same as --iterations 200 --seconds 3
//   --where        also prints where the bodies are at the end, on every side
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "tests/bench/dynamics_scenes/measure.hpp"

namespace {

using namespace breve::bench;

constexpr double kMostFast = 0.8, kMostBalanced = 2, kMostSlowest = 10;

struct Options {
  std::vector<std::string> scenes, rungs;
  Effort effort;
  bool quick = false, where = false;
};

bool wanted(const Options& options, const std::string& name) {
  return options.scenes.empty() || std::any_of(options.scenes.begin(), options.scenes.end(),
                                               [&](const std::string& start) { return name.rfind(start, 0) == 0; });
}

const Contender* find(const std::vector<Contender>& all, const char* name) {
  const auto found = std::find_if(all.begin(), all.end(), [name](const Contender& one) { return one.name == name; });
  return found == all.end() || found->rounds.empty() ? nullptr : &*found;
}

/// The cheaper one of Bullet and ODE, of those that can do the scene.
const Contender* faster_peer(const std::vector<Contender>& all) {
  const Contender *bullet = find(all, "Bullet"), *ode = find(all, "ODE");
  const auto works = [](const Contender* peer) { return peer && peer->refusal.empty() && peer->lost == 0; };
  if (!works(bullet)) return works(ode) ? ode : nullptr;
  if (!works(ode)) return bullet;
  return ratio(*bullet, *ode) <= 1 ? bullet : ode;
}

std::string cell(const Contender* side) {
  char text[32] = "-";
  if (side) std::snprintf(text, sizeof text, "%.3f%s", side->milliseconds(), side->cut ? "*" : "");
  return text;
}

void print_head() {
  std::printf("%-20s %-8s %10s %10s %10s %10s %7s %7s %8s %6s %6s\n", "scene", "rung", "breve ms", "Bullet ms",
              "ODE ms", "Box2D ms", "ratio", "(most)", "slowest", "of", "guard");
}

/// One line. @return whether its claims hold
bool print_row(const std::string& scene, const Contender& ours, const std::vector<Contender>& all) {
  const double most = ours.rung == BREVE_RUNG_FAST ? kMostFast : kMostBalanced;
  const Contender* peer = faster_peer(all);
  const double against = peer ? ratio(ours, *peer) : 0;
  const bool holds = ours.refusal.empty() && !ours.cut && against <= most && ours.slowest() <= kMostSlowest;
  std::printf("%-20s %-8s %10s %10s %10s %10s %7.2f %7.1f %8.1f %6zu %6lu  %s", scene.c_str(), ours.name.c_str(),
              cell(&ours).c_str(), cell(find(all, "Bullet")).c_str(), cell(find(all, "ODE")).c_str(),
              cell(find(all, "Box2D")).c_str(), against, most, ours.slowest(), ours.times.size(),
              static_cast<unsigned long>(ours.interventions), holds ? "" : "DOES NOT HOLD");
  for (const Contender& side : all) {
    if (side.rung && &side != &ours) continue;
    if (!side.refusal.empty()) std::printf("; %s: %s", side.name.c_str(), side.refusal.c_str());
    if (side.lost > 0) std::printf("; %s lost %d bodies", side.name.c_str(), side.lost);
  }
  std::printf("\n");
  return holds;
}

bool measure_scene(const std::string& name, const Options& options) {
  std::vector<breve_rung> rungs;
  for (const breve_rung rung : {BREVE_RUNG_FAST, BREVE_RUNG_BALANCED})
    if (options.rungs.empty() || std::count(options.rungs.begin(), options.rungs.end(), name_of(rung)))
      rungs.push_back(rung);
  const breve::scenes::Scene scene = breve::scenes::make(name);
  const std::vector<Contender> all = measure(scene, rungs, options.effort);
  bool holds = true;
  for (const Contender& side : all) {
    if (side.rung) holds = print_row(name, side, all) && holds;
    if (options.where)
      std::printf("  %-10s middle of the bodies at %9.3f %9.3f %9.3f\n", side.name.c_str(), side.middle.x(),
                  side.middle.y(), side.middle.z());
  }
  std::fflush(stdout);
  return holds;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("What scenes of bodies cost beside Bullet and ODE.");
  app.add_option("--scene", options.scenes, "only scenes that begin so");
  app.add_option("--rung", options.rungs, "only this rung")->check(CLI::IsMember({"fast", "balanced"}));
  app.add_option("--iterations", options.effort.iterations, "of each side")->check(CLI::PositiveNumber);
  app.add_option("--seconds", options.effort.most_seconds, "of CPU that a side gets at most")
      ->check(CLI::PositiveNumber);
  app.add_flag("--quick", options.quick, "200 iterations, at most 3 s of CPU a side");
  app.add_flag("--where", options.where, "print where the bodies are at the end");
  CLI11_PARSE(app, argc, argv);
  if (options.quick) options.effort = {200, 3};
  std::vector<std::string> names;
  for (const std::string& name : breve::scenes::names())
    if (wanted(options, name)) names.push_back(name);
  if (names.empty()) {
    std::fprintf(stderr, "no such scene; there are:");
    for (const std::string& name : breve::scenes::names()) std::fprintf(stderr, " %s", name.c_str());
    std::fprintf(stderr, "\n");
    return 2;
  }
  print_head();
  bool holds = true;
  for (const std::string& name : names) holds = measure_scene(name, options) && holds;
  std::printf("* cut short: it took more CPU time than a side gets\n%s\n", holds ? "holds" : "DOES NOT HOLD");
  return holds ? 0 : 1;
}
