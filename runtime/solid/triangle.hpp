// A convex solid against one triangle of a surface: behind manifolds, closest points and times of impact.
#pragma once

#include "runtime/solid/gap.hpp"
#include "runtime/solid/pair.hpp"
#include "runtime/solid/surface.hpp"

namespace breve {

/// A triangle as a polyhedron of two faces, without asking for memory: it is filled anew for each facet. Its face 0 is
/// the outer side; edge i runs from corner i to the next.
class TriangleSolid {
 public:
  TriangleSolid();
  TriangleSolid(const TriangleSolid&) = delete;
  TriangleSolid& operator=(const TriangleSolid&) = delete;
  void set(const Facet& facet);
  const Polyhedron& polyhedron() const { return solid_; }
  const Facet& facet() const { return facet_; }
  /// At the place of its surface.
  Placed placed(const Placed& surface, bool outer) const {
    return {&solid_, radius_, surface.location, surface.rotation, true, outer};
  }

 private:
  alignas(std::max_align_t) std::array<std::byte, 2048> bytes_;
  std::pmr::monotonic_buffer_resource memory_;
  Polyhedron solid_;
  Facet facet_;
  double radius_ = 0;  // about the origin of the surface's frame
};

/// a is a ball or polyhedron, b a triangle (Placed::flat). Exact apart; else the shortest way out: of a triangle that
/// bounds a solid (Placed::outer) to the side of its normal, of a sheet to the side where a's origin is.
/// @param enough  what is farther apart than this has no more than a distance, a lower bound beyond it
Gap triangle_gap(const Placed& a, const Placed& b, double enough = std::numeric_limits<double>::infinity());

/// The same without the points of an overlap, or of what is less than a hair apart: most who ask do not want them.
struct TriangleGap : Gap {
  FaceAxis face{0, -1};       // as best_face, where it was found on the way: a number below 0 if it was not
  bool lacks_points = false;  // `on_a` and `on_b` are not known yet
};
TriangleGap triangle_distance(const Placed& a, const Placed& b, double enough);
/// Fill in these points.
void complete(const Placed& a, const Placed& b, TriangleGap& gap);

/// Whether a triangle that bounds a solid is left backward: the way back is far shorter than the way out, or shorter
/// and shallow. Distances are negative.
/// @param size  of the smaller solid, m
bool backward(double out, double back, double size);

/// The manifold of a convex solid (pair.a) and the triangle pair.b, which is `facet` placed; false if there is none.
/// At edges that do not stand out the contact is the face's, or its neighbour's. `near` becomes true if they are within
/// the margin, manifold or not.
bool facet_manifold(const ConvexPair& pair, const Facet& facet, bool& near, Manifold& out);

/// Put the points of `more` into `into`, whose normal is nearly the same; four of all are kept.
void merge_manifold(const Manifold& more, double rim, Manifold& into);

}  // namespace breve
