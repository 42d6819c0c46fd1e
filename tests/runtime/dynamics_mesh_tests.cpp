// Concave closed meshes that move: they fall, rest, rock, and hold one another.
#include <gtest/gtest.h>

#include "dynamics_scene.hpp"
#include "runtime/solid/pieces.hpp"
#include "tests/runtime/mesh_solids.hpp"

namespace breve::testing {
namespace {

using namespace mesh_solids;

enum class Floor { Box, Mesh, Field, Cylinder };

struct Ground : Physics {
  explicit Ground(Floor floor) {
    mechanics().set_accuracy(Rung::Balanced);
    body(2, Vector3(0, floor == Floor::Field ? 0.0 : -0.5, 0), BodyKind::Stationary, of(floor));
  }
  static std::shared_ptr<Shape> of(Floor floor) {
    if (floor == Floor::Box) return Shape::box(Vector3(40, 1, 40));
    if (floor == Floor::Cylinder) return Shape::cylinder(1, 20);
    if (floor == Floor::Mesh) return block(Vector3(40, 1, 40)).shape();
    return Shape::height_field(41, 41, 1, std::vector<double>(41 * 41, 0.0));
  }
  double energy() { return mechanics().energy().kinetic + mechanics().energy().potential; }
  /// Runs, and yields how much the energy rose over what it had been before, relative to the scale given.
  double rise(double seconds) {
    double most = 0, least = energy();
    for (int i = 0; i < static_cast<int>(seconds * 60); ++i) {
      world.step();
      most = std::max(most, energy() - least);
      least = std::min(least, energy());
    }
    return most;
  }
  double lowest(ObjectId id, const Shape& shape) {
    const Eigen::AlignedBox3d box = shape.bounds(world.bodies().orientation(index(id)).toRotationMatrix());
    return world.bodies().location(index(id)).y() + box.min().y();
  }
};

std::shared_ptr<Shape> split(const Mesh& mesh) {
  const auto shape = mesh.centered().shape();
  shape->split({64, 0.05}, [](std::uint64_t) {});
  return shape;
}

// The solver lets a resting body sink by some 1e-3 of its size before it pushes (as boxes do), and an impact may raise
// the energy by what that sinking is worth.
constexpr double kSink = 0.02, kEnergy = 0.01;

TEST(ConcaveBodies, FallAndComeToRestOnFloorsOfAllKindsWithoutGainingEnergy) {
  const std::pair<const char*, std::shared_ptr<Shape>> solids[] = {{"ell", split(ell())},
                                                                   {"torus", split(torus(1, 0.3, 24, 12))},
                                                                   {"cup", split(cup(0.7, 1.4, 0.15, 16))},
                                                                   {"bowl", split(bowl(1, 0.2, 20, 5))}};
  for (const auto& [name, shape] : solids) {
    for (const Floor floor : {Floor::Box, Floor::Mesh, Floor::Field, Floor::Cylinder}) {
      Ground s(floor);
      const Quaternion tilted(Eigen::AngleAxisd(0.7, Vector3(1, 0.2, 0.5).normalized()));
      const ObjectId id = s.rigid(shape, Vector3(0.3, 2.5, 0.2), tilted);
      const double scale = shape->mass() * 9.81 * 2.5;
      const double rise = s.rise(8);
      std::printf("  %-6s floor %d: energy rose by %.1e of the fall, lowest %.4f, speed %.1e\n", name,
                  static_cast<int>(floor), rise / scale, s.lowest(id, *shape), s.velocity(id).norm());
      EXPECT_LE(rise, kEnergy * scale) << name << " on floor " << static_cast<int>(floor);
      EXPECT_GT(s.lowest(id, *shape), -kSink) << name << " on floor " << static_cast<int>(floor);
      EXPECT_LT(s.lowest(id, *shape), 0.1) << name << " on floor " << static_cast<int>(floor);
    }
  }
}

TEST(ConcaveBodies, ACupHoldsABallAndAnLAndIsCarriedOff) {
  const auto cup_shape = split(cup(1, 2, 0.2, 24));
  Ground s(Floor::Box);
  const double middle = -cup_shape->bounds(Matrix3::Identity()).min().y();
  const ObjectId holder = s.rigid(cup_shape, Vector3(0, middle, 0));
  const ObjectId ball = s.rigid(Shape::sphere(0.3), Vector3(0.1, 2.5, 0));
  Mesh small = ell();
  for (Vector3& p : small.corners) p *= 0.15;
  const ObjectId guest = s.rigid(split(small), Vector3(-0.3, 3.2, 0.1));
  const double rise = s.rise(6);
  EXPECT_LE(rise, kEnergy * cup_shape->mass() * 9.81);
  for (const ObjectId id : {ball, guest}) {
    const Vector3 at = s.at(id) - s.at(holder);
    EXPECT_LT(std::hypot(at.x(), at.z()), 0.8);
    EXPECT_GT(at.y(), 0.2 - middle);
    EXPECT_LT(at.y(), 2.0 - middle);
  }
  // The cup is pulled along: what it holds goes with it.
  s.world.bodies().set_velocity(s.index(holder), Vector3(2, 0, 0));
  s.run(2);
  EXPECT_GT(s.at(holder).x(), 0.1);
  for (const ObjectId id : {ball, guest}) EXPECT_LT((s.at(id) - s.at(holder)).norm(), 1.6);
}

TEST(ConcaveBodies, ABowlRocksAndCalmsDown) {
  const auto shape = split(bowl(1, 0.2, 32, 8));
  Ground s(Floor::Box);
  const double low = -shape->bounds(Matrix3::Identity()).min().y();
  const ObjectId id = s.rigid(shape, Vector3(0, low + 0.05, 0), Quaternion(Eigen::AngleAxisd(0.5, Vector3::UnitZ())));
  int swings = 0;
  double before = 0;
  const double rise = [&] {
    double most = 0, least = s.energy();
    for (int i = 0; i < 600; ++i) {
      s.world.step();
      most = std::max(most, s.energy() - least);
      least = std::min(least, s.energy());
      const double tilt = (s.world.bodies().orientation(s.index(id)) * Vector3::UnitY()).x();
      if (tilt * before < 0) ++swings;
      if (tilt != 0) before = tilt;
    }
    return most;
  }();
  EXPECT_GE(swings, 3);
  EXPECT_LE(rise, kEnergy * shape->mass() * 9.81);
  EXPECT_LT(s.velocity(id).norm(), 0.5);
}

TEST(ConcaveBodies, ARingThrownOnAPegOfTrianglesHangsThere) {
  Ground s(Floor::Box);
  s.body(2, Vector3(0, 1.5, 0), BodyKind::Stationary, block(Vector3(0.5, 3, 0.5)).shape());
  const ObjectId ring =
      s.rigid(split(torus(1, 0.2, 24, 10)), Vector3(0.2, 4, 0.1), Quaternion(Eigen::AngleAxisd(0.2, Vector3::UnitX())));
  s.run(6);
  EXPECT_LT(s.at(ring).y(), 0.5);
  EXPECT_LT(std::hypot(s.at(ring).x(), s.at(ring).z()), 0.6);
  EXPECT_LT(s.velocity(ring).norm(), 0.2);
}

}  // namespace
}  // namespace breve::testing
