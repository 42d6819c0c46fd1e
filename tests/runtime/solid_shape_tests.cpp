// Mass properties, scaling, rays and refusals of shapes against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <tuple>

#include "runtime/base/error.hpp"
#include "runtime/solid/polyhedron.hpp"
#include "runtime/solid/shape.hpp"
#include "tests/runtime/solid_oracle.hpp"

namespace breve::shape_tests {
namespace {

using std::numbers::pi;
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// Sums of a few dozen rounded terms.
constexpr double kExact = 1e-14;

using Faces = std::vector<std::vector<Vector3>>;

void expect_inertia(const Shape& shape, const Matrix3& expected, double tolerance = kExact) {
  EXPECT_LE((shape.inertia() - expected).cwiseAbs().maxCoeff(), tolerance * expected.cwiseAbs().maxCoeff())
      << shape.inertia() << "\nagainst\n"
      << expected;
}

Matrix3 diagonal(double x, double y, double z) { return Vector3(x, y, z).asDiagonal(); }

/// Runs `act` and returns the message of the Error{Argument} that it must throw.
std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Argument);
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

#define EXPECT_REFUSED(statement, text) \
  EXPECT_NE(refusal([&] { statement; }).find(text), std::string::npos) << refusal([&] { statement; })

Faces tetrahedron() {
  // Corners of a regular tetrahedron in a cube of edge 2; the sense of the faces is mixed on purpose.
  const Vector3 a(1, 1, 1), b(1, -1, -1), c(-1, 1, -1), d(-1, -1, 1);
  return {{a, b, c}, {a, b, d}, {a, d, c}, {b, c, d}};
}

Faces cube_of_triangles(double half) {
  Faces faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto at = [&](double u, double v) {
        Vector3 p;
        p[axis] = side * half;
        p[(axis + 1) % 3] = u * half;
        p[(axis + 2) % 3] = v * half;
        return p;
      };
      faces.push_back({at(-1, -1), at(1, -1), at(1, 1)});
      faces.push_back({at(-1, -1), at(1, 1), at(-1, 1)});
    }
  }
  return faces;
}

TEST(Shape, SphereHasTheMassAndInertiaOfABall) {
  const auto ball = Shape::sphere(2);
  EXPECT_NEAR(ball->mass(), 4.0 / 3 * pi * 8, kExact * 40);
  const double i = 0.4 * ball->mass() * 4;
  expect_inertia(*ball, diagonal(i, i, i));
  EXPECT_EQ(ball->bounding_radius(), 2);
  EXPECT_EQ(ball->center_of_mass(), Vector3::Zero());
}

TEST(Shape, BoxHasTheMassAndInertiaOfABox) {
  const auto box = Shape::box(Vector3(1, 2, 3));
  EXPECT_NEAR(box->mass(), 6, kExact * 6);
  expect_inertia(*box, diagonal(6 * 13 / 12.0, 6 * 10 / 12.0, 6 * 5 / 12.0));
  EXPECT_EQ(box->size(), Vector3(1, 2, 3));
  EXPECT_NEAR(box->bounding_radius(), std::sqrt(14) / 2, kExact);
  EXPECT_EQ(box->vertices().size(), 8U);
  EXPECT_EQ(box->polyhedron().edges.size(), 12U);
  EXPECT_LE(box->center_of_mass().norm(), kExact);
}

TEST(Shape, AThinRodKeepsItsSmallMoment) {
  const auto rod = Shape::box(Vector3(1, 1e-9, 1e-9));
  EXPECT_NEAR(rod->inertia()(0, 0) / (rod->mass() * 2e-18 / 12), 1, 1e-9);
}

TEST(Shape, PrismHasTheInertiaOfARegularPolygon) {
  for (const int n : {3, 4, 7, 100}) {
    const double r = 1.5, h = 0.8, step = 2 * pi / n;
    const auto prism = Shape::prism(n, h, r);
    const double area = n * r * r * std::sin(step) / 2;
    EXPECT_NEAR(prism->volume(), area * h, kExact * 10);
    // Second moment of a regular polygon about any axis in its plane through its centre.
    const double m = area * h, plane = r * r / 12 * (2 + std::cos(step));
    expect_inertia(*prism, diagonal(m * (plane + h * h / 12), 2 * m * plane, m * (plane + h * h / 12)), 1e-13);
  }
}

TEST(Shape, APrismOfManySidesTendsToACylinder) {
  const double r = 0.5, h = 2;
  for (const int n : {10, 100, 1000}) {
    const auto prism = Shape::prism(n, h, r);
    const double m = pi * r * r * h,
                 relative = 7.0 * 4 / (n * static_cast<double>(n));  // (2 pi / n)^2 / 6 and similar terms
    EXPECT_NEAR(prism->mass() / m, 1, relative);
    expect_inertia(*prism, diagonal(m * (3 * r * r + h * h) / 12, m * r * r / 2, m * (3 * r * r + h * h) / 12),
                   relative);
  }
}

TEST(Shape, PrismStandsOnTheYAxisHalfAStepPastX) {
  const auto prism = Shape::prism(4, 2, 1);
  EXPECT_LE((prism->vertices()[0].cwiseAbs() - Vector3(std::sqrt(0.5), 1, std::sqrt(0.5))).norm(), kExact);
}

TEST(Shape, AConeOfManySidesTendsToACone) {
  const double r = 0.7, h = 2;
  const auto cone = Shape::cone(1000, h, r);
  const double m = pi * r * r * h / 3;
  EXPECT_NEAR(cone->mass() / m, 1, 1e-5);
  EXPECT_LE((cone->center_of_mass() - Vector3(0, -h / 4, 0)).norm(), kExact);
  // About the centre of mass 3/80 m (4 r^2 + h^2); the middle of the height is h/4 above it.
  const double across = 3.0 / 80 * m * (4 * r * r + h * h) + m * h * h / 16;
  expect_inertia(*cone, diagonal(across, 0.3 * m * r * r, across), 2e-5);
}

TEST(Shape, ConeHasItsApexAtHalfItsHeightAndItsFirstBaseVertexOnX) {
  const auto cone = Shape::cone(5, 3, 2);
  EXPECT_EQ(cone->vertices().front(), Vector3(2, -1.5, 0));
  EXPECT_EQ(cone->vertices().back(), Vector3(0, 1.5, 0));
}

TEST(Shape, TetrahedronFromFacesInAnySense) {
  const auto shape = Shape::convex(tetrahedron(), 3);
  EXPECT_NEAR(shape->volume(), 8.0 / 3, kExact * 3);
  EXPECT_NEAR(shape->mass(), 8, kExact * 8);
  // Regular tetrahedron of edge s: m s^2 / 20 about any axis; s^2 = 8.
  expect_inertia(*shape, diagonal(8 * 8 / 20.0, 8 * 8 / 20.0, 8 * 8 / 20.0));
  for (const Plane& plane : shape->polyhedron().planes) EXPECT_NEAR(plane.offset, 1 / std::sqrt(3), kExact);
}

TEST(Shape, TriangulatedCubeIsTheBox) {
  const auto shape = Shape::convex(cube_of_triangles(1), 1);
  EXPECT_EQ(shape->vertices().size(), 8U);
  EXPECT_EQ(shape->kind(), ShapeKind::Convex);
  expect_inertia(*shape, Shape::box(Vector3(2, 2, 2))->inertia());
}

TEST(Shape, EveryFaceLooksOutward) {
  oracle::Dice dice(21);
  for (int i = 0; i < 40; ++i) {
    const auto shape = dice.polyhedron(i);
    const Polyhedron& solid = shape->polyhedron();
    for (const Plane& plane : solid.planes) {
      EXPECT_GT(plane.offset, 0);
      for (const Vector3& v : solid.vertices) EXPECT_LE(plane.normal.dot(v), plane.offset + kExact);
    }
    // Euler: V - E + F = 2.
    EXPECT_EQ(solid.vertices.size() + solid.faces.size(), solid.edges.size() + 2);
  }
}

TEST(Shape, TheEdgesOfABoxAreThoseThatItsFacesShare) {
  const Polyhedron box = make_box({1, 2, 3});
  Polyhedron connected = box;
  connect(connected);
  ASSERT_EQ(box.edges.size(), connected.edges.size());
  for (std::size_t i = 0; i < box.edges.size(); ++i) {
    const Edge &given = box.edges[i], &found = connected.edges[i];
    EXPECT_EQ(std::tie(given.a, given.b, given.left, given.right), std::tie(found.a, found.b, found.left, found.right));
  }
}

TEST(Shape, ScaleOfABoxIsTheScaledBox) {
  const auto box = Shape::box(Vector3(1, 2, 3));
  box->set_density(2);
  box->set_scale(Vector3(3, 0.5, 2));
  const auto expected = Shape::box(Vector3(3, 1, 6));
  expected->set_density(2);
  EXPECT_EQ(box->size(), expected->size());
  EXPECT_NEAR(box->mass(), expected->mass(), 1e-12);
  EXPECT_EQ(box->density(), 2);
  expect_inertia(*box, expected->inertia(), 1e-13);
  EXPECT_EQ(box->scale(), Vector3(3, 0.5, 2));
  EXPECT_EQ(box->last_scale(), Vector3::Ones());
  // Absolute factors: back to 1 is the original again.
  box->set_scale(Vector3::Ones());
  EXPECT_EQ(box->size(), Vector3(1, 2, 3));
  EXPECT_EQ(box->last_scale(), Vector3(3, 0.5, 2));
}

TEST(Shape, ScaleOfATetrahedronIsTheTetrahedronOfScaledCorners) {
  const Vector3 f(2, 0.3, 1.7);
  Faces faces = tetrahedron();
  for (auto& face : faces) {
    for (Vector3& p : face) p = p.cwiseProduct(f);
  }
  const auto shape = Shape::convex(tetrahedron(), 1.5), expected = Shape::convex(faces, 1.5);
  shape->set_scale(f);
  EXPECT_NEAR(shape->mass(), expected->mass(), 1e-13);
  expect_inertia(*shape, expected->inertia(), 1e-13);
  for (std::size_t i = 0; i < shape->polyhedron().planes.size(); ++i) {
    EXPECT_NEAR(shape->polyhedron().planes[i].offset, expected->polyhedron().planes[i].offset, 1e-13);
  }
}

TEST(Shape, ScaleOfASphereUsesXOnly) {
  const auto ball = Shape::sphere(2);
  ball->set_scale(Vector3(0.5, 7, 9));
  EXPECT_EQ(ball->radius(), 1);
  EXPECT_NEAR(ball->mass(), 4.0 / 3 * pi, 1e-14);
  expect_inertia(*ball, 0.4 * ball->mass() * Matrix3::Identity());
}

TEST(Shape, MassAndDensityCarryTheInertia) {
  const auto box = Shape::box(Vector3(1, 1, 1));
  box->set_mass(12);
  EXPECT_NEAR(box->density(), 12, kExact * 12);
  expect_inertia(*box, diagonal(2, 2, 2));
  box->set_density(6);
  EXPECT_NEAR(box->mass(), 6, kExact * 6);
  expect_inertia(*box, diagonal(1, 1, 1));
}

TEST(Shape, AGivenInertiaStaysAndScales) {
  const auto box = Shape::box(Vector3(1, 1, 1));
  Matrix3 given;
  given << 3, 0.5, 0, 0.5, 4, 0.2, 0, 0.2, 5;
  box->set_inertia(given);
  EXPECT_EQ(box->inertia(), given);
  box->set_mass(2);
  expect_inertia(*box, 2 * given);
  box->set_scale(Vector3(2, 2, 2));  // mass times 8, lengths squared times 4
  expect_inertia(*box, 64 * given, 1e-13);
}

TEST(Shape, BoundsHoldEveryVertexTightly) {
  oracle::Dice dice(22);
  for (int i = 0; i < 20; ++i) {
    const auto shape = dice.polyhedron(i);
    const Matrix3 r = dice.rotation().toRotationMatrix();
    const auto box = shape->bounds(r);
    Vector3 high = Vector3::Constant(-kInf);
    for (const Vector3& v : shape->vertices()) high = high.cwiseMax(r * v);
    EXPECT_LE((box.max() - high).norm(), kExact);
  }
  const auto ball = Shape::sphere(2)->bounds(Matrix3::Identity());
  EXPECT_EQ(ball.max(), Vector3(2, 2, 2));
}

TEST(Shape, PointOnLiesOnTheSurfaceAlongTheDirection) {
  const auto box = Shape::box(Vector3(2, 4, 6));
  EXPECT_LE((box->point_on(Vector3(5, 0, 0)) - Vector3(1, 0, 0)).norm(), kExact);
  EXPECT_LE((box->point_on(Vector3(1, 1, 0)) - Vector3(1, 1, 0)).norm(), kExact);
  EXPECT_LE((Shape::sphere(3)->point_on(Vector3(0, 1e-200, 0)) - Vector3(0, 3, 0)).norm(), kExact);
  EXPECT_EQ(box->point_on(Vector3::Zero()), Vector3::Zero());
  oracle::Dice dice(23);
  for (int i = 0; i < 200; ++i) {
    const auto shape = dice.polyhedron(i);
    const Vector3 d = dice.vector(3), p = shape->point_on(d);
    double highest = -kInf;
    for (const Plane& plane : shape->polyhedron().planes)
      highest = std::max(highest, plane.normal.dot(p) - plane.offset);
    EXPECT_NEAR(highest, 0, kExact);
    EXPECT_LE(p.cross(d).norm(), kExact * 10);
    EXPECT_GT(p.dot(d), 0);
  }
}

TEST(Shape, RaysHitWhereTheSurfaceIs) {
  double t = -1;
  const auto ball = Shape::sphere(1), box = Shape::box(Vector3(2, 2, 2));
  ASSERT_TRUE(ball->raycast(Vector3(-3, 0, 0), Vector3(4, 0, 0), t));
  EXPECT_NEAR(t, 0.5, kExact);
  ASSERT_TRUE(box->raycast(Vector3(-3, 0.5, 0.5), Vector3(4, 0, 0), t));
  EXPECT_NEAR(t, 0.5, kExact);
  EXPECT_FALSE(ball->raycast(Vector3(-3, 0, 0), Vector3(-1, 0, 0), t));
  EXPECT_FALSE(ball->raycast(Vector3(-3, 1.001, 0), Vector3(1, 0, 0), t));
  EXPECT_FALSE(box->raycast(Vector3(-3, 1.001, 0), Vector3(1, 0, 0), t));
  EXPECT_FALSE(box->raycast(Vector3(-3, 0, 0), Vector3::Zero(), t));
  ASSERT_TRUE(box->raycast(Vector3(0.2, 0, 0), Vector3(1, 0, 0), t));
  EXPECT_EQ(t, 0);
  // From outside toward a random inner point: the hit is the first point that is not outside.
  oracle::Dice dice(24);
  for (int i = 0; i < 200; ++i) {
    const auto shape = dice.polyhedron(i);
    const Vector3 from = 5 * dice.direction();
    ASSERT_TRUE(shape->raycast(from, -from, t));
    EXPECT_LE((from * (1 - t) - shape->point_on(from)).norm(), 1e-13);
  }
}

TEST(Shape, SizesAreChecked) {
  EXPECT_REFUSED(Shape::sphere(0), "the radius of a sphere is 0 (must be finite and > 0)");
  EXPECT_REFUSED(Shape::sphere(-1), "-1");
  EXPECT_REFUSED(Shape::sphere(kNaN), "nan");
  EXPECT_REFUSED(Shape::sphere(1e200), "out of range");
  EXPECT_REFUSED(Shape::sphere(1e-120), "out of range");
  EXPECT_REFUSED(Shape::box(Vector3(1, -2, 1)), "a box's size along y is -2");
  EXPECT_REFUSED(Shape::box(Vector3(1, 1, kInf)), "a box's size along z is inf");
  EXPECT_REFUSED(Shape::prism(2, 1, 1), "a polygon disk has 2 sides (must be from 3 to 1000)");
  EXPECT_REFUSED(Shape::prism(1000000, 1, 1), "1000000 sides");
  EXPECT_REFUSED(Shape::prism(3, 0, 1), "the height of a polygon disk is 0");
  EXPECT_REFUSED(Shape::cone(3, 1, kNaN), "the radius of a polygon cone is nan");
  const auto box = Shape::box(Vector3(1, 1, 1));
  EXPECT_REFUSED(box->set_mass(0), "the mass of a shape is 0");
  EXPECT_REFUSED(box->set_density(-3), "the density of a shape is -3");
  EXPECT_REFUSED(box->set_density(1e-320), "out of range");
  EXPECT_REFUSED(box->set_scale(Vector3(1, 0, 1)), "the scale of a shape along y is 0");
  EXPECT_REFUSED(box->set_scale(Vector3(1e150, 1e150, 1e150)), "out of range");
  EXPECT_REFUSED(box->point_on(Vector3(kNaN, 0, 0)), "must be finite");
  EXPECT_EQ(box->mass(), 1);  // nothing changed
  EXPECT_EQ(box->size(), Vector3(1, 1, 1));
}

TEST(Shape, InertiaIsChecked) {
  const auto box = Shape::box(Vector3(1, 1, 1));
  Matrix3 skew = Matrix3::Identity();
  skew(0, 1) = 0.1;
  EXPECT_REFUSED(box->set_inertia(skew), "must be symmetric");
  EXPECT_REFUSED(box->set_inertia(diagonal(1, 1, -1)), "must be positive definite");
  EXPECT_REFUSED(box->set_inertia(Matrix3::Zero()), "must be positive definite");
  EXPECT_REFUSED(box->set_inertia(diagonal(1, kNaN, 1)), "must be finite");
  EXPECT_REFUSED(box->set_inertia(diagonal(1, 1, 3)), "the sum of the other two");
  expect_inertia(*box, diagonal(1 / 6.0, 1 / 6.0, 1 / 6.0));
}

TEST(Shape, FacesOfAConvexShapeAreChecked) {
  Faces open = tetrahedron();
  open.pop_back();
  EXPECT_REFUSED(Shape::convex(open, 1), "has 3 faces (must be at least 4)");
  Faces hole = cube_of_triangles(1);
  hole.pop_back();
  EXPECT_REFUSED(Shape::convex(hole, 1), "not closed");
  Faces doubled = cube_of_triangles(1);
  doubled.push_back(doubled[0]);
  EXPECT_REFUSED(Shape::convex(doubled, 1), "two faces share already");
  EXPECT_REFUSED(Shape::convex(tetrahedron(), 0), "the density of a shape is 0");
  Faces short_face = tetrahedron();
  short_face[1].pop_back();
  EXPECT_REFUSED(Shape::convex(short_face, 1), "a face 1 of 2 vertices");
  Faces infinite = tetrahedron();
  infinite[2][1].x() = kInf;
  EXPECT_REFUSED(Shape::convex(infinite, 1), "vertex 1 of face 2 at (inf");
  Faces flat = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}},
                {{0, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
  EXPECT_REFUSED(Shape::convex(flat, 1), "a convex shape");
  Faces moved = tetrahedron();
  for (auto& face : moved) {
    for (Vector3& p : face) p.x() += 3;
  }
  EXPECT_REFUSED(Shape::convex(moved, 1), "does not contain the origin");
  // A cube with one face pushed in to a point: closed, not convex.
  Faces dent;
  for (const auto& face : cube_of_triangles(1)) {
    if (!(face[0].y() == 1 && face[1].y() == 1 && face[2].y() == 1)) dent.push_back(face);
  }
  const Vector3 pit(0, 0.5, 0), c[] = {{1, 1, 1}, {1, 1, -1}, {-1, 1, -1}, {-1, 1, 1}};
  for (int i = 0; i < 4; ++i) dent.push_back({c[i], c[(i + 1) % 4], pit});
  EXPECT_REFUSED(Shape::convex(dent, 1), "is not convex");
  Faces warped = {{{1, -1, 1}, {1, -1, -1}, {-1, -1, -1}, {-1, -0.9, 1}},
                  {{1, -1, 1}, {1, -1, -1}, {0, 1, 0}},
                  {{1, -1, -1}, {-1, -1, -1}, {0, 1, 0}},
                  {{-1, -1, -1}, {-1, -0.9, 1}, {0, 1, 0}},
                  {{-1, -0.9, 1}, {1, -1, 1}, {0, 1, 0}}};
  EXPECT_REFUSED(Shape::convex(warped, 1), "not flat");
}

TEST(Shape, AnImageGivesTheSameShapeBackBitForBit) {
  oracle::Dice dice(25);
  for (int i = 0; i < 9; ++i) {
    const auto shape = i == 8 ? Shape::sphere(0.3) : dice.polyhedron(i);
    shape->set_scale(Vector3(1.1, 1.2, 0.7));
    shape->set_mass(2.5);
    if (i % 2 == 0) shape->set_inertia(shape->inertia() * 1.25);
    ByteWriter out;
    shape->save(out);
    const auto bytes = out.take();
    ByteReader in(bytes.data(), bytes.size());
    const auto back = Shape::load(in);
    EXPECT_EQ(in.left(), 0U);
    Hasher before, after;
    shape->hash(before);
    back->hash(after);
    EXPECT_EQ(before.value(), after.value());
    EXPECT_EQ(back->last_scale(), shape->last_scale());
    back->set_scale(Vector3::Ones());
    shape->set_scale(Vector3::Ones());
    EXPECT_EQ(back->inertia(), shape->inertia());
    EXPECT_EQ(back->kind(), shape->kind());
    // Every cut-off image is refused, and so is every image with a wrong byte, or it makes some shape: never a crash.
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      ByteReader cut(bytes.data(), size);
      EXPECT_THROW(Shape::load(cut), Error);
    }
    for (std::size_t k = 0; k < bytes.size(); ++k) {
      auto wrong = bytes;
      wrong[k] ^= 0x81;
      ByteReader damaged(wrong.data(), wrong.size());
      try {
        Shape::load(damaged);
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::Image);
      }
    }
  }
}

}  // namespace
}  // namespace breve::shape_tests
