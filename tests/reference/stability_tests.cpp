// Hard scenes through breve.h with the bounds promised for them, on `balanced` at an outer step of 1/60 s with the
// guard on `report`, unless a test says otherwise. Those that take long are in endurance_tests.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "creatures.hpp"
#include "scenes.hpp"

namespace breve::reference {
namespace {

constexpr double kStep = 1.0 / 60;

struct Hard : World {
  explicit Hard(breve_rung rung = BREVE_RUNG_BALANCED, double step = kStep) : World(step, rung) {
    set_guard(BREVE_GUARD_REPORT);
  }
  void print(const char* name) const {
    std::printf("  %-26s %.1f sub-steps a step (at most %lu), %lu interventions\n", name, toll().per_iteration(),
                toll().most, toll().interventions);
  }
};

/// What fell on a stop with e = 1 again and again, and how high it came.
struct Bounces {
  int impacts = 0;
  double gained = 0, apex = 0, lowest = 0;  // energy by m g l (half of the length), positions by the first one
};

constexpr double kBounced = 0.1;  // m, at whose pace things fall at a step of 1/60 s

/// A joint with its stop at zero and from `start` at rest, of something `length` large, stepped at its own pace.
/// @param seconds  that it would take if it were kBounced large
Bounces bounce(Hard& world, breve_object joint, double length, double start, bool stop, double seconds) {
  breve_drive drive = world.drive(joint);
  if (stop) drive.low[0] = 0, drive.high[0] = INFINITY;
  drive.limit_restitution = 1;
  world.set_drive(joint, drive);
  world.set_joint(joint, start, 0);
  const double begin = world.mechanical();
  Bounces out;
  double before = 0;
  world.run(seconds * std::sqrt(length / kBounced), [&] {
    const breve_joint_info info = world.read(joint);
    // It came down and goes up again: it struck the stop in between.
    if (before < 0 && info.velocity[0] > 0) ++out.impacts;
    before = info.velocity[0];
    out.gained = std::max(out.gained, (world.mechanical() - begin) / (9.81 * 0.5 * length));
    out.apex = std::max(out.apex, info.position[0] / start);
    out.lowest = std::min(out.lowest, info.position[0] / start);
  });
  EXPECT_EQ(world.toll().interventions, 0U);
  return out;
}

/// A pendulum of 1 kg whose rod is as long as that, from half a radian.
Bounces swing_on_a_stop(breve_rung rung, double length, bool stop) {
  Hard world(rung, kStep * std::sqrt(length / kBounced));
  return bounce(world, hang(world, {length}, {1}).joints[0], length, 0.5, stop, 270);
}

/// The same seen in steps of time that are as large by their period, so that bounds hold at every size.
void expect_no_apex_higher(double length) {
  for (const breve_rung rung : {BREVE_RUNG_BALANCED, BREVE_RUNG_REFERENCE}) {
    const Bounces with = swing_on_a_stop(rung, length, true), without = swing_on_a_stop(rung, length, false);
    std::printf("  %g m, %d impacts: energy %+.1e of m g l, apex %+.1e; without a stop %+.1e\n", length, with.impacts,
                with.gained, with.apex - 1, without.gained);
    EXPECT_GE(with.impacts, 1000);
    // What the integrator gains is not the stop's.
    EXPECT_LE(with.gained, 1.01 * without.gained + 1e-12);
    EXPECT_LE(with.apex, 1 + 2e-9);
    EXPECT_GE(with.lowest, -2e-6);
    EXPECT_LE(without.lowest, -0.99);
  }
}

TEST(Stability, AThousandImpactsOnAStopAddNoEnergy) { expect_no_apex_higher(kBounced); }
TEST(Stability, NorDoTheyForAPendulumOfAMillimetre) { expect_no_apex_higher(1e-3); }
TEST(Stability, NorDoTheyForAPendulumOfAKilometre) { expect_no_apex_higher(1e3); }

/// A joint whose positions are lengths: what is small by an angle is not by a millimetre.
TEST(Stability, AThousandImpactsOfASliderAddNoEnergyAtAnySize) {
  for (const breve_rung rung : {BREVE_RUNG_BALANCED, BREVE_RUNG_REFERENCE}) {
    for (const double length : {1e-3, 1e3}) {
      Hard world(rung, kStep * std::sqrt(length / kBounced));
      Hinge slide;
      slide.kind = BREVE_JOINT_PRISMATIC;
      slide.child = world.body(sphere(0.1 * length, 1), Vector3::Zero());
      slide.normal = -Vector3::UnitY();
      const Bounces out = bounce(world, world.join(slide), length, length, true, 300);
      std::printf("  slider of %g m, %d impacts: energy %+.1e of m g l, apex %+.1e\n", length, out.impacts, out.gained,
                  out.apex - 1);
      EXPECT_GE(out.impacts, 1000);
      EXPECT_LE(out.gained, 1e-12);
      EXPECT_LE(out.apex, 1 + 1e-9);
      EXPECT_GE(out.apex, 1 - 1e-5);
      EXPECT_GE(out.lowest, -1e-6);
    }
  }
}

TEST(Stability, StiffSpringsInJointsAddNoEnergy) {
  for (const breve_rung rung : {BREVE_RUNG_FAST, BREVE_RUNG_BALANCED, BREVE_RUNG_PRECISE, BREVE_RUNG_CONSERVING}) {
    Hard world(rung);
    world.set_gravity(Vector3::Zero());
    const Chain chain = hang(world, {1}, {1});
    breve_drive drive = world.drive(chain.joints[0]);
    drive.stiffness = 100 * (1.0 / 3) / (kStep * kStep);  // k h^2 / I = 100 for the rod about its end
    world.set_drive(chain.joints[0], drive);
    start(world, chain, {0.1}, {0});
    const double begin = world.mechanical();
    double most = 0;
    world.run(5, [&] { most = std::max(most, world.mechanical() / begin - 1); });
    world.print("k h^2 / I = 100");
    std::printf("    energy %+.1e of the start\n", most);
    EXPECT_LE(most, 1e-3);
    EXPECT_TRUE(world.velocity(chain.links[0]).allFinite());
  }
}

TEST(Stability, ABulletThatIsALinkDoesNotPassAThinWall) {
  for (const double speed : {300.0, 1000.0}) {
    for (const double thick : {0.01, 0.001}) {
      Hard world;
      world.set_gravity(Vector3::Zero());
      const breve_object wall = world.fixed(box(Vector3(thick, 10, 10), 1), Vector3(20, 0, 0));
      Hinge slide;
      slide.kind = BREVE_JOINT_PRISMATIC;
      slide.child = world.body(sphere(0.01, 1), Vector3::Zero());
      slide.normal = -Vector3::UnitX();
      for (const breve_object one : {wall, slide.child}) world.set_material(one, 0, 0);
      const breve_object joint = world.join(slide);
      breve_drive drive = world.drive(joint);
      drive.low[0] = -INFINITY, drive.high[0] = INFINITY;
      world.set_drive(joint, drive);
      world.set_joint(joint, 0, speed);
      world.run(0.2);
      EXPECT_LT(world.at(slide.child).x(), 20) << speed << ' ' << thick;
      EXPECT_GT(world.at(slide.child).x(), 19) << speed << ' ' << thick;
    }
  }
}

/// Three boxes on each other and a pendulum beside them, `scale` times as large, around `from`.
struct Mixed {
  Hard world;
  double scale;
  Vector3 from;
  std::vector<breve_object> boxes;
  Chain chain;
  Mixed(double size, const Vector3& around) : scale(size), from(around) {
    world.set_gravity(Vector3(0, -9.81 * scale, 0));  // so that all goes at the same pace
    world.fixed(box(scale * Vector3(20, 4, 20), 1), from - scale * Vector3(0, 2, 0));
    const double mass = scale * scale * scale;
    for (int i = 0; i < 3; ++i)
      boxes.push_back(world.body(box(scale * Vector3(1, 1, 1), mass), from + scale * Vector3(0, 0.5 + 1.01 * i, 0)));
    chain = hang(world, {scale, scale}, {mass, mass}, from + scale * Vector3(5, 5, 0));
    start(world, chain, {1.5, 1}, {0, 0});
  }
  double pendulum_energy() const {
    breve_energy energy = breve_energy_default();
    world.must(breve_object_energy(world.get(), chain.links[0], &energy));
    return energy.kinetic + energy.potential;
  }
  Vector3 top() const { return (world.at(boxes.back()) - from) / scale; }
};

void keeps_its_bounds(double scale, const Vector3& from) {
  Mixed scene(scale, from);
  const double begin = scene.pendulum_energy(), turnover = std::pow(scale, 5) * 2 * 9.81 * 2;
  double worst = 0;
  scene.world.run(10, [&] { worst = std::max(worst, std::abs(scene.pendulum_energy() - begin)); });
  scene.world.print("boxes and pendulum");
  std::printf("    scale %g, %g m off: top at %.6f, drift %.1e, pendulum dE %.1e\n", scale, from.norm(),
              scene.top().y(), std::hypot(scene.top().x(), scene.top().z()), worst / turnover);
  EXPECT_NEAR(scene.top().y(), 2.5, 0.025);
  EXPECT_LE(std::hypot(scene.top().x(), scene.top().z()), 0.01);
  EXPECT_LE(worst / turnover, 0.01);
}

TEST(Stability, TheSameSceneInMetres) { keeps_its_bounds(1, Vector3::Zero()); }
TEST(Stability, TheSameSceneInMillimetres) { keeps_its_bounds(1e-3, Vector3::Zero()); }
TEST(Stability, TheSameSceneInKilometres) { keeps_its_bounds(1e3, Vector3::Zero()); }
TEST(Stability, TheSameSceneTenKilometresAway) { keeps_its_bounds(1, Vector3(6000, 8000, 0)); }

TEST(Stability, BodiesCreatedIntoEachOtherPartGently) {
  for (const double apart : {0.0, 0.001, 0.5, 0.9}) {
    Hard world;
    world.set_gravity(Vector3::Zero());
    const breve_object a = world.body(box(Vector3(1, 1, 1), 1), Vector3::Zero());
    const breve_object b = world.body(box(Vector3(1, 1, 1), 3), Vector3(apart, 0.2 * apart, 0));
    double fastest = 0;
    world.run(2, [&] { fastest = std::max(fastest, (world.velocity(a) - world.velocity(b)).norm()); });
    const Vector3 momentum = world.velocity(a) + 3 * world.velocity(b);
    std::printf("  %.3f m apart: fastest %.2e m/s, momentum %.1e\n", apart, fastest, momentum.norm());
    EXPECT_LT(fastest, 4);
    EXPECT_LE(momentum.norm(), 1e-9);
  }
}

/// Limbs that lie on the floor, on their limits and on each other: rebounds must come to an end. On `precise` the floor
/// is springs.
TEST(Stability, CreaturesWithLimitsHaveNoStormsOfRebounds) {
  for (const breve_rung rung : {BREVE_RUNG_BALANCED, BREVE_RUNG_PRECISE})
    for (const double rebound : {0.0, 0.5, 0.9}) {
      const std::uint64_t told = drop_creatures(rung, 3, 2.5, {true, rebound, 0.05});
      EXPECT_LE(told, 3U) << "in 150 steps, rebound " << rebound;
    }
}

/// Rebounds that are lower than the error of their moments do not go on for ever, and what rebounds does not sink.
TEST(Stability, CreaturesThatReboundComeToRest) {
  const Lying lying = drop_and_lie(BREVE_RUNG_BALANCED, 20, 8);
  EXPECT_LE(lying.impacts, 60U);
  EXPECT_LE(lying.lost, 0.05);
}

}  // namespace
}  // namespace breve::reference
