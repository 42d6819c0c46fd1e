// The geometry of a grid of cells: which cell is where, which are next to which. What cells hold stands elsewhere.
#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/math.hpp"

namespace breve {

using CellIndex = std::uint32_t;
inline constexpr CellIndex kNoCell = 0xffffffffU;

/// A cell by its three indices.
struct Cell3 {
  int x = 0, y = 0, z = 0;
};

/// Cell (x, y, z) has the index (x * ny + y) * nz + z, as the elements of a Field; scripts see cells in this order.
class Grid {
 public:
  static constexpr std::size_t kMaxCells = std::size_t{1} << 28;

  /// @param counts  cells along each axis, from 1
  /// @param wraps   indices wrap on all axes (a toroid), or end at the edges
  /// @param center  of the box of all cells, m
  /// @param size    of one cell, m, each > 0
  /// @throws Error{Argument} naming what cannot be
  Grid(Cell3 counts, bool wraps, const Vector3& center, const Vector3& size);

  int nx() const { return counts_.x; }
  int ny() const { return counts_.y; }
  int nz() const { return counts_.z; }
  bool wraps() const { return wraps_; }
  bool flat() const { return counts_.z == 1; }
  std::size_t cells() const { return cells_; }
  const Vector3& center() const { return center_; }
  const Vector3& cell_size() const { return size_; }

  /// The cell with these indices, wrapped on a toroid; kNoCell outside.
  CellIndex at(std::int64_t x, std::int64_t y, std::int64_t z) const;
  Cell3 cell(CellIndex index) const;
  /// The cell that holds a point: lower faces belong to it. kNoCell outside; a toroid repeats for ever.
  CellIndex at(const Vector3& location) const;
  Vector3 corner(CellIndex index) const;  // the low one
  Vector3 middle(CellIndex index) const { return corner(index) + 0.5 * size_; }

  // Neighbourhoods up to distance n >= 0, without the cell itself and without duplicates. `visit` is given each index.

  /// Every cell up to n away along each axis (Chebyshev distance); x slowest, then y, then z. @param flat  same z only
  template <class Visit>
  void moore(CellIndex index, int n, bool flat, Visit visit) const {
    const Cell3 c = cell(index);
    Walk x = walk(c.x, n, counts_.x);
    for (; x.left > 0; x.step()) {
      Walk y = walk(c.y, n, counts_.y);
      for (; y.left > 0; y.step()) {
        Walk z = flat ? Walk{c.z, 1, counts_.z} : walk(c.z, n, counts_.z);
        for (; z.left > 0; z.step()) {
          const CellIndex other = index_of(x.at, y.at, z.at);
          if (other != index) visit(other);
        }
      }
    }
  }
  /// The cells up to n away on the lines along x, y and, unless flat, z: first all along x, then y, then z.
  template <class Visit>
  void von_neumann(CellIndex index, int n, bool flat, Visit visit) const {
    const Cell3 c = cell(index);
    const auto tell = [&](CellIndex other) {
      if (other != index) visit(other);
    };
    for (Walk x = walk(c.x, n, counts_.x); x.left > 0; x.step()) tell(index_of(x.at, c.y, c.z));
    for (Walk y = walk(c.y, n, counts_.y); y.left > 0; y.step()) tell(index_of(c.x, y.at, c.z));
    if (flat) return;
    for (Walk z = walk(c.z, n, counts_.z); z.left > 0; z.step()) tell(index_of(c.x, c.y, z.at));
  }

  void save(ByteWriter& out) const;
  static Grid load(ByteReader& in);  // Error{Image}
  void hash(Hasher& hasher) const;

 private:
  /// The indices up to n from one along an axis of `count` cells, each once, in ascending offset.
  struct Walk {
    int at, left, count;
    void step() {
      --left;
      if (++at == count) at = 0;
    }
  };
  Walk walk(int from, int n, int count) const;
  CellIndex index_of(int x, int y, int z) const {
    return (static_cast<CellIndex>(x) * static_cast<CellIndex>(counts_.y) + static_cast<CellIndex>(y)) *
               static_cast<CellIndex>(counts_.z) +
           static_cast<CellIndex>(z);
  }
  static int wrapped(std::int64_t index, int count);

  Cell3 counts_;
  bool wraps_;
  Vector3 center_, size_;
  std::size_t cells_;
};

}  // namespace breve
