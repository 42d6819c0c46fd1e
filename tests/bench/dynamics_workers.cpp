// What a second worker is worth: two worlds of 200 walkers each on one floor, with equal hashes all along, one of them
// stepped by two threads. Claim: on `balanced` that takes at most 1 / 1.7 of the other's time; `fast` is shown. By the
// clock on the wall: two cores must be free. Prints a table; exits 1 if the claim does not hold.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "tests/reference/world.hpp"

namespace {

using namespace breve::reference;

constexpr int kWalkers = 200, kWarmUp = 10, kSteps = 40;
constexpr double kLeast = 1.7;

/// A box body and four limbs of two sections; hinges with motors of constant speed within limits.
struct Crowd : World {
  Crowd(breve_rung rung, std::uint32_t workers) : World(1.0 / 60, rung) {
    must(breve_world_set_workers(get(), workers));
    set_material(fixed(box(Vector3(1000, 5, 1000), 1), Vector3(0, -2.5, 0)), 1, 0);
    for (int i = 0; i < kWalkers; ++i) add(Vector3(4.0 * (i % 15), 1.7, 4.0 * (i / 15)), i);
  }
  void add(const Vector3& at, int number) {
    const breve_object trunk = body(box(Vector3(2, 0.5, 1), 1), at);
    set_material(trunk, 1, 0);
    int limb = 0;
    for (const double x : {-0.8, 0.8})
      for (const double z : {-0.65, 0.65}) {
        ++limb;
        const double speed = (limb % 2 ? 1 : -1) * (1 + 0.001 * number);
        const breve_object thigh =
            hang(trunk, at, Vector3(x, -0.2, z), Vector3(0, 0.3, 0), Vector3(0.25, 0.7, 0.25), speed);
        hang(thigh, at, Vector3(0, -0.35, 0), Vector3(0, 0.35, 0), Vector3(0.2, 0.7, 0.2), -speed);
      }
  }
  breve_object hang(breve_object parent, const Vector3& near, const Vector3& on_parent, const Vector3& on_child,
                    const Vector3& size, double speed) {
    Hinge hinge;
    hinge.parent = parent;
    hinge.child = body(box(size, 0.1), near);
    hinge.parent_point = on_parent;
    hinge.child_point = on_child;
    set_material(hinge.child, 1, 0);
    const breve_object joint = join(hinge);
    breve_drive now = drive(joint);
    now.motor_speed[0] = speed;
    now.strength_limit = 2;
    now.low[0] = -0.6;
    now.high[0] = 0.6;
    set_drive(joint, now);
    return hinge.child;
  }
};

double seconds(Crowd& crowd) {
  const auto start = std::chrono::steady_clock::now();
  crowd.step();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// What one step in ten is faster than: other work on the machine only slows steps.
double quick(std::vector<double> all) {
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 10), all.end());
  return all[all.size() / 10];
}

bool measure(breve_rung rung, const char* name) {
  Crowd one(rung, 1), two(rung, 2);
  std::vector<double> by_one, by_two;
  bool equal = true;
  for (int i = 0; i < kWarmUp + kSteps; ++i) {
    const double a = seconds(one), b = seconds(two);
    equal = equal && one.hash() == two.hash();
    if (i < kWarmUp) continue;
    by_one.push_back(a);
    by_two.push_back(b);
  }
  const double a = quick(by_one), b = quick(by_two);
  const double least = rung == BREVE_RUNG_BALANCED ? kLeast : 0;
  std::printf("%-10s %10.2f %10.2f %8.2f (>= %.1f)  hashes %s\n", name, a * 1e3, b * 1e3, a / b, least,
              equal ? "equal" : "DIFFER");
  return equal && a / b >= least;
}

}  // namespace

int main() {
  std::printf("200 walkers on a floor, ms a step at 1/60 s\n%-10s %10s %10s %8s\n", "", "1 worker", "2 workers",
              "ratio");
  const bool balanced = measure(BREVE_RUNG_BALANCED, "balanced"), fast = measure(BREVE_RUNG_FAST, "fast");
  std::printf("%s\n", balanced && fast ? "holds" : "DOES NOT HOLD");
  return balanced && fast ? 0 : 1;
}
