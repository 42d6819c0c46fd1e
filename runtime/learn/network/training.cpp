// Training: epochs of mini-batches.
#include "runtime/learn/network/training.hpp"

#include <algorithm>
#include <numeric>

namespace breve::learn {

double train_epoch(Network& network, const Samples& samples, Optimizer& optimizer, Gradient& gradient,
                   std::int32_t batch, Random& random, const Poll& poll) {
  std::pmr::vector<std::uint32_t> order(static_cast<std::size_t>(samples.count), network.memory());
  std::iota(order.begin(), order.end(), 0U);
  const std::size_t size = batch > 0 ? std::min(static_cast<std::size_t>(batch), order.size()) : order.size();
  if (size < order.size())
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  double error = 0;
  for (std::size_t begin = 0; begin < order.size(); begin += size) {
    const std::span<const std::uint32_t> which(order.data() + begin, std::min(size, order.size() - begin));
    error += gradient.compute(network, samples, which, poll) * static_cast<double>(which.size());
    optimizer.update(network.parameters(), gradient.gradient());
  }
  return error / static_cast<double>(order.size());
}

}  // namespace breve::learn
