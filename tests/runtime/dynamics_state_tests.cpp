// What scripts do between steps, snapshots and hashes of worlds with joints and contacts, handlers at impacts.
#include <gtest/gtest.h>

#include <numbers>

#include "dynamics_scene.hpp"

namespace breve::testing {
namespace {

constexpr double kRounding = 1e-12;

/// A pendulum of two links on the world, a pair of boxes that fall on a floor, a tie.
struct Mixed : Physics {
  std::vector<ObjectId> links, boxes;
  std::vector<JointIndex> joints;

  Mixed() {
    body(2, Vector3(0, -2.5, 0), BodyKind::Stationary, Shape::box(Vector3(100, 5, 100)));
    for (int i = 0; i < 3; ++i) {
      links.push_back(rigid(Shape::box(Vector3(0.1, 1, 0.1)), Vector3(0, 4, 0)));
      JointDescription is;
      is.kind = i == 1 ? JointKind::Ball : JointKind::Revolute;
      is.child = index(links.back());
      is.child_point = Vector3(0, 0.5, 0);
      is.parent_point = i == 0 ? Vector3(0, 4, 0) : Vector3(0, -0.5, 0);
      if (i > 0) is.parent = index(links[static_cast<std::size_t>(i - 1)]);
      is.normal = Vector3::UnitZ();
      joints.push_back(mechanics().link(is, links.back()));
    }
    mechanics().set_velocity(joints[0], Vector3(4, 0, 0));
    JointDrive drive = mechanics().drive(joints[2]);
    drive.motor_speed = Vector3(1, 0, 0);
    drive.strength_limit = 0.01;
    drive.damping = 0.001;
    mechanics().set_drive(joints[2], drive);
    for (int i = 0; i < 3; ++i)
      boxes.push_back(rigid(Shape::box(Vector3(1, 1, 1)), Vector3(3, 0.5 + 1.2 * i, 0.1 * i)));
    SpringDescription spring;
    spring.a = index(links[2]);
    spring.b = index(boxes[2]);
    spring.strength = 2;
    spring.length = 1;
    mechanics().add_spring(spring, links[2]);
  }
};

TEST(DynamicsState, GoingOnAndRestoringAreEqualBitForBit) {
  Mixed s;
  for (int i = 0; i < 40; ++i) {
    s.world.step();
    const auto image = s.world.save(1);
    Scene other;
    other.script.recording = false;
    other.world.load(image.data(), image.size(), 1);
    ASSERT_EQ(other.world.hash(), s.world.hash()) << "after step " << i;
    for (int k = 0; k < 3; ++k) {
      other.world.step();
    }
    Scene again;
    again.script.recording = false;
    again.world.load(image.data(), image.size(), 1);
    for (int k = 0; k < 3; ++k) again.world.step();
    ASSERT_EQ(other.world.hash(), again.world.hash());
  }
  const auto image = s.world.save(1);
  Scene other;
  other.script.recording = false;
  other.world.load(image.data(), image.size(), 1);
  for (int i = 0; i < 60; ++i) {
    s.world.step();
    other.world.step();
    ASSERT_EQ(other.world.hash(), s.world.hash()) << "step " << i << " after the image";
  }
}

TEST(DynamicsState, WhatAScriptSetSinceTheLastStepIsInTheImage) {
  Mixed s;
  s.run(0.2);
  s.world.bodies().set_velocity(s.index(s.links[1]), Vector3(1, 2, 0));
  s.mechanics().unlink(s.joints[2]);
  const auto image = s.world.save(1);
  Scene other;
  other.script.recording = false;
  other.world.load(image.data(), image.size(), 1);
  for (int i = 0; i < 20; ++i) {
    s.world.step();
    other.world.step();
    ASSERT_EQ(other.world.hash(), s.world.hash()) << i;
  }
}

TEST(DynamicsState, AMovedLinkTakesItsAssemblyAlong) {
  Physics s;
  const ObjectId a = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3::Zero());
  const ObjectId b = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(5, 5, 5));
  JointDescription is;
  is.parent = s.index(a);
  is.child = s.index(b);
  is.parent_point = Vector3(1, 0, 0);
  is.child_point = Vector3(-1, 0, 0);
  is.normal = Vector3::UnitZ();
  s.mechanics().link(is, b);
  EXPECT_LT((s.at(b) - Vector3(2, 0, 0)).norm(), kRounding);
  s.world.bodies().set_location(s.index(b), Vector3(10, 0, 0));
  s.mechanics().take_changes();
  EXPECT_LT((s.at(a) - Vector3(8, 0, 0)).norm(), kRounding);
  s.mechanics().set_gravity(Vector3::Zero());
  s.set_velocity(a, Vector3(0, 1, 0));
  s.mechanics().take_changes();
  EXPECT_LT((s.velocity(a) - Vector3(0, 1, 0)).norm(), kRounding);
  EXPECT_GT(s.velocity(b).norm(), 0.05);  // it answers
  s.set_velocity(a, Vector3(0, 2, 0));
  s.set_velocity(b, Vector3(0, 2, 0));
  s.world.bodies().set_rotational_velocity(s.index(a), Vector3::Zero());
  s.world.bodies().set_rotational_velocity(s.index(b), Vector3::Zero());
  s.mechanics().take_changes();
  s.run(1);
  EXPECT_LT((s.at(a) - Vector3(8, 2, 0)).norm(), 1e-9);
  EXPECT_LT((s.at(b) - Vector3(10, 2, 0)).norm(), 1e-9);
}

TEST(DynamicsState, PositionIsPositiveWhenTheParentRotatesAlongTheNormal) {
  for (const bool flipped : {false, true}) {
    Physics s;
    s.mechanics().set_gravity(Vector3::Zero());
    const ObjectId parent = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3::Zero());
    const ObjectId child = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3::Zero());
    JointDescription is;
    is.parent = s.index(parent);
    is.child = s.index(child);
    is.normal = Vector3::UnitZ();
    const JointIndex joint = s.mechanics().link(is, child);
    if (flipped) {
      // Held by the world at its child: the tree then goes the other way.
      JointDescription anchor;
      anchor.kind = JointKind::Fixed;
      anchor.child = s.index(child);
      s.mechanics().link(anchor, child);
    }
    s.mechanics().set_position(joint, Vector3(0.3, 0, 0));
    s.mechanics().set_velocity(joint, Vector3(0.5, 0, 0));
    const Bodies& bodies = s.world.bodies();
    const Quaternion rotation = bodies.orientation(s.index(child)).conjugate() * bodies.orientation(s.index(parent));
    EXPECT_NEAR(2 * std::atan2(rotation.z(), rotation.w()), 0.3, kRounding) << flipped;
    const Vector3 spin = bodies.rotational_velocity(s.index(parent)) - bodies.rotational_velocity(s.index(child));
    EXPECT_NEAR(spin.z(), 0.5, kRounding) << flipped;
  }
}

TEST(DynamicsState, AMotorReachesItsSpeedAndHoldsAgainstALoad) {
  for (const Rung rung : {Rung::Fast, Rung::Balanced, Rung::Precise}) {
    Physics s;
    s.mechanics().set_accuracy(rung);
    const ObjectId arm = s.rigid(Shape::box(Vector3(1, 0.1, 0.1)), Vector3::Zero());
    JointDescription is;
    is.child = s.index(arm);
    is.child_point = Vector3(-0.5, 0, 0);
    is.normal = Vector3::UnitZ();
    const JointIndex joint = s.mechanics().link(is, arm);
    JointDrive drive;
    drive.strength_limit = 1;
    s.mechanics().set_drive(joint, drive);
    s.run(1);
    EXPECT_NEAR(s.mechanics().position(joint)[0], 0, 1e-5) << name_of(rung);
    drive.motor_speed = Vector3(2, 0, 0);
    s.mechanics().set_drive(joint, drive);
    s.run(1);
    EXPECT_NEAR(s.mechanics().velocity(joint)[0], 2, 1e-3) << name_of(rung);
    const Energy energy = s.mechanics().energy();
    EXPECT_NEAR(energy.residual, 0, rung == Rung::Fast ? 1e-2 : 1e-4) << name_of(rung);
  }
}

TEST(DynamicsState, AHandlerRunsAtTheImpactAndBeforeItsImpulse) {
  Physics s;
  s.body(2, Vector3(0, -2.5, 0), BodyKind::Stationary, Shape::box(Vector3(100, 5, 100)));
  const ObjectId ball = s.rigid(Shape::sphere(0.5), Vector3(0, 1.5, 0));
  s.world.handle_collisions(1, 2, "hit", ball);
  std::vector<double> times;
  double speed = 0;
  s.script.on_collided = [&](ObjectId, ObjectId, const Vector3&, const Vector3&) {
    if (times.empty()) speed = s.velocity(ball).y();
    times.push_back(s.world.time());
    return false;
  };
  s.run(1);
  ASSERT_FALSE(times.empty());
  const double expected = std::sqrt(2 / 9.81);
  EXPECT_NEAR(times.front(), expected, 1e-9);
  EXPECT_NEAR(speed, -9.81 * expected, 1e-9);
}

TEST(DynamicsState, AHandlerMayFreeWhatItTouches) {
  Physics s;
  const ObjectId floor = s.body(2, Vector3(0, -2.5, 0), BodyKind::Stationary, Shape::box(Vector3(100, 5, 100)));
  std::vector<ObjectId> balls;
  for (int i = 0; i < 5; ++i) balls.push_back(s.rigid(Shape::sphere(0.5), Vector3(0.9 * i, 1 + 0.1 * i, 0)));
  s.world.handle_collisions(1, 2, "hit", balls[0]);
  s.script.on_collided = [&](ObjectId ball, ObjectId, const Vector3&, const Vector3&) {
    if (s.world.alive(ball)) s.world.release(ball);
    return true;
  };
  s.run(2);
  EXPECT_EQ(s.world.object_count(), 2U);  // the controller and the floor
  EXPECT_TRUE(s.world.alive(floor));
}

TEST(DynamicsState, AJointSaysWhatItHolds) {
  Physics s;
  const ObjectId a = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3::Zero());
  const ObjectId b = s.rigid(Shape::box(Vector3(1, 2, 1)), Vector3::Zero());
  JointDescription is;
  is.kind = JointKind::Fixed;
  is.child = s.index(a);
  const JointIndex top = s.mechanics().link(is, a);
  is.parent = s.index(a);
  is.child = s.index(b);
  is.parent_point = Vector3(1, 0, 0);
  const JointIndex weld = s.mechanics().link(is, b);
  s.run(0.1);
  EXPECT_LT((s.mechanics().reaction(top).force - Vector3(0, 3 * 9.81, 0)).norm(), 1e-9);
  EXPECT_LT((s.mechanics().reaction(top).torque - Vector3(0, 0, 2 * 9.81)).norm(), 1e-9);
  EXPECT_LT((s.mechanics().reaction(weld).force - Vector3(0, 2 * 9.81, 0)).norm(), 1e-9);
}

TEST(DynamicsState, AJointHoldsWhatAFloorPushes) {
  // A body on a leg: the joint between them carries the body, the floor carries both.
  Physics s;
  s.body(2, Vector3(0, -0.5, 0), BodyKind::Stationary, Shape::box(Vector3(10, 1, 10)));
  const ObjectId trunk = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(0, 1.5, 0));
  const ObjectId leg = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(0, 0.5, 0));
  JointDescription is;
  is.kind = JointKind::Fixed;
  is.parent = s.index(trunk);
  is.child = s.index(leg);
  is.parent_point = Vector3(0, -0.5, 0);
  is.child_point = Vector3(0, 0.5, 0);
  const JointIndex joint = s.mechanics().link(is, leg);
  s.run(1);
  // On the leg: the trunk's weight.
  EXPECT_LT((s.mechanics().reaction(joint).force - Vector3(0, -9.81, 0)).norm(), 1e-6);
  EXPECT_LT(s.mechanics().reaction(joint).torque.norm(), 1e-6);
}

TEST(DynamicsState, LinksThatIntersectAreCountedIfTheyAreTested) {
  Physics s;
  s.mechanics().set_gravity(Vector3::Zero());
  std::vector<ObjectId> rods;
  for (int i = 0; i < 4; ++i) rods.push_back(s.rigid(Shape::box(Vector3(1, 0.2, 0.2)), Vector3::Zero()));
  for (std::size_t i = 1; i < rods.size(); ++i) {
    JointDescription is;
    is.parent = s.index(rods[i - 1]);
    is.child = s.index(rods[i]);
    is.parent_point = Vector3(0.5, 0, 0);
    is.child_point = Vector3(-0.5, 0, 0);
    is.normal = Vector3::UnitZ();
    const JointIndex joint = s.mechanics().link(is, rods[i]);
    s.mechanics().set_position(joint, Vector3(1.57, 0, 0));  // a square: the fourth meets the first
  }
  EXPECT_EQ(s.mechanics().self_penetrations(s.index(rods[0])), 0U);
  s.mechanics().set_self_collisions(s.index(rods[0]), true);
  EXPECT_EQ(s.mechanics().self_penetrations(s.index(rods[2])), 1U);
  const JointIndex last = s.mechanics().joints_of(s.index(rods[0])).back();
  s.mechanics().set_position(last, Vector3(-1.57, 0, 0));
  EXPECT_EQ(s.mechanics().self_penetrations(s.index(rods[0])), 0U);
}

TEST(DynamicsState, TheCounterOfSleepersIsTheirNumber) {
  Physics s(1.0 / 240);
  s.world.set_iteration_step(1.0 / 60);  // four sub-steps
  s.mechanics().set_sleeping(true);
  s.body(2, Vector3(0, -0.5, 0), BodyKind::Stationary, Shape::box(Vector3(10, 1, 10)));
  ObjectId last;
  for (int i = 0; i < 3; ++i) last = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(2 * i, 0.5, 0));
  s.run(2);
  EXPECT_EQ(s.mechanics().counters().sleeping, 3U);
  s.set_velocity(last, Vector3(0, 1, 0));
  s.world.step();
  EXPECT_EQ(s.mechanics().counters().sleeping, 2U);
}

TEST(DynamicsState, AnImageLeavesTheHashOfWhatIsAboutToWakeAsItIs) {
  Physics s;
  s.mechanics().set_sleeping(true);
  const ObjectId floor = s.body(2, Vector3(0, -0.5, 0), BodyKind::Stationary, Shape::box(Vector3(10, 1, 10)));
  s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(0, 0.5, 0));
  s.run(2);
  ASSERT_EQ(s.mechanics().counters().sleeping, 1U);
  s.world.bodies().set_collision_shape(s.index(floor), Shape::box(Vector3(8, 1, 8)));
  const std::uint64_t before = s.world.hash();
  const auto image = s.world.save(1);
  EXPECT_EQ(s.world.hash(), before);
  Scene other;
  other.world.load(image.data(), image.size(), 1);
  EXPECT_EQ(other.world.hash(), before);
}

TEST(DynamicsState, ALinkThatIsRotatedBeforeTheFirstStepTakesItsAssemblyAlong) {
  Physics s;
  const ObjectId a = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3::Zero());
  const ObjectId b = s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(5, 5, 5));
  JointDescription is;
  is.parent = s.index(a);
  is.child = s.index(b);
  is.parent_point = Vector3(1, 0, 0);
  is.child_point = Vector3(-1, 0, 0);
  is.normal = Vector3::UnitZ();
  s.mechanics().link(is, b);
  s.world.bodies().set_orientation(s.index(a), Quaternion(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3::UnitZ())));
  s.mechanics().moved(s.index(a));
  EXPECT_LT((s.at(b) - Vector3(0, 2, 0)).norm(), kRounding);
  s.world.bodies().set_location(s.index(b), Vector3(1, 2, 0));
  s.mechanics().moved(s.index(b));
  EXPECT_LT((s.at(a) - Vector3(1, 0, 0)).norm(), kRounding);
}

TEST(DynamicsState, EffectsSayWhoAsked) {
  Mixed s;
  s.world.step();
  const Effects& effects = s.world.effects();
  EXPECT_TRUE(effects[EffectId::Articulation].active);
  EXPECT_EQ(effects[EffectId::Articulation].asked_by, s.links[0]);
  EXPECT_TRUE(effects[EffectId::Motors].active);
  EXPECT_EQ(effects[EffectId::Motors].asked_by, s.links[2]);
  EXPECT_TRUE(effects[EffectId::Contact].active);
  EXPECT_FALSE(effects[EffectId::JointLimits].active);
}

}  // namespace
}  // namespace breve::testing
