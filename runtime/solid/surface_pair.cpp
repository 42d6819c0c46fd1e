// A convex solid against all triangles of a surface that are near it, one by one.
#include "runtime/solid/surface_pair.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "runtime/solid/place.hpp"
#include "runtime/solid/triangle.hpp"

namespace breve {

namespace {

// Normals within 2.5 degrees are one patch: a body that rests on a gentle curve has one manifold.
constexpr double kOnePatch = 0.999;

Eigen::AlignedBox3d grown(const Eigen::AlignedBox3d& box, double by) {
  return {box.min() - Vector3::Constant(by), box.max() + Vector3::Constant(by)};
}

/// The narrowest gap of all facets; of equals that of the first.
class Narrowest final : public FacetVisitor {
 public:
  /// @param outer  out of an overlap to the outer side only
  Narrowest(const SurfacePair& pair, bool outer)
      : pair_(pair), box_(bounds_in(pair.frame, pair.convex)), outer_(outer) {
    gap.distance = std::numeric_limits<double>::infinity();
  }
  void visit(const Facet& facet) override {
    Eigen::AlignedBox3d around(facet.corner[0]);
    around.extend(facet.corner[1]).extend(facet.corner[2]);
    if (around.exteriorDistance(box_) > std::max(gap.distance, 0.0)) return;
    triangle_.set(facet);
    const Gap here = triangle_gap(pair_.convex, triangle_.placed(pair_.frame, outer_));
    if (here.distance >= gap.distance) return;
    gap = here;
    nearest = facet;
  }

  Gap gap;
  Facet nearest;

 private:
  const SurfacePair& pair_;
  Eigen::AlignedBox3d box_;  // of the convex solid, in the surface's frame
  bool outer_;
  TriangleSolid triangle_;
};

bool center_inside(const SurfacePair& pair) {
  return pair.surface->inside(pair.frame.rotation.transpose() * (pair.convex.location - pair.frame.location));
}

/// A ball whose centre is in the solid: the nearest facet is its shortest way out.
bool ball_inside(const SurfacePair& pair) { return pair.convex.solid == nullptr && center_inside(pair); }

/// Inside the solid: out through the facet that is nearest.
void push_out(const SurfacePair& pair, const Facet& nearest, Gap& gap) {
  const Placed& c = pair.convex;
  gap.normal = pair.frame.rotation * nearest.normal;
  const double plane = gap.normal.dot(pair.frame.location + pair.frame.rotation * nearest.corner[0]);
  const double low = c.solid == nullptr ? gap.normal.dot(c.location) - c.radius : -c.reach(-gap.normal);
  gap.distance = low - plane;
  gap.on_a = c.solid == nullptr ? Vector3(c.location - c.radius * gap.normal) : c.vertex(c.support(-gap.normal));
  gap.on_b = gap.on_a - gap.distance * gap.normal;
}

/// The gap with the convex solid as a.
Gap narrowest_gap(const SurfacePair& pair) {
  const bool sunk = ball_inside(pair);
  Narrowest search(pair, pair.surface->solid() && !sunk);
  const Eigen::AlignedBox3d box = bounds_in(pair.frame, pair.convex);
  // The search widens until something is found, and then to what that may hide.
  const Eigen::AlignedBox3d& all = pair.surface->bounds();
  const double farthest = box.merged(all).diagonal().norm();
  double reach = 1e-3 * pair.convex.radius;
  pair.surface->under(grown(box, reach), search);
  while (search.gap.distance > reach && reach < farthest) {
    reach = std::min(std::min(8 * reach, farthest), std::max(search.gap.distance, 2 * reach));
    pair.surface->under(grown(box, reach), search);
  }
  Gap gap = search.gap;
  if (sunk || (gap.distance > 0 && center_inside(pair))) push_out(pair, search.nearest, gap);
  return gap;
}

/// Manifolds of all facets, those of one patch together.
class Patches final : public FacetVisitor {
 public:
  Patches(const SurfacePair& pair, double margin, const Slack& slack, std::pmr::vector<Manifold>& out)
      : pair_(pair), slack_(slack), out_(out), first_(out.size()) {
    convex_.a = pair.convex;
    convex_.margin = margin;
    convex_.slack = slack;
  }
  void visit(const Facet& facet) override {
    triangle_.set(facet);
    convex_.b = triangle_.placed(pair_.frame, pair_.surface->solid());
    Manifold found;
    if (!facet_manifold(convex_, facet, near, found)) return;
    for (std::size_t i = first_; i < out_.size(); ++i) {
      if (out_[i].normal.dot(found.normal) < kOnePatch) continue;
      // The normal of the deeper one holds for both.
      if (found.points[0].distance < out_[i].points[0].distance - slack_.rim) std::swap(found, out_[i]);
      merge_manifold(found, slack_.rim, out_[i]);
      return;
    }
    out_.push_back(found);
  }

  bool near = false;  // some facet is within the margin

 private:
  const SurfacePair& pair_;
  const Slack& slack_;
  std::pmr::vector<Manifold>& out_;
  std::size_t first_;
  ConvexPair convex_;
  TriangleSolid triangle_;
};

void flip(Manifold& manifold) {
  manifold.normal = -manifold.normal;
  for (int i = 0; i < manifold.count; ++i) {
    ContactPoint& point = manifold.points[static_cast<std::size_t>(i)];
    std::swap(point.on_a, point.on_b);
  }
}

}  // namespace

SurfacePair::SurfacePair(const Shape& a, const Placed& pa, const Shape& b, const Placed& pb) {
  const bool ground_a = a.kind() == ShapeKind::HeightField, ground_b = b.kind() == ShapeKind::HeightField;
  if (ground_a && ground_b) return;
  const bool a_is_surface = is_surface(a) && (ground_a || !is_surface(b) || (!ground_b && pa.radius >= pb.radius));
  surface = a_is_surface ? a.surface() : b.surface();
  convex_is_a = !a_is_surface;
  convex = a_is_surface ? pb : pa;
  frame = a_is_surface ? pa : pb;
}

Eigen::AlignedBox3d bounds_in(const Placed& frame, const Placed& solid) {
  const Vector3 center = frame.rotation.transpose() * (solid.location - frame.location);
  if (solid.solid == nullptr) {
    return {center - Vector3::Constant(solid.radius), center + Vector3::Constant(solid.radius)};
  }
  const Matrix3 turn = frame.rotation.transpose() * solid.rotation;
  Eigen::AlignedBox3d box;
  for (const Vector3& v : solid.solid->vertices) box.extend(center + turn * v);
  return box;
}

Gap surface_gap(const Shape& a, const Placed& pa, const Shape& b, const Placed& pb) {
  const SurfacePair pair(a, pa, b, pb);
  if (pair.surface == nullptr) {
    Gap never;
    never.on_a = pa.location;
    never.on_b = pb.location;
    never.distance = std::numeric_limits<double>::infinity();
    return never;
  }
  const Gap gap = narrowest_gap(pair);
  return pair.convex_is_a ? gap : flipped(gap);
}

void surface_manifolds(const Shape& a, const Placed& pa, const Shape& b, const Placed& pb, double margin,
                       const Slack& slack, std::pmr::vector<Manifold>& out) {
  const SurfacePair pair(a, pa, b, pb);
  if (pair.surface == nullptr) return;
  const std::size_t first = out.size();
  bool near = true;
  if (!ball_inside(pair)) {
    Patches patches(pair, margin, slack, out);
    pair.surface->under(grown(bounds_in(pair.frame, pair.convex), margin), patches);
    near = patches.near || (pair.surface->solid() && center_inside(pair));
  }
  // Wholly inside, or in among facets smaller than the depth, which all left the contact to their neighbours.
  if (out.size() == first && near) {
    const Gap gap = narrowest_gap(pair);
    Manifold& manifold = out.emplace_back();
    manifold.normal = gap.normal;
    manifold.count = 1;
    manifold.points[0] = {gap.on_a, gap.on_b, gap.distance, kNearestPoint};
  }
  if (pair.convex_is_a) return;
  for (std::size_t i = first; i < out.size(); ++i) flip(out[i]);
}

}  // namespace breve
