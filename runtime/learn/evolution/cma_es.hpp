// The evolution strategy with covariance matrix adaptation, CMA-ES, which minimises a function of n reals. The caller
// asks for candidates, evaluates them as it likes, and tells their values.
// Source: Hansen, The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772v2 (2023), appendix A, with the parameters of
// its table 1, where weights may be negative (active CMA); appendix B.2 for the decomposition.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <span>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/poll.hpp"
#include "runtime/base/random.hpp"
#include "runtime/learn/network/numbers.hpp"

namespace breve::learn {

class CmaEs {
 public:
  static constexpr std::int32_t kMaxDimension = 500, kMaxPopulation = 10'000;
  /// 4 + floor(3 log n)
  static std::int32_t default_population(std::int32_t dimension);

  explicit CmaEs(std::pmr::memory_resource* memory);

  /// Begin a search.
  /// @param mean        where it begins, n finite numbers
  /// @param step        standard deviation of the first candidates, > 0: about a third of the range that is searched
  /// @param population  candidates of a generation, 4 or more; 0: the default
  /// @throws Error{Argument}
  void begin(std::span<const double> mean, double step, std::int32_t population);

  std::int32_t dimension() const { return dimension_; }  // 0 before begin
  std::int32_t population() const { return population_; }
  double step() const { return step_; }
  std::span<const double> mean() const { return {mean_.data(), mean_.size()}; }
  std::uint64_t generation() const { return generation_; }
  std::uint64_t evaluations() const { return generation_ * static_cast<std::uint64_t>(population_); }
  double best_value() const { return best_value_; }  // infinite before the first tell
  std::span<const double> best() const { return {best_.data(), best_.size()}; }

  /// Draw the candidates of a generation: n numbers each, one candidate after the other. They stay until the next ask.
  std::span<const double> ask(Random& random, const Poll& poll);
  /// Adapt to the values of those candidates; less is better. A value that is not a number counts as the worst.
  /// @throws Error{Argument} for another number of values, or before ask
  void tell(std::span<const double> values, const Poll& poll);

  /// Units as for a Meter of one generation.
  std::uint64_t work() const;

  void save(ByteWriter& out) const;
  /// @throws Error{Image} for anything that save does not write
  void load(ByteReader& in);
  void hash(Hasher& hasher) const;

 private:
  struct Weights;
  void resize(std::int32_t dimension, std::int32_t population);
  void adapt(const Weights& weights, std::span<const std::uint32_t> order, const Poll& poll);
  void decompose();

  std::int32_t dimension_ = 0, population_ = 0;
  double step_ = 1;
  bool asked_ = false;
  std::uint64_t generation_ = 0, decomposed_ = 0;  // the generation whose covariance matrix the axes are of
  double best_value_;
  Numbers mean_, step_path_, path_;      // n each
  Numbers covariance_, axes_, lengths_;  // n x n, n x n: its eigenvectors, n: roots of its eigenvalues
  Numbers candidates_;                   // n x population
  Numbers best_;                         // n, or empty
};

}  // namespace breve::learn
