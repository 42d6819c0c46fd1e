// Single facets against convex solids: what a search in the tree of faces finds is what a look at all faces finds, and
// what the planes of a solid tell is what an exact distance says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/solid/pair.hpp"
#include "runtime/solid/place.hpp"
#include "runtime/solid/triangle.hpp"
#include "tests/runtime/solid_oracle.hpp"

namespace breve::facet_tests {
namespace {

/// Corners at random on an ellipsoid.
Polyhedron pebble(oracle::Dice& dice, int corners) {
  const Vector3 half = dice.edges(0.4, 1);
  std::vector<Vector3> points;
  for (int i = 0; i < corners; ++i) points.push_back(half.cwiseProduct(dice.direction()));
  return make_hull(points);
}

double radius_of(const Polyhedron& solid) {
  double radius = 0;
  for (const Vector3& v : solid.vertices) radius = std::max(radius, v.norm());
  return radius;
}

Facet facet_near(oracle::Dice& dice, const Vector3& middle, double size) {
  Facet facet;
  for (Vector3& corner : facet.corner) corner = middle + dice.vector(size);
  facet.normal = normal_of(facet.corner[0], facet.corner[1], facet.corner[2]);
  return facet;
}

TEST(FaceTree, FindsTheGapThatALookAtAllFacesFinds) {
  oracle::Dice dice(96);
  int overlaps = 0, trees = 0;
  TriangleSolid triangle;
  for (int i = 0; i < 4000; ++i) {
    const Polyhedron solid = pebble(dice, 40 + i % 60);
    if (solid.looks.empty()) continue;  // not convex to round-off: all faces are looked at
    ++trees;
    Polyhedron without(solid, std::pmr::get_default_resource());
    without.looks.clear();
    triangle.set(facet_near(dice, 0.9 * dice.direction(), i % 2 == 0 ? 0.1 : 1));
    Placed a, frame;
    a.radius = radius_of(solid);
    a.rotation = dice.rotation().toRotationMatrix();
    frame.location = dice.vector(0.1);
    a.solid = &solid;
    const Placed b = triangle.placed(frame, i % 3 != 0);
    const Gap by_tree = triangle_gap(a, b);
    a.solid = &without;
    a.last = 0;
    const Gap by_all = triangle_gap(a, b);
    ASSERT_EQ(by_tree.distance, by_all.distance) << "case " << i;
    ASSERT_EQ(by_tree.normal, by_all.normal) << "case " << i;
    ASSERT_EQ(by_tree.back, by_all.back) << "case " << i;
    ASSERT_EQ(by_tree.on_b, by_all.on_b) << "case " << i;
    overlaps += by_tree.distance < 0;
  }
  EXPECT_GT(trees, 3500);
  EXPECT_GT(overlaps, 1000);
}

TEST(FaceTree, FindsTheFaceThatLooksMostAlongADirection) {
  oracle::Dice dice(97);
  for (int i = 0; i < 300; ++i) {
    const Polyhedron solid = pebble(dice, 200);
    Placed placed;
    placed.solid = &solid;
    const Vector3 direction = dice.direction();
    const auto along = [&](const Plane& plane) { return plane.normal.dot(direction); };
    const auto best = std::max_element(solid.planes.begin(), solid.planes.end(),
                                       [&](const Plane& p, const Plane& q) { return along(p) < along(q); });
    ASSERT_NEAR(along(solid.planes[at(face_along(placed, direction))]), along(*best), 1e-6);
  }
}

TEST(Facet, APlaneOfABoxTellsTheDistanceThatTheNearestPointsHave) {
  oracle::Dice dice(98);
  const Polyhedron box = make_box(Vector3(4, 1, 3));
  TriangleSolid triangle;
  int apart = 0;
  for (int i = 0; i < 3000; ++i) {
    triangle.set(facet_near(dice, Vector3(dice.between(-3, 3), 0.8, dice.between(-2, 2)), 0.3));
    Placed a;
    a.solid = &box;
    a.radius = radius_of(box);
    const Placed b = triangle.placed(Placed(), true);
    const Gap gap = triangle_gap(a, b);
    Gap exact;
    if (gap.distance < 1e-3 || !separated(a, b, exact)) continue;
    ++apart;
    ASSERT_NEAR(gap.distance, exact.distance, 1e-14) << "case " << i;
    ASSERT_NEAR((gap.on_a - gap.on_b).norm(), exact.distance, 1e-13) << "case " << i;
    ASSERT_NEAR((gap.normal - exact.normal).norm(), 0, 1e-11) << "case " << i;
  }
  EXPECT_GT(apart, 500);
}

}  // namespace
}  // namespace breve::facet_tests
