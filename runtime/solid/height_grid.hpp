// A height field: heights over a regular grid in x and z, two triangles a cell. Ground: what is below it is inside.
#pragma once

#include <span>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/poll.hpp"
#include "runtime/solid/surface.hpp"

namespace breve {

/// Column i stands at x = (i - (columns - 1) / 2) tile, row j at z alike, y up: the origin is the grid's centre at
/// height 0. Each cell is split from its low corner (i, j) to its high corner (i + 1, j + 1).
class HeightGrid final : public Surface {
 public:
  static constexpr int kMostSide = 4097;

  /// `heights` has rows * columns values, row after row. Error{Argument}: a side that is not from 2 to kMostSide, a
  /// count that does not fit, a tile that is not finite and > 0, a height that is not finite.
  HeightGrid(int columns, int rows, double tile, std::span<const double> heights, std::pmr::memory_resource* memory,
             const Poll& poll = {});

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double tile() const { return tile_; }  // before scaling
  /// Error{Argument} if the place is not in the grid. Before scaling.
  double height(int column, int row) const;
  void set_height(int column, int row, double height);
  /// A point of the grid, in range; own frame, after scaling.
  Vector3 corner(int column, int row) const;
  /// The height of the triangles at (x, z), own frame, after scaling; false beyond the rim.
  bool height_at(double x, double z, double& height) const;

  std::shared_ptr<Surface> scaled(const Vector3& factors) const override;
  void under(const Eigen::AlignedBox3d& box, FacetVisitor& visitor) const override;
  bool raycast(const Vector3& origin, const Vector3& direction, double& fraction, Facet& hit) const override;
  const Eigen::AlignedBox3d& bounds() const override { return bounds_; }
  bool solid() const override { return true; }
  /// Below the surface and not beside the grid.
  bool inside(const Vector3& point) const override;
  void hash(Hasher& hasher) const override;
  void save(ByteWriter& out) const;
  static std::shared_ptr<HeightGrid> load(ByteReader& in);

 private:
  HeightGrid(const HeightGrid& other, const Vector3& factors);
  std::size_t index(int column, int row) const;
  /// The cell at (x, z), at the rim the last one.
  int column_at(double x) const;
  int row_at(double z) const;
  /// Lowest and highest height of a square of cells; before scaling.
  struct Range {
    double low, high;
  };
  static constexpr int kBlock = 16;  // cells along the side of a block
  int blocks_across() const { return (columns_ - 2) / kBlock + 1; }
  int blocks_along() const { return (rows_ - 2) / kBlock + 1; }
  Range& block(int across, int along) {
    return blocks_[static_cast<std::size_t>(along) * static_cast<std::size_t>(blocks_across()) +
                   static_cast<std::size_t>(across)];
  }
  const Range& block(int across, int along) const { return const_cast<HeightGrid*>(this)->block(across, along); }
  void measure(const Poll& poll = {});
  void measure_block(int across, int along);
  void measure_bounds();
  /// Cells from the first to the last, with bounds; of an area of the grid.
  struct Area {
    int first_column, first_row, last_column, last_row;
  };
  Eigen::AlignedBox3d box_of(const Area& cells, const Range& heights) const;
  void visit_row(int row, const Area& cells, const Eigen::AlignedBox3d& box, FacetVisitor& visitor) const;
  void visit_cell(int column, int row, const Eigen::AlignedBox3d& box, FacetVisitor& visitor) const;
  Facet facet(int column, int row, int half, bool with_active) const;
  /// Normal of a triangle and its corner off the shared edge; false beyond the rim.
  bool neighbour(int column, int row, int half, int edge, Vector3& normal, Vector3& opposite) const;
  std::array<Vector3, 3> corners(int column, int row, int half) const;

  int columns_, rows_;
  double tile_;
  Vector3 scale_ = Vector3::Ones();
  std::pmr::vector<double> heights_;
  std::pmr::vector<Range> blocks_;  // row after row
  Eigen::AlignedBox3d bounds_;
};

}  // namespace breve
