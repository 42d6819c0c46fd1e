// Every integrator in a world: digit for digit what the scheme gives, and its order, of joints and of free bodies.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "scenes.hpp"
#include "trees.hpp"

namespace breve::reference {
namespace {

const std::map<std::string, breve_integrator> kSchemes = {{"explicit_euler", BREVE_INTEGRATOR_EXPLICIT_EULER},
                                                          {"semi_implicit_euler", BREVE_INTEGRATOR_SEMI_IMPLICIT_EULER},
                                                          {"implicit_euler", BREVE_INTEGRATOR_IMPLICIT_EULER},
                                                          {"velocity_verlet", BREVE_INTEGRATOR_VELOCITY_VERLET},
                                                          {"implicit_midpoint", BREVE_INTEGRATOR_IMPLICIT_MIDPOINT},
                                                          {"rk4", BREVE_INTEGRATOR_RUNGE_KUTTA_4},
                                                          {"rkf45_4th", BREVE_INTEGRATOR_FEHLBERG_4},
                                                          {"rkf45_5th", BREVE_INTEGRATOR_FEHLBERG_5}};
const std::map<std::string, int> kOrders = {{"explicit_euler", 1},    {"semi_implicit_euler", 1},
                                            {"implicit_euler", 1},    {"velocity_verlet", 2},
                                            {"implicit_midpoint", 2}, {"rk4", 4},
                                            {"rkf45_4th", 4},         {"rkf45_5th", 5}};
constexpr double kOneStep = 1e-13;  // the bound after one step
constexpr double kOrder = 0.2;

/// x'' of the file as one joint: a spring in a slider, or a pendulum.
breve_object oscillator(World& world, const std::string& problem) {
  Hinge hinge;
  hinge.normal = -Vector3::UnitX();
  if (problem == "pendulum") {
    // Half a metre down, with as much inertia about its centre as makes x'' = -9.81 sin x.
    hinge.child = world.body(lump(1, 0.25 * Matrix3::Identity()), Vector3::Zero());
    hinge.child_point = Vector3(0, 0.5, 0);
    hinge.normal = -Vector3::UnitZ();
    return world.join(hinge);
  }
  world.set_gravity(Vector3::Zero());
  hinge.kind = BREVE_JOINT_PRISMATIC;
  hinge.child = world.body(box(Vector3(0.1, 0.1, 0.1), 1), Vector3::Zero());
  const breve_object joint = world.join(hinge);
  breve_drive drive = world.drive(joint);
  drive.stiffness = problem == "damped" ? 4 : 1;
  drive.damping = problem == "damped" ? 0.3 : 0;
  drive.low[0] = -INFINITY, drive.high[0] = INFINITY;
  world.set_drive(joint, drive);
  return joint;
}

TEST(ReferenceIntegrators, GiveTheDigitsOfTheFile) {
  std::map<std::string, std::pair<double, double>> before;  // of each problem and scheme: step and error
  double first = 0, last = 0;
  for (const Row& row : read("integrators")) {
    const std::string name = row.text("problem") + ' ' + row.text("method");
    World world(row.number("h"), BREVE_RUNG_BALANCED);
    world.set_guard(BREVE_GUARD_REPORT);
    const breve_object joint = oscillator(world, row.text("problem"));
    world.set_integrator(kSchemes.at(row.text("method")));
    world.set_joint(joint, row.number("x0"), row.number("v0"));
    world.step();
    breve_joint_info info = world.read(joint);
    const double one = std::max(std::abs(info.position[0] - row.number("x_after_1")),
                                std::abs(info.velocity[0] - row.number("v_after_1")));
    EXPECT_LE(one, kOneStep) << name << " h " << row.text("h");
    for (int i = 1; i < row.integer("steps"); ++i) world.step();
    info = world.read(joint);
    const double end =
        std::max(std::abs(info.position[0] - row.number("x_end")), std::abs(info.velocity[0] - row.number("v_end")));
    EXPECT_LE(end, kOneStep * row.integer("steps")) << name << " h " << row.text("h");
    const double error = std::hypot(info.position[0] - row.number("x_exact"), info.velocity[0] - row.number("v_exact"));
    if (before.count(name) && row.text("observed_order") != "none") {
      const double order = std::log2(before[name].second / error);
      EXPECT_NEAR(order, row.number("order"), kOrder) << name << " h " << row.text("h");
    }
    before[name] = {row.number("h"), error};
    first = std::max(first, one);
    last = std::max(last, end);
  }
  std::printf("  off by at most %.1e after one step, %.1e after all\n", first, last);
}

struct Whirl {
  World world;
  breve_object body;
  Whirl(breve_integrator scheme, double h) : world(h, BREVE_RUNG_BALANCED) {
    world.set_guard(BREVE_GUARD_REPORT);
    world.set_gravity(Vector3::Zero());
    world.set_integrator(scheme);
    body = world.body(lump(1, Vector3(0.4, 0.5, 0.6).asDiagonal()), Vector3::Zero());
    world.set_spin(body, Vector3(4, 1, -3));
  }
  void add_arm() {
    Hinge hinge;
    hinge.parent = body;
    hinge.child = world.body(rod(1, 0.5), Vector3::Zero());
    hinge.parent_point = Vector3(0.3, 0, 0);
    hinge.child_point = Vector3(0, 0.5, 0);
    world.join(hinge);
  }
};

/// How wrong the attitude is after one second, rad.
double attitude_error(breve_integrator scheme, double h, bool arm, const Quaternion& exact) {
  Whirl whirl(scheme, h);
  if (arm) {
    whirl.add_arm();
    whirl.world.set_spin(whirl.body, Vector3(4, 1, -3));
  }
  whirl.world.run(1);
  return whirl.world.orientation(whirl.body).angularDistance(exact);
}

Quaternion exact_attitude(bool arm) {
  Whirl whirl(BREVE_INTEGRATOR_FEHLBERG_5, 1.0 / 8000);
  if (arm) {
    whirl.add_arm();
    whirl.world.set_spin(whirl.body, Vector3(4, 1, -3));
  }
  whirl.world.run(1);
  return whirl.world.orientation(whirl.body);
}

void attitude_has_full_order(bool arm) {
  const Quaternion exact = exact_attitude(arm);
  for (const auto& [name, scheme] : kSchemes) {
    const double h = kOrders.at(name) == 1 ? 1.0 / 4000 : kOrders.at(name) == 2 ? 1.0 / 400 : 1.0 / 50;
    const double coarse = attitude_error(scheme, h, arm, exact), fine = attitude_error(scheme, 0.5 * h, arm, exact);
    const double order = std::log2(coarse / fine);
    std::printf("  %-20s error %.1e at %g s, order %.2f\n", name.c_str(), coarse, h, order);
    EXPECT_GE(order, kOrders.at(name) - kOrder) << name;
  }
}

TEST(ReferenceIntegrators, AFreeBodyRotatesWithTheFullOrder) { attitude_has_full_order(false); }
TEST(ReferenceIntegrators, AFloatingBaseRotatesWithTheFullOrder) { attitude_has_full_order(true); }

}  // namespace
}  // namespace breve::reference
