// Halves by the direction in which the faces differ most.
#include "runtime/solid/face_tree.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "runtime/solid/polyhedron.hpp"

namespace breve {

void FaceTree::clear() {
  nodes_.clear();
  order_.clear();
  edges_.clear();
  first_edge_.clear();
}

/// A node for the faces order_[begin, end).
FaceTree::Node FaceTree::node_of(const Polyhedron& solid, std::uint32_t begin, std::uint32_t end) const {
  constexpr double kRoundOff = 1e-14;  // of directions
  constexpr double kOpposite = 1e-6;   // faces that look away from one another have no arc between them
  Node node;
  node.point = solid.vertices[at(solid.faces[order_[(begin + end) / 2]][0])];
  node.outside = 0;
  Eigen::AlignedBox3d box;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Plane& plane = solid.planes[order_[i]];
    box.extend(plane.normal);
    node.outside = std::max(node.outside, plane.normal.dot(node.point) - plane.offset);
    for (const std::uint32_t e : edges_of(order_[i])) {
      const Edge& edge = solid.edges[e];
      const Vector3& other = solid.planes[at(edge.right)].normal;
      const double between = 1 + plane.normal.dot(other);
      if (between < kOpposite) {
        box.extend(Vector3::Constant(-1)).extend(Vector3::Constant(1));
        node.outside = std::numeric_limits<double>::infinity();
        continue;
      }
      // The arc is within the triangle of its ends and of the point where its tangents there meet.
      box.extend(other).extend((plane.normal + other) / between);
      const Vector3 beyond = node.point - solid.vertices[at(edge.a)];
      const double over = std::max(plane.normal.dot(beyond), other.dot(beyond));
      node.outside = std::max(node.outside, over * 2 / (plane.normal + other).norm());
    }
  }
  node.middle = box.center();
  node.half = box.sizes() / 2 + Vector3::Constant(kRoundOff);
  return node;
}

void FaceTree::build(const Polyhedron& solid) {
  constexpr std::uint32_t kLeaf = 4;
  clear();
  const auto faces = static_cast<std::uint32_t>(solid.planes.size());
  first_edge_.assign(faces + 1, 0);
  for (const Edge& edge : solid.edges) ++first_edge_[at(edge.left) + 1];
  std::partial_sum(first_edge_.begin(), first_edge_.end(), first_edge_.begin());
  edges_.resize(solid.edges.size());
  std::iota(edges_.begin(), edges_.end(), 0U);
  std::stable_sort(edges_.begin(), edges_.end(),
                   [&](std::uint32_t p, std::uint32_t q) { return solid.edges[p].left < solid.edges[q].left; });
  order_.resize(faces);
  std::iota(order_.begin(), order_.end(), 0U);
  struct Task {
    std::uint32_t begin, end;
    std::int64_t parent;  // whose second child this is
  };
  std::pmr::vector<Task> tasks({{0, faces, -1}}, order_.get_allocator());
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    if (task.parent >= 0) nodes_[static_cast<std::size_t>(task.parent)].first = number;
    nodes_.push_back(node_of(solid, task.begin, task.end));
    if (task.end - task.begin <= kLeaf) {
      nodes_.back().first = task.begin;
      nodes_.back().count = task.end - task.begin;
      continue;
    }
    Eigen::Index axis;
    nodes_.back().half.maxCoeff(&axis);
    const std::uint32_t middle = (task.begin + task.end) / 2;
    std::nth_element(order_.begin() + task.begin, order_.begin() + middle, order_.begin() + task.end,
                     [&](std::uint32_t p, std::uint32_t q) {
                       const double x = solid.planes[p].normal[axis], y = solid.planes[q].normal[axis];
                       return x != y ? x < y : p < q;
                     });
    tasks.push_back({middle, task.end, number});
    tasks.push_back({task.begin, middle, -1});
  }
}

}  // namespace breve
