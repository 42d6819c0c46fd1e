// Bodies that only springs connect, against closed forms and conservation laws: on `fast` and `balanced` they move as
// points, with the springs in flat arrays.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "world.hpp"

namespace {

using namespace breve::reference;

constexpr double kStep = 1.0 / 60;

class SpringNetworks : public testing::TestWithParam<breve_rung> {};

breve_object add_spring(World& world, breve_object a, breve_object b, double length, double strength, double damping) {
  breve_spring spring = breve_spring_default();
  spring.from = a, spring.to = b;
  spring.length = length, spring.strength = strength, spring.damping = damping;
  breve_object made{};
  world.must(breve_spring_create(world.get(), &spring, &made));
  return made;
}

/// A block of n x n x n balls of 1 kg, each connected to its neighbours along the axes and the diagonals of faces.
std::vector<breve_object> block(World& world, int n, double height, double damping) {
  constexpr double kReach = 1.5;
  std::vector<breve_object> balls;
  for (int x = 0; x < n; ++x)
    for (int y = 0; y < n; ++y)
      for (int z = 0; z < n; ++z) balls.push_back(world.body(sphere(0.2, 1), Vector3(x, y + height, z)));
  for (std::size_t i = 0; i < balls.size(); ++i)
    for (std::size_t k = i + 1; k < balls.size(); ++k) {
      const double length = (world.at(balls[i]) - world.at(balls[k])).norm();
      if (length < kReach) add_spring(world, balls[i], balls[k], length, 300, damping);
    }
  return balls;
}

}  // namespace

/// Two masses on a spring: the distance is length + A cos(w t) with w^2 = k (1/m1 + 1/m2). Here w h is 0.8.
TEST_P(SpringNetworks, TwoMassesOscillateAsTheClosedFormSays) {
  constexpr double kStrength = 1536, kLength = 2, kStretch = 0.1;
  World world(kStep, GetParam());
  world.set_gravity(Vector3::Zero());
  const breve_object a = world.body(sphere(0.2, 1), Vector3(0, 5, 0));
  const breve_object b = world.body(sphere(0.2, 2), Vector3(kLength + kStretch, 5, 0));
  add_spring(world, a, b, kLength, kStrength, 0);
  const double w = std::sqrt(kStrength * 1.5);
  double worst = 0;
  world.run(2, [&] {
    const double wanted = kLength + kStretch * std::cos(w * world.time());
    worst = std::max(worst, std::abs((world.at(b) - world.at(a)).norm() - wanted));
  });
  EXPECT_LT(worst, 0.1 * kStretch);  // after fifteen oscillations with eight steps each
  EXPECT_NEAR((world.at(a) + 2 * world.at(b)).x(), 2 * (kLength + kStretch), 1e-12);
}

/// A damper that only slows two masses down: their relative velocity is v exp(-c (1/m1 + 1/m2) t), at any strength.
TEST_P(SpringNetworks, DampersTakeWhatTheClosedFormSays) {
  for (const double damping : {1.0, 1000.0}) {
    World world(kStep, GetParam());
    world.set_gravity(Vector3::Zero());
    const breve_object a = world.body(sphere(0.2, 1), Vector3(0, 5, 0));
    const breve_object b = world.body(sphere(0.2, 3), Vector3(4, 5, 0));
    world.set_velocity(b, Vector3(1, 0, 0));
    add_spring(world, a, b, 4, 0, damping);
    world.run(0.5);
    const double rate = damping * (1 + 1.0 / 3);
    EXPECT_NEAR((world.velocity(b) - world.velocity(a)).x(), std::exp(-rate * world.time()), 1e-9);
    const breve_energy energy = world.energy();
    EXPECT_NEAR(energy.drag_loss, 0.5 * 0.75 * -std::expm1(-2 * rate * world.time()), 1e-9);
    EXPECT_NEAR(energy.residual, 0, 1e-12);
  }
}

/// A block that flies, turns and oscillates for ten seconds.
TEST_P(SpringNetworks, BlocksKeepEnergyAndMomentum) {
  World world(kStep, GetParam());
  world.set_gravity(Vector3::Zero());
  const std::vector<breve_object> balls = block(world, 3, 50, 0);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const auto k = static_cast<double>(i);
    world.set_velocity(balls[i], Vector3(std::sin(k), 1 + std::cos(2 * k), std::sin(3 * k)));
  }
  world.step();
  const auto momenta = [&](Vector3& linear, Vector3& angular) {
    linear = angular = Vector3::Zero();
    for (const breve_object ball : balls) {
      linear += world.velocity(ball);
      angular += world.at(ball).cross(world.velocity(ball));
    }
  };
  Vector3 linear, angular, linear_after, angular_after;
  momenta(linear, angular);
  const double energy = world.mechanical();
  world.run(10);
  momenta(linear_after, angular_after);
  EXPECT_LT((linear_after - linear).norm(), 1e-10 * linear.norm());
  EXPECT_LT((angular_after - angular).norm(), 1e-10 * angular.norm());
  EXPECT_NEAR(world.mechanical(), energy, 0.01 * energy);
  EXPECT_LT(std::abs(world.energy().residual), 0.01 * energy);
}

/// A block that falls on a floor: what it had is in the books, and it lies in the end.
TEST_P(SpringNetworks, FallenBlocksComeToRestByTheBooks) {
  World world(kStep, GetParam());
  world.fixed(box(Vector3(20, 1, 20), 1), Vector3(0, -0.5, 0));
  const std::vector<breve_object> balls = block(world, 3, 1, 5);
  const double before = world.mechanical();
  world.run(6);
  const breve_energy energy = world.energy();
  const double fall = before - world.mechanical();
  EXPECT_GT(fall, 0);
  EXPECT_LT(energy.kinetic, 0.01 * fall);
  EXPECT_LT(std::abs(energy.residual), 0.03 * fall);
  for (const breve_object ball : balls) EXPECT_GT(world.at(ball).y(), 0.15);
}

/// A spring that is set to push only, is followed all the same.
TEST_P(SpringNetworks, SpringsMayChangeTheirMindOnTheWay) {
  World world(kStep, GetParam());
  world.set_gravity(Vector3::Zero());
  const breve_object a = world.body(sphere(0.2, 1), Vector3(0, 5, 0));
  const breve_object b = world.body(sphere(0.2, 1), Vector3(1.4, 5, 0));
  const breve_object spring = add_spring(world, a, b, 1, 100, 0);
  world.run(0.5);
  const double energy = world.mechanical();
  breve_spring now = breve_spring_default();
  now.from = a, now.to = b;
  now.length = 1, now.damping = 0;
  now.mode = BREVE_SPRING_EXPAND_ONLY;
  world.must(breve_spring_set_description(world.get(), spring, &now));
  const double changed = world.mechanical();
  world.run(1);
  EXPECT_LE(changed, energy + 1e-12);
  EXPECT_NEAR(world.mechanical(), changed, 0.02 * energy);
}

INSTANTIATE_TEST_SUITE_P(Rungs, SpringNetworks, testing::Values(BREVE_RUNG_FAST, BREVE_RUNG_BALANCED),
                         [](const auto& one) {
                           return one.param == BREVE_RUNG_FAST ? std::string("fast") : std::string("balanced");
                         });
