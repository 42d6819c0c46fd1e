// What the narrow phase looks at: a bounded part of a surface, whatever is far; and nothing that matters is left out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "runtime/solid/clearance.hpp"
#include "runtime/solid/height_grid.hpp"
#include "runtime/solid/manifold.hpp"
#include "runtime/solid/place.hpp"
#include "runtime/solid/triangle.hpp"
#include "tests/runtime/solid_oracle.hpp"

namespace breve::cost_tests {
namespace {

std::shared_ptr<Shape> field(int side, double tile, const std::function<double(int, int)>& height) {
  std::vector<double> heights;
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c) heights.push_back(height(c, r));
  return Shape::height_field(side, side, tile, heights);
}

/// A closed mesh of 2 around (along - 1) triangles, about a ball of radius 1 that is cut off below.
std::shared_ptr<Shape> lump(int around, int along) {
  std::vector<Vector3> corners;
  std::vector<std::array<std::int32_t, 3>> triangles;
  for (int i = 1; i < along; ++i)
    for (int j = 0; j < around; ++j) {
      const double t = std::numbers::pi * i / along, p = 2 * std::numbers::pi * j / around;
      const double r = 1 + 0.1 * std::sin(5 * p) * std::sin(4 * t);
      corners.emplace_back(r * std::sin(t) * std::cos(p), std::max(-0.6, 0.7 * r * std::cos(t)),
                           r * std::sin(t) * std::sin(p));
    }
  corners.emplace_back(0, 0.7, 0);
  corners.emplace_back(0, -0.6, 0);
  const int top = around * (along - 1), bottom = top + 1;
  const auto at = [around](int i, int j) { return i * around + j % around; };
  for (int j = 0; j < around; ++j) {
    triangles.push_back({top, at(0, j + 1), at(0, j)});
    triangles.push_back({bottom, at(along - 2, j), at(along - 2, j + 1)});
    for (int i = 0; i + 2 < along; ++i) {
      triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return Shape::mesh(corners, triangles);
}

/// What all three questions about a pair look at: whether they touch, when they will, and where they nearly do.
NarrowCounters asked(const Shape& a, const Motion& ma, const Shape& b) {
  NarrowCounters counters;
  Contact contact;
  double t;
  EXPECT_FALSE(closest_within(a, ma.start, b, Pose(), touch_tolerance(a, ma.start, b, Pose()), contact, &counters));
  EXPECT_FALSE(time_of_impact(a, ma, b, Motion(), 0.1, t, contact, &counters));
  std::pmr::vector<Manifold> manifolds;
  PairCache cache;
  find_manifolds(a, ma.start, b, Pose(), 0.01, manifolds, cache, counters);
  EXPECT_TRUE(manifolds.empty());
  return counters;
}

TEST(NarrowCost, AFarPeakMakesNothingDearer) {
  const auto plain = field(101, 1, [](int, int) { return 0.0; });
  const auto peak = field(101, 1, [](int c, int r) { return c + r == 0 ? 20.0 : 0.0; });
  const auto cone = Shape::cone(5, 0.5, 0.2);
  oracle::Dice dice(91);
  for (int i = 0; i < 50; ++i) {
    Motion motion;
    motion.start = {dice.vector(5), dice.rotation()};
    motion.start.location.y() = 5;
    motion.velocity = Vector3(0.01, 0, 0);
    const NarrowCounters with = asked(*cone, motion, *peak), without = asked(*cone, motion, *plain);
    EXPECT_EQ(with.facets, 0U);
    EXPECT_EQ(without.facets, 0U);
    EXPECT_LE(with.boxes, 40U) << "a few blocks, and none of their cells";
  }
}

TEST(NarrowCost, ALargePlateOverHillsLooksAtTheOneHillThatReachesIt) {
  // A million facets, six of which are near the plate.
  const auto hills = field(708, 1, [](int c, int r) { return c == 300 && r == 400 ? 4.0 : 0.5 * std::sin(0.3 * c); });
  const auto plate = Shape::box(Vector3(700, 0.2, 700));
  Motion motion;
  motion.start.location = Vector3(0, 4.13, 0);
  motion.start.orientation = Quaternion(Eigen::AngleAxisd(1e-5, Vector3::UnitX()));
  motion.velocity = Vector3(0, -0.1, 0);
  NarrowCounters counters = asked(*plate, motion, *hills);
  EXPECT_EQ(counters.facets, 0U);
  EXPECT_LE(counters.boxes, 3U * 45U * 45U) << "blocks of 16 by 16 cells";
  counters = {};
  std::pmr::vector<Manifold> manifolds;
  PairCache cache;
  find_manifolds(*plate, motion.start, *hills, Pose(), 0.05, manifolds, cache, counters);
  EXPECT_FALSE(manifolds.empty());
  EXPECT_LE(counters.facets, 6U);
}

TEST(NarrowCost, AMeshOnALargeBoxIsLookedAtWhereItTouches) {
  const auto mesh = lump(60, 51);
  const auto floor = Shape::box(Vector3(100, 2, 100));
  oracle::Dice dice(92);
  for (int i = 0; i < 20; ++i) {
    // Lifted so that it is a thousandth above the floor at its lowest corner, turned in any way but on its flat base.
    Pose pose{Vector3(dice.between(-20, 20), 0, dice.between(-20, 20)), dice.rotation()};
    const Quaternion level(Eigen::AngleAxisd(dice.between(0, 6), dice.direction()));
    double low = 0;
    for (const Vector3& p : mesh->vertices()) low = std::min(low, (pose.orientation * p).y());
    if ((pose.orientation * Vector3::UnitY()).y() > 0.99) continue;
    pose.location.y() = 1 - low + 1e-3;
    // The whole scene turned: bounds along the axes say nothing then.
    const Pose ground{Vector3::Zero(), level}, lying{level * pose.location, level * pose.orientation};
    NarrowCounters counters;
    Contact contact;
    double t;
    EXPECT_TRUE(closest_within(*mesh, lying, *floor, ground, 2e-3, contact, &counters));
    EXPECT_NEAR(contact.distance, 1e-3, 1e-9);
    EXPECT_FALSE(time_of_impact(*mesh, {lying, level * Vector3(0, -0.01, 0), Vector3(0, 0.01, 0)}, *floor,
                                {ground, Vector3::Zero(), Vector3::Zero()}, 0.01, t, contact, &counters));
    std::pmr::vector<Manifold> manifolds;
    PairCache cache;
    find_manifolds(*mesh, lying, *floor, ground, 2e-3, manifolds, cache, counters);
    EXPECT_FALSE(manifolds.empty());
    EXPECT_LE(counters.facets, 600U) << "of 6,000, for three questions";
  }
}

TEST(NarrowCost, WhatIsSunkFindsItsWayOutWithoutLookingAtEverything) {
  const auto hills = field(708, 1, [](int c, int r) { return std::sin(0.3 * c) + std::cos(0.2 * r); });
  NarrowCounters counters;
  Contact contact;
  ASSERT_TRUE(closest_within(*Shape::box(Vector3(1, 1, 1)), {Vector3(10, -6, 20), Quaternion::Identity()}, *hills,
                             Pose(), 0, contact, &counters));
  EXPECT_LT(contact.distance, -3);
  EXPECT_LE(counters.boxes, 20000U) << "of a million";
}

TEST(NarrowCost, WithinALimitTheContactIsTheClosestAndBeyondThereIsNone) {
  oracle::Dice dice(93);
  const auto hills = field(33, 0.5, [](int c, int r) { return 0.4 * std::sin(0.7 * c) * std::cos(0.5 * r); });
  const auto mesh = lump(12, 11);
  int within = 0, beyond = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto solid = i % 5 == 0 ? Shape::sphere(dice.between(0.2, 1)) : dice.polyhedron(i);
    const std::shared_ptr<Shape> other = i % 3 == 0 ? hills : i % 3 == 1 ? mesh : dice.polyhedron(i / 3);
    const Pose a{dice.vector(2.5), dice.rotation()}, b{Vector3::Zero(), dice.rotation()};
    const double limit = i % 4 == 0 ? -0.05 : i % 4 == 1 ? 0 : dice.between(1e-9, 1);
    const Contact exact = closest(*solid, a, *other, b);
    Contact found;
    const bool is = closest_within(*solid, a, *other, b, limit, found);
    ASSERT_EQ(is, exact.distance <= limit) << "pair " << i << ", " << exact.distance << " apart";
    (is ? within : beyond) += 1;
    if (!is) continue;
    ASSERT_EQ(found.distance, exact.distance) << "pair " << i;
    // The deepest or closest points may be any of several that are equal.
    if (!is_surface(*other)) {
      ASSERT_EQ(found.point, exact.point);
    }
  }
  EXPECT_GT(within, 300);
  EXPECT_GT(beyond, 300);
}

/// Takes all facets and compares bounds with distances.
class Auditor final : public FacetVisitor {
 public:
  Auditor(const Placed& convex, const Placed& frame, const Surface& surface)
      : convex_(convex), frame_(frame), clearance_(convex, frame, surface.bounds()) {}
  void visit(const Facet& facet) override {
    triangle_.set(facet);
    const double distance = triangle_gap(convex_, triangle_.placed(frame_, false)).distance;
    Eigen::AlignedBox3d box(facet.corner[0]);
    box.extend(facet.corner[1]).extend(facet.corner[2]);
    const double bound = std::max(clearance_.of(box), clearance_.of_plane(facet));
    EXPECT_LE(std::max(bound, 0.0), std::max(distance, 0.0));
    apart += distance > 0.05;
    told += distance > 0.05 && bound > 0;
  }
  int apart = 0, told = 0;

 private:
  const Placed &convex_, &frame_;
  const Clearance clearance_;
  TriangleSolid triangle_;
};

TEST(Clearance, IsNeverMoreThanTheDistanceAndTellsMostFacetsApart) {
  oracle::Dice dice(94);
  const auto mesh = lump(20, 11);
  int apart = 0, told = 0;
  for (int i = 0; i < 100; ++i) {
    const auto solid = i % 6 == 5   ? Shape::sphere(dice.between(0.2, 3))
                       : i % 6 == 4 ? Shape::prism(40, dice.between(0.1, 1), dice.between(1, 9))
                                    : dice.polyhedron(i);
    const Placed convex = place(*solid, {dice.vector(3), dice.rotation()}),
                 frame = place(*mesh, {dice.vector(1), dice.rotation()});
    Auditor auditor(convex, frame, *mesh->surface());
    mesh->surface()->under(mesh->surface()->bounds(), auditor);
    EXPECT_EQ(auditor.counters.facets, 400U);
    apart += auditor.apart;
    told += auditor.told;
  }
  EXPECT_GT(told, apart * 9 / 10);
}

/// The facets under a box as they come.
class Collector final : public FacetVisitor {
 public:
  void visit(const Facet& facet) override { found.push_back(facet); }
  bool reads_active() const override { return true; }
  std::vector<Facet> found;
};

TEST(HeightFieldCost, ChangedHeightsAreFoundAsInAFieldThatWasMadeWithThem) {
  oracle::Dice dice(95);
  constexpr int kColumns = 40, kRows = 35;
  std::vector<double> heights(kColumns * kRows, 0.0);
  const auto changed = Shape::height_field(kColumns, kRows, 1, heights);
  for (int i = 0; i < 400; ++i) {
    // Every third one goes back to what most are, so that ranges narrow again.
    const int c = static_cast<int>(dice.between(0, kColumns - 0.001)),
              r = static_cast<int>(dice.between(0, kRows - 0.001));
    const double height = i % 3 == 0 ? 0 : dice.between(-3, 3);
    heights[static_cast<std::size_t>(r * kColumns + c)] = height;
    changed->set_height(c, r, height);
    if (i % 20 != 0) continue;
    const auto fresh = Shape::height_field(kColumns, kRows, 1, heights);
    EXPECT_EQ(changed->heights()->bounds().min(), fresh->heights()->bounds().min());
    EXPECT_EQ(changed->heights()->bounds().max(), fresh->heights()->bounds().max());
    const Vector3 low = dice.vector(20);
    Eigen::AlignedBox3d box(low, low + dice.vector(8).cwiseAbs());
    box.min().y() = dice.between(-3, 0);
    box.max().y() = box.min().y() + dice.between(0, 2);
    Collector one, other, all;
    changed->surface()->under(box, one);
    fresh->surface()->under(box, other);
    changed->surface()->under(changed->surface()->bounds(), all);
    EXPECT_EQ(all.found.size(), 2U * (kColumns - 1) * (kRows - 1));
    ASSERT_EQ(one.found.size(), other.found.size());
    // Every facet whose bounds meet the box, in the same order.
    std::size_t next = 0;
    for (const Facet& facet : all.found) {
      Eigen::AlignedBox3d around(facet.corner[0]);
      around.extend(facet.corner[1]).extend(facet.corner[2]);
      if (!around.intersects(box)) continue;
      ASSERT_LT(next, one.found.size());
      EXPECT_EQ(one.found[next].index, facet.index);
      EXPECT_EQ(one.found[next].active, other.found[next].active);
      ++next;
    }
    EXPECT_EQ(next, one.found.size());
  }
}

}  // namespace
}  // namespace breve::cost_tests
