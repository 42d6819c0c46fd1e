// One pair of convex solids on its way to a manifold: what the files of the narrow phase hand to one another.
#pragma once

#include "runtime/solid/clip.hpp"

namespace breve {

/// Two convex solids in world axes with the origin in a, and what is asked of them.
struct ConvexPair {
  Placed a, b;
  double margin = 0;
  Slack slack;
  PairCache* cache = nullptr;  // may be null
  NarrowCounters* counters = nullptr;

  /// Is the gap along the remembered axis wider than the margin? The axis alone then decides.
  bool apart_by_cache() const;
  /// `axis`: unit, world, from b toward a. `feature`: what gave it.
  void remember(const Vector3& axis, std::uint32_t feature) const {
    if (cache == nullptr) return;
    cache->axis = a.rotation.transpose() * axis;
    cache->feature = feature;
  }
  bool remembers(std::uint32_t feature) const { return cache != nullptr && cache->feature == feature; }
};

constexpr std::uint32_t kFaceOfA = 0x40000000U, kFaceOfB = 0x80000000U, kEdges = 0xc0000000U;  // with the index below
constexpr std::uint32_t kNearestPoint = 1;  // the feature of a single point that no face or edge pair explains

/// The manifold of two polyhedra; false if they are farther apart than the margin. The second is for boxes: their
/// fifteen axes are known beforehand.
bool polyhedra_manifold(const ConvexPair& pair, Manifold& out);
bool boxes_manifold(const ConvexPair& pair, const Vector3& half_a, const Vector3& half_b, Manifold& out);

/// The manifold of a cylinder or capsule and anything convex except a ball.
bool round_manifold(const ConvexPair& pair, Manifold& out);

/// The remaining case, without a face: the one point of the exact gap, or two where parallel edges run beside one
/// another.
bool nearest_manifold(const ConvexPair& pair, Manifold& out);

/// Clip the face of `owner` that is its number `index` against the facing one of the other.
bool face_manifold(const ConvexPair& pair, Owner owner, int index, Manifold& out);

/// Points where two edges (start and direction, world) run nearest: one, or the ends of the stretch over which they run
/// side by side. `normal` from b toward a, `distance` along it. False if the edges are nearest elsewhere than inside
/// both.
bool edge_manifold(const Vector3& start_a, const Vector3& edge_a, const Vector3& start_b, const Vector3& edge_b,
                   const Vector3& normal, double distance, double preference, std::uint32_t feature, Manifold& out);

}  // namespace breve
