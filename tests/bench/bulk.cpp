// Many objects at once, beside a loop of calls for one object: 100,000 poses are read in at most 0.9 of its time, a
// float variable of each in at most 0.5. The best of several rounds counts, all in one run.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
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
      alone, 0.9);
  row("poses, 7 floats", best_of([&] { world.get_all(objects, kBirds, BREVE_PROPERTY_POSE, narrow).or_throw(); }),
      alone, 0.9);
  row("set poses", best_of([&] { world.set_all(objects, kBirds, BREVE_PROPERTY_POSE, narrow).or_throw(); }));
  row("a float variable", best_of([&] { world.get_all(objects, kBirds, "energy", ones).or_throw(); }), variable, 0.5);
  row("set a float variable", best_of([&] { world.set_all(objects, kBirds, "energy", ones).or_throw(); }));
  row("call a method of one argument", best_of([&] { world.call_all(objects, kBirds, selector, year).or_throw(); }),
      called);
  return failed ? 1 : 0;
}
