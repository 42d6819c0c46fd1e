// Many objects at once, beside a loop of calls for one object: 100,000 poses are read in at most 0.7 of its time, a
// float variable of each in at most 0.5. Then what a query costs, among 10,000 and 40,000 bodies at the same
// density. The best of several rounds counts, all in one run.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "breve/breve.hpp"

namespace {

constexpr std::size_t kBirds = 100'000, kRounds = 40;

constexpr const char* kText = R"(
@use Control.
@use Mobile.
Controller Main.
Mobile : Bird (aka Birds) {
  + variables:
    energy (float).
  + to init:
    energy = random[1.0].
    self move to random[(100, 100, 100)].
    self set-rotation around-axis (0, 0, 1) by energy.
  + to age by years (int):
    energy += years.
}
Control : Main {
  + variables:
    birds (list).
  + to init:
    birds = 100000 new Birds.
}
)";

template <class Work>
double best_of(Work&& work) {
  double best = 1e9;
  for (std::size_t i = 0; i < kRounds; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

bool failed = false;

/// @param peer  s, of the loop; 0: there is none
/// @param most  of its time; 0: no claim is made
void row(const char* what, double seconds, double peer = 0, double most = 0) {
  std::printf("%-32s %8.3f ms %6.1f ns each", what, 1e3 * seconds, 1e9 * seconds / static_cast<double>(kBirds));
  if (peer > 0) std::printf("   %.2f of one by one", seconds / peer);
  const bool holds = most == 0 || seconds <= most * peer;
  failed = failed || !holds;
  std::puts(holds ? "" : "  TOO SLOW");
}

// --- queries -------------------------------------------------------------------------------------------------------

/// Spheres in a cube, at random places, 0.02 of them in a unit of volume: one of radius 3 has two others near it.
std::string crowd_of(std::size_t bodies) {
  const std::string side = std::to_string(std::cbrt(static_cast<double>(bodies) / 0.02));
  return "@use Control.\n@use Mobile.\nController Main.\nMobile : Ball (aka Balls) {\n+ to init: self move to "
         "random[(" +
         side + ", " + side + ", " + side +
         ")].\n}\nControl : Main {\n+ variables: balls (list).\n+ to init: balls = " + std::to_string(bodies) +
         " new Balls.\n}\n";
}

constexpr std::size_t kQueries = 2000;
constexpr std::array kKinds = {"ray of 20, first",   "ray of 20, all", "sphere of radius 3",
                               "sphere moved by 10", "closest body",   "bodies within 5"};

/// s for each query of each kind, among so many bodies
std::array<double, kKinds.size()> time_queries(breve::Runtime& runtime, std::size_t bodies) {
  auto program = runtime.compile("crowd.tz", crowd_of(bodies)).or_throw();
  auto world = runtime.world(program).or_throw();
  const std::vector<breve::Object> balls = world.objects("Ball").or_throw();
  std::vector<std::array<double, 3>> starts(kQueries);
  for (std::size_t i = 0; i < kQueries; ++i) {
    breve_pose pose;
    breve_object_pose(world.get(), balls[i * (bodies / kQueries)], &pose);
    // Beside a body, so that there is something to find and no query starts inside of one.
    starts[i] = {pose.location[0] + 1.5, pose.location[1], pose.location[2]};
  }
  breve_geometry sphere = breve_geometry_default();
  sphere.kind = BREVE_SHAPE_SPHERE;
  sphere.radius = 3;
  const double way[3] = {12, 16, 0}, shift[3] = {0, 6, 8};
  breve_hit hits[64];
  bool found = false;
  std::size_t count = 0;
  const auto each = [&](auto&& ask) {
    return best_of([&] {
             for (const auto& start : starts) ask(start.data());
           }) /
           static_cast<double>(kQueries);
  };
  const auto pose_at = [](const double* at) { return breve_pose{{at[0], at[1], at[2]}, {1, 0, 0, 0}}; };
  breve_world* const w = world.get();
  return {each([&](const double* at) { breve_world_ray_first(w, at, way, nullptr, &found, hits); }),
          each([&](const double* at) { breve_world_ray_all(w, at, way, nullptr, hits, 64, &count); }),
          each([&](const double* at) {
            const breve_pose pose = pose_at(at);
            breve_world_overlap(w, &sphere, &pose, nullptr, hits, 64, &count);
          }),
          each([&](const double* at) {
            const breve_pose pose = pose_at(at);
            breve_world_cast(w, &sphere, &pose, shift, nullptr, &found, hits);
          }),
          each([&](const double* at) { breve_world_closest(w, at, INFINITY, nullptr, &found, hits); }),
          each([&](const double* at) { breve_world_near(w, at, 5, nullptr, hits, 64, &count); })};
}

void queries(breve::Runtime& runtime) {
  const auto few = time_queries(runtime, 10'000), many = time_queries(runtime, 40'000);
  std::printf("\n%-32s %10s %10s\n", "queries, us each", "10,000", "40,000");
  for (std::size_t i = 0; i < kKinds.size(); ++i)
    std::printf("%-32s %10.2f %10.2f\n", kKinds[i], 1e6 * few[i], 1e6 * many[i]);
}

}  // namespace

int main() {
  auto runtime = breve::Runtime::create().or_throw();
  auto program = runtime.compile("birds.tz", kText).or_throw();
  auto world = runtime.world(program).or_throw();
  std::vector<breve::Object> birds = world.objects("Bird").or_throw();
  std::vector<double> numbers(7 * kBirds), copied(7 * kBirds);
  std::vector<float> singles(7 * kBirds);
  const breve::Array poses(numbers.data(), 7), narrow(singles.data(), 7), ones(numbers.data(), 1);
  const auto objects = birds.data();
  const auto selector = world.prepare("age", {"by"}).or_throw();
  const breve::Value year[] = {1};

  const double alone = best_of([&] {
    for (std::size_t i = 0; i < kBirds; ++i) {
      breve_pose pose;
      breve_object_pose(world.get(), birds[i], &pose);
      std::memcpy(numbers.data() + 7 * i, &pose, sizeof pose);
    }
  });
  const double variable = best_of([&] {
    for (std::size_t i = 0; i < kBirds; ++i) {
      breve_value value;
      breve_object_get(world.get(), birds[i], "energy", &value);
      numbers[i] = value.as.number;
    }
  });
  const double called = best_of([&] {
    const breve_value argument = year[0];
    for (std::size_t i = 0; i < kBirds; ++i)
      breve_object_call_prepared(world.get(), birds[i], selector, &argument, 1, nullptr);
  });
  const double copy = best_of([&] { std::memcpy(copied.data(), numbers.data(), 7 * kBirds * sizeof(double)); });
  std::printf("%zu objects, best of %zu rounds; a copy of their poses takes %.3f ms\n", kBirds, kRounds, 1e3 * copy);
  row("all objects of a class", best_of([&] { world.objects("Bird", birds).or_throw(); }));
  row("poses, 7 doubles", best_of([&] { world.get_all(objects, kBirds, BREVE_PROPERTY_POSE, poses).or_throw(); }),
      alone, 0.7);
  row("poses, 7 floats", best_of([&] { world.get_all(objects, kBirds, BREVE_PROPERTY_POSE, narrow).or_throw(); }),
      alone, 0.7);
  row("set poses", best_of([&] { world.set_all(objects, kBirds, BREVE_PROPERTY_POSE, narrow).or_throw(); }));
  row("a float variable", best_of([&] { world.get_all(objects, kBirds, "energy", ones).or_throw(); }), variable, 0.5);
  row("set a float variable", best_of([&] { world.set_all(objects, kBirds, "energy", ones).or_throw(); }));
  row("call a method of one argument", best_of([&] { world.call_all(objects, kBirds, selector, year).or_throw(); }),
      called);
  queries(runtime);
  return failed ? 1 : 0;
}
