// Networks of neurons: their layers, and one step of a batch of samples.
#include "runtime/learn/network/network.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "runtime/base/error.hpp"

namespace breve::learn {

void add_product(const Eigen::Ref<const Eigen::MatrixXd>& left, const Eigen::Ref<const Eigen::MatrixXd>& right,
                 Eigen::Ref<Eigen::MatrixXd> sum) {
  constexpr Eigen::Index kAtOnce = 192;  // with the smallest first-level cache, 16 KiB, Eigen splits after 248
  for (Eigen::Index begin = 0; begin < left.cols(); begin += kAtOnce) {
    const Eigen::Index count = std::min(kAtOnce, left.cols() - begin);
    if (sum.cols() == 1)
      sum.col(0).noalias() += left.middleCols(begin, count) * right.col(0).segment(begin, count);
    else
      sum.noalias() += left.middleCols(begin, count) * right.middleRows(begin, count);
  }
}

Network::Network(std::pmr::memory_resource* memory) : layers_(memory), parameters_(memory) {}

void Network::assign(const Network& other) {
  Numbers parameters(memory(), other.parameters_.size());
  parameters = other.parameters_;
  layers_.reserve(other.layers_.size());
  layers_ = other.layers_;
  parameters_ = std::move(parameters);
  neurons_ = other.neurons_;
  time_step_ = other.time_step_;
}

void Network::add_layer(LayerKind kind, Eigen::Index neurons, Activation activation) {
  if (neurons < 1 || neurons > kMaxNeurons)
    throw Error(ErrorCode::Argument, "a layer of " + std::to_string(neurons) + " neurons (must be 1 to " +
                                         std::to_string(kMaxNeurons) + ")");
  if (layers_.size() >= kMaxLayers)
    throw Error(ErrorCode::Argument, "a network has at most " + std::to_string(kMaxLayers) + " layers");
  Layer layer{kind, activation, outputs(), neurons};
  if (layers_.empty() && layer.recurrent())
    throw Error(ErrorCode::Argument, "the first layer holds the inputs: it cannot be recurrent");
  std::size_t end = parameters_.size();
  if (layer.inputs > 0) {
    const auto n = static_cast<std::size_t>(neurons), from = static_cast<std::size_t>(layer.inputs);
    layer.weights = end;
    layer.feedback = layer.weights + n * from;
    layer.biases = layer.feedback + (layer.recurrent() ? n * n : 0);
    layer.time_constants = layer.biases + n;
    end = layer.time_constants + (kind == LayerKind::ContinuousTime ? n : 0);
  }
  if (end > kMaxParameters)
    throw Error(ErrorCode::Argument, "a network has at most " + std::to_string(kMaxParameters) +
                                         " parameters; this layer would make them " + std::to_string(end));
  layers_.reserve(layers_.size() + 1);
  parameters_.resize(end);
  layers_.push_back(layer);
  neurons_ += static_cast<std::size_t>(neurons);
}

void Network::randomize(Random& random) {
  for (const Layer& layer : layers_) {
    if (layer.inputs == 0) continue;
    const auto draw = [&](std::size_t begin, std::size_t end, double bound) {
      for (std::size_t i = begin; i < end; ++i) parameters_[i] = bound * (2 * random.uniform() - 1);
    };
    draw(layer.weights, layer.feedback, std::sqrt(6.0 / static_cast<double>(layer.inputs + layer.neurons)));
    draw(layer.feedback, layer.biases, std::sqrt(3.0 / static_cast<double>(layer.neurons)));
    std::fill(parameters_.begin() + layer.biases, parameters_.begin() + layer.time_constants, 0.0);
  }
}

bool Network::same_shape(const Network& other) const {
  return std::equal(layers_.begin(), layers_.end(), other.layers_.begin(), other.layers_.end(),
                    [](const Layer& a, const Layer& b) {
                      return a.kind == b.kind && a.activation == b.activation && a.neurons == b.neurons;
                    });
}

Eigen::Index Network::samples_at_once(Eigen::Index kept) const {
  constexpr std::uint64_t kWorkAtOnce = 2'000'000, kNumbersAtOnce = 1'000'000, kMost = 256;
  const std::uint64_t numbers = std::max<std::uint64_t>(1, neurons_ * static_cast<std::uint64_t>(kept));
  const std::uint64_t count = std::min(kWorkAtOnce / std::max<std::uint64_t>(1, work()), kNumbersAtOnce / numbers);
  return static_cast<Eigen::Index>(std::clamp<std::uint64_t>(count, 1, kMost));
}

bool Network::fits(const Activity& activity) const {
  if (activity.outputs.size() != layers_.size() || activity.potentials.size() != layers_.size()) return false;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const auto size = static_cast<std::size_t>(layers_[i].neurons * activity.samples);
    const bool continuous = layers_[i].kind == LayerKind::ContinuousTime;
    if (activity.outputs[i].size() != size || activity.potentials[i].size() != (continuous ? size : 0)) return false;
  }
  return true;
}

void Network::rest(Activity& activity, Eigen::Index samples) const {
  activity.samples = samples;
  const auto resize = [&](std::pmr::vector<Numbers>& all) {
    while (all.size() > layers_.size()) all.pop_back();
    while (all.size() < layers_.size()) all.emplace_back(memory());
  };
  resize(activity.outputs);
  resize(activity.potentials);
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    const auto size = static_cast<std::size_t>(layer.neurons * samples);
    const bool continuous = layer.kind == LayerKind::ContinuousTime;
    activity.outputs[i].resize(size);
    activity.outputs[i].fill(0);
    activity.potentials[i].resize(continuous ? size : 0);
    activity.potentials[i].fill(0);
    if (continuous) activate(layer.activation, activity.outputs[i].matrix(0, layer.neurons, samples));
  }
}

void Network::step(Activity& activity, const Eigen::Ref<const Eigen::MatrixXd>& inputs) const {
  const Eigen::Index samples = activity.samples;
  if (layers_.empty()) return;
  activity.outputs[0].matrix(0, layers_[0].neurons, samples) = inputs;
  Numbers before(memory());  // a recurrent layer's outputs of the step before
  for (std::size_t i = 1; i < layers_.size(); ++i) {
    const Layer& layer = layers_[i];
    MatrixMap output = activity.outputs[i].matrix(0, layer.neurons, samples);
    if (layer.recurrent()) before = activity.outputs[i];
    output.colwise() = biases(layer);
    add_product(weights(layer), activity.outputs[i - 1].matrix(0, layer.inputs, samples), output);
    if (layer.recurrent()) add_product(feedback(layer), before.matrix(0, layer.neurons, samples), output);
    if (layer.kind == LayerKind::ContinuousTime) {
      MatrixMap potential = activity.potentials[i].matrix(0, layer.neurons, samples);
      for (Eigen::Index k = 0; k < layer.neurons; ++k) {
        const double part = -std::expm1(-time_step_ * std::exp(-log_time_constants(layer)[k]));
        potential.row(k) += part * (output.row(k) - potential.row(k));
      }
      output = potential;
    }
    activate(layer.activation, output);
  }
}

}  // namespace breve::learn
