// A static tree of boxes for questions about space: what a box meets, what a ray meets first, what is nearest. It is
// built at once and follows its boxes when they move. The results never depend on the shape of the tree.
#pragma once

#include <cstdint>
#include <limits>
#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/math.hpp"

namespace breve {

class BoxIndex {
 public:
  using Box = Eigen::AlignedBox3d;

  explicit BoxIndex(std::pmr::memory_resource* memory)
      : boxes_(memory), nodes_(memory), order_(memory), leaf_(memory) {}

  /// The box of item i is boxes[i]; an empty one is nowhere. Cost O(n log n).
  void build(std::span<const Box> boxes);
  /// The items have other boxes; that must not be empty where they were not, and empty where they were. Cost O(n).
  void refit(std::span<const Box> boxes);
  /// One item has another box; it may become empty. Cost O(log n). Error in logic for an item that was empty at
  /// build().
  void set(std::uint32_t item, const Box& box);
  std::size_t size() const { return boxes_.size(); }
  bool has(std::uint32_t item) const { return item < leaf_.size() && leaf_[item] != kNone; }
  const Box& box(std::uint32_t item) const { return boxes_[item]; }
  /// How much larger the boxes of nodes have become since build(): 1 at first. A large number asks for a new one.
  double spread() const { return built_size_ > 0 ? size_of_nodes() / built_size_ : 1; }
  std::size_t bytes() const;

  /// Calls visit(item) for each whose box meets `box`; touching counts.
  template <class Visit>
  void meeting(const Box& box, Visit&& visit) const;
  /// Calls visit(item) for each whose box, grown by `grow` on all sides, meets start + t way for a t in [0, most],
  /// those that are entered first being asked first, roughly. `most` is read anew each time: the visitor may lower it.
  template <class Visit>
  void along(const Vector3& start, const Vector3& way, const Vector3& grow, const double& most, Visit&& visit) const;
  /// Calls visit(item) for each whose box is not farther from `point` than `most`, which the visitor may lower.
  template <class Visit>
  void around(const Vector3& point, const double& most, Visit&& visit) const;

  /// Where the way enters the box grown by `grow`, in [0, most]; infinity if it does not.
  static double entry(const Box& box, const Vector3& start, const Vector3& inverse, const Vector3& grow, double most);

 private:
  static constexpr std::uint32_t kNone = 0xffffffffU;
  static constexpr std::uint32_t kLeafSize = 4;
  static constexpr std::size_t kDeepest = 64;  // halves of 2^32 items, with room
  struct Node {
    Box box;
    std::uint32_t begin = 0, end = 0;  // its items, in order_
    std::uint32_t right = 0;           // 0: a leaf; the left child follows its parent
    std::uint32_t parent = kNone;
  };
  std::uint32_t build_node(std::uint32_t begin, std::uint32_t end, std::uint32_t parent);
  void fit(std::uint32_t node);
  double size_of_nodes() const;

  std::pmr::vector<Box> boxes_;            // by item
  std::pmr::vector<Node> nodes_;           // children behind their parents
  std::pmr::vector<std::uint32_t> order_;  // items, by leaf
  std::pmr::vector<std::uint32_t> leaf_;   // by item: its node; kNone: nowhere
  double built_size_ = 0;
};

template <class Visit>
void BoxIndex::meeting(const Box& box, Visit&& visit) const {
  if (nodes_.empty()) return;
  std::uint32_t waiting[kDeepest], count = 0;
  waiting[count++] = 0;
  while (count > 0) {
    const std::uint32_t at = waiting[--count];
    const Node& node = nodes_[at];
    if (!node.box.intersects(box)) continue;
    if (node.right != 0) {
      waiting[count++] = node.right;
      waiting[count++] = at + 1;
      continue;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i)
      if (boxes_[order_[i]].intersects(box)) visit(order_[i]);
  }
}

template <class Visit>
void BoxIndex::along(const Vector3& start, const Vector3& way, const Vector3& grow, const double& most,
                     Visit&& visit) const {
  if (nodes_.empty()) return;
  const Vector3 inverse = way.cwiseInverse();
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  struct Waiting {
    std::uint32_t node;
    double entry;
  } waiting[kDeepest];
  std::uint32_t count = 0;
  const auto wait = [&](std::uint32_t node) {
    const double at = entry(nodes_[node].box, start, inverse, grow, most);
    if (at != kMiss) waiting[count++] = {node, at};
  };
  wait(0);
  while (count > 0) {
    const Waiting next = waiting[--count];
    if (next.entry > most) continue;
    const Node& node = nodes_[next.node];
    if (node.right == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i)
        if (entry(boxes_[order_[i]], start, inverse, grow, most) != kMiss) visit(order_[i]);
      continue;
    }
    const std::uint32_t before = count;
    wait(node.right);
    wait(next.node + 1);
    // The nearer child is asked first.
    if (count == before + 2 && waiting[before].entry < waiting[before + 1].entry)
      std::swap(waiting[before], waiting[before + 1]);
  }
}

template <class Visit>
void BoxIndex::around(const Vector3& point, const double& most, Visit&& visit) const {
  if (nodes_.empty()) return;
  struct Waiting {
    std::uint32_t node;
    double distance;
  } waiting[kDeepest];
  std::uint32_t count = 0;
  const auto wait = [&](std::uint32_t node) {
    const double distance = nodes_[node].box.exteriorDistance(point);
    if (distance <= most) waiting[count++] = {node, distance};
  };
  wait(0);
  while (count > 0) {
    const Waiting next = waiting[--count];
    if (next.distance > most) continue;
    const Node& node = nodes_[next.node];
    if (node.right == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i)
        if (boxes_[order_[i]].exteriorDistance(point) <= most) visit(order_[i]);
      continue;
    }
    const std::uint32_t before = count;
    wait(node.right);
    wait(next.node + 1);
    if (count == before + 2 && waiting[before].distance < waiting[before + 1].distance)
      std::swap(waiting[before], waiting[before + 1]);
  }
}

}  // namespace breve
