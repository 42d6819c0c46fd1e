// Cylinders and capsules: closed forms of mass, rays and bounds; distances and overlaps against dense sampling of
// separating directions; contact points where lines and caps lie on something; times of impact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/base/error.hpp"
#include "runtime/solid/manifold.hpp"
#include "tests/runtime/solid_oracle.hpp"

namespace breve::round_tests {
namespace {

using oracle::Dice;

constexpr double kExact = 1e-12;
const Quaternion kLevel = Quaternion::Identity();

Quaternion rotated(double angle, const Vector3& axis) {
  return Quaternion(Eigen::AngleAxisd(angle, axis.normalized()));
}

std::pmr::vector<Manifold> find(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, double margin = 0.01) {
  std::pmr::vector<Manifold> out;
  find_manifolds(a, pa, b, pb, margin, out);
  return out;
}

void expect_near(const Vector3& a, const Vector3& b, double tolerance) {
  EXPECT_LE((a - b).cwiseAbs().maxCoeff(), tolerance) << a.transpose() << " against " << b.transpose();
}

// --- the oracle: how far two solids are apart along directions, by their own formulas

double highest(const Shape& shape, const Pose& pose, const Vector3& n) {
  const Vector3 d = pose.orientation.conjugate() * n;
  const double at = n.dot(pose.location);
  switch (shape.kind()) {
    case ShapeKind::Sphere: return at + shape.radius();
    case ShapeKind::Cylinder:
      return at + shape.radius() * std::hypot(d.x(), d.z()) +
             shape.bounds(Matrix3::Identity()).max().y() * std::abs(d.y());
    case ShapeKind::Capsule:
      return at + shape.radius() + (shape.bounds(Matrix3::Identity()).max().y() - shape.radius()) * std::abs(d.y());
    default: break;
  }
  double most = -1e300;
  for (const Vector3& v : shape.vertices()) most = std::max(most, d.dot(v));
  return at + most;
}

struct Sampled {
  double distance;
  Vector3 normal;
};

double apart_along(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, const Vector3& n) {
  return -highest(a, pa, -n) - highest(b, pb, n);
}

/// The direction that separates best: of a dense net of directions the best few, each improved by ever smaller steps.
Sampled sampled(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, Dice& dice) {
  const auto apart = [&](const Vector3& n) { return apart_along(a, pa, b, pb, n); };
  constexpr int kNet = 3000, kTries = 8;
  std::vector<Sampled> net;
  for (int i = 0; i < kNet; ++i) {
    const double y = 1 - 2 * (i + 0.5) / kNet, angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const Vector3 n(std::sqrt(1 - y * y) * std::cos(angle), y, std::sqrt(1 - y * y) * std::sin(angle));
    net.push_back({apart(n), n});
  }
  std::partial_sort(net.begin(), net.begin() + kTries, net.end(),
                    [](const Sampled& x, const Sampled& y) { return x.distance > y.distance; });
  Sampled best{-1e300, Vector3::UnitY()};
  for (int i = 0; i < kTries; ++i) {
    Sampled here = net[static_cast<std::size_t>(i)];
    for (double step = 0.05; step > 1e-11; step *= 0.8) {
      for (int k = 0; k < 12; ++k) {
        const Vector3 n = (here.normal + dice.vector(step)).normalized();
        if (const double d = apart(n); d > here.distance) here = {d, n};
      }
    }
    if (here.distance > best.distance) best = here;
  }
  return best;
}

std::shared_ptr<Shape> some_round(Dice& dice, int which) {
  const double radius = dice.between(0.1, which % 2 == 0 ? 1 : 0.6), length = dice.between(0.1, 2);
  return which % 2 == 0 ? Shape::cylinder(length, radius) : Shape::capsule(length, radius);
}

std::shared_ptr<Shape> some_solid(Dice& dice, int which) {
  if (which % 3 == 0) return some_round(dice, which / 3);
  if (which % 3 == 1) return dice.polyhedron(which / 3);
  return Shape::sphere(dice.between(0.2, 1));
}

TEST(RoundShape, MassAndInertiaAreThoseOfTheSolids) {
  const double pi = std::numbers::pi, r = 0.4, h = 1.5;
  const auto cylinder = Shape::cylinder(h, r);
  cylinder->set_density(3);
  const double m = 3 * pi * r * r * h;
  EXPECT_NEAR(cylinder->mass(), m, kExact);
  EXPECT_NEAR(cylinder->inertia()(1, 1), m * r * r / 2, kExact);
  EXPECT_NEAR(cylinder->inertia()(0, 0), m * (3 * r * r + h * h) / 12, kExact);
  EXPECT_NEAR(cylinder->inertia()(2, 2), m * (3 * r * r + h * h) / 12, kExact);

  const auto capsule = Shape::capsule(h, r);
  const double tube = pi * r * r * h, ball = 4 * pi / 3 * r * r * r;
  EXPECT_NEAR(capsule->mass(), tube + ball, kExact);
  EXPECT_NEAR(capsule->inertia()(1, 1), tube * r * r / 2 + ball * 2 * r * r / 5, kExact);
  const double across = tube * (3 * r * r + h * h) / 12 + ball * (2 * r * r / 5 + h * h / 4 + 3 * h * r / 8);
  EXPECT_NEAR(capsule->inertia()(0, 0), across, kExact);
  EXPECT_NEAR(capsule->inertia()(2, 2), across, kExact);
}

TEST(RoundShape, APrismOfManySidesTendsToTheCylinder) {
  const auto prism = Shape::prism(900, 1.5, 0.4), cylinder = Shape::cylinder(1.5, 0.4);
  EXPECT_NEAR(prism->mass() / cylinder->mass(), 1, 1e-4);
  EXPECT_TRUE(prism->inertia().isApprox(cylinder->inertia(), 1e-4));
}

TEST(RoundShape, ScaleStretchesACylinderAlongAndAcrossItsAxis) {
  const auto shape = Shape::cylinder(1, 0.5);
  shape->set_scale(Vector3(2, 3, 9));
  const auto wanted = Shape::cylinder(3, 1);
  EXPECT_NEAR(shape->mass(), wanted->mass(), kExact);
  EXPECT_TRUE(shape->inertia().isApprox(wanted->inertia(), kExact));
  expect_near(shape->bounds(Matrix3::Identity()).max(), Vector3(1, 1.5, 1), kExact);
  EXPECT_NEAR(shape->bounding_radius(), std::hypot(1, 1.5), kExact);
  const auto capsule = Shape::capsule(1, 0.5);
  capsule->set_scale(Vector3(2, 3, 9));
  EXPECT_NEAR(capsule->mass(), Shape::capsule(2, 1)->mass(), kExact);
}

TEST(RoundShape, BadSizesAreRefused) {
  EXPECT_THROW(Shape::cylinder(0, 1), Error);
  EXPECT_THROW(Shape::cylinder(1, -1), Error);
  EXPECT_THROW(Shape::capsule(std::nan(""), 1), Error);
  EXPECT_THROW(Shape::capsule(1, 1e200), Error);
}

TEST(RoundShape, AnImageKeepsEveryBit) {
  for (const auto& shape : {Shape::cylinder(0.3, 0.7), Shape::capsule(1.1, 0.2), Shape::cylinder(0.3, 0.7, 2)}) {
    shape->set_scale(Vector3(1.5, 0.7, 1.1));
    shape->set_density(7);
    ByteWriter out;
    shape->save(out);
    const auto& bytes = out.bytes();
    ByteReader in(bytes.data(), bytes.size());
    const auto copy = Shape::load(in);
    Hasher of_shape, of_copy;
    shape->hash(of_shape);
    copy->hash(of_copy);
    EXPECT_EQ(of_shape.value(), of_copy.value());
    EXPECT_EQ(copy->kind(), shape->kind());
    EXPECT_EQ(copy->mass(), shape->mass());
    EXPECT_EQ(copy->vertices().size(), shape->vertices().size());
    for (std::size_t cut = 0; cut < bytes.size(); cut += 3) {
      ByteReader short_in(bytes.data(), cut);
      EXPECT_THROW(Shape::load(short_in), Error);
    }
  }
}

TEST(RoundShape, PolygonsThatShowThemLieOnTheSurfaceAndClose) {
  for (const auto& shape : {Shape::cylinder(0.3, 0.7), Shape::capsule(1.1, 0.2), Shape::capsule(1.1, 0.2, 2)}) {
    Moments sum = moments(shape->polyhedron());
    EXPECT_GT(sum.volume, 0.95 * shape->volume());
    EXPECT_LT(sum.volume, shape->volume());
    for (const Plane& plane : shape->polyhedron().planes) EXPECT_GT(plane.offset, 0);
    for (const Vector3& v : shape->vertices()) {
      double t;
      ASSERT_TRUE(shape->raycast(3 * v, -v, t));
      EXPECT_NEAR(t, 2, 1e-9);
    }
  }
}

TEST(RoundShape, RaysMeetSidesCapsAndRoundEnds) {
  const auto cylinder = Shape::cylinder(2, 0.5), capsule = Shape::capsule(2, 0.5);
  double t;
  ASSERT_TRUE(cylinder->raycast(Vector3(3, 0.2, 0), Vector3(-1, 0, 0), t));
  EXPECT_NEAR(t, 2.5, kExact);
  ASSERT_TRUE(cylinder->raycast(Vector3(0.2, 5, 0.1), Vector3(0, -2, 0), t));
  EXPECT_NEAR(t, 2, kExact);
  EXPECT_FALSE(cylinder->raycast(Vector3(0.6, 5, 0), Vector3(0, -2, 0), t));
  ASSERT_TRUE(cylinder->raycast(Vector3(0, 0.3, 0), Vector3(0, 1, 0), t));
  EXPECT_EQ(t, 0);
  EXPECT_FALSE(cylinder->raycast(Vector3(3, 0, 0), Vector3(1, 0, 0), t));
  ASSERT_TRUE(capsule->raycast(Vector3(0.3, 5, 0), Vector3(0, -1, 0), t));
  EXPECT_NEAR(t, 5 - 1.4, kExact);
  ASSERT_TRUE(capsule->raycast(Vector3(0, 0.9, 4), Vector3(0, 0, -1), t));
  EXPECT_NEAR(t, 3.5, kExact);
  EXPECT_FALSE(capsule->raycast(Vector3(0.45, 1.4, 4), Vector3(0, 0, -1), t));
  expect_near(cylinder->point_on(Vector3(1, 0, 0)), Vector3(0.5, 0, 0), kExact);
  expect_near(cylinder->point_on(Vector3(0, -3, 0)), Vector3(0, -1, 0), kExact);
  expect_near(capsule->point_on(Vector3(0, 1, 0)), Vector3(0, 1.5, 0), kExact);
}

// What separates along some direction is never more than the distance of two points: where both agree, both are exact.
TEST(RoundGap, DistanceIsThatOfTheBestSeparatingDirection) {
  Dice dice(1);
  for (int i = 0; i < 150; ++i) {
    const auto a = some_round(dice, i), b = some_solid(dice, i / 2);
    const Pose pa{dice.vector(1), dice.rotation()};
    const Vector3 to = dice.direction();
    const Pose pb{pa.location + dice.between(1, 3) * to, dice.rotation()};
    const Sampled wanted = sampled(*a, pa, *b, pb, dice);
    if (wanted.distance < 1e-6) continue;
    const Contact found = closest(*a, pa, *b, pb);
    EXPECT_NEAR(apart_along(*a, pa, *b, pb, found.normal), found.distance, 1e-11) << i;
    EXPECT_NEAR(found.distance, wanted.distance, 1e-4) << i;
    EXPECT_GE(found.distance, wanted.distance - 1e-12) << i;
    const Contact other = closest(*b, pb, *a, pa);
    EXPECT_NEAR(other.distance, found.distance, 1e-11) << i;
    expect_near(other.normal, -found.normal, 1e-5);
  }
}

TEST(RoundGap, OverlapIsTheShortestWayOut) {
  Dice dice(2);
  int deep = 0;
  for (int i = 0; i < 200; ++i) {
    const auto a = some_round(dice, i), b = some_solid(dice, i / 2);
    const Pose pa{dice.vector(1), dice.rotation()};
    Pose pb{pa.location + dice.direction(), dice.rotation()};
    // From where they touch inward.
    const Sampled far = sampled(*a, pa, *b, pb, dice);
    const double size = std::min(a->bounding_radius(), b->bounding_radius());
    const double depth = std::pow(10, dice.between(-9, -1.5)) * size;
    pb.location += (far.distance + depth) * far.normal;
    const Sampled wanted = sampled(*a, pa, *b, pb, dice);
    const Contact found = closest(*a, pa, *b, pb);
    if (wanted.distance > 0) continue;
    ++deep;
    EXPECT_NEAR(apart_along(*a, pa, *b, pb, found.normal), found.distance, 1e-11) << i;
    EXPECT_GE(found.distance, wanted.distance - 1e-9 - 1e-3 * std::abs(wanted.distance)) << i;
  }
  EXPECT_GT(deep, 100);
}

TEST(RoundGap, DeepOverlapsEndInANormalThatSeparates) {
  Dice dice(3);
  for (int i = 0; i < 300; ++i) {
    const auto a = some_round(dice, i), b = some_solid(dice, i / 2);
    const Pose pa{dice.vector(1), dice.rotation()}, pb{pa.location + dice.vector(0.05), dice.rotation()};
    const Contact found = closest(*a, pa, *b, pb);
    ASSERT_LT(found.distance, 0) << i;
    EXPECT_NEAR(found.normal.norm(), 1, kExact) << i;
    const Pose there{pb.location + (found.distance - 1e-6) * found.normal, pb.orientation};
    EXPECT_GT(closest(*a, pa, *b, there).distance, 0) << i;
  }
}

// --- contact points

const Pose kFloor{Vector3(0, -1, 0), kLevel};

std::shared_ptr<Shape> floor_box() { return Shape::box(Vector3(10, 2, 10)); }

/// A floor of two triangles, its top at y = 0.
std::shared_ptr<Shape> floor_mesh() {
  const std::vector<Vector3> corners{{-5, 0, -5}, {5, 0, -5}, {5, 0, 5}, {-5, 0, 5}};
  return Shape::mesh(corners, std::vector<std::array<std::int32_t, 3>>{{0, 2, 1}, {0, 3, 2}});
}

/// Points along a line from one end to the other, both among them; where triangles meet under it there may be more.
void expect_line(const std::pmr::vector<Manifold>& found, double depth, const Vector3& one, const Vector3& other) {
  ASSERT_EQ(found.size(), 1U);
  ASSERT_GE(found[0].count, 2);
  expect_near(found[0].normal, Vector3::UnitY(), 1e-9);
  double low = 1, high = 0;
  for (int i = 0; i < found[0].count; ++i) {
    const ContactPoint& point = found[0].points[static_cast<std::size_t>(i)];
    EXPECT_NEAR(point.distance, -depth, 1e-12);
    const double along = (point.on_a - one).dot(other - one) / (other - one).squaredNorm();
    expect_near(point.on_a, one + along * (other - one), 1e-9);
    low = std::min(low, along);
    high = std::max(high, along);
  }
  EXPECT_NEAR(low, 0, 1e-9);
  EXPECT_NEAR(high, 1, 1e-9);
}

TEST(RoundManifold, ALyingCylinderTouchesAlongALineOnAnyFloor) {
  const auto cylinder = Shape::cylinder(1, 0.5);
  const Pose lying{Vector3(0.3, 0.499, 0.2), rotated(std::numbers::pi / 2, Vector3::UnitX())};
  const Vector3 one(0.3, -0.001, 0.7), other(0.3, -0.001, -0.3);
  expect_line(find(*cylinder, lying, *floor_box(), kFloor), 0.001, one, other);
  const auto hull = Shape::hull(floor_box()->vertices(), 1);
  expect_line(find(*cylinder, lying, *hull, kFloor), 0.001, one, other);
  expect_line(find(*cylinder, lying, *floor_mesh(), {}), 0.001, one, other);
  const std::vector<double> heights(36, 0.0);
  expect_line(find(*cylinder, lying, *Shape::height_field(6, 6, 2, heights), {}), 0.001, one, other);
  // Rotated about its own axis it is the same.
  const Pose rolled{lying.location, lying.orientation * rotated(0.777, Vector3::UnitY())};
  expect_line(find(*cylinder, rolled, *floor_box(), kFloor), 0.001, one, other);
}

TEST(RoundManifold, ALyingCapsuleTouchesUnderBothEnds) {
  const auto capsule = Shape::capsule(1, 0.5);
  const Pose lying{Vector3(0, 0.499, 0), rotated(std::numbers::pi / 2, Vector3::UnitX())};
  expect_line(find(*capsule, lying, *floor_box(), kFloor), 0.001, Vector3(0, -0.001, 0.5), Vector3(0, -0.001, -0.5));
  expect_line(find(*capsule, lying, *floor_mesh(), {}), 0.001, Vector3(0, -0.001, 0.5), Vector3(0, -0.001, -0.5));
}

TEST(RoundManifold, AStandingCylinderStandsOnFourPointsOfItsRim) {
  const auto cylinder = Shape::cylinder(1, 0.5);
  for (const auto& floor : {floor_box(), Shape::cylinder(2, 3)}) {
    const auto found = find(*cylinder, {Vector3(0.3, 0.499, 0.2), kLevel}, *floor, kFloor);
    ASSERT_EQ(found.size(), 1U);
    ASSERT_EQ(found[0].count, 4);
    Vector3 middle = Vector3::Zero();
    for (const ContactPoint& point : found[0].points) {
      EXPECT_NEAR(point.distance, -0.001, 1e-12);
      const Vector3 from = point.on_a - Vector3(0.3, -0.001, 0.2);
      EXPECT_NEAR(from.norm(), 0.5, 1e-9);
      middle += from / 4;
    }
    EXPECT_LT(middle.norm(), 0.1);
  }
}

TEST(RoundManifold, ATiltedCylinderTouchesWithTheLowestPointOfItsRim) {
  const auto cylinder = Shape::cylinder(1, 0.5);
  const double tilt = 0.3, low = -0.5 * std::cos(tilt) - 0.5 * std::sin(tilt);
  const Pose pose{Vector3(0, -low - 0.001, 0), rotated(tilt, Vector3::UnitZ())};
  for (const auto& [floor, at] : {std::pair(floor_box(), kFloor), std::pair(floor_mesh(), Pose{})}) {
    const auto found = find(*cylinder, pose, *floor, at, 0);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].points[0].distance, -0.001, 1e-12);
    EXPECT_NEAR(found[0].points[0].on_a.x(), 0.5 * std::sin(tilt) - 0.5 * std::cos(tilt), 1e-9);
  }
}

TEST(RoundManifold, LogsSideBySideTouchAlongALineAndCrossedInAPoint) {
  const auto log = Shape::cylinder(4, 0.5);
  const Quaternion along_z = rotated(std::numbers::pi / 2, Vector3::UnitX());
  const Quaternion along_x = rotated(std::numbers::pi / 2, Vector3::UnitZ());
  expect_line(find(*log, {Vector3(0, 0.999, 1), along_z}, *log, {Vector3::Zero(), along_z}), 0.001,
              Vector3(0, 0.499, 2), Vector3(0, 0.499, -1));
  const auto crossed = find(*log, {Vector3(0, 0.999, 1), along_x}, *log, {Vector3::Zero(), along_z});
  ASSERT_EQ(crossed.size(), 1U);
  EXPECT_EQ(crossed[0].count, 1);
  EXPECT_NEAR(crossed[0].points[0].distance, -0.001, 1e-12);
  expect_near(crossed[0].points[0].on_a, Vector3(0, 0.499, 1), 1e-6);
  const auto capsule = Shape::capsule(4, 0.5);
  expect_line(find(*capsule, {Vector3(0, 0.999, 1), along_z}, *capsule, {Vector3::Zero(), along_z}), 0.001,
              Vector3(0, 0.499, 2), Vector3(0, 0.499, -1));
}

TEST(RoundManifold, ABoxStandsOnACapAndABallOnASide) {
  const auto cylinder = Shape::cylinder(1, 2), box = Shape::box(Vector3(1, 1, 1)), ball = Shape::sphere(0.5);
  const auto flat = find(*box, {Vector3(0.2, 0.999, 0), kLevel}, *cylinder, {});
  ASSERT_EQ(flat.size(), 1U);
  EXPECT_EQ(flat[0].count, 4);
  for (const ContactPoint& point : flat[0].points) EXPECT_NEAR(point.distance, -0.001, 1e-12);
  const auto side = find(*ball, {Vector3(2.499, 0.1, 0), kLevel}, *cylinder, {});
  ASSERT_EQ(side.size(), 1U);
  EXPECT_EQ(side[0].count, 1);
  expect_near(side[0].normal, Vector3::UnitX(), kExact);
  EXPECT_NEAR(side[0].points[0].distance, -0.001, kExact);
}

// --- times of impact

TEST(RoundImpact, FallingCylindersAndCapsulesLandWhenTheyShould) {
  const auto floor = floor_box();
  const Motion still{kFloor};
  Dice dice(5);
  for (int i = 0; i < 40; ++i) {
    const auto shape = some_round(dice, i);
    const Quaternion rotation = dice.rotation();
    const double low = -(-highest(*shape, {Vector3::Zero(), rotation}, -Vector3::UnitY()));
    Motion motion{{Vector3(0.1, 2 + low, 0.2), rotation}};
    motion.velocity = Vector3(0.3, -4, 0.1);
    // A spin about its own axis moves nothing of it.
    motion.rotational_velocity_world = dice.between(-50, 50) * (rotation * Vector3::UnitY());
    double t;
    Contact contact;
    ASSERT_TRUE(time_of_impact(*shape, motion, *floor, still, 1, t, contact)) << i;
    EXPECT_NEAR(t, 0.5, 1e-10) << i;
    ASSERT_TRUE(time_of_impact(*floor, still, *shape, motion, 1, t, contact)) << i;
    EXPECT_NEAR(t, 0.5, 1e-10) << i;
    ASSERT_TRUE(time_of_impact(*shape, motion, *floor_mesh(), Motion{}, 1, t, contact)) << i;
    EXPECT_NEAR(t, 0.5, 1e-10) << i;
  }
}

TEST(RoundImpact, TumblingSolidsTouchAtTheTimeThatIsFoundAndNotBefore) {
  Dice dice(6);
  int hits = 0;
  for (int i = 0; i < 120; ++i) {
    const auto a = some_round(dice, i), b = some_solid(dice, i / 2);
    Motion ma{{dice.vector(1), dice.rotation()}}, mb{{ma.start.location + 4 * dice.direction(), dice.rotation()}};
    ma.velocity = 3 * (mb.start.location - ma.start.location) / 4 + dice.vector(0.6);
    ma.rotational_velocity_world = dice.vector(4);
    mb.rotational_velocity_world = dice.vector(4);
    double t = 1;
    Contact contact;
    const bool hit = time_of_impact(*a, ma, *b, mb, 1, t, contact);
    hits += hit;
    EXPECT_TRUE(!hit || std::abs(contact.distance) <= 1e-9) << i;
    for (int k = 0; k < 40; ++k) {
      const double before = t * (k + 0.5) / 40;
      EXPECT_GT(closest(*a, pose_at(ma, before), *b, pose_at(mb, before)).distance, -1e-12) << i;
    }
  }
  EXPECT_GT(hits, 40);
}

}  // namespace
}  // namespace breve::round_tests
