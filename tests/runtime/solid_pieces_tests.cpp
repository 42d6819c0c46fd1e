// Concave closed meshes: their mass properties, their convex pieces, and what touches them as which.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "runtime/base/error.hpp"
#include "runtime/solid/manifold.hpp"
#include "runtime/solid/triangle_mesh.hpp"
#include "tests/runtime/mesh_solids.hpp"
#include "tests/runtime/solid_oracle.hpp"

namespace breve::pieces_tests {
namespace {

using namespace mesh_solids;
using std::numbers::pi;

constexpr double kExact = 1e-12;

void no_charge(std::uint64_t) {}

std::shared_ptr<Shape> split(const Mesh& mesh, int most = 64, double excess = 0.05) {
  const auto shape = mesh.shape();
  shape->split({most, excess}, no_charge);
  return shape;
}

/// How far a point is outside the piece that it is deepest in.
double outside(const ConvexPieces& pieces, const Vector3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& piece : pieces.all()) {
    double here = -std::numeric_limits<double>::infinity();
    for (const Plane& plane : piece.solid.planes) here = std::max(here, plane.normal.dot(p) - plane.offset);
    least = std::min(least, here);
  }
  return least;
}

std::string refusal(const Mesh& mesh, const PieceSettings& settings = {}) {
  try {
    mesh.shape()->split(settings, no_charge);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Argument);
    return error.what();
  }
  return "accepted";
}

// --- mass ------------------------------------------------------------------------------------------------------------

TEST(ConcaveMass, OfAnLIsThatOfItsTwoBoxes) {
  const auto shape = ell().shape();
  EXPECT_NEAR(shape->volume(), 4, kExact);
  // Boxes 2 x 1 x 1 about (1, .5, .5) and 1 x 2 x 1 about (.5, 2, .5), 2 each.
  EXPECT_LE((shape->center_of_mass() - Vector3(0.75, 1.25, 0.5)).norm(), kExact);
  const auto about_origin = [](const Vector3& size, const Vector3& center) {
    const double mass = size.prod();
    const Vector3 square = size.cwiseAbs2() / 12;
    const Matrix3 second = mass * (Matrix3(square.asDiagonal()) + center * center.transpose());
    return Matrix3(second.trace() * Matrix3::Identity() - second);
  };
  const Matrix3 expected = about_origin({2, 1, 1}, {1, 0.5, 0.5}) + about_origin({1, 2, 1}, {0.5, 2, 0.5});
  EXPECT_LE((shape->inertia() - expected).norm(), 1e-11);
}

TEST(ConcaveMass, OfATorusIsPappusVolumeOfItsPolygonAndTendsToTheRoundOne) {
  const double radius = 1, tube = 0.3;
  double volume[3], moment[3];
  for (int i = 0; i < 3; ++i) {
    const int corners = 20 << i;
    const auto shape = torus(radius, tube, corners, corners).shape();
    volume[i] = shape->volume();
    moment[i] = shape->inertia()(1, 1);
    EXPECT_LE(shape->center_of_mass().norm(), 1e-12);
    // The area of the polygon times the way of its centre, which is also a polygon.
    const double step = 2 * pi / corners, area = corners * tube * tube * std::sin(step) / 2;
    EXPECT_NEAR(volume[i], area * radius * corners * std::sin(step), 1e-12);
  }
  // Richardson's extrapolation: errors are even powers of the step. The round one: volume 2 pi^2 R r^2, moment about
  // its axis m (R^2 + 3/4 r^2).
  const auto limit = [](const double(&x)[3]) {
    const double first = (4 * x[1] - x[0]) / 3, second = (4 * x[2] - x[1]) / 3;
    return (16 * second - first) / 15;
  };
  const double round = 2 * pi * pi * radius * tube * tube;
  EXPECT_NEAR(limit(volume), round, 1e-6);
  EXPECT_NEAR(limit(moment), round * (radius * radius + 0.75 * tube * tube), 1e-6);
}

TEST(ConcaveMass, OfACupIsThatOfTheCylinderLessItsHollow) {
  const double step = 2 * pi / 32, polygon = 32 * std::sin(step) / 2;  // area for radius 1
  const auto shape = cup(1, 2, 0.2, 32).shape();
  const double whole = polygon * 2, hollow = polygon * 0.64 * 1.8;
  EXPECT_NEAR(shape->volume(), whole - hollow, kExact);
  EXPECT_NEAR(shape->center_of_mass().y(), (whole * 1 - hollow * 1.1) / (whole - hollow), kExact);
  // About y: the mean square of the radius over a regular polygon is (2 + cos(step)) / 6.
  const double square = (2 + std::cos(step)) / 6;
  EXPECT_NEAR(shape->inertia()(1, 1), whole * square - hollow * 0.64 * square, kExact);
}

// --- pieces ----------------------------------------------------------------------------------------------------------

TEST(Pieces, HoldTheWholeSolidAndLittleMore) {
  oracle::Dice dice(91);
  const std::pair<const char*, Mesh> solids[] = {{"ell", ell()},
                                                 {"torus", torus(1, 0.3, 24, 12)},
                                                 {"cup", cup(1, 2, 0.2, 16)},
                                                 {"bowl", bowl(1, 0.25, 16, 5)},
                                                 {"block", block({1, 2, 3})}};
  for (const auto& [name, mesh] : solids) {
    SCOPED_TRACE(name);
    const auto shape = split(mesh, 96, 0.1);
    const ConvexPieces& pieces = *shape->pieces();
    ASSERT_LE(pieces.excess(), 0.1);
    double volume = 0;
    for (const auto& piece : pieces.all()) volume += moments(piece.solid).volume;
    ASSERT_NEAR(volume, shape->volume() * (1 + pieces.excess()), 1e-9);
    for (const Vector3& p : shape->triangles()->corners()) ASSERT_LE(outside(pieces, p), 1e-8);
    const Eigen::AlignedBox3d box = shape->surface()->bounds();
    int inside = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vector3 p = box.center() + dice.vector(1).cwiseProduct(box.sizes() / 2);
      if (!shape->surface()->inside(p)) continue;
      ++inside;
      ASSERT_LE(outside(pieces, p), 1e-8);
    }
    ASSERT_GT(inside, 300);
  }
}

TEST(Pieces, OfAnLAreTwoAndExactAndOfABlockOne) {
  EXPECT_EQ(split(ell())->pieces()->all().size(), 2U);
  EXPECT_NEAR(split(ell())->pieces()->excess(), 0, 1e-12);
  EXPECT_EQ(split(block({1, 2, 3}))->pieces()->all().size(), 1U);
  EXPECT_EQ(split(torus(1, 0.3, 16, 8), 5, 0)->pieces()->all().size(), 5U);  // no more than asked for
}

TEST(Pieces, ATurnedMeshHasPiecesAsGood) {
  oracle::Dice dice(92);
  for (int i = 0; i < 12; ++i) {
    Mesh mesh = i % 2 == 0 ? ell() : torus(1, 0.35, 12, 8);
    const Quaternion rotation = dice.rotation();
    for (Vector3& p : mesh.corners) p = rotation * p + dice.vector(0);
    const auto shape = split(mesh, 64, 0.1);
    ASSERT_LE(shape->pieces()->excess(), 0.1) << i;
    for (const Vector3& p : mesh.corners) ASSERT_LE(outside(*shape->pieces(), p), 1e-7) << i;
  }
}

TEST(Pieces, TheSameMeshGivesTheSamePieces) {
  const auto hash = [](const Shape& shape) {
    Hasher hasher;
    shape.pieces()->hash(hasher);
    return hasher.value();
  };
  EXPECT_EQ(hash(*split(cup(1, 2, 0.2, 12))), hash(*split(cup(1, 2, 0.2, 12))));
}

TEST(Pieces, AHollowIsKeptOpen) {
  Mesh hollow = block({4, 4, 4});
  hollow.add(block({2, 2, 2}), Vector3::Zero(), true);
  const auto shape = split(hollow, 64, 0.01);
  EXPECT_NEAR(shape->volume(), 64 - 8, 1e-12);
  EXPECT_LE(shape->pieces()->excess(), 0.01);
  EXPECT_GT(outside(*shape->pieces(), Vector3::Zero()), 0.5);
}

TEST(Pieces, RefuseWhatBoundsNoSolid) {
  Mesh open = ell();
  open.triangles.pop_back();
  EXPECT_NE(refusal(open).find("is not closed"), std::string::npos);
  Mesh crossing = block({2, 2, 2});
  crossing.add(block({2, 2, 2}), Vector3(0.7, 0.6, 0.5));
  EXPECT_NE(refusal(crossing).find("crosses itself"), std::string::npos);
  Mesh nested = block({4, 4, 4});
  nested.add(block({2, 2, 2}), Vector3::Zero());
  EXPECT_NE(refusal(nested).find("inside another"), std::string::npos);
  Mesh apart = block({2, 2, 2});
  apart.add(block({2, 2, 2}), Vector3(3, 0, 0));
  EXPECT_EQ(refusal(apart), "accepted");
  EXPECT_NE(refusal(ell(), {0, 0.1}).find("from 1 to 256"), std::string::npos);
  EXPECT_NE(refusal(ell(), {257, 0.1}).find("from 1 to 256"), std::string::npos);
  EXPECT_NE(refusal(ell(), {8, -1}).find("excess"), std::string::npos);
  EXPECT_NE(refusal(ell(), {8, std::nan("")}).find("excess"), std::string::npos);
  const auto ball = Shape::sphere(1);
  EXPECT_THROW(ball->split({}, no_charge), Error);
}

TEST(Pieces, WorkIsCountedAndMayEndIt) {
  const auto shape = torus(1, 0.3, 24, 12).shape();
  std::uint64_t all = 0;
  shape->split({32, 0.05}, [&](std::uint64_t units) { all += units; });
  EXPECT_GT(all, 100'000U);
  for (const std::uint64_t most : {std::uint64_t{0}, all / 7, all - 1}) {
    const auto other = torus(1, 0.3, 24, 12).shape();
    std::uint64_t done = 0;
    const auto charge = [&](std::uint64_t units) {
      if ((done += units) > most) throw Error(ErrorCode::Argument, "enough");
    };
    EXPECT_THROW(other->split({32, 0.05}, charge), Error);
    EXPECT_EQ(other->pieces(), nullptr);
  }
}

TEST(Pieces, ImageAndHashKeepThemAndDamageIsFound) {
  const auto shape = split(torus(1, 0.3, 12, 6), 8, 0.1);
  shape->set_scale(Vector3(1, 2, 0.5));
  ByteWriter out;
  shape->save(out);
  ByteReader in(out.bytes().data(), out.bytes().size());
  const auto again = Shape::load(in);
  Hasher before, after;
  shape->hash(before);
  again->hash(after);
  EXPECT_EQ(before.value(), after.value());
  EXPECT_EQ(again->pieces()->all().size(), shape->pieces()->all().size());
  // Each damaged image is refused, or is of a shape that can be used.
  const auto ball = Shape::sphere(0.5);
  for (std::size_t i = 0; i < out.bytes().size(); i += 7) {
    auto bytes = out.bytes();
    bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ (1U << (i % 8)));
    try {
      ByteReader damaged(bytes.data(), bytes.size());
      const auto loaded = Shape::load(damaged);
      std::pmr::vector<Manifold> found;
      find_manifolds(*loaded, {}, *shape, {Vector3(0.5, 0.1, 0), Quaternion::Identity()}, 0.1, found);
      find_manifolds(*loaded, {}, *ball, {}, 0.1, found);
    } catch (const Error& error) {
      ASSERT_EQ(error.code(), ErrorCode::Image);
    }
  }
}

// --- what they touch -------------------------------------------------------------------------------------------------

TEST(PieceContacts, ARingMeshMayHangOnAPegMesh) {
  // The peg is the larger mesh, so that the ring takes part as its pieces: its hull would overlap the peg.
  const auto peg = block({0.6, 9, 0.6}).shape(), ring = torus(1, 0.3, 24, 12).shape();
  EXPECT_LT(closest(*ring, {}, *peg, {}).distance, 0);
  ring->split({64, 0.05}, no_charge);
  // Between the inner side of the ring at .7 and an edge of the peg at .3 sqrt(2), less what pieces stand out.
  const double gap = closest(*ring, {}, *peg, {}).distance;
  EXPECT_NEAR(gap, 0.7 - 0.3 * std::sqrt(2.0), 0.1);
  std::pmr::vector<Manifold> found;
  find_manifolds(*ring, {}, *peg, {}, 0.05, found);
  EXPECT_TRUE(found.empty());
  find_manifolds(*ring, {Vector3(0.4, 0, 0), Quaternion::Identity()}, *peg, {}, 0.05, found);
  ASSERT_FALSE(found.empty());
  for (const Manifold& m : found) EXPECT_LT(m.normal.x(), -0.7);
}

TEST(PieceContacts, AgreeWithTheTrianglesWhereThePiecesAreExact) {
  oracle::Dice dice(93);
  const auto floor = block({12, 1, 12}).shape(), floor_box = Shape::box({12, 1, 12});
  const auto shape = split(ell().centered());
  int touching = 0;
  for (int i = 0; i < 300; ++i) {
    const Pose pose{Vector3(dice.between(-2, 2), dice.between(1, 2.6), dice.between(-2, 2)), dice.rotation()};
    // Against the box as triangles, against the mesh of the floor as pieces.
    const double expected = closest(*shape, pose, *floor_box, {}).distance;
    if (expected < 1e-3) {
      ++touching;
      continue;
    }
    ASSERT_NEAR(closest(*shape, pose, *floor, {}).distance, expected, 1e-9) << i;
    ASSERT_NEAR(closest(*floor, {}, *shape, pose).distance, expected, 1e-9) << i;
  }
  EXPECT_LT(touching, 200);
}

TEST(PieceContacts, TimeOfImpactIsThatOfTheTriangles) {
  oracle::Dice dice(94);
  const auto floor = block({12, 1, 12}).shape(), floor_box = Shape::box({12, 1, 12});
  const auto shape = split(ell().centered());
  for (int i = 0; i < 60; ++i) {
    const Motion falling{
        {Vector3(dice.between(-2, 2), 3.5, dice.between(-2, 2)), dice.rotation()}, {0, -4, 0}, dice.vector(2)};
    const Motion still;
    double expected = -1, found = -2;
    Contact contact;
    ASSERT_TRUE(time_of_impact(*shape, falling, *floor_box, still, 1, expected, contact)) << i;
    ASSERT_TRUE(time_of_impact(*shape, falling, *floor, still, 1, found, contact)) << i;
    ASSERT_NEAR(found, expected, 1e-8) << i;
  }
}

TEST(PieceContacts, ALRestsOnAHeightFieldWithItsOwnFoot) {
  // Upside down, on the short leg and the long one: the hull would touch between them.
  const std::vector<double> heights(9 * 9, 0.0);
  const auto ground = Shape::height_field(9, 9, 1, heights);
  Mesh bridge = block({3, 0.5, 1});
  bridge.add(block({0.5, 1, 1}), Vector3(0, 0, 0));  // crosses: only to be refused
  EXPECT_NE(refusal(bridge).find("crosses itself"), std::string::npos);
  const auto shape = split(ell());
  std::pmr::vector<Manifold> found;
  find_manifolds(*shape, {Vector3(0, -0.001, 0), Quaternion::Identity()}, *ground, {}, 0.01, found);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_GT(found[0].normal.y(), 0.999);
  for (int i = 0; i < found[0].count; ++i) {
    EXPECT_NEAR(found[0].points[static_cast<std::size_t>(i)].distance, -0.001, 1e-9);
  }
}

}  // namespace
}  // namespace breve::pieces_tests
