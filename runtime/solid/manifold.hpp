// The points where two solids touch or nearly do: what contact forces act on. Behind every contact solver.
#pragma once

#include <array>
#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/solid/contact.hpp"

namespace breve {

/// A point where two solids touch or nearly do.
struct ContactPoint {
  Vector3 on_a = Vector3::Zero(), on_b = Vector3::Zero();  // world, m; on the two surfaces
  double distance = 0;                                     // m along the normal: (on_a - on_b) . normal; < 0: overlap
  std::uint32_t feature = 0;  // the same while the same features touch: for warm starting and snapshots
};

constexpr int kMostPoints = 4;

/// Points that share one normal (unit, from b toward a), the deepest first. Of more than four, four that span a large
/// area are kept, and the deepest (to 1e-4 of the size, so that the choice does not tremble).
struct Manifold {
  Vector3 normal = Vector3::UnitY();
  int count = 0;
  std::array<ContactPoint, kMostPoints> points;
};

/// What a pair remembers from one step to the next, so that the next look starts warm. Plain data: it may stand in a
/// snapshot, and belongs there, since a warm start may change the last bit of a result. A new one is cold.
struct PairCache {
  Vector3 axis = Vector3::Zero();  // unit, in a's frame, from b toward a: the last normal or separating axis; 0: none,
                                   // or so far away that its square is not a number
  std::uint32_t feature = 0;       // the reference feature that the axis comes from; 0: none
  std::uint32_t apart = 0;         // 1 if the pair was apart: the axis is tried first

  bool cold() const { return feature == 0 && apart == 0 && axis == Vector3::Zero(); }
};

/// All manifolds of a pair whose gap is below `margin` (m, finite, >= 0), appended to `out`. Two convex solids give
/// none or one; a mesh or height field gives one for each patch of nearly coplanar triangles. Deterministic; allocates
/// in `out` only.
///
/// Normal and distance of the deepest point are those of `closest`, but that a face is preferred to an edge, and the
/// larger solid's face to the smaller's, while it costs less than 1e-3 of the size: so a box that rests does
/// not change its normal with every rounding. Sources: separating axes as in gap.hpp; the incident face is clipped
/// against the reference face by the method of Sutherland and Hodgman (1974).
void find_manifolds(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, double margin,
                    std::pmr::vector<Manifold>& out);
/// The same, warm.
void find_manifolds(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, double margin,
                    std::pmr::vector<Manifold>& out, PairCache& cache, NarrowCounters& counters);

}  // namespace breve
