// The generator against its published words, and its distributions against their moments.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "runtime/base/random.hpp"

namespace breve {
namespace {

TEST(RandomNumbers, FollowThePublishedGenerator) {
  // xoshiro256** seeded by splitmix64(0): the first words of the authors' reference code.
  Random r(0);
  EXPECT_EQ(r.next(), 0x99ec5f36cb75f2b4ULL);
  EXPECT_EQ(r.next(), 0xbf6e1f784956452aULL);
}

TEST(RandomNumbers, IntegersReachBothEndsAndAreNotBiased) {
  Random r(3);
  int counts[6] = {};
  for (int i = 0; i < 60000; ++i) ++counts[r.below_or_equal(5)];
  double chi = 0;
  for (const int c : counts) chi += (c - 10000.0) * (c - 10000.0) / 10000.0;
  EXPECT_LT(chi, 20.5);  // 5 degrees of freedom, p = 0.001
  EXPECT_EQ(r.below_or_equal(-4), 0);
  EXPECT_EQ(r.below_or_equal(0), 0);
}

TEST(RandomNumbers, DistributionsHaveTheirMeansAndVariances) {
  Random r(7);
  constexpr int kDraws = 200000;
  const struct {
    const char* name;
    std::function<double()> draw;
    double mean, variance;
  } cases[] = {{"uniform", [&] { return r.uniform(); }, 0.5, 1.0 / 12},
               {"gauss", [&] { return r.gauss(); }, 0, 1},
               {"exponential", [&] { return r.exponential(); }, 1, 1},
               {"gamma 3", [&] { return r.gamma(3); }, 3, 3},
               {"gamma 50", [&] { return r.gamma(50); }, 50, 50}};
  for (const auto& c : cases) {
    double sum = 0, squares = 0;
    for (int i = 0; i < kDraws; ++i) {
      const double x = c.draw();
      sum += x;
      squares += x * x;
    }
    const double mean = sum / kDraws;
    const double variance = squares / kDraws - mean * mean;
    EXPECT_NEAR(mean, c.mean, 5 * std::sqrt(c.variance / kDraws)) << c.name;
    EXPECT_NEAR(variance, c.variance, 0.03 * c.variance) << c.name;
  }
  EXPECT_THROW(r.gamma(0), Error);
}

TEST(RandomNumbers, TheCoarseModeHasThirtyTwoThousandStepsAndReachesBothEnds) {
  Random r(1);
  r.set_coarse(true);
  bool low = false, high = false;
  for (int i = 0; i < 1000000; ++i) {
    const double x = r.uniform() * 32767;
    EXPECT_NEAR(x, std::round(x), 1e-9);
    low = low || x == 0;
    high = high || x == 32767;
  }
  EXPECT_TRUE(low && high);
}

}  // namespace
}  // namespace breve
