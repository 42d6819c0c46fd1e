// Trees of bodies in a world against the mb_ files: start, accelerations, trajectories, the errors of the rungs.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "trees.hpp"

namespace breve::reference {
namespace {

std::vector<std::string> names_in(const std::string& file) {
  std::vector<std::string> out;
  for (const Row& row : read(file))
    if (out.empty() || out.back() != row.text("case")) out.push_back(row.text("case"));
  return out;
}

TEST(ReferenceTrees, StartAsTheFilesSay) {
  int built = 0;
  for (const std::string& name : names_in("mb_cases")) {
    if (!Tree::can_be_built(name)) continue;
    ++built;
    Tree tree(name, 0.01, BREVE_RUNG_BALANCED, false);
    for (const Row& row : rows_of("mb_state", name)) EXPECT_LE(tree.error(row), 1e-11) << name;
    for (const Row& row : rows_of("mb_scalars", name)) {
      const breve_energy energy = tree.world.energy();
      EXPECT_NEAR(energy.kinetic, row.number("kinetic"), 1e-11 * std::abs(row.number("kinetic"))) << name;
      EXPECT_NEAR(energy.potential, row.number("potential"), 1e-11 * (1 + std::abs(row.number("potential")))) << name;
    }
  }
  EXPECT_EQ(built, 10);
}

/// With the explicit Euler scheme velocities of joints grow by exactly acceleration times step, so that a step of one
/// second shows accelerations with all their digits.
TEST(ReferenceTrees, JointsAccelerateAsTheFileSays) {
  for (const std::string& name : names_in("mb_accel")) {
    if (!Tree::can_be_built(name)) continue;
    Tree tree(name, 1, BREVE_RUNG_BALANCED, true);
    tree.world.set_integrator(BREVE_INTEGRATOR_EXPLICIT_EULER);
    const std::vector<Row> states = rows_of("mb_state", name), expected = rows_of("mb_accel", name);
    tree.world.step();
    double size = 0, worst = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (tree.joints[i].generation == 0 || expected[i].empty("qdd0")) continue;
      const double acceleration = tree.world.read(tree.joints[i]).velocity[0] - states[i].number("u0");
      size = std::max(size, std::abs(expected[i].number("qdd0")));
      worst = std::max(worst, std::abs(acceleration - expected[i].number("qdd0")));
    }
    // Where the matrix of mass is badly conditioned the same digits are lost by every method.
    const double condition = rows_of("mb_scalars", name).front().number("cond_M");
    const double bound = condition > 1e6 ? 1e-7 : 1e-11;
    if (size > 0) {
      EXPECT_LE(worst, bound * size) << name;
      std::printf("  %-14s relative error %.1e (condition %.0e)\n", name.c_str(), worst / size, condition);
    }
  }
}

TEST(ReferenceTrees, TheReferenceRungFollowsTheTrajectories) {
  int built = 0;
  for (const std::string& name : names_in("mb_trajectory")) {
    if (!Tree::can_be_built(name)) continue;
    ++built;
    Tree tree(name, 0.05, BREVE_RUNG_REFERENCE, false);
    double worst = 0;
    for (const Row& row : rows_of("mb_trajectory", name)) {
      tree.world.run(row.number("t") - tree.world.time());
      const double error = tree.error(row);
      EXPECT_LE(error, std::max(1e-7, 1e-13 * row.number("amplification"))) << name << " at " << row.text("t");
      worst = std::max(worst, error);
    }
    std::printf("  %-12s largest error %.1e\n", name.c_str(), worst);
  }
  EXPECT_GE(built, 2);
}

TEST(ReferenceTrees, FastAndPreciseErrAsMuchAsTheTextbooks) {
  double worst = 0;
  for (const Row& row : read("expected_errors")) {
    const std::string& name = row.text("case");
    if (row.text("max_error_q_and_u") == "unstable" || !Tree::can_be_built(name)) continue;
    const bool precise = row.text("scheme") == "rk4";
    Tree tree(name, row.number("h"), precise ? BREVE_RUNG_PRECISE : BREVE_RUNG_FAST, false);
    breve_accuracy accuracy = tree.world.accuracy();
    accuracy.step = 0;
    tree.world.set_accuracy(accuracy);
    tree.world.run(row.number("t"));
    double error = 0;
    for (const Row& state : rows_of("mb_trajectory", name))
      if (state.number("t") == row.number("t")) error = std::max(error, tree.error(state));
    const double expected = row.number("max_error_q_and_u");
    EXPECT_LE(error, 2 * expected) << name << ' ' << row.text("scheme") << ' ' << row.number("h");
    worst = std::max(worst, error / expected);
  }
  std::printf("  expected_errors: at most %.3f times\n", worst);
}

}  // namespace
}  // namespace breve::reference
