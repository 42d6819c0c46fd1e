// The tree of boxes for questions: halved at the median of the boxes' centres, along the axis where these spread most.
#include "runtime/space/box_index.hpp"

#include <algorithm>

#include "runtime/base/invariant.hpp"

namespace breve {

void BoxIndex::build(std::span<const Box> boxes) {
  boxes_.assign(boxes.begin(), boxes.end());
  nodes_.clear();
  order_.clear();
  leaf_.assign(boxes.size(), kNone);
  for (std::uint32_t item = 0; item < boxes.size(); ++item)
    if (!boxes[item].isEmpty()) order_.push_back(item);
  nodes_.reserve(order_.size());
  if (!order_.empty()) build_node(0, static_cast<std::uint32_t>(order_.size()), kNone);
  built_size_ = size_of_nodes();
}

std::uint32_t BoxIndex::build_node(std::uint32_t begin, std::uint32_t end, std::uint32_t parent) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  nodes_[index].begin = begin;
  nodes_[index].end = end;
  nodes_[index].parent = parent;
  if (end - begin > kLeafSize) {
    Box centers;
    for (std::uint32_t i = begin; i < end; ++i) centers.extend(boxes_[order_[i]].center());
    int axis = 0;
    centers.sizes().maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto at = [this](std::uint32_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t x, std::uint32_t y) {
      return boxes_[x].min()[axis] + boxes_[x].max()[axis] < boxes_[y].min()[axis] + boxes_[y].max()[axis];
    });
    build_node(begin, middle, index);
    nodes_[index].right = build_node(middle, end, index);
  } else {
    for (std::uint32_t i = begin; i < end; ++i) leaf_[order_[i]] = index;
  }
  fit(index);
  return index;
}

void BoxIndex::fit(std::uint32_t index) {
  Node& node = nodes_[index];
  node.box.setEmpty();
  if (node.right != 0) {
    node.box = nodes_[index + 1].box.merged(nodes_[node.right].box);
    return;
  }
  for (std::uint32_t i = node.begin; i < node.end; ++i) node.box.extend(boxes_[order_[i]]);
}

void BoxIndex::refit(std::span<const Box> boxes) {
  invariant(boxes.size() == boxes_.size(), "a tree of boxes follows the boxes that it was built of");
  std::copy(boxes.begin(), boxes.end(), boxes_.begin());
  for (auto index = static_cast<std::uint32_t>(nodes_.size()); index > 0; --index) fit(index - 1);
}

void BoxIndex::set(std::uint32_t item, const Box& box) {
  invariant(has(item), "an item of a tree of boxes is one that it was built of");
  boxes_[item] = box;
  for (std::uint32_t index = leaf_[item]; index != kNone; index = nodes_[index].parent) {
    const Box before = nodes_[index].box;
    fit(index);
    if (before.min() == nodes_[index].box.min() && before.max() == nodes_[index].box.max()) return;
  }
}

double BoxIndex::size_of_nodes() const {
  double sum = 0;
  for (const Node& node : nodes_)
    if (!node.box.isEmpty()) sum += node.box.sizes().sum();
  return sum;
}

std::size_t BoxIndex::bytes() const {
  return boxes_.capacity() * sizeof(Box) + nodes_.capacity() * sizeof(Node) +
         (order_.capacity() + leaf_.capacity()) * sizeof(std::uint32_t);
}

double BoxIndex::entry(const Box& box, const Vector3& start, const Vector3& inverse, const Vector3& grow, double most) {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  double first = 0, last = most;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min()[axis] - grow[axis], high = box.max()[axis] + grow[axis];
    if (!std::isfinite(inverse[axis])) {  // it does not move along this axis
      if (start[axis] < low || start[axis] > high) return kMiss;
      continue;
    }
    const double to_low = (low - start[axis]) * inverse[axis], to_high = (high - start[axis]) * inverse[axis];
    first = std::max(first, std::min(to_low, to_high));
    last = std::min(last, std::max(to_low, to_high));
  }
  // Round-off must not hide what lies in the rim of a box.
  constexpr double kHair = 1e-14;
  return first * (1 - kHair) <= last * (1 + kHair) ? first : kMiss;
}

}  // namespace breve
