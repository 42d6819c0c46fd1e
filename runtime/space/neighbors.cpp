// The query: a grid whose cells fit the radius; a k-d tree where the grid would look at too much.
#include "runtime/space/neighbors.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace breve {

Neighbors::Neighbors(std::pmr::memory_resource* memory)
    : points_(memory),
      radii_(memory),
      labels_(memory),
      real_of_(memory),
      marks_(memory),
      grids_(memory),
      tree_(memory),
      result_(memory),
      result_labels_(memory),
      kept_(memory),
      kept_labels_(memory),
      answers_(memory) {}

void Neighbors::clear() {
  points_.clear();
  radii_.clear();
  labels_.clear();
  real_of_.clear();
  asked_last_time_ = asked_;
  asked_ = 0;
  answered_ = too_many_ = false;
  grid_count_ = 0;
  tree_built_ = false;
  visited_ = 0;
}

void Neighbors::close(const Extent& space) {
  if (!space.wraps()) return;
  double reach = 0;
  for (const double radius : radii_) reach = std::max(reach, radius);
  const std::size_t count = points_.size();
  for (int i = 0; i < 3; ++i) {
    const Extent::Axis& axis = space.axis(i);
    if (axis.edge != Ending::Wrap) continue;
    const double length = axis.high - axis.low;
    // The nearest image of a point is never farther beyond an edge than half the length.
    const double near = std::min(reach, 0.5 * length);
    for (std::size_t p = 0, end = points_.size(); p < end; ++p) {
      const double x = points_[p][i];
      const auto add_image = [&](double shift) {
        Vector3 image = points_[p];
        image[i] += shift;
        real_of_.push_back(p < count ? static_cast<std::uint32_t>(p) : real_of_[p - count]);
        add(image, 0);
      };
      if (x - axis.low < near) add_image(length);
      if (axis.high - x <= near) add_image(-length);
    }
  }
}

/// The points found since `start`: images become their points, ascending, none twice, not the one who asks.
void Neighbors::put_in_order(std::uint32_t self, std::size_t start, std::pmr::vector<std::uint32_t>& out) {
  const auto begin = out.begin() + static_cast<std::ptrdiff_t>(start);
  if (!real_of_.empty()) {
    for (auto at = begin; at != out.end(); ++at)
      if (*at >= size()) *at = real_of_[*at - size()];
  }
  // Where the answer is a good part of all points, a bit for each of them sorts without comparing.
  const std::size_t words = size() / 64 + 1, found = out.size() - start;
  if (words <= found) {
    if (marks_.size() < words) marks_.resize(words);
    for (auto at = begin; at != out.end(); ++at) marks_[*at / 64] |= std::uint64_t{1} << (*at % 64);
    marks_[self / 64] &= ~(std::uint64_t{1} << (self % 64));
    out.resize(start);
    for (std::size_t word = 0; word < words; ++word) {
      for (std::uint64_t bits = std::exchange(marks_[word], 0); bits != 0; bits &= bits - 1)
        out.push_back(static_cast<std::uint32_t>(64 * word + static_cast<std::size_t>(std::countr_zero(bits))));
    }
    return;
  }
  std::sort(begin, out.end());
  if (real_of_.empty()) return;
  out.erase(std::unique(begin, out.end()), out.end());
  out.erase(std::remove(begin, out.end(), self), out.end());
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

void Neighbors::search(std::uint32_t self, const Vector3& center, std::pmr::vector<std::uint32_t>& out) {
  const double radius = radii_[self];
  if (!(radius > 0)) return;
  const std::size_t start = out.size();
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
    // Room for all; each is written, and kept by stepping on. Which are near is beyond what a processor can guess.
    out.resize(start + candidates);
    std::uint32_t* next = out.data() + start;
    const std::uint32_t* const order = grid->order().data();
    const Vector3* const points = grid->sorted_points().data();
    const Nearer nearer(radius);
    for (std::size_t i = 0; i < run_count; ++i) {
      for (std::uint32_t at = runs[i].begin; at < runs[i].end; ++at) {
        *next = order[at];
        next += static_cast<int>(nearer(points[at], center)) & static_cast<int>(order[at] != self);
      }
    }
    out.resize(static_cast<std::size_t>(next - out.data()));
  }
  put_in_order(self, start, out);
}

void Neighbors::set_label(std::uint32_t point, std::uint64_t label) {
  labels_[point] = label;
  answered_ = false;  // the answers kept have the old one
}

/// Labels of what was found since `labels` was last as long as `found`.
void Neighbors::add_labels(const std::pmr::vector<std::uint32_t>& found,
                           std::pmr::vector<std::uint64_t>& labels) const {
  for (std::size_t i = labels.size(); i < found.size(); ++i) labels.push_back(labels_[found[i]]);
}

bool Neighbors::most_ask() const { return asked_last_time_ > size() / 2 || asked_ > size() / 4; }

/// @param first  the point whose radius makes the grid that gives the order
void Neighbors::answer_all(std::uint32_t first) {
  constexpr std::size_t kAhead = 8;  // points; about as long as memory takes
  kept_.clear();
  kept_labels_.clear();
  answers_.resize(points_.size());
  grid_for(radii_[first]);
  const CellGrid* grid = grid_count_ != 0 ? &grids_.front() : nullptr;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::uint32_t point = grid ? grid->order()[i] : static_cast<std::uint32_t>(i);
    if (point >= size()) continue;  // an image asks nothing
    const std::size_t begin = kept_.size();
    if (grid && i + kAhead < points_.size()) {
      const std::uint32_t later = grid->order()[i + kAhead];
      __builtin_prefetch(radii_.data() + later);
      __builtin_prefetch(labels_.data() + later);
      __builtin_prefetch(answers_.data() + later, 1);
    }
    // A copy: the search may make another grid.
    const Vector3 center = grid ? grid->sorted_points()[i] : points_[point];
    search(point, center, kept_);
    add_labels(kept_, kept_labels_);
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

/// Answers lie in the order of space, questions mostly come in that of creation: begin to fetch what the next two will
/// want. A label is often the address of what will be counted or written; if it is not valid, a prefetch does nothing.
void Neighbors::fetch_ahead(std::uint32_t self) const {
  if (self + std::size_t{2} >= size()) return;
  const Answer& second = answers_[self + 2];
  __builtin_prefetch(kept_labels_.data() + second.begin);
  __builtin_prefetch(kept_labels_.data() + second.begin + second.count);
  constexpr std::uint32_t kMostFetched = 16;  // more would push each other out
  const Answer& next = answers_[self + 1];
  for (std::uint32_t i = 0; i < std::min(next.count, kMostFetched); ++i) {
    __builtin_prefetch(reinterpret_cast<const void*>(kept_labels_[next.begin + i]), 1);
  }
}

Neighbors::Found Neighbors::query(std::uint32_t self) {
  ++asked_;
  if (!answered_ && !too_many_ && most_ask()) answer_all(self);
  if (answered_) {
    fetch_ahead(self);
    const Answer answer = answers_[self];
    return {{kept_.data() + answer.begin, answer.count}, {kept_labels_.data() + answer.begin, answer.count}};
  }
  result_.clear();
  result_labels_.clear();
  search(self, points_[self], result_);
  add_labels(result_, result_labels_);
  return {result_, result_labels_};
}

std::size_t Neighbors::bytes() const {
  std::size_t bytes = points_.capacity() * sizeof(Vector3) + tree_.bytes() +
                      (result_.capacity() + kept_.capacity()) * sizeof(std::uint32_t) +
                      (labels_.capacity() + marks_.capacity() + result_labels_.capacity() + kept_labels_.capacity()) *
                          sizeof(std::uint64_t) +
                      radii_.capacity() * sizeof(double) + real_of_.capacity() * sizeof(std::uint32_t) +
                      answers_.capacity() * sizeof(Answer);
  for (const CellGrid& grid : grids_) bytes += grid.bytes();
  return bytes;
}

}  // namespace breve
