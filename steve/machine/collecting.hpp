// What the two halves of the collector of the whole heap share: units of work, and what may be garbage.
#pragma once

#include <cstdint>

#include "steve/machine/cells.hpp"

namespace breve::steve::collecting {

// Units of work, about a quarter of a nanosecond each. See docs/performance.md for what a slice takes. docs/limits.md
// promises in how many slices a cycle is gone, by the number of cells: two collections, so that a slice is 40,000
// cells. An object with two references costs 87 units, a list in a list some 100; for heaps with more see Heap::slice.
constexpr std::int64_t kSlice = 5'000'000;
constexpr std::uint64_t kPromised = 40'000;  // cells of the heap for each slice that a collection may take
constexpr std::uint64_t kHurry = 60'000;     // cells for each slice that is left, so that larger ones must follow
constexpr std::int64_t kLook = 4;            // is a place a root?
constexpr std::int64_t kRoot = 40;           // scan a root, in the order of the table
constexpr std::int64_t kMark = 80;           // scan another cell, which lies anywhere
constexpr std::int64_t kReference = 20;      // reach a cell
constexpr std::int64_t kElement = 1;         // look at an element of a list or hash
constexpr std::int64_t kSlot = 1;            // look at the mark of a place
constexpr std::int64_t kBreak = 40;          // release a reference of garbage, or a cell of it
constexpr std::int64_t kSwept = 3 * kBreak;  // take apart a cell of the garbage with a reference to another
constexpr std::int64_t kLeastSwept = 2000;   // cells in a slice
constexpr std::int64_t kBegin = 1000;        // so that collections that follow each other end a slice

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

/// A list that leads to no other container.
inline bool is_leaf(const Container& cell) {
  if (cell.tag != Tag::List) return false;
  const auto& list = static_cast<const ListCell&>(cell);
  return list.size == 0 || (list.narrow() && !is_container(list.kind));
}

}  // namespace breve::steve::collecting
