// Contacts that are springs, in a world: the figures of a ball of 1 kg with k = 1e4 N/m and zeta = 0.2, and what has to
// hold for any body: energy, friction, snapshots.
#include <gtest/gtest.h>

#include <numbers>

#include "dynamics_scene.hpp"

namespace breve::testing::spring_tests {
namespace {

// Of zeta = 0.2: exp(-pi zeta / sqrt(1 - zeta^2)).
constexpr double kRebound = 0.526620, kDuration = 0.0320637, kSink = 9.81e-4;

struct Ground : Physics {
  ObjectId floor;
  explicit Ground(Rung rung, double step = 1.0 / 960) : Physics(step) {
    Accuracy accuracy = accuracy_of(rung);
    accuracy.contact_springs = true;
    mechanics().set_accuracy(accuracy);
    floor = body(2, Vector3(0, -2.5, 0), BodyKind::Stationary, Shape::box(Vector3(1000, 5, 1000)));
    give(floor, kRebound);
  }
  void give(ObjectId id, double e, double mu = 0.5, double threshold = 0.2) {
    Material& material = world.bodies().material(index(id));
    material.normal_restitution = e;
    material.restitution_threshold = threshold;
    material.static_friction = material.dynamic_friction = mu;
  }
  ObjectId thing(std::shared_ptr<Shape> shape, const Vector3& at, double e = kRebound, double mu = 0.5) {
    shape->set_mass(1);
    const ObjectId id = rigid(std::move(shape), at);
    give(id, e, mu);
    return id;
  }
};

TEST(ContactSpringsInAWorld, ABallSinksByItsWeightAndTheLedgerCloses) {
  for (const Rung rung : {Rung::Precise, Rung::Reference}) {
    Ground s(rung);
    const ObjectId ball = s.thing(Shape::sphere(0.5), Vector3(0, 0.5, 0));
    const double start = s.mechanics().energy().total();
    s.run(1.5);
    EXPECT_NEAR(0.5 - s.at(ball).y(), kSink, 1e-8) << name_of(rung);
    EXPECT_LT(s.velocity(ball).norm(), 1e-6);
    const Energy now = s.mechanics().energy();
    EXPECT_NEAR(now.springs, 0.5 * 1e4 * kSink * kSink, 1e-6);
    EXPECT_NEAR(now.total() + now.contact_loss + now.friction_loss, start, 1e-6);
    EXPECT_NEAR(now.residual, 0, 1e-6);
  }
}

/// How a ball without weight that comes at `speed` leaves, m/s, and how long it touched, s.
std::pair<double, double> touch(Rung rung, double speed) {
  Ground s(rung, 1.0 / 9600);
  s.mechanics().set_gravity(Vector3::Zero());
  const double gap = 1e-4;
  const ObjectId ball = s.thing(Shape::sphere(0.5), Vector3(0, 0.5 + gap, 0));
  s.world.bodies().set_velocity(s.index(ball), Vector3(0, -speed, 0));
  const double begins = gap / speed;
  for (int i = 0; i < 20000; ++i) {
    s.world.step();
    const double height = s.at(ball).y() - 0.5, out = s.velocity(ball).y();
    if (s.world.time() > begins && height > 0 && out > 0) return {out, s.world.time() - height / out - begins};
  }
  return {0, 0};
}

TEST(ContactSpringsInAWorld, ReboundAndDurationAreThoseOfTheOscillatorAtEverySpeed) {
  for (const Rung rung : {Rung::Precise, Rung::Reference})
    for (const double speed : {0.01, 0.03, 0.1}) {
      const auto [out, duration] = touch(rung, speed);
      EXPECT_NEAR(out / speed, kRebound, 1e-4) << name_of(rung) << ' ' << speed;
      EXPECT_NEAR(duration, kDuration, 1e-5) << name_of(rung) << ' ' << speed;
    }
}

TEST(ContactSpringsInAWorld, WhatComesOutDoesNotJumpWhereTheImpactLawTakesOver) {
  // The threshold is 0.2 m/s: slower touches are springs, faster ones impulses.
  const double below = touch(Rung::Precise, 0.199).first / 0.199, above = touch(Rung::Precise, 0.201).first / 0.201;
  EXPECT_NEAR(below, above, 1e-3);
}

TEST(ContactSpringsInAWorld, EnergyAfterIsNeverAboveEnergyBefore) {
  for (const double step : {1.0 / 480, 1.0 / 960}) {
    double last = 0;
    for (int i = 0; i <= 18; ++i) {
      const double speed = 0.01 + 0.005 * i;
      Ground s(Rung::Precise, step);
      const ObjectId ball = s.thing(Shape::sphere(0.5), Vector3(0, 0.5, 0));
      s.world.bodies().set_velocity(s.index(ball), Vector3(0, -speed, 0));
      const double before = s.mechanics().energy().total();
      double highest = 0;
      for (int k = 0; k * step < 0.08; ++k) {
        s.world.step();
        highest = std::max(highest, s.velocity(ball).y());
        ASSERT_LE(s.mechanics().energy().total(), before + 1e-9) << speed << ' ' << k;
      }
      if (i > 0) {
        EXPECT_NEAR(highest, last, 0.1 * last) << speed;
      }
      last = highest;
    }
  }
}

TEST(ContactSpringsInAWorld, OrderIsThatOfTheIntegrator) {
  // A ball that oscillates on its spring, never leaving it: 1/h twice as large, error a sixteenth. It is caught where
  // gravity is weak, and at the deepest point gravity grows.
  constexpr double kFrequency = 100, kWeak = 1;
  const auto error = [&](double step) {
    Ground s(Rung::Precise, step);
    s.mechanics().set_gravity(Vector3(0, -kWeak, 0));
    Accuracy accuracy = accuracy_of(Rung::Precise);
    accuracy.contact_springs = true;
    accuracy.step = step;
    s.mechanics().set_accuracy(accuracy);
    const ObjectId ball = s.thing(Shape::sphere(0.5), Vector3(0, 0.5, 0), 1);
    s.give(s.floor, 1);
    s.run(std::numbers::pi / kFrequency);
    s.mechanics().set_gravity(Vector3(0, -9.81, 0));
    s.run(10 * std::numbers::pi / kFrequency);
    EXPECT_NEAR(s.at(ball).y(), 0.5 - 2 * kWeak / (kFrequency * kFrequency), 1e-8);
    return std::abs(s.velocity(ball).y());  // after five periods it is where it was: at the top
  };
  const double coarse = error(std::numbers::pi / 3200), fine = error(std::numbers::pi / 6400);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_NEAR(coarse / fine, 16, 2);
}

TEST(ContactSpringsInAWorld, ABoxOnASlopeSticksOrSlides) {
  for (const bool holds : {true, false}) {
    Ground s(Rung::Precise);
    const double angle = 0.3, mu = std::tan(angle) * (holds ? 1.02 : 0.98);
    s.mechanics().set_gravity(9.81 * Vector3(std::sin(angle), -std::cos(angle), 0));
    s.give(s.floor, kRebound, mu);
    const ObjectId box = s.thing(Shape::box(Vector3(1, 1, 1)), Vector3(0, 0.5, 0), kRebound, mu);
    s.run(1);
    const double from = s.at(box).x(), speed = s.velocity(box).x();
    s.run(1);
    const double way = s.at(box).x() - from;
    if (holds) {
      EXPECT_NEAR(way, 0, 1e-6);
    } else {
      const double a = 9.81 * (std::sin(angle) - mu * std::cos(angle));
      EXPECT_NEAR(way, speed + 0.5 * a, 1e-3 * way);
    }
    EXPECT_NEAR(s.mechanics().energy().residual, 0, 1e-4);
  }
}

TEST(ContactSpringsInAWorld, ASlidingBallEndsInRollingAtFiveSeventhsOfItsSpeed) {
  Ground s(Rung::Precise);
  std::shared_ptr<Shape> shape = Shape::sphere(0.5);
  const ObjectId ball = s.thing(shape, Vector3(0, 0.5 - kSink, 0));
  s.world.bodies().set_velocity(s.index(ball), Vector3(1, 0, 0));
  s.run(1);
  EXPECT_NEAR(s.velocity(ball).x(), 5.0 / 7, 2e-3);
  EXPECT_NEAR(s.world.bodies().rotational_velocity(s.index(ball)).z(), -s.velocity(ball).x() / 0.5, 2e-3);
}

TEST(ContactSpringsInAWorld, ALoadThatIsTooHeavyIsCarriedByRigidSurfaces) {
  Ground s(Rung::Precise, 1.0 / 60);
  const ObjectId small = s.thing(Shape::box(Vector3(1, 1, 1)), Vector3(0, 0.5, 0));
  std::shared_ptr<Shape> heavy = Shape::box(Vector3(1, 1, 1));
  const ObjectId large = s.thing(heavy, Vector3(0, 1.5, 0));
  heavy->set_mass(1000);
  s.run(5);
  EXPECT_GT(s.at(small).y(), 0.49);
  EXPECT_GT(s.at(large).y(), 1.48);
  EXPECT_LT(s.velocity(large).norm(), 1e-3);
}

TEST(ContactSpringsInAWorld, AHeapOfBoxesThatFallOnEachOtherComesToRestAndGainsNothing) {
  Ground s(Rung::Precise, 1.0 / 60);
  s.mechanics().set_guard(GuardMode::Report);
  std::vector<ObjectId> boxes;
  for (int i = 0; i < 10; ++i)
    boxes.push_back(s.thing(Shape::box(Vector3(1, 1, 1)), Vector3(0, 0.55 + 1.1 * i, 0), 0.4));
  double most = 0;
  std::uint64_t told = 0;
  for (int i = 0; i < 600; ++i) {
    s.world.step();
    most = std::max(most, s.mechanics().energy().kinetic);
    told += s.mechanics().counters().interventions;
  }
  EXPECT_LT(std::abs(s.mechanics().energy().residual), 1e-6 * most);
  EXPECT_EQ(told, 0u);
  // The lowest carries ten: its springs are pressed in until they harden.
  EXPECT_NEAR(s.at(boxes.front()).y(), 0.496, 2e-3);
  EXPECT_NEAR(s.at(boxes.back()).y(), 9.5, 0.03);
  EXPECT_LT(s.velocity(boxes.back()).norm(), 1e-2);
}

/// A plate on two feet with sprung joints, on the ground.
ObjectId table(Ground& s) {
  const ObjectId body = s.thing(Shape::box(Vector3(1, 0.2, 0.5)), Vector3(0, 1.1, 0));
  std::vector<ObjectId> feet;
  for (const double x : {-0.4, 0.4}) {
    feet.push_back(s.thing(Shape::box(Vector3(0.2, 1, 0.5)), Vector3(x, 0.5, 0)));
    JointDescription is;
    is.kind = JointKind::Revolute;
    is.child = s.index(feet.back());
    is.parent = s.index(body);
    is.parent_point = Vector3(x, -0.1, 0);
    is.child_point = Vector3(0, 0.5, 0);
    is.normal = Vector3::UnitZ();
    const JointIndex joint = s.mechanics().link(is, feet.back());
    JointDrive drive = s.mechanics().drive(joint);
    drive.stiffness = 500;
    drive.damping = 20;
    s.mechanics().set_drive(joint, drive);
  }
  return body;
}

TEST(ContactSpringsInAWorld, AnArticulatedFootStandsOnThem) {
  Ground s(Rung::Precise);
  const ObjectId body = table(s);
  const double start = s.mechanics().energy().total();
  s.run(2);
  EXPECT_NEAR(s.at(body).y(), 1.1, 2e-3);
  EXPECT_LT(s.velocity(body).norm(), 1e-3);
  const Energy now = s.mechanics().energy(), own = s.mechanics().energy(s.index(body));
  EXPECT_NEAR(now.total() + now.contact_loss + now.friction_loss + now.drag_loss - now.residual, start, 1e-6);
  EXPECT_NEAR(now.residual, 0, 1e-4);
  EXPECT_NEAR(own.residual, 0, 1e-4);
  EXPECT_GT(now.springs, 0);
}

TEST(ContactSpringsInAWorld, ArticulatedBodiesStandOnRigidGroundIfAskedTo) {
  for (const Rung rung : {Rung::Precise, Rung::Reference}) {
    Ground s(rung, 1.0 / 60);
    Accuracy accuracy = accuracy_of(rung);
    accuracy.contact_springs = true;
    accuracy.link_springs = false;
    s.mechanics().set_accuracy(accuracy);
    const ObjectId body = table(s);
    const ObjectId ball = s.thing(Shape::sphere(0.5), Vector3(5, 0.5, 0));
    s.run(1);
    EXPECT_LT(s.velocity(body).norm(), 1e-3);
    EXPECT_NEAR(s.at(body).y(), 1.1, 1e-5) << "on springs it sinks by some 1e-4 m";
    EXPECT_NEAR(0.5 - s.at(ball).y(), kSink, 1e-6) << "what has no joints has springs";
  }
}

/// A box with an arm of 0.1 kg that sticks out by 1 m; its joint's limits alone keep it from falling.
JointIndex arm_on_its_limit(Ground& s, JointKind kind, double low, double high) {
  const ObjectId box = s.thing(Shape::box(Vector3(1, 0.2, 1)), Vector3(0, 0.1, 0), 0.4);
  std::shared_ptr<Shape> rod = Shape::box(Vector3(1, 0.1, 0.1));
  rod->set_mass(0.1);
  const ObjectId arm = s.rigid(std::move(rod), Vector3(1, 0.1, 0));
  JointDescription is;
  is.kind = kind;
  is.child = s.index(arm);
  is.parent = s.index(box);
  is.parent_point = Vector3(0.5, 0, 0);
  is.child_point = Vector3(-0.5, 0, 0);
  is.normal = Vector3::UnitZ();
  const JointIndex joint = s.mechanics().link(is, arm);
  JointDrive drive = s.mechanics().drive(joint);
  for (int k = 0; k < axis_count(kind); ++k) drive.low[k] = low, drive.high[k] = high;
  s.mechanics().set_drive(joint, drive);
  return joint;
}

TEST(ContactSpringsInAWorld, LimitsThatJointsRestOnHoldInsideTheStages) {
  const struct {
    JointKind kind;
    double low, high;
  } cases[] = {{JointKind::Revolute, -1, 0}, {JointKind::Revolute, 0, 0}, {JointKind::Ball, 0, 0}};
  for (const auto& [kind, low, high] : cases) {
    Ground s(Rung::Precise, 1.0 / 480);
    const JointIndex joint = arm_on_its_limit(s, kind, low, high);
    s.run(3);
    EXPECT_LT(s.mechanics().velocity(joint).norm(), 1e-9);
    EXPECT_LT(s.mechanics().position(joint).norm(), 1e-6);
    EXPECT_NEAR(s.mechanics().reaction(joint).torque.norm(), 0.1 * 9.81 * 0.5, 1e-4);
    EXPECT_NEAR(s.mechanics().energy().residual, 0, 1e-5);
    for (int i = 0; i < 240; ++i) {
      s.world.step();
      ASSERT_EQ(s.mechanics().counters().sub_steps, 1U) << i;
      ASSERT_EQ(s.mechanics().counters().evaluations, 4U) << "nothing swings: each is a step of Runge-Kutta 4";
    }
  }
}

TEST(ContactSpringsInAWorld, AJointLeavesALimitThatHoldsWhenItIsPulledAway) {
  Ground s(Rung::Precise, 1.0 / 480);
  const JointIndex joint = arm_on_its_limit(s, JointKind::Revolute, -1, 0);
  s.run(1);
  JointDrive drive = s.mechanics().drive(joint);
  drive.force[0] = -2 * 0.1 * 9.81 * 0.5;  // lifts as much as the weight pulls: as if it fell upward
  s.mechanics().set_drive(joint, drive);
  s.run(0.1);
  const double inertia = 0.1 * (1.01 / 12 + 0.25);
  EXPECT_NEAR(s.mechanics().position(joint)[0], -0.5 * 0.1 * 9.81 * 0.5 / inertia * 0.01, 2e-3);
  EXPECT_NEAR(s.mechanics().energy().residual, 0, 1e-4);
}

TEST(ContactSpringsInAWorld, SurfacesAreRigidOnceTheSettingIsOff) {
  for (const Rung rung : {Rung::Precise, Rung::Fast}) {
    Ground s(Rung::Precise, 1.0 / 60);
    const ObjectId ball = s.thing(Shape::sphere(0.5), Vector3(0, 0.5, 0));
    s.run(1);
    EXPECT_GT(s.mechanics().energy().springs, 0);
    Accuracy rigid = accuracy_of(rung);
    rigid.contact_springs = false;
    s.mechanics().set_accuracy(rigid);
    s.run(1);
    EXPECT_EQ(s.mechanics().energy().springs, 0);
    EXPECT_NEAR(s.at(ball).y(), 0.5, kSink) << name_of(rung);
    EXPECT_LT(s.velocity(ball).norm(), 1e-3) << name_of(rung);
    s.world.bodies().set_velocity(s.index(ball), Vector3(0, -1, 0));  // an impact takes place again
    s.run(1.0 / 60);
    EXPECT_GT(s.velocity(ball).y(), 0.2) << name_of(rung);
  }
}

TEST(ContactSpringsInAWorld, ASnapshotGoesOnBitForBit) {
  const auto make = [] {
    auto s = std::make_unique<Ground>(Rung::Precise, 1.0 / 60);
    for (int i = 0; i < 3; ++i) s->thing(Shape::box(Vector3(1, 1, 1)), Vector3(0.1 * i, 0.51 + 1.02 * i, 0.05 * i));
    return s;
  };
  const auto one = make();
  one->run(0.7);
  const auto image = one->world.save(1);
  const auto other = make();
  other->world.load(image.data(), image.size(), 1);
  for (int i = 0; i < 60; ++i) {
    one->world.step();
    other->world.step();
    ASSERT_EQ(one->world.hash(), other->world.hash()) << i;
  }
}

}  // namespace
}  // namespace breve::testing::spring_tests
