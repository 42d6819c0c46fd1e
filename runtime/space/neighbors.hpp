// Neighbour search among centres, at one recorded time. Recording is cheap; search structures are built when asked for.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/math.hpp"
#include "runtime/space/cell_grid.hpp"
#include "runtime/space/extent.hpp"
#include "runtime/space/point_tree.hpp"

namespace breve {

class Neighbors {
 public:
  explicit Neighbors(std::pmr::memory_resource* memory);

  /// Forget the last moment; points of the next one follow in order of creation.
  void clear();
  /// @param label  what answers give for this point, beside its index
  void add(const Vector3& location, double radius, std::uint64_t label = 0) {
    points_.push_back(location);
    radii_.push_back(radius);
    labels_.push_back(label);
  }
  /// All points of this moment are there. Where space wraps, those near an edge get images beyond the opposite one, so
  /// that distances are those across it; answers never name an image, nor a point twice.
  void close(const Extent& space);
  void set_label(std::uint32_t point, std::uint64_t label);
  std::size_t size() const { return points_.size() - real_of_.size(); }
  const std::pmr::vector<Vector3>& points() const { return points_; }
  const std::pmr::vector<double>& radii() const { return radii_; }

  struct Found {
    std::span<const std::uint32_t> points;  // indices, ascending
    std::span<const std::uint64_t> labels;  // of the same points
  };
  /// The points strictly nearer to point `self` than its radius, without it. Valid until the next call. Expected cost
  /// proportional to the answer, in surroundings of similar density; no allocation after warm-up.
  Found query(std::uint32_t self);
  bool answered() const { return answered_; }  // all answers are kept: a query is a look-up
  std::size_t bytes() const;
  std::uint64_t visited() const { return visited_; }  // points looked at since clear()

 private:
  CellGrid* grid_for(double radius);
  void search(std::uint32_t self, const Vector3& center, std::pmr::vector<std::uint32_t>& out);
  void put_in_order(std::uint32_t self, std::size_t start, std::pmr::vector<std::uint32_t>& out);
  bool most_ask() const;
  void answer_all(std::uint32_t first);
  void fetch_ahead(std::uint32_t self) const;
  void add_labels(const std::pmr::vector<std::uint32_t>& found, std::pmr::vector<std::uint64_t>& labels) const;

  // Each grid serves the radii from half its cell to its cell; more kinds of radii than this go to the tree.
  static constexpr std::size_t kMostGrids = 6;
  // A query that would look at more points in cells than this asks the tree, which leaves out what is far.
  static constexpr std::size_t kMostCandidates = 512;
  // Answers kept in advance take at most this many numbers for each point.
  static constexpr std::size_t kMostKept = 64;

  struct Answer {
    std::uint32_t begin = 0, count = 0;
  };

  std::pmr::vector<Vector3> points_;
  std::pmr::vector<double> radii_;
  std::pmr::vector<std::uint64_t> labels_;
  std::pmr::vector<std::uint32_t> real_of_;  // images stand behind the points: which point each is of
  std::pmr::vector<std::uint64_t> marks_;    // a bit for each point, all 0 between searches
  std::pmr::vector<CellGrid> grids_;         // kept for their memory; the first `grid_count_` are of this moment
  std::size_t grid_count_ = 0;
  PointTree tree_;
  bool tree_built_ = false;
  std::pmr::vector<std::uint32_t> result_;
  std::pmr::vector<std::uint64_t> result_labels_;
  // Once it shows that most points ask, all are answered in the order of space, which is kind to caches.
  std::pmr::vector<std::uint32_t> kept_;
  std::pmr::vector<std::uint64_t> kept_labels_;  // of kept_
  std::pmr::vector<Answer> answers_;             // by point, into kept_
  std::size_t asked_ = 0, asked_last_time_ = 0;
  bool answered_ = false, too_many_ = false;
  std::uint64_t visited_ = 0;
};

}  // namespace breve
