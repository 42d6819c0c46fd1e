// A dynamic tree of axis-aligned boxes: insert, move, ask what a box meets; kept tight by rotations as it grows.
// Which boxes are found never depends on the shape of the tree.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/base/math.hpp"

namespace breve {

class BoxTree {
 public:
  using Leaf = std::uint32_t;
  static constexpr Leaf kNoLeaf = 0xffffffffU;

  explicit BoxTree(std::pmr::memory_resource* memory) : nodes_(memory), stack_(memory) {}

  /// @param box   finite; kept as given, so grow it by what it may move before the next update
  /// @param item  what queries report
  Leaf insert(const Eigen::AlignedBox3d& box, std::uint32_t item);
  void remove(Leaf leaf);
  void move(Leaf leaf, const Eigen::AlignedBox3d& box);
  const Eigen::AlignedBox3d& box(Leaf leaf) const { return nodes_[leaf].box; }
  /// Append the items whose boxes meet `box` (touching counts). Cost O(log n + found) for boxes that spread.
  void query(const Eigen::AlignedBox3d& box, std::pmr::vector<std::uint32_t>& items);
  std::size_t bytes() const { return nodes_.capacity() * sizeof(Node); }

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t parent = kNoLeaf;
    std::uint32_t left = kNoLeaf, right = kNoLeaf;  // kNoLeaf: a leaf. In a free node `left` is the next free one
    std::uint32_t item = 0;
    std::int32_t height = 0;
  };
  std::uint32_t make_node();
  void drop_node(std::uint32_t node);
  void link(std::uint32_t leaf);
  void unlink(std::uint32_t leaf);
  std::uint32_t best_sibling(const Eigen::AlignedBox3d& box) const;
  void refit_up(std::uint32_t node);
  void tighten(std::uint32_t node);
  void exchange(std::uint32_t node, std::uint32_t child, std::uint32_t nephew);
  std::uint32_t balance(std::uint32_t node);
  std::uint32_t rotate_up(std::uint32_t node, std::uint32_t child, bool child_is_right);
  void fit(std::uint32_t node);
  void replace_child(std::uint32_t parent, std::uint32_t old_child, std::uint32_t new_child);

  std::pmr::vector<Node> nodes_;
  std::pmr::vector<std::uint32_t> stack_;
  std::uint32_t root_ = kNoLeaf;
  std::uint32_t free_ = kNoLeaf;
};

}  // namespace breve
