// The grid as a hash table: points are counted into cells, the cells are sorted, and a stable counting sort brings the
// points into their order. Cells in a plain array are in cell_array.cpp.
#include "runtime/space/cell_grid.hpp"

#include <algorithm>
#include <bit>

namespace breve {

CellGrid::CellGrid(std::pmr::memory_resource* memory)
    : starts_(memory),
      cells_(memory),
      table_(memory),
      cell_of_point_(memory),
      renumbered_(memory),
      order_(memory),
      sorted_points_(memory) {}

std::int64_t CellGrid::coordinate(double value) const {
  // Beyond 2^52 cells a double no longer tells neighbouring cells apart; what is out there shares the border cell.
  constexpr double kBorder = 4503599627370496.0;
  const double cell = value / edge_;
  if (!(cell > -kBorder)) return -(std::int64_t{1} << 52);
  if (cell >= kBorder) return std::int64_t{1} << 52;
  const auto towards_zero = static_cast<std::int64_t>(cell);
  return towards_zero - (static_cast<double>(towards_zero) > cell ? 1 : 0);
}

CellGrid::CellKey CellGrid::key_of(const Vector3& point) const {
  return {coordinate(point.x()), coordinate(point.y()), coordinate(point.z())};
}

std::uint64_t CellGrid::mix(const CellKey& key) {
  std::uint64_t h = static_cast<std::uint64_t>(key.x) * 0x9e3779b97f4a7c15ULL;
  h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(key.y)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(key.z)) * 0x94d049bb133111ebULL;
  return h ^ (h >> 29);
}

std::uint32_t CellGrid::find_or_make(const CellKey& key) {
  const std::size_t mask = table_.size() - 1;
  for (std::size_t at = mix(key) & mask;; at = (at + 1) & mask) {
    if (table_[at] == 0) {
      cells_.push_back({key, 0, 0, static_cast<std::uint32_t>(cells_.size())});
      table_[at] = static_cast<std::uint32_t>(cells_.size());
    }
    if (cells_[table_[at] - 1].key == key) return table_[at] - 1;
  }
}

const CellGrid::Cell* CellGrid::find(const CellKey& key) const {
  const std::size_t mask = table_.size() - 1;
  for (std::size_t at = mix(key) & mask; table_[at] != 0; at = (at + 1) & mask) {
    if (cells_[table_[at] - 1].key == key) return &cells_[table_[at] - 1];
  }
  return nullptr;
}

void CellGrid::sort_cells() {
  std::sort(cells_.begin(), cells_.end(), [](const Cell& a, const Cell& b) { return a.key < b.key; });
  renumbered_.resize(cells_.size());
  // A table of the size that the cells need, which is mostly far smaller than what the points might have needed.
  table_.assign(std::bit_ceil(2 * cells_.size() + 1), 0);
  const std::size_t mask = table_.size() - 1;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    std::size_t at = mix(cells_[i].key) & mask;
    while (table_[at] != 0) at = (at + 1) & mask;
    table_[at] = static_cast<std::uint32_t>(i + 1);
    renumbered_[cells_[i].number] = static_cast<std::uint32_t>(i);
  }
}

void CellGrid::build(const std::pmr::vector<Vector3>& points, double cell_size) {
  cell_size_ = cell_size;
  cell_of_point_.resize(points.size());
  order_.resize(points.size());
  sorted_points_.resize(points.size());
  in_array_ = fit(points);
  in_array_ ? scatter(points) : build_table(points);
}

void CellGrid::build_table(const std::pmr::vector<Vector3>& points) {
  edge_ = cell_size_;
  cells_.clear();
  // At most half full, even if every point has a cell of its own.
  table_.assign(std::bit_ceil(2 * points.size() + 1), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CellKey key = key_of(points[i]);
    if (i == 0) low_ = high_ = key;
    low_ = {std::min(low_.x, key.x), std::min(low_.y, key.y), std::min(low_.z, key.z)};
    high_ = {std::max(high_.x, key.x), std::max(high_.y, key.y), std::max(high_.z, key.z)};
    cell_of_point_[i] = find_or_make(key);
    ++cells_[cell_of_point_[i]].end;
  }
  sort_cells();
  std::uint32_t next = 0;
  for (Cell& cell : cells_) {
    const std::uint32_t count = cell.end;
    cell.begin = cell.end = next;
    next += count;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t slot = cells_[renumbered_[cell_of_point_[i]]].end++;
    order_[slot] = static_cast<std::uint32_t>(i);
    sorted_points_[slot] = points[i];
  }
}

CellGrid::Run CellGrid::run_in_table(std::int64_t x, std::int64_t y, std::int64_t from, std::int64_t to) const {
  // The occupied cells of a row stand side by side: the first one leads to the rest.
  const Cell* first = nullptr;
  for (std::int64_t z = from; z <= to && !first; ++z) first = find({x, y, z});
  if (!first) return {0, 0};
  const Cell* last = first;
  const Cell* const stop = cells_.data() + cells_.size();
  while (last + 1 != stop && last[1].key <= CellKey{x, y, to}) ++last;
  return {first->begin, last->end};
}

std::size_t CellGrid::around(const Vector3& center, double radius, std::array<Run, kMostRuns>& runs) const {
  std::size_t count = 0;
  const Vector3 reach = Vector3::Constant(radius);
  CellKey from = key_of(center - reach);
  CellKey to = key_of(center + reach);
  from = {std::max(from.x, low_.x), std::max(from.y, low_.y), std::max(from.z, low_.z)};
  to = {std::min(to.x, high_.x), std::min(to.y, high_.y), std::min(to.z, high_.z)};
  for (std::int64_t x = from.x; x <= to.x; ++x) {
    for (std::int64_t y = from.y; y <= to.y; ++y) {
      Run run{0, 0};
      if (in_array_) {
        const std::uint32_t* const start = starts_.data() + row(x, y);
        run = {start[from.z - low_.z], start[to.z - low_.z + 1]};
      } else {
        run = run_in_table(x, y, from.z, to.z);
      }
      if (run.begin != run.end && count < runs.size()) runs[count++] = run;
    }
  }
  return count;
}

std::size_t CellGrid::bytes() const {
  return cells_.capacity() * sizeof(Cell) + sorted_points_.capacity() * sizeof(Vector3) +
         (starts_.capacity() + table_.capacity() + cell_of_point_.capacity() + renumbered_.capacity() +
          order_.capacity()) *
             sizeof(std::uint32_t);
}

}  // namespace breve
