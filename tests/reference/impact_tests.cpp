// Bodies that bounce, in a world: times of impact, rows of balls, counting to pi; read from the events of collisions.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "scenes.hpp"
#include "table.hpp"

namespace breve::reference {
namespace {

constexpr double kTime = 1e-9;    // s, the bound on times of impact on `precise`
constexpr double kRadius = 0.01;  // m, of balls in a row: a hundred times the tightest gap

/// A ball over a floor, as bounce_impacts describes it.
struct Bouncing {
  World world;
  breve_object ball;
  explicit Bouncing(const Row& row, double step, breve_rung rung) : world(step, rung) {
    world.set_gravity(Vector3(0, -row.number("g"), 0));
    const breve_object floor = incline(world, 0);
    ball = world.body(sphere(0.5, 1), Vector3(0, 0.5 + row.number("gap0"), 0));
    world.set_velocity(ball, Vector3(0, row.number("v0"), 0));
    for (const breve_object one : {floor, ball}) world.set_material(one, 0, row.number("e"));
  }
};

TEST(ReferenceImpacts, ABallBouncesAtTheTimesOfTheFile) {
  for (const std::vector<Row>& rows : groups("bounce_impacts", "case")) {
    Bouncing scene(rows.front(), 1.0 / 60, BREVE_RUNG_PRECISE);
    scene.world.set_guard(BREVE_GUARD_REPORT);
    std::vector<breve_impact> seen;
    scene.world.run(std::min(20.0, rows.back().number("time") + 0.1), [&] {
      for (const breve_impact& impact : scene.world.impacts()) seen.push_back(impact);
    });
    double worst = 0, speed = 0;
    std::size_t compared = 0;
    for (const Row& row : rows) {
      if (compared == seen.size()) break;
      const breve_impact& impact = seen[compared];
      // Impulse of 1 kg: what its velocity changes by.
      const double change = std::abs(impact.impulse[1]);
      worst = std::max(worst, std::abs(impact.time - row.number("time")));
      speed = std::max(speed, std::abs(change - (row.number("v_after") - row.number("v_before"))));
      ++compared;
      if (row.number("time") > 19.9) break;
    }
    std::printf("  %-6s %zu of %zu impacts: time off by %.1e, impulse by %.1e; slowest %.1e m/s\n",
                rows.front().text("case").c_str(), compared, rows.size(), worst, speed,
                rows[compared - 1].number("v_before"));
    EXPECT_GE(compared, std::min<std::size_t>(rows.size(), 6)) << rows.front().text("case");
    EXPECT_LE(worst, kTime) << rows.front().text("case");
    EXPECT_LE(speed, 1e-9) << rows.front().text("case");
  }
}

TEST(ReferenceImpacts, ABallStandsWhereTheFileSays) {
  std::map<std::string, Row> starts;
  for (const Row& row : read("bounce_impacts")) starts.emplace(row.text("case"), row);
  for (const std::vector<Row>& rows : groups("bounce_state", "case")) {
    Bouncing scene(starts.at(rows.front().text("case")), 1.0 / 200, BREVE_RUNG_BALANCED);
    for (const Row& row : rows) {
      scene.world.run(row.number("t") - scene.world.time());
      const double gap = scene.world.at(scene.ball).y() - 0.5, speed = scene.world.velocity(scene.ball).y();
      std::printf("  %-6s at %4.1f s: gap off by %.1e, speed by %.1e\n", row.text("case").c_str(), row.number("t"),
                  gap - row.number("gap"), speed - row.number("v"));
      const bool rests = row.text("impacts_so_far") == "at rest";
      EXPECT_NEAR(gap, row.number("gap"), rests ? 1e-4 : 1e-6) << row.text("case") << ' ' << row.text("t");
      EXPECT_NEAR(speed, row.number("v"), rests ? 1e-4 : 1e-6) << row.text("case") << ' ' << row.text("t");
    }
  }
}

/// Bodies whose handler notes the clock at the first touch: it is called at the moment of impact.
const std::string kListening = R"(
@use PhysicalControl.
@use Stationary.
@use RevoluteJoint.
Controller Lab.

PhysicalControl : Lab {
  + variables: first (double).
  + to init: first = -1.
  + to note: if first < 0: first = (self get-time).
}
Mobile : Ball {
  + to init:
    self handle-collisions with-type "Ball" with-method "touch".
    self handle-collisions with-type "Stationary" with-method "touch".
  + to touch with other (object): controller note.
}
)";

/// When the first handler was called in some seconds; negative: there was no touch.
double first_touch(World& world, double seconds) {
  world.run(seconds);
  breve_value first;
  world.must(breve_object_get(world.get(), breve_world_controller(world.get()), "first", &first));
  return first.as.number;
}

constexpr double kThin = 1e-9;  // m, of what the file has as a line

/// Builds the scene of a row of time_of_impact; false: one that is not made of rigid bodies alone.
bool build(World& world, const std::string& name) {
  const auto plane = [&] { world.fixed(box(Vector3(100, 100, 10), 1), Vector3(0, 0, -5)); };
  const auto thrown = [&](double radius, const Vector3& at, const Vector3& velocity) {
    world.set_velocity(world.body(sphere(radius, 1), at), velocity);
  };
  world.set_gravity(Vector3::Zero());
  if (name == "sphere_drop") {
    world.set_gravity(Vector3(0, 0, -9.81));
    plane();
    thrown(0.5, Vector3(0, 0, 10), Vector3::Zero());
  } else if (name == "sphere_sphere") {
    thrown(0.4, Vector3::Zero(), Vector3(3, 1, 0));
    thrown(0.6, Vector3(10, 3.8, 0), Vector3::Zero());
  } else if (name == "graze_miss" || name == "graze_hit") {
    thrown(0.5, Vector3::Zero(), Vector3(7, 0, 0));
    thrown(0.5, Vector3(10, name == "graze_hit" ? 0.9999999 : 1.0000001, 0), Vector3::Zero());
  } else if (name == "bullet") {
    world.fixed(box(Vector3(0.001, 10, 10), 1), Vector3(5, 0, 0));
    thrown(0.01, Vector3::Zero(), Vector3(1000, 0, 0));
  } else if (name == "spinning_box") {
    world.set_gravity(Vector3(0, 0, -9.81));
    plane();
    const breve_object one = world.body(box(Vector3(1, 0.6, 0.4), 1), Vector3(0, 0, 1.5),
                                        Quaternion(Eigen::AngleAxisd(0.2, Vector3::UnitY())));
    world.set_velocity(one, Vector3(0, 0, -2));
    world.set_spin(one, Vector3(0, 15, 0));
  } else if (name == "spinning_rod") {
    world.set_gravity(Vector3(0, 0, -9.81));
    plane();
    Solid rod = box(Vector3(kThin, kThin, 1), 1);
    // About its own axis, where it does not turn, more than a line has: or the impact would spin it up without bound.
    rod.inertia = Vector3(1.0 / 12, 1.0 / 12, 0.01).asDiagonal();
    const breve_object one = world.body(rod, Vector3(0, 0, 2), Quaternion(Eigen::AngleAxisd(0.3, Vector3::UnitY())));
    world.set_spin(one, Vector3(0, 10, 0));
  } else if (name == "arm_on_peg") {
    Solid peg;
    peg = sphere(0.05, 1);
    world.fixed(peg, Vector3(0, 0.8, 0));
    Hinge hinge;
    Solid arm = box(Vector3(1, kThin, kThin), 1);
    arm.inertia = Vector3(0.01, 1.0 / 12, 1.0 / 12).asDiagonal();
    hinge.child = world.body(arm, Vector3(0.5, 0, 0));
    hinge.child_point = Vector3(-0.5, 0, 0);
    hinge.normal = -Vector3::UnitZ();
    world.set_joint(world.join(hinge), 0, 4);
  } else {
    return false;
  }
  return true;
}

TEST(ReferenceImpacts, FirstTouchesAreAtTheTimesOfTheFile) {
  int built = 0;
  for (const Row& row : read("time_of_impact")) {
    World world(1.0 / 60, BREVE_RUNG_PRECISE, kListening);
    world.body_class = "Ball";
    if (!build(world, row.text("case"))) continue;
    ++built;
    const double found = first_touch(world, 3.5);
    if (row.text("time") == "miss") {
      EXPECT_LT(found, 0) << row.text("case");
    } else {
      EXPECT_NEAR(found, row.number("time"), kTime) << row.text("case");
      std::printf("  %-14s off by %.1e s\n", row.text("case").c_str(), found - row.number("time"));
    }
  }
  EXPECT_EQ(built, 8);
}

TEST(ReferenceImpacts, RowsOfBallsPassTheShockOn) {
  for (const std::vector<Row>& rows : groups("collision_chain", "case")) {
    World world(1.0 / 60, BREVE_RUNG_PRECISE);
    world.set_gravity(Vector3::Zero());
    std::vector<breve_object> balls;
    for (const Row& row : rows) {
      const double gaps = row.number("x0_surface_gap_frame"),
                   diameters = 2 * kRadius * static_cast<double>(balls.size());
      balls.push_back(world.body(sphere(kRadius, row.number("mass")), Vector3(gaps + diameters, 0, 0)));
      world.set_velocity(balls.back(), Vector3(row.number("v_before"), 0, 0));
      world.set_material(balls.back(), 0, row.number("e"));
    }
    std::uint64_t impacts = 0;
    double last = 0;
    world.run(1, [&] {
      for (const breve_impact& impact : world.impacts()) ++impacts, last = impact.time;
    });
    double worst = 0;
    for (std::size_t i = 0; i < balls.size(); ++i)
      worst = std::max(worst, (world.velocity(balls[i]) - Vector3(rows[i].number("v_after"), 0, 0)).norm());
    std::printf("  %-12s %lu impacts, last off by %.1e s, velocities by %.1e\n", rows.front().text("case").c_str(),
                impacts, last - rows.front().number("time_of_last"), worst);
    EXPECT_EQ(impacts, static_cast<std::uint64_t>(rows.front().integer("collisions"))) << rows.front().text("case");
    EXPECT_NEAR(last, rows.front().number("time_of_last"), kTime) << rows.front().text("case");
    EXPECT_LE(worst, 1e-9) << rows.front().text("case");
  }
}

TEST(ReferenceImpacts, TwoBlocksAndAWallCountTheDigitsOfPi) {
  for (const Row& row : read("billiard_pi")) {
    World world(1.0 / 60, BREVE_RUNG_PRECISE);
    world.set_gravity(Vector3::Zero());
    breve_accuracy accuracy = world.accuracy();
    accuracy.impacts = 10000;  // 3,141 of them within a few hundredths of a second
    world.set_accuracy(accuracy);
    const double radius = 0.25;
    const breve_object wall = world.fixed(box(Vector3(1, 4, 4), 1), Vector3(-0.5, 0, 0));
    const breve_object small =
        world.body(sphere(radius, row.number("mass_small")), Vector3(row.number("x_small0") + radius, 0, 0));
    const breve_object big =
        world.body(sphere(radius, row.number("mass_big")), Vector3(row.number("x_big0") + 3 * radius, 0, 0));
    world.set_velocity(big, Vector3(row.number("v_big0"), 0, 0));
    for (const breve_object one : {wall, small, big}) world.set_material(one, 0, 1);
    int impacts = 0;
    double last = 0;
    world.run(row.number("time_of_last") + 0.5, [&] {
      for (const breve_impact& impact : world.impacts()) ++impacts, last = impact.time;
    });
    std::printf("  %7.0f : 1   %d collisions, last off by %.1e s, velocities by %.1e and %.1e\n",
                row.number("mass_big"), impacts, last - row.number("time_of_last"),
                world.velocity(big).x() - row.number("v_big_final"),
                world.velocity(small).x() - row.number("v_small_final"));
    EXPECT_EQ(impacts, row.integer("collisions"));
    EXPECT_NEAR(world.velocity(big).x(), row.number("v_big_final"), 1e-9);
    EXPECT_NEAR(world.velocity(small).x(), row.number("v_small_final"), 1e-6);
  }
}

}  // namespace
}  // namespace breve::reference
