// Bytes as a series of choices. When they run out every choice is the first one, so that what is built ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>

namespace breve::fuzz {

class Choices {
 public:
  explicit Choices(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  /// A number below `count`, which is at least 1.
  std::size_t below(std::size_t count) {
    if (count <= 1 || at_ == bytes_.size()) return 0;
    std::size_t value = bytes_[at_++];
    if (count > 256 && at_ != bytes_.size()) value = value << 8 | bytes_[at_++];
    return value % count;
  }
  /// True in about `percent` of 100 cases.
  bool chance(std::size_t percent) { return below(100) + percent >= 100; }
  bool empty() const { return at_ == bytes_.size(); }

  template <class Container>
  auto& one_of(Container&& from) {
    return from[below(std::size(from))];
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

}  // namespace breve::fuzz
