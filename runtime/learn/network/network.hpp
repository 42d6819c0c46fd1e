// Networks of neurons in layers. Each layer is fully connected with the one before it; a recurrent layer also with its
// own outputs of the step before.
//
// With x the outputs of the layer before, y those of this one, and ' the step before, a layer computes y = f(z) from
//   feed-forward       z = W x + b
//   Elman              z = W x + U y' + b                             (Elman, Finding structure in time, 1990)
//   continuous time    z = z' + a (W x + U y' + b - z'),   a = 1 - exp(-h / tau)
// The last is the network of leaky integrators tau dz/dt = -z + W x + U y + b (Beer, On the dynamics of small
// continuous-time recurrent neural networks, 1995) by the exponential Euler method with time step h: stable for any h,
// and exact where the input of a neuron is constant.
//
// All parameters stand in one array, for optimizers and evolution: layer by layer W (column by column), U, b, log tau.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/poll.hpp"
#include "runtime/base/random.hpp"
#include "runtime/learn/network/activation.hpp"
#include "runtime/learn/network/numbers.hpp"

namespace breve::learn {

enum class LayerKind : std::uint8_t { FeedForward, Elman, ContinuousTime };
constexpr std::uint8_t kLayerKinds = 3;

/// One layer, and where its parameters begin in the array of the network.
struct Layer {
  LayerKind kind = LayerKind::FeedForward;
  Activation activation = Activation::Linear;
  Eigen::Index inputs = 0, neurons = 0;  // no inputs: this is the first layer, which only holds the inputs
  std::size_t weights = 0, feedback = 0, biases = 0, time_constants = 0;

  bool recurrent() const { return kind != LayerKind::FeedForward; }
};

/// What a network remembers between steps, for a batch of samples: one column a sample.
struct Activity {
  explicit Activity(std::pmr::memory_resource* memory) : outputs(memory), potentials(memory) {}
  std::pmr::vector<Numbers> outputs;     // of each layer
  std::pmr::vector<Numbers> potentials;  // z of each layer of continuous time; empty for others
  Eigen::Index samples = 0;
};

class Network {
 public:
  static constexpr std::size_t kMaxParameters = 4'000'000, kMaxLayers = 1000;
  static constexpr Eigen::Index kMaxNeurons = 100'000;  // of a layer

  explicit Network(std::pmr::memory_resource* memory);
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;
  /// Become equal to another. If memory runs out, nothing changes.
  void assign(const Network& other);

  /// Append a layer; the first one holds the inputs, and must be feed-forward. Its weights and biases are 0, its time
  /// constants 1.
  /// @throws Error{Argument} for a size out of range
  void add_layer(LayerKind kind, Eigen::Index neurons, Activation activation);
  /// Weights uniform within sqrt(6 / (inputs + neurons)) (Glorot and Bengio, Understanding the difficulty of training
  /// deep feedforward neural networks, 2010), feedback within sqrt(3 / neurons), biases 0. Time constants stay.
  void randomize(Random& random);

  const std::pmr::vector<Layer>& layers() const { return layers_; }
  Eigen::Index inputs() const { return layers_.empty() ? 0 : layers_.front().neurons; }
  Eigen::Index outputs() const { return layers_.empty() ? 0 : layers_.back().neurons; }
  /// Do both have the same layers?
  bool same_shape(const Network& other) const;
  const Numbers& parameters() const { return parameters_; }
  Numbers& parameters() { return parameters_; }
  double time_step() const { return time_step_; }
  void set_time_step(double step) { time_step_ = step; }  // finite, > 0; initially 1
  std::pmr::memory_resource* memory() const { return parameters_.memory(); }

  ConstMatrixMap weights(const Layer& layer) const {
    return parameters_.matrix(layer.weights, layer.neurons, layer.inputs);
  }
  ConstMatrixMap feedback(const Layer& layer) const {
    return parameters_.matrix(layer.feedback, layer.neurons, layer.neurons);
  }
  ConstVectorMap biases(const Layer& layer) const { return {parameters_.data() + layer.biases, layer.neurons}; }
  ConstVectorMap log_time_constants(const Layer& layer) const {
    return {parameters_.data() + layer.time_constants, layer.neurons};
  }

  /// Room for so many samples; what every recurrent neuron remembers is that of a network at rest: potential 0.
  void rest(Activity& activity, Eigen::Index samples) const;
  /// One step of all samples of `activity`, from `inputs` (one column a sample).
  void step(Activity& activity, const Eigen::Ref<const Eigen::MatrixXd>& inputs) const;
  /// Multiplications of one step of one sample.
  std::uint64_t work() const { return parameters_.size() + neurons_; }
  /// How many samples are computed at once: those whose steps take a millisecond or so each.
  /// @param kept  steps whose outputs are kept, for all samples
  Eigen::Index samples_at_once(Eigen::Index kept = 1) const;
  /// Was `activity` made for the layers that the network has now?
  bool fits(const Activity& activity) const;

  void save(ByteWriter& out) const;
  /// @throws Error{Image} for anything that save does not write
  void load(ByteReader& in);
  void hash(Hasher& hasher) const;

 private:
  std::pmr::vector<Layer> layers_;
  Numbers parameters_;
  std::size_t neurons_ = 0;
  double time_step_ = 1;
};

/// Adds left * right to `sum`. Eigen splits long sums of products by the size of the processor's cache, which would let
/// results differ between machines: shorter ones, as here, it does not split.
void add_product(const Eigen::Ref<const Eigen::MatrixXd>& left, const Eigen::Ref<const Eigen::MatrixXd>& right,
                 Eigen::Ref<Eigen::MatrixXd> sum);

}  // namespace breve::learn
