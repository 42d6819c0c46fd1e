// A surface of triangles: what triangle meshes and height fields have in common. The narrow phase asks it for the
// triangles near a solid, one after the other, in an order that never changes.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <memory_resource>

#include "runtime/base/hasher.hpp"
#include "runtime/base/math.hpp"
#include "runtime/base/memory.hpp"

namespace breve {

/// A triangle, counter-clockwise seen from outside. Edge i runs from corner i to the next.
struct Facet {
  std::array<Vector3, 3> corner;
  Vector3 normal;           // unit, outward
  std::uint32_t index = 0;  // its name in the surface
  std::uint8_t active = 7;  // bit i: edge i stands out, so that something can touch it; not set where neighbours are
                            // nearly coplanar or fold inward: a contact there is the face's (no ghost contacts)
};

/// What a search for facets did, for tests and reports.
struct FacetCounters {
  std::uint64_t boxes = 0;   // of many facets or one, that were looked at
  std::uint64_t facets = 0;  // visited
};

/// Called for each facet found.
class FacetVisitor {
 public:
  /// May a facet in this box be of interest? Asked of boxes about many facets and of the box about one, before any
  /// facet is made; the answer may become false as the search goes on, and never true again.
  virtual bool wants(const Eigen::AlignedBox3d&) const { return true; }
  virtual void visit(const Facet& facet) = 0;
  /// Does it read Facet::active? A surface may leave that out otherwise: it costs more than all the rest.
  virtual bool reads_active() const { return false; }

  FacetCounters counters;

 protected:
  ~FacetVisitor() = default;
};

class Surface : public InMemory {
 public:
  virtual ~Surface() = default;
  /// The same surface, stretched from its original size.
  virtual std::shared_ptr<Surface> scaled(const Vector3& factors) const = 0;
  /// Visit the facets whose bounds meet `box` and are wanted. Cost: what is not wanted as a whole is left out as a
  /// whole.
  virtual void under(const Eigen::AlignedBox3d& box, FacetVisitor& visitor) const = 0;
  /// First facet on a ray at t >= 0 in lengths of `direction`; false on a miss.
  virtual bool raycast(const Vector3& origin, const Vector3& direction, double& fraction, Facet& hit) const = 0;
  /// Do the bounds of some facet meet `box`?
  bool meets(const Eigen::AlignedBox3d& box) const;
  virtual const Eigen::AlignedBox3d& bounds() const = 0;
  /// Does it bound a solid? Then it has an outside, and what is inside is pushed out; else both sides are alike.
  virtual bool solid() const = 0;
  /// Is a point in the solid? False for a surface that bounds none.
  virtual bool inside(const Vector3& point) const = 0;
  virtual void hash(Hasher& hasher) const = 0;

 protected:
  Surface() = default;
  Surface(const Surface&) = default;
};

/// Unit normal of a triangle, counter-clockwise; zero if it has no area.
Vector3 normal_of(const Vector3& a, const Vector3& b, const Vector3& c);
/// Where a ray meets a triangle; t >= 0, or infinity. Rim counts as inside, so that a ray finds no way between two
/// triangles. Source: Möller and Trumbore 1997, with the scaled tolerance at the rim.
double ray_meets(const std::array<Vector3, 3>& corner, const Vector3& origin, const Vector3& direction);
/// Does an edge between two faces stand out? `opposite`: the corner of the neighbour that is not on the edge, less one
/// that is. In a surface that bounds no solid folds stand out on one side or the other.
bool stands_out(const Vector3& normal, const Vector3& neighbour, const Vector3& opposite, bool solid);

}  // namespace breve
