// What walkers cost: nine links, eight motors, on a floor. Claims, as ratios of CPU time within one run: `balanced` at
// 1/200 s costs no more than Bullet's multibody walker at 1/200 s; `fast` at 1/60 s at most half of `balanced` at 1/60
// s; one of 200 in a world at most 1.15 times one alone. The two sides take turns, and the median of the ratios counts.
// How many walkers keep up with the clock is shown. Prints tables; exits 1 if a claim does not hold. With an argument,
// only what it names: bullet, rungs, crowd.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>

#include "tests/bench/walkers.hpp"

namespace {

using namespace breve::bench;

constexpr double kMostAgainstBullet = 1, kMostFast = 0.5, kMostCrowd = 1.15;
constexpr int kKinds = 10;      // walkers with genes of their own
constexpr double kLanding = 1;  // s, not counted
constexpr double kSeconds = 5;  // counted
constexpr int kRounds = 10;     // of the two sides, in that time

double cost_of(int steps, const std::function<void()>& step) {
  const double start = cpu_seconds();
  for (int i = 0; i < steps; ++i) step();
  return cpu_seconds() - start;
}

struct Pair {
  double one = 0, other = 0, ratio = 0;  // s of CPU a simulated second; median of the ratios
};

/// Both sides simulate the same time, in turns, after they have landed.
Pair alternating(double one_step, const std::function<void()>& one, double other_step,
                 const std::function<void()>& other) {
  cost_of(static_cast<int>(kLanding / one_step), one);
  cost_of(static_cast<int>(kLanding / other_step), other);
  Pair pair;
  std::vector<double> ratios;
  for (int i = 0; i < kRounds; ++i) {
    const double round = kSeconds / kRounds;
    const double a = cost_of(static_cast<int>(std::lround(round / one_step)), one);
    const double b = cost_of(static_cast<int>(std::lround(round / other_step)), other);
    pair.one += a / kSeconds;
    pair.other += b / kSeconds;
    ratios.push_back(a / b);
  }
  pair.ratio = median(ratios);
  return pair;
}

bool against_bullet() {
  constexpr double kStep = 1.0 / 200;
  std::printf("a walker, balanced and Bullet's at 1/200 s: CPU microseconds a step\n%8s %10s %10s %8s\n", "genes",
              "ours", "Bullet", "ratio");
  std::vector<double> ratios;
  for (int n = 0; n < kKinds; ++n) {
    Walkers ours(BREVE_RUNG_BALANCED, kStep, 1, n);
    BulletWalker theirs(kStep, genes(n));
    const Pair pair = alternating(
        kStep, [&] { ours.iterate(); }, kStep, [&] { theirs.iterate(); });
    std::printf("%8d %10.1f %10.1f %8.2f%s\n", n, pair.one * kStep * 1e6, pair.other * kStep * 1e6, pair.ratio,
                theirs.height() > 0 ? "" : "  (Bullet's fell through the floor)");
    ratios.push_back(pair.ratio);
  }
  std::printf("%8s %10s %10s %8.2f (<= %.2f)\n", "median", "", "", median(ratios), kMostAgainstBullet);
  return median(ratios) <= kMostAgainstBullet;
}

bool rungs() {
  constexpr double kStep = 1.0 / 60;
  std::printf("a walker at 1/60 s: CPU microseconds a step\n%8s %10s %10s %8s\n", "genes", "fast", "balanced", "ratio");
  std::vector<double> ratios;
  for (int n = 0; n < kKinds; ++n) {
    Walkers fast(BREVE_RUNG_FAST, kStep, 1, n), balanced(BREVE_RUNG_BALANCED, kStep, 1, n);
    const Pair pair = alternating(
        kStep, [&] { fast.iterate(); }, kStep, [&] { balanced.iterate(); });
    std::printf("%8d %10.1f %10.1f %8.2f\n", n, pair.one * kStep * 1e6, pair.other * kStep * 1e6, pair.ratio);
    ratios.push_back(pair.ratio);
  }
  std::printf("%8s %10s %10s %8.2f (<= %.2f)\n", "median", "", "", median(ratios), kMostFast);
  return median(ratios) <= kMostFast;
}

bool crowd(breve_rung rung, const char* name) {
  constexpr double kStep = 1.0 / 60;
  constexpr int kCount = 200;
  std::vector<std::unique_ptr<Walkers>> alone;
  for (int n = 0; n < kKinds; ++n) alone.push_back(std::make_unique<Walkers>(rung, kStep, 1, n));
  Walkers crowd(rung, kStep, kCount, 0, kKinds);
  const Pair pair = alternating(
      kStep, [&] { crowd.iterate(); }, kStep,
      [&] {
        for (const auto& one : alone) one->iterate();
      });
  const double ratio = pair.ratio * kKinds / kCount;
  // CPU seconds for a simulated second of one walker.
  const double each = pair.one / kCount;
  std::printf("%-10s %12.1f %12.1f %8.2f (<= %.2f) %10.0f\n", name, pair.other / kKinds * kStep * 1e6,
              each * kStep * 1e6, ratio, kMostCrowd, 2 / each);
  return ratio <= kMostCrowd;
}

bool crowds() {
  std::printf("200 walkers in one world at 1/60 s: CPU microseconds a step and walker; as many keep up on two cores\n");
  std::printf("%-10s %12s %12s %8s %20s\n", "", "alone", "of 200", "ratio", "in real time");
  const bool fast = crowd(BREVE_RUNG_FAST, "fast"), balanced = crowd(BREVE_RUNG_BALANCED, "balanced");
  return fast && balanced;
}

}  // namespace

int main(int argc, char** argv) {
  const auto wanted = [&](const char* name) { return argc < 2 || std::strcmp(argv[1], name) == 0; };
  bool holds = true;
  if (wanted("bullet")) holds = against_bullet() && holds;
  if (wanted("rungs")) holds = rungs() && holds;
  if (wanted("crowd")) holds = crowds() && holds;
  std::printf("%s\n", holds ? "holds" : "DOES NOT HOLD");
  return holds ? 0 : 1;
}
