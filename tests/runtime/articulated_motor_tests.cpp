// Motors that look ahead and have a limit: which of them are at it, on random trees. The oracle is the definition:
// within its limit a motor's joint follows its speed, at the limit it asks for more; and there are no jumps.
#include <gtest/gtest.h>

#include "articulated_random.hpp"
#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/inverse_dynamics.hpp"
#include "runtime/articulated/mass_matrix.hpp"

namespace breve::articulated::motor_tests {
namespace {

constexpr double kLag = 0.01;  // s
constexpr double kGain = 1e4;  // N*m*s: far more than the inertias over the lag, so that speeds are followed to 1e-3
constexpr int kTrees = 300;

/// Trees with a motor on each joint with axes; limits so that some are at them and some are not.
/// @param balls  every other joint with one axis is a ball joint; else there are none
template <class F>
void for_driven_trees(F f, bool balls = false) {
  Random random(11);
  for (int i = 0; i < kTrees; ++i) {
    SCOPED_TRACE("tree " + std::to_string(i));
    std::vector<Link> links = random_tree(random, 2 + static_cast<int>(random.below(11)), i % 2 == 1);
    for (std::size_t k = 1; k < links.size(); ++k) {
      JointType& type = links[k].type;
      if (type == JointType::Ball && !balls) type = JointType::Revolute;
      if (type == JointType::Revolute && balls && k % 2 == 1) type = JointType::Ball;
    }
    const Model model(links);
    Loads loads;
    loads.gravity = random_vector(random, 10);
    loads.motor_time = kLag;
    loads.drives.resize(static_cast<std::size_t>(model.size()));
    for (int k = 0; k < model.size(); ++k)
      if (model.body(k).type != JointType::Free)
        loads.drives[static_cast<std::size_t>(k)] = {0, 0, kGain, between(random, 0, 60)};
    loads.motor_speed = random_forces(random, model.velocities());
    Data data(model);
    f(random, model, data, random_state(random, model, 1), loads);
    if (testing::Test::HasFailure()) return;
  }
}

struct Tally {
  int free = 0, held = 0;
};

/// The couple of a ball joint's motor is bounded as a whole, and points along what it asks for.
void check_ball(int first, const Drive& drive, const State& state, const Loads& loads, const Vector& a,
                const Vector& torque, Tally& tally) {
  const Vector3 left = loads.motor_speed.segment<3>(first) - state.v.segment<3>(first) - kLag * a.segment<3>(first);
  const Vector3 asked = kGain * left, given = torque.segment<3>(first);
  const double round_off = 1e-10 * kGain * (1 + kLag * a.cwiseAbs().maxCoeff());
  EXPECT_LE(given.norm(), drive.motor_limit + round_off);
  if ((asked - given).norm() <= round_off) {
    ++tally.free;
    return;
  }
  ++tally.held;
  EXPECT_NEAR(given.norm(), drive.motor_limit, round_off);
  EXPECT_GE(asked.norm(), drive.motor_limit - round_off);
  EXPECT_LE((given * asked.norm() - asked * given.norm()).norm(), round_off * (given.norm() + asked.norm()));
}

/// Counts motors on both sides, and checks each.
void check_motors(const Model& model, Data& data, const State& state, const Loads& loads, const Vector& a,
                  Tally& tally) {
  Loads bare = loads;
  bare.drives.clear();
  Vector torque(model.velocities());
  inverse_dynamics(model, data, state, a, bare, torque);
  for (int i = 0; i < model.size(); ++i) {
    const Drive& drive = loads.drives[static_cast<std::size_t>(i)];
    if (!(drive.motor_gain > 0)) continue;
    if (model.body(i).type == JointType::Ball) {
      check_ball(model.body(i).v, drive, state, loads, a, torque, tally);
      continue;
    }
    for (int k = model.body(i).v; k < model.body(i).v + velocity_count(model.body(i).type); ++k) {
      const double asked = kGain * (loads.motor_speed[k] - state.v[k] - kLag * a[k]);
      const double round_off = 1e-10 * kGain * (1 + kLag * a.cwiseAbs().maxCoeff());
      EXPECT_LE(std::abs(torque[k]), drive.motor_limit + round_off);
      // Either what it asks for is what it gives, or it gives its limit and asks for more in the same direction.
      if (std::abs(asked - torque[k]) <= round_off) {
        ++tally.free;
        continue;
      }
      ++tally.held;
      EXPECT_NEAR(std::abs(torque[k]), drive.motor_limit, round_off);
      EXPECT_GE(asked * torque[k], 0);
      EXPECT_GE(std::abs(asked), drive.motor_limit - round_off);
    }
  }
}

TEST(Motors, FollowTheirSpeedOrAreAtTheirLimit) {
  Tally tally;
  for_driven_trees([&](Random&, const Model& model, Data& data, const State& state, const Loads& loads) {
    const Vector a = forward_dynamics(model, data, state, loads);
    check_motors(model, data, state, loads, a, tally);
  });
  EXPECT_GT(tally.free, 300);
  EXPECT_GT(tally.held, 300);
}

TEST(Motors, OfBallJointsPushAlongWhatTheyAskFor) {
  Tally tally;
  const auto check = [&](Random&, const Model& model, Data& data, const State& state, const Loads& loads) {
    const Vector a = forward_dynamics(model, data, state, loads);
    check_motors(model, data, state, loads, a, tally);
  };
  for_driven_trees(check, true);
  EXPECT_GT(tally.free, 300);
  EXPECT_GT(tally.held, 300);
}

/// Whatever was tried before, the same state has the same accelerations: step control finds no step small enough else.
void check_memory(Random& random, const Model& model, Data& data, State state, const Loads& loads) {
  forward_dynamics(model, data, state, loads);
  for (int i = 0; i < 5; ++i) {
    state.v += random_forces(random, model.velocities());
    const Vector warm = forward_dynamics(model, data, state, loads, 0, MotorGuess::Last);
    const Vector cold = forward_dynamics(model, data, state, loads);
    EXPECT_LE((warm - cold).cwiseAbs().maxCoeff(), 1e-9 * (1 + cold.cwiseAbs().maxCoeff()));
  }
}

TEST(Motors, OfBallJointsDoNotDependOnTheLastSolve) { for_driven_trees(check_memory, true); }

TEST(Motors, WhatIsRememberedOfTheLastSolveMakesNoDifference) { for_driven_trees(check_memory); }

TEST(Motors, ThatComeToTheirLimitsMakeNoJump) {
  int met = 0;
  for_driven_trees([&](Random& random, const Model& model, Data& data, const State& state, const Loads& loads) {
    // On a straight way through velocities: where the motors at their limit change, the accelerations on both sides.
    const Vector way = 2 * random_forces(random, model.velocities());
    State at = state;
    const auto solve = [&](double s, std::vector<signed char>& held) -> Vector {
      at.v = state.v + s * way;
      const Vector a = forward_dynamics(model, data, at, loads);
      held.assign(data.at_limit.begin(), data.at_limit.end());
      return a;
    };
    std::vector<signed char> held_low, held_high, held;
    double low = 0, high = 1;
    solve(low, held_low);
    solve(high, held_high);
    if (held_low == held_high) return;
    ++met;
    while (high - low > 1e-13) {
      const double middle = 0.5 * (low + high);
      solve(middle, held);
      (held == held_low ? low : high) = middle;
    }
    const Vector below = solve(low, held_low), above = solve(high, held_high);
    // The way between the two, and gains times it: round-off.
    EXPECT_LE((above - below).cwiseAbs().maxCoeff(), 1e-7 * (1 + below.cwiseAbs().maxCoeff()));
  });
  EXPECT_GT(met, kTrees / 2);
}

}  // namespace
}  // namespace breve::articulated::motor_tests
