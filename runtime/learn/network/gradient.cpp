// Backpropagation through time, in chunks of samples: a forward pass that keeps every layer's outputs, then one
// backward.
#include "runtime/learn/network/gradient.hpp"

#include <algorithm>
#include <cmath>

namespace breve::learn {

namespace {

using Index = Eigen::Index;

void resize_all(std::pmr::vector<Numbers>& all, std::size_t count, std::pmr::memory_resource* memory) {
  while (all.size() > count) all.pop_back();
  while (all.size() < count) all.emplace_back(memory);
}

/// Column s of the result is step `step` of sample which[s].
void gather(const Numbers& numbers, Index rows, const Samples& samples, std::span<const std::uint32_t> which,
            Index step, Eigen::Ref<Eigen::MatrixXd> result) {
  const ConstMatrixMap all = numbers.matrix(0, rows, samples.count * samples.steps);
  for (std::size_t s = 0; s < which.size(); ++s)
    result.col(static_cast<Index>(s)) = all.col(static_cast<Index>(which[s]) * samples.steps + step);
}

/// The slope of the part a = 1 - exp(-k) by log tau, divided by a, where k = h / tau: -k / (exp k - 1).
double slope_of_part(double k) {
  if (k == 0) return -1;
  return std::isinf(k) ? 0 : -k / std::expm1(k);
}

std::size_t size_of(Index rows, Index columns) { return static_cast<std::size_t>(rows * columns); }

/// What a trace has of a layer at a step.
MatrixMap traced(const Network& network, std::pmr::vector<Numbers>& trace, std::size_t layer, Index step) {
  Numbers& numbers = trace[static_cast<std::size_t>(step) * network.layers().size() + layer];
  const Index neurons = network.layers()[layer].neurons;
  return numbers.matrix(0, neurons, static_cast<Index>(numbers.size()) / neurons);
}

}  // namespace

Gradient::Gradient(std::pmr::memory_resource* memory)
    : gradient_(memory),
      activity_(memory),
      trace_{std::pmr::vector<Numbers>(memory), std::pmr::vector<Numbers>(memory)},
      by_output_(memory),
      later_(memory),
      potential_(memory),
      drive_(memory) {}

double Gradient::compute(const Network& network, const Samples& samples, std::span<const std::uint32_t> which,
                         const Poll& poll) {
  gradient_.resize(network.parameters().size());
  gradient_.fill(0);
  const auto numbers =
      static_cast<double>(size_of(network.outputs(), samples.steps)) * static_cast<double>(which.size());
  const auto most = static_cast<std::size_t>(network.samples_at_once(samples.steps + 1));
  double sum = 0;
  for (std::size_t begin = 0; begin < which.size(); begin += most) {
    const auto chunk = which.subspan(begin, std::min(most, which.size() - begin));
    forward(network, samples, chunk, poll);
    sum += backward(network, samples, chunk, 2 / numbers, poll);
  }
  return sum / numbers;
}

void Gradient::forward(const Network& network, const Samples& samples, std::span<const std::uint32_t> which,
                       const Poll& poll) {
  const auto count = static_cast<Index>(which.size());
  const std::size_t layers = network.layers().size();
  network.rest(activity_, count);
  const std::size_t kept = layers * static_cast<std::size_t>(samples.steps + 1);
  resize_all(trace_.outputs, kept, network.memory());
  resize_all(trace_.potentials, kept, network.memory());
  const auto record = [&](Index step) {
    const std::size_t at = static_cast<std::size_t>(step) * layers;
    for (std::size_t i = 0; i < layers; ++i) {
      trace_.outputs[at + i] = activity_.outputs[i];
      trace_.potentials[at + i] = activity_.potentials[i];
    }
  };
  record(0);
  Numbers inputs(network.memory(), size_of(network.inputs(), count));
  for (Index step = 0; step < samples.steps; ++step) {
    gather(samples.inputs, network.inputs(), samples, which, step, inputs.matrix(0, network.inputs(), count));
    network.step(activity_, inputs.matrix(0, network.inputs(), count));
    record(step + 1);
    if (poll) poll();
  }
}

double Gradient::backward(const Network& network, const Samples& samples, std::span<const std::uint32_t> which,
                          double scale, const Poll& poll) {
  const auto count = static_cast<Index>(which.size());
  const auto& layers = network.layers();
  for (std::pmr::vector<Numbers>* all : {&by_output_, &later_, &potential_})
    resize_all(*all, layers.size(), network.memory());
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const std::size_t size = size_of(layers[i].neurons, count);
    by_output_[i].resize(size);
    later_[i].resize(layers[i].recurrent() ? size : 0);
    later_[i].fill(0);
    potential_[i].resize(layers[i].kind == LayerKind::ContinuousTime ? size : 0);
    potential_[i].fill(0);
  }
  const std::size_t last = layers.size() - 1;
  double sum = 0;
  for (Index step = samples.steps; step-- > 0;) {
    MatrixMap error = by_output_[last].matrix(0, network.outputs(), count);
    gather(samples.targets, network.outputs(), samples, which, step, error);
    error = traced(network, trace_.outputs, last, step + 1) - error;
    sum += error.squaredNorm();
    error *= scale;
    for (std::size_t i = last; i > 0; --i) back_through(network, i, step, count);
    if (poll) poll();
  }
  return sum;
}

/// From the derivatives by a layer's outputs at one step to those by its parameters, by the outputs of the layer before
/// at this step, and by its own at the step before.
void Gradient::back_through(const Network& network, std::size_t number, Index step, Index count) {
  const Layer& layer = network.layers()[number];
  const Index n = layer.neurons;
  MatrixMap by_output = by_output_[number].matrix(0, n, count);
  if (layer.recurrent()) by_output += later_[number].matrix(0, n, count);
  multiply_by_slope(layer.activation, traced(network, trace_.outputs, number, step + 1),
                    by_output);  // now by the potentials
  drive_ = by_output_[number];
  MatrixMap drive = drive_.matrix(0, n, count);
  if (layer.kind == LayerKind::ContinuousTime) {
    MatrixMap potential = potential_[number].matrix(0, n, count);
    potential += drive;
    const MatrixMap now = traced(network, trace_.potentials, number, step + 1);
    const MatrixMap before = traced(network, trace_.potentials, number, step);
    for (Index k = 0; k < n; ++k) {
      const double rate = network.time_step() * std::exp(-network.log_time_constants(layer)[k]);
      gradient_[layer.time_constants + static_cast<std::size_t>(k)] +=
          slope_of_part(rate) * potential.row(k).dot(now.row(k) - before.row(k));
      drive.row(k) = -std::expm1(-rate) * potential.row(k);
      potential.row(k) *= std::exp(-rate);
    }
  }
  add_product(drive, traced(network, trace_.outputs, number - 1, step + 1).transpose(),
              gradient_.matrix(layer.weights, n, layer.inputs));
  gradient_.matrix(layer.biases, n, 1) += drive.rowwise().sum();
  if (layer.recurrent()) {
    add_product(drive, traced(network, trace_.outputs, number, step).transpose(),
                gradient_.matrix(layer.feedback, n, n));
    MatrixMap later = later_[number].matrix(0, n, count);
    later.setZero();
    add_product(network.feedback(layer).transpose(), drive, later);
  }
  if (number > 1) {  // nobody asks for the derivatives by the inputs
    MatrixMap below = by_output_[number - 1].matrix(0, layer.inputs, count);
    below.setZero();
    add_product(network.weights(layer).transpose(), drive, below);
  }
}

namespace {

/// Calls `visit(outputs, first sample, step)` for chunks of samples, from rest.
template <class Visit>
void run_all(const Network& network, const Samples& samples, const Poll& poll, Visit visit) {
  Activity activity(network.memory());
  const ConstMatrixMap inputs = samples.inputs.matrix(0, network.inputs(), samples.count * samples.steps);
  Numbers chunk(network.memory());
  const Index most = network.samples_at_once();
  for (Index begin = 0; begin < samples.count; begin += most) {
    const Index count = std::min(most, samples.count - begin);
    network.rest(activity, count);
    chunk.resize(size_of(network.inputs(), count));
    MatrixMap input = chunk.matrix(0, network.inputs(), count);
    for (Index step = 0; step < samples.steps; ++step) {
      for (Index s = 0; s < count; ++s) input.col(s) = inputs.col((begin + s) * samples.steps + step);
      network.step(activity, input);
      visit(activity.outputs.back().matrix(0, network.outputs(), count), begin, step);
      if (poll) poll();
    }
  }
}

}  // namespace

double error_of(const Network& network, const Samples& samples, const Poll& poll) {
  const ConstMatrixMap targets = samples.targets.matrix(0, network.outputs(), samples.count * samples.steps);
  double sum = 0;
  run_all(network, samples, poll, [&](const MatrixMap& outputs, Index begin, Index step) {
    for (Index s = 0; s < outputs.cols(); ++s)
      sum += (outputs.col(s) - targets.col((begin + s) * samples.steps + step)).squaredNorm();
  });
  return sum / static_cast<double>(targets.size());
}

void evaluate(const Network& network, const Samples& samples, Numbers& outputs, const Poll& poll) {
  outputs.resize(size_of(network.outputs(), samples.count * samples.steps));
  MatrixMap all = outputs.matrix(0, network.outputs(), samples.count * samples.steps);
  run_all(network, samples, poll, [&](const MatrixMap& some, Index begin, Index step) {
    for (Index s = 0; s < some.cols(); ++s) all.col((begin + s) * samples.steps + step) = some.col(s);
  });
}

}  // namespace breve::learn
