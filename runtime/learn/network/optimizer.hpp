// What a gradient does to the parameters of a network.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <optional>
#include <string_view>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/learn/network/numbers.hpp"

namespace breve::learn {

enum class OptimizerKind : std::uint8_t { GradientDescent, Momentum, Adam };
constexpr std::uint8_t kOptimizerKinds = 3;

/// Names: "gradient-descent", "momentum", "adam".
std::optional<OptimizerKind> optimizer_named(std::string_view name);

class Optimizer {
 public:
  explicit Optimizer(std::pmr::memory_resource* memory) : mean_(memory), square_(memory) {}

  OptimizerKind kind() const { return kind_; }
  /// Another kind begins without memory of former gradients.
  void set_kind(OptimizerKind kind);
  double rate = 0.01;     // finite, > 0
  double momentum = 0.9;  // 0 to 1, exclusive
  double gradient_limit =
      0;  // a longer gradient is shortened to this length (Pascanu, Mikolov and Bengio, 2013); 0: none

  /// One step against the gradient, which it may change. With g the gradient and r the rate:
  ///   gradient descent  p -= r g
  ///   momentum          m = momentum m + g;  p -= r m         (Polyak, 1964)
  ///   Adam              with decay 0.9 and 0.999, epsilon 1e-8 (Kingma and Ba, Adam, 2015, algorithm 1)
  /// @throws Error{Numeric} if a parameter would not be finite; the parameters are then as before
  void update(Numbers& parameters, Numbers& gradient);
  /// Forget former gradients.
  void reset();

  void save(ByteWriter& out) const;
  /// @throws Error{Image} for anything that save does not write for so many parameters
  void load(ByteReader& in, std::size_t parameters);
  void hash(Hasher& hasher) const;

 private:
  OptimizerKind kind_ = OptimizerKind::Adam;
  Numbers mean_, square_;  // empty, or one for each parameter
  std::uint64_t updates_ = 0;
};

}  // namespace breve::learn
