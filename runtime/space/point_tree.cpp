// Built by halving the points at the median along the widest side of their box: depth log2(n), whatever the points.
#include "runtime/space/point_tree.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace breve {

void PointTree::build(const std::pmr::vector<Vector3>& points) {
  nodes_.clear();
  order_.resize(points.size());
  std::iota(order_.begin(), order_.end(), 0U);
  if (!points.empty()) build_node(points, 0, static_cast<std::uint32_t>(points.size()));
}

std::uint32_t PointTree::build_node(const std::pmr::vector<Vector3>& points, std::uint32_t begin, std::uint32_t end) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  Node node;
  node.begin = begin;
  node.end = end;
  for (std::uint32_t i = begin; i < end; ++i) node.box.extend(points[order_[i]]);
  nodes_.push_back(node);
  const Vector3 sides = node.box.sizes();
  Eigen::Index axis = 0;
  const bool coincident = !(sides.maxCoeff(&axis) > 0);
  if (end - begin <= kLeafSize || coincident) return number;
  const std::uint32_t middle = begin + (end - begin) / 2;
  // Ties by index, so that the tree is the same everywhere.
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t i, std::uint32_t j) {
                     return points[i][axis] != points[j][axis] ? points[i][axis] < points[j][axis] : i < j;
                   });
  build_node(points, begin, middle);
  const std::uint32_t right = build_node(points, middle, end);
  nodes_[number].right = right;
  return number;
}

std::size_t PointTree::within(const std::pmr::vector<Vector3>& points, const Vector3& center, double radius,
                              std::pmr::vector<std::uint32_t>& out) const {
  if (nodes_.empty()) return 0;
  const Nearer nearer(radius);
  std::size_t looked_at = 0;
  std::array<std::uint32_t, 64> stack;  // depth is at most log2(2^32)
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t number = stack[--depth];
    const Node& node = nodes_[number];
    const Vector3 gap = (node.box.min() - center).cwiseMax(center - node.box.max()).cwiseMax(0.0);
    // A box at exactly the radius holds nothing strictly nearer; the slack covers rounding of the gap.
    constexpr double kSlack = 1e-12;
    if (gap.maxCoeff() > radius * (1 + kSlack) || gap.stableNorm() > radius * (1 + kSlack)) continue;
    if (node.right != 0) {
      stack[depth++] = node.right;
      stack[depth++] = number + 1;
      continue;
    }
    looked_at += node.end - node.begin;
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      if (nearer(points[order_[i]], center)) out.push_back(order_[i]);
    }
  }
  return looked_at;
}

std::size_t PointTree::bytes() const {
  return nodes_.capacity() * sizeof(Node) + order_.capacity() * sizeof(std::uint32_t);
}

}  // namespace breve
