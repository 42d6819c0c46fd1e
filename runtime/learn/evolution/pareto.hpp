// Fronts of individuals that have several values each, all of which are minimised: one dominates another if it is
// nowhere greater and somewhere less. And how crowded they are along a front.
// Source: Deb, Pratap, Agarwal and Meyarivan, A Fast and Elitist Multiobjective Genetic Algorithm: NSGA-II, IEEE
// Transactions on Evolutionary Computation 6 (2002), sections III.A and III.B.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/base/poll.hpp"

namespace breve::learn {

/// Values of some individuals: `objectives` numbers each, one individual after the other. No number is NaN, and the
/// difference of any two is finite: see `comparable`.
struct ObjectiveValues {
  std::span<const double> numbers;
  std::size_t objectives;

  std::size_t count() const { return objectives == 0 ? 0 : numbers.size() / objectives; }
  std::span<const double> of(std::size_t individual) const {
    return numbers.subspan(individual * objectives, objectives);
  }
  bool dominates(std::size_t a, std::size_t b) const;
};

/// A value as the functions here take it: not a number is the greatest, and what is huge is cut off at 1e300.
double comparable(double value);

/// The front of each individual, from 0: none dominates those of front 0, and those of front k are dominated only by
/// individuals of the fronts before. Cost O(M N^2) for M objectives, memory O(N).
std::vector<std::uint32_t> sort_fronts(const ObjectiveValues& values, const Poll& poll);

/// The crowding distance of each individual within its front: the sum over the objectives of the distance between its
/// two neighbours along the front, divided by the range that the front covers; infinite at both ends of a front.
std::vector<double> crowding_distances(const ObjectiveValues& values, std::span<const std::uint32_t> fronts);

/// Fronts and distances of some individuals, and which of two is preferred by them.
struct CrowdedOrder {
  std::vector<std::uint32_t> fronts;
  std::vector<double> distances;

  CrowdedOrder(const ObjectiveValues& values, const Poll& poll)
      : fronts(sort_fronts(values, poll)), distances(crowding_distances(values, fronts)) {}

  /// The earlier front, or the less crowded of the same front.
  bool prefers(std::size_t a, std::size_t b) const {
    return fronts[a] != fronts[b] ? fronts[a] < fronts[b] : distances[a] > distances[b];
  }
  /// All individuals, the preferred ones first; equal ones as they come.
  std::vector<std::uint32_t> sorted() const;
};

}  // namespace breve::learn
