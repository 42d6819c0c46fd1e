// A k-d tree over points (Bentley, 1975), for queries that a grid of one cell size serves badly: points that crowd just
// out of reach, and many very different radii.
#pragma once

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
bool nearer_than(const Vector3& a, const Vector3& b, double radius);

}  // namespace breve
