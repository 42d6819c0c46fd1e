// The guard of a flat world: unexplained energy, numbers that are not finite, and that quiet scenes give no events.
#include <cmath>

#include "scene.hpp"

namespace breve::testing {
namespace {

constexpr GuardMode kModes[] = {GuardMode::Off, GuardMode::Report, GuardMode::Refine, GuardMode::Rest};

struct Guarded : Flat {
  std::vector<Intervention> all;
  explicit Guarded(GuardMode mode, Rung rung = Rung::Balanced) : Flat(rung) { physics().set_guard(mode); }
  void watch(int steps) {
    for (int i = 0; i < steps; ++i) {
      world.step();
      const auto now = physics().interventions();
      EXPECT_EQ(now.size(), physics().counters().interventions);
      all.insert(all.end(), now.begin(), now.end());
    }
  }
  int count(GuardReason reason, GuardAction action) const {
    return static_cast<int>(std::count_if(
        all.begin(), all.end(), [&](const Intervention& one) { return one.reason == reason && one.action == action; }));
  }
  /// A ball on a spring that a force method makes stiffer within steps, until some time: nobody accounts for that.
  ObjectId stiffened(double until) {
    physics().set_gravity(Vector3::Zero());
    const ObjectId wall = fixed(Shape::box({1, 1, 1}), 0, 0), ball = this->ball(0.5, 3, 0);
    SpringDescription spring;
    spring.a = index(wall);
    spring.b = index(ball);
    spring.length = 2.9;
    spring.strength = 100;
    spring.damping = 0;
    const SpringIndex stiffer = physics().add_spring(spring, ball);
    physics().set_force_method(index(ball), true);
    script.on_force = [this, stiffer, until](ObjectId, double time) {
      SpringDescription is = physics().spring(stiffer);
      constexpr double kSteps = 60;  // in each of which it doubles
      is.strength = 100 * std::exp2(kSteps * time);
      if (time < until) physics().set_spring(stiffer, is);
      return Vector3(Vector3::Zero());
    };
    return ball;
  }
};

TEST(PlanarGuard, EnergyFromNowhereIsAnEventAndMoreSubStepsEndIt) {
  for (const GuardMode mode : kModes) {
    Guarded flat(mode);
    const ObjectId ball = flat.stiffened(0.05);
    const double start = flat.physics().energy().total();
    flat.watch(30);
    EXPECT_EQ(flat.count(GuardReason::Residual, GuardAction::Reported) > 0, mode == GuardMode::Report);
    EXPECT_EQ(flat.count(GuardReason::Residual, GuardAction::Refined) > 0, mode >= GuardMode::Refine);
    EXPECT_EQ(flat.count(GuardReason::Residual, GuardAction::Rested), 0);
    for (const Intervention& one : flat.all) {
      EXPECT_EQ(one.body, ball);
      EXPECT_GT(one.value, 0);
      EXPECT_TRUE(std::isfinite(one.value));
    }
    if (mode == GuardMode::Off) {
      EXPECT_TRUE(flat.all.empty());
    }
    if (mode < GuardMode::Refine) continue;
    EXPECT_LE(flat.all.size(), 4U);
    EXPECT_GT(flat.physics().counters().sub_steps, 4U);
    // What it had gained by then it keeps, and no more.
    const double then = flat.physics().energy().total();
    flat.watch(200);
    EXPECT_LT(flat.physics().energy().total(), 1.5 * then + start);
  }
}

TEST(PlanarGuard, WhatGainsEvenSoIsPutToRest) {
  for (const GuardMode mode : {GuardMode::Refine, GuardMode::Rest}) {
    Guarded flat(mode);
    const ObjectId ball = flat.stiffened(1);
    flat.watch(30);
    EXPECT_EQ(flat.count(GuardReason::Residual, GuardAction::Rested) > 0, mode == GuardMode::Rest);
    EXPECT_TRUE(flat.at(ball).allFinite());
    EXPECT_TRUE(flat.velocity(ball).allFinite());
  }
}

TEST(PlanarGuard, AJointThatOpensIsReportedAsSuch) {
  Guarded flat(GuardMode::Report, Rung::Fast);
  // A weight 1,000 times as heavy as the links of its chain, which lies over a peg: what touches is solved by Box2D's
  // sweeps, and these do not hold it on this rung.
  constexpr double kLength = 0.5;
  constexpr int kLinks = 20;
  flat.fixed(Shape::box({1, 1, 1}), 5 * kLength, -0.55);
  ObjectId last;
  for (int i = 0; i < kLinks; ++i) {
    auto shape = Shape::box({kLength, 0.1, 0.1});
    shape->set_mass(0.1);
    const ObjectId link = flat.rigid(shape, (i + 0.5) * kLength, 0);
    flat.hinge(last, link, last ? Vector3(kLength / 2, 0, 0) : Vector3::Zero(), {-kLength / 2, 0, 0});
    last = link;
  }
  auto heavy = Shape::sphere(0.5);
  heavy->set_mass(100);
  const ObjectId weight = flat.rigid(heavy, kLinks * kLength + 0.5, 0);
  flat.hinge(last, weight, {kLength / 2, 0, 0}, {-0.5, 0, 0});
  flat.watch(300);
  EXPECT_GT(flat.count(GuardReason::OpenJoint, GuardAction::Reported), 0);
  EXPECT_EQ(flat.count(GuardReason::NoSolution, GuardAction::Reported), 0);
  EXPECT_EQ(words_for(GuardReason::OpenJoint), "a joint opens");
}

TEST(PlanarGuard, ABodyWhoseNumbersAreNoneRestsWhereItWas) {
  for (const GuardMode mode : {GuardMode::Report, GuardMode::Refine, GuardMode::Rest}) {
    Guarded flat(mode);
    flat.physics().set_gravity(Vector3::Zero());
    const ObjectId ball = flat.ball(0.5, 1, 2), other = flat.ball(0.5, 0, 20);
    flat.set_velocity(other, {1, 0, 0});
    flat.bodies().set_force(flat.index(ball), {1e300, 0, 0});
    flat.watch(3);
    EXPECT_GT(flat.count(GuardReason::NotFinite, GuardAction::Rested), 0);
    EXPECT_EQ(flat.at(ball), Vector3(1, 2, 0));
    EXPECT_EQ(flat.velocity(ball), Vector3(0, 0, 0));
    EXPECT_NEAR(flat.at(other).x(), 0.05, 1e-4);
    flat.bodies().set_force(flat.index(ball), {0, 0, 0});
    flat.set_velocity(ball, {1, 0, 0});
    flat.run(1);
    EXPECT_NEAR(flat.at(ball).x(), 2, 1e-4);
  }
}

TEST(PlanarGuard, OthersAndTheLedgerGoOnWhileABodyIsNotFinite) {
  Guarded flat(GuardMode::Rest);
  flat.physics().set_gravity(Vector3::Zero());
  const ObjectId ball = flat.ball(0.5, 1, 2), near = flat.ball(0.5, 2.2, 2), far = flat.ball(0.5, 0, 20);
  for (const ObjectId other : {near, far}) flat.set_velocity(other, {1, 0, 0});
  flat.bodies().set_force(flat.index(ball), {1e300, 0, 0});
  flat.watch(60);
  EXPECT_GT(flat.count(GuardReason::NotFinite, GuardAction::Rested), 0);
  EXPECT_EQ(flat.at(ball), Vector3(1, 2, 0));
  EXPECT_NEAR(flat.at(near).x(), 3.2, 1e-3);
  EXPECT_NEAR(flat.at(far).x(), 1, 1e-3);
  EXPECT_TRUE(std::isfinite(flat.physics().energy().script_work));
  EXPECT_TRUE(std::isfinite(flat.physics().energy().residual));
}

TEST(PlanarGuard, AJointToTheWorldHoldsAgainAfterNumbersThatWereNotFinite) {
  Guarded flat(GuardMode::Rest);
  const ObjectId bob = flat.ball(0.5, 0, 0);
  const JointIndex hinge = flat.hinge({}, bob, {0, 1, 0}, {0, 1, 0});
  flat.bodies().set_force(flat.index(bob), {1e300, 0, 0});
  flat.watch(2);
  EXPECT_GT(flat.count(GuardReason::NotFinite, GuardAction::Rested), 0);
  flat.bodies().set_force(flat.index(bob), {0, 0, 0});
  flat.all.clear();
  flat.set_velocity(bob, {1, 0, 0});
  flat.watch(60);
  EXPECT_TRUE(flat.all.empty());
  EXPECT_NEAR((flat.at(bob) - Vector3(0, 1, 0)).norm(), 1, 0.01);
  EXPECT_GT(std::abs(flat.physics().position(hinge)[0]), 0.05);
}

TEST(PlanarGuard, AVelocityBeyondSinglePrecisionIsStoppedInARestoredWorldAlike) {
  Guarded flat(GuardMode::Rest);
  const ObjectId ball = flat.ball(0.5, 1, 2);
  flat.set_velocity(ball, {-1e300, 0, 0});
  flat.bodies().set_rotational_velocity(flat.index(ball), {0, 0, 1e300});
  flat.hinge({}, ball, {1, 2, 0}, {0, 0, 0});  // Box2D has it now
  const auto image = flat.world.save(1);
  Guarded other(GuardMode::Rest);
  other.world.load(image.data(), image.size(), 1);
  for (int i = 0; i < 10; ++i) {
    flat.world.step();
    other.world.step();
    ASSERT_EQ(flat.world.hash(), other.world.hash()) << "step " << i;
  }
  EXPECT_EQ(flat.velocity(ball), Vector3(0, 0, 0));
}

TEST(PlanarGuard, WithoutItANumberThatIsNoneIsAnErrorAndTheWorldGoesOn) {
  Guarded flat(GuardMode::Off);
  const ObjectId ball = flat.ball(0.5, 1, 2);
  flat.bodies().set_force(flat.index(ball), {1e300, 0, 0});
  EXPECT_THROW(flat.world.step(), Error);
  EXPECT_EQ(flat.at(ball), Vector3(1, 2, 0));
  flat.bodies().set_force(flat.index(ball), {0, 0, 0});
  flat.run(0.5);
  EXPECT_TRUE(flat.at(ball).allFinite());
}

TEST(PlanarGuard, RestingScenesGiveNoEvents) {
  for (const Rung rung : {Rung::Fast, Rung::Balanced, Rung::Precise}) {
    Guarded flat(GuardMode::Report, rung);
    flat.ground();
    for (int i = 0; i < 5; ++i) flat.box(1, 1, 0, 0.5 + i);
    for (int i = 0; i < 20; ++i) flat.material(flat.ball(0.3, 5 + i, 1 + i % 3), 0.5, 0.1 * (i % 11));
    ObjectId last;
    for (int i = 0; i < 4; ++i) {
      const ObjectId link = flat.box(1, 0.2, -19.5 + i, 10);
      flat.hinge(last, link, last ? Vector3(0.5, 0, 0) : Vector3(-20, 10, 0), {-0.5, 0, 0});
      last = link;
    }
    flat.watch(600);
    EXPECT_TRUE(flat.all.empty()) << words_for(flat.all.front().reason) << " on " << name_of(rung) << " at step "
                                  << flat.all.front().iteration;
  }
}

TEST(PlanarGuard, WhatItKnowsIsInAnImage) {
  Guarded live(GuardMode::Rest);
  live.stiffened(0.05);
  live.watch(2);
  const auto image = live.world.save(1);
  Guarded other(GuardMode::Off);
  other.stiffened(0.05);
  other.world.load(image.data(), image.size(), 1);
  for (int i = 0; i < 60; ++i) {
    live.world.step();
    other.world.step();
    ASSERT_EQ(live.world.hash(), other.world.hash()) << i;
    ASSERT_EQ(live.physics().interventions().size(), other.physics().interventions().size()) << i;
  }
}

}  // namespace
}  // namespace breve::testing
