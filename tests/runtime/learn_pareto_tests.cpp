// Several objectives: fronts and crowding against closed forms, operators of variation, and NSGA-II on problems of the
// paper that describes it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>

#include "runtime/base/error.hpp"
#include "runtime/learn/evolution/nsga2.hpp"
#include "tests/runtime/search_images.hpp"

namespace breve::learn {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(Pareto, FrontsAreThoseOfAFigure) {
  //                                  0     1     2     3     4     5     6
  const std::vector<double> numbers = {1, 5, 2, 3, 4, 1, 2, 6, 3, 3, 5, 5, 2, 3};
  const std::vector<std::uint32_t> fronts = sort_fronts({numbers, 2}, {});
  EXPECT_EQ(fronts, (std::vector<std::uint32_t>{0, 0, 0, 1, 1, 2, 0}));
}

/// The fronts by their definition: 1 more than the last front of those that dominate an individual.
std::vector<std::uint32_t> fronts_by_definition(const ObjectiveValues& values) {
  std::vector<std::uint32_t> fronts(values.count());
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t a = 0; a < fronts.size(); ++a)
      for (std::size_t b = 0; b < fronts.size(); ++b)
        if (values.dominates(a, b) && fronts[b] <= fronts[a]) {
          fronts[b] = fronts[a] + 1;
          changed = true;
        }
  }
  return fronts;
}

TEST(Pareto, FrontsAreThoseOfTheirDefinition) {
  Random random(5);
  for (std::size_t objectives = 1; objectives <= 4; ++objectives) {
    std::vector<double> numbers(40 * objectives);
    for (double& number : numbers) number = random.below_or_equal(12);  // with equal ones
    const ObjectiveValues values{numbers, objectives};
    EXPECT_EQ(sort_fronts(values, {}), fronts_by_definition(values));
  }
}

TEST(Pareto, CrowdingIsTheDistanceOfTheNeighborsInEachObjective) {
  const std::vector<double> numbers = {0, 10, 4, 4, 1, 7, 10, 0, 20, 20};
  const ObjectiveValues values{numbers, 2};
  const CrowdedOrder order(values, {});
  EXPECT_EQ(order.distances[0], kInfinite);
  EXPECT_EQ(order.distances[3], kInfinite);
  EXPECT_EQ(order.distances[4], kInfinite);  // alone in its front
  EXPECT_NEAR(order.distances[1], 9.0 / 10 + 7.0 / 10, 1e-15);
  EXPECT_NEAR(order.distances[2], 4.0 / 10 + 6.0 / 10, 1e-15);
  EXPECT_EQ(order.sorted(), (std::vector<std::uint32_t>{0, 3, 1, 2, 4}));
  const std::vector<double> equal(8, 3.0);
  for (const double distance : CrowdedOrder({equal, 2}, {}).distances)
    EXPECT_TRUE(distance == 0 || distance == kInfinite);
}

TEST(Variation, CrossedPairsKeepTheirMeanAndTheSpreadOfTheirDistribution) {
  // Far from bounds, P(spread <= 1) is 1/2, and P(spread <= b) = b^(index + 1) / 2 below it.
  Random random(6);
  const std::vector<double> lowest{-1e6}, highest{1e6};
  constexpr int kPairs = 100'000;
  constexpr double kTolerance = 0.01;  // more than five deviations of a share of 1/2 in half as many draws
  int crossed = 0, nearer = 0, near = 0;
  for (int i = 0; i < kPairs; ++i) {
    std::vector<double> a{1}, b{3};
    simulated_binary_crossover(a, b, {lowest, highest}, 2, random);
    EXPECT_NEAR(a[0] + b[0], 4, 1e-9);
    const double spread = std::abs(a[0] - b[0]) / 2;
    if (spread == 1) continue;
    ++crossed;
    nearer += spread <= 1 ? 1 : 0;
    near += spread <= 0.8 ? 1 : 0;
  }
  EXPECT_NEAR(crossed / double{kPairs}, 0.5, kTolerance);
  EXPECT_NEAR(nearer / double(crossed), 0.5, kTolerance);
  EXPECT_NEAR(near / double(crossed), 0.5 * 0.8 * 0.8 * 0.8, kTolerance);
}

TEST(Variation, MutationHasItsProbabilityAndItsDistribution) {
  // From the middle of 0 to 1, a step has |step| <= d with probability (1 - (1 - d)^(index + 1)) / (1 - (1/2)^(index +
  // 1)).
  Random random(7);
  constexpr std::size_t kNumbers = 100'000;
  constexpr double kIndex = 3, kTolerance = 0.02;
  const std::vector<double> lowest(kNumbers, 0.0), highest(kNumbers, 1.0);
  std::vector<double> numbers(kNumbers, 0.5);
  polynomial_mutation(numbers, {lowest, highest}, 0.3, kIndex, random);
  double changed = 0, small = 0, up = 0;
  for (const double number : numbers) {
    if (number == 0.5) continue;
    ++changed;
    up += number > 0.5 ? 1 : 0;
    small += std::abs(number - 0.5) <= 0.1 ? 1 : 0;
  }
  EXPECT_NEAR(changed / kNumbers, 0.3, kTolerance);
  EXPECT_NEAR(up / changed, 0.5, kTolerance);
  EXPECT_NEAR(small / changed, (1 - std::pow(0.9, kIndex + 1)) / (1 - std::pow(0.5, kIndex + 1)), kTolerance);
}

TEST(Variation, NothingLeavesItsBounds) {
  Random random(8);
  const std::vector<double> lowest{0, -1e300, 5}, highest{1, 1e300, 5 + 1e-9};
  std::vector<double> a{0, -1e300, 5}, b{1, 1e300, 5 + 1e-9};
  for (int i = 0; i < 20'000; ++i) {
    const double index = random.below_or_equal(3) * 300;
    simulated_binary_crossover(a, b, {lowest, highest}, index, random);
    polynomial_mutation(a, {lowest, highest}, 1, index, random);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_TRUE(a[k] >= lowest[k] && a[k] <= highest[k]);
      ASSERT_TRUE(b[k] >= lowest[k] && b[k] <= highest[k]);
    }
  }
}

// --- the problems of Zitzler, Deb and Thiele (2000) ------------------------------------------------------------------

constexpr std::size_t kDimension = 30;
using Point = std::span<const double>;
using Pair = std::pair<double, double>;

double distance_term(Point x) { return 1 + 9 * std::accumulate(x.begin() + 1, x.end(), 0.0) / (kDimension - 1); }
Pair zdt1(Point x) {
  const double g = distance_term(x);
  return {x[0], g * (1 - std::sqrt(x[0] / g))};
}
Pair zdt2(Point x) {
  const double g = distance_term(x);
  return {x[0], g * (1 - (x[0] / g) * (x[0] / g))};
}
Pair zdt3(Point x) {
  const double g = distance_term(x);
  return {x[0], g * (1 - std::sqrt(x[0] / g) - x[0] / g * std::sin(10 * std::numbers::pi * x[0]))};
}

/// About 500 points of the true front, evenly spaced in the first objective: those for g = 1 that none dominates.
std::vector<Pair> true_front(Pair (*problem)(Point)) {
  std::vector<Pair> front;
  double least = kInfinite;
  std::vector<double> x(kDimension, 0.0);
  constexpr int kSteps = 1600;
  for (int i = 0; i <= kSteps; ++i) {
    x[0] = double(i) / kSteps;
    const Pair point = problem(x);
    if (point.second < least) front.push_back(point);
    least = std::min(least, point.second);
  }
  return front;
}

double length(Pair a, Pair b) { return std::hypot(a.first - b.first, a.second - b.second); }

/// The mean distance of the found points to the true front.
double convergence(const std::vector<Pair>& found, const std::vector<Pair>& front) {
  double sum = 0;
  for (const Pair& point : found) {
    double least = kInfinite;
    for (const Pair& other : front) least = std::min(least, length(point, other));
    sum += least;
  }
  return sum / static_cast<double>(found.size());
}

/// The spread of the found points, sorted by their first objective: 0 if they are evenly spaced from end to end.
double spread(const std::vector<Pair>& found, const std::vector<Pair>& front) {
  const double ends = length(found.front(), front.front()) + length(found.back(), front.back());
  std::vector<double> steps;
  for (std::size_t i = 0; i + 1 < found.size(); ++i) steps.push_back(length(found[i], found[i + 1]));
  const double count = static_cast<double>(steps.size());
  const double mean = std::accumulate(steps.begin(), steps.end(), 0.0) / count;
  double deviation = 0;
  for (const double step : steps) deviation += std::abs(step - mean);
  return (ends + deviation) / (ends + count * mean);
}

std::vector<Pair> front_of(Pair (*problem)(Point), std::uint64_t seed) {
  Random random(seed);
  Nsga2 search(std::pmr::get_default_resource());
  search.begin(std::vector<double>(kDimension, 0.0), std::vector<double>(kDimension, 1.0), 2, 100);
  std::vector<double> values;
  for (int generation = 0; generation < 250; ++generation) {
    const auto candidates = search.ask(random, {});
    values.clear();
    for (std::size_t at = 0; at < candidates.size(); at += kDimension) {
      const Pair pair = problem(candidates.subspan(at, kDimension));
      values.insert(values.end(), {pair.first, pair.second});
    }
    search.tell(values, {});
  }
  EXPECT_EQ(search.evaluations(), 25'000U);
  std::vector<Pair> found;
  for (const std::uint32_t at : search.front({}))
    found.emplace_back(search.survivor_values(at)[0], search.survivor_values(at)[1]);
  std::sort(found.begin(), found.end());
  return found;
}

TEST(Nsga2, FrontsAreAsNearAndAsEvenAsThoseOfThePaper) {
  // Means and variances of ten runs with 25,000 evaluations in tables II and III of Deb and others (2002), NSGA-II with
  // real numbers. Each seed here must be as near as their mean, and no more uneven than two deviations above their
  // mean.
  struct Row {
    const char* name;
    Pair (*problem)(Point);
    double distance, spread, variance;
  };
  for (const Row& row : {Row{"ZDT1", zdt1, 0.033482, 0.390307, 0.001876},
                         {"ZDT2", zdt2, 0.072391, 0.430776, 0.004721},
                         {"ZDT3", zdt3, 0.114500, 0.738540, 0.019706}})
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      const std::vector<Pair> found = front_of(row.problem, seed), front = true_front(row.problem);
      EXPECT_LE(convergence(found, front), row.distance) << row.name << " " << seed;
      EXPECT_LE(spread(found, front), row.spread + 2 * std::sqrt(row.variance)) << row.name << " " << seed;
      EXPECT_GE(found.size(), 90U);
    }
}

void advance(Nsga2& search, Random& random) {
  const auto candidates = search.ask(random, {});
  std::vector<double> values;
  for (std::size_t at = 0; at < candidates.size(); at += 2) {
    values.push_back(candidates[at]);
    values.push_back(1 - candidates[at] + candidates[at + 1]);
  }
  search.tell(values, {});
}

TEST(Nsga2, GoesOnFromAnImageAsBefore) {
  Random random(3);
  Nsga2 search(std::pmr::get_default_resource());
  search.begin(std::vector<double>{0, 1}, std::vector<double>{1, 2}, 2, 5);
  search.set_crossover(0.8, 10);
  search.set_mutation(0.4, 15);
  for (int i = 0; i < 10; ++i) advance(search, random);
  search.ask(random, {});
  expect_goes_on_from_image(search, random, advance,
                            [](const Nsga2& forged) { return forged.dimension() == 2 && forged.objectives() == 2; });
}

TEST(Nsga2, WhatMakesNoSenseIsRefused) {
  Random random(4);
  Nsga2 search(std::pmr::get_default_resource());
  const std::vector<double> zero{0}, one{1};
  EXPECT_THROW(search.ask(random, {}), Error);
  EXPECT_THROW(search.set_crossover(0.5, 20), Error);
  EXPECT_THROW(search.begin({}, {}, 2, 10), Error);
  EXPECT_THROW(search.begin(zero, zero, 2, 10), Error);
  EXPECT_THROW(search.begin(zero, std::vector<double>{1, 2}, 2, 10), Error);
  EXPECT_THROW(search.begin(std::vector<double>{-1e308}, std::vector<double>{1.7e308}, 2, 10), Error);
  EXPECT_THROW(search.begin(zero, one, 0, 10), Error);
  EXPECT_THROW(search.begin(zero, one, 2, 3), Error);
  search.begin(zero, one, 2, 4);
  EXPECT_THROW(search.tell(std::vector<double>(8), {}), Error);
  EXPECT_THROW(search.set_mutation(1.1, 20), Error);
  EXPECT_THROW(search.set_mutation(1, std::nan("")), Error);
  search.ask(random, {});
  EXPECT_THROW(search.tell(std::vector<double>(7), {}), Error);
  for (const double value : {std::nan(""), kInfinite, -kInfinite, 0.0}) {
    search.ask(random, {});
    search.tell(std::vector<double>(8, value), {});
  }
  EXPECT_EQ(search.front({}).size(), 4U);  // those with the value of -infinity
  for (const std::uint32_t at : search.front({})) EXPECT_EQ(search.survivor_values(at)[0], -1e300);
}

}  // namespace
}  // namespace breve::learn
