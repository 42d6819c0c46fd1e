// Bodies that sleep wake when what they rest on, hang on or are driven by changes: in space and in the plane.
#include <gtest/gtest.h>

#include "fake_behaviour.hpp"
#include "runtime/mechanics/mechanics.hpp"

namespace breve::testing {
namespace {

constexpr ClassId kMoves = 1, kStands = 2;

/// Everything lies in the plane z = 0, gravity along -y, so that space and the flat world mean the same.
struct Sleepers : Scene {
  explicit Sleepers(int dimension) {
    if (dimension == 2) world.flatten();
    world.set_integration_step(1.0 / 60);
    world.set_iteration_step(1.0 / 60);
    script.recording = false;
    physics().set_sleeping(true);
  }
  Mechanics& physics() { return world.mechanics(); }
  BodyIndex index(ObjectId id) { return world.body(id); }
  ObjectId stands(const Vector3& size, const Vector3& at) {
    return body(kStands, at, BodyKind::Stationary, Shape::box(size));
  }
  ObjectId moves(const Vector3& at) {
    const ObjectId id = body(kMoves, at, BodyKind::Mobile, Shape::box(Vector3(1, 1, 1)));
    world.bodies().set_physics(index(id), true);
    return id;
  }
  JointIndex hinge(ObjectId child, JointKind kind = JointKind::Revolute) {
    JointDescription is;
    is.kind = kind;
    is.child = index(child);
    is.parent_point = at(child) + Vector3(-2, 0, 0);
    is.child_point = Vector3(-2, 0, 0);
    is.normal = Vector3::UnitZ();
    return physics().link(is, child);
  }
  void run(double seconds) {
    for (long i = std::lround(60 * seconds); i > 0; --i) world.step();
  }
  void fall_asleep(ObjectId id) {
    run(3);
    ASSERT_TRUE(physics().asleep(index(id)));
  }
  void friction(ObjectId id, double mu) {
    Material& material = world.bodies().material(index(id));
    material.static_friction = material.dynamic_friction = mu;
    material.normal_restitution = 0;
  }
};

class Sleep : public ::testing::TestWithParam<int> {
 protected:
  Sleepers s{GetParam()};
  Mechanics& physics() { return s.physics(); }
};

/// What flat worlds do not hold.
class SleepInSpace : public Sleep {};

TEST_P(Sleep, EndsWhenAMotorGetsAnotherSpeed) {
  physics().set_gravity(Vector3::Zero());
  const ObjectId arm = s.moves(Vector3::Zero());
  const JointIndex joint = s.hinge(arm);
  JointDrive drive;
  drive.strength_limit = 100;
  physics().set_drive(joint, drive);
  s.fall_asleep(arm);
  physics().set_drive(joint, drive);  // setting the same value changes nothing
  EXPECT_TRUE(physics().asleep(s.index(arm)));
  drive.motor_speed[0] = 1;
  physics().set_drive(joint, drive);
  s.run(2);
  EXPECT_NEAR(physics().position(joint)[0], 2, 0.05);
}

TEST_P(Sleep, DoesNotStopASlowMotor) {
  physics().set_gravity(Vector3::Zero());
  const JointIndex joint = s.hinge(s.moves(Vector3::Zero()));
  JointDrive drive;
  drive.strength_limit = 100;
  drive.motor_speed[0] = 0.005;
  physics().set_drive(joint, drive);
  s.run(20);
  EXPECT_NEAR(physics().position(joint)[0], 0.1, 0.005);
}

TEST_P(Sleep, EndsWhenAMotorGetsTooWeak) {
  const ObjectId arm = s.moves(Vector3::Zero());
  const JointIndex joint = s.hinge(arm);
  JointDrive drive;
  drive.strength_limit = 100;
  physics().set_drive(joint, drive);
  s.fall_asleep(arm);
  drive.strength_limit = 1;
  physics().set_drive(joint, drive);
  s.run(1);
  EXPECT_LT(s.at(arm).y(), -0.5);
}

TEST_P(Sleep, EndsWhenALimitMoves) {
  const ObjectId arm = s.moves(Vector3::Zero());
  const JointIndex joint = s.hinge(arm);
  JointDrive drive;
  drive.low[0] = drive.high[0] = 0;
  physics().set_drive(joint, drive);
  s.fall_asleep(arm);
  drive.low[0] = -2, drive.high[0] = 2;
  physics().set_drive(joint, drive);
  s.run(1);
  EXPECT_LT(s.at(arm).y(), -0.5);
}

TEST_P(Sleep, EndsWhenAJointsSpringChanges) {
  physics().set_gravity(Vector3::Zero());
  const ObjectId arm = s.moves(Vector3::Zero());
  const JointIndex joint = s.hinge(arm);
  JointDrive drive;
  drive.stiffness = 50;
  drive.damping = 5;
  physics().set_drive(joint, drive);
  s.fall_asleep(arm);
  drive.rest[0] = 0.5;
  physics().set_drive(joint, drive);
  s.run(20);
  EXPECT_NEAR(physics().position(joint)[0], 0.5, 0.05);
}

TEST_P(Sleep, EndsWhenTheOnlyJointIsFreed) {
  const ObjectId link = s.moves(Vector3::Zero());
  const JointIndex joint = s.hinge(link, JointKind::Fixed);
  s.fall_asleep(link);
  physics().unlink(joint);
  s.run(1);
  EXPECT_NEAR(s.at(link).y(), -0.5 * 9.81, 0.1);
}

TEST_P(Sleep, EndsWhenTheParentOfAJointIsFreed) {
  s.stands(Vector3(20, 1, 1), Vector3(0, -2.5, 0));
  const ObjectId below = s.moves(Vector3(0, -1.5, 0)), above = s.moves(Vector3(0, 0.5, 0));
  JointDescription is;
  is.kind = JointKind::Fixed;
  is.parent = s.index(below), is.child = s.index(above);
  is.parent_point = Vector3(0, 1, 0), is.child_point = Vector3(0, -1, 0);
  physics().link(is, above);
  s.fall_asleep(above);
  s.world.release(below);
  s.run(2);
  EXPECT_NEAR(s.at(above).y(), -1.5, 0.01);
}

TEST_P(Sleep, EndsWhenAJointIsMade) {
  s.stands(Vector3(20, 1, 1), Vector3(0, -1, 0));
  const ObjectId box = s.moves(Vector3::Zero());
  s.fall_asleep(box);
  JointDrive drive;
  drive.strength_limit = 400;
  drive.motor_speed[0] = -1;
  physics().set_drive(s.hinge(box), drive);
  s.run(1);
  EXPECT_GT(s.at(box).y(), 0.5);
}

TEST_P(Sleep, EndsWhenGravityChanges) {
  s.stands(Vector3(20, 1, 1), Vector3(0, -1, 0));
  const ObjectId box = s.moves(Vector3::Zero());
  s.fall_asleep(box);
  physics().set_gravity(Vector3(0, 1, 0));
  s.run(1);
  EXPECT_NEAR(s.at(box).y(), 0.5, 0.05);
}

TEST_P(SleepInSpace, EndsWhenASpringIsMadeChangedOrCut) {
  const ObjectId beam = s.stands(Vector3(1, 1, 1), Vector3(0, 8, 0));
  s.stands(Vector3(20, 1, 1), Vector3(0, -1, 0));
  const ObjectId box = s.moves(Vector3::Zero());
  s.fall_asleep(box);
  SpringDescription is;
  is.a = s.index(beam), is.b = s.index(box);
  is.length = 4;
  is.strength = 100;
  is.damping = 30;
  const SpringIndex spring = physics().add_spring(is, box);
  s.run(20);
  const double hangs = 8 - 4 - 9.81 * s.world.bodies().mass(s.index(box)) / 100;
  EXPECT_NEAR(s.at(box).y(), hangs, 0.05);
  s.fall_asleep(box);
  is.length = 3;
  physics().set_spring(spring, is);
  s.run(20);
  EXPECT_NEAR(s.at(box).y(), hangs + 1, 0.05);
  s.fall_asleep(box);
  physics().remove_spring(spring);
  s.run(5);
  EXPECT_NEAR(s.at(box).y(), 0, 0.05);
}

TEST_P(Sleep, EndsWhenAMaterialChanges) {
  const ObjectId slope = s.stands(Vector3(40, 1, 1), Vector3::Zero());
  const Quaternion lean(Eigen::AngleAxisd(0.2, Vector3::UnitZ()));
  s.world.bodies().set_orientation(s.index(slope), lean);
  const ObjectId box = s.moves(lean * Vector3(0, 1, 0));
  s.world.bodies().set_orientation(s.index(box), lean);
  s.friction(slope, 1);
  s.friction(box, 1);
  s.fall_asleep(box);
  s.friction(slope, 0);
  s.run(1);
  EXPECT_NEAR((s.at(box) - lean * Vector3(0, 1, 0)).norm(), 0.5 * 9.81 * std::sin(0.2), 0.1);
}

TEST_P(Sleep, EndsWhenCollisionsAreIgnoredAndWhenTheyAreNot) {
  s.stands(Vector3(20, 1, 1), Vector3(0, -1, 0));
  const ObjectId box = s.moves(Vector3::Zero());
  s.fall_asleep(box);
  s.world.ignore_collisions(kMoves, kStands);
  s.run(1);
  EXPECT_LT(s.at(box).y(), -3);
}

TEST_P(Sleep, EndsWhenWhatHoldsABodyMoves) {
  const ObjectId floor = s.stands(Vector3(20, 1, 1), Vector3(0, -1, 0));
  const ObjectId box = s.moves(Vector3::Zero());
  s.fall_asleep(box);
  s.world.bodies().set_location(s.index(floor), Vector3(0, -2, 0));
  s.run(2);
  EXPECT_NEAR(s.at(box).y(), -1, 0.02);
}

TEST_P(Sleep, EndsWhenWhatHoldsABodyIsScaled) {
  const ObjectId floor = s.stands(Vector3(20, 1, 1), Vector3(0, -1, 0));
  const ObjectId box = s.moves(Vector3::Zero());
  s.fall_asleep(box);
  s.world.bodies().collision_shape(s.index(floor))->set_scale(Vector3(1, 0.5, 1));
  s.run(2);
  EXPECT_NEAR(s.at(box).y(), -0.25, 0.02);
}

TEST_P(Sleep, EndsWhenWhatHoldsABodyIsFreed) {
  const ObjectId floor = s.stands(Vector3(20, 1, 1), Vector3(0, -1, 0));
  const ObjectId low = s.moves(Vector3::Zero()), high = s.moves(Vector3(0, 1, 0));
  s.fall_asleep(high);
  s.world.release(low);
  s.run(2);
  EXPECT_NEAR(s.at(high).y(), 0, 0.02);
  s.fall_asleep(high);
  s.world.release(floor);
  s.run(1);
  EXPECT_NEAR(s.at(high).y(), -0.5 * 9.81, 0.1);
}

TEST_P(Sleep, EndsWhenABodyBelowIsTakenAway) {
  s.stands(Vector3(20, 1, 1), Vector3(0, -1, 0));
  const ObjectId low = s.moves(Vector3::Zero()), high = s.moves(Vector3(0, 1, 0));
  s.fall_asleep(high);
  s.world.bodies().set_location(s.index(low), Vector3(8, 0, 0));
  s.run(2);
  EXPECT_NEAR(s.at(high).y(), 0, 0.02);
}

TEST_P(Sleep, EndsWhenSomethingIsMovedAgainstABody) {
  s.stands(Vector3(20, 1, 1), Vector3(0, -1, 0));
  const ObjectId pusher = s.stands(Vector3(1, 1, 1), Vector3(5, 0.1, 0)), box = s.moves(Vector3::Zero());
  s.fall_asleep(box);
  s.world.bodies().set_location(s.index(pusher), Vector3(0.9, 0.1, 0));
  s.run(3);
  EXPECT_LT(s.at(box).x(), -0.08);
}

TEST_P(SleepInSpace, GoesOnAfterARestoreAsItWouldHave) {
  const ObjectId floor = s.stands(Vector3(20, 1, 1), Vector3(0, -1, 0));
  const ObjectId box = s.moves(Vector3::Zero());
  s.fall_asleep(box);
  s.world.bodies().set_location(s.index(floor), Vector3(0, -2, 0));
  const auto image = s.world.save(1);
  s.run(1);
  const double before = s.at(box).y();
  s.world.load(image.data(), image.size(), 1);
  s.run(1);
  EXPECT_EQ(s.at(box).y(), before);
  EXPECT_NEAR(before, -1, 0.02);
}

INSTANTIATE_TEST_SUITE_P(InSpace, SleepInSpace, ::testing::Values(3));
INSTANTIATE_TEST_SUITE_P(InSpaceAndInThePlane, Sleep, ::testing::Values(3, 2),
                         [](const ::testing::TestParamInfo<int>& info) { return info.param == 2 ? "flat" : "space"; });

}  // namespace
}  // namespace breve::testing
