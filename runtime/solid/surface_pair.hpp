// Pairs of which one or both are surfaces of triangles: behind contact.hpp and manifold.hpp.
#pragma once

#include "runtime/solid/manifold.hpp"
#include "runtime/solid/pair.hpp"
#include "runtime/solid/surface.hpp"

namespace breve {

/// One surface, and a convex solid against it. The smaller of two meshes takes part as its hull, or the second if both
/// have one size; so does a mesh against a height field. Two height fields are ground both, and never touch.
struct SurfacePair {
  const Surface* surface = nullptr;  // null: never touch
  bool convex_is_a = true;
  Placed convex, frame;  // frame: where the surface is

  SurfacePair(const Shape& a, const Placed& pa, const Shape& b, const Placed& pb);
};

/// As find_gap. Never touching: an infinite distance; so perhaps what is farther apart than `limit`. `counters` may be
/// null.
Gap surface_gap(const Shape& a, const Placed& pa, const Shape& b, const Placed& pb, double limit,
                NarrowCounters* counters);

/// Append the manifolds, in the world axes and origin of `pa` and `pb`.
void surface_manifolds(const Shape& a, const Placed& pa, const Shape& b, const Placed& pb, double margin,
                       const Slack& slack, std::pmr::vector<Manifold>& out, NarrowCounters* counters);

/// The bounds of a placed convex solid in the frame of another.
Eigen::AlignedBox3d bounds_in(const Placed& frame, const Placed& solid);

}  // namespace breve
