// A surface of any triangles, with a tree of boxes over them that is built once.
#pragma once

#include <span>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/solid/polyhedron.hpp"
#include "runtime/solid/surface.hpp"

namespace breve {

using Triangle = std::array<std::int32_t, 3>;  // indices of corners

class TriangleMesh final : public Surface {
 public:
  static constexpr std::size_t kMostTriangles = 2'000'000;

  /// Corners at equal places become one; triangles without area are left out; a closed mesh that is turned inside out
  /// is turned back. Error{Argument}: a corner that is not finite, an index out of range, no triangle that has area,
  /// more than kMostTriangles.
  TriangleMesh(std::span<const Vector3> corners, std::span<const Triangle> triangles,
               std::pmr::memory_resource* memory);

  /// After scaling.
  const std::pmr::vector<Vector3>& corners() const { return corners_; }
  const std::pmr::vector<Triangle>& triangles() const { return triangles_; }
  /// Across each edge of each triangle; -1: none, or more than one.
  const std::pmr::vector<Triangle>& neighbours() const { return neighbours_; }
  const std::pmr::vector<Vector3>& normals() const { return normals_; }
  /// The moments of the closed mesh, by the divergence theorem; meaningless for an open one.
  Moments moments() const;

  std::shared_ptr<Surface> scaled(const Vector3& factors) const override;
  void under(const Eigen::AlignedBox3d& box, FacetVisitor& visitor) const override;
  bool raycast(const Vector3& origin, const Vector3& direction, double& fraction, Facet& hit) const override;
  const Eigen::AlignedBox3d& bounds() const override { return bounds_; }
  bool solid() const override { return closed_; }
  bool inside(const Vector3& point) const override;
  void hash(Hasher& hasher) const override;
  /// The original corners and triangles; the image is read by the constructor.
  void save(ByteWriter& out) const;
  static std::shared_ptr<TriangleMesh> load(ByteReader& in);

 private:
  /// A box over some triangles: `count` of them from `first` in order_, or two nodes, the next one and `first`.
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t first = 0, count = 0;
  };
  TriangleMesh(const TriangleMesh& other, const Vector3& factors);
  void weld(std::span<const Vector3> corners, std::span<const Triangle> triangles);
  void join();
  void derive();
  void build_tree();
  Facet facet(std::uint32_t triangle) const;

  std::pmr::vector<Vector3> original_, corners_;
  std::pmr::vector<Triangle> triangles_;
  std::pmr::vector<Triangle> neighbours_;  // across each edge; -1: none, or more than one
  std::pmr::vector<Vector3> normals_;
  std::pmr::vector<std::uint8_t> active_;
  std::pmr::vector<std::uint32_t> order_;
  std::pmr::vector<Node> nodes_;
  Eigen::AlignedBox3d bounds_;
  bool closed_ = false;
};

}  // namespace breve
