// The query: a grid whose cells fit the radius; a k-d tree where the grid would look at too much.
#include "runtime/space/neighbors.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace breve {

Neighbors::Neighbors(std::pmr::memory_resource* memory)
    : points_(memory),
      radii_(memory),
      grids_(memory),
      tree_(memory),
      result_(memory),
      kept_(memory),
      answers_(memory) {}

void Neighbors::clear() {
  points_.clear();
  radii_.clear();
  asked_last_time_ = asked_;
  asked_ = 0;
  answered_ = too_many_ = false;
  grid_count_ = 0;
  tree_built_ = false;
  visited_ = 0;
}

CellGrid* Neighbors::grid_for(double radius) {
  constexpr double kSmallest = 1e-290, kLargest = 1e290;  // cells of other sizes would not be normal numbers
  if (!(radius > kSmallest && radius < kLargest)) return nullptr;
  for (std::size_t i = 0; i < grid_count_; ++i) {
    if (radius <= grids_[i].cell_size() && radius > 0.5 * grids_[i].cell_size()) return &grids_[i];
  }
  if (grid_count_ == kMostGrids) return nullptr;
  if (grid_count_ == grids_.size()) grids_.emplace_back(points_.get_allocator().resource());
  // Where all radii are one, cells of just that size are the best. Others share cells with their octave.
  const double octave = std::exp2(std::ceil(std::log2(radius)));
  grids_[grid_count_].build(points_, grid_count_ == 0 || octave < radius ? radius : octave);
  return &grids_[grid_count_++];
}

void Neighbors::search(std::uint32_t self, std::pmr::vector<std::uint32_t>& out) {
  const double radius = radii_[self];
  if (!(radius > 0)) return;
  const std::size_t start = out.size();
  const Vector3& center = points_[self];
  const CellGrid* grid = grid_for(radius);
  std::array<CellGrid::Run, CellGrid::kMostRuns> runs;
  const std::size_t run_count = grid ? grid->around(center, radius, runs) : 0;
  std::size_t candidates = 0;
  for (std::size_t i = 0; i < run_count; ++i) candidates += runs[i].end - runs[i].begin;
  if (!grid || candidates > kMostCandidates) {
    if (!tree_built_) tree_.build(points_);
    tree_built_ = true;
    visited_ += tree_.within(points_, center, radius, out);
    out.erase(std::remove(out.begin() + static_cast<std::ptrdiff_t>(start), out.end(), self), out.end());
  } else {
    visited_ += candidates;
    for (std::size_t i = 0; i < run_count; ++i) {
      for (std::uint32_t at = runs[i].begin; at < runs[i].end; ++at) {
        if (nearer_than(grid->sorted_points()[at], center, radius) && grid->order()[at] != self) {
          out.push_back(grid->order()[at]);
        }
      }
    }
  }
  std::sort(out.begin() + static_cast<std::ptrdiff_t>(start), out.end());
}

bool Neighbors::most_ask() const { return asked_last_time_ > points_.size() / 2 || asked_ > points_.size() / 4; }

void Neighbors::answer_all() {
  kept_.clear();
  answers_.resize(points_.size());
  const CellGrid* grid = grid_count_ != 0 ? &grids_.front() : nullptr;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::uint32_t point = grid ? grid->order()[i] : static_cast<std::uint32_t>(i);
    const std::size_t begin = kept_.size();
    search(point, kept_);
    answers_[point] = {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(kept_.size() - begin)};
    if (kept_.size() > kMostKept * points_.size()) {
      too_many_ = true;
      return;
    }
    // The search may have made another grid, and with it moved them all.
    if (grid) grid = &grids_.front();
  }
  answered_ = true;
}

std::span<const std::uint32_t> Neighbors::query(std::uint32_t self) {
  ++asked_;
  if (!answered_ && !too_many_ && most_ask()) answer_all();
  if (answered_) return {kept_.data() + answers_[self].begin, answers_[self].count};
  result_.clear();
  search(self, result_);
  return result_;
}

std::size_t Neighbors::bytes() const {
  std::size_t bytes = points_.capacity() * sizeof(Vector3) + tree_.bytes() +
                      (result_.capacity() + kept_.capacity()) * sizeof(std::uint32_t) +
                      radii_.capacity() * sizeof(double) + answers_.capacity() * sizeof(Answer);
  for (const CellGrid& grid : grids_) bytes += grid.bytes();
  return bytes;
}

}  // namespace breve
