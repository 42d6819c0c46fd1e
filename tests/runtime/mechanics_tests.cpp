// What Dynamics and Planar have in common: the same settings, tables, messages and numbers, in space and in a flat
// world.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "fake_behaviour.hpp"
#include "runtime/base/error.hpp"
#include "runtime/mechanics/mechanics.hpp"

namespace breve::testing {
namespace {

class MechanicsTest : public ::testing::TestWithParam<int> {
 protected:
  MechanicsTest() {
    if (GetParam() == 2) scene.world.flatten();
    scene.script.recording = false;
  }
  Mechanics& mechanics() { return scene.world.mechanics(); }
  BodyIndex cube(double x) {
    const ObjectId id = scene.body(1, {x, 0, 0}, BodyKind::Mobile, Shape::box({1, 1, 1}));
    scene.world.bodies().set_physics(scene.world.body(id), true);
    return scene.world.body(id);
  }
  JointIndex slider(BodyIndex parent, BodyIndex child) {
    JointDescription is;
    is.kind = JointKind::Prismatic;
    is.parent = parent;
    is.child = child;
    is.parent_point = {1, 0, 0};
    is.child_point = {-1, 0, 0};
    return mechanics().link(is, ObjectId{});
  }
  SpringIndex spring(BodyIndex a, BodyIndex b) {
    SpringDescription is;
    is.a = a;
    is.b = b;
    is.point_a = {0.5, 0, 0};
    is.length = 1;
    is.strength = 3;
    return mechanics().add_spring(is, ObjectId{});
  }

  Scene scene;
};

std::string refusal(const std::function<void()>& act, ErrorCode code = ErrorCode::Argument) {
  try {
    act();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    return error.what();
  }
  return "";
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST_P(MechanicsTest, BeginsWithTheDefaultsAndAsksForNothing) {
  const Mechanics& m = mechanics();
  EXPECT_EQ(m.dimension(), GetParam());
  EXPECT_EQ(m.gravity(), Vector3(0, -9.81, 0));
  EXPECT_EQ(m.accuracy().rung, Rung::Balanced);
  EXPECT_EQ(m.guard(), GuardMode::Rest);
  EXPECT_EQ(m.length_unit(), 1);
  EXPECT_EQ(m.workers(), 1);
  EXPECT_FALSE(m.sleeping());
  EXPECT_FALSE(m.over());
  EXPECT_TRUE(m.impacts().empty());
  EXPECT_TRUE(m.interventions().empty());
}

TEST_P(MechanicsTest, GivesBackTheSettingsThatItGot) {
  Mechanics& m = mechanics();
  m.set_gravity({1, -2, 0});
  m.set_accuracy(Rung::Precise);
  m.set_guard(GuardMode::Report);
  m.set_sleeping(true);
  m.set_softness(0.25, 1e-3);
  m.set_workers(3);
  m.set_length_unit(0.25);
  EXPECT_EQ(m.length_unit(), 0.25);
  EXPECT_EQ(m.gravity(), Vector3(1, -2, 0));
  EXPECT_EQ(m.accuracy().rung, Rung::Precise);
  EXPECT_EQ(m.guard(), GuardMode::Report);
  EXPECT_TRUE(m.sleeping());
  EXPECT_EQ(m.erp(), 0.25);
  EXPECT_EQ(m.cfm(), 1e-3);
  EXPECT_EQ(m.workers(), 3);
}

TEST_P(MechanicsTest, RefusesBadSettingsInTheSameWordsAndKeepsTheOld) {
  Mechanics& m = mechanics();
  EXPECT_EQ(refusal([&] { m.set_softness(1.5, 0); }), "erp must be from 0 to 1, but is 1.5");
  EXPECT_EQ(refusal([&] { m.set_softness(0.5, -1); }), "cfm must be finite and >= 0, but is -1");
  EXPECT_EQ(refusal([&] { m.set_workers(0); }), "the number of workers must be from 1 to 1024, but is 0");
  EXPECT_EQ(refusal([&] { m.set_gravity({kNaN, 0, 0}); }), "gravity must be finite");
  EXPECT_EQ(refusal([&] { m.set_length_unit(0); }), "the length unit must be from 1e-9 to 1e9, but is 0");
  EXPECT_NE(refusal([&] { m.set_length_unit(kNaN); }), "");
  EXPECT_EQ(m.length_unit(), 1);
  EXPECT_EQ(refusal([&] { m.set_self_collision_parameters(cube(0), 2, 0); }),
            "self collision erp must be from 0 to 1, but is 2");
  EXPECT_NE(refusal([&] { m.set_fast_contacts(-1); }), "");
  EXPECT_EQ(m.erp(), 0.1);
  EXPECT_EQ(m.workers(), 1);
  EXPECT_EQ(m.gravity(), Vector3(0, -9.81, 0));
}

TEST_P(MechanicsTest, AJointIsLinkedNearbyAndGoesWhereverItsChildIsMoved) {
  Mechanics& m = mechanics();
  JointDescription is;
  is.child = cube(0);
  is.normal = {0, 0, 1};
  is.child_point = {1, 0, 0};
  is.parent_point = {2e18, 0, 0};
  EXPECT_EQ(refusal([&] { m.link(is, ObjectId{}); }),
            "revolute joint: the parent's point is (2e+18, 0, 0), which is farther away than 1e+15 m");
  is.parent_point = {1, 0, 0};
  const JointIndex hinge = m.link(is, ObjectId{});
  scene.world.bodies().set_location(is.child, {0, 1e20, 0});
  scene.world.step();
  EXPECT_GT(m.joint(hinge).parent_point.y(), 1e19);
  const auto image = scene.world.save(1);
  Scene other;
  other.script.recording = false;
  other.world.load(image.data(), image.size(), 1);
  for (int i = 0; i < 10; ++i) {
    scene.world.step();
    other.world.step();
    ASSERT_EQ(other.world.hash(), scene.world.hash()) << "step " << i;
  }
}

// What of its rotation the joint cannot make is added to the relative rotation that was asked for; the angle is counted
// from that.
TEST_P(MechanicsTest, AChildThatKeepsItsRotationRestsThere) {
  const bool flat = GetParam() == 2;
  const Quaternion tilt(Eigen::AngleAxisd(flat ? 0 : 1, Vector3::UnitX()));
  const Quaternion about_z(Eigen::AngleAxisd(0.75, Vector3::UnitZ())),
      rotation(Eigen::AngleAxisd(0.25, Vector3::UnitZ()));
  mechanics().set_gravity(Vector3::Zero());
  for (const JointKind kind : {JointKind::Revolute, JointKind::Prismatic, JointKind::Fixed}) {
    const BodyIndex parent = cube(100 * static_cast<int>(kind)), child = cube(100 * static_cast<int>(kind) + 10);
    scene.world.bodies().set_orientation(child, about_z * tilt);
    JointDescription is;
    is.kind = kind;
    is.parent = parent;
    is.child = child;
    is.parent_point = {5, 0, 0};
    is.normal = kind == JointKind::Revolute ? Vector3::UnitZ() : Vector3::UnitX();
    is.relative_rotation = rotation;
    is.keep_rotation = true;
    const JointIndex joint = mechanics().link(is, ObjectId{});
    for (int i = 0; i < 10; ++i) scene.world.step();
    const double tolerance = flat ? 1e-6 : 1e-12;  // Box2D has single precision
    EXPECT_NEAR(scene.world.bodies().orientation(child).angularDistance(about_z * tilt), 0, 10 * tolerance);
    EXPECT_NEAR(mechanics().position(joint)[0], kind == JointKind::Revolute ? -0.5 : 0, tolerance);
    const Quaternion rest = mechanics().joint(joint).relative_rotation;
    EXPECT_NEAR(rest.angularDistance(kind == JointKind::Revolute ? rotation * tilt : about_z * tilt), 0, 1e-7);
    // Linked anew it changes nothing.
    mechanics().relink(joint, mechanics().joint(joint));
    EXPECT_EQ(mechanics().joint(joint).relative_rotation.coeffs(), rest.coeffs());
  }
}

TEST_P(MechanicsTest, AWorldWhoseNumbersOverflowCanBeRestored) {
  for (const GuardMode guard : {GuardMode::Off, GuardMode::Report, GuardMode::Refine, GuardMode::Rest}) {
    for (const double force : {1e35, 1e300}) {
      SCOPED_TRACE(fmt::format("{}, {:g}", name_of(guard), force));
      Scene one;
      one.script.recording = false;
      if (GetParam() == 2) one.world.flatten();
      Mechanics& m = one.world.mechanics();
      m.set_guard(guard);
      JointDescription is;
      is.child = one.world.body(one.body(1, {0, 0, 0}, BodyKind::Mobile, Shape::box({1, 1, 1})));
      is.normal = {0, 0, 1};
      is.child_point = {-1, 0, 0};
      one.world.bodies().set_physics(is.child, true);
      const JointIndex hinge = m.link(is, ObjectId{});
      JointDrive drive = m.drive(hinge);
      drive.low[0] = -0.1, drive.high[0] = 0.1, drive.limit_restitution = 0.5;
      m.set_drive(hinge, drive);
      one.world.bodies().set_force(is.child, {force, -force, 0});
      for (int i = 0; i < 5; ++i) {
        const auto image = one.world.save(1);
        Scene other;
        other.script.recording = false;
        ASSERT_NO_THROW(other.world.load(image.data(), image.size(), 1)) << "step " << i;
        EXPECT_EQ(refusal([&] { one.world.step(); }, ErrorCode::Numeric),
                  refusal([&] { other.world.step(); }, ErrorCode::Numeric));
        ASSERT_EQ(one.world.hash(), other.world.hash()) << "step " << i;
      }
    }
  }
}

TEST_P(MechanicsTest, NamesJointsAndSpringsThatAreNotThere) {
  Mechanics& m = mechanics();
  for (int made = 0; made < 2; ++made) {  // before and after there has been one
    EXPECT_FALSE(m.linked(0));
    EXPECT_FALSE(m.has_spring(0));
    EXPECT_EQ(refusal([&] { m.joint(0); }), "the joint is not linked");
    EXPECT_EQ(refusal([&] { m.drive(7); }), "the joint is not linked");
    EXPECT_EQ(refusal([&] { m.strength_hard_limit(kNoJoint); }), "the joint is not linked");
    EXPECT_EQ(refusal([&] { m.spring(0); }), "the spring is not connected");
    EXPECT_EQ(refusal([&] { m.spring_force(0); }), "the spring is not connected");
    EXPECT_EQ(refusal([&] { m.spring_length(kNoSpring); }), "the spring is not connected");
    const BodyIndex a = cube(0), b = cube(4);
    m.unlink(slider(a, b));
    m.remove_spring(spring(a, b));
  }
}

TEST_P(MechanicsTest, UsesFreePlacesOfItsTablesAgain) {
  const BodyIndex a = cube(0), b = cube(4), c = cube(8);
  const JointIndex first = slider(a, b), second = slider(b, c);
  mechanics().unlink(first);
  EXPECT_EQ(mechanics().joint_count(), 1U);
  EXPECT_EQ(slider(a, b), first);
  EXPECT_EQ(mechanics().joint_count(), 2U);
  const std::pmr::vector<JointIndex> all = mechanics().joints_of(a);  // in the order of creation
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0], second);
  EXPECT_EQ(all[1], first);
}

TEST_P(MechanicsTest, MeasuresSpringsAndLimitsMotors) {
  const BodyIndex a = cube(0), b = cube(4);
  const SpringIndex made = spring(a, b);
  EXPECT_DOUBLE_EQ(mechanics().spring_length(made), 3.5);
  EXPECT_EQ(mechanics().spring_force(made), 0);
  const JointIndex joint = slider(a, b);
  EXPECT_DOUBLE_EQ(mechanics().strength_hard_limit(joint), 500 * scene.world.bodies().mass(b));
  EXPECT_FALSE(mechanics().closes_loop(joint));
}

TEST_P(MechanicsTest, SettingsOfOneBodyHoldForItsAssembly) {
  const BodyIndex a = cube(0), b = cube(4), alone = cube(20);
  slider(a, b);
  const std::uint64_t rules = mechanics().rules();
  mechanics().set_accuracy(b, accuracy_of(Rung::Fast));
  mechanics().set_self_collisions(b, true);
  EXPECT_GT(mechanics().rules(), rules);
  EXPECT_EQ(mechanics().accuracy(a).rung, Rung::Fast);
  EXPECT_TRUE(mechanics().self_collisions(a));
  EXPECT_EQ(mechanics().accuracy(alone).rung, Rung::Balanced);
  EXPECT_FALSE(mechanics().self_collisions(alone));
  mechanics().clear_accuracy(b);
  EXPECT_EQ(mechanics().accuracy(a).rung, Rung::Balanced);
}

TEST_P(MechanicsTest, CountsJointsSpringsAndMotorsAlike) {
  const BodyIndex a = cube(0), b = cube(4);
  const JointIndex joint = slider(a, b);
  spring(a, b);
  JointDrive drive;
  drive.low[0] = -1;
  drive.strength_limit = 1;
  drive.stiffness = 2;
  mechanics().set_drive(joint, drive);
  const Mechanics::Census census = mechanics().census();
  EXPECT_EQ(census.bodies, 2U);
  EXPECT_EQ(census.joints, 1U);
  EXPECT_EQ(census.limits, 1U);
  EXPECT_EQ(census.motors, 1U);
  EXPECT_EQ(census.springs, 2U);  // the joint's, and the one between the bodies
}

INSTANTIATE_TEST_SUITE_P(InSpaceAndFlat, MechanicsTest, ::testing::Values(3, 2),
                         [](const auto& info) { return info.param == 3 ? "Space" : "Flat"; });

}  // namespace
}  // namespace breve::testing
