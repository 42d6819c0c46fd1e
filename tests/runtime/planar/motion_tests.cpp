// Motion in a flat world against closed forms: free flight, pendulums, inclines, rebounds, joints.
#include <numbers>

#include "scene.hpp"

namespace breve::testing::motion_tests {
namespace {

constexpr double kG = 9.81;

TEST(PlanarMotion, FreeFallLiesOnTheParabola) {
  for (const Rung rung : {Rung::Fast, Rung::Balanced, Rung::Precise}) {
    Flat flat(rung);
    const ObjectId ball = flat.ball(0.5, 0, 0);
    flat.set_velocity(ball, {3, 4, 0});
    flat.run(1);
    // Single precision: a part in a hundred thousand after a thousand sub-steps.
    EXPECT_NEAR(flat.at(ball).x(), 3, 1e-4);
    EXPECT_NEAR(flat.at(ball).y(), 4 - kG / 2, 2e-4);
    EXPECT_NEAR(flat.velocity(ball).y(), 4 - kG, 2e-4);
    EXPECT_EQ(flat.at(ball).z(), 0);
  }
}

TEST(PlanarMotion, NothingLeavesThePlane) {
  Flat flat;
  flat.ground();
  const ObjectId box = flat.rigid(Shape::box({1, 1, 1}), 0, 3, 0.4);
  flat.bodies().set_rotational_velocity(flat.index(box), {0, 0, 5});
  for (int i = 0; i < 300; ++i) {
    flat.world.step();
    ASSERT_EQ(flat.at(box).z(), 0);
    ASSERT_EQ(flat.velocity(box).z(), 0);
    const Quaternion q = flat.bodies().orientation(flat.index(box));
    ASSERT_EQ(q.x(), 0);
    ASSERT_EQ(q.y(), 0);
  }
}

TEST(PlanarMotion, WhatIsOutOfThePlaneIsAnErrorThatSaysSo) {
  Flat flat;
  const ObjectId ball = flat.ball(1, 0, 0);
  const BodyIndex body = flat.index(ball);
  const auto refused = [](auto&& what) {
    try {
      what();
    } catch (const Error& error) {
      return std::string(error.what()).find("flat") != std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(refused([&] { flat.bodies().set_location(body, {0, 0, 1}); }));
  EXPECT_TRUE(refused([&] { flat.bodies().set_velocity(body, {0, 0, 1}); }));
  EXPECT_TRUE(refused([&] { flat.bodies().set_force(body, {0, 0, 1}); }));
  EXPECT_TRUE(refused([&] { flat.bodies().set_torque(body, {1, 0, 0}); }));
  EXPECT_TRUE(refused([&] { flat.bodies().set_rotational_velocity(body, {0, 1, 0}); }));
  EXPECT_TRUE(refused([&] { flat.bodies().set_orientation(body, Quaternion(0.8, 0.6, 0, 0)); }));
  EXPECT_TRUE(refused([&] { flat.physics().set_gravity({0, 0, -9.8}); }));
  JointDescription is;
  is.child = body;
  for (const JointKind kind : {JointKind::Ball, JointKind::Universal}) {
    is.kind = kind;
    EXPECT_TRUE(refused([&] { flat.physics().link(is, ball); }));
  }
  is.kind = JointKind::Revolute;
  is.normal = {1, 0, 0};
  EXPECT_TRUE(refused([&] { flat.physics().link(is, ball); }));
  EXPECT_EQ(flat.at(ball), Vector3(0, 0, 0));
  EXPECT_EQ(flat.physics().joint_count(), 0U);
}

TEST(PlanarMotion, APendulumSwingsWithItsPeriod) {
  // A ball on a rod without mass: T = 2 pi sqrt((l^2 + 2/5 r^2) / (g l)), and 1 + a^2 / 16 of it at amplitude a.
  Flat flat(Rung::Precise);
  const double l = 2, r = 0.2, a = 0.1;
  const ObjectId ball = flat.ball(r, l * std::sin(a), -l * std::cos(a));
  flat.hinge({}, ball, {0, 0, 0}, {-l * std::sin(a), l * std::cos(a), 0});
  const double period = 2 * M_PI * std::sqrt((l * l + 0.4 * r * r) / (kG * l)) * (1 + a * a / 16);
  double last = flat.at(ball).x(), time = 0, first = -1, latest = -1;
  int periods = 0;
  for (int i = 0; i < 60 * 30; ++i) {
    flat.world.step();
    time += 1.0 / 60;
    const double x = flat.at(ball).x();
    if (last < 0 && x >= 0) {
      latest = time - x / (x - last) / 60;
      if (first < 0)
        first = latest;
      else
        ++periods;
    }
    last = x;
  }
  EXPECT_NEAR((latest - first) / periods, period, 0.002 * period);
}

TEST(PlanarMotion, ABlockOnAnInclineSticksOrSlidesAsItsFrictionSays) {
  const double slope = 0.4;
  for (const double mu : {0.3, 0.5}) {
    Flat flat;
    flat.material(flat.fixed(Shape::box({200, 2, 1}), std::sin(slope), -std::cos(slope), -slope), mu, 0);
    const ObjectId block = flat.rigid(Shape::box({1, 1, 1}), 0.5 * std::sin(slope), 0.5 * std::cos(slope), -slope);
    flat.material(block, mu, 0);
    flat.run(0.5);  // it settles
    const Vector3 before = flat.at(block);
    const double speed = flat.velocity(block).norm();
    flat.run(2);
    const double way = (flat.at(block) - before).norm();
    if (mu > std::tan(slope)) {
      EXPECT_LT(way, 1e-3);
    } else {
      const double a = kG * (std::sin(slope) - mu * std::cos(slope));
      EXPECT_NEAR(way, speed * 2 + a * 2, 0.01 * way);
    }
  }
}

TEST(PlanarMotion, ABallBouncesToTheSquareOfItsRestitution) {
  for (const double e : {1.0, 0.8}) {
    Flat flat;
    flat.material(flat.ground(), 0, e);
    const ObjectId ball = flat.ball(0.5, 0, 5.5);
    flat.material(ball, 0, e);
    double top = 0, wanted = 5;
    int bounces = 0;
    double last = flat.velocity(ball).y();
    for (int i = 0; i < 60 * 12 && bounces < 4; ++i) {
      flat.world.step();
      const double v = flat.velocity(ball).y();
      if (last < 0 && v > 0) {
        ++bounces;
        top = 0;
        wanted *= e * e;
      }
      last = v;
      const double height = flat.at(ball).y() - 0.5 + (v > 0 ? v * v / (2 * kG) : 0);
      if (bounces > 0 && v > 0.5) {
        top = std::max(top, height);
        ASSERT_NEAR(height, wanted, 0.005 * wanted) << "after bounce " << bounces << " with e = " << e;
      }
    }
    EXPECT_EQ(bounces, 4);
  }
}

TEST(PlanarMotion, ADiscAt300MetresASecondNeverPassesAWallOfACentimetre) {
  for (const Rung rung : {Rung::Fast, Rung::Balanced, Rung::Precise})
    for (const double e : {0.0, 0.5, 1.0})
      for (int k = 0; k < 7; ++k) {
        Flat flat(rung);
        flat.physics().set_gravity(Vector3::Zero());
        flat.material(flat.fixed(Shape::box({0.01, 20, 1}), 0, 0), 0.2, e);
        const ObjectId disc = flat.ball(0.05, -4 - 0.37 * k, 0);
        flat.material(disc, 0.2, e);
        flat.set_velocity(disc, {300, 0, 0});
        for (int i = 0; i < 20; ++i) {
          flat.world.step();
          ASSERT_LT(flat.at(disc).x(), 0) << "rung " << static_cast<int>(rung) << ", e " << e;
        }
      }
}

TEST(PlanarMotion, SpeedsAboveWhatBox2DMovesInAStepAreNotCut) {
  Flat flat(Rung::Fast);
  flat.physics().set_gravity(Vector3::Zero());
  const ObjectId ball = flat.ball(0.5, 0, 0);
  flat.set_velocity(ball, {1500, 0, 0});
  flat.run(1);
  EXPECT_NEAR(flat.at(ball).x(), 1500, 0.05);
}

TEST(PlanarMotion, MillimetresAndKilometresBehaveWithTheirLengthUnit) {
  for (const double unit : {1e-3, 1.0, 1e3}) {
    Flat flat;
    flat.physics().set_length_unit(unit);
    flat.physics().set_gravity({0, -kG * unit, 0});
    flat.material(flat.fixed(Shape::box({100 * unit, 2 * unit, unit}), 0, -unit), 0.5, 0);
    std::vector<ObjectId> boxes;
    for (int i = 0; i < 5; ++i) {
      boxes.push_back(flat.rigid(Shape::box({unit, unit, unit}), 0, (0.5 + i) * unit));
      flat.material(boxes.back(), 0.5, 0);
    }
    flat.run(5);
    for (int i = 0; i < 5; ++i) {
      EXPECT_NEAR(flat.at(boxes[static_cast<std::size_t>(i)]).x() / unit, 0, 0.01);
      EXPECT_NEAR(flat.at(boxes[static_cast<std::size_t>(i)]).y() / unit, 0.5 + i, 0.05);
    }
  }
}

TEST(PlanarMotion, AShapeTooThinForTheUnitIsAnErrorThatNamesTheRemedy) {
  Flat flat;
  flat.ball(1e-4, 0, 0);
  try {
    flat.world.step();
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("set-length-unit"), std::string::npos);
  }
}

std::string refusal(Flat& flat) {
  try {
    flat.world.step();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(PlanarMotion, APlaceBeyondSinglePrecisionIsAnErrorAndNoAbort) {
  Flat flat;
  const ObjectId ball = flat.ball(0.5, 0, 5), wall = flat.fixed(Shape::sphere(0.5), 9, 0);
  for (int i = 0; i < 2; ++i) {
    for (const ObjectId id : {ball, wall})
      EXPECT_THROW(flat.bodies().set_location(flat.index(id), {1e300, 0, 0}), Error);
    flat.world.step();
  }
  EXPECT_LT(flat.at(ball).y(), 5);
  // Who flew there without physics.
  const ObjectId agent = flat.body(1, {0, 0, 0});
  flat.set_velocity(agent, {1e300, 0, 0});
  flat.world.step();
  flat.bodies().set_physics(flat.index(agent), true);
  for (int i = 0; i < 2; ++i) EXPECT_NE(refusal(flat).find("single precision"), std::string::npos);
  flat.bodies().set_location(flat.index(agent), {3, 0, 0});
  flat.set_velocity(agent, {0, 0, 0});
  EXPECT_EQ(refusal(flat), "");
}

TEST(PlanarMotion, AProfileMayHaveCornersNearerThanBox2DCanTell) {
  // A profile of 4 m with a valley in the middle; a ball of 0.5 m comes to rest there as on a coarse one.
  std::vector<double> heights;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 2001; ++column) heights.push_back(0.1 * std::cos(M_PI * column / 1000));
  Flat flat;
  flat.fixed(Shape::height_field(2001, 3, 0.002, heights), 0, 0);
  const ObjectId ball = flat.ball(0.25, 0, 0.5);
  flat.material(ball, 1, 0);
  flat.run(3);
  EXPECT_NEAR(flat.at(ball).y(), 0.15, 0.02);
  Flat tiny;
  tiny.fixed(Shape::height_field(3, 3, 0.001, std::vector<double>(9)), 0, 0);
  tiny.ball(0.25, 0, 0.5);
  EXPECT_NE(refusal(tiny).find("set-length-unit"), std::string::npos);
  Flat huge;
  huge.fixed(Shape::height_field(3, 3, 1, std::vector<double>{0, 0, 0, 0, 1e40, 0, 0, 0, 0}), 0, 0);
  huge.ball(0.25, 0, 0.5);
  EXPECT_NE(refusal(huge).find("single precision"), std::string::npos);
}

TEST(PlanarMotion, ABodyWhoseCentreIsFarFromItsOriginIsRefused) {
  // Box2D would see no inertia at all, and end the process.
  std::vector<Vector3> corners;
  for (const double x : {1000.0, 1000.1})
    for (const double y : {0.0, 0.1})
      for (const double z : {-0.1, 0.1}) corners.emplace_back(x, y, z);
  Flat flat;
  flat.rigid(Shape::hull(corners, 1), 0, 5);
  EXPECT_NE(refusal(flat).find("centre of mass is out of the range"), std::string::npos);
}

TEST(PlanarMotion, AShapeThatIsALineToDoublePrecisionIsRefusedAsSuch) {
  Flat flat;
  flat.box(1e14, 1, 0, 0);
  EXPECT_NE(refusal(flat).find("is a line to double precision"), std::string::npos) << refusal(flat);
  Flat aside;  // a closed mesh that lies beyond the plane
  const std::vector<Vector3> corners{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 2}};
  const std::vector<std::array<std::int32_t, 3>> triangles{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  aside.fixed(Shape::mesh(corners, triangles), 0, 0);
  aside.ball(1, 0, 5);
  EXPECT_NE(refusal(aside).find("does not reach the plane z = 0"), std::string::npos) << refusal(aside);
}

TEST(PlanarMotion, BoundsAlongZThatLeaveOutThePlaneAreRefused) {
  Flat flat;
  EXPECT_THROW(flat.world.set_space(2, Ending::Wrap, 1, 2), Error);
  EXPECT_THROW(flat.world.set_space(2, Ending::Wall, -2, 0), Error);
  EXPECT_TRUE(flat.world.space().open());
  flat.world.set_space(2, Ending::Wrap, -1, 1);
}

TEST(PlanarMotion, ABulletNeverPassesWhatMovesItself) {
  // A disc and a plate that is free to move; two discs that come at each other.
  for (const Rung rung : {Rung::Fast, Rung::Balanced, Rung::Precise})
    for (int k = 0; k < 7; ++k) {
      Flat flat(rung);
      flat.physics().set_gravity(Vector3::Zero());
      const ObjectId plate = flat.box(0.01, 20, 0, 0);
      const ObjectId disc = flat.ball(0.05, -4 - 0.37 * k, 0);
      const ObjectId left = flat.ball(0.05, -4 - 0.37 * k, 40), right = flat.ball(0.05, 4, 40);
      for (const ObjectId id : {disc, left}) flat.set_velocity(id, {300, 0, 0});
      flat.set_velocity(right, {-300, 0, 0});
      for (int i = 0; i < 20; ++i) {
        flat.world.step();
        ASSERT_LT(flat.at(disc).x(), flat.at(plate).x()) << "rung " << static_cast<int>(rung);
        ASSERT_LT(flat.at(left).x(), flat.at(right).x()) << "rung " << static_cast<int>(rung);
      }
    }
}

// --- joints ---------------------------------------------------------------------------------------------------------

TEST(PlanarMotion, ACapsuleLiesOnItsSideAndStandsOnItsEnd) {
  Flat scene;
  scene.material(scene.ground(), 0.5, 0);
  const ObjectId lying = scene.rigid(Shape::capsule(1, 0.5), 0, 0.5, std::numbers::pi / 2);
  const ObjectId standing = scene.rigid(Shape::capsule(1, 0.5), 5, 1);
  for (const ObjectId id : {lying, standing}) scene.material(id, 0.5, 0);
  scene.run(1);
  EXPECT_NEAR(scene.bodies().location(scene.index(lying)).y(), 0.5, 0.006);
  EXPECT_NEAR(scene.bodies().location(scene.index(standing)).y(), 1, 0.006);
  EXPECT_NEAR(scene.angle(lying), std::numbers::pi / 2, 1e-3);
}

TEST(PlanarMotion, ACylinderAboutZRollsDownAnInclineByTwoThirds) {
  Flat scene(Rung::Precise);
  const double slope = 0.2;
  scene.physics().set_gravity({9.81 * std::sin(slope), -9.81 * std::cos(slope), 0});
  scene.material(scene.ground(), 1, 0);
  const ObjectId wheel = scene.rigid(Shape::cylinder(0.3, 0.5, 2), 0, 0.5);
  scene.material(wheel, 1, 0);
  scene.run(2);
  const double wanted = 2 * 2.0 / 3 * 9.81 * std::sin(slope);
  EXPECT_NEAR(scene.bodies().velocity(scene.index(wheel)).x(), wanted, 0.01 * wanted);
}

TEST(PlanarMotion, APlateThatMovesAsItIsToldCarriesAndLifts) {
  Flat scene;
  const ObjectId plate = scene.fixed(Shape::box({20, 1, 1}), 0, -0.5), box = scene.box(1, 1, 0, 0.5);
  scene.material(plate, 0.8, 0);
  scene.material(box, 0.8, 0);
  scene.bodies().set_velocity(scene.index(plate), {1, 0.5, 0});
  scene.run(2);
  EXPECT_NEAR(scene.bodies().location(scene.index(plate)).y(), 0.5, 1e-9);
  EXPECT_NEAR(scene.bodies().velocity(scene.index(box)).x(), 1, 1e-3);
  EXPECT_NEAR(scene.bodies().velocity(scene.index(box)).y(), 0.5, 1e-2);
  EXPECT_NEAR(scene.bodies().location(scene.index(box)).y(), 1.5, 0.01);
  const Energy energy = scene.physics().energy();
  EXPECT_NEAR(energy.residual, 0, 0.02 * energy.script_work);
  EXPECT_NEAR(energy.script_work, 9.81 + 1 + 0.25, 0.5);
}

TEST(PlanarJoints, AHingeCountsItsRevolutionsAndItsMotorRotatesIt) {
  Flat flat;
  flat.physics().set_gravity(Vector3::Zero());
  const ObjectId bar = flat.box(2, 0.2, 0, 0);
  const JointIndex joint = flat.hinge({}, bar, {0, 0, 0}, {0, 0, 0});
  JointDrive drive = flat.physics().drive(joint);
  drive.motor_speed[0] = 3;
  drive.strength_limit = 100;
  flat.physics().set_drive(joint, drive);
  flat.run(10);
  // Positive when the parent, here the world, turns along +z relative to the child.
  EXPECT_NEAR(flat.physics().position(joint)[0], 30, 0.3);
  EXPECT_NEAR(flat.physics().velocity(joint)[0], 3, 1e-3);
  EXPECT_LT(flat.bodies().rotational_velocity(flat.index(bar)).z(), 0);
  EXPECT_GT(flat.physics().energy().motor_work, 0);
}

TEST(PlanarJoints, LimitsStopAHingeAndASlider) {
  Flat flat;
  const ObjectId bar = flat.box(2, 0.2, 1, 0);
  const JointIndex hinge = flat.hinge({}, bar, {0, 0, 0}, {-1, 0, 0});
  JointDrive drive = flat.physics().drive(hinge);
  drive.low[0] = -0.5;
  drive.high[0] = 0.5;
  flat.physics().set_drive(hinge, drive);
  const ObjectId lift = flat.box(0.5, 0.5, 5, 0);
  JointDescription is;
  is.kind = JointKind::Prismatic;
  is.child = flat.index(lift);
  is.parent_point = {5, 0, 0};
  is.normal = {0, 1, 0};
  const JointIndex slider = flat.physics().link(is, lift);
  drive = flat.physics().drive(slider);
  drive.low[0] = -1;
  drive.high[0] = 1;
  flat.physics().set_drive(slider, drive);
  flat.run(3);
  EXPECT_NEAR(flat.physics().position(hinge)[0], 0.5, 0.01);
  EXPECT_NEAR(flat.physics().position(slider)[0], 1, 0.01);
  EXPECT_NEAR(flat.at(lift).y(), -1, 0.01);
}

TEST(PlanarJoints, AFixedJointHoldsAndARotatedAssemblyFollowsItsMovedLink) {
  Flat flat;
  flat.physics().set_gravity(Vector3::Zero());
  const ObjectId a = flat.box(1, 1, 0, 0), b = flat.box(1, 1, 3, 7);
  JointDescription is;
  is.kind = JointKind::Fixed;
  is.parent = flat.index(a);
  is.child = flat.index(b);
  is.parent_point = {0.5, 0, 0};
  is.child_point = {-0.5, 0, 0};
  flat.physics().link(is, b);
  EXPECT_NEAR((flat.at(b) - Vector3(1, 0, 0)).norm(), 0, 1e-12);  // it was brought to its place
  flat.bodies().set_location(flat.index(a), {0, 5, 0});
  flat.rotate(a, M_PI / 2);
  flat.physics().moved(flat.index(a));
  EXPECT_NEAR((flat.at(b) - Vector3(0, 6, 0)).norm(), 0, 1e-6);
  flat.bodies().set_rotational_velocity(flat.index(a), {0, 0, 2});
  flat.run(2);
  EXPECT_NEAR((flat.at(b) - flat.at(a)).norm(), 1, 0.01);
  EXPECT_EQ(flat.physics().links_of(flat.index(a)).size(), 2U);
}

TEST(PlanarJoints, ASpringSwingsWithItsPeriodAndItsEnergyIsInTheLedger) {
  Flat flat(Rung::Precise);
  flat.physics().set_gravity(Vector3::Zero());
  const ObjectId a = flat.fixed(Shape::box({1, 1, 1}), 0, 0), b = flat.box(0.5, 0.5, 3, 0);
  SpringDescription spring;
  spring.a = flat.index(a);
  spring.b = flat.index(b);
  spring.length = 2;
  spring.strength = 10;
  spring.damping = 0;
  flat.physics().add_spring(spring, b);
  flat.world.step();
  const Energy start = flat.physics().energy();
  EXPECT_NEAR(start.total(), 5, 0.05);
  const double w = std::sqrt(10 / flat.bodies().mass(flat.index(b)));
  double time = 1.0 / 60;
  for (int i = 0; i < 300; ++i) {
    flat.world.step();
    time += 1.0 / 60;
    ASSERT_NEAR(flat.at(b).x(), 2 + std::cos(w * time), 0.01);
  }
  EXPECT_NEAR(flat.physics().energy().total(), start.total(), 0.05);
}

}  // namespace
}  // namespace breve::testing::motion_tests
