// A height field needs no tree: a place says which cells are meant. A ray walks from cell to cell.
#include "runtime/solid/height_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/base/error.hpp"

namespace breve {

namespace {

[[noreturn]] void refuse_field(const std::string& why) { throw Error(ErrorCode::Argument, "a height field " + why); }

void check_height(double height, int column, int row) {
  if (!std::isfinite(height)) {
    refuse_field(fmt::format("has height {} at column {}, row {} (must be finite)", height, column, row));
  }
}

}  // namespace

HeightGrid::HeightGrid(int columns, int rows, double tile, std::span<const double> heights,
                       std::pmr::memory_resource* memory, const Poll& poll)
    : columns_(columns), rows_(rows), tile_(tile), heights_(memory), blocks_(memory) {
  if (columns < 2 || rows < 2 || columns > kMostSide || rows > kMostSide) {
    refuse_field(fmt::format("has {} columns and {} rows (must be from 2 to {})", columns, rows, kMostSide));
  }
  if (!std::isfinite(tile) || tile <= 0)
    refuse_field(fmt::format("has tiles of size {} (must be finite and > 0)", tile));
  const auto points = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  if (heights.size() != points) {
    refuse_field(
        fmt::format("of {} columns and {} rows has {} heights (must be {})", columns, rows, heights.size(), points));
  }
  heights_.reserve(points);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      check_height(heights[heights_.size()], column, row);
      heights_.push_back(heights[heights_.size()]);
    }
    if (poll) poll();
  }
  measure(poll);
}

HeightGrid::HeightGrid(const HeightGrid& other, const Vector3& factors)
    : columns_(other.columns_),
      rows_(other.rows_),
      tile_(other.tile_),
      scale_(factors),
      heights_(other.heights_, other.heights_.get_allocator()),
      blocks_(other.blocks_, other.heights_.get_allocator()) {
  measure_bounds();
}

void HeightGrid::measure(const Poll& poll) {
  blocks_.resize(static_cast<std::size_t>(blocks_across()) * static_cast<std::size_t>(blocks_along()));
  for (int along = 0; along < blocks_along(); ++along) {
    for (int across = 0; across < blocks_across(); ++across) measure_block(across, along);
    if (poll) poll();
  }
  measure_bounds();
}

void HeightGrid::measure_block(int across, int along) {
  const int last_column = std::min((across + 1) * kBlock, columns_ - 1),
            last_row = std::min((along + 1) * kBlock, rows_ - 1);
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (int r = along * kBlock; r <= last_row; ++r) {
    for (int c = across * kBlock; c <= last_column; ++c) {
      range.low = std::min(range.low, heights_[index(c, r)]);
      range.high = std::max(range.high, heights_[index(c, r)]);
    }
  }
  block(across, along) = range;
}

void HeightGrid::measure_bounds() {
  Range range = blocks_.front();
  for (const Range& block : blocks_) range = {std::min(range.low, block.low), std::max(range.high, block.high)};
  bounds_ = box_of({0, 0, columns_ - 2, rows_ - 2}, range);
}

std::size_t HeightGrid::index(int column, int row) const {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
}

Vector3 HeightGrid::corner(int column, int row) const {
  return {(column - (columns_ - 1) / 2.0) * tile_ * scale_.x(), heights_[index(column, row)] * scale_.y(),
          (row - (rows_ - 1) / 2.0) * tile_ * scale_.z()};
}

double HeightGrid::height(int column, int row) const {
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) {
    refuse_field(fmt::format("has no column {}, row {} (there are {} and {})", column, row, columns_, rows_));
  }
  return heights_[index(column, row)];
}

void HeightGrid::set_height(int column, int row, double value) {
  const double before = height(column, row);
  check_height(value, column, row);
  heights_[index(column, row)] = value;
  bool narrower = false;
  // A corner of the grid belongs to the cells on either side of it.
  for (int along = std::max(row - 1, 0) / kBlock; along <= std::min(row, rows_ - 2) / kBlock; ++along) {
    for (int across = std::max(column - 1, 0) / kBlock; across <= std::min(column, columns_ - 2) / kBlock; ++across) {
      Range& range = block(across, along);
      // Only a height that made the range can narrow it.
      const bool made_it = before <= range.low || before >= range.high;
      range = {std::min(range.low, value), std::max(range.high, value)};
      if (made_it) measure_block(across, along);
      narrower = narrower || made_it;
    }
  }
  const double y = value * scale_.y(), old = before * scale_.y();
  bounds_.min().y() = std::min(bounds_.min().y(), y);
  bounds_.max().y() = std::max(bounds_.max().y(), y);
  if (narrower && (old <= bounds_.min().y() || old >= bounds_.max().y())) measure_bounds();
}

int HeightGrid::column_at(double x) const {
  const double position = x / (tile_ * scale_.x()) + (columns_ - 1) / 2.0;
  return static_cast<int>(std::clamp(std::floor(position), 0.0, columns_ - 2.0));
}

int HeightGrid::row_at(double z) const {
  const double position = z / (tile_ * scale_.z()) + (rows_ - 1) / 2.0;
  return static_cast<int>(std::clamp(std::floor(position), 0.0, rows_ - 2.0));
}

/// Half 0 has the corner at low x and high z, half 1 the one at high x and low z; edge 2 of both is the diagonal.
std::array<Vector3, 3> HeightGrid::corners(int column, int row, int half) const {
  const Vector3 low = corner(column, row), high = corner(column + 1, row + 1);
  if (half == 0) return {low, corner(column, row + 1), high};
  return {high, corner(column + 1, row), low};
}

bool HeightGrid::neighbour(int column, int row, int half, int edge, Vector3& normal, Vector3& opposite) const {
  int c = column, r = row;
  if (edge == 0) c += half == 0 ? -1 : 1;
  if (edge == 1) r += half == 0 ? 1 : -1;
  if (c < 0 || r < 0 || c > columns_ - 2 || r > rows_ - 2) return false;
  const auto other = corners(c, r, 1 - half);
  normal = normal_of(other[0], other[1], other[2]);
  // Edge e of one is edge e of the other; the corner off edges 0, 1, 2 is number 2, 0, 1.
  opposite = other[static_cast<std::size_t>(edge + 2) % 3];
  return true;
}

Facet HeightGrid::facet(int column, int row, int half, bool with_active) const {
  Facet f;
  f.corner = corners(column, row, half);
  f.normal = normal_of(f.corner[0], f.corner[1], f.corner[2]);
  f.index = static_cast<std::uint32_t>(2 * (row * (columns_ - 1) + column) + half);
  f.active = 0;
  if (!with_active) return f;
  for (int edge = 0; edge < 3; ++edge) {
    Vector3 normal, opposite;
    if (!neighbour(column, row, half, edge, normal, opposite) ||
        stands_out(f.normal, normal, opposite - f.corner[static_cast<std::size_t>(edge)], true)) {
      f.active = static_cast<std::uint8_t>(f.active | (1 << edge));
    }
  }
  return f;
}

bool HeightGrid::height_at(double x, double z, double& height) const {
  if (!(x >= bounds_.min().x() && x <= bounds_.max().x() && z >= bounds_.min().z() && z <= bounds_.max().z())) {
    return false;
  }
  const int c = column_at(x), r = row_at(z);
  const Vector3 low = corner(c, r), high = corner(c + 1, r + 1);
  const double u = std::clamp((x - low.x()) / (high.x() - low.x()), 0.0, 1.0);
  const double v = std::clamp((z - low.z()) / (high.z() - low.z()), 0.0, 1.0);
  // Along the two edges of the half that the place is in.
  const double third = v >= u ? corner(c, r + 1).y() : corner(c + 1, r).y();
  height = v >= u ? low.y() + v * (third - low.y()) + u * (high.y() - third)
                  : low.y() + u * (third - low.y()) + v * (high.y() - third);
  return true;
}

bool HeightGrid::inside(const Vector3& point) const {
  double height;
  return height_at(point.x(), point.z(), height) && point.y() <= height;
}

Eigen::AlignedBox3d HeightGrid::box_of(const Area& cells, const Range& heights) const {
  const Vector3 low = corner(cells.first_column, cells.first_row),
                high = corner(cells.last_column + 1, cells.last_row + 1);
  return {Vector3(low.x(), heights.low * scale_.y(), low.z()), Vector3(high.x(), heights.high * scale_.y(), high.z())};
}

void HeightGrid::visit_cell(int column, int row, const Eigen::AlignedBox3d& box, FacetVisitor& visitor) const {
  for (int half = 0; half < 2; ++half) {
    const auto at = corners(column, row, half);
    Eigen::AlignedBox3d around(at[0]);
    around.extend(at[1]).extend(at[2]);
    ++visitor.counters.boxes;
    if (!around.intersects(box) || !visitor.wants(around)) continue;
    ++visitor.counters.facets;
    visitor.visit(facet(column, row, half, visitor.reads_active()));
  }
}

void HeightGrid::under(const Eigen::AlignedBox3d& box, FacetVisitor& visitor) const {
  if (!box.intersects(bounds_)) return;
  const Area area{column_at(box.min().x()), row_at(box.min().z()), column_at(box.max().x()), row_at(box.max().z())};
  const int first_across = area.first_column / kBlock, last_across = area.last_column / kBlock;
  std::array<bool, (kMostSide - 2) / kBlock + 1> wanted;
  for (int along = area.first_row / kBlock; along <= area.last_row / kBlock; ++along) {
    const int first_row = std::max(along * kBlock, area.first_row),
              last_row = std::min(along * kBlock + kBlock - 1, area.last_row);
    const auto cells_of = [&](int across) -> Area {
      return {std::max(across * kBlock, area.first_column), first_row,
              std::min(across * kBlock + kBlock - 1, area.last_column), last_row};
    };
    bool any = false;
    for (int across = first_across; across <= last_across; ++across) {
      const Eigen::AlignedBox3d around = box_of(cells_of(across), block(across, along));
      ++visitor.counters.boxes;
      any |= wanted[static_cast<std::size_t>(across)] = around.intersects(box) && visitor.wants(around);
    }
    // Facets come row after row, whatever the blocks.
    for (int row = first_row; any && row <= last_row; ++row)
      for (int across = first_across; across <= last_across; ++across)
        if (wanted[static_cast<std::size_t>(across)]) visit_row(row, cells_of(across), box, visitor);
  }
}

void HeightGrid::visit_row(int row, const Area& cells, const Eigen::AlignedBox3d& box, FacetVisitor& visitor) const {
  for (int c = cells.first_column; c <= cells.last_column; ++c) {
    const double a = heights_[index(c, row)], b = heights_[index(c + 1, row)], d = heights_[index(c, row + 1)],
                 e = heights_[index(c + 1, row + 1)];
    if (std::min({a, b, d, e}) * scale_.y() <= box.max().y() && std::max({a, b, d, e}) * scale_.y() >= box.min().y())
      visit_cell(c, row, box, visitor);
  }
}

bool HeightGrid::raycast(const Vector3& origin, const Vector3& direction, double& fraction, Facet& hit) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  // The stretch of the ray over the grid, a hair longer than the bounds.
  double begin = 0, end = kNever;
  const Vector3 hair = 1e-12 * (bounds_.sizes() + bounds_.max().cwiseAbs() + origin.cwiseAbs());
  for (int i = 0; i < 3; ++i) {
    const double low = bounds_.min()[i] - hair[i] - origin[i], high = bounds_.max()[i] + hair[i] - origin[i];
    if (direction[i] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    begin = std::max(begin, std::min(low / direction[i], high / direction[i]));
    end = std::min(end, std::max(low / direction[i], high / direction[i]));
  }
  if (begin > end) return false;
  const Vector3 start = origin + begin * direction;
  int c = column_at(start.x()), r = row_at(start.z());
  const int step_c = direction.x() > 0 ? 1 : -1, step_r = direction.z() > 0 ? 1 : -1;
  for (;;) {
    double best = kNever;
    for (int half = 0; half < 2; ++half) {
      const double t = ray_meets(corners(c, r, half), origin, direction);
      if (t >= best) continue;
      best = t;
      hit = facet(c, r, half, true);
    }
    if (std::isfinite(best)) {
      fraction = best;
      return true;
    }
    // Where the ray leaves this cell: amanatides and Woo 1987.
    const Vector3 low = corner(c, r), high = corner(c + 1, r + 1);
    const double tx = direction.x() == 0 ? kNever : ((step_c > 0 ? high : low).x() - origin.x()) / direction.x();
    const double tz = direction.z() == 0 ? kNever : ((step_r > 0 ? high : low).z() - origin.z()) / direction.z();
    if (std::min(tx, tz) > end) return false;
    (tx < tz ? c : r) += tx < tz ? step_c : step_r;
    if (c < 0 || r < 0 || c > columns_ - 2 || r > rows_ - 2 || (tx == kNever && tz == kNever)) return false;
  }
}

std::shared_ptr<Surface> HeightGrid::scaled(const Vector3& factors) const {
  return std::shared_ptr<Surface>(new (heights_.get_allocator().resource()) HeightGrid(*this, factors),
                                  std::default_delete<Surface>(), heights_.get_allocator());
}

void HeightGrid::hash(Hasher& hasher) const {
  hasher.add(static_cast<std::uint64_t>(columns_));
  hasher.add(static_cast<std::uint64_t>(rows_));
  hasher.add(tile_);
  for (const double h : heights_) hasher.add(h);
}

void HeightGrid::save(ByteWriter& out) const {
  out.put(static_cast<std::int32_t>(columns_));
  out.put(static_cast<std::int32_t>(rows_));
  out.put(tile_);
  out.put(static_cast<std::uint64_t>(heights_.size()));
  out.raw(heights_.data(), heights_.size() * sizeof(double));
}

std::shared_ptr<HeightGrid> HeightGrid::load(ByteReader& in) {
  const auto columns = in.get<std::int32_t>(), rows = in.get<std::int32_t>();
  const double tile = in.get<double>();
  std::pmr::vector<double> heights(in.get_count(sizeof(double)), in.memory());
  for (double& h : heights) h = in.get<double>();
  return std::shared_ptr<HeightGrid>(new (in.memory()) HeightGrid(columns, rows, tile, heights, in.memory()),
                                     std::default_delete<HeightGrid>(), heights.get_allocator());
}

}  // namespace breve
