// What evaluating a neural network costs: 64 inputs, 64 neurons of tanh and 8 logistic ones, for one sample and for a
// batch, beside the same matrices driven by Eigen directly. Claim: at most 1.5 times as much CPU time.
// Prints both ratios, each the median of rounds in which the two sides take turns; exits 1 if the claim does not hold.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include "runtime/base/random.hpp"
#include "runtime/learn/network/network.hpp"

namespace {

using breve::learn::Activation;
using breve::learn::LayerKind;
using breve::learn::Network;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kInputs = 64, kHidden = 64, kOutputs = 8;
constexpr int kRounds = 41;
constexpr Index kSamplesARound = 8192;
constexpr double kBound = 1.5;

/// The peer: what one writes with Eigen alone.
struct Plain {
  MatrixXd hidden_weights, output_weights;
  VectorXd hidden_biases, output_biases;
  MatrixXd hidden, output;

  const MatrixXd& evaluate(const MatrixXd& inputs) {
    hidden.noalias() = hidden_weights * inputs;
    hidden.colwise() += hidden_biases;
    hidden = hidden.array().tanh();
    output.noalias() = output_weights * hidden;
    output.colwise() += output_biases;
    output = 1.0 / (1.0 + (-output.array()).exp());
    return output;
  }
};

template <class Work>
double seconds(Index samples, Work work) {
  const std::clock_t start = std::clock();
  for (Index done = 0; done < kSamplesARound; done += samples) work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// The median ratio of CPU times for batches of so many samples; 0 if the results differ.
double measure(const Network& network, Plain& plain, Index samples) {
  const MatrixXd inputs = MatrixXd::Random(kInputs, samples);
  breve::learn::Activity activity(network.memory());
  network.rest(activity, samples);
  network.step(activity, inputs);
  const auto output = activity.outputs.back().matrix(0, kOutputs, samples);
  if (!output.isApprox(plain.evaluate(inputs), 1e-12)) return std::puts("the outputs differ"), 0;
  std::vector<double> ratios;
  double ours = 1e30, theirs = 1e30;
  for (int round = 0; round < kRounds; ++round) {
    const double first = seconds(samples, [&] { network.step(activity, inputs); });
    const double second = seconds(samples, [&] { plain.evaluate(inputs); });
    ratios.push_back(first / second);
    ours = std::min(ours, first);
    theirs = std::min(theirs, second);
  }
  std::nth_element(ratios.begin(), ratios.begin() + kRounds / 2, ratios.end());
  const double ratio = ratios[kRounds / 2], scale = 1e9 / static_cast<double>(kSamplesARound);
  std::printf("networks: %3d samples at a time: %.0f ns a sample, Eigen %.0f ns; ratio %.2f (at most %.1f)\n",
              static_cast<int>(samples), ours * scale, theirs * scale, ratio, kBound);
  return ratio;
}

}  // namespace

int main() {
  Network network(std::pmr::get_default_resource());
  network.add_layer(LayerKind::FeedForward, kInputs, Activation::Linear);
  network.add_layer(LayerKind::FeedForward, kHidden, Activation::Tanh);
  network.add_layer(LayerKind::FeedForward, kOutputs, Activation::Logistic);
  breve::Random random(1);
  network.randomize(random);
  const auto& hidden = network.layers()[1];
  const auto& output = network.layers()[2];
  Plain plain{network.weights(hidden), network.weights(output), network.biases(hidden), network.biases(output), {}, {}};
  bool holds = true;
  for (const Index samples : {Index{1}, Index{16}, Index{256}}) {
    const double ratio = measure(network, plain, samples);
    holds = holds && ratio > 0 && ratio <= kBound;
  }
  return holds ? 0 : 1;
}
