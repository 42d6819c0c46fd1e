// NSGA-II, which minimises several functions of n reals at once: it approaches the front of those vectors that no other
// one dominates. The caller asks for candidates, evaluates them as it likes, and tells their values.
// Source: Deb, Pratap, Agarwal and Meyarivan, A Fast and Elitist Multiobjective Genetic Algorithm: NSGA-II, IEEE
// Transactions on Evolutionary Computation 6 (2002), section III. Distances of crowding are those among the survivors.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/poll.hpp"
#include "runtime/base/random.hpp"
#include "runtime/learn/evolution/pareto.hpp"
#include "runtime/learn/evolution/variation.hpp"
#include "runtime/learn/network/numbers.hpp"

namespace breve::learn {

class Nsga2 {
 public:
  static constexpr std::int32_t kMaxDimension = 1000, kMaxObjectives = 100, kMaxPopulation = 10'000;
  static constexpr double kMaxIndex = 1000;

  explicit Nsga2(std::pmr::memory_resource* memory);

  /// Begin a search in a box. Operators are as in the paper: crossover of 0.9 of the pairs, mutation of 1/n of the
  /// numbers, both with index 20.
  /// @param lowest, highest  n finite numbers each, with a finite difference > 0
  /// @param objectives       values of each candidate, 1 to kMaxObjectives
  /// @param population       candidates of a generation, 4 to kMaxPopulation
  /// @throws Error{Argument}
  void begin(std::span<const double> lowest, std::span<const double> highest, std::int32_t objectives,
             std::int32_t population);
  /// @param probability 0 to 1, of a pair of parents to be crossed
  /// @param index       0 to kMaxIndex
  /// @throws Error{Argument}, also before begin
  void set_crossover(double probability, double index);
  /// @param probability 0 to 1, of each number to be changed
  void set_mutation(double probability, double index);

  std::int32_t dimension() const { return dimension_; }  // 0 before begin
  std::int32_t objectives() const { return objectives_; }
  std::int32_t population() const { return population_; }
  std::uint64_t generation() const { return generation_; }
  std::uint64_t evaluations() const { return generation_ * static_cast<std::uint64_t>(population_); }

  /// Draw the candidates of a generation, the first of them uniformly: n numbers each, one candidate after the other.
  /// They stay until the next ask.
  std::span<const double> ask(Random& random, const Poll& poll);
  /// Keep the better half of the former survivors and these candidates. A value that is not a number is the worst.
  /// @param values  of the candidates, `objectives` for each, one candidate after the other; less is better
  /// @throws Error{Argument} for another number of values, or before ask
  void tell(std::span<const double> values, const Poll& poll);

  /// The survivors, and which of them none dominates.
  std::span<const double> survivor(std::size_t at) const { return row(survivors_, at, dimension_); }
  std::span<const double> survivor_values(std::size_t at) const { return row(values_, at, objectives_); }
  std::vector<std::uint32_t> front(const Poll& poll) const;

  /// Units as for a Meter of one ask and tell.
  std::uint64_t work() const;

  void save(ByteWriter& out) const;
  /// @throws Error{Image} for anything that save does not write
  void load(ByteReader& in);
  void hash(Hasher& hasher) const;

 private:
  struct Operator {
    double probability, index;
  };
  static std::span<const double> row(const Numbers& numbers, std::size_t at, std::int32_t length) {
    const auto size = static_cast<std::size_t>(length);
    return {numbers.data() + at * size, size};
  }
  Operator checked(const char* name, double probability, double index) const;
  ObjectiveValues values() const { return {{values_.data(), values_.size()}, static_cast<std::size_t>(objectives_)}; }
  Box box() const { return {{lowest_.data(), lowest_.size()}, {highest_.data(), highest_.size()}}; }
  void breed(Random& random, const Poll& poll);
  void load_numbers(ByteReader& in, std::size_t n, std::size_t m, std::size_t size);

  std::int32_t dimension_ = 0, objectives_ = 0, population_ = 0;
  Operator crossover_{0.9, 20}, mutation_{0, 20};
  bool asked_ = false;
  std::uint64_t generation_ = 0;
  Numbers lowest_, highest_;    // n each
  Numbers candidates_;          // n x population
  Numbers survivors_, values_;  // n x population and objectives x population, or empty before the first tell
};

}  // namespace breve::learn
