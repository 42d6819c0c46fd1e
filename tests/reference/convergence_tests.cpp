// The order with which the rungs converge: scenes with a smooth solution at steps of h, h/2, h/4 and h/8, against a
// closed form where there is one, else against `reference` at a short step.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "convergence_scenes.hpp"

namespace breve::reference {
namespace {

constexpr std::size_t kHalvings = 4;
// An order that is fitted to four steps errs: sliding that ends within a sub-step does so at another part of each step.
constexpr double kTolerance = 0.3;
// m or rad. A motor gives way by a millionth of what it moves; where there are contacts, places are looked at to a
// millionth of the radius; positions in a flat world are numbers of single precision.
constexpr double kExact = 1e-8, kExactInContact = 5e-7, kExactFlat = 1e-6;

struct Rung {
  breve_rung rung;
  const char* name;
  double longest;  // s, h: not more than the rung's own longest sub-step
};
constexpr Rung kRungs[] = {{BREVE_RUNG_FAST, "fast", 1.0 / 60},
                           {BREVE_RUNG_BALANCED, "balanced", 1.0 / 240},
                           {BREVE_RUNG_PRECISE, "precise", 1.0 / 480}};
constexpr double kLongestFlat = 1.0 / 60, kShort = 1.0 / 15360;

/// What docs/accuracy.md says of a rung.
double order_of(Motion motion, breve_rung rung) {
  switch (motion) {
    case Motion::Joints: return 4;
    case Motion::Rotation: return rung == BREVE_RUNG_PRECISE ? 4 : 2;
    case Motion::Straight: return 2;
    case Motion::Curved:
    case Motion::Flat: return 1;
  }
  return 4;
}

double exact_below(Motion motion) {
  if (motion == Motion::Flat) return kExactFlat;
  return motion == Motion::Straight || motion == Motion::Curved ? kExactInContact : kExact;
}

std::vector<double> result_of(const Scene& scene, int variant, breve_rung rung, double step, std::uint32_t dimension) {
  World world(step, rung, dimension);
  world.set_guard(BREVE_GUARD_REPORT);
  const Read read = scene.build(world, variant);
  world.run(scene.seconds);
  return read(world);
}

double off(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

/// The slope of the logarithms of errors at steps that halve, by least squares.
double order_in(const std::array<double, kHalvings>& errors) {
  const double ends = std::log2(errors[0] / errors[3]), middle = std::log2(errors[1] / errors[2]);
  return (3 * ends + middle) / 10;
}

class Convergence : public testing::TestWithParam<std::size_t> {};

TEST_P(Convergence, HasTheOrderThatIsClaimed) {
  const Scene scene = smooth_scenes()[GetParam()];
  const bool flat = scene.motion == Motion::Flat;
  std::vector<std::vector<double>> exact;
  for (int i = 0; i < scene.variants; ++i)
    exact.push_back(scene.exact ? scene.exact(scene.seconds, i) : result_of(scene, i, BREVE_RUNG_REFERENCE, kShort, 3));
  std::printf("  %s\n", scene.name);
  for (const Rung& rung : kRungs) {
    std::array<double, kHalvings> errors{};
    std::printf("    %-8s", rung.name);
    for (std::size_t k = 0; k < kHalvings; ++k) {
      const double step = (flat ? kLongestFlat : rung.longest) / std::exp2(k);
      for (int i = 0; i < scene.variants; ++i)
        errors[k] = std::max(
            errors[k], off(result_of(scene, i, rung.rung, step, flat ? 2 : 3), exact[static_cast<std::size_t>(i)]));
      std::printf("  %.1e", errors[k]);
    }
    const double order = order_in(errors);
    std::printf("  order %.2f\n", order);
    if (scene.within > 0) {
      for (const double error : errors) EXPECT_LE(error, scene.within) << scene.name << " on " << rung.name;
      continue;
    }
    if (errors.back() <= exact_below(scene.motion)) continue;
    EXPECT_GE(order, order_of(scene.motion, rung.rung) - kTolerance) << scene.name << " on " << rung.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Smooth, Convergence, testing::Range<std::size_t>(0, smooth_scenes().size()));

}  // namespace
}  // namespace breve::reference
