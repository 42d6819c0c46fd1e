// Agents on the cells of a grid: who stands where, which cells are free. Every operation is O(1) but the searches.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/base/ids.hpp"
#include "runtime/base/random.hpp"
#include "runtime/patches/grid.hpp"

namespace breve {

/// The agents of one cell form a circular list, in order of arrival. Free cells stand in an array, so that a random one
/// is drawn without trying.
class Occupants {
 public:
  using Slot = std::uint32_t;  // of an agent in the tables
  static constexpr Slot kNoSlot = 0xffffffffU;

  struct Agent {
    ObjectId id;  // null: the place is not in use
    CellIndex cell = kNoCell;
    Slot before = kNoSlot, after = kNoSlot;  // in the circular list of its cell
  };

  explicit Occupants(std::pmr::memory_resource* memory)
      : first_(memory), agents_(memory), unused_(memory), free_(memory), slot_of_free_(memory), counts_(memory) {}

  bool made() const { return !first_.empty(); }
  void make(const Grid& grid);  // tables for its cells; nothing if they are there
  /// How many agents a cell holds at most; 0: any number. Surplus agents stay.
  void set_capacity(std::uint32_t capacity) { capacity_ = capacity; }
  std::uint32_t capacity() const { return capacity_; }
  std::uint32_t count(CellIndex cell) const { return counts_[cell]; }
  bool has_room(CellIndex cell) const { return capacity_ == 0 || counts_[cell] < capacity_; }
  std::size_t agents() const { return agents_.size() - unused_.size(); }
  std::size_t free_cells() const { return free_.size(); }  // cells without any agent

  /// A new agent in a cell. @throws std::bad_alloc, and nothing has changed then
  Slot enter(ObjectId id, CellIndex cell);
  void leave(Slot slot);
  void move(Slot slot, CellIndex to);
  /// Is this agent still there?
  bool holds(Slot slot, ObjectId id) const { return slot < agents_.size() && id && agents_[slot].id == id; }
  const Agent& agent(Slot slot) const { return agents_[slot]; }
  std::size_t slots() const { return agents_.size(); }
  Slot first(CellIndex cell) const { return first_[cell]; }
  /// The next agent of the same cell; kNoSlot behind the last.
  Slot next(Slot slot) const {
    const Agent& a = agents_[slot];
    return a.after == first_[a.cell] ? kNoSlot : a.after;
  }
  /// A cell without any agent, each equally likely; kNoCell if there is none.
  CellIndex random_free(Random& random) const;

  void save(ByteWriter& out) const;
  void load(ByteReader& in, const Grid& grid);  // Error{Image}
  void hash(Hasher& hasher) const;

 private:
  void link(Slot slot, CellIndex cell);
  void unlink(Slot slot);

  std::uint32_t capacity_ = 1;
  std::pmr::vector<Slot> first_;  // by cell
  std::pmr::vector<Agent> agents_;
  std::pmr::vector<Slot> unused_;             // last left, first used again
  std::pmr::vector<CellIndex> free_;          // cells without agents
  std::pmr::vector<CellIndex> slot_of_free_;  // by cell: where it stands in free_
  std::pmr::vector<std::uint32_t> counts_;    // by cell
};

}  // namespace breve
