// A convex solid against all triangles of a surface that are near it, one by one.
#include "runtime/solid/surface_pair.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/solid/clearance.hpp"
#include "runtime/solid/place.hpp"
#include "runtime/solid/triangle.hpp"

namespace breve {

namespace {

// Normals within 2.5 degrees are one patch: a body that rests on a gentle curve has one manifold.
constexpr double kOnePatch = 0.999;

constexpr double kSunk =
    1e-3;  // of the smaller solid's radius: less deep, a facet that is left backward does not count

Eigen::AlignedBox3d grown(const Eigen::AlignedBox3d& box, double by) {
  return {box.min() - Vector3::Constant(by), box.max() + Vector3::Constant(by)};
}

Clearance clearance_of(const SurfacePair& pair) { return {pair.convex, pair.frame, pair.surface->bounds()}; }

/// The narrowest gap of all facets; of equals that of the first. Facets that are left backward
/// (triangle.hpp) count only if no other touches.
class Narrowest final : public FacetVisitor {
 public:
  /// @param outer  out of an overlap to the outer side only
  Narrowest(const SurfacePair& pair, bool outer, const NarrowCounters* asked)
      : pair_(pair), convex_(pair.convex), clearance_(clearance_of(pair)), asked_(asked), outer_(outer) {
    convex_.hints = &hints_;
    nearest.gap.distance = behind_.gap.distance = kFar;
  }
  /// All facets whose gap is at most `reach`, and perhaps some that are farther.
  void search(double reach) {
    reach_ = reach;
    pair_.surface->under(grown(clearance_.bounds(), reach), *this);
  }
  bool wants(const Eigen::AlignedBox3d& box) const override {
    return clearance_.of(box) <= farthest() && (asked_ == nullptr || !asked_->stopped());
  }
  void visit(const Facet& facet) override {
    if (clearance_.of_plane(facet) > farthest()) return;
    triangle_.set(facet);
    const TriangleGap here = triangle_distance(convex_, triangle_.placed(pair_.frame, outer_), farthest());
    if (here.back != 0) {
      const double size = std::min(pair_.convex.radius, 0.5 * pair_.surface->bounds().diagonal().norm());
      if (here.back < -kSunk * size && here.distance < behind_.gap.distance) behind_ = {here, facet};
      return;
    }
    if (here.distance >= nearest.gap.distance || here.distance > reach_) return;
    nearest = {here, facet};
  }
  /// The gap to a facet, with its points.
  struct Found {
    TriangleGap gap;
    Facet facet;
  };
  Gap complete(const Found& found) {
    TriangleGap gap = found.gap;
    if (!gap.lacks_points) return gap;
    triangle_.set(found.facet);
    breve::complete(convex_, triangle_.placed(pair_.frame, outer_), gap);
    return gap;
  }
  /// Overlaps are with facets of that kind alone, of which this is the deepest; null: they are not.
  const Found* only_behind() const { return nearest.gap.distance > 0 && behind_.gap.distance < 0 ? &behind_ : nullptr; }
  const Clearance& clearance() const { return clearance_; }

  Found nearest;

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  double farthest() const { return std::min(reach_, std::max(nearest.gap.distance, 0.0)); }

  const SurfacePair& pair_;
  Placed convex_;
  TriangleHints hints_;
  const Clearance clearance_;
  const NarrowCounters* asked_;
  bool outer_;
  double reach_ = 0;
  Found behind_;
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
  gap.on_a = c.solid == nullptr ? Vector3(c.location - c.radius * gap.normal) : c.extreme(-gap.normal);
  gap.on_b = gap.on_a - gap.distance * gap.normal;
}

/// May the convex solid be as near as that to some facet? By the ball around it.
bool may_reach(const SurfacePair& pair, double distance) {
  const Vector3 center = pair.frame.rotation.transpose() * (pair.convex.location - pair.frame.location);
  return pair.surface->meets(grown({center, center}, pair.convex.radius * (1 + 1e-12) + distance));
}

/// The gap with the convex solid as a. Solids farther apart than `limit` may have an infinite one.
Gap narrowest_gap(const SurfacePair& pair, double limit, NarrowCounters* counters) {
  const bool sunk = ball_inside(pair);
  Narrowest narrowest(pair, pair.surface->solid() && !sunk, counters);
  // The search widens until something is found. A point has no size of its own: that of the surface counts.
  const double size = pair.convex.radius > 0 ? pair.convex.radius : pair.surface->bounds().diagonal().norm();
  const double least = 1e-3 * size;
  double reach = std::min(least, std::max(limit, 0.0));
  narrowest.search(reach);
  if (const Narrowest::Found* deep = narrowest.only_behind()) {
    if (counters != nullptr) counters->add(narrowest.counters);
    return narrowest.complete(*deep);
  }
  const bool inside = sunk || (narrowest.nearest.gap.distance > 0 && center_inside(pair));
  const double all = narrowest.clearance().bounds().merged(pair.surface->bounds()).diagonal().norm();
  const double farthest = inside ? all : std::min(all, limit);
  const auto stopped = [counters] { return counters != nullptr && counters->stopped(); };
  while (narrowest.nearest.gap.distance > reach && reach < farthest && !stopped()) {
    reach = std::min(std::max(8 * reach, least), farthest);
    narrowest.search(reach);
  }
  if (counters != nullptr) counters->add(narrowest.counters);
  Gap gap = narrowest.complete(narrowest.nearest);
  if (inside && !stopped()) push_out(pair, narrowest.nearest.facet, gap);
  return gap;
}

/// Manifolds of all facets, those of one patch together.
class Patches final : public FacetVisitor {
 public:
  Patches(const SurfacePair& pair, double margin, const Slack& slack, std::size_t first,
          std::pmr::vector<Manifold>& out, const NarrowCounters* asked)
      : pair_(pair), clearance_(clearance_of(pair)), slack_(slack), out_(out), asked_(asked), first_(first) {
    convex_.a = pair.convex;
    convex_.a.hints = &hints_;
    convex_.margin = margin;
    convex_.slack = slack;
  }
  void search() { pair_.surface->under(grown(clearance_.bounds(), convex_.margin), *this); }
  bool wants(const Eigen::AlignedBox3d& box) const override {
    return clearance_.of(box) < convex_.margin && (asked_ == nullptr || !asked_->stopped());
  }
  bool reads_active() const override { return true; }
  void visit(const Facet& facet) override {
    if (clearance_.of_plane(facet) >= convex_.margin) return;
    triangle_.set(facet);
    convex_.b = triangle_.placed(pair_.frame, pair_.surface->solid());
    Manifold here;
    if (!facet_manifold(convex_, facet, near, here)) return;
    found = true;
    for (std::size_t i = first_; i < out_.size(); ++i) {
      if (out_[i].normal.dot(here.normal) < kOnePatch) continue;
      // The normal of the deeper one holds for both.
      if (here.points[0].distance < out_[i].points[0].distance - slack_.rim) std::swap(here, out_[i]);
      merge_manifold(here, slack_.rim, out_[i]);
      return;
    }
    out_.push_back(here);
  }

  bool near = false;   // some facet is within the margin
  bool found = false;  // and some has a manifold

 private:
  const SurfacePair& pair_;
  const Clearance clearance_;
  const Slack& slack_;
  std::pmr::vector<Manifold>& out_;
  const NarrowCounters* asked_;
  std::size_t first_;
  ConvexPair convex_;
  TriangleHints hints_;
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
  pieces = (a_is_surface ? b : a).pieces();
}

std::size_t SurfacePair::count() const { return pieces != nullptr ? pieces->all().size() : 1; }

SurfacePair SurfacePair::of(std::size_t number) const {
  SurfacePair one = *this;
  one.pieces = nullptr;
  if (pieces == nullptr) return one;
  const ConvexPieces::Piece& piece = pieces->all()[number];
  one.convex.last = 0;
  one.convex.solid = &piece.about;
  one.convex.radius = piece.radius;
  one.convex.location += one.convex.rotation * piece.center;
  return one;
}

Placed SurfacePair::moving(std::size_t number) const {
  Placed placed = convex;
  if (pieces == nullptr) return placed;
  placed.last = 0;
  placed.solid = &pieces->all()[number].solid;
  placed.radius = pieces->all()[number].reach;
  return placed;
}

Eigen::AlignedBox3d bounds_in(const Placed& frame, const Placed& solid) {
  const Vector3 center = frame.rotation.transpose() * (solid.location - frame.location);
  if (solid.solid == nullptr) {
    return {center - Vector3::Constant(solid.radius), center + Vector3::Constant(solid.radius)};
  }
  const Matrix3 rotation = frame.rotation.transpose() * solid.rotation;
  if (solid.round.is_round()) {
    const Vector3 half = half_extent(solid.round, rotation);
    return {center - half, center + half};
  }
  Eigen::AlignedBox3d box;
  const auto& vertices = solid.solid->vertices;
  if (solid.solid->neighbors.empty()) {
    for (const Vector3& v : vertices) box.extend(center + rotation * v);
    return box;
  }
  int from = 0;
  for (int i = 0; i < 3; ++i) {
    const Vector3 axis = rotation.row(i);
    for (const double sign : {-1.0, 1.0}) {
      from = solid.solid->farthest(sign * axis, from);
      box.extend(center + rotation * vertices[at(from)]);
    }
  }
  return box;
}

namespace {

Gap never(const Placed& a, const Placed& b) {
  Gap gap;
  gap.on_a = a.location;
  gap.on_b = b.location;
  gap.distance = std::numeric_limits<double>::infinity();
  return gap;
}

}  // namespace

Gap surface_gap(const Shape& a, const Placed& pa, const Shape& b, const Placed& pb, double limit,
                NarrowCounters* counters) {
  const SurfacePair whole(a, pa, b, pb);
  Gap gap = never(pa, pb);
  for (std::size_t i = 0; whole.surface != nullptr && i < whole.count(); ++i) {
    const SurfacePair pair = whole.of(i);
    const bool near =
        std::isinf(limit) || may_reach(pair, std::max(limit, 0.0)) || (pair.surface->solid() && center_inside(pair));
    if (!near) continue;
    // What an earlier piece found is to be beaten.
    const Gap here = narrowest_gap(pair, std::min(limit, gap.distance), counters);
    if (i == 0 || here.distance < gap.distance) gap = here;
  }
  return whole.convex_is_a ? gap : flipped(gap);
}

namespace {

/// Of one convex solid; its manifolds join those that are there from `first` on. False if there are none of it although
/// it is near.
bool find_patches(const SurfacePair& pair, double margin, const Slack& slack, std::size_t first,
                  std::pmr::vector<Manifold>& out, NarrowCounters* counters) {
  if (!may_reach(pair, margin)) return !(pair.surface->solid() && center_inside(pair));
  if (ball_inside(pair)) return false;
  Patches patches(pair, margin, slack, first, out, counters);
  patches.search();
  if (counters != nullptr) {
    counters->add(patches.counters);
    if (counters->stopped()) return true;
  }
  return patches.found || !(patches.near || (pair.surface->solid() && center_inside(pair)));
}

}  // namespace

void surface_manifolds(const Shape& a, const Placed& pa, const Shape& b, const Placed& pb, double margin,
                       const Slack& slack, std::pmr::vector<Manifold>& out, NarrowCounters* counters) {
  const SurfacePair whole(a, pa, b, pb);
  if (whole.surface == nullptr) return;
  const std::size_t first = out.size();
  bool lost = false;
  for (std::size_t i = 0; i < whole.count(); ++i) {
    if (!find_patches(whole.of(i), margin, slack, first, out, counters)) lost = true;
    if (counters != nullptr && counters->stopped()) return;
  }
  // Wholly inside, or in among facets smaller than the depth, which all left the contact to their neighbours.
  if (out.size() == first && lost) {
    const Gap gap = surface_gap(a, pa, b, pb, std::numeric_limits<double>::infinity(), counters);
    Manifold& manifold = out.emplace_back();
    manifold.normal = gap.normal;
    manifold.count = 1;
    manifold.points[0] = {gap.on_a, gap.on_b, gap.distance, kNearestPoint};
    return;
  }
  if (whole.convex_is_a) return;
  for (std::size_t i = first; i < out.size(); ++i) flip(out[i]);
}

}  // namespace breve
