// The energy ledger closes where bodies touch: what contacts, friction and limits take is written down, for the world
// and for each assembly, and what is left over is small against what went through.
#include <gtest/gtest.h>

#include <cstdio>

#include "dynamics_walker.hpp"

namespace breve::testing {
namespace {

struct Floor : Physics {
  explicit Floor(Rung rung = Rung::Balanced) : Physics(1.0 / 60) {
    mechanics().set_accuracy(rung);
    const ObjectId ground = body(2, Vector3(0, -2.5, 0), BodyKind::Stationary, Shape::box(Vector3(1000, 5, 1000)));
    Material& material = world.bodies().material(index(ground));
    material.static_friction = material.dynamic_friction = 0.5;
    material.normal_restitution = 0;
  }
  ObjectId box(const Vector3& at, double friction = 0.5) {
    const ObjectId id = rigid(Shape::box(Vector3(1, 1, 1)), at);
    Material& material = world.bodies().material(index(id));
    material.static_friction = material.dynamic_friction = friction;
    material.normal_restitution = 0;
    return id;
  }
};

/// The ledger's own sum: what came in less what went out less the residual is what is there more than at the start.
void expect_closed(const Energy& start, const Energy& now, double turnover) {
  const double in = now.motor_work + now.script_work - start.motor_work - start.script_work;
  const double out = now.contact_loss + now.friction_loss + now.drag_loss + now.limit_loss - start.contact_loss -
                     start.friction_loss - start.drag_loss - start.limit_loss;
  EXPECT_NEAR(now.total() - start.total(), in - out + now.residual - start.residual, 1e-9 * turnover);
}

TEST(DynamicsEnergy, ABoxThatIsDroppedLosesItsHeightInTheContact) {
  Floor s;
  const ObjectId box = s.box(Vector3(0, 1.5, 0));
  const Energy start = s.mechanics().energy();
  s.run(2);
  const Energy now = s.mechanics().energy();
  const double fall = s.world.bodies().mass(s.index(box)) * 9.81;  // 1 m
  std::printf("  dropped: contact %.5f friction %.1e residual %.1e of %.3f J\n", now.contact_loss, now.friction_loss,
              now.residual, fall);
  EXPECT_NEAR(now.contact_loss, fall, 1e-3 * fall);
  EXPECT_NEAR(now.friction_loss, 0, 1e-9 * fall);
  EXPECT_LT(std::abs(now.residual), 1e-3 * fall);
  expect_closed(start, now, fall);
}

TEST(DynamicsEnergy, ABoxThatSlidesLosesItsSpeedToFriction) {
  for (const Rung rung : {Rung::Balanced, Rung::Precise}) {
    Floor s(rung);
    const ObjectId box = s.box(Vector3(0, 0.5, 0));
    s.world.bodies().set_velocity(s.index(box), Vector3(3, 0, 0));
    const Energy start = s.mechanics().energy();
    s.run(2);
    const Energy now = s.mechanics().energy();
    std::printf("  slid on %s: contact %.1e friction %.5f residual %.1e of %.3f J\n",
                std::string(name_of(rung)).c_str(), now.contact_loss, now.friction_loss, now.residual, start.kinetic);
    EXPECT_NEAR(now.friction_loss, start.kinetic, 1e-3 * start.kinetic);
    EXPECT_LT(std::abs(now.residual), 1e-3 * start.kinetic);
    expect_closed(start, now, start.kinetic);
  }
}

TEST(DynamicsEnergy, AStackThatIsHitAndStandsAccountsForAll) {
  Floor s;
  for (int i = 0; i < 5; ++i) s.box(Vector3(0, 0.5 + i, 0));
  s.box(Vector3(0.1, 5.9, 0));
  const Energy start = s.mechanics().energy();
  s.run(3);
  const Energy now = s.mechanics().energy();
  const double fell = start.total() - now.total();
  std::printf("  stack: contact %.4f friction %.2e residual %.1e of %.3f J\n", now.contact_loss, now.friction_loss,
              now.residual, fell);
  EXPECT_GT(fell, 1);
  EXPECT_LT(std::abs(now.residual), 0.01 * fell);
  expect_closed(start, now, fell);
}

TEST(DynamicsEnergy, AnAssemblyKnowsWhatItsContactsTook) {
  Walker s(Rung::Balanced);
  const Energy start = s.mechanics().energy(s.index(s.trunk));
  for (int i = 0; i < 240; ++i) s.step();
  const Energy own = s.mechanics().energy(s.index(s.trunk)), all = s.mechanics().energy();
  std::printf("  walker: motors %.3f contact %.3f friction %.3f drag %.3f residual %.4f J\n", own.motor_work,
              own.contact_loss, own.friction_loss, own.drag_loss, own.residual);
  EXPECT_GT(own.contact_loss, 1);
  EXPECT_GT(own.friction_loss, 0.1);
  // The walker is all that moves.
  const double turnover = own.motor_work + own.contact_loss;
  EXPECT_NEAR(own.contact_loss, all.contact_loss, 1e-9 * turnover);
  EXPECT_NEAR(own.friction_loss, all.friction_loss, 1e-9 * turnover);
  EXPECT_NEAR(own.residual, all.residual, 1e-9 * turnover);
  EXPECT_LT(std::abs(own.residual), 0.01 * turnover);
  expect_closed(start, own, turnover);
}

TEST(DynamicsEnergy, FeetThatRestAreNotASeriesOfImpacts) {
  Walker s(Rung::Balanced);
  std::uint64_t impacts = 0, most = 0, sub_steps = 0, evaluations = 0, rejected = 0, solves = 0;
  for (int i = 0; i < 300; ++i) {
    s.step();
    const DynamicsCounters& c = s.mechanics().counters();
    impacts += c.impacts;
    most = std::max(most, c.impacts);
    sub_steps += c.sub_steps;
    evaluations += c.evaluations;
    rejected += c.rejected;
    solves += c.solver_iterations;
    EXPECT_EQ(c.interventions, 0U) << "at " << s.world.time()
                                   << " s: " << words_for(s.mechanics().interventions()[0].reason);
  }
  std::printf(
      "  walker, 5 s: %lu impacts, at most %lu in a step, %lu sub-steps, %lu evaluations, %lu rejected, %lu "
      "iterations\n",
      impacts, most, sub_steps, evaluations, rejected, solves);
  EXPECT_LT(most, 20U);
  EXPECT_LT(impacts, 300U);
}

}  // namespace
}  // namespace breve::testing
