// Cells by index and by place, and the two families of neighbourhoods.
#include "runtime/patches/grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"

namespace breve {

Grid::Grid(Cell3 counts, bool wraps, const Vector3& center, const Vector3& size)
    : counts_(counts), wraps_(wraps), center_(center), size_(size), cells_(0) {
  const auto check = [](const char* axis, int count) {
    if (count < 1)
      throw Error(ErrorCode::Argument, fmt::format("the {} count of a grid is {} (must be > 0)", axis, count));
  };
  check("x", counts.x);
  check("y", counts.y);
  check("z", counts.z);
  const std::size_t across = static_cast<std::size_t>(counts.y) * static_cast<std::size_t>(counts.z);
  if (across > kMaxCells / static_cast<std::size_t>(counts.x)) {
    throw Error(ErrorCode::Argument, fmt::format("a grid of {} x {} x {} has too many cells (at most {})", counts.x,
                                                 counts.y, counts.z, kMaxCells));
  }
  if (!center.allFinite()) throw Error(ErrorCode::Argument, "the location of a grid must be finite");
  if (!size.allFinite() || !(size.minCoeff() > 0))
    throw Error(ErrorCode::Argument, fmt::format("the size of a cell is ({}, {}, {}) (each must be finite and > 0)",
                                                 size.x(), size.y(), size.z()));
  cells_ = across * static_cast<std::size_t>(counts.x);
}

int Grid::wrapped(std::int64_t index, int count) {
  const std::int64_t rest = index % count;
  return static_cast<int>(rest < 0 ? rest + count : rest);
}

CellIndex Grid::at(std::int64_t x, std::int64_t y, std::int64_t z) const {
  if (x < 0 || x >= counts_.x || y < 0 || y >= counts_.y || z < 0 || z >= counts_.z) {
    if (!wraps_) return kNoCell;
    x = wrapped(x, counts_.x);
    y = wrapped(y, counts_.y);
    z = wrapped(z, counts_.z);
  }
  return index_of(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z));
}

Cell3 Grid::cell(CellIndex index) const {
  // 32 bits: this is in every question about neighbours, and long divisions are slow.
  const auto ny = static_cast<std::uint32_t>(counts_.y), nz = static_cast<std::uint32_t>(counts_.z);
  const std::uint32_t row = nz == 1 ? index : index / nz;
  const std::uint32_t x = row / ny;
  return {static_cast<int>(x), static_cast<int>(row - x * ny), static_cast<int>(index - row * nz)};
}

CellIndex Grid::at(const Vector3& location) const {
  const Vector3 counts(counts_.x, counts_.y, counts_.z);
  const Vector3 low = center_ - 0.5 * counts.cwiseProduct(size_);
  const Vector3 position = (location - low).cwiseQuotient(size_);
  constexpr double kFar = 1e15;  // cells; beyond that a double does not tell one from the next
  if (!position.allFinite() || position.cwiseAbs().maxCoeff() > kFar) return kNoCell;
  const auto index = [&](int axis) { return static_cast<std::int64_t>(std::floor(position[axis])); };
  return at(index(0), index(1), index(2));
}

Vector3 Grid::corner(CellIndex index) const {
  const Cell3 c = cell(index);
  const Vector3 counts(counts_.x, counts_.y, counts_.z);
  return center_ - 0.5 * counts.cwiseProduct(size_) + Vector3(c.x, c.y, c.z).cwiseProduct(size_);
}

Grid::Walk Grid::walk(int from, int n, int count) const {
  const std::int64_t far = std::max(n, 0);
  if (!wraps_) {
    const std::int64_t first = std::max<std::int64_t>(0, from - far),
                       last = std::min<std::int64_t>(count - 1, from + far);
    return {static_cast<int>(first), static_cast<int>(last - first + 1), count};
  }
  // Once around is everything: what follows would be duplicates.
  return {wrapped(from - far, count), static_cast<int>(std::min<std::int64_t>(2 * far + 1, count)), count};
}

void Grid::save(ByteWriter& out) const {
  for (const int n : {counts_.x, counts_.y, counts_.z}) out.put(static_cast<std::int32_t>(n));
  out.put(wraps_);
  out.put(center_);
  out.put(size_);
}

Grid Grid::load(ByteReader& in) {
  Cell3 counts;
  for (int* n : {&counts.x, &counts.y, &counts.z}) *n = in.get<std::int32_t>();
  const bool wraps = in.get_bool();
  const Vector3 center = in.get_vector();
  const Vector3 size = in.get_vector();
  try {
    return {counts, wraps, center, size};
  } catch (const Error&) {
    ByteReader::fail();
  }
}

void Grid::hash(Hasher& hasher) const {
  for (const int n : {counts_.x, counts_.y, counts_.z}) hasher.add(static_cast<std::uint64_t>(n));
  hasher.add(static_cast<std::uint64_t>(wraps_));
  hasher.add(center_);
  hasher.add(size_);
}

}  // namespace breve
