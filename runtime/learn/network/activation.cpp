// Activation functions of neurons, and their slopes.
#include "runtime/learn/network/activation.hpp"

#include <array>
#include <cmath>

namespace breve::learn {

namespace {

constexpr double kLeak = 0.01;  // Maas, Hannun and Ng, 2013
constexpr std::array<std::string_view, kActivations> kActivationNames = {"linear", "logistic",   "tanh",
                                                                         "relu",   "leaky-relu", "softplus"};

}  // namespace

std::optional<Activation> activation_named(std::string_view name) {
  for (std::uint8_t i = 0; i < kActivations; ++i)
    if (kActivationNames[i] == name) return static_cast<Activation>(i);
  return std::nullopt;
}

void activate(Activation activation, Eigen::Ref<Eigen::MatrixXd> values) {
  auto x = values.array();
  switch (activation) {
    case Activation::Linear: break;
    case Activation::Logistic: x = 1.0 / (1.0 + (-x).exp()); break;
    case Activation::Tanh: x = x.tanh(); break;
    case Activation::Relu: x = x.max(0.0); break;
    case Activation::LeakyRelu: x = x.max(kLeak * x); break;
    // The exponent is never positive, so that nothing overflows.
    case Activation::Softplus: x = x.max(0.0) + (-x.abs()).exp().log1p(); break;
  }
}

void multiply_by_slope(Activation activation, const Eigen::Ref<const Eigen::MatrixXd>& values,
                       Eigen::Ref<Eigen::MatrixXd> gradient) {
  const auto y = values.array();
  auto g = gradient.array();
  switch (activation) {
    case Activation::Linear: break;
    case Activation::Logistic: g *= y * (1.0 - y); break;
    case Activation::Tanh: g *= 1.0 - y.square(); break;
    case Activation::Relu: g = (y > 0.0).select(g, 0.0); break;
    case Activation::LeakyRelu: g = (y > 0.0).select(g, kLeak * g); break;
    case Activation::Softplus: g *= 1.0 - (-y).exp(); break;
  }
}

}  // namespace breve::learn
