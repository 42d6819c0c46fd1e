// Manifolds of convex solids: how many points, where, and under which names.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/solid/manifold.hpp"
#include "tests/runtime/solid_oracle.hpp"

namespace breve::manifold_tests {
namespace {

constexpr double kExact = 1e-12;
constexpr double kPreference = 1e-3;  // of the smaller solid's radius: manifold.hpp
constexpr double kRim = 6e-4;         // a face counts as larger by 1e-4, six times as far out at a corner of 20 degrees
constexpr double kSideBySide = 0.02;
const Quaternion kLevel = Quaternion::Identity();

Quaternion rotated(double angle, const Vector3& axis) {
  return Quaternion(Eigen::AngleAxisd(angle, axis.normalized()));
}

std::pmr::vector<Manifold> find(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, double margin = 0.01) {
  std::pmr::vector<Manifold> out;
  find_manifolds(a, pa, b, pb, margin, out);
  return out;
}

/// How far a point is from the surface of a solid.
double off_surface(const Shape& shape, const Pose& pose, const Vector3& point) {
  const Vector3 p = pose.orientation.conjugate() * (point - pose.location);
  if (shape.kind() == ShapeKind::Sphere) return std::abs(p.norm() - shape.radius());
  double highest = -1e300;
  for (const Plane& plane : shape.polyhedron().planes) highest = std::max(highest, plane.normal.dot(p) - plane.offset);
  return std::abs(highest);
}

void expect_near(const Vector3& a, const Vector3& b, double tolerance) {
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), tolerance) << a.transpose() << " against " << b.transpose();
}

TEST(Manifold, SpheresHaveOnePointBetweenThem) {
  const auto a = Shape::sphere(0.5), b = Shape::sphere(1);
  const auto m = find(*a, {Vector3(0, 1.49, 0), kLevel}, *b, {});
  ASSERT_EQ(m.size(), 1U);
  EXPECT_EQ(m[0].count, 1);
  expect_near(m[0].normal, Vector3::UnitY(), kExact);
  EXPECT_NEAR(m[0].points[0].distance, -0.01, kExact);
  expect_near(m[0].points[0].on_a, Vector3(0, 0.99, 0), kExact);
  expect_near(m[0].points[0].on_b, Vector3(0, 1, 0), kExact);
  EXPECT_TRUE(find(*a, {Vector3(0, 1.52, 0), kLevel}, *b, {}).empty());
}

TEST(Manifold, ABoxFlatOnABoxHasFourPointsAtItsCorners) {
  const auto floor = Shape::box(Vector3(10, 2, 10)), box = Shape::box(Vector3(1, 1, 1));
  const auto m = find(*box, {Vector3(1, 0.499, 2), kLevel}, *floor, {Vector3(0, -1, 0), kLevel});
  ASSERT_EQ(m.size(), 1U);
  ASSERT_EQ(m[0].count, 4);
  expect_near(m[0].normal, Vector3::UnitY(), kExact);
  for (const ContactPoint& p : m[0].points) {
    EXPECT_NEAR(p.distance, -0.001, kExact);
    EXPECT_NEAR(std::abs(p.on_a.x() - 1), 0.5, kExact);
    EXPECT_NEAR(std::abs(p.on_a.z() - 2), 0.5, kExact);
    EXPECT_NEAR(p.on_a.y(), -0.001, kExact);
    EXPECT_NEAR(p.on_b.y(), 0, kExact);
  }
}

TEST(Manifold, ABoxRotatedByFortyFiveDegreesKeepsFourOfEightPointsThatSpanMuch) {
  const auto box = Shape::box(Vector3(1, 1, 1));
  const auto m = find(*box, {Vector3(0, 0.999, 0), rotated(std::numbers::pi / 4, Vector3::UnitY())}, *box, {});
  ASSERT_EQ(m.size(), 1U);
  ASSERT_EQ(m[0].count, 4);
  // The octagon's corners are 0.5 / cos(pi / 8) from the middle; four of them 90 degrees apart span 2 r^2.
  const double r = 0.5 / std::cos(std::numbers::pi / 8);
  std::vector<double> angles;
  for (const ContactPoint& p : m[0].points) {
    EXPECT_NEAR(std::hypot(p.on_a.x(), p.on_a.z()), r, 1e-3);
    angles.push_back(std::atan2(p.on_a.z(), p.on_a.x()));
  }
  std::sort(angles.begin(), angles.end());
  double area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double next = i < 3 ? angles[i + 1] : angles[0] + 2 * std::numbers::pi;
    area += r * r * std::sin(next - angles[i]) / 2;
  }
  EXPECT_GT(area, 0.99 * 2 * r * r);
}

TEST(Manifold, AnEdgeOnAFaceHasTwoPointsAndACornerOne) {
  const auto floor = Shape::box(Vector3(10, 2, 10)), box = Shape::box(Vector3(1, 1, 1));
  const Pose ground{Vector3(0, -1, 0), kLevel};
  const double low = std::sqrt(0.5) - 0.001;
  const auto edge = find(*box, {Vector3(0, low, 0), rotated(std::numbers::pi / 4, Vector3::UnitZ())}, *floor, ground);
  ASSERT_EQ(edge.size(), 1U);
  ASSERT_EQ(edge[0].count, 2);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(edge[0].points[static_cast<std::size_t>(i)].distance, -0.001, kExact);
  EXPECT_NEAR(std::abs(edge[0].points[0].on_b.z() - edge[0].points[1].on_b.z()), 1, kExact);

  const Quaternion on_corner = Quaternion::FromTwoVectors(Vector3(1, 1, 1), -Vector3::UnitY());
  const auto corner = find(*box, {Vector3(0, std::sqrt(0.75) - 0.001, 0), on_corner}, *floor, ground);
  ASSERT_EQ(corner.size(), 1U);
  ASSERT_EQ(corner[0].count, 1);
  EXPECT_NEAR(corner[0].points[0].distance, -0.001, kExact);
  expect_near(corner[0].points[0].on_b, Vector3::Zero(), kExact);
}

TEST(Manifold, CrossedEdgesHaveOnePointAndParallelEdgesTwo) {
  const auto box = Shape::box(Vector3(1, 1, 1));
  const double apart = 2 * std::sqrt(0.5);
  const Quaternion on_edge = rotated(std::numbers::pi / 4, Vector3::UnitZ());
  const Pose below{Vector3::Zero(), on_edge};
  for (const double gap : {-0.002, 0.004}) {
    const auto crossed = find(
        *box, {Vector3(0, apart + gap, 0), rotated(std::numbers::pi / 2, Vector3::UnitY()) * on_edge}, *box, below);
    ASSERT_EQ(crossed.size(), 1U);
    EXPECT_EQ(crossed[0].count, 1);
    expect_near(crossed[0].normal, Vector3::UnitY(), kExact);
    EXPECT_NEAR(crossed[0].points[0].distance, gap, kExact);
  }
  const auto parallel = find(*box, {Vector3(0, apart + 0.004, 0.25), on_edge}, *box, below);
  ASSERT_EQ(parallel.size(), 1U);
  ASSERT_EQ(parallel[0].count, 2);
  EXPECT_NEAR(std::abs(parallel[0].points[0].on_a.z() - parallel[0].points[1].on_a.z()), 0.75, kExact);
}

TEST(Manifold, ABallInACornerTouchesEachWallOnce) {
  const auto ball = Shape::sphere(0.5), wall = Shape::box(Vector3(1, 4, 4));
  const Pose at{Vector3(1 - 1e-4, 0.3, -0.2), kLevel};
  const auto one = find(*ball, at, *wall, {});
  const auto two = find(*ball, at, *wall, {Vector3(0, -0.7, 0), rotated(std::numbers::pi / 2, Vector3::UnitZ())});
  ASSERT_EQ(one.size(), 1U);
  ASSERT_EQ(two.size(), 1U);
  expect_near(one[0].normal, Vector3::UnitX(), kExact);
  expect_near(two[0].normal, Vector3::UnitY(), kExact);
  EXPECT_NEAR(one[0].points[0].distance, -1e-4, kExact);
}

TEST(Manifold, CoincidentCentresGiveAFiniteUnitNormal) {
  const auto ball = Shape::sphere(0.5), box = Shape::box(Vector3(1, 1, 1)), cone = Shape::cone(5, 1, 1);
  for (const auto& a : {ball, box, cone}) {
    for (const auto& b : {ball, box, cone}) {
      const auto m = find(*a, {}, *b, {});
      ASSERT_EQ(m.size(), 1U);
      EXPECT_NEAR(m[0].normal.norm(), 1, kExact);
      EXPECT_LT(m[0].points[0].distance, 0);
      for (int i = 0; i < m[0].count; ++i) {
        EXPECT_TRUE(m[0].points[static_cast<std::size_t>(i)].on_a.allFinite());
        EXPECT_TRUE(m[0].points[static_cast<std::size_t>(i)].on_b.allFinite());
      }
    }
  }
}

/// Random pairs near touch, at a scale and place, against `closest`.
void check_random_pairs(std::uint64_t seed, double scale, const Vector3& origin, double round_off) {
  oracle::Dice dice(seed);
  int touching = 0;
  for (int i = 0; i < 1500; ++i) {
    const bool ball = i % 7 == 0;
    const auto a = ball ? Shape::sphere(dice.between(0.2, 1)) : dice.polyhedron(i);
    const auto b = i % 11 == 0  ? Shape::sphere(dice.between(0.2, 1))
                   : i % 2 == 0 ? dice.polyhedron(0)
                                : dice.polyhedron(i / 4);
    a->set_scale(scale * a->scale());
    b->set_scale(scale * b->scale());
    const Pose pa{origin + scale * dice.vector(1),
                  i % 5 == 0 ? rotated(1e-4 * i / 1500, dice.direction()) : dice.rotation()};
    Pose pb{pa.location + scale * dice.vector(2), i % 5 == 0 ? Quaternion::Identity() : dice.rotation()};
    const Contact start = closest(*a, pa, *b, pb);
    const double wanted = scale * dice.between(-0.05, 0.02);
    pb.location += (start.distance - wanted) * start.normal;  // b to where the gap is about as wanted
    const Contact c = closest(*a, pa, *b, pb);
    const double margin = 0.03 * scale, size = std::min(a->bounding_radius(), b->bounding_radius());
    const auto found = find(*a, pa, *b, pb, margin);
    const double exact = round_off * scale, loose = 1.01 * kPreference * size + exact;
    if (found.empty()) {
      ASSERT_GE(c.distance, margin - loose) << "case " << i;
      continue;
    }
    ++touching;
    ASSERT_EQ(found.size(), 1U);
    const Manifold& m = found[0];
    ASSERT_GE(m.count, 1);
    ASSERT_LE(m.count, kMostPoints);
    ASSERT_NEAR(m.normal.norm(), 1, 1e-12);
    ASSERT_NEAR(m.points[0].distance, c.distance, 2 * loose) << "case " << i;
    // The normal is nearly as good an axis as the best.
    const auto shadow = [](const Shape& s, const Pose& p, const Vector3& n) {
      if (s.kind() == ShapeKind::Sphere) return s.radius();
      double high = -1e300;
      for (const Vector3& v : s.vertices()) high = std::max(high, n.dot(p.orientation * v));
      return high;
    };
    const double along = m.normal.dot(pa.location - pb.location) - shadow(*a, pa, -m.normal) - shadow(*b, pb, m.normal);
    ASSERT_NEAR(along, c.distance, loose) << "case " << i;
    for (int k = 0; k < m.count; ++k) {
      const ContactPoint& p = m.points[static_cast<std::size_t>(k)];
      ASSERT_LT(p.distance, margin);
      ASSERT_GE(p.distance, m.points[0].distance - exact);
      ASSERT_NEAR((p.on_a - p.on_b).dot(m.normal), p.distance, exact);
      const double rim = kRim * size + exact + (m.count == 1 && c.distance < 0 ? 0.02 * size : 0);
      ASSERT_LE(off_surface(*a, pa, p.on_a), rim + std::max(0.0, -p.distance)) << "case " << i;
      ASSERT_LE(off_surface(*b, pb, p.on_b), rim + std::max(0.0, -p.distance)) << "case " << i;
      for (int l = 0; l < k; ++l) ASSERT_NE(p.feature, m.points[static_cast<std::size_t>(l)].feature) << "case " << i;
    }
    const auto mirrored = find(*b, pb, *a, pa, margin);
    ASSERT_EQ(mirrored.size(), 1U) << "case " << i;
    ASSERT_NEAR(mirrored[0].points[0].distance, m.points[0].distance, 2 * loose) << "case " << i;
    if (a->bounding_radius() == b->bounding_radius()) continue;  // which of two equals leads is decided by the order
    ASSERT_LE((mirrored[0].normal + m.normal).norm(), 1e-9) << "case " << i;
    ASSERT_EQ(mirrored[0].count, m.count) << "case " << i;
    if (m.count == 1 && c.distance < 0) continue;  // the deepest points of an overlap need not be the only ones
    // If two edges are side by side, the points across are not unique, by the angle between the edges.
    const double slip = m.count == 2 ? kSideBySide * kSideBySide * 4 * scale : 1e3 * exact;
    for (int k = 0; k < m.count; ++k) {
      bool same = false;
      for (int l = 0; l < m.count; ++l) {
        const ContactPoint &p = m.points[static_cast<std::size_t>(k)],
                           &q = mirrored[0].points[static_cast<std::size_t>(l)];
        same = same || ((p.on_a - q.on_b).norm() <= slip && (p.on_b - q.on_a).norm() <= slip);
      }
      ASSERT_TRUE(same) << "case " << i << " point " << k;
    }
  }
  EXPECT_GT(touching, 1000);
}

TEST(Manifold, RandomPairsAgreeWithTheClosestPoints) { check_random_pairs(21, 1, Vector3::Zero(), 1e-12); }
TEST(Manifold, AThousandthOfTheSizeGivesTheSame) { check_random_pairs(22, 1e-3, Vector3::Zero(), 1e-12); }
TEST(Manifold, AThousandTimesTheSizeGivesTheSame) { check_random_pairs(23, 1e3, Vector3::Zero(), 1e-12); }
// Places are rounded to 2e-12 there.
TEST(Manifold, TenKilometresFromTheOriginOnlyRoundOffIsLost) {
  check_random_pairs(24, 1, Vector3(1e4, -1e4, 1e4), 2e-11);
}

std::vector<std::uint32_t> names(const Manifold& m) {
  std::vector<std::uint32_t> out;
  for (int i = 0; i < m.count; ++i) out.push_back(m.points[static_cast<std::size_t>(i)].feature);
  std::sort(out.begin(), out.end());
  return out;
}

TEST(Manifold, FeaturesOfASlidingAndTremblingBoxStayTheSame) {
  const auto floor = Shape::box(Vector3(10, 2, 10)), box = Shape::box(Vector3(1, 1, 1));
  oracle::Dice dice(25);
  std::vector<std::uint32_t> first;
  for (int i = 0; i < 1000; ++i) {
    const Pose at{Vector3(-3 + 0.006 * i, 0.4995, 0.1) + dice.vector(1e-5), rotated(1e-4, dice.direction())};
    const auto m = find(*box, at, *floor, {Vector3(0, -1, 0), kLevel});
    ASSERT_EQ(m.size(), 1U);
    ASSERT_EQ(m[0].count, 4);
    if (i == 0) first = names(m[0]);
    ASSERT_EQ(names(m[0]), first) << "step " << i;
  }
}

TEST(Manifold, FeaturesOfATremblingStackOfEqualBoxesStayTheSame) {
  const auto box = Shape::box(Vector3(1, 1, 1));
  oracle::Dice dice(26);
  for (const auto& rotation : {Quaternion::Identity(), rotated(std::numbers::pi / 4, Vector3::UnitY())}) {
    std::vector<std::uint32_t> first;
    for (int i = 0; i < 1000; ++i) {
      const Pose at{Vector3(0, 0.9995, 0) + dice.vector(1e-5), rotated(1e-5, dice.direction()) * rotation};
      const auto m = find(*box, at, *box, {});
      ASSERT_EQ(m.size(), 1U);
      ASSERT_EQ(m[0].count, 4);
      if (i == 0) first = names(m[0]);
      ASSERT_EQ(names(m[0]), first) << "step " << i;
    }
  }
}

TEST(Manifold, AWarmStartFindsTheSameAndDecidesMostPairsThatStayApart) {
  oracle::Dice dice(27);
  NarrowCounters counters;
  for (int i = 0; i < 300; ++i) {
    const auto a = dice.polyhedron(i), b = dice.polyhedron(i / 4);
    Pose pa{dice.vector(1), dice.rotation()}, pb{dice.vector(1.5), dice.rotation()};
    const Vector3 drift = dice.vector(1e-3);
    PairCache cache;
    for (int step = 0; step < 20; ++step) {
      std::pmr::vector<Manifold> warm;
      find_manifolds(*a, pa, *b, pb, 0.02, warm, cache, counters);
      const auto cold = find(*a, pa, *b, pb, 0.02);
      ASSERT_EQ(warm.size(), cold.size());
      if (!cold.empty()) {
        ASSERT_NEAR(warm[0].points[0].distance, cold[0].points[0].distance,
                    2 * kPreference * std::min(a->bounding_radius(), b->bounding_radius()));
      }
      pb.location += drift;
    }
  }
  EXPECT_GT(counters.pairs, 3000U);
  EXPECT_GE(counters.warm, counters.pairs - 300);
  EXPECT_GT(counters.separate, 1000U);
}

TEST(Manifold, SolidsOfManyFacesTouchAsTheirSmoothOriginalsDo) {
  const auto disk = Shape::prism(200, 0.2, 1), floor = Shape::box(Vector3(10, 2, 10));
  const auto flat = find(*disk, {Vector3(0, 0.0995, 0), kLevel}, *floor, {Vector3(0, -1, 0), kLevel});
  ASSERT_EQ(flat.size(), 1U);
  ASSERT_EQ(flat[0].count, 4);
  double area = 0;
  for (std::size_t i = 0; i < 4; ++i) area = std::max(area, (flat[0].points[i].on_a - flat[0].points[0].on_a).norm());
  EXPECT_GT(area, 1.99);
  const auto rolling = find(*disk, {Vector3(0, 0.9995, 0), rotated(std::numbers::pi / 2, Vector3::UnitX())}, *floor,
                            {Vector3(0, -1, 0), kLevel}, 1e-4);
  ASSERT_EQ(rolling.size(), 1U);
  EXPECT_GE(rolling[0].count, 2);
}

}  // namespace
}  // namespace breve::manifold_tests
