// A k-d tree over points (Bentley, 1975), for queries that a grid of one cell size serves badly: points that crowd just
// out of reach, and many very different radii.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/base/math.hpp"

namespace breve {

class PointTree {
 public:
  explicit PointTree(std::pmr::memory_resource* memory) : nodes_(memory), order_(memory) {}

  /// Cost O(n log n).
  void build(const std::pmr::vector<Vector3>& points);
  /// Append the indices of the points strictly nearer than `radius` to `center`, in no order that means anything.
  /// @return how many points were looked at
  std::size_t within(const std::pmr::vector<Vector3>& points, const Vector3& center, double radius,
                     std::pmr::vector<std::uint32_t>& out) const;
  std::size_t bytes() const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t begin = 0, end = 0;  // its points, in order_
    std::uint32_t right = 0;           // 0: a leaf; the left child follows its parent
  };
  static constexpr std::uint32_t kLeafSize = 16;

  std::uint32_t build_node(const std::pmr::vector<Vector3>& points, std::uint32_t begin, std::uint32_t end);

  std::pmr::vector<Node> nodes_;
  std::pmr::vector<std::uint32_t> order_;
};

/// |a - b| < radius, strictly; by squares where these neither vanish nor overflow.
class Nearer {
 public:
  explicit Nearer(double radius)
      : radius_(radius), square_(radius * radius), by_squares_(radius > kSmallest && radius < kLargest) {}
  bool operator()(const Vector3& a, const Vector3& b) const {
    const Vector3 d = a - b;
    return by_squares_ ? d.squaredNorm() < square_ : std::hypot(d.x(), d.y(), d.z()) < radius_;
  }

 private:
  static constexpr double kSmallest = 1e-140, kLargest = 1e140;  // squares between stay normal numbers
  double radius_, square_;
  bool by_squares_;
};

}  // namespace breve
