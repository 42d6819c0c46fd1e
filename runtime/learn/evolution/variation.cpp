// Simulated binary crossover and polynomial mutation.
#include "runtime/learn/evolution/variation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace breve::learn {

namespace {

constexpr double kLeastDifference = 1e-14;  // parents nearer than this have children like themselves

/// The spread of children, as a multiple of that of their parents, where `room` is the distance to the bound on their
/// side in units of the difference of the parents.
double spread(double draw, double room, double index) {
  const double alpha = 2 - std::pow(1 + 2 * room, -(index + 1));
  const double base = draw * alpha <= 1 ? draw * alpha : 1 / (2 - draw * alpha);
  return std::pow(base, 1 / (index + 1));
}

}  // namespace

void simulated_binary_crossover(std::span<double> first, std::span<double> second, const Box& box, double index,
                                Random& random) {
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (random.uniform() > 0.5) continue;
    const auto [low, high] = std::minmax({first[i], second[i]});
    const double difference = high - low, mean = 0.5 * low + 0.5 * high;
    if (difference <= kLeastDifference) continue;
    const double draw = random.uniform();
    const double below = spread(draw, (low - box.lowest[i]) / difference, index);
    const double above = spread(draw, (box.highest[i] - high) / difference, index);
    first[i] = std::clamp(mean - 0.5 * below * difference, box.lowest[i], box.highest[i]);
    second[i] = std::clamp(mean + 0.5 * above * difference, box.lowest[i], box.highest[i]);
    if (random.uniform() <= 0.5) std::swap(first[i], second[i]);
  }
}

void polynomial_mutation(std::span<double> numbers, const Box& box, double probability, double index, Random& random) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (random.uniform() > probability) continue;
    const double range = box.highest[i] - box.lowest[i], draw = random.uniform();
    const double to_bound = (draw <= 0.5 ? numbers[i] - box.lowest[i] : box.highest[i] - numbers[i]) / range;
    const double half = draw <= 0.5 ? 2 * draw : 2 * (1 - draw);
    const double step = 1 - std::pow(half + (1 - half) * std::pow(1 - to_bound, index + 1), 1 / (index + 1));
    numbers[i] = std::clamp(numbers[i] + (draw <= 0.5 ? -step : step) * range, box.lowest[i], box.highest[i]);
  }
}

}  // namespace breve::learn
