// Selection against closed forms; CMA-ES on the functions of its authors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory_resource>
#include <numeric>

#include "runtime/base/error.hpp"
#include "runtime/learn/evolution/cma_es.hpp"
#include "runtime/learn/evolution/selection.hpp"
#include "tests/runtime/search_images.hpp"

namespace breve::learn {
namespace {

constexpr int kDraws = 200'000;
constexpr double kDrawsTolerance = 0.006;  // five deviations of a share of 1/2 in so many draws

std::vector<double> shares_of(std::size_t count, const std::function<std::size_t()>& draw) {
  std::vector<double> shares(count);
  for (int i = 0; i < kDraws; ++i) shares[draw()] += 1.0 / kDraws;
  return shares;
}

TEST(Selection, LinearRankingHasItsProbabilities) {
  const std::vector<double> fitness = {7, -3, 100, 7};
  std::vector<double> shares(4);
  rank_probabilities(fitness, 1.8, shares);
  EXPECT_NEAR(shares[2], 1.8 / 4, 1e-15);
  EXPECT_NEAR(shares[1], 0.2 / 4, 1e-15);
  EXPECT_NEAR(shares[0], 1.0 / 4, 1e-15);  // the two in the middle share their ranks
  EXPECT_NEAR(shares[3], 1.0 / 4, 1e-15);
  rank_probabilities(fitness, 1, shares);
  for (const double share : shares) EXPECT_NEAR(share, 0.25, 1e-15);
  const std::vector<double> one = {5};
  rank_probabilities(one, 2, std::span(shares).first(1));
  EXPECT_EQ(shares[0], 1);
}

TEST(Selection, ProportionalSharesAreThoseOfTheFitnessAboveTheLeast) {
  std::vector<double> shares(3);
  proportional_probabilities(std::vector<double>{-1, 2, 0}, shares);
  EXPECT_NEAR(shares[0], 0, 1e-15);
  EXPECT_NEAR(shares[1], 0.75, 1e-15);
  EXPECT_NEAR(shares[2], 0.25, 1e-15);
  proportional_probabilities(std::vector<double>{4, 4, 4}, shares);
  for (const double share : shares) EXPECT_NEAR(share, 1.0 / 3, 1e-15);
  proportional_probabilities(std::vector<double>{-1.7e308, 1.7e308, 0}, shares);
  EXPECT_NEAR(shares[1], 2.0 / 3, 1e-12);
}

TEST(Selection, DrawsHaveTheProbabilities) {
  Random random(2);
  const std::vector<double> probabilities = {0.5, 0, 0.2, 0.3};
  const auto shares = shares_of(4, [&] { return draw_index(probabilities, random); });
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(shares[i], probabilities[i], kDrawsTolerance);
  EXPECT_EQ(shares[1], 0);
}

constexpr std::size_t kDimension = 10;
using Point = std::span<const double>;

double sphere(Point x) { return std::inner_product(x.begin(), x.end(), x.begin(), 0.0); }
double ellipsoid(Point x) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += std::pow(1e6, static_cast<double>(i) / (kDimension - 1)) * x[i] * x[i];
  return sum;
}
/// The ellipsoid in a frame that mixes all coordinates: the reflection at the diagonal.
double reflected(Point x) {
  const double sum = std::accumulate(x.begin(), x.end(), 0.0);
  std::vector<double> y(x.begin(), x.end());
  for (double& number : y) number -= 2 * sum / kDimension;
  return ellipsoid(y);
}
double rosenbrock(Point x) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i)
    sum += 100 * std::pow(x[i] * x[i] - x[i + 1], 2) + std::pow(x[i] - 1, 2);
  return sum;
}

/// Evaluations until a value of 1e-9 is found; 0 if it is not.
std::uint64_t evaluations(double (*function)(Point), double start, std::uint64_t seed, std::uint64_t most) {
  Random random(seed);
  CmaEs search(std::pmr::get_default_resource());
  search.begin(std::vector<double>(kDimension, start), 0.5, 0);
  while (search.evaluations() < most && search.best_value() > 1e-9) {
    const auto candidates = search.ask(random, {});
    std::vector<double> values;
    for (std::size_t at = 0; at < candidates.size(); at += kDimension)
      values.push_back(function(candidates.subspan(at, kDimension)));
    search.tell(values, {});
  }
  return search.best_value() <= 1e-9 ? search.evaluations() : 0;
}

TEST(CmaEs, FindsTheMinimaOfItsAuthorsFunctions) {
  // 51 seeds take 1,320 to 1,720, 3,730 to 4,550 and 4,590 to about 7,000 evaluations; Rosenbrock's function has a
  // second minimum, which one of 51 seeds finds. The Python package cmaes 0.9.1, another implementation of the
  // tutorial, takes 1,330 to 1,730, 3,710 to 4,940 and 4,520 to 6,180 from the same starts, with medians of 1,500,
  // 4,190 and 5,130.
  struct Row {
    double (*function)(Point);
    double start;
    std::uint64_t most;
  };
  for (const Row& row : {Row{sphere, 1, 1900}, {ellipsoid, 1, 5000}, {reflected, 1, 5000}, {rosenbrock, 0, 8000}})
    for (std::uint64_t seed = 1; seed <= 3; ++seed) EXPECT_GT(evaluations(row.function, row.start, seed, row.most), 0U);
}

/// Counts the bytes that are taken.
class Counter final : public std::pmr::memory_resource {
 public:
  std::size_t most = 0;

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    taken_ += bytes;
    most = std::max(most, taken_);
    return std::pmr::new_delete_resource()->allocate(bytes, alignment);
  }
  void do_deallocate(void* p, std::size_t bytes, std::size_t alignment) override {
    taken_ -= bytes;
    std::pmr::new_delete_resource()->deallocate(p, bytes, alignment);
  }
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }
  std::size_t taken_ = 0;
};

TEST(CmaEs, TakesWhatGrowsWithThePopulationFromItsMemory) {
  constexpr std::size_t kWide = 20, kMany = 2000;
  Counter counter;
  CmaEs search(&counter);
  Random random(1);
  search.begin(std::vector<double>(kWide, 1), 0.5, kMany);
  search.ask(random, {});
  const std::size_t before = counter.most;
  search.tell(std::vector<double>(kMany, 1), {});
  EXPECT_GE(counter.most, before + kWide * kMany * sizeof(double));
}

TEST(CmaEs, GoesOnFromAnImageAsBefore) {
  Random random(3);
  CmaEs search(std::pmr::get_default_resource());
  search.begin(std::vector<double>{1, 2, 3}, 0.5, 6);
  const auto tell = [](CmaEs& to, Random& draws) {
    const auto candidates = to.ask(draws, {});
    std::vector<double> values;
    for (std::size_t at = 0; at < candidates.size(); at += 3) values.push_back(sphere(candidates.subspan(at, 3)));
    to.tell(values, {});
  };
  for (int i = 0; i < 10; ++i) tell(search, random);
  search.ask(random, {});
  expect_goes_on_from_image(search, random, tell, [](const CmaEs& forged) { return forged.dimension() == 3; });
}

TEST(CmaEs, ValuesWithoutSenseDoNoHarm) {
  Random random(4);
  CmaEs search(std::pmr::get_default_resource());
  EXPECT_THROW(search.ask(random, {}), Error);
  EXPECT_THROW(search.begin({}, 1, 0), Error);
  EXPECT_THROW(search.begin(std::vector<double>{1}, 0, 0), Error);
  EXPECT_THROW(search.begin(std::vector<double>{1}, 1, 3), Error);
  search.begin(std::vector<double>{1, 1}, 0.5, 6);
  EXPECT_THROW(search.tell(std::vector<double>(6), {}), Error);
  for (const double value : {std::nan(""), HUGE_VAL, -HUGE_VAL, 0.0})
    for (int i = 0; i < 500; ++i) {
      search.ask(random, {});
      search.tell(std::vector<double>(6, value), {});
    }
  search.ask(random, {});
  EXPECT_THROW(search.tell(std::vector<double>(5), {}), Error);
}

}  // namespace
}  // namespace breve::learn
