// Hard scenes through breve.h that take long: minutes of passive creatures and pendulums, and what `fast` does.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "creatures.hpp"
#include "scenes.hpp"

namespace breve::reference {
namespace {

struct Hard : World {
  explicit Hard(breve_rung rung, double step = 1.0 / 60) : World(step, rung) { set_guard(BREVE_GUARD_REPORT); }
};

/// Links of half a metre and one kilogram, released level. Returns the worst error of energy by m g l of all.
double swing(World& world, int links, double seconds) {
  const std::vector<double> lengths(static_cast<std::size_t>(links), 0.5), masses(static_cast<std::size_t>(links), 1);
  const Chain chain = hang(world, lengths, masses);
  const std::vector<double> level(static_cast<std::size_t>(links), 0.5 * kPi);
  start(world, chain, level, std::vector<double>(level.size(), 0.0));
  const double begin = world.mechanical(), scale = links * 9.81 * 0.5 * links;
  double worst = 0;
  world.run(seconds, [&] { worst = std::max(worst, std::abs(world.mechanical() - begin) / scale); });
  EXPECT_LE(chain.widest(world), 1e-9);
  std::printf("    dE %.1e, %.1f sub-steps a step, %lu interventions\n", worst, world.toll().per_iteration(),
              world.toll().interventions);
  return worst;
}

TEST(Endurance, APendulumOfFiveLinksOnBalanced) {
  Hard world(BREVE_RUNG_BALANCED);
  EXPECT_LE(swing(world, 5, 60), 0.01);
  EXPECT_LE(world.toll().per_iteration(), 8);
}

TEST(Endurance, APendulumOfFiveLinksOnPrecise) {
  Hard coarse(BREVE_RUNG_PRECISE, 1.0 / 480), fine(BREVE_RUNG_PRECISE, 1.0 / 960);
  EXPECT_LE(swing(coarse, 5, 60), 1e-3);
  EXPECT_LE(swing(fine, 5, 60), 1e-4);
}

TEST(Endurance, TwentyPassiveCreaturesGainNoEnergy) { drop_creatures(BREVE_RUNG_BALANCED, 20, 5); }
TEST(Endurance, TwoHundredPassiveCreaturesGainNoEnergyInAMinute) { drop_creatures(BREVE_RUNG_BALANCED, 200, 60); }

TEST(Endurance, PlatesThatClapForAHundredSecondsStayWhereTheyAre) {
  Hard world(BREVE_RUNG_BALANCED);
  world.set_gravity(Vector3::Zero());
  const breve_object a = world.body(box(Vector3(1, 0.1, 1), 1), Vector3(0, 0.5, 0));
  const breve_object b = world.body(box(Vector3(1, 0.1, 1), 1), Vector3(0, -0.5, 0));
  breve_spring spring = breve_spring_default();
  spring.from = a, spring.to = b;
  spring.strength = 5;
  spring.damping = 0;
  breve_object made;
  world.must(breve_spring_create(world.get(), &spring, &made));
  for (const breve_object one : {a, b}) world.set_material(one, 0.5, 0.8);
  double moved = 0;
  world.run(100, [&] { moved = std::max(moved, (0.5 * (world.at(a) + world.at(b))).norm()); });
  std::printf("  centre of mass moved by %.1e m, %lu impacts\n", moved, world.toll().impacts);
  EXPECT_LE(moved, 1e-6);
}

/// On `fast` figures are published, not promised; but with the guard as it is at first every number stays finite.
TEST(Endurance, FastStaysFiniteUnderTheGuard) {
  World stack(1.0 / 60, BREVE_RUNG_FAST);
  incline(stack, 0);
  std::vector<breve_object> boxes;
  for (int i = 0; i < 10; ++i) boxes.push_back(stack.body(box(Vector3(1, 1, 1), 1), Vector3(0, 0.5 + i, 0)));
  stack.run(60);
  const Vector3 top = stack.at(boxes.back());
  std::printf("  fast, ten boxes: top at %.4f, drift %.1e\n", top.y(), std::hypot(top.x(), top.z()));
  EXPECT_TRUE(top.allFinite());
  World chain(1.0 / 60, BREVE_RUNG_FAST);
  Chain links = hang(chain, std::vector<double>(20, 0.5), std::vector<double>(20, 0.1));
  Hinge hinge;
  hinge.parent = links.links.back();
  hinge.child = chain.body(sphere(0.5, 1000), Vector3::Zero());
  hinge.parent_point = Vector3(0, -0.25, 0);
  hinge.child_point = Vector3(0, 0.5, 0);
  chain.join(hinge);
  chain.set_joint(links.joints[0], 0.5 * kPi, 0);
  chain.run(10);
  std::printf("  fast, 1000 kg on 20 links: at %.2f, %.2f; %lu interventions\n", chain.at(hinge.child).x(),
              chain.at(hinge.child).y(), chain.toll().interventions);
  EXPECT_TRUE(chain.at(hinge.child).allFinite());
}

}  // namespace
}  // namespace breve::reference
