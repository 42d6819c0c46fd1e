// Two faces that face one another, and the points where they touch: behind manifold.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "runtime/solid/gap.hpp"
#include "runtime/solid/manifold.hpp"

namespace breve {

/// Faces with more corners are thinned to so many: a polygon of 64 sides leaves out 0.12 % of a circle's radius.
constexpr int kMostCorners = 64;

/// A face in world axes, counter-clockwise seen from outside; `vertex` are the indices in its polyhedron.
struct PlacedFace {
  Vector3 normal;
  int index = 0, count = 0;
  std::array<Vector3, kMostCorners> corner;
  std::array<int, kMostCorners> vertex;
};

/// Lengths that count as nothing, of the size of the pair.
struct Slack {
  double preference = 0;  // by which a worse but steadier feature is taken
  double rim = 0;         // by which a point may stand beyond the rim of the reference face
};
Slack slack_of(double radius_a, double radius_b);

/// The owner of the reference face.
enum class Owner : std::uint8_t { A, B };

/// Points of `incident` within the prism over `reference` and lower over it than `margin`. False if there is none:
/// `out` is then unchanged but for the normal.
bool clip_faces(const PlacedFace& reference, const PlacedFace& incident, Owner owner, double margin, double rim,
                Manifold& out);

/// The points that a manifold keeps of all that were found, named and measured already; at most 2 kMostPoints.
void select_points(std::span<const ContactPoint> all, double slack, Manifold& out);

/// Face `index` of a polyhedron or cylinder, and the face of a polyhedron that looks most along `direction`; of equals
/// (1e-6) the first.
void place_face(const Placed& solid, int index, PlacedFace& out);
/// What of a solid looks along `direction` (unit): a face, a cap, or the line of a side as a face of two corners.
void place_facing(const Placed& solid, const Vector3& direction, PlacedFace& out);
int face_along(const Placed& solid, const Vector3& direction);

/// A number that names a feature: `kind` tells what the two indices mean.
std::uint32_t feature_name(std::uint32_t kind, std::uint32_t first, std::uint32_t second);

}  // namespace breve
