// Insertion by the surface area heuristic (Goldsmith and Salmon, 1987). On the way back up, rotations that make boxes
// smaller keep queries short (Kopta and others, 2012); rotations by height step in only where boxes say nothing, as
// where many stand in one place.
#include "runtime/space/box_tree.hpp"

#include <algorithm>

namespace breve {

namespace {

double area(const Eigen::AlignedBox3d& box) {
  const Vector3 d = box.max() - box.min();
  return d.x() * d.y() + d.y() * d.z() + d.z() * d.x();
}

}  // namespace

std::uint32_t BoxTree::make_node() {
  if (free_ == kNoLeaf) {
    nodes_.emplace_back();
    return static_cast<std::uint32_t>(nodes_.size() - 1);
  }
  const std::uint32_t node = free_;
  free_ = nodes_[node].left;
  nodes_[node] = Node();
  return node;
}

void BoxTree::drop_node(std::uint32_t node) {
  nodes_[node].left = free_;
  free_ = node;
}

BoxTree::Leaf BoxTree::insert(const Eigen::AlignedBox3d& box, std::uint32_t item) {
  const std::uint32_t leaf = make_node();
  nodes_[leaf].box = box;
  nodes_[leaf].item = item;
  link(leaf);
  return leaf;
}

void BoxTree::remove(Leaf leaf) {
  unlink(leaf);
  drop_node(leaf);
}

void BoxTree::move(Leaf leaf, const Eigen::AlignedBox3d& box) {
  // A leaf that moves a little keeps its position in the tree; rotations improve it if needed.
  if (nodes_[leaf].box.intersects(box)) {
    nodes_[leaf].box = box;
    refit_up(nodes_[leaf].parent);
    return;
  }
  unlink(leaf);
  nodes_[leaf].box = box;
  link(leaf);
}

std::uint32_t BoxTree::best_sibling(const Eigen::AlignedBox3d& box) const {
  std::uint32_t node = root_;
  while (nodes_[node].left != kNoLeaf) {
    const Node& here = nodes_[node];
    const double merged = area(here.box.merged(box));
    const double stop_cost = 2 * merged;
    const double inherited = 2 * (merged - area(here.box));
    const auto descend_cost = [&](std::uint32_t child) {
      const Node& c = nodes_[child];
      const double grown = area(c.box.merged(box));
      return inherited + (c.left == kNoLeaf ? grown : grown - area(c.box));
    };
    const double left = descend_cost(here.left);
    const double right = descend_cost(here.right);
    if (stop_cost < left && stop_cost < right) break;
    const bool tie = left == right;  // then the lower side, or boxes in one place would make a chain
    const bool go_left = tie ? nodes_[here.left].height <= nodes_[here.right].height : left < right;
    node = go_left ? here.left : here.right;
  }
  return node;
}

void BoxTree::replace_child(std::uint32_t parent, std::uint32_t old_child, std::uint32_t new_child) {
  if (parent == kNoLeaf) {
    root_ = new_child;
  } else if (nodes_[parent].left == old_child) {
    nodes_[parent].left = new_child;
  } else {
    nodes_[parent].right = new_child;
  }
}

void BoxTree::link(std::uint32_t leaf) {
  if (root_ == kNoLeaf) {
    root_ = leaf;
    nodes_[leaf].parent = kNoLeaf;
    return;
  }
  const std::uint32_t sibling = best_sibling(nodes_[leaf].box);
  const std::uint32_t parent = make_node();
  const std::uint32_t above = nodes_[sibling].parent;
  nodes_[parent].parent = above;
  nodes_[parent].left = sibling;
  nodes_[parent].right = leaf;
  replace_child(above, sibling, parent);
  nodes_[sibling].parent = parent;
  nodes_[leaf].parent = parent;
  refit_up(parent);
}

void BoxTree::unlink(std::uint32_t leaf) {
  if (leaf == root_) {
    root_ = kNoLeaf;
    return;
  }
  const std::uint32_t parent = nodes_[leaf].parent;
  const std::uint32_t above = nodes_[parent].parent;
  const std::uint32_t sibling = nodes_[parent].left == leaf ? nodes_[parent].right : nodes_[parent].left;
  replace_child(above, parent, sibling);
  nodes_[sibling].parent = above;
  drop_node(parent);
  refit_up(above);
}

void BoxTree::fit(std::uint32_t node) {
  Node& n = nodes_[node];
  n.box = nodes_[n.left].box.merged(nodes_[n.right].box);
  n.height = 1 + std::max(nodes_[n.left].height, nodes_[n.right].height);
}

void BoxTree::refit_up(std::uint32_t node) {
  while (node != kNoLeaf) {
    const Eigen::AlignedBox3d before = nodes_[node].box;
    const std::int32_t height = nodes_[node].height;
    fit(node);
    tighten(node);
    node = balance(node);
    const Node& now = nodes_[node];
    // Above, nothing has changed.
    if (now.height == height && now.box.min() == before.min() && now.box.max() == before.max()) return;
    node = now.parent;
  }
}

void BoxTree::exchange(std::uint32_t node, std::uint32_t child, std::uint32_t nephew) {
  const std::uint32_t sibling = nodes_[nephew].parent;
  replace_child(node, child, nephew);
  replace_child(sibling, nephew, child);
  nodes_[nephew].parent = node;
  nodes_[child].parent = sibling;
  fit(sibling);
  fit(node);
}

void BoxTree::tighten(std::uint32_t node) {
  // Each child may change places with a child of its sibling; the exchange that shrinks the sibling most is done.
  const std::uint32_t children[2] = {nodes_[node].left, nodes_[node].right};
  double best = 0;
  std::uint32_t best_child = kNoLeaf;
  std::uint32_t best_nephew = kNoLeaf;
  for (int i = 0; i < 2; ++i) {
    const Node& sibling = nodes_[children[1 - i]];
    if (sibling.left == kNoLeaf) continue;
    const Eigen::AlignedBox3d& box = nodes_[children[i]].box;
    const double now = area(sibling.box);
    const double without_left = area(box.merged(nodes_[sibling.right].box)) - now;
    const double without_right = area(box.merged(nodes_[sibling.left].box)) - now;
    if (without_left < best) {
      best = without_left;
      best_child = children[i];
      best_nephew = sibling.left;
    }
    if (without_right < best) {
      best = without_right;
      best_child = children[i];
      best_nephew = sibling.right;
    }
  }
  if (best_child != kNoLeaf) exchange(node, best_child, best_nephew);
}

std::uint32_t BoxTree::balance(std::uint32_t node) {
  constexpr std::int32_t kMostLean = 4;  // levels; loose, so that boxes decide where they can
  const Node& n = nodes_[node];
  const std::int32_t lean = nodes_[n.right].height - nodes_[n.left].height;
  if (lean > kMostLean) return rotate_up(node, n.right, true);
  if (lean < -kMostLean) return rotate_up(node, n.left, false);
  return node;
}

std::uint32_t BoxTree::rotate_up(std::uint32_t node, std::uint32_t child, bool child_is_right) {
  // `child` takes the place of `node`, keeps its taller child, and hands the shorter one to `node`.
  std::uint32_t tall = nodes_[child].left;
  std::uint32_t low = nodes_[child].right;
  if (nodes_[tall].height < nodes_[low].height) std::swap(tall, low);
  const std::uint32_t above = nodes_[node].parent;
  replace_child(above, node, child);
  nodes_[child].parent = above;
  nodes_[child].left = node;
  nodes_[child].right = tall;
  nodes_[node].parent = child;
  (child_is_right ? nodes_[node].right : nodes_[node].left) = low;
  nodes_[low].parent = node;
  fit(node);
  fit(child);
  return child;
}

void BoxTree::query(const Eigen::AlignedBox3d& box, std::pmr::vector<std::uint32_t>& items) {
  if (root_ == kNoLeaf) return;
  stack_.clear();
  stack_.push_back(root_);
  while (!stack_.empty()) {
    const Node& node = nodes_[stack_.back()];
    stack_.pop_back();
    if (!node.box.intersects(box)) continue;
    if (node.left == kNoLeaf) {
      items.push_back(node.item);
    } else {
      stack_.push_back(node.right);
      stack_.push_back(node.left);
    }
  }
}

}  // namespace breve
