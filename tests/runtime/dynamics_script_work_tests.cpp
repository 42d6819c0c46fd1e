// What scripts and hosts do to bodies is in the ledger as their work, by closed forms, and leaves no residual: in space
// and in the plane.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fake_behaviour.hpp"
#include "runtime/mechanics/mechanics.hpp"

namespace breve::testing {
namespace {

constexpr double kGravity = 9.81;

/// Everything lies in the plane z = 0, so that space and the flat world mean the same. No contacts.
struct Books : Scene {
  double first = 0;

  explicit Books(int dimension) {
    if (dimension == 2) world.flatten();
    world.set_integration_step(1.0 / 100);
    world.set_iteration_step(1.0 / 100);
    script.recording = false;
    physics().set_gravity(Vector3::Zero());
  }
  Mechanics& physics() { return world.mechanics(); }
  Bodies& bodies() { return world.bodies(); }
  BodyIndex index(ObjectId id) { return world.body(id); }
  static std::shared_ptr<Shape> weight(double kg) {
    std::shared_ptr<Shape> shape = Shape::box(Vector3(1, 1, 1));
    shape->set_mass(kg);
    return shape;
  }
  ObjectId rigid(double kg, const Vector3& at) {
    const ObjectId id = body(1, at, BodyKind::Mobile, weight(kg));
    bodies().set_physics(index(id), true);
    return id;
  }
  JointIndex join(JointKind kind, ObjectId parent, ObjectId child, const Vector3& on_child) {
    JointDescription is;
    is.kind = kind;
    is.parent = parent ? index(parent) : kNoBody;
    is.child = index(child);
    is.child_point = on_child;
    is.parent_point = at(child) + on_child - (parent ? at(parent) : Vector3(Vector3::Zero()));
    is.normal = kind == JointKind::Prismatic ? Vector3::UnitX() : Vector3::UnitZ();
    return physics().link(is, child);
  }
  void run(double seconds) {
    for (long i = std::lround(100 * seconds); i > 0; --i) world.step();
  }
  void start() {
    run(0.1);
    first = physics().energy().total();
  }
};

class ScriptWork : public ::testing::TestWithParam<int> {
 protected:
  Books s{GetParam()};
  double rounding() const { return GetParam() == 2 ? 2e-6 : 1e-9; }  // of the scale; Box2D has single precision
  Mechanics& physics() { return s.physics(); }
  double work() { return physics().energy().script_work; }
  /// The change since `start` is work so much, at once and after some steps.
  void expect(double joules, double scale) {
    for (const double seconds : {0.0, 0.01, 0.3}) {
      s.run(seconds);
      const Energy e = physics().energy();
      const double losses = e.contact_loss + e.friction_loss + e.drag_loss + e.limit_loss;
      EXPECT_NEAR(e.script_work, joules, rounding() * scale) << "after " << seconds << " s";
      EXPECT_NEAR(e.total() - s.first, e.script_work + e.motor_work - losses + e.residual, rounding() * scale);
      EXPECT_NEAR(e.residual, 0, rounding() * scale);
    }
  }
};

/// What flat worlds do not hold.
class ScriptWorkInSpace : public ScriptWork {};

TEST_P(ScriptWork, IsNoneOfWhatIsMadeBeforeTheFirstStep) {
  const ObjectId body = s.rigid(2, Vector3(0, 1, 0));
  s.set_velocity(body, Vector3(3, 4, 0));
  EXPECT_EQ(work(), 0);
  s.start();
  expect(0, 25);
}

TEST_P(ScriptWork, OfAVelocityIsTheChangeOfKineticEnergy) {
  const ObjectId body = s.rigid(2, Vector3::Zero());
  s.set_velocity(body, Vector3(1, 0, 0));
  s.start();
  s.set_velocity(body, Vector3(3, 4, 0));
  expect(25 - 1, 25);
  s.set_velocity(body, Vector3::Zero());
  expect(-1, 25);
}

TEST_P(ScriptWork, DoesNotDependOnHowOftenSomebodyAsks) {
  double seen[2];
  for (const bool asks : {false, true}) {
    Books one(GetParam());
    const ObjectId body = one.rigid(2, Vector3::Zero());
    one.start();
    one.set_velocity(body, Vector3(1.1, 0, 0));
    if (asks) one.physics().energy();
    one.set_velocity(body, Vector3(0.3, 0.7, 0));
    if (asks) one.physics().energy();
    one.run(0.1);
    seen[asks] = one.physics().energy().script_work;
  }
  if (GetParam() == 3) {
    EXPECT_EQ(seen[0], seen[1]);
  }
  EXPECT_NEAR(seen[0], 0.58, 1e-5);
}

TEST_P(ScriptWork, OfASpinIsTheChangeOfKineticEnergy) {
  const ObjectId body = s.rigid(6, Vector3::Zero());  // a cube of side 1: m / 6 about each axis
  s.start();
  s.bodies().set_rotational_velocity(s.index(body), Vector3(0, 0, 2));
  expect(2, 2);
}

TEST_P(ScriptWork, OfAMoveIsTheChangeOfHeight) {
  physics().set_gravity(Vector3(0, -kGravity, 0));
  const ObjectId body = s.rigid(2, Vector3::Zero());
  s.start();
  s.bodies().set_location(s.index(body), s.at(body) + Vector3(5, 10, 0));
  expect(2 * kGravity * 10, 2 * kGravity * 10);
}

TEST_P(ScriptWorkInSpace, OfARotationIsThatOfWhatHangsOnTheBody) {
  physics().set_gravity(Vector3(0, -kGravity, 0));
  const ObjectId body = s.rigid(1, Vector3::Zero()), weight = s.rigid(3, Vector3(2, 0, 0));
  s.join(JointKind::Fixed, body, weight, Vector3(-1, 0, 0));
  s.start();
  const double fallen = s.at(body).y();
  s.bodies().set_orientation(s.index(body), Quaternion(Eigen::AngleAxisd(std::numbers::pi / 2, Vector3::UnitZ())));
  physics().moved(s.index(body));
  EXPECT_NEAR(s.at(weight).y() - fallen, 2, 1e-5);
  // The body keeps its velocity, and so does what turns with it.
  expect(3 * kGravity * 2, 3 * kGravity * 2);
}

TEST_P(ScriptWork, OfAMassIsWhatMovesAndLiesHighWithIt) {
  physics().set_gravity(Vector3(0, -kGravity, 0));
  const ObjectId body = s.rigid(2, Vector3(0, 10, 0));
  s.start();
  const double height = s.at(body).y(), speed = s.velocity(body).norm();
  s.bodies().set_collision_shape(s.index(body), Books::weight(5));
  expect(3 * (kGravity * height + 0.5 * speed * speed), 5 * kGravity * 10);
}

TEST_P(ScriptWork, OfAJointsSpringIsWhatItHoldsMore) {
  const ObjectId body = s.rigid(1, Vector3(1, 0, 0));
  const JointIndex joint = s.join(JointKind::Prismatic, {}, body, Vector3::Zero());
  JointDrive drive = physics().drive(joint);
  drive.stiffness = 20;
  physics().set_drive(joint, drive);
  s.start();
  drive.rest[0] = 0.1;
  physics().set_drive(joint, drive);
  EXPECT_NEAR(work(), 0.5 * 20 * 0.01, 1e-6);
  drive.stiffness = 80;
  physics().set_drive(joint, drive);
  EXPECT_NEAR(work(), 0.5 * 80 * 0.01, 1e-6);
  s.world.step();
  // As the joint moves, the work of a change follows from where it stands.
  const double before = work(), stretch = physics().position(joint)[0] - 0.1;
  drive.stiffness = 0;
  physics().set_drive(joint, drive);
  EXPECT_NEAR(work() - before, -0.5 * 80 * stretch * stretch, 1e-6);
}

TEST_P(ScriptWork, OfASpringIsWhatItHoldsMore) {
  const ObjectId a = s.rigid(1, Vector3::Zero()), b = s.rigid(1, Vector3(3, 0, 0));
  s.start();
  SpringDescription is;
  is.a = s.index(a), is.b = s.index(b);
  is.length = 2.5;
  is.strength = 10;
  is.damping = 0;
  const SpringIndex spring = physics().add_spring(is, a);
  EXPECT_NEAR(work(), 0.5 * 10 * 0.25, 1e-6);
  is.length = 2;
  is.strength = 20;
  physics().set_spring(spring, is);
  EXPECT_NEAR(work(), 0.5 * 20, 1e-6);
  physics().remove_spring(spring);
  expect(0, 10);
}

TEST_P(ScriptWork, OfASpringThatIsSetWhileItPullsIsAllThatComesOfIt) {
  const ObjectId a = s.rigid(1, Vector3::Zero()), b = s.rigid(1, Vector3(3, 0, 0));
  SpringDescription is;
  is.a = s.index(a), is.b = s.index(b);
  is.point_a = Vector3(0.2, 0.3, 0), is.point_b = Vector3(-0.1, 0.2, 0);
  is.length = 2;
  is.strength = 10;
  is.damping = 0;
  const SpringIndex spring = physics().add_spring(is, a);
  s.start();
  const double residual = physics().energy().residual, held = work();
  const double stretch = physics().spring_length(spring) - is.length;
  is.strength = 20;
  physics().set_spring(spring, is);
  EXPECT_NEAR(work() - held, 0.5 * 10 * stretch * stretch, 1e-5);
  const auto image = s.world.save(1);
  s.run(0.01);
  EXPECT_NEAR(physics().energy().residual, residual, 0.01 * (work() - held));
  const std::uint64_t hash = s.world.hash();
  s.world.load(image.data(), image.size(), 1);
  s.run(0.01);
  EXPECT_EQ(s.world.hash(), hash);
}

TEST_P(ScriptWork, OfAFreedJointIsWhatItsSpringHeld) {
  const ObjectId body = s.rigid(1, Vector3(1, 0, 0));
  const JointIndex joint = s.join(JointKind::Revolute, {}, body, Vector3(-1, 0, 0));
  JointDrive drive = physics().drive(joint);
  drive.stiffness = 20;
  drive.rest[0] = 0;
  physics().set_drive(joint, drive);
  s.start();
  drive.rest[0] = 0.5;
  physics().set_drive(joint, drive);
  physics().unlink(joint);
  expect(0, 2.5);
}

TEST_P(ScriptWork, OfAStruckLinkIsWhatTheAssemblyGets) {
  const ObjectId a = s.rigid(1, Vector3::Zero()), b = s.rigid(2, Vector3(3, 0, 0));
  s.join(JointKind::Fixed, a, b, Vector3(-0.5, 0, 0));
  s.start();
  s.set_velocity(a, Vector3(2, 0, 0));
  expect(0.5 * 3 * 4, 6);
}

TEST_P(ScriptWork, OfGravityIsTheChangeOfHeightEnergy) {
  physics().set_gravity(Vector3(0, -kGravity, 0));
  const ObjectId body = s.rigid(2, Vector3(0, 10, 0));
  s.start();
  const double height = s.at(body).y();
  physics().set_gravity(Vector3(0, -2 * kGravity, 0));
  expect(2 * kGravity * height, 4 * kGravity * height);
}

TEST_P(ScriptWork, OfSpaceThatWrapsIsTheChangeOfHeight) {
  physics().set_gravity(Vector3(0, -kGravity, 0));
  s.world.set_space(1, Ending::Wrap, -2, 3);
  const ObjectId body = s.rigid(2, Vector3(0, -1.9, 0));
  s.start();
  s.run(0.1);
  EXPECT_GT(s.at(body).y(), 0);
  const Energy e = physics().energy();
  EXPECT_NEAR(e.script_work, 2 * kGravity * 5, rounding() * 2 * kGravity * 5);
  EXPECT_NEAR(e.residual, 0, rounding() * 100);
}

TEST_P(ScriptWork, OfWallsIsNone) {
  physics().set_gravity(Vector3(0, -kGravity, 0));
  s.world.set_space(1, Ending::Wall, -2, 2);
  const ObjectId body = s.rigid(2, Vector3(0, 1, 0));
  s.start();
  s.run(60);
  const Energy e = physics().energy();
  const double scale = 2 * kGravity * 3;
  EXPECT_NEAR(e.total() - s.first, 0, 1000 * rounding() * scale);
  EXPECT_NEAR(e.script_work, 0, 1000 * rounding() * scale);
  EXPECT_LE(s.at(body).y(), 1 + 1e-3);
}

TEST_P(ScriptWork, IsTheSameAfterARestore) {
  physics().set_gravity(Vector3(0, -kGravity, 0));
  const ObjectId body = s.rigid(2, Vector3::Zero());
  s.start();
  s.set_velocity(body, Vector3(1, 1, 0));
  const auto image = s.world.save(1);
  s.run(0.1);
  const double before = work();
  const std::uint64_t hash = s.world.hash();
  s.world.load(image.data(), image.size(), 1);
  s.run(0.1);
  EXPECT_EQ(work(), before);
  EXPECT_EQ(s.world.hash(), hash);
}

INSTANTIATE_TEST_SUITE_P(InSpace, ScriptWorkInSpace, ::testing::Values(3));
INSTANTIATE_TEST_SUITE_P(InSpaceAndInThePlane, ScriptWork, ::testing::Values(3, 2),
                         [](const ::testing::TestParamInfo<int>& info) { return info.param == 2 ? "flat" : "space"; });

/// In space a joint closes when it is linked; in the plane in the next step.
TEST(ScriptWorkOfJoints, ThatCloseOnMovingBodiesIsWhatStops) {
  Books s(3);
  const ObjectId a = s.rigid(1, Vector3::Zero()), b = s.rigid(1, Vector3(3, 0, 0));
  s.set_velocity(a, Vector3(2, 0, 0));
  s.start();
  s.join(JointKind::Fixed, a, b, Vector3(-0.5, 0, 0));
  s.run(0.1);
  const Energy e = s.physics().energy();
  EXPECT_NEAR(e.script_work, -1, 1e-9);  // both go on with 1 m/s
  EXPECT_NEAR(e.residual, 0, 1e-9);
}

/// A handler's changes in the middle of a step are also the script's work.
TEST(ScriptWorkOfHandlers, IsInTheBooks) {
  Books s(3);
  s.world.handle_collisions(1, 2, "hit", s.controller);
  s.body(2, Vector3(5, 0, 0), BodyKind::Stationary, Shape::box(Vector3(1, 9, 9)));
  const ObjectId body = s.rigid(2, Vector3::Zero());
  Material& material = s.bodies().material(s.index(body));
  material.normal_restitution = 1;
  material.static_friction = material.dynamic_friction = 0;
  s.set_velocity(body, Vector3(10, 0, 0));
  s.start();
  int hits = 0;
  s.script.on_collided = [&](ObjectId id, ObjectId, const Vector3&, const Vector3&) {
    if (++hits == 1) s.set_velocity(id, Vector3(-3, 0, 0));
    return true;
  };
  s.run(2);
  EXPECT_EQ(hits, 1);
  const Energy e = s.physics().energy();
  EXPECT_NEAR(s.velocity(body).x(), -3, 1e-9);
  EXPECT_NEAR(e.script_work, 9 - 100, 1e-7);
  EXPECT_NEAR(e.residual, 0, 1e-7);
}

}  // namespace
}  // namespace breve::testing
