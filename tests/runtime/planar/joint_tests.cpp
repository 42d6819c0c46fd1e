// Joints in a flat world against closed forms: limits that bounce, and links whose velocity is set.
#include "runtime/base/error.hpp"
#include "scene.hpp"

namespace breve::testing {
namespace {

constexpr double kG = 9.81;
constexpr double kSingle = 1e-5;  // what single precision leaves of a number after some operations

constexpr Rung kRungs[] = {Rung::Fast, Rung::Balanced, Rung::Precise, Rung::Conserving};

/// A position that goes up and down between two ends at one speed, starting upward.
double between(double at, double low, double high) {
  const double way = high - low, phase = std::fmod(at - low, 2 * way);
  return low + (phase < way ? phase : 2 * way - phase);
}

struct Limited : Flat {
  using Flat::Flat;
  void limit(JointIndex joint, double low, double high, double e) {
    JointDrive drive = physics().drive(joint);
    drive.low[0] = low;
    drive.high[0] = high;
    drive.limit_restitution = e;
    physics().set_drive(joint, drive);
  }
  JointIndex slider(ObjectId parent, ObjectId child, const Vector3& along) {
    JointDescription is;
    is.kind = JointKind::Prismatic;
    is.parent = parent ? index(parent) : kNoBody;
    is.child = index(child);
    is.normal = along;
    return physics().link(is, child);
  }
  double mass(ObjectId id) { return bodies().mass(index(id)); }
  double inertia(ObjectId id) { return bodies().mass_properties(index(id)).inertia(2, 2); }
  double spin(ObjectId id) { return bodies().rotational_velocity(index(id)).z(); }
};

TEST(PlanarJoints, WhatTouchedDoesNotMeetAnyMoreOnceAJointConnectsIt) {
  for (const Rung rung : {Rung::Balanced, Rung::Precise}) {
    Flat flat(rung), restored(rung);
    flat.physics().set_gravity(Vector3::Zero());
    const ObjectId a = flat.box(1, 1, 0, 0), b = flat.box(1, 1, 1.002, 0);
    flat.set_velocity(a, {0.5, 0, 0});
    flat.run(0.1);
    flat.hinge(a, b, {0.5, 0.5, 0}, {-0.5, 0.5, 0});
    flat.set_velocity(a, {0, 1, 0});
    flat.set_velocity(b, {-3, -1, 0});
    const auto image = flat.world.save(1);
    restored.world.load(image.data(), image.size(), 1);
    for (int i = 0; i < 30; ++i) {
      flat.world.step();
      restored.world.step();
      ASSERT_EQ(flat.world.hash(), restored.world.hash()) << name_of(rung) << " step " << i;
    }
    EXPECT_EQ(flat.physics().energy().friction_loss, 0);
  }
}

TEST(PlanarStops, AHingeAndASliderRunBetweenElasticLimitsForEver) {
  for (const Rung rung : kRungs) {
    Limited flat(rung);
    flat.physics().set_gravity(Vector3::Zero());
    const ObjectId bar = flat.box(1, 0.2, 50, 0), cart = flat.box(1, 1, 0, 0);
    const JointIndex hinge = flat.hinge({}, bar, {50, 0, 0}, {0, 0, 0});
    const JointIndex slider = flat.slider({}, cart, {0.6, 0.8, 0});
    flat.limit(hinge, -0.5, 0.3, 1);
    flat.limit(slider, -0.4, 1, 1);
    flat.physics().set_velocity(hinge, {3, 0, 0});
    flat.physics().set_velocity(slider, {2, 0, 0});
    const double start = flat.physics().energy().total();
    // Where impacts are not located they are met at the end of a step.
    const double late = rung == Rung::Fast ? 1.0 / 60 : 0;
    for (int i = 1; i <= 600; ++i) {
      flat.world.step();
      const double t = i / 60.0, angle = flat.physics().position(hinge)[0], way = flat.physics().position(slider)[0];
      ASSERT_NEAR(flat.physics().energy().total(), start, 1e-4 * start) << i;
      ASSERT_GT(angle, -0.5 - 1e-4 - 3 * late);
      ASSERT_LT(angle, 0.3 + 1e-4 + 3 * late);
      ASSERT_GT(way, -0.4 - 1e-4 - 2 * late);
      ASSERT_LT(way, 1 + 1e-4 + 2 * late);
      if (rung == Rung::Fast) continue;
      ASSERT_NEAR(angle, between(3 * t, -0.5, 0.3), 0.005) << i;
      ASSERT_NEAR(way, between(2 * t, -0.4, 1), 0.005) << i;
    }
    EXPECT_NEAR(flat.physics().energy().limit_loss, 0, 1e-4 * start);
    EXPECT_NEAR(flat.physics().energy().residual, 0, 1e-3 * start);
  }
}

TEST(PlanarStops, EveryReboundKeepsTheSquareOfTheRestitutionAndTheLedgerSaysWhereTheRestWent) {
  Limited flat;
  flat.physics().set_gravity(Vector3::Zero());
  const ObjectId cart = flat.box(1, 1, 0, 0);
  const JointIndex slider = flat.slider({}, cart, {1, 0, 0});
  flat.limit(slider, -1, 1, 0.8);
  flat.physics().set_velocity(slider, {4, 0, 0});
  const double start = flat.physics().energy().kinetic;
  // Legs of 1, 2, 2, 2 m at 4, 3.2, 2.56, 2.048 m/s: three rebounds by 1.66 s, the fourth at 2.63 s.
  flat.run(2);
  const double kept = std::pow(0.8, 6);
  EXPECT_NEAR(flat.physics().velocity(slider)[0], -4 * 0.512, 4 * kSingle);
  EXPECT_NEAR(flat.physics().position(slider)[0], 1 - 2.048 * (2 - 0.25 - 2 / 3.2 - 2 / 2.56), 1e-3);
  EXPECT_NEAR(flat.physics().energy().kinetic, kept * start, 1e-4 * start);
  EXPECT_NEAR(flat.physics().energy().limit_loss, (1 - kept) * start, 1e-4 * start);
  EXPECT_NEAR(flat.physics().energy().residual, 0, 1e-4 * start);
}

TEST(PlanarStops, TwoFreeBodiesReboundAboutTheirCentreOfMass) {
  Limited flat;
  flat.physics().set_gravity(Vector3::Zero());
  const ObjectId light = flat.box(1, 1, 0, 0), heavy = flat.box(2, 2, 0, 0);
  const JointIndex slider = flat.slider(light, heavy, {1, 0, 0});
  flat.physics().set_self_collisions(flat.index(light), false);
  flat.limit(slider, -3, 3, 0.5);
  flat.set_velocity(light, {-6, 0, 0});
  flat.bodies().set_velocity(flat.index(heavy), {0, 0, 0});
  flat.bodies().set_rotational_velocity(flat.index(heavy), {0, 0, 0});
  flat.physics().set_velocity(slider, {-6, 0, 0});
  const double m = flat.mass(light), n = flat.mass(heavy);
  const double p = m * flat.velocity(light).x() + n * flat.velocity(heavy).x();
  const double rate = flat.velocity(heavy).x() - flat.velocity(light).x();
  ASSERT_NEAR(rate, 6, 1e-4);
  flat.run(0.8);  // 3 m at 6 m/s, and back at half of it
  EXPECT_NEAR(flat.velocity(heavy).x() - flat.velocity(light).x(), -3, 3 * kSingle);
  EXPECT_NEAR(m * flat.velocity(light).x() + n * flat.velocity(heavy).x(), p, (m + n) * 6 * kSingle);
  EXPECT_NEAR(flat.velocity(light).y(), 0, 1e-4);
}

TEST(PlanarStops, AWeightOnAStopRisesToTheSquareOfItsRestitution) {
  for (const double e : {1.0, 0.7}) {
    Limited flat(Rung::Precise, 1.0 / 240);
    const ObjectId lift = flat.box(0.5, 0.5, 0, 0);
    const JointIndex slider = flat.slider({}, lift, {0, -1, 0});  // positive upward
    flat.limit(slider, -1, 10, e);
    double last = 0, top = -1, wanted = 1;
    int bounces = 0;
    for (int i = 0; i < 240 * 10 && bounces < 3; ++i) {
      flat.world.step();
      const double v = flat.physics().velocity(slider)[0];
      if (last < 0 && v > 0) {
        ++bounces;
        wanted *= e * e;
      }
      if (bounces > 0 && v > 0.5) {
        top = flat.physics().position(slider)[0] + 1 + v * v / (2 * kG);
        ASSERT_NEAR(top, wanted, 0.01 * wanted) << "after bounce " << bounces << " with e = " << e;
      }
      last = v;
    }
    EXPECT_EQ(bounces, 3);
    if (e < 1) {
      EXPECT_GT(flat.physics().energy().limit_loss, 0.7 * (1 - std::pow(e, 6)) * flat.mass(lift) * kG);
    }
  }
}

TEST(PlanarStops, AnInelasticLimitStillStopsAndWhatBouncesComesToRest) {
  for (const double e : {0.0, 0.5}) {
    Limited flat;
    const ObjectId bar = flat.box(2, 0.2, 1, 0);
    const JointIndex hinge = flat.hinge({}, bar, {0, 0, 0}, {-1, 0, 0});
    flat.limit(hinge, -0.5, 0.5, e);
    flat.run(10);
    EXPECT_NEAR(flat.physics().position(hinge)[0], 0.5, 0.01);
    EXPECT_NEAR(flat.physics().velocity(hinge)[0], 0, 1e-3);
    EXPECT_TRUE(flat.physics().interventions().empty());
  }
}

TEST(PlanarStops, AChainThatRunsIntoItsLimitsAgainAndAgainGainsNothing) {
  for (const Rung rung : kRungs) {
    Limited flat(rung);
    flat.physics().set_gravity(Vector3::Zero());
    std::vector<JointIndex> joints;
    ObjectId last;
    for (int i = 0; i < 6; ++i) {
      const ObjectId link = flat.box(1, 0.2, i + 0.5, 0);
      if (last) joints.push_back(flat.hinge(last, link, {0.5, 0, 0}, {-0.5, 0, 0}));
      last = link;
    }
    for (const JointIndex joint : joints) flat.limit(joint, -0.4, 0.4, 1);
    flat.physics().set_velocity(joints[0], {2, 0, 0});
    flat.physics().set_velocity(joints[3], {-3, 0, 0});
    const double start = flat.physics().energy().total();
    double most = 0;
    for (int i = 0; i < 600; ++i) {
      flat.world.step();
      most = std::max(most, flat.physics().energy().total());
    }
    EXPECT_LT(most, 1.001 * start);
    EXPECT_GT(flat.physics().energy().total(), 0.85 * start);
    EXPECT_NEAR(flat.physics().energy().residual, 0, 1e-3 * start);
    EXPECT_GE(flat.physics().energy().limit_loss, 0);
  }
}

TEST(PlanarStops, BouncingLimitsAreInAnImage) {
  const auto scene = [](Limited& flat) {
    const ObjectId bar = flat.box(2, 0.2, 1, 0);
    const JointIndex hinge = flat.hinge({}, bar, {0, 0, 0}, {-1, 0, 0});
    flat.limit(hinge, -0.5, 0.5, 0.9);
  };
  Limited live, other;
  scene(live);
  scene(other);
  for (int i = 0; i < 200; ++i) {
    live.world.step();
    if (i % 7 == 0) {
      const auto image = live.world.save(1);
      other.world.load(image.data(), image.size(), 1);
    } else {
      other.world.step();
    }
    ASSERT_EQ(live.world.hash(), other.world.hash()) << i;
  }
}

TEST(PlanarStops, AChainThatBouncesOnTheGroundGainsNothingInItsImpacts) {
  for (const Rung rung : kRungs) {
    Limited flat(rung);
    flat.material(flat.ground(), 0.3, 1);
    ObjectId last;
    for (int i = 0; i < 6; ++i) {
      const ObjectId link = flat.box(1, 0.2, i + 0.5, 3);
      flat.material(link, 0.3, 1);
      if (last) flat.hinge(last, link, {0.5, 0, 0}, {-0.5, 0, 0});
      last = link;
    }
    flat.bodies().set_rotational_velocity(flat.index(last), {0, 0, 5});
    double lost = 0;
    flat.world.step();
    const double start = flat.physics().energy().total();
    double most = 0;
    for (int i = 0; i < 1200; ++i) {
      flat.world.step();
      const double now = flat.physics().energy().contact_loss + flat.physics().energy().friction_loss;
      ASSERT_GT(now, lost - 1e-5 * start) << i << " on rung " << static_cast<int>(rung);
      lost = now;
      most = std::max(most, flat.physics().energy().total());
    }
    EXPECT_LT(most, 1.001 * start);
  }
}

// --- strikes --------------------------------------------------------------------------------------------------------

/// Two equal rods in a row, joined end to end, at rest without gravity.
struct Rods : Limited {
  static constexpr double l = 1;
  ObjectId a, b;
  double m, i;
  Rods() {
    physics().set_gravity(Vector3::Zero());
    a = box(l, 0.1, 0, 0);
    b = box(l, 0.1, l, 0);
    hinge(a, b, {l / 2, 0, 0}, {-l / 2, 0, 0});
    m = mass(a);
    i = inertia(a);
  }
};

TEST(PlanarStrikes, ALinkWhoseVelocityIsSetIsStruckAndTheOtherAnswers) {
  Rods s;
  constexpr double v = 2;
  s.set_velocity(s.a, {0, v, 0});
  s.physics().take_changes();
  // P on a's centre and J in the joint: v - J l^2 / (4 I) = J / m + J l^2 / (4 I).
  const double j = v / (1 / s.m + s.l * s.l / (2 * s.i));
  EXPECT_EQ(s.velocity(s.a), Vector3(0, v, 0));
  EXPECT_NEAR(s.spin(s.a), -j * s.l / (2 * s.i), v * kSingle);
  EXPECT_NEAR(s.velocity(s.b).y(), j / s.m, v * kSingle);
  EXPECT_NEAR(s.velocity(s.b).x(), 0, v * kSingle);
  EXPECT_NEAR(s.spin(s.b), -j * s.l / (2 * s.i), v * kSingle);
  // Half of what was asked times the impulse is the work.
  const double impulse = s.m * v + j;
  EXPECT_NEAR(s.physics().energy().kinetic, 0.5 * impulse * v, impulse * v * kSingle);
  EXPECT_NEAR(s.physics().energy().script_work, 0.5 * impulse * v, impulse * v * kSingle);
  EXPECT_NEAR(s.physics().energy().residual, 0, impulse * v * kSingle);
}

TEST(PlanarStrikes, ALinkWhoseSpinIsSetIsRotatedAndTheOtherAnswers) {
  Rods s;
  constexpr double w = 3;
  s.bodies().set_rotational_velocity(s.index(s.a), {0, 0, w});
  s.physics().take_changes();
  const double j = w * s.l / 2 / (2 / s.m + s.l * s.l / (4 * s.i));
  EXPECT_EQ(s.spin(s.a), w);
  EXPECT_NEAR(s.velocity(s.a).y(), -j / s.m, w * kSingle);
  EXPECT_NEAR(s.velocity(s.b).y(), j / s.m, w * kSingle);
  EXPECT_NEAR(s.spin(s.b), -j * s.l / (2 * s.i), w * kSingle);
}

TEST(PlanarStrikes, LinksThatAreSetTogetherGetWhatTheyWereSetTo) {
  Rods s;
  for (const ObjectId id : {s.b, s.a}) {
    s.set_velocity(id, {0, 2, 0});
    s.bodies().set_rotational_velocity(s.index(id), {0, 0, 0.5});
    s.bodies().set_rotational_velocity(s.index(id), {0, 0, 0});
  }
  s.run(1);
  EXPECT_NEAR((s.at(s.a) - Vector3(0, 2, 0)).norm(), 0, 1e-4);
  EXPECT_NEAR((s.at(s.b) - Vector3(s.l, 2, 0)).norm(), 0, 1e-4);
  EXPECT_NEAR(s.spin(s.b), 0, 1e-5);
}

TEST(PlanarStrikes, AJointAllowsWhatItAllows) {
  // A rod that hangs on the world can only turn: of a velocity along it nothing is left.
  Limited flat;
  flat.physics().set_gravity(Vector3::Zero());
  const ObjectId rod = flat.box(1, 0.1, 0.5, 0);
  flat.hinge({}, rod, {0, 0, 0}, {-0.5, 0, 0});
  flat.set_velocity(rod, {3, 2, 0});
  flat.physics().take_changes();
  EXPECT_NEAR((flat.velocity(rod) - Vector3(0, 2, 0)).norm(), 0, kSingle);
  EXPECT_NEAR(flat.spin(rod), 4, 4 * kSingle);
}

TEST(PlanarStrikes, ALinkThatWasJustLinkedToAMovingOneIsStruckAsTheJointLetsItMove) {
  Limited flat;
  flat.physics().set_gravity(Vector3::Zero());
  const Vector3 v(1, 0.5, 0);
  const ObjectId a = flat.box(1, 0.2, 0, 0), b = flat.box(1, 0.2, 1, 0);
  flat.set_velocity(a, v);
  flat.hinge(a, b, {0.5, 0, 0}, {-0.5, 0, 0});
  flat.set_velocity(b, v);
  flat.physics().take_changes();
  // What the hinge left of a's motion, and the blow that brings b to its velocity, add up to one translation.
  for (const ObjectId link : {a, b}) {
    EXPECT_NEAR((flat.velocity(link) - v).norm(), 0, 10 * kSingle);
    EXPECT_NEAR(flat.spin(link), 0, 10 * kSingle);
  }
}

TEST(PlanarStrikes, WhatWasSetIsTakenOnceWhetherOrNotAnImageWasTaken) {
  Rods live;
  live.run(0.1);
  live.set_velocity(live.b, {1, 2, 0});
  const auto image = live.world.save(1);
  Rods other;
  other.world.load(image.data(), image.size(), 1);
  for (int i = 0; i < 30; ++i) {
    live.world.step();
    other.world.step();
    ASSERT_EQ(live.world.hash(), other.world.hash()) << i;
  }
  EXPECT_GT(live.velocity(live.a).norm(), 0.1);
}

TEST(PlanarStrikes, AJointThatIsGivenASpeedMovesAllThatHangsOnItAndNothingElse) {
  Limited flat;
  flat.physics().set_gravity(Vector3::Zero());
  std::vector<ObjectId> links;
  std::vector<JointIndex> joints;
  for (int i = 0; i < 4; ++i) {
    links.push_back(flat.box(1, 0.1, i, 0));
    if (i > 0) joints.push_back(flat.hinge(links[links.size() - 2], links.back(), {0.5, 0, 0}, {-0.5, 0, 0}));
  }
  flat.physics().set_velocity(joints[1], {-2, 0, 0});  // the child turns by +2 rad/s
  EXPECT_EQ(flat.velocity(links[0]), Vector3(0, 0, 0));
  EXPECT_EQ(flat.velocity(links[1]), Vector3(0, 0, 0));
  EXPECT_NEAR((flat.velocity(links[2]) - Vector3(0, 1, 0)).norm(), 0, kSingle);
  EXPECT_NEAR((flat.velocity(links[3]) - Vector3(0, 3, 0)).norm(), 0, kSingle);
  EXPECT_NEAR(flat.spin(links[3]), 2, kSingle);
  EXPECT_NEAR(flat.physics().velocity(joints[0])[0], 0, kSingle);
  EXPECT_NEAR(flat.physics().velocity(joints[1])[0], -2, kSingle);
  EXPECT_NEAR(flat.physics().velocity(joints[2])[0], 0, kSingle);
  EXPECT_NEAR(flat.physics().energy().residual, 0, 1e-4);
}

TEST(PlanarStrikes, AnAssemblyThatIsGivenAVelocityMovesAsOneSolid) {
  Rods s;
  s.physics().set_assembly_velocity(s.index(s.b), {1, 2, 0}, {0, 0, 3});
  EXPECT_EQ(s.velocity(s.b), Vector3(1, 2, 0));
  EXPECT_NEAR((s.velocity(s.a) - Vector3(1, 2 - 3 * s.l, 0)).norm(), 0, 5 * kSingle);
  EXPECT_NEAR(s.spin(s.a), 3, 3 * kSingle);
}

TEST(PlanarStrikes, AnAssemblyThatIsRefusedAMotionOrAPoseKeepsItsOwn) {
  Rods s;
  s.physics().set_assembly_velocity(s.index(s.b), {1, 2, 0}, {0, 0, 3});
  const Vector3 velocity = s.velocity(s.a), location = s.bodies().location(s.index(s.b));
  EXPECT_THROW(s.physics().set_assembly_velocity(s.index(s.b), {4, 5, 0}, {0, 6, 3}), Error);
  EXPECT_THROW(s.physics().set_assembly_velocity(s.index(s.b), {4, 5, 6}, {0, 0, 3}), Error);
  const Quaternion tilted(0.8, 0.6, 0, 0);
  EXPECT_THROW(s.physics().move_assembly(s.index(s.b), location + Vector3(1, 1, 0), tilted), Error);
  EXPECT_EQ(s.velocity(s.b), Vector3(1, 2, 0));
  EXPECT_EQ(s.velocity(s.a), velocity);
  EXPECT_EQ(s.bodies().location(s.index(s.b)), location);
}

}  // namespace
}  // namespace breve::testing
