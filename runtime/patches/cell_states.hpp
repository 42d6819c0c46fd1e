// The states of a grid's cells, a byte each: what cellular automata are made of. Two buffers, so that all cells can
// change at once; totalistic rules run over whole rows of bytes.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/poll.hpp"
#include "runtime/base/random.hpp"
#include "runtime/patches/grid.hpp"

namespace breve {

/// Which cells count as neighbours of a cell, one step away.
enum class Neighborhood : std::uint8_t { Moore, VonNeumann, Moore3, VonNeumann3 };

/// A cell becomes 1 if it is 0 and has k neighbours that are not 0 with bit k of `born`, or if it is not 0 and bit k of
/// `survive` is set; otherwise it becomes 0. Life is born {3}, survive {2, 3} (Conway; Gardner 1970).
struct TotalisticRule {
  std::uint32_t born = 0, survive = 0;
};

/// When a change of one cell is seen by the others.
enum class UpdateOrder : std::uint8_t {
  Synchronous,  // all change at once: each sees the states before
  Sequential,   // one after the other, in the order of the cells
  Random,       // one after the other, in an order drawn anew each time
};

class CellStates {
 public:
  explicit CellStates(std::pmr::memory_resource* memory) : now_(memory), next_(memory), rows_(memory) {}

  bool made() const { return !now_.empty(); }
  void make(const Grid& grid) { now_.resize(grid.cells()); }  // all 0; nothing if they are there
  std::uint8_t get(CellIndex cell) const { return now_[cell]; }
  /// While a synchronous update runs the new state is seen only after it.
  void set(CellIndex cell, std::uint8_t state) { (buffered_ ? next_ : now_)[cell] = state; }
  std::span<const std::uint8_t> all() const { return now_; }
  std::span<std::uint8_t> all() { return now_; }
  std::size_t count(std::uint8_t state) const;

  /// How many neighbours of a cell are not 0 now.
  int neighbors(const Grid& grid, Neighborhood kind, CellIndex cell) const;
  /// The same for every cell. Valid until the next call.
  std::span<const std::uint8_t> neighbor_counts(const Grid& grid, Neighborhood kind);
  /// Every cell by the rule. @throws std::bad_alloc, and nothing has changed then
  /// Where `poll` throws, nothing has changed, or the cells before some cell where the order is not Synchronous.
  void step(const Grid& grid, Neighborhood kind, const TotalisticRule& rule, UpdateOrder order, Random& random,
            const Poll& poll = {});

  // A synchronous update cell by cell: begin, set() what changes, end (or abandon: nothing has changed).
  void begin();
  void end();
  void abandon() { buffered_ = false; }

  void save(ByteWriter& out) const;
  void load(ByteReader& in, const Grid& grid);  // Error{Image}
  void hash(Hasher& hasher) const;

 private:
  void sum_block(const Grid& grid, Neighborhood kind);
  void step_at_once(const Grid& grid, Neighborhood kind, const TotalisticRule& rule, const Poll& poll);

  std::pmr::vector<std::uint8_t> now_, next_;
  std::pmr::vector<std::uint8_t> rows_;  // scratch: 1 where a cell is not 0, then sums
  bool buffered_ = false;
};

/// The numbers 0 .. count-1 in an order drawn from `random` (Fisher and Yates).
void shuffled(std::size_t count, Random& random, std::pmr::vector<CellIndex>& out);

}  // namespace breve
