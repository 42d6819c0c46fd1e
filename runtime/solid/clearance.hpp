// How far the facets of a surface are from a convex solid at least: what keeps most of a surface from being looked at.
#pragma once

#include <array>
#include <cstddef>

#include "runtime/solid/gap.hpp"
#include "runtime/solid/surface.hpp"

namespace breve {

/// Lower bounds of distances, m, at a small part of the cost of a distance. A bound that is not positive says nothing.
/// They are a hair lower than they could be, so that round-off never leaves out what touches.
class Clearance {
 public:
  /// @param surface  the bounds of the surface, in its frame
  Clearance(const Placed& convex, const Placed& frame, const Eigen::AlignedBox3d& surface);

  /// The bounds of the solid in the frame of the surface.
  const Eigen::AlignedBox3d& bounds() const { return bounds_; }
  /// No point of a box in the frame of the surface is nearer to the solid.
  double of(const Eigen::AlignedBox3d& box) const;
  /// No point of the facet's plane is nearer.
  double of_plane(const Facet& facet) const;

 private:
  static constexpr std::size_t kMostPlanes = 8;
  void choose_planes(const Vector3& surface_center);

  const Polyhedron* solid_;
  Round round_;
  double radius_;
  Matrix3 rotation_;  // from the solid's frame to the surface's
  Vector3 center_;    // of the solid, in the surface's frame
  double hair_;
  Eigen::AlignedBox3d bounds_;
  std::array<Plane, kMostPlanes> planes_;  // of the solid, those that face the middle of the surface
  std::size_t plane_count_ = 0;
  mutable int lowest_ = 0, highest_ = 0;  // vertices over the plane of the last facet
};

}  // namespace breve
