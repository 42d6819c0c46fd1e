// The faces of a convex solid, and the edges between them, in a tree by where they look: what separates a few points
// best from a solid of thousands of faces is found among few of these.
#pragma once

#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/math.hpp"

namespace breve {

struct Polyhedron;

class FaceTree {
 public:
  /// The directions of all outward normals in some faces and on the arcs of edges whose left face is one of these, as a
  /// box; and a point of the solid next to them.
  struct Node {
    Vector3 middle, half;
    Vector3 point;
    double outside;           // how far that point may be outside these faces, by round-off
    std::uint32_t first = 0;  // of a leaf its first face, else its second child; the first child is the next node
    std::uint32_t count = 0;  // faces of a leaf

    /// No direction in the box leads farther along `v`.
    double along(const Vector3& v) const { return middle.dot(v) + half.dot(v.cwiseAbs()); }
    /// No supporting plane of the solid with a normal in the box is lower under all corners.
    double height(const std::array<Vector3, 3>& corners) const {
      return outside + std::min({along(corners[0] - point), along(corners[1] - point), along(corners[2] - point)});
    }
  };

  explicit FaceTree(std::pmr::memory_resource* memory)
      : nodes_(memory), order_(memory), edges_(memory), first_edge_(memory) {}
  FaceTree(const FaceTree& other, std::pmr::memory_resource* memory)
      : nodes_(other.nodes_, memory),
        order_(other.order_, memory),
        edges_(other.edges_, memory),
        first_edge_(other.first_edge_, memory) {}

  void clear();
  bool empty() const { return nodes_.empty(); }
  /// @param solid  with planes and edges
  void build(const Polyhedron& solid);
  /// The numbers of the edges whose left face it is.
  std::span<const std::uint32_t> edges_of(std::uint32_t face) const {
    return std::span(edges_).subspan(first_edge_[face], first_edge_[face + 1] - first_edge_[face]);
  }

  /// Visit all faces of leaves whose bound is above `least`, which may rise meanwhile, and perhaps some more. What
  /// promises most comes first.
  /// @param bound  of a node; no more for a node within it
  template <class Bound, class Visit>
  void search(const double& least, const Bound& bound, const Visit& visit) const {
    struct Task {
      std::uint32_t node;
      double bound;
    };
    std::array<Task, kDeepest> stack;
    std::size_t top = 0;
    stack[top++] = {0, bound(nodes_[0])};
    while (top > 0) {
      const Task task = stack[--top];
      if (!(task.bound > least)) continue;
      const Node& node = nodes_[task.node];
      for (std::uint32_t i = 0; i < node.count; ++i) visit(order_[node.first + i]);
      if (node.count > 0) continue;
      const Task first{task.node + 1, bound(nodes_[task.node + 1])}, second{node.first, bound(nodes_[node.first])};
      const bool first_last = first.bound < second.bound;
      stack[top++] = first_last ? first : second;
      stack[top++] = first_last ? second : first;
    }
  }

 private:
  static constexpr std::size_t kDeepest = 64;  // halving 4,000 faces goes 12 deep
  Node node_of(const Polyhedron& solid, std::uint32_t begin, std::uint32_t end) const;

  std::pmr::vector<Node> nodes_;
  std::pmr::vector<std::uint32_t> order_;               // faces, leaf by leaf
  std::pmr::vector<std::uint32_t> edges_, first_edge_;  // edges by their left face
};

}  // namespace breve
