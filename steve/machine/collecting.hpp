// What the two halves of the collector of the whole heap share: units of work, and what may be garbage.
#pragma once

#include <cstdint>

#include "steve/machine/cells.hpp"

namespace breve::steve::collecting {

// Units of work. See docs/performance.md for what a slice takes. docs/limits.md promises in how many slices a cycle is
// gone, by the number of cells: two collections, each of at most kLook + kMark + 3 * kPlace + r units for a cell with r
// references, so that a slice is 40,000 cells with up to six references on the average.
constexpr std::int64_t kSlice = 2'120'000;
constexpr std::int64_t kLook = 4;      // is a place a root?
constexpr std::int64_t kMark = 40;     // reach and scan a cell: memory is waited for, whatever stands there
constexpr std::int64_t kElement = 1;   // look at a reference, or an element of a list or hash
constexpr std::int64_t kPlace = 1;     // look at the mark of a place
constexpr std::int64_t kBreak = 18;    // release a reference of garbage, or a cell of it
constexpr std::int64_t kBegin = 1000;  // so that collections that follow each other end a slice

inline void fetch(const void* memory) { __builtin_prefetch(memory); }

inline bool can_close_cycle(const Cell* cell) {
  if (cell == nullptr || !is_container(cell->tag)) return false;
  return cell->tag != Tag::Object || static_cast<const Instance*>(cell)->auto_free;
}

inline bool is_root(const Container& cell) {
  if (cell.tag != Tag::Object) return false;
  const auto& instance = static_cast<const Instance&>(cell);
  return instance.live() && (!instance.auto_free || instance.state == Instance::State::BeingFreed);
}

inline bool can_be_doomed(const Container& cell) {
  if (cell.tag != Tag::Object) return false;
  const auto& instance = static_cast<const Instance&>(cell);
  return instance.auto_free && instance.state == Instance::State::Live;
}

}  // namespace breve::steve::collecting
