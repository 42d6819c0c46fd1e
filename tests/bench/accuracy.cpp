// What accuracy costs in time: each scene of accuracy/ on each rung of the ladder, at an outer step of 1/60 s, with the
// guard on `report`. Claim: none, but that every run ends with finite numbers; the table is what docs/accuracy.md
// shows.
//
//   cost      CPU seconds for a simulated second, least of some runs
//   forces    how often forces were evaluated in a simulated second, by trees of bodies
//   energy    the unexplained part of the energy, over the largest kinetic energy
//   position  the largest error of a body's position after a second, compared with `reference`, m: of points of it that
//             are 1 m from its centre
//   guard     interventions of the guard
#include <algorithm>
#include <array>
#include <breve/breve.hpp>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

namespace {

constexpr std::array kScenes{"pendulum", "whip", "spin", "ball", "stack", "vehicle", "walker"};
constexpr std::array kRungs{BREVE_RUNG_FAST, BREVE_RUNG_BALANCED, BREVE_RUNG_PRECISE, BREVE_RUNG_CONSERVING,
                            BREVE_RUNG_REFERENCE};
constexpr std::array kNames{"fast", "balanced", "precise", "conserving", "reference"};
constexpr int kFrames = 300;  // 5 s
constexpr int kEarly = 60;    // until here orbits of chaos are near each other
constexpr int kRuns = 3;      // the fastest counts: the others were disturbed

struct Measured {
  double cost = std::numeric_limits<double>::infinity();
  double forces = 0, energy = 0;
  std::uint64_t told = 0;
  std::vector<breve_pose> early;
};

std::string text_of(const char* scene) {
  std::ifstream file(std::string(BREVE_ACCURACY_FOLDER) + "/" + scene + ".tz");
  return {std::istreambuf_iterator<char>(file), {}};
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void check(breve::World& world, breve_status status) {
  if (status != BREVE_OK) throw breve::Failure(status, breve_world_last_error(world.get())->text);
}

std::vector<breve_pose> poses(breve::World& world) {
  std::vector<breve_pose> all;
  for (const breve::Object object : world.objects("Real").or_throw()) all.push_back(world.pose(object).or_throw());
  return all;
}

void run(breve::World& world, Measured& measured) {
  breve_energy energy = breve_energy_default();
  breve_physics_counters counters = breve_physics_counters_default();
  double largest = 0;
  double spent = 0;
  measured.forces = 0;
  measured.told = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const double start = cpu_seconds();
    world.step().or_throw();
    spent += cpu_seconds() - start;
    check(world, breve_world_energy(world.get(), &energy));
    check(world, breve_world_physics_counters(world.get(), &counters));
    largest = std::max(largest, energy.kinetic);
    measured.forces += static_cast<double>(counters.evaluations);
    measured.told += counters.interventions;
    if (frame + 1 == kEarly) measured.early = poses(world);
  }
  measured.cost = std::min(measured.cost, spent / world.time());
  measured.forces /= world.time();
  measured.energy = std::abs(energy.residual) / largest;
}

Measured measure(breve::Runtime& runtime, const breve::Program& program, breve_rung rung) {
  Measured measured;
  for (int i = 0; i < kRuns; ++i) {
    breve_world_config config = breve_world_config_default();
    config.seed = 1;
    auto world = runtime.world(program, config).or_throw();
    breve_accuracy accuracy = breve_accuracy_default();
    check(world, breve_rung_accuracy(rung, &accuracy));
    check(world, breve_world_set_accuracy(world.get(), &accuracy));
    check(world, breve_world_set_guard(world.get(), BREVE_GUARD_REPORT));
    run(world, measured);
  }
  return measured;
}

/// Where a point of the body's first two axes, 1 m off, stands in the world.
std::array<double, 3> point(const breve_pose& pose, int axis) {
  const auto [w, x, y, z] = std::tuple(pose.rotation[0], pose.rotation[1], pose.rotation[2], pose.rotation[3]);
  const std::array<double, 3> rotated =
      axis == 0 ? std::array{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)}
                : std::array{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)};
  return {pose.location[0] + rotated[0], pose.location[1] + rotated[1], pose.location[2] + rotated[2]};
}

double farthest(const std::vector<breve_pose>& a, const std::vector<breve_pose>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (const int axis : {0, 1}) {
      const auto p = point(a[i], axis), q = point(b[i], axis);
      most = std::max(most, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
    }
  }
  return most;
}

}  // namespace

/// Arguments are names of scenes; without any it is all.
int main(int count, char** arguments) {
  bool finite = true;
  std::vector<const char*> scenes(arguments + 1, arguments + count);
  if (scenes.empty()) scenes.assign(kScenes.begin(), kScenes.end());
  try {
    auto runtime = breve::Runtime::create().or_throw();
    std::printf("%-10s %-11s %10s %10s %10s %10s %6s\n", "scene", "rung", "cost", "forces", "energy", "position",
                "guard");
    for (const char* scene : scenes) {
      const auto program = runtime.compile(scene, text_of(scene)).or_throw();
      std::vector<Measured> all;
      for (const breve_rung rung : kRungs) all.push_back(measure(runtime, program, rung));
      for (std::size_t i = 0; i < all.size(); ++i) {
        const Measured& m = all[i];
        const double place = farthest(m.early, all.back().early);
        finite = finite && std::isfinite(m.energy) && std::isfinite(place);
        std::printf("%-10s %-11s %10.5f %10.0f %10.1e %10.1e %6llu\n", scene, kNames[i], m.cost, m.forces, m.energy,
                    place, static_cast<unsigned long long>(m.told));
      }
    }
  } catch (const breve::Failure& failure) {
    std::fprintf(stderr, "%s", failure.what());
    return 1;
  }
  return finite ? 0 : 1;
}
