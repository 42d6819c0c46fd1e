// Names by value for things that live in a world. A stale id never names another thing.
#pragma once

#include <cstdint>

namespace breve {

/// One instance in a world. All zero is null. `generation` tells a recycled index from the instance it once named.
struct ObjectId {
  std::uint32_t index = 0;
  std::uint32_t generation = 0;

  explicit operator bool() const { return generation != 0; }
  friend bool operator==(ObjectId, ObjectId) = default;
};

/// A class of a program, as the runtime sees it: a number without meaning of its own.
using ClassId = std::uint32_t;
inline constexpr ClassId kNoClass = 0xffffffffU;

}  // namespace breve
