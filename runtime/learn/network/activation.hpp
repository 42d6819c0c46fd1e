// Activation functions of neurons. The slope of each follows from its value, so that training keeps values only.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "runtime/learn/network/numbers.hpp"

namespace breve::learn {

enum class Activation : std::uint8_t { Linear, Logistic, Tanh, Relu, LeakyRelu, Softplus };
constexpr std::uint8_t kActivations = 6;

/// Names: "linear", "logistic", "tanh", "relu", "leaky-relu", "softplus".
std::optional<Activation> activation_named(std::string_view name);

/// Replaces each x by its activation: x; 1 / (1 + exp(-x)); tanh x; max(x, 0); max(x, x / 100); log(1 + exp x).
void activate(Activation activation, Eigen::Ref<Eigen::MatrixXd> values);

/// Multiplies each element of `gradient` by the slope of the activation where it has the value in `values`.
void multiply_by_slope(Activation activation, const Eigen::Ref<const Eigen::MatrixXd>& values,
                       Eigen::Ref<Eigen::MatrixXd> gradient);

}  // namespace breve::learn
