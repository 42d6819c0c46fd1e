// Trees in a world against the reference files: trajectories, springs, the errors of the rungs.
#include <gtest/gtest.h>

#include <cstdio>

#include "dynamics_scene.hpp"

namespace breve::testing {
namespace {

double allowed(double amplification) { return std::max(1e-7, 1e-16 * amplification * 1e3); }

struct Moment {
  double t, kinetic, potential, amplification;
  articulated::State state;
};

std::vector<Moment> moments_of(const std::string& name) {
  std::vector<Moment> moments;
  for (const ref::Row& row : ref::rows_of(ref::read("mb_trajectory"), name)) {
    if (moments.empty() || moments.back().t != row.number("t"))
      moments.push_back(
          {row.number("t"), row.number("kinetic"), row.number("potential"), row.number("amplification"), {}});
    ref::append(moments.back().state.q, ref::numbers(row, "q", 7));
    ref::append(moments.back().state.v, ref::numbers(row, "u", 6));
  }
  return moments;
}

double error_of(Machine& machine, const articulated::State& expected) {
  machine.given.state.q = expected.q;  // for the signs of quaternions
  const articulated::State got = machine.read();
  return std::max((got.q - expected.q).cwiseAbs().maxCoeff(), (got.v - expected.v).cwiseAbs().maxCoeff());
}

TEST(DynamicsMotion, StartsWhereTheFilesSay) {
  for (const std::string& name : ref::case_names("mb_cases")) {
    Machine machine(name, 0.01, false);
    const articulated::State start = ref::load(name).state;
    EXPECT_LE(error_of(machine, start), 1e-12) << name;
    for (const ref::Row& row : ref::rows_of(ref::read("mb_scalars"), name)) {
      const Energy energy = machine.mechanics().energy();
      EXPECT_NEAR(energy.kinetic, row.number("kinetic"), 1e-11 * std::abs(row.number("kinetic"))) << name;
      EXPECT_NEAR(energy.potential, row.number("potential"), 1e-11 * (1 + std::abs(row.number("potential")))) << name;
    }
  }
}

TEST(DynamicsMotion, TheReferenceRungFollowsTheTrajectories) {
  for (const std::string& name : ref::case_names("mb_trajectory")) {
    Machine machine(name, 0.05, false);
    machine.mechanics().set_accuracy(Rung::Reference);
    double worst = 0;
    for (const Moment& moment : moments_of(name)) {
      machine.run(moment.t - machine.world.time());
      const double error = error_of(machine, moment.state);
      EXPECT_LE(error, allowed(moment.amplification)) << name << " at " << moment.t;
      worst = std::max(worst, error);
    }
    std::printf("  %-14s largest error in q and v %.1e\n", name.c_str(), worst);
  }
}

TEST(DynamicsMotion, FastAndPreciseErrAsMuchAsTheTextbooks) {
  double worst = 0;
  for (const ref::Row& row : ref::read("expected_errors")) {
    if (row.text("max_error_q_and_u") == "unstable") continue;
    const bool precise = row.text("scheme") == "rk4";
    Machine machine(row.text("case"), row.number("h"), false);
    Accuracy accuracy = accuracy_of(precise ? Rung::Precise : Rung::Fast);
    accuracy.step = 0;
    machine.mechanics().set_accuracy(accuracy);
    machine.run(row.number("t"));
    for (const Moment& moment : moments_of(row.text("case"))) {
      if (moment.t != row.number("t")) continue;
      const double expected = row.number("max_error_q_and_u"), got = error_of(machine, moment.state);
      EXPECT_LE(got, 2 * expected) << row.text("case") << ' ' << row.text("scheme") << ' ' << row.number("h");
      worst = std::max(worst, got / expected);
    }
  }
  std::printf("  expected_errors: at most %.3f times\n", worst);
}

}  // namespace
}  // namespace breve::testing
