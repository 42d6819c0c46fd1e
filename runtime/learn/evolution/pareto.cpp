// Non-dominated sorting and crowding distances.
#include "runtime/learn/evolution/pareto.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace breve::learn {

namespace {

/// Adds to the distances of one front, whose individuals are given, in any order.
void add_distances(const ObjectiveValues& values, std::span<std::uint32_t> front, std::span<double> distances) {
  for (std::size_t objective = 0; objective < values.objectives; ++objective) {
    const auto value = [&](std::size_t at) { return values.of(front[at])[objective]; };
    std::stable_sort(front.begin(), front.end(), [&](std::uint32_t a, std::uint32_t b) {
      return values.of(a)[objective] < values.of(b)[objective];
    });
    distances[front.front()] = distances[front.back()] = std::numeric_limits<double>::infinity();
    const double range = value(front.size() - 1) - value(0);
    if (range == 0) continue;
    for (std::size_t i = 1; i + 1 < front.size(); ++i) distances[front[i]] += (value(i + 1) - value(i - 1)) / range;
  }
}

}  // namespace

double comparable(double value) {
  constexpr double kMost = 1e300;
  return std::isnan(value) ? kMost : std::clamp(value, -kMost, kMost);
}

bool ObjectiveValues::dominates(std::size_t a, std::size_t b) const {
  const std::span<const double> first = of(a), second = of(b);
  bool less = false;
  for (std::size_t i = 0; i < objectives; ++i) {
    if (first[i] > second[i]) return false;
    less = less || first[i] < second[i];
  }
  return less;
}

std::vector<std::uint32_t> sort_fronts(const ObjectiveValues& values, const Poll& poll) {
  const std::size_t count = values.count();
  std::vector<std::uint32_t> fronts(count), dominators(count), left(count);
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) dominators[b] += values.dominates(a, b) ? 1U : 0U;
    if (poll) poll();
  }
  std::iota(left.begin(), left.end(), 0U);
  for (std::uint32_t front = 0; !left.empty(); ++front) {
    // The paper keeps a list of those that each one dominates. Comparing each pair once more needs no such memory.
    const auto begin = std::stable_partition(left.begin(), left.end(), [&](auto at) { return dominators[at] != 0; });
    for (auto member = begin; member != left.end(); ++member) {
      fronts[*member] = front;
      for (auto other = left.begin(); other != begin; ++other)
        dominators[*other] -= values.dominates(*member, *other) ? 1U : 0U;
      if (poll) poll();
    }
    left.erase(begin, left.end());
  }
  return fronts;
}

std::vector<double> crowding_distances(const ObjectiveValues& values, std::span<const std::uint32_t> fronts) {
  std::vector<double> distances(fronts.size());
  std::vector<std::uint32_t> order(fronts.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return fronts[a] < fronts[b]; });
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first;
    while (end < order.size() && fronts[order[end]] == fronts[order[first]]) ++end;
    add_distances(values, std::span(order).subspan(first, end - first), distances);
    first = end;
  }
  return distances;
}

std::vector<std::uint32_t> CrowdedOrder::sorted() const {
  std::vector<std::uint32_t> order(fronts.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return prefers(a, b); });
  return order;
}

}  // namespace breve::learn
