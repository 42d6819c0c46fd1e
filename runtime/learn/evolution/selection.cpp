// Selection of parents by their fitness.
#include "runtime/learn/evolution/selection.hpp"

#include <algorithm>
#include <numeric>

namespace breve::learn {

void rank_probabilities(std::span<const double> fitness, double pressure, std::span<double> result) {
  const std::size_t count = fitness.size();
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return fitness[a] < fitness[b]; });
  const auto n = static_cast<double>(count);
  for (std::size_t first = 0; first < count;) {
    std::size_t end = first;
    while (end < count && fitness[order[end]] == fitness[order[first]]) ++end;
    const double rank = 0.5 * static_cast<double>(first + end - 1);  // the mean of those that are equally fit
    const double share = count == 1 ? 1 : (2 - pressure) / n + 2 * rank * (pressure - 1) / (n * (n - 1));
    for (; first < end; ++first) result[order[first]] = share;
  }
}

void proportional_probabilities(std::span<const double> fitness, std::span<double> result) {
  if (fitness.empty()) return;
  const auto [least, most] = std::minmax_element(fitness.begin(), fitness.end());
  // Scaled before it is summed: the differences of finite numbers may overflow, but halves do not.
  const double scale = 0.5 * *most - 0.5 * *least;
  double sum = 0;
  for (std::size_t i = 0; i < fitness.size(); ++i) {
    result[i] = scale > 0 ? (0.5 * fitness[i] - 0.5 * *least) / scale : 1;
    sum += result[i];
  }
  for (double& share : result) share /= sum;
}

std::size_t draw_index(std::span<const double> probabilities, Random& random) {
  double left = random.uniform();
  std::size_t last = 0;
  for (std::size_t i = 0; i < probabilities.size(); ++i) {
    if (probabilities[i] <= 0) continue;
    last = i;
    left -= probabilities[i];
    if (left < 0) break;
  }
  return last;
}

}  // namespace breve::learn
