// Triangle meshes, height fields and hulls: geometry, mass, rays, closest points, contact points, times of impact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "runtime/base/error.hpp"
#include "runtime/solid/height_grid.hpp"
#include "runtime/solid/manifold.hpp"
#include "runtime/solid/polygons.hpp"
#include "runtime/solid/triangle_mesh.hpp"
#include "tests/runtime/mesh_solids.hpp"
#include "tests/runtime/solid_oracle.hpp"

namespace breve::surface_tests {
namespace {

constexpr double kExact = 1e-12;
const Quaternion kLevel = Quaternion::Identity();

Quaternion rotated(double angle, const Vector3& axis) {
  return Quaternion(Eigen::AngleAxisd(angle, axis.normalized()));
}

/// The faces of a convex shape as triangles.
std::shared_ptr<Shape> mesh_of(const Shape& solid) {
  const std::vector<Vector3> corners(solid.vertices().begin(), solid.vertices().end());
  std::vector<Triangle> triangles;
  for (const auto& face : solid.faces()) {
    for (std::size_t i = 1; i + 1 < face.size(); ++i) triangles.push_back({face[0], face[i], face[i + 1]});
  }
  return Shape::mesh(corners, triangles);
}

/// A level grid of `cells` squares of triangles as an open mesh in the plane y = 0.
std::shared_ptr<Shape> sheet(int cells, double tile, const std::function<double(double, double)>& height) {
  std::vector<Vector3> corners;
  std::vector<Triangle> triangles;
  for (int r = 0; r <= cells; ++r) {
    for (int c = 0; c <= cells; ++c) {
      const double x = (c - cells / 2.0) * tile, z = (r - cells / 2.0) * tile;
      corners.emplace_back(x, height(x, z), z);
    }
  }
  for (int r = 0; r < cells; ++r) {
    for (int c = 0; c < cells; ++c) {
      const int i = r * (cells + 1) + c, j = i + cells + 1;
      triangles.push_back({i, j, j + 1});
      triangles.push_back({i, j + 1, i + 1});
    }
  }
  return Shape::mesh(corners, triangles);
}

double flat(double, double) { return 0; }
double hilly(double x, double z) { return 0.4 * std::sin(1.3 * x) * std::cos(0.9 * z + 0.2); }

std::shared_ptr<Shape> field(int side, double tile, const std::function<double(double, double)>& height) {
  std::vector<double> heights;
  for (int r = 0; r < side; ++r) {
    for (int c = 0; c < side; ++c)
      heights.push_back(height((c - (side - 1) / 2.0) * tile, (r - (side - 1) / 2.0) * tile));
  }
  return Shape::height_field(side, side, tile, heights);
}

std::pmr::vector<Manifold> find(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb, double margin = 0.01) {
  std::pmr::vector<Manifold> out;
  find_manifolds(a, pa, b, pb, margin, out);
  return out;
}

std::string refusal(const std::function<void()>& build) {
  try {
    build();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Argument);
    return error.what();
  }
  return "accepted";
}

// --- hulls
// ------------------------------------------------------------------------------------------------------------

TEST(Hull, OfACubesCornersAndInnerPointsIsTheCube) {
  oracle::Dice dice(31);
  std::vector<Vector3> points;
  for (int i = 0; i < 8; ++i) points.emplace_back(i & 1 ? 1 : -1, i & 2 ? 2 : -2, i & 4 ? 3 : -3);
  for (int i = 0; i < 200; ++i) points.push_back(dice.vector(0.99));
  for (int i = 0; i < 50; ++i) points.emplace_back(1, dice.between(-2, 2), dice.between(-3, 3));  // on a face
  const auto hull = Shape::hull(points, 2);
  EXPECT_EQ(hull->vertices().size(), 8U);
  EXPECT_EQ(hull->faces().size(), 6U);
  EXPECT_NEAR(hull->volume(), 48, 1e-10);
  EXPECT_NEAR(hull->mass(), 96, 1e-10);
}

TEST(Hull, HoldsAllPointsAndIsConvexForCloudsOfAllKinds) {
  oracle::Dice dice(32);
  for (int i = 0; i < 60; ++i) {
    std::vector<Vector3> points;
    const int count = 4 + 7 * i;
    for (int k = 0; k < count; ++k) {
      Vector3 p = dice.vector(1);
      if (i % 3 == 0) p.normalize();                                       // on a sphere
      if (i % 3 == 1) p = (p * 3).array().round().matrix();                // on a lattice: many in one plane
      if (i % 4 == 3) p = Vector3(1e-3 * p.x(), 1e3 * p.y(), p.z() + 50);  // a needle far off
      points.push_back(p);
    }
    Polyhedron hull;
    const std::string refused = refusal([&] { hull = make_hull(points); });
    if (refused != "accepted") {
      EXPECT_NE(refused.find("one plane"), std::string::npos) << refused;
      continue;
    }
    Eigen::AlignedBox3d box;
    for (const Vector3& p : points) box.extend(p);
    const double slack = 1.01e-8 * box.sizes().maxCoeff();
    for (const Plane& plane : hull.planes) {
      for (const Vector3& p : points) ASSERT_LE(plane.normal.dot(p) - plane.offset, slack) << "cloud " << i;
    }
    // Euler's formula, and a volume from outside in.
    ASSERT_EQ(hull.vertices.size() + hull.faces.size(), hull.edges.size() + 2);
    ASSERT_GT(moments(hull).volume, 0);
  }
}

TEST(Hull, RefusesWhatIsNoSolid) {
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY();
  EXPECT_NE(refusal([&] { make_hull(std::vector<Vector3>{x, y, x + y}); }).find("from 4 to"), std::string::npos);
  EXPECT_NE(refusal([&] {
              make_hull(std::vector<Vector3>{x, y, x + y, 2 * x, 3 * y});
            }).find("one plane"),
            std::string::npos);
  EXPECT_NE(refusal([&] { make_hull(std::vector<Vector3>(9, x)); }).find("one plane"), std::string::npos);
  const Vector3 bad(0, std::nan(""), 0);
  EXPECT_NE(refusal([&] {
              make_hull(std::vector<Vector3>{x, y, x + y, bad});
            }).find("must be finite"),
            std::string::npos);
}

// --- meshes
// -----------------------------------------------------------------------------------------------------------

TEST(Mesh, AClosedOneHasTheMassPropertiesOfItsSolid) {
  oracle::Dice dice(33);
  for (int i = 0; i < 20; ++i) {
    const auto solid = dice.polyhedron(i);
    const auto mesh = mesh_of(*solid);
    EXPECT_TRUE(mesh->surface()->solid());
    EXPECT_NEAR(mesh->volume(), solid->volume(), kExact);
    EXPECT_LE((mesh->inertia() - solid->inertia()).norm(), kExact * (1 + solid->inertia().norm()));
    EXPECT_LE((mesh->center_of_mass() - solid->center_of_mass()).norm(), kExact);
    mesh->set_scale(Vector3(2, 3, 4));
    EXPECT_NEAR(mesh->volume(), solid->volume() * 24, 1e-10);
  }
}

TEST(Mesh, InsideOutItIsReversed) {
  const auto box = Shape::box(Vector3(1, 2, 3));
  std::vector<Triangle> triangles;
  for (const auto& face : box->faces()) {
    triangles.push_back({face[0], face[2], face[1]});
    triangles.push_back({face[0], face[3], face[2]});
  }
  const auto mesh = Shape::mesh(std::vector<Vector3>(box->vertices().begin(), box->vertices().end()), triangles);
  EXPECT_TRUE(mesh->surface()->solid());
  EXPECT_NEAR(mesh->volume(), 6, kExact);
  EXPECT_LT(closest(*Shape::sphere(0.1), {}, *mesh, {}).distance, 0);
}

TEST(Mesh, AnOpenOneHasTheMassOfItsHull) {
  const auto open = sheet(4, 1, [](double x, double z) { return std::abs(x) + std::abs(z); });
  EXPECT_FALSE(open->surface()->solid());
  std::vector<Vector3> points;
  for_each_vertex(*open, [&](const Vector3& p) { points.push_back(p); });
  EXPECT_EQ(points.size(), 25U);
  EXPECT_NEAR(open->volume(), Shape::hull(points, 1)->volume(), kExact);
  EXPECT_GT(sheet(2, 1, flat)->mass(), 0);  // as if a thousandth thick
}

TEST(Mesh, RefusesBadCornersAndIndices) {
  const std::vector<Vector3> corners{Vector3::Zero(), Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()};
  const auto build = [&](std::vector<Vector3> c, std::vector<Triangle> t) { return [=] { Shape::mesh(c, t); }; };
  EXPECT_NE(refusal(build(corners, {{0, 1, 4}})).find("triangle 0 with corner 4"), std::string::npos);
  EXPECT_NE(refusal(build(corners, {{0, 1, -1}})).find("corner -1"), std::string::npos);
  EXPECT_NE(refusal(build(corners, {})).find("no triangle with an area"), std::string::npos);
  EXPECT_NE(refusal(build(corners, {{0, 1, 1}})).find("no triangle with an area"), std::string::npos);
  auto bad = corners;
  bad[2].x() = INFINITY;
  EXPECT_NE(refusal(build(bad, {{0, 1, 2}})).find("must be finite"), std::string::npos);
}

TEST(Mesh, RaysMeetAConvexMeshWhereTheyMeetItsSolid) {
  oracle::Dice dice(34);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto solid = dice.polyhedron(i % 40);
    const auto mesh = mesh_of(*solid);
    const Vector3 origin = dice.vector(2), direction = dice.vector(1) - origin;
    double t = -1, u = -1;
    const bool hit = solid->raycast(origin, direction, t);
    ASSERT_EQ(mesh->raycast(origin, direction, u), hit) << "case " << i;
    if (!hit) continue;
    ++hits;
    ASSERT_NEAR(u, t, 1e-11) << "case " << i;
    ASSERT_LE((mesh->point_on(direction) - solid->point_on(direction)).norm(), 1e-11);
  }
  EXPECT_GT(hits, 500);
}

TEST(Mesh, ClosestPointsOfAConvexMeshAreThoseOfItsSolid) {
  oracle::Dice dice(35);
  int apart = 0, overlap = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto solid = dice.polyhedron(i);
    const auto mesh = mesh_of(*solid);
    const auto other = i % 3 == 0 ? Shape::sphere(dice.between(0.1, 1)) : dice.polyhedron(i / 4);
    const Pose pa{dice.vector(1), dice.rotation()}, pb{dice.vector(1.2), dice.rotation()};
    const Contact expected = closest(*other, pa, *solid, pb), found = closest(*other, pa, *mesh, pb);
    if (expected.distance > 0) {
      ++apart;
      ASSERT_NEAR(found.distance, expected.distance, 1e-11) << "case " << i;
      ASSERT_LE((found.normal - expected.normal).norm(), 1e-9 / std::min(1.0, expected.distance)) << "case " << i;
    } else {
      ++overlap;
      // Out through one triangle is at least as far as the shortest way out of the whole.
      ASSERT_LT(found.distance, 1e-12) << "case " << i;
    }
    const Contact mirrored = closest(*mesh, pb, *other, pa);
    ASSERT_NEAR(mirrored.distance, found.distance, 1e-11);
  }
  EXPECT_GT(apart, 500);
  EXPECT_GT(overlap, 500);
}

TEST(Mesh, ManifoldsOnASheetAreThoseOnAFloor) {
  const auto floor = sheet(20, 0.7, flat), box = Shape::box(Vector3(1, 1, 1)), ball = Shape::sphere(0.5);
  oracle::Dice dice(36);
  for (int i = 0; i < 500; ++i) {
    const double x = dice.between(-4, 4), z = dice.between(-4, 4);
    const auto m = find(*box, {Vector3(x, 0.499, z), rotated(dice.between(0, 3), Vector3::UnitY())}, *floor, {});
    ASSERT_EQ(m.size(), 1U) << "case " << i;
    ASSERT_EQ(m[0].count, 4);
    ASSERT_LE((m[0].normal - Vector3::UnitY()).norm(), kExact);
    double span = 0;
    for (const ContactPoint& p : m[0].points) {
      ASSERT_NEAR(p.distance, -0.001, kExact);
      for (const ContactPoint& q : m[0].points) span = std::max(span, (p.on_a - q.on_a).norm());
    }
    ASSERT_NEAR(span, std::sqrt(2.0), 2e-3);  // its corners, not where triangles end
    const auto round = find(*ball, {Vector3(x, 0.5005, z), kLevel}, *floor, {});
    ASSERT_EQ(round.size(), 1U);
    ASSERT_EQ(round[0].count, 1);
    ASSERT_LE((round[0].normal - Vector3::UnitY()).norm(), kExact);
    ASSERT_NEAR(round[0].points[0].distance, 0.0005, kExact);
  }
}

TEST(Mesh, ABoxThatSlidesOverSeamsNeverFeelsASidewaysNormal) {
  const auto floor = sheet(20, 0.7, flat), box = Shape::box(Vector3(1, 1, 1)), ball = Shape::sphere(0.5);
  oracle::Dice dice(37);
  for (int i = 0; i < 2000; ++i) {
    const Vector3 position(-4 + 0.004 * i, 0.5 - dice.between(0, 0.02), 0.003 * i - 3);
    for (const auto& m : find(*box, {position, rotated(1e-3, dice.direction())}, *floor, {}, 0.02)) {
      ASSERT_GT(m.normal.y(), 0.999) << "step " << i;
    }
    for (const auto& m : find(*ball, {position, kLevel}, *floor, {}, 0.02))
      ASSERT_GT(m.normal.y(), 0.999) << "step " << i;
  }
}

TEST(Mesh, ASheetHasTwoSidesAndASolidOne) {
  const auto floor = sheet(2, 2, flat), ball = Shape::sphere(0.5), wall = mesh_of(*Shape::box(Vector3(4, 1, 4)));
  EXPECT_GT(find(*ball, {Vector3(0.3, 0.4, 0), kLevel}, *floor, {})[0].normal.y(), 0.99);
  EXPECT_LT(find(*ball, {Vector3(0.3, -0.4, 0), kLevel}, *floor, {})[0].normal.y(), -0.99);
  // The centre is 0.2 inside: still out by the face.
  const auto m = find(*ball, {Vector3(0.3, 0.3, 0), kLevel}, *wall, {});
  ASSERT_FALSE(m.empty());
  EXPECT_GT(m[0].normal.y(), 0.99);
  EXPECT_NEAR(m[0].points[0].distance, -0.7, kExact);
  const auto small = find(*Shape::sphere(0.1), {Vector3(0.3, 0.3, 0), kLevel}, *wall, {});  // wholly inside
  ASSERT_EQ(small.size(), 1U);
  EXPECT_NEAR(small[0].points[0].distance, -0.3, kExact);
}

TEST(Mesh, ImageAndHashKeepEveryBit) {
  for (const auto& shape : {mesh_of(*Shape::cone(5, 2, 1)), sheet(5, 0.3, hilly), field(9, 0.5, hilly)}) {
    shape->set_scale(Vector3(1.1, 0.7, 2));
    shape->set_mass(3);
    ByteWriter out;
    shape->save(out);
    ByteReader in(out.bytes().data(), out.bytes().size());
    const auto again = Shape::load(in);
    Hasher before, after;
    shape->hash(before);
    again->hash(after);
    EXPECT_EQ(before.value(), after.value());
    const auto ball = Shape::sphere(0.2);
    const Pose at{Vector3(0.1, 0.9, 0.2), kLevel};
    EXPECT_EQ(closest(*ball, at, *shape, {}).distance, closest(*ball, at, *again, {}).distance);
    for (std::size_t cut = 0; cut < out.bytes().size(); cut += 37) {
      ByteReader damaged(out.bytes().data(), cut);
      EXPECT_THROW(Shape::load(damaged), Error);
    }
  }
}

TEST(Mesh, DamagedImagesAreRefusedOrHarmless) {
  oracle::Dice dice(38);
  for (const auto& shape : {mesh_of(*Shape::box(Vector3(1, 1, 1))), field(5, 0.5, hilly)}) {
    ByteWriter out;
    shape->save(out);
    for (int i = 0; i < 2000; ++i) {
      std::vector<std::uint8_t> bytes(out.bytes().begin(), out.bytes().end());
      bytes[static_cast<std::size_t>(dice.between(0, static_cast<double>(bytes.size()) - 1))] =
          static_cast<std::uint8_t>(dice.between(0, 255));
      ByteReader in(bytes.data(), bytes.size());
      try {
        const auto again = Shape::load(in);
        closest(*Shape::sphere(0.2), {Vector3(0.1, 0.9, 0.2), kLevel}, *again, {});
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::Image);
      }
    }
  }
}

// --- height fields
// ----------------------------------------------------------------------------------------------------

TEST(HeightField, HeightsAreAtTheGridAndInterpolatedOnTheTriangles) {
  const auto ground = field(5, 2, [](double x, double z) { return 0.5 * x - 0.25 * z; });
  const HeightGrid& grid = *ground->heights();
  EXPECT_EQ(grid.height(0, 0), -2 + 1);
  double height = 0;
  ASSERT_TRUE(grid.height_at(1.3, -0.4, height));
  EXPECT_NEAR(height, 0.75, kExact);
  EXPECT_FALSE(grid.height_at(4.1, 0, height));
  ground->set_height(2, 2, 10);
  ASSERT_TRUE(ground->heights()->height_at(0, 0, height));
  EXPECT_EQ(height, 10);
  EXPECT_EQ(ground->bounds(Matrix3::Identity()).max().y(), 10);
  ground->set_height(2, 2, 0);
  EXPECT_EQ(ground->bounds(Matrix3::Identity()).max().y(), 3);
}

TEST(HeightField, RefusesBadGrids) {
  const std::vector<double> four(4, 0.0), bad{0, 0, 0, std::nan("")};
  EXPECT_NE(refusal([&] { Shape::height_field(1, 4, 1, four); }).find("from 2 to"), std::string::npos);
  EXPECT_NE(refusal([&] { Shape::height_field(2, 3, 1, four); }).find("must be 6"), std::string::npos);
  EXPECT_NE(refusal([&] { Shape::height_field(2, 2, 0, four); }).find("tiles of size 0"), std::string::npos);
  EXPECT_NE(refusal([&] { Shape::height_field(2, 2, 1, bad); }).find("column 1, row 1"), std::string::npos);
  const auto ground = Shape::height_field(2, 2, 1, four);
  EXPECT_NE(refusal([&] { ground->set_height(2, 0, 1); }).find("no column 2"), std::string::npos);
  EXPECT_NE(refusal([&] { ground->set_height(0, 0, INFINITY); }).find("must be finite"), std::string::npos);
  EXPECT_NE(refusal([&] { Shape::sphere(1)->set_height(0, 0, 1); }).find("only a height field"), std::string::npos);
}

TEST(HeightField, AgreesWithTheSameSurfaceAsAMesh) {
  const auto ground = field(21, 0.7, hilly), mesh = sheet(20, 0.7, hilly);
  oracle::Dice dice(39);
  for (int i = 0; i < 400; ++i) {
    const auto solid = i % 3 == 0 ? Shape::sphere(dice.between(0.1, 0.6)) : dice.polyhedron(i);
    const Pose at{Vector3(dice.between(-5, 5), dice.between(0.8, 3), dice.between(-5, 5)), dice.rotation()};
    const Contact a = closest(*solid, at, *ground, {}), b = closest(*solid, at, *mesh, {});
    if (b.distance > 0) {
      ASSERT_NEAR(a.distance, b.distance, kExact) << "case " << i;
    }
    const Vector3 origin(dice.between(-8, 8), dice.between(0, 4), dice.between(-8, 8));
    const Vector3 direction = dice.vector(6) - origin;
    double t = -1, u = -1;
    if (origin.y() < 0.5) continue;
    const bool hit = mesh->raycast(origin, direction, t);
    ASSERT_EQ(ground->raycast(origin, direction, u), hit) << "case " << i;
    if (hit) {
      ASSERT_NEAR(t, u, kExact) << "case " << i;
    }
  }
}

TEST(HeightField, WhatIsBelowIsPushedUp) {
  const auto ground = field(9, 1, flat), ball = Shape::sphere(0.25);
  const auto m = find(*ball, {Vector3(0.4, -2, 0.1), kLevel}, *ground, {});
  ASSERT_EQ(m.size(), 1U);
  EXPECT_LE((m[0].normal - Vector3::UnitY()).norm(), kExact);
  EXPECT_NEAR(m[0].points[0].distance, -2.25, kExact);
  EXPECT_NEAR(closest(*ball, {Vector3(0.4, -2, 0.1), kLevel}, *ground, {}).distance, -2.25, kExact);
}

TEST(HeightField, TwoOfThemNeverTouch) {
  const auto ground = field(9, 1, flat);
  EXPECT_TRUE(find(*ground, {}, *ground, {}).empty());
  EXPECT_EQ(closest(*ground, {}, *ground, {}).distance, std::numeric_limits<double>::infinity());
  double t = 0;
  Contact contact;
  EXPECT_FALSE(time_of_impact(*ground, {{Vector3(0, 1, 0), kLevel}, Vector3(0, -2, 0), Vector3::Zero()}, *ground, {}, 1,
                              t, contact));
}

// --- moving
// -----------------------------------------------------------------------------------------------------------

TEST(SurfaceImpact, ABallFallsOnASheetInClosedForm) {
  const auto ball = Shape::sphere(0.25);
  double t = 0;
  Contact contact;
  for (const auto& ground : {field(9, 1, flat), sheet(8, 1, flat)}) {
    ASSERT_TRUE(time_of_impact(*ball, {{Vector3(0.3, 1.25, -0.2), kLevel}, Vector3(0.5, -3, 0), Vector3::Zero()},
                               *ground, {}, 1, t, contact));
    EXPECT_NEAR(t, 1.0 / 3, 1e-10);
    EXPECT_LE((contact.normal - Vector3::UnitY()).norm(), 1e-9);
    ASSERT_TRUE(time_of_impact(*Shape::sphere(0.01),
                               {{Vector3(0.3, 5, -0.2), kLevel}, Vector3(0, -1000, 0), Vector3::Zero()}, *ground, {},
                               1.0 / 60, t, contact));
    EXPECT_NEAR(t, 4.99e-3, 1e-11);
  }
}

TEST(SurfaceImpact, NeverStepsOverATouch) {
  const auto ground = field(21, 0.7, hilly), mesh = sheet(20, 0.7, hilly), solid_mesh = mesh_of(*Shape::cone(7, 2, 1));
  oracle::Dice dice(40);
  int hits = 0, misses = 0;
  for (int i = 0; i < 80; ++i) {
    const auto& surface = i % 3 == 0 ? ground : i % 3 == 1 ? mesh : solid_mesh;
    const auto solid = i % 5 == 0   ? Shape::sphere(dice.between(0.1, 0.5))
                       : i % 5 == 1 ? mesh_of(*dice.polyhedron(i))
                                    : dice.polyhedron(i);
    const Motion a{{Vector3(dice.between(-3, 3), dice.between(1, 4), dice.between(-3, 3)), dice.rotation()},
                   Vector3(dice.between(-2, 2), dice.between(-6, 1), dice.between(-2, 2)),
                   dice.vector(6)};
    const Motion b{{dice.vector(0.2), rotated(0.2, dice.direction())},
                   dice.vector(0.3),
                   i % 2 == 0 ? Vector3(Vector3::Zero()) : dice.vector(1)};
    if (closest(*solid, a.start, *surface, b.start).distance <= 1e-9) continue;
    const double h = 0.5;
    double t = h;
    Contact contact;
    const bool hit = time_of_impact(*solid, a, *surface, b, h, t, contact);
    (hit ? hits : misses)++;
    const double end = hit ? t : h;
    for (int k = 0; k < 50; ++k) {
      const double s = end * k / 50 * (1 - 1e-9);
      ASSERT_GT(closest(*solid, pose_at(a, s), *surface, pose_at(b, s)).distance, 0) << "case " << i << " at " << s;
    }
    if (hit) {
      ASSERT_NEAR(contact.distance, 0, 1e-9) << "case " << i;
    }
  }
  EXPECT_GT(hits, 15);
  EXPECT_GT(misses, 15);
}

TEST(SurfaceManifold, PointsAreOnBothSurfacesAndWithinTheMargin) {
  const auto ground = field(21, 0.7, hilly);
  oracle::Dice dice(41);
  int found = 0;
  for (int i = 0; i < 600; ++i) {
    const auto solid = i % 3 == 0 ? Shape::sphere(dice.between(0.1, 0.6)) : dice.polyhedron(i);
    Pose at{Vector3(dice.between(-4, 4), dice.between(1, 3), dice.between(-4, 4)), dice.rotation()};
    const Contact c = closest(*solid, at, *ground, {});
    at.location -= (c.distance + dice.between(-0.01, 0.02)) * c.normal;
    const Contact now = closest(*solid, at, *ground, {});
    const auto manifolds = find(*solid, at, *ground, {}, 0.02);
    ASSERT_EQ(manifolds.empty(), now.distance >= 0.02) << "case " << i << " " << now.distance;
    double deepest = 1e9;
    for (const Manifold& m : manifolds) {
      ++found;
      ASSERT_NEAR(m.normal.norm(), 1, kExact);
      for (int k = 0; k < m.count; ++k) {
        const ContactPoint& p = m.points[static_cast<std::size_t>(k)];
        ASSERT_LT(p.distance, 0.02 + 1e-3);
        ASSERT_NEAR((p.on_a - p.on_b).dot(m.normal), p.distance, 1e-9);
        deepest = std::min(deepest, p.distance);
        double height = 0;
        ASSERT_TRUE(ground->heights()->height_at(p.on_b.x(), p.on_b.z(), height));
        ASSERT_NEAR(p.on_b.y(), height, 0.03) << "case " << i;
      }
    }
    // At a seam the way out is the face's, which may be a little longer than the shortest.
    if (!manifolds.empty() && now.distance > -0.03) {
      ASSERT_LE(deepest, now.distance + 4e-3) << "case " << i;
      ASSERT_GE(deepest, now.distance - 4e-3) << "case " << i;
    }
  }
  EXPECT_GT(found, 400);
}

// A closed mesh whose lowest corner is a little over the flat top of a large solid, or in it: that corner decides, and
// no side of the mesh, however it leans.
TEST(SurfaceGap, AMeshOnALargeSolidIsAsFarAsItsLowestCorner) {
  namespace solids = mesh_solids;
  const std::pair<const char*, std::shared_ptr<Shape>> floors[] = {{"box", Shape::box(Vector3(40, 1, 40))},
                                                                   {"cylinder", Shape::cylinder(1, 20)},
                                                                   {"prism", Shape::prism(12, 1, 20)}};
  const std::pair<const char*, solids::Mesh> meshes[] = {{"ell", solids::ell()},
                                                         {"torus", solids::torus(1, 0.3, 24, 12)},
                                                         {"cup", solids::cup(0.7, 1.4, 0.15, 16)},
                                                         {"bowl", solids::bowl(1, 0.2, 20, 5)}};
  oracle::Dice dice(5);
  for (const auto& [floor_name, floor] : floors) {
    for (const auto& [mesh_name, mesh] : meshes) {
      const std::shared_ptr<Shape> solid = mesh.centered().shape();
      for (int i = 0; i < 60; ++i) {
        const double gap = std::array{0.01, 1e-6, -1e-6, -1e-4}[static_cast<std::size_t>(i) % 4];
        Pose at{dice.vector(5), dice.rotation()};
        double low = std::numeric_limits<double>::infinity();
        for (const Vector3& p : mesh.centered().corners) low = std::min(low, (at.orientation * p).y());
        at.location.y() = gap - low;
        const Pose under{Vector3(0, -0.5, 0), kLevel};
        const std::string what = std::string(mesh_name) + " on " + floor_name + ", pose " + std::to_string(i);
        const Contact found = closest(*solid, at, *floor, under);
        ASSERT_NEAR(found.distance, gap, 1e-9) << what;
        ASSERT_NEAR(found.normal.y(), 1, 1e-6) << what;
        std::pmr::vector<Manifold> manifolds;
        find_manifolds(*solid, at, *floor, under, 0.02, manifolds);
        ASSERT_FALSE(manifolds.empty()) << what;
        for (const Manifold& one : manifolds) {
          EXPECT_GT(one.normal.y(), 0.9) << what;
          for (int k = 0; k < one.count; ++k)
            EXPECT_GT(one.points[static_cast<std::size_t>(k)].distance, gap - 0.002) << what;
        }
      }
    }
  }
}

}  // namespace
}  // namespace breve::surface_tests
