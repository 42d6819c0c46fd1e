// Points sorted into cubic cells of one size; the occupied cells stand in a hash table, so that a world may be as wide
// as it likes.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/base/math.hpp"

namespace breve {

class CellGrid {
 public:
  explicit CellGrid(std::pmr::memory_resource* memory);

  /// Sort `points` into cells of edge `cell_size` > 0, cells in the order of their coordinates: what is near in space
  /// is mostly near in memory. Cost O(n), plus the sorting of the occupied cells.
  void build(const std::pmr::vector<Vector3>& points, double cell_size);
  double cell_size() const { return cell_size_; }

  /// The points of one row of cells, as positions in order() and sorted_points().
  struct Run {
    std::uint32_t begin, end;
  };
  /// Three by three rows, or four where rounding splits an edge.
  static constexpr std::size_t kMostRuns = 16;
  /// The rows of cells that meet the cube of half edge `radius` <= cell_size about `center`.
  /// @return how many runs were written
  std::size_t around(const Vector3& center, double radius, std::array<Run, kMostRuns>& runs) const;
  const std::pmr::vector<std::uint32_t>& order() const { return order_; }  // indices into the points given
  const std::pmr::vector<Vector3>& sorted_points() const { return sorted_points_; }
  std::size_t bytes() const;

 private:
  struct CellKey {
    std::int64_t x = 0, y = 0, z = 0;
    friend auto operator<=>(const CellKey&, const CellKey&) = default;
  };
  struct Cell {
    CellKey key;
    std::uint32_t begin = 0, end = 0;
    std::uint32_t number = 0;  // as its first point came
  };
  std::int64_t coordinate(double value) const;
  CellKey key_of(const Vector3& point) const;
  static std::uint64_t mix(const CellKey& key);
  std::uint32_t find_or_make(const CellKey& key);
  void sort_cells();
  const Cell* find(const CellKey& key) const;

  double cell_size_ = 1;
  CellKey low_, high_;  // bounds of the occupied cells
  std::pmr::vector<Cell> cells_;
  std::pmr::vector<std::uint32_t> table_;  // open addressing: cell number + 1, or 0; size a power of two
  std::pmr::vector<std::uint32_t> cell_of_point_;
  std::pmr::vector<std::uint32_t> renumbered_;
  std::pmr::vector<std::uint32_t> order_;
  std::pmr::vector<Vector3> sorted_points_;
};

}  // namespace breve
