// Points sorted into cubic cells of one size. Where the box about all points has not many more cells than there are
// points, the cells are a plain array; elsewhere the occupied ones stand in a hash table, so that a world may be as
// wide as it likes.
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

  /// Sort finite `points` into cells of edge `cell_size` > 0, or of a longer one where that makes no crowds. The cells
  /// are in the order of their coordinates: what is near in space is mostly near in memory. Cost O(n); in a table, plus
  /// the sorting of the occupied cells.
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

  // cells in a plain array (cell_array.cpp)
  double measure(const Vector3& low, const Vector3& high);
  bool fit(const std::pmr::vector<Vector3>& points);
  bool count(const std::pmr::vector<Vector3>& points);
  void scatter(const std::pmr::vector<Vector3>& points);
  std::size_t row(std::int64_t x, std::int64_t y) const {
    return static_cast<std::size_t>((x - low_.x) * rows_ + (y - low_.y)) * static_cast<std::size_t>(row_length_);
  }

  // cells in a hash table (cell_grid.cpp)
  static std::uint64_t mix(const CellKey& key);
  std::uint32_t find_or_make(const CellKey& key);
  void build_table(const std::pmr::vector<Vector3>& points);
  void sort_cells();
  const Cell* find(const CellKey& key) const;
  Run run_in_table(std::int64_t x, std::int64_t y, std::int64_t from, std::int64_t to) const;

  double cell_size_ = 1;
  double edge_ = 1;     // of the cells as they are, at least cell_size_
  CellKey low_, high_;  // bounds of the occupied cells
  bool in_array_ = false;
  std::int64_t rows_ = 0, row_length_ = 0;  // cells of the box along y and along z
  std::pmr::vector<std::uint32_t> starts_;  // by cell of the box: where its points begin; one more at the end
  std::pmr::vector<Cell> cells_;
  std::pmr::vector<std::uint32_t> table_;  // open addressing: cell number + 1, or 0; size a power of two
  std::pmr::vector<std::uint32_t> cell_of_point_;
  std::pmr::vector<std::uint32_t> renumbered_;
  std::pmr::vector<std::uint32_t> order_;
  std::pmr::vector<Vector3> sorted_points_;
};

}  // namespace breve
