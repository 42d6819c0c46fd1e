// The implicit midpoint rule that step control tries first where it may be coarse.
#include <gtest/gtest.h>

#include <cmath>

#include "articulated_random.hpp"
#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/integrator.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/articulated/tree_system.hpp"
#include "runtime/base/error.hpp"

namespace breve::articulated::midpoint_tests {
namespace {

/// x'' = -(frequency)^2 x.
class Swing final : public System {
 public:
  explicit Swing(double frequency) : square_(frequency * frequency) {}
  int positions() const override { return 1; }
  int velocities() const override { return 1; }
  Kind kind(int) const override { return Kind::Length; }
  void acceleration(double, const Vector& q, const Vector&, double, Vector& a) override {
    a[0] = wall && q[0] > 0.5 ? std::nan("") : -square_ * q[0];
  }
  bool wall = false;

 private:
  double square_;
};

Settings coarse(double tolerance) {
  Settings settings;
  settings.tolerance.relative = tolerance;
  return settings;
}

Instant coarse_start(bool remembers) {
  Instant at{0, Vector::Ones(1), Vector::Zero(1), 0};
  at.slack = 10;
  if (remembers) at.mean = Vector::Zero(1);
  return at;
}

TEST(Midpoint, HasOrderTwo) {
  Swing swing(1);
  double errors[2];
  for (const int fine : {0, 1}) {
    Integrator integrator(swing, Scheme::FehlbergAdaptive, coarse(1e-9));
    Instant at = coarse_start(false);
    const int steps = fine ? 200 : 100;
    for (int i = 0; i < steps; ++i) {
      integrator.step(at, 2.0 / steps);
      ASSERT_LE(integrator.count().evaluations, 6) << "step control took over";
    }
    errors[fine] = std::abs(at.q[0] - std::cos(2.0));
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2, 0.01);
}

TEST(Midpoint, SwingsNeitherGrowNorDieOut) {
  Swing swing(1);
  Integrator integrator(swing, Scheme::FehlbergAdaptive, coarse(1e-6));
  Instant at = coarse_start(true);
  for (int i = 0; i < 100'000; ++i) integrator.step(at, 0.1);
  EXPECT_NEAR(at.q[0] * at.q[0] + at.v[0] * at.v[0], 1, 1e-3);
}

// So small that the second guess is good enough for the tolerance: in the end it was four times as large.
TEST(Midpoint, SmallSwingsAreNotDrivenOn) {
  constexpr double kFrequency = 200, kAmplitude = 1e-3;
  Swing swing(kFrequency);
  Integrator integrator(swing, Scheme::FehlbergAdaptive, coarse(1e-2));
  Instant at = coarse_start(true);
  at.q[0] = kAmplitude;
  for (int i = 0; i < 4000; ++i) {
    integrator.step(at, 1.0 / 400);
    const double amplitude = std::hypot(at.q[0], at.v[0] / kFrequency);
    ASSERT_LE(amplitude, 1.00001 * kAmplitude);
    ASSERT_GE(amplitude, 0.95 * kAmplitude);
  }
}

TEST(Midpoint, TreesKeepTheirEnergy) {
  Random random(7);
  const Model model(random_tree(random, 6, false));
  TreeSystem system(model);
  system.loads.gravity = Vector3(0, 0, -9.81);
  Integrator integrator(system, Scheme::FehlbergAdaptive, coarse(1e-2));
  Data data(model);
  State state = random_state(random, model, 1);
  const auto energy = [&] {
    forward_kinematics(model, data, state);
    return kinetic_energy(model, data) + potential_energy(model, data, system.loads.gravity);
  };
  const double before = energy(), moves = kinetic_energy(model, data);
  Instant at{0, state.q, state.v, 0};
  at.slack = 10;
  at.mean = Vector::Zero(model.velocities());
  int evaluations = 0;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    integrator.step(at, 1.0 / 1000);
    evaluations += integrator.count().evaluations;
  }
  state.q = at.q;
  state.v = at.v;
  EXPECT_LE(std::abs(energy() - before), 0.01 * moves);
  EXPECT_LE(evaluations, 3 * kSteps);
}

TEST(Midpoint, LeavesToStepControlWhatDoesNotConverge) {
  Swing swing(30);
  Integrator integrator(swing, Scheme::FehlbergAdaptive, coarse(1e-4));
  Instant at = coarse_start(false);
  integrator.step(at, 0.1);  // an angle of 3 a step
  EXPECT_GT(integrator.count().evaluations, 12);
  EXPECT_NEAR(at.q[0], std::cos(3.0), 1e-3);
}

TEST(Midpoint, LeavesTheStateWhereThereIsNoAcceleration) {
  Swing swing(1);
  swing.wall = true;
  Integrator integrator(swing, Scheme::FehlbergAdaptive, coarse(1e-4));
  Instant at = coarse_start(true);
  EXPECT_THROW(integrator.step(at, 0.1), Error);
  EXPECT_EQ(at.t, 0);
  EXPECT_EQ(at.q[0], 1);
  EXPECT_EQ(at.v[0], 0);
  EXPECT_EQ(at.mean[0], 0);
}

TEST(Midpoint, BeginsWhereTheLastStepEndedWhichIsPartOfTheState) {
  Swing swing(1);
  Integrator one(swing, Scheme::FehlbergAdaptive, coarse(1e-5)), other(swing, Scheme::FehlbergAdaptive, coarse(1e-5));
  Instant knows = coarse_start(true), new_to_it = coarse_start(false);
  int with = 0, without = 0;
  for (int i = 0; i < 100; ++i) {
    one.step(knows, 0.01);
    with += one.count().evaluations;
    one.step(new_to_it, 0.01);
    without += one.count().evaluations;
  }
  EXPECT_LT(with, without);
  Instant copy = knows;
  one.step(knows, 0.01);
  other.step(copy, 0.01);  // an integrator that has seen nothing goes on alike
  EXPECT_EQ(knows.q[0], copy.q[0]);
  EXPECT_EQ(knows.v[0], copy.v[0]);
  EXPECT_EQ(knows.mean[0], copy.mean[0]);
}

}  // namespace
}  // namespace breve::articulated::midpoint_tests
