// From two shapes to their manifolds: which method serves which pair.
#include "runtime/solid/manifold.hpp"

#include "runtime/solid/pair.hpp"
#include "runtime/solid/place.hpp"
#include "runtime/solid/surface_pair.hpp"

namespace breve {

namespace {

constexpr std::uint32_t kBallPoint = 2;  // a ball has one point, wherever it rolls

/// A ball against anything convex: the exact gap is the whole manifold.
bool ball_manifold(const ConvexPair& pair, Manifold& out) {
  const Gap gap = find_gap(pair.a, pair.b);
  pair.remember(gap.normal, kBallPoint);
  if (gap.distance >= pair.margin) return false;
  out.normal = gap.normal;
  out.count = 1;
  out.points[0] = {gap.on_a, gap.on_b, gap.distance, kBallPoint};
  return true;
}

/// Spheres around both solids that are farther apart than the margin.
bool far_apart(const ConvexPair& pair) {
  const double reach = pair.a.radius + pair.b.radius + pair.margin;
  return pair.b.location.squaredNorm() > reach * reach;
}

bool convex_manifold(const Shape& a, const Shape& b, const ConvexPair& pair, Manifold& out) {
  if (a.kind() == ShapeKind::Sphere || b.kind() == ShapeKind::Sphere) return ball_manifold(pair, out);
  if (pair.a.round.is_round() || pair.b.round.is_round()) return round_manifold(pair, out);
  if (a.kind() == ShapeKind::Box && b.kind() == ShapeKind::Box) {
    return boxes_manifold(pair, a.size() / 2, b.size() / 2, out);
  }
  return polyhedra_manifold(pair, out);
}

/// The same with its two early ways out, and the outcome remembered.
bool find_convex(const Shape& a, const Shape& b, const ConvexPair& pair, Manifold& out) {
  if (far_apart(pair) || pair.apart_by_cache()) return false;
  const bool touch = convex_manifold(a, b, pair, out);
  if (pair.cache != nullptr) pair.cache->apart = touch ? 0 : 1;
  return touch;
}

void find(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, double margin,
          std::pmr::vector<Manifold>& out, PairCache* cache, NarrowCounters* counters) {
  ConvexPair pair{place(a, pa), place(b, pb), margin, slack_of(a.bounding_radius(), b.bounding_radius()),
                  cache,        counters};
  // Coordinates relative to a keep digits far from the origin.
  pair.a.location.setZero();
  pair.b.location = pb.location - pa.location;
  const std::size_t first = out.size();
  if (is_surface(a) || is_surface(b)) {
    if (far_apart(pair)) return;
    if (counters != nullptr) ++counters->pairs;
    surface_manifolds(a, pair.a, b, pair.b, margin, pair.slack, out, counters);
  } else if (!find_convex(a, b, pair, out.emplace_back())) {
    out.pop_back();
  }
  for (std::size_t m = first; m < out.size(); ++m) {
    for (int i = 0; i < out[m].count; ++i) {
      ContactPoint& point = out[m].points[static_cast<std::size_t>(i)];
      point.on_a += pa.location;
      point.on_b += pa.location;
    }
  }
}

}  // namespace

void find_manifolds(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, double margin,
                    std::pmr::vector<Manifold>& out) {
  find(a, pa, b, pb, margin, out, nullptr, nullptr);
}

void find_manifolds(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, double margin,
                    std::pmr::vector<Manifold>& out, PairCache& cache, NarrowCounters& counters) {
  find(a, pa, b, pb, margin, out, &cache, &counters);
}

}  // namespace breve
