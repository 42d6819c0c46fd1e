// A 64-bit hash of state: the world hash, program fingerprints, keys of script hashes. Not for secrets.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>

#include "runtime/base/math.hpp"

namespace breve {

/// Multiply-and-fold over 64-bit words. The same input gives the same hash in every build.
class Hasher {
 public:
  void add(std::uint64_t word) {
    const Wide product = static_cast<Wide>(state_ ^ word) * kMultiplier;
    state_ = static_cast<std::uint64_t>(product) ^ static_cast<std::uint64_t>(product >> 64) ^ kIncrement;
  }
  /// All that are not a number count as one: which of them arithmetic gives depends on the processor's instructions.
  void add(double value) {
    add(std::bit_cast<std::uint64_t>(value == value ? value : std::numeric_limits<double>::quiet_NaN()));
  }
  void add(const Vector3& v) {
    for (int i = 0; i < 3; ++i) add(v[i]);
  }
  void add(const Quaternion& q) {
    for (int i = 0; i < 4; ++i) add(q.coeffs()[i]);
  }
  void add(const Matrix3& m) {
    for (int i = 0; i < 9; ++i) add(m.data()[i]);
  }
  void add(std::string_view text) {
    add(static_cast<std::uint64_t>(text.size()));
    for (; text.size() >= 8; text.remove_prefix(8)) {
      std::uint64_t word;
      std::memcpy(&word, text.data(), 8);
      add(word);
    }
    std::uint64_t tail = 0;
    if (!text.empty()) std::memcpy(&tail, text.data(), text.size());
    add(tail);
  }
  std::uint64_t value() const { return state_; }

 private:
  __extension__ using Wide = unsigned __int128;
  static constexpr std::uint64_t kMultiplier = 0x9e3779b97f4a7c15ULL;
  static constexpr std::uint64_t kIncrement = 0xd1b54a32d192ed03ULL;
  std::uint64_t state_ = 0x2545f4914f6cdd1dULL;
};

}  // namespace breve
