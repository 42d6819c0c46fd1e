// Gradient descent, momentum and Adam.
#include "runtime/learn/network/optimizer.hpp"

#include <array>
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/learn/network/numbers_image.hpp"

namespace breve::learn {

namespace {

constexpr std::array<std::string_view, kOptimizerKinds> kOptimizerNames = {"gradient-descent", "momentum", "adam"};
constexpr double kMeanDecay = 0.9, kSquareDecay = 0.999, kEpsilon = 1e-8;  // as Kingma and Ba recommend

}  // namespace

std::optional<OptimizerKind> optimizer_named(std::string_view name) {
  for (std::uint8_t i = 0; i < kOptimizerKinds; ++i)
    if (kOptimizerNames[i] == name) return static_cast<OptimizerKind>(i);
  return std::nullopt;
}

void Optimizer::set_kind(OptimizerKind kind) {
  if (kind != kind_) reset();
  kind_ = kind;
}

void Optimizer::reset() {
  mean_.resize(0);
  square_.resize(0);
  updates_ = 0;
}

void Optimizer::update(Numbers& parameters, Numbers& gradient) {
  auto g = gradient.vector();
  const double length = g.norm();
  if (gradient_limit > 0 && length > gradient_limit) g *= gradient_limit / length;
  if (kind_ != OptimizerKind::GradientDescent) mean_.resize(parameters.size());
  if (kind_ == OptimizerKind::Adam) square_.resize(parameters.size());
  // The step replaces the gradient, so that nothing has changed if it turns out not to be finite.
  if (kind_ == OptimizerKind::GradientDescent) {
    g *= rate;
  } else if (kind_ == OptimizerKind::Momentum) {
    mean_.vector() = momentum * mean_.vector() + g;
    g = rate * mean_.vector();
  } else {
    ++updates_;
    const auto n = static_cast<double>(updates_);
    const double mean_part = 1 - std::pow(kMeanDecay, n), square_part = 1 - std::pow(kSquareDecay, n);
    mean_.vector() = kMeanDecay * mean_.vector() + (1 - kMeanDecay) * g;
    square_.vector() = kSquareDecay * square_.vector() + (1 - kSquareDecay) * g.cwiseAbs2();
    g = rate * (mean_.vector().array() / mean_part) / ((square_.vector().array() / square_part).sqrt() + kEpsilon);
  }
  g = parameters.vector() - g;
  if (!g.allFinite()) {
    reset();
    throw Error(ErrorCode::Numeric,
                "a parameter would not be finite: the learning rate is too large for these samples");
  }
  parameters.vector() = g;
}

void Optimizer::save(ByteWriter& out) const {
  out.put(kind_);
  out.put(rate);
  out.put(momentum);
  out.put(gradient_limit);
  out.put(updates_);
  put_numbers(out, mean_);
  put_numbers(out, square_);
}

void Optimizer::load(ByteReader& in, std::size_t parameters) {
  const auto kind = in.get<std::uint8_t>();
  if (kind >= kOptimizerKinds) ByteReader::fail();
  kind_ = static_cast<OptimizerKind>(kind);
  rate = in.get<double>();
  momentum = in.get<double>();
  gradient_limit = in.get<double>();
  if (!std::isfinite(rate) || rate <= 0 || !(momentum >= 0 && momentum < 1) || !(gradient_limit >= 0))
    ByteReader::fail();
  updates_ = in.get<std::uint64_t>();
  for (Numbers* numbers : {&mean_, &square_}) {
    get_numbers(in, *numbers);
    if (numbers->size() != 0 && numbers->size() != parameters) ByteReader::fail();
  }
}

void Optimizer::hash(Hasher& hasher) const {
  hasher.add(static_cast<std::uint64_t>(kind_));
  for (const double setting : {rate, momentum, gradient_limit}) hasher.add(setting);
  hasher.add(updates_);
  hash_numbers(hasher, mean_);
  hash_numbers(hasher, square_);
}

}  // namespace breve::learn
