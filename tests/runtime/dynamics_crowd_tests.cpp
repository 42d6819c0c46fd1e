// Walkers whose motors are at their limits most of the time, many in one world: what one costs must not depend on
// chance, nor on how many there are.
#include <gtest/gtest.h>

#include <cstdio>

#include "dynamics_walker.hpp"

namespace breve::testing {
namespace {

TEST(DynamicsCrowd, MotorsAtTheirLimitsDoNotHoldUpStepControl) {
  constexpr int kWalkers = 10, kSeconds = 3;
  Crowd s(kWalkers, Rung::Balanced);
  std::uint64_t sum = 0, most = 0, rejected = 0;
  for (int i = 0; i < 60 * kSeconds; ++i) {
    s.step();
    const DynamicsCounters& c = s.mechanics().counters();
    sum += c.evaluations;
    rejected += c.rejected;
    most = std::max(most, c.evaluations);
  }
  const double each = static_cast<double>(sum) / (kWalkers * kSeconds);
  std::printf("  %.0f evaluations a walker and second, %lu rejected in all, at most %lu in a step of all\n", each,
              rejected, most);
  // Four sub-steps of six evaluations are 1,440 a second. The rest is for motors that come to their limit and leave it,
  // some ten a second: step control looks for each moment with some hundred.
  EXPECT_LT(each, 15000);
  EXPECT_LT(most, 1500U * kWalkers);
}

TEST(DynamicsCrowd, OnFastAWalkerThatStandsTakesOneRungeKuttaStep) {
  // What its feet hold acts inside the stages: nothing moves for which a finer step would have to stand in.
  Walker s(Rung::Fast);
  for (int i = 0; i < 180; ++i) s.world.step();
  std::uint64_t evaluations = 0;
  for (int i = 0; i < 60; ++i) {
    s.world.step();
    evaluations += s.mechanics().counters().evaluations;
  }
  EXPECT_LE(evaluations, 4 * 60U);
}

TEST(DynamicsCrowd, WalkersThatDoNotMeetAreIslandsOfTheirOwn) {
  // Light limbs beat heavy bodies beside light limbs: what one may pass on to the next must not grow on the way.
  constexpr int kWalkers = 20;
  Crowd s(kWalkers, Rung::Balanced);
  for (int i = 0; i < 90; ++i) {
    s.step();
    ASSERT_EQ(s.mechanics().counters().islands, static_cast<std::uint64_t>(kWalkers))
        << "at " << s.world.time() << " s";
  }
}

}  // namespace
}  // namespace breve::testing
