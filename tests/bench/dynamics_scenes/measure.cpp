// Measures one scene. The sides take turns in rounds of a few iterations, so that what else the machine does hits all
// of them alike. breve's worlds are stepped twice, by two equal worlds: the lesser time of an iteration counts for the
// slowest one, because no worker of the machine interrupts the same iteration of both.
#include "tests/bench/dynamics_scenes/measure.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>
#include <utility>

#include "tests/bench/dynamics_scenes/peers.hpp"
#include "tests/scenes/breve_side.hpp"

namespace breve::bench {
namespace {

using scenes::Scene;
using scenes::Side;

constexpr double kStep = 1.0 / 60;  // s
constexpr int kRound = 20;          // iterations
constexpr double kFar = 300;        // m from the origin, or 30 below it: lost

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> numbers) {
  if (numbers.empty()) return 0;
  std::nth_element(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2), numbers.end());
  return numbers[numbers.size() / 2];
}

/// A contender with its worlds.
struct Runner {
  Contender result;
  std::vector<std::unique_ptr<Side>> sides;  // the first counts, the second is its equal
  double spent = 0;

  bool runs() const { return result.refusal.empty() && !result.cut; }

  void round(const Scene& scene, const Effort& effort, int from, int to) {
    const std::size_t before = result.times.size();
    double mean = 0;
    for (std::size_t i = 0; i < sides.size() && runs(); ++i) {
      int step = from;
      for (; step < to && spent < effort.most_seconds * static_cast<double>(sides.size()); ++step) {
        const double took = iterate(scene, *sides[i], step);
        const std::size_t place = before + static_cast<std::size_t>(step - from);
        if (i == 0) {
          result.times.push_back(took);
          mean += took;
        } else if (place < result.times.size()) {
          result.times[place] = std::min(result.times[place], took);
        }
      }
      result.cut = step < to;
    }
    const std::size_t count = result.times.size() - before;
    if (count > 0) result.rounds.push_back(mean / static_cast<double>(count));
  }

  double iterate(const Scene& scene, Side& side, int step) {
    prepare(scene, side, step, step * kStep);
    const double start = cpu_seconds();
    side.step();
    const double took = cpu_seconds() - start;
    spent += took;
    if (auto* ours = dynamic_cast<scenes::BreveSide*>(&side); ours && &side == sides.front().get())
      result.interventions += ours->world().counters().interventions;
    return took;
  }

  void look(const Scene& scene, int steps) {
    int left = 0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (scene.bodies[i].motion != scenes::Motion::Free || scene.bodies[i].born >= steps) continue;
      const scenes::Vector3 at = sides.front()->at(static_cast<int>(i));
      if (!at.allFinite() || (at - scene.bodies[i].at).norm() > kFar || at.y() < -30) {
        ++result.lost;
      } else {
        ++left;
        result.middle += (at - result.middle) / left;
      }
    }
  }
};

using Maker = std::function<std::unique_ptr<Side>()>;

Runner start(const std::string& name, std::optional<breve_rung> rung, const Maker& make) {
  Runner out;
  out.result.name = name;
  out.result.rung = rung;
  try {
    for (int i = 0; i < (rung ? 2 : 1); ++i) out.sides.push_back(make());
  } catch (const std::exception& refused) {
    out.result.refusal = refused.what();
  }
  return out;
}

}  // namespace

double Contender::milliseconds() const { return 1e3 * median(rounds); }

double Contender::slowest() const {
  return times.empty() ? 0 : *std::max_element(times.begin(), times.end()) / median(times);
}

double ratio(const Contender& one, const Contender& other) {
  std::vector<double> quotients;
  for (std::size_t i = 0; i < std::min(one.rounds.size(), other.rounds.size()); ++i)
    quotients.push_back(one.rounds[i] / other.rounds[i]);
  return median(quotients);
}

const char* name_of(breve_rung rung) { return rung == BREVE_RUNG_FAST ? "fast" : "balanced"; }

std::vector<Contender> measure(const Scene& scene, const std::vector<breve_rung>& rungs, const Effort& effort) {
  std::vector<Runner> runners;
  runners.push_back(start("Bullet", {}, [&] { return make_bullet(scene, kStep); }));
  runners.push_back(start("ODE", {}, [&] { return make_ode(scene, kStep); }));
  if (scene.flat) runners.push_back(start("Box2D", {}, [&] { return make_box2d(scene, kStep); }));
  for (const breve_rung rung : rungs)
    runners.push_back(
        start(name_of(rung), rung, [&] { return std::make_unique<scenes::BreveSide>(scene, rung, kStep); }));
  for (int from = 0; from < effort.iterations; from += kRound)
    for (Runner& runner : runners) {
      if (!runner.runs()) continue;
      try {
        runner.round(scene, effort, from, std::min(from + kRound, effort.iterations));
      } catch (const std::exception& failed) {
        runner.result.refusal = failed.what();
      }
    }
  std::vector<Contender> out;
  for (Runner& runner : runners) {
    if (!runner.sides.empty()) runner.look(scene, static_cast<int>(runner.result.times.size()));
    out.push_back(std::move(runner.result));
  }
  return out;
}

}  // namespace breve::bench
