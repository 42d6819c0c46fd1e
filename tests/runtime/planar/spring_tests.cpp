// Springs of a flat world: no stiffness gives energy, alone, in networks and in joints.
#include "scene.hpp"

namespace breve::testing {
namespace {

constexpr Rung kSpringRungs[] = {Rung::Fast, Rung::Balanced, Rung::Precise};

/// What single precision and the bends of paths may add to the energy, as a part of it.
double most_gain(Rung rung) { return rung == Rung::Precise ? 0.001 : 0.01; }

struct Sprung : Flat {
  explicit Sprung(Rung rung) : Flat(rung) { physics().set_gravity(Vector3::Zero()); }
  void spring(ObjectId a, ObjectId b, double length, double strength, double damping = 0) {
    SpringDescription is;
    is.a = index(a);
    is.b = index(b);
    is.length = length;
    is.strength = strength;
    is.damping = damping;
    physics().add_spring(is, b);
  }
  /// Four balls of a square, each on springs with the three others, stretched and out of shape.
  void square(double strength, double damping = 0) {
    std::vector<ObjectId> balls;
    for (int i = 0; i < 4; ++i) {
      const double angle = i * M_PI / 2;
      balls.push_back(ball(0.1, 1.01 * std::cos(angle) + 0.02 * i, 1.01 * std::sin(angle)));
      for (int j = 0; j < i; ++j) spring(balls[j], balls[i], (i - j) % 2 == 1 ? std::sqrt(2.0) : 2, strength, damping);
    }
  }
  /// The most energy in some time, as a part of what there was.
  double rise(double seconds) {
    const double start = physics().energy().total();
    double most = start;
    for (double t = 0; t < seconds; t += world.iteration_step()) {
      world.step();
      most = std::max(most, physics().energy().total());
    }
    return most / start - 1;
  }
};

TEST(PlanarSprings, ASpringBetweenTwoBallsKeepsItsEnergy) {
  for (const Rung rung : kSpringRungs)
    for (const double strength : {300.0, 3000.0, 100000.0, 1e6}) {
      Sprung flat(rung);
      flat.spring(flat.ball(0.1, 0, 0), flat.ball(0.1, 2.1, 0), 2, strength);
      EXPECT_LT(flat.rise(3), most_gain(rung)) << name_of(rung) << ", " << strength << " N/m";
      EXPECT_EQ(flat.physics().counters().interventions, 0U);
    }
}

TEST(PlanarSprings, ANetworkOfStiffSpringsGainsNothing) {
  for (const Rung rung : kSpringRungs)
    for (const double strength : {100.0, 8000.0, 100000.0}) {
      Sprung flat(rung);
      flat.square(strength);
      EXPECT_LT(flat.rise(3), most_gain(rung)) << name_of(rung) << ", " << strength << " N/m";
    }
}

TEST(PlanarSprings, ManySpringsSideBySideActAsOne) {
  constexpr int kCount = 300;
  for (const Rung rung : kSpringRungs) {
    Sprung flat(rung), one(rung);
    const ObjectId ball = flat.ball(0.1, 2.1, 0), single = one.ball(0.1, 2.1, 0);
    const ObjectId wall = flat.fixed(Shape::box({1, 1, 1}), 0, 0), other = one.fixed(Shape::box({1, 1, 1}), 0, 0);
    for (int i = 0; i < kCount; ++i) flat.spring(wall, ball, 2, 1000);
    one.spring(other, single, 2, kCount * 1000);
    EXPECT_LT(flat.rise(1), most_gain(rung));
    one.run(1);
    EXPECT_NEAR(flat.at(ball).x(), one.at(single).x(), 1e-3);
  }
}

TEST(PlanarSprings, ASpringInAHingeKeepsItsEnergy) {
  for (const Rung rung : kSpringRungs)
    for (const double stiffness : {30.0, 300.0, 3000.0, 30000.0}) {
      Sprung flat(rung);
      const ObjectId rod = flat.box(2, 0.1, 0, 0);
      JointDrive drive;
      drive.stiffness = stiffness;
      drive.rest[0] = 0.5;
      flat.physics().set_drive(flat.hinge({}, rod, {0, 0, 0}, {0, 0, 0}), drive);
      EXPECT_LT(flat.rise(3), most_gain(rung)) << name_of(rung) << ", " << stiffness << " N m/rad";
    }
}

TEST(PlanarSprings, ANetworkThatIsDampedToRestGivesNoEvents) {
  for (const Rung rung : kSpringRungs) {
    Sprung flat(rung);
    flat.physics().set_guard(GuardMode::Rest);
    flat.square(8000, 20);
    std::size_t events = 0;
    for (int i = 0; i < 300; ++i) {
      flat.world.step();
      events += flat.physics().interventions().size();
    }
    EXPECT_EQ(events, 0U) << name_of(rung);
    EXPECT_LT(flat.physics().energy().total(), 1e-6);
  }
}

}  // namespace
}  // namespace breve::testing
