// The error of a network on a set of samples, and its gradient with respect to all parameters, by backpropagation
// through time (Werbos, Backpropagation through time: what it does and how to do it, 1990).
#pragma once

#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/learn/network/network.hpp"

namespace breve::learn {

/// Samples for a network: each is a sequence of `steps` steps, which begins at rest. Column s * steps + t of the
/// numbers is step t of sample s.
struct Samples {
  explicit Samples(std::pmr::memory_resource* memory) : inputs(memory), targets(memory) {}
  Numbers inputs, targets;  // targets may be empty where only outputs are wanted
  Eigen::Index count = 0, steps = 1;
};

/// Computes gradients; keeps its memory from one call to the next.
class Gradient {
 public:
  explicit Gradient(std::pmr::memory_resource* memory);

  /// The mean squared error over all outputs, steps and the samples named by `which`. The gradient is then that of this
  /// error.
  double compute(const Network& network, const Samples& samples, std::span<const std::uint32_t> which,
                 const Poll& poll);
  const Numbers& gradient() const { return gradient_; }
  Numbers& gradient() { return gradient_; }

 private:
  /// Outputs and potentials of all layers at rest and after each step: those of layer i at step t stand at t * layers +
  /// i.
  struct Trace {
    std::pmr::vector<Numbers> outputs, potentials;
  };
  void forward(const Network& network, const Samples& samples, std::span<const std::uint32_t> which, const Poll& poll);
  double backward(const Network& network, const Samples& samples, std::span<const std::uint32_t> which, double scale,
                  const Poll& poll);
  void back_through(const Network& network, std::size_t number, Eigen::Index step, Eigen::Index count);

  Numbers gradient_;
  Activity activity_;
  Trace trace_;
  std::pmr::vector<Numbers> by_output_;  // of each layer: derivatives by its outputs at the present step
  std::pmr::vector<Numbers> later_;      // of each recurrent layer: by its outputs, through the step after
  std::pmr::vector<Numbers> potential_;  // of each layer of continuous time: by its potentials, likewise
  Numbers drive_;                        // by W x + U y' + b
};

/// The mean squared error alone.
double error_of(const Network& network, const Samples& samples, const Poll& poll);

/// The outputs of all samples, each from rest: columns as in Samples.
void evaluate(const Network& network, const Samples& samples, Numbers& outputs, const Poll& poll);

/// Multiplications to evaluate samples so often, or to compute their gradient so often.
inline std::uint64_t evaluation_work(const Network& network, const Samples& samples) {
  return network.work() * static_cast<std::uint64_t>(samples.count * samples.steps);
}
inline std::uint64_t gradient_work(const Network& network, const Samples& samples) {
  return 3 * evaluation_work(network, samples);
}

}  // namespace breve::learn
