// Neural networks: gradients against finite differences, closed forms, what training learns, forged images.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "runtime/base/error.hpp"
#include "runtime/learn/network/training.hpp"

namespace breve::learn {
namespace {

std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }

void make(Network& network, std::initializer_list<Eigen::Index> sizes, LayerKind kind, Activation hidden,
          Activation last) {
  std::size_t number = 0;
  for (const Eigen::Index size : sizes) {
    const bool first = number == 0, is_last = ++number == sizes.size();
    network.add_layer(first || is_last ? LayerKind::FeedForward : kind, size, is_last ? last : hidden);
  }
}

Samples random_samples(const Network& network, Eigen::Index count, Eigen::Index steps, Random& random) {
  Samples samples(memory());
  samples.count = count;
  samples.steps = steps;
  samples.inputs.resize(static_cast<std::size_t>(network.inputs() * count * steps));
  samples.targets.resize(static_cast<std::size_t>(network.outputs() * count * steps));
  for (double& x : samples.inputs) x = random.gauss();
  for (double& x : samples.targets) x = random.gauss();
  return samples;
}

double train(Network& network, const Samples& samples, Optimizer& optimizer, int epochs, std::int32_t batch,
             Random& random) {
  Gradient gradient(memory());
  double error = 0;
  for (int epoch = 0; epoch < epochs; ++epoch)
    error = train_epoch(network, samples, optimizer, gradient, batch, random, {});
  return error;
}

TEST(Network, GradientsEqualFiniteDifferencesForEveryLayerAndActivation) {
  constexpr double kStep = 1e-5, kTolerance = 1e-6;
  Random random(3);
  for (std::uint8_t kind = 0; kind < kLayerKinds; ++kind)
    for (std::uint8_t activation = 0; activation < kActivations; ++activation) {
      SCOPED_TRACE("activation " + std::to_string(activation) + ", layer " + std::to_string(kind));
      Network network(memory());
      network.add_layer(LayerKind::FeedForward, 3, Activation::Linear);
      network.add_layer(static_cast<LayerKind>(kind), 5, static_cast<Activation>(activation));
      network.add_layer(LayerKind::FeedForward, 4, Activation::Softplus);
      network.add_layer(static_cast<LayerKind>(kind), 2, static_cast<Activation>(activation));
      network.set_time_step(0.3);
      network.randomize(random);
      for (double& parameter : network.parameters()) parameter += 0.1 * random.gauss();
      const Samples samples = random_samples(network, 7, 6, random);
      std::vector<std::uint32_t> all(7);
      std::iota(all.begin(), all.end(), 0U);
      Gradient gradient(memory());
      EXPECT_NEAR(gradient.compute(network, samples, all, {}), error_of(network, samples, {}), 1e-12);
      for (std::size_t i = 0; i < network.parameters().size(); ++i) {
        double& parameter = network.parameters()[i];
        const double here = parameter;
        parameter = here + kStep;
        const double above = error_of(network, samples, {});
        parameter = here - kStep;
        const double below = error_of(network, samples, {});
        parameter = here;
        EXPECT_NEAR(gradient.gradient()[i], (above - below) / (2 * kStep), kTolerance) << "parameter " << i;
      }
    }
}

TEST(Network, ChunksOfSamplesAddUpToTheGradientOfAll) {
  Random random(5);
  Network network(memory());
  make(network, {3, 4, 2}, LayerKind::Elman, Activation::Tanh, Activation::Linear);
  network.randomize(random);
  const Samples samples = random_samples(network, 700, 2, random);  // more than are computed at once
  ASSERT_LT(network.samples_at_once(3), samples.count);
  std::vector<std::uint32_t> some(700);
  std::iota(some.begin(), some.end(), 0U);
  Gradient all(memory()), part(memory());
  all.compute(network, samples, some, {});
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(network.parameters().size()));
  for (std::uint32_t i = 0; i < 700; i += 7) {
    part.compute(network, samples, std::span(some).subspan(i, 7), {});
    sum += part.gradient().vector() / 100;
  }
  EXPECT_LT((sum - all.gradient().vector()).norm(), 1e-12);
}

TEST(Network, LongSumsAreThoseOfPlainArithmetic) {
  Random random(9);
  Network network(memory());
  make(network, {1000, 3}, LayerKind::FeedForward, Activation::Linear, Activation::Linear);
  network.randomize(random);
  const Samples samples = random_samples(network, 5, 1, random);
  Numbers outputs(memory());
  evaluate(network, samples, outputs, {});
  for (std::size_t s = 0; s < 5; ++s)
    for (std::size_t k = 0; k < 3; ++k) {
      double sum = 0;
      for (std::size_t j = 0; j < 1000; ++j) sum += network.parameters()[3 * j + k] * samples.inputs[1000 * s + j];
      EXPECT_NEAR(outputs[3 * s + k], sum, 1e-12);
    }
}

/// dz/dt = (-z + w z + I) / tau of a linear neuron with feedback w has z = I / (1 - w) (1 - exp(-(1 - w) t / tau)).
double leaky_error(int steps) {
  constexpr double kFeedback = 0.5, kTau = 0.7, kInput = 2, kTime = 1;
  Network network(memory());
  network.add_layer(LayerKind::FeedForward, 1, Activation::Linear);
  network.add_layer(LayerKind::ContinuousTime, 1, Activation::Linear);
  network.parameters()[0] = 1;
  network.parameters()[1] = kFeedback;
  network.parameters()[3] = std::log(kTau);
  network.set_time_step(kTime / steps);
  Activity activity(memory());
  network.rest(activity, 1);
  const Eigen::MatrixXd input = Eigen::MatrixXd::Constant(1, 1, kInput);
  for (int step = 0; step < steps; ++step) network.step(activity, input);
  const double exact = kInput / (1 - kFeedback) * (1 - std::exp(-(1 - kFeedback) * kTime / kTau));
  return std::abs(activity.outputs.back()[0] - exact);
}

TEST(Network, ContinuousTimeConvergesToTheDifferentialEquation) {
  EXPECT_LT(leaky_error(1000), 1e-3);
  EXPECT_NEAR(leaky_error(1000) / leaky_error(2000), 2, 0.02);  // the method is of first order
}

TEST(Network, AConstantDriveIsExactAtAnyStep) {
  Network network(memory());
  network.add_layer(LayerKind::FeedForward, 1, Activation::Linear);
  network.add_layer(LayerKind::ContinuousTime, 1, Activation::Linear);
  network.parameters()[0] = 1;
  network.set_time_step(3);  // three time constants: explicit Euler would overshoot
  Activity activity(memory());
  network.rest(activity, 1);
  network.step(activity, Eigen::MatrixXd::Constant(1, 1, 2.0));
  EXPECT_NEAR(activity.outputs.back()[0], 2 * (1 - std::exp(-3.0)), 1e-15);
}

TEST(Network, EveryOptimizerLearnsExclusiveOr) {
  struct Row {
    OptimizerKind kind;
    double rate;
  };
  for (const Row& row :
       {Row{OptimizerKind::GradientDescent, 2}, {OptimizerKind::Momentum, 0.3}, {OptimizerKind::Adam, 0.05}})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Random random(seed);
      Network network(memory());
      make(network, {2, 4, 1}, LayerKind::FeedForward, Activation::Tanh, Activation::Logistic);
      network.randomize(random);
      Samples samples = random_samples(network, 4, 1, random);
      for (std::size_t i = 0; i < 4; ++i) {
        samples.inputs[2 * i] = static_cast<double>(i & 1);
        samples.inputs[2 * i + 1] = static_cast<double>(i >> 1);
        samples.targets[i] = static_cast<double>((i & 1) ^ (i >> 1));
      }
      Optimizer optimizer(memory());
      optimizer.set_kind(row.kind);
      optimizer.rate = row.rate;
      EXPECT_LT(train(network, samples, optimizer, 1000, 0, random), 0.01)
          << static_cast<int>(row.kind) << ", seed " << seed;
    }
}

/// The two spirals of Lang and Witbrock (Learning to tell two spirals apart, 1988): 97 points each, three rotations.
Samples two_spirals() {
  constexpr std::size_t kPoints = 97;
  Samples samples(memory());
  samples.count = 2 * kPoints;
  samples.inputs.resize(4 * kPoints);
  samples.targets.resize(2 * kPoints);
  for (std::size_t i = 0; i < 2 * kPoints; ++i) {
    const auto point = static_cast<double>(i / 2);
    const double angle = point * std::numbers::pi / 16, sign = i % 2 == 0 ? 1 : -1;
    const double radius = sign * 6.5 * (104 - point) / 104;
    samples.inputs[2 * i] = radius * std::sin(angle);
    samples.inputs[2 * i + 1] = radius * std::cos(angle);
    samples.targets[i] = sign;
  }
  return samples;
}

/// How many points of two_spirals have an output of the wrong sign.
int wrong_points(const Network& network, const Samples& samples) {
  Numbers outputs(memory());
  evaluate(network, samples, outputs, {});
  int wrong = 0;
  for (std::size_t i = 0; i < outputs.size(); ++i) wrong += outputs[i] * samples.targets[i] > 0 ? 0 : 1;
  return wrong;
}

TEST(Network, TellsTwoSpiralsApart) {
  constexpr int kMostEpochs = 2500, kEpochs = 100;  // of ten seeds eight take 1,000 to 1,800; two keep one point wrong
  const Samples samples = two_spirals();
  Random random(6);
  Network network(memory());
  make(network, {2, 32, 32, 1}, LayerKind::FeedForward, Activation::Tanh, Activation::Tanh);
  network.randomize(random);
  Optimizer optimizer(memory());
  for (int epoch = 0; epoch < kMostEpochs && wrong_points(network, samples) > 0; epoch += kEpochs)
    train(network, samples, optimizer, kEpochs, 0, random);
  EXPECT_EQ(wrong_points(network, samples), 0);
}

TEST(Network, RecurrentLayersLearnADelayedEcho) {
  constexpr std::size_t kDelay = 3, kSteps = 12, kCount = 60;
  for (const LayerKind kind : {LayerKind::Elman, LayerKind::ContinuousTime}) {
    Random random(1);
    Network network(memory());
    make(network, {1, 10, 1}, kind, Activation::Tanh, Activation::Linear);
    network.randomize(random);
    const auto echo = [&] {
      Samples samples = random_samples(network, kCount, kSteps, random);
      for (std::size_t i = 0; i < kCount * kSteps; ++i) samples.inputs[i] = random.uniform() < 0.5 ? -1 : 1;
      for (std::size_t i = 0; i < kCount * kSteps; ++i)
        samples.targets[i] = i % kSteps < kDelay ? 0 : samples.inputs[i - kDelay];
      return samples;
    };
    const Samples known = echo(), unknown = echo();
    Optimizer optimizer(memory());
    optimizer.gradient_limit = 1;
    train(network, known, optimizer, 120, 20, random);
    EXPECT_LT(error_of(network, unknown, {}), 0.02) << "kind " << static_cast<int>(kind);
  }
}

TEST(Network, TrainingThatDivergesIsAnErrorAndKeepsTheParameters) {
  Random random(1);
  Network network(memory());
  make(network, {2, 3, 1}, LayerKind::FeedForward, Activation::Linear, Activation::Linear);
  network.randomize(random);
  const Samples samples = random_samples(network, 10, 1, random);
  Optimizer optimizer(memory());
  optimizer.set_kind(OptimizerKind::GradientDescent);
  optimizer.rate = 1e200;
  EXPECT_THROW(train(network, samples, optimizer, 100, 0, random), Error);
  EXPECT_TRUE(network.parameters().vector().allFinite());
}

TEST(Network, WorkEndsWhereThePollThrows) {
  Random random(1);
  Network network(memory());
  make(network, {2, 3, 1}, LayerKind::Elman, Activation::Tanh, Activation::Linear);
  const Samples samples = random_samples(network, 3, 50, random);
  int left = 20;
  Gradient gradient(memory());
  const std::uint32_t which[] = {0, 1, 2};
  EXPECT_THROW(gradient.compute(network, samples, which,
                                [&] {
                                  if (--left == 0) throw Error(ErrorCode::Interrupted, "interrupted");
                                }),
               Error);
  EXPECT_EQ(left, 0);
}

TEST(Network, AnImageGivesTheSameNetworkAndADamagedOneIsAnError) {
  Random random(4);
  Network network(memory());
  make(network, {3, 4, 5, 2}, LayerKind::ContinuousTime, Activation::Softplus, Activation::Relu);
  network.randomize(random);
  network.set_time_step(0.25);
  ByteWriter out;
  network.save(out);
  const auto bytes = out.take();
  Network copy(memory());
  ByteReader in(bytes.data(), bytes.size());
  copy.load(in);
  Hasher first, second;
  network.hash(first);
  copy.hash(second);
  EXPECT_EQ(first.value(), second.value());
  EXPECT_TRUE(copy.same_shape(network));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ByteReader cut(bytes.data(), size);
    EXPECT_THROW(copy.load(cut), Error) << size;
  }
  // Any byte may be anything: it is read as another network, or refused.
  for (int round = 0; round < 20'000; ++round) {
    auto forged = bytes;
    for (std::uint64_t change = 0; change <= random.below(3); ++change)
      forged[random.below(forged.size())] = static_cast<std::uint8_t>(random.below(256));
    ByteReader from(forged.data(), forged.size());
    try {
      copy.load(from);
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), ErrorCode::Image);
      continue;
    }
    Activity activity(memory());
    copy.rest(activity, 2);
    copy.step(activity, Eigen::MatrixXd::Ones(copy.inputs(), 2));
  }
}

TEST(Network, LayersBeyondTheBoundsAreRefused) {
  Network network(memory());
  EXPECT_THROW(network.add_layer(LayerKind::Elman, 3, Activation::Tanh), Error);
  EXPECT_THROW(network.add_layer(LayerKind::FeedForward, 0, Activation::Tanh), Error);
  EXPECT_THROW(network.add_layer(LayerKind::FeedForward, Network::kMaxNeurons + 1, Activation::Tanh), Error);
  network.add_layer(LayerKind::FeedForward, 100'000, Activation::Linear);
  EXPECT_THROW(network.add_layer(LayerKind::FeedForward, 100, Activation::Tanh), Error);
  EXPECT_EQ(network.layers().size(), 1U);
  EXPECT_EQ(network.parameters().size(), 0U);
}

}  // namespace
}  // namespace breve::learn
