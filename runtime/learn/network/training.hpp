// Training: epochs of mini-batches, in an order that the world's generator draws.
#pragma once

#include "runtime/base/random.hpp"
#include "runtime/learn/network/gradient.hpp"
#include "runtime/learn/network/optimizer.hpp"

namespace breve::learn {

/// Updates of the parameters in an epoch, of `batch` samples each; 0: of all samples.
inline std::uint64_t updates_of(const Samples& samples, std::int32_t batch) {
  const auto count = static_cast<std::uint64_t>(samples.count), size = static_cast<std::uint64_t>(batch);
  return size == 0 || size >= count ? 1 : (count + size - 1) / size;
}

/// One epoch: every sample is used once, in an order that is drawn unless a batch holds all of them.
/// @param gradient  whatever it holds: its memory is used
/// @return the mean squared error, each sample's from before the update that used it
/// @throws Error{Numeric} if training diverges: the parameters are then those before the update that failed
double train_epoch(Network& network, const Samples& samples, Optimizer& optimizer, Gradient& gradient,
                   std::int32_t batch, Random& random, const Poll& poll);

}  // namespace breve::learn
