// The grid as a plain array over the box about all points: a row of cells is found by arithmetic, and queries that go
// through space in order go through memory in order.
#include <algorithm>
#include <cmath>

#include "runtime/space/cell_grid.hpp"

namespace breve {

namespace {

constexpr double kCellsPerPoint = 16;       // an array may have this many; a Gaussian crowd needs about ten
constexpr double kCellsPerPointIfWide = 2;  // where cells are longer than asked anyway: few, which caches like
constexpr double kFewestCells = 4096;       // that are never too many

}  // namespace

/// The bounds of the cells of edge_, and how many there are.
double CellGrid::measure(const Vector3& low, const Vector3& high) {
  low_ = key_of(low);
  high_ = key_of(high);
  rows_ = high_.y - low_.y + 1;
  row_length_ = high_.z - low_.z + 1;
  return static_cast<double>(high_.x - low_.x + 1) * static_cast<double>(rows_) * static_cast<double>(row_length_);
}

/// Choose edge_ and count the points in their cells. False where an array will not do.
bool CellGrid::fit(const std::pmr::vector<Vector3>& points) {
  Vector3 low = Vector3::Zero(), high = Vector3::Zero();
  if (!points.empty()) low = high = points.front();
  for (const Vector3& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  edge_ = cell_size_;
  const auto count_of_points = static_cast<double>(points.size());
  double cells = measure(low, high);
  const bool wide = cells > std::max(kFewestCells, kCellsPerPoint * count_of_points);
  const double most = std::max(kFewestCells, kCellsPerPointIfWide * count_of_points);
  // A cube has its answer after a round or two; a thin world needs more, as it does not shrink along each side. Small
  // steps at the end: two worlds of one density are to have nearly the same crowd in a cell.
  constexpr double kGrowth = 1.02;
  while (wide && cells > most) {
    edge_ *= kGrowth * std::cbrt(cells / most);
    if (!std::isfinite(edge_)) return false;
    cells = measure(low, high);
  }
  starts_.assign(static_cast<std::size_t>(cells) + 2, 0);
  return count(points) || !wide;
}

/// Two places further on than where the cell's points will begin, so that scatter() leaves the starts in place.
/// @return false if many points share cells
bool CellGrid::count(const std::pmr::vector<Vector3>& points) {
  constexpr std::uint64_t kMostCompany = 4;  // points in the cell of a point, on average
  std::uint64_t company = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CellKey key = key_of(points[i]);
    const std::size_t cell = row(key.x, key.y) + static_cast<std::size_t>(key.z - low_.z);
    cell_of_point_[i] = static_cast<std::uint32_t>(cell);
    company += 2 * starts_[cell + 2]++ + 1;  // the sum of these odd numbers is the square of the count
  }
  return company <= kMostCompany * points.size();
}

void CellGrid::scatter(const std::pmr::vector<Vector3>& points) {
  std::uint32_t begin = 0;
  for (std::uint32_t& start : starts_) start = begin += start;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t slot = starts_[cell_of_point_[i] + 1]++;
    order_[slot] = static_cast<std::uint32_t>(i);
    sorted_points_[slot] = points[i];
  }
}

}  // namespace breve
