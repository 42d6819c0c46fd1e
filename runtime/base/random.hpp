// The world's generator of random numbers: xoshiro256** (Blackman and Vigna, 2018), seeded by splitmix64.
// Its whole state is part of a snapshot; nothing else in the library draws from anywhere else.
#pragma once

#include <array>
#include <cstdint>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"

namespace breve {

class Random {
 public:
  explicit Random(std::uint64_t seed = 1) { seed_with(seed); }

  void seed_with(std::uint64_t seed);
  /// uniform() in steps of 1/32767, as the original drew its floats. Off by default.
  void set_coarse(bool coarse) { coarse_ = coarse; }
  bool coarse() const { return coarse_; }
  std::uint64_t seed() const { return seed_; }
  std::uint64_t next();
  /// Uniform integer in [0, bound), bound > 0. No modulo bias.
  std::uint64_t below(std::uint64_t bound);

  /// Uniform in [0, 1], both ends reachable, 53 bits.
  double uniform();
  /// Uniform integer in [0, n], both ends reachable; 0 for n < 0. No modulo bias.
  std::int32_t below_or_equal(std::int32_t n);
  /// Mean 0, deviation 1 (polar method of Marsaglia).
  double gauss();
  /// Mean 1.
  double exponential();
  /// Gamma distributed of integer order >= 1 (waiting time to the order-th event of a unit Poisson process).
  /// Error{Argument} for an order below 1.
  double gamma(std::int32_t order);

  void save(ByteWriter& out) const;
  void load(ByteReader& in);
  void hash(Hasher& hasher) const;

 private:
  double open_uniform();  // in (0, 1), 53 bits: safe under a logarithm

  std::array<std::uint64_t, 4> state_{};
  std::uint64_t seed_ = 0;
  double spare_ = 0;  // gauss makes two at a time
  bool has_spare_ = false;
  bool coarse_ = false;
};

}  // namespace breve
