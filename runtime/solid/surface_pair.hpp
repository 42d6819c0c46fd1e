// Pairs of which one or both are surfaces of triangles: behind contact.hpp and manifold.hpp.
#pragma once

#include "runtime/solid/manifold.hpp"
#include "runtime/solid/pair.hpp"
#include "runtime/solid/pieces.hpp"
#include "runtime/solid/surface.hpp"

namespace breve {

/// One surface, and a convex solid against it. The smaller of two meshes takes part as its convex pieces, or as its
/// hull if it has none; if both have one size it is the second. A mesh against a height field does likewise. Two height
/// fields are ground both, and never touch.
struct SurfacePair {
  const Surface* surface = nullptr;  // null: never touch
  bool convex_is_a = true;
  Placed convex, frame;                  // frame: where the surface is
  const ConvexPieces* pieces = nullptr;  // what `convex` is made of; null: it is one

  SurfacePair(const Shape& a, const Placed& pa, const Shape& b, const Placed& pb);
  std::size_t count() const;
  /// The same with one of the convex solids that there are, about its own centre.
  SurfacePair of(std::size_t number) const;
  /// That solid in the frame of the whole, for motions.
  Placed moving(std::size_t number) const;
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
