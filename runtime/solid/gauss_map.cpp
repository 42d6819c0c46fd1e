// Arcs in a grid of cells over the directions.
#include "runtime/solid/gauss_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace breve {

namespace {

/// The cell of a coordinate in [-1, 1] and beyond, of so many.
int cell_of(double x, int cells) {
  return std::clamp(static_cast<int>(std::floor((std::clamp(x, -1.0, 1.0) + 1) / 2 * cells)), 0, cells - 1);
}

std::size_t index_of(int x, int y, int z, int cells) { return static_cast<std::size_t>((x * cells + y) * cells + z); }

}  // namespace

ArcBall ArcBall::between(const Vector3& from, const Vector3& to) {
  constexpr double kOpposite = 1e-6;
  const Vector3 sum = from + to;
  const double length = sum.norm();
  if (!(length > kOpposite)) return {};  // anywhere
  ArcBall ball;
  ball.middle = sum / length;
  ball.reach = (from - ball.middle).norm();
  return ball;
}

void GaussMap::clear() {
  balls_.clear();
  start_.clear();
  edges_.clear();
  wide_.clear();
  most_reach_ = 0;
}

void GaussMap::build(std::pmr::vector<ArcBall> balls) {
  clear();
  balls_ = std::move(balls);
  const auto cell = [](const ArcBall& ball) {
    return index_of(cell_of(ball.middle.x(), kCells), cell_of(ball.middle.y(), kCells),
                    cell_of(ball.middle.z(), kCells), kCells);
  };
  start_.assign(static_cast<std::size_t>(kCells * kCells * kCells) + 1, 0);
  for (std::uint32_t edge = 0; edge < balls_.size(); ++edge) {
    if (balls_[edge].reach > kWide) {
      wide_.push_back(edge);
      continue;
    }
    ++start_[cell(balls_[edge]) + 1];
    most_reach_ = std::max(most_reach_, balls_[edge].reach);
  }
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  edges_.resize(start_.back());
  std::pmr::vector<std::uint32_t> next(start_, start_.get_allocator());
  for (std::uint32_t edge = 0; edge < balls_.size(); ++edge)
    if (!(balls_[edge].reach > kWide)) edges_[next[cell(balls_[edge])]++] = edge;
}

void GaussMap::meeting(const ArcBall& ball, std::vector<std::uint32_t>& out) const {
  out.clear();
  const auto look = [&](std::uint32_t edge) {
    if (balls_[edge].meets(ball)) out.push_back(edge);
  };
  for (const std::uint32_t edge : wide_) look(edge);
  const double most = most_reach_ + ball.reach + ArcBall::kRoundOff;
  std::array<int, 3> low{}, high{};
  for (int axis = 0; axis < 3; ++axis) {
    low[static_cast<std::size_t>(axis)] = cell_of(ball.middle[axis] - most, kCells);
    high[static_cast<std::size_t>(axis)] = cell_of(ball.middle[axis] + most, kCells);
  }
  for (int x = low[0]; x <= high[0]; ++x)
    for (int y = low[1]; y <= high[1]; ++y) {
      // Cells along z lie side by side.
      const std::size_t first = index_of(x, y, low[2], kCells), last = index_of(x, y, high[2], kCells);
      for (std::uint32_t i = start_[first]; i < start_[last + 1]; ++i) look(edges_[i]);
    }
  std::sort(out.begin(), out.end());
}

}  // namespace breve
