// Closest and deepest points of two solids against closed forms and against all pairs of features.
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/solid/contact.hpp"
#include "tests/runtime/solid_oracle.hpp"

namespace breve {
namespace {

// Positions and sizes are about 1: some hundred roundings of 1e-16.
constexpr double kExact = 1e-13;

void expect_near(const Vector3& a, const Vector3& b, double tolerance) {
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), tolerance) << a.transpose() << " against " << b.transpose();
}

TEST(Closest, SpheresApartInClosedForm) {
  const auto a = Shape::sphere(0.5), b = Shape::sphere(1);
  const Contact c =
      closest(*a, {Vector3(3, 4, 0), Quaternion::Identity()}, *b, {Vector3::Zero(), Quaternion::Identity()});
  EXPECT_NEAR(c.distance, 3.5, kExact);
  expect_near(c.normal, Vector3(0.6, 0.8, 0), kExact);
  expect_near(c.point, 2.75 * Vector3(0.6, 0.8, 0), kExact);
}

TEST(Closest, ConcentricSpheresHaveAUnitNormalAndFullDepth) {
  const auto a = Shape::sphere(0.5), b = Shape::sphere(1);
  const Contact c = closest(*a, {}, *b, {});
  EXPECT_EQ(c.distance, -1.5);
  EXPECT_EQ(c.normal.norm(), 1);
}

TEST(Closest, SphereAndRotatedBoxInClosedForm) {
  oracle::Dice dice(1);
  for (int i = 0; i < 2000; ++i) {
    const Vector3 half(dice.between(0.1, 2), dice.between(0.1, 2), dice.between(0.1, 2));
    const auto ball = Shape::sphere(dice.between(0.1, 1)), box = Shape::box(2 * half);
    const Pose at{dice.vector(3), dice.rotation()}, center{dice.vector(4), dice.rotation()};
    const Vector3 p = at.orientation.conjugate() * (center.location - at.location);
    const Vector3 clamped = p.cwiseMax(-half).cwiseMin(half);
    const bool inside = clamped == p;
    const double expected = inside ? (p.cwiseAbs() - half).maxCoeff() : (p - clamped).norm();
    const Contact c = closest(*ball, center, *box, at);
    ASSERT_NEAR(c.distance, expected - ball->radius(), kExact);
    // Mirrored arguments: the same, with the normal turned about.
    const Contact m = closest(*box, at, *ball, center);
    ASSERT_EQ(m.distance, c.distance);
    expect_near(m.normal, -c.normal, kExact);
    expect_near(m.point, c.point, kExact * 10);
    if (inside) continue;
    expect_near(c.normal, at.orientation * (p - clamped).normalized(), 1e-12 / expected + kExact);
  }
}

TEST(Closest, PolyhedraApartMatchAllPairsOfFeatures) {
  oracle::Dice dice(2);
  int apart = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto a = dice.polyhedron(i), b = dice.polyhedron(i / 4);
    const Pose pa{dice.vector(1), dice.rotation()}, pb{dice.vector(3), i % 5 == 0 ? pa.orientation : dice.rotation()};
    const Contact c = closest(*a, pa, *b, pb);
    if (c.distance <= 0) continue;
    ++apart;
    ASSERT_NEAR(c.distance, oracle::distance(*a, pa, *b, pb), kExact) << "case " << i;
    ASSERT_NEAR(c.normal.norm(), 1, kExact);
    // The normal separates by the whole distance, and the point is midway on both sides of it.
    ASSERT_NEAR(oracle::shadow_overlap(*a, pa, *b, pb, -c.normal), -c.distance, 1e-12) << "case " << i;
  }
  EXPECT_GT(apart, 1000);
}

TEST(Closest, TinyGapsKeepTheirDigits) {
  oracle::Dice dice(3);
  for (int i = 0; i < 2000; ++i) {
    const auto a = dice.polyhedron(i), b = dice.polyhedron(i / 4);
    const Pose pa{dice.vector(1), dice.rotation()};
    Pose pb{dice.vector(3), dice.rotation()};
    const Contact far = closest(*a, pa, *b, pb);
    // Move b along the normal to a gap of 1e-3 ... 1e-11: the old distance less the way (the normal stays the best
    // one).
    const double gap = std::pow(10, -3 - i % 9);
    pb.location += (far.distance - gap) * far.normal;
    const Contact near = closest(*a, pa, *b, pb);
    ASSERT_NEAR(near.distance, gap, kExact) << "case " << i;
    ASSERT_NEAR(oracle::shadow_overlap(*a, pa, *b, pb, -near.normal), -gap, kExact) << "case " << i;
    // Between two vertices every direction within this cone separates by the gap, to round-off: 1e-13 / 1e-11.
    ASSERT_GE(near.normal.dot(far.normal), 1 - kExact / gap) << "case " << i << " gap " << gap;
  }
}

TEST(Closest, OverlappingBoxesMatchTheFifteenAxes) {
  oracle::Dice dice(4);
  int overlaps = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3 ha(dice.between(0.1, 1), dice.between(0.1, 1), dice.between(0.1, 1));
    const Vector3 hb(dice.between(0.1, 1), dice.between(0.1, 1), dice.between(0.1, 1));
    const Pose pa{dice.vector(1), dice.rotation()},
        pb{pa.location + dice.vector(0.8), i % 5 == 0 ? pa.orientation : dice.rotation()};
    const Eigen::Matrix3d ra = pa.orientation.toRotationMatrix(), rb = pb.orientation.toRotationMatrix();
    double expected = -1e9;
    const auto axis = [&](Vector3 n) {
      if (n.norm() < 1e-6) return;
      n.normalize();
      expected =
          std::max(expected, std::abs(n.dot(pb.location - pa.location)) - (ra.transpose() * n).cwiseAbs().dot(ha) -
                                 (rb.transpose() * n).cwiseAbs().dot(hb));
    };
    for (int k = 0; k < 3; ++k) {
      axis(ra.col(k));
      axis(rb.col(k));
      for (int l = 0; l < 3; ++l) axis(ra.col(k).cross(rb.col(l)));
    }
    const Contact c = closest(*Shape::box(2 * ha), pa, *Shape::box(2 * hb), pb);
    ASSERT_EQ(c.distance > 0, expected > 0);
    if (expected > 0) continue;
    ++overlaps;
    ASSERT_NEAR(c.distance, expected, kExact) << "case " << i;
  }
  EXPECT_GT(overlaps, 1000);
}

TEST(Closest, DepthIsTheShortestWayOutForAnyPolyhedra) {
  oracle::Dice dice(5);
  int overlaps = 0;
  for (int i = 0; i < 1500; ++i) {
    const auto a = dice.polyhedron(i), b = dice.polyhedron(i / 4);
    const Pose pa{dice.vector(1), dice.rotation()};
    Pose pb{pa.location + dice.vector(0.7), dice.rotation()};
    const Contact c = closest(*a, pa, *b, pb);
    if (c.distance > 0) continue;
    ++overlaps;
    for (int k = 0; k < 200; ++k) {
      ASSERT_GE(oracle::shadow_overlap(*a, pa, *b, pb, dice.direction()), -c.distance - kExact) << "case " << i;
    }
    pb.location -= (-c.distance + 1e-6) * c.normal;
    ASSERT_NEAR(closest(*a, pa, *b, pb).distance, 1e-6, kExact) << "case " << i;
  }
  EXPECT_GT(overlaps, 500);
}

/// Corners at random on an ellipsoid: a solid of some three edges for each.
std::shared_ptr<Shape> pebble(oracle::Dice& dice, int corners, const Vector3& half) {
  std::vector<Vector3> points;
  for (int i = 0; i < corners; ++i) points.push_back(half.cwiseProduct(dice.direction()));
  const Polyhedron hull = make_hull(points);
  std::vector<std::vector<Vector3>> faces;
  for (const auto& face : hull.faces) {
    std::vector<Vector3>& corner = faces.emplace_back();
    for (const int v : face) corner.push_back(hull.vertices[at(v)]);
  }
  return Shape::convex(faces, 1);
}

/// Edges of such solids are looked for on their Gauss maps. What they find is also what a search by all directions
/// finds, those next to the found one among them.
TEST(Closest, DepthIsTheShortestWayOutForSolidsOfManyEdges) {
  oracle::Dice dice(6);
  int overlaps = 0;
  for (int i = 0; i < 60; ++i) {
    const Vector3 half_a = dice.edges(0.4, 1), half_b = dice.edges(0.4, 1);
    const auto a = pebble(dice, 100 + 10 * i, half_a), b = pebble(dice, 300, half_b);
    ASSERT_FALSE(b->polyhedron().arcs.empty());
    const Pose pa{dice.vector(1), dice.rotation()};
    Pose pb{pa.location + dice.vector(0.5), dice.rotation()};
    const Contact c = closest(*a, pa, *b, pb);
    if (c.distance > 0) continue;
    ++overlaps;
    for (int k = 0; k < 2000; ++k) {
      const double apart = std::pow(10, dice.between(-8, 0));
      const Vector3 direction = (c.normal + apart * dice.direction()).normalized();
      ASSERT_GE(oracle::shadow_overlap(*a, pa, *b, pb, direction), -c.distance - kExact) << "case " << i;
    }
    pb.location -= (-c.distance + 1e-6) * c.normal;
    ASSERT_NEAR(closest(*a, pa, *b, pb).distance, 1e-6, kExact) << "case " << i;
  }
  EXPECT_GT(overlaps, 30);
}

TEST(Closest, ABoxInTheFloorTouchesUnderTheBox) {
  const auto box = Shape::box(Vector3(1, 1, 1)), floor = Shape::box(Vector3(1000, 2, 1000));
  const Contact c = closest(*box, {Vector3(100, 0.4, 50), Quaternion::Identity()}, *floor,
                            {Vector3(0, -1, 0), Quaternion::Identity()});
  EXPECT_NEAR(c.distance, -0.1, 1e-12);
  expect_near(c.normal, Vector3::UnitY(), 1e-12);
  EXPECT_LE(std::abs(c.point.x() - 100), 0.5 + 1e-9);
  EXPECT_LE(std::abs(c.point.z() - 50), 0.5 + 1e-9);
  EXPECT_NEAR(c.point.y(), -0.05, 1e-9);
}

TEST(Closest, SphereOnAConeTipAndSide) {
  const auto cone = Shape::cone(4, 2, 1), ball = Shape::sphere(0.25);
  EXPECT_NEAR(closest(*ball, {Vector3(0, 3, 0), Quaternion::Identity()}, *cone, {}).distance, 1.75,
              kExact);  // apex at +height/2
  EXPECT_NEAR(closest(*ball, {Vector3(0, -3, 0), Quaternion::Identity()}, *cone, {}).distance, 1.75, kExact);
  EXPECT_NEAR(closest(*ball, {Vector3(3, -1, 0), Quaternion::Identity()}, *cone, {}).distance, 1.75,
              kExact);  // first base vertex on +x
}

TEST(PoseAt, RotatesByTheExponentialMap) {
  const Motion motion{
      {Vector3(1, 2, 3), Quaternion(Eigen::AngleAxisd(0.3, Vector3::UnitX()))}, Vector3(1, 0, 0), Vector3(0, 0, 2)};
  const Pose pose = pose_at(motion, 0.5);
  expect_near(pose.location, Vector3(1.5, 2, 3), kExact);
  const Quaternion expected = Quaternion(Eigen::AngleAxisd(1.0, Vector3::UnitZ())) * motion.start.orientation;
  EXPECT_LE(pose.orientation.angularDistance(expected), 1e-15 * 10);
}

}  // namespace
}  // namespace breve
