// Spinning bodies in a world, free and with one point fixed, against the reference files and on every rung.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "table.hpp"
#include "world.hpp"

namespace breve::reference {
namespace {

constexpr breve_rung kRungs[] = {BREVE_RUNG_FAST, BREVE_RUNG_BALANCED, BREVE_RUNG_PRECISE, BREVE_RUNG_REFERENCE,
                                 BREVE_RUNG_CONSERVING};
constexpr const char* kNames[] = {"fast", "balanced", "precise", "reference", "conserving"};

Vector3 three_numbers(const Row& row, const std::string& x, const std::string& y, const std::string& z) {
  return Vector3(row.number(x), row.number(y), row.number(z));
}

Quaternion attitude(const Row& row) {
  return Quaternion(row.number("qw"), row.number("qx"), row.number("qy"), row.number("qz"));
}

/// Which row of a file is wrong by how much: spin in body axes relative to its size, attitude in rad.
double error_of(const World& world, breve_object body, const Row& row) {
  const Vector3 expected = three_numbers(row, "w1", "w2", "w3");
  const Vector3 own = world.orientation(body).conjugate() * world.spin(body);
  return std::max((own - expected).norm() / std::max(1.0, expected.norm()),
                  world.orientation(body).angularDistance(attitude(row)));
}

struct FreeTop {
  World world;
  Matrix3 inertia;
  breve_object body;
  FreeTop(const Row& row, double step, breve_rung rung)
      : world(step, rung), inertia(three_numbers(row, "I1", "I2", "I3").asDiagonal()) {
    world.set_guard(BREVE_GUARD_REPORT);
    world.set_gravity(Vector3::Zero());
    body = world.body(lump(1, inertia), Vector3::Zero());
    world.set_spin(body, three_numbers(row, "w1_0", "w2_0", "w3_0"));
  }
};

/// The first step that reaches the given moment in a whole number of steps, below a longest one.
double step_for(double t, double longest) { return t / std::ceil(t / longest); }

TEST(ReferenceTops, AFreeBodyRotatesAsTheFileSays) {
  for (const std::vector<Row>& rows : groups("top_free", "case")) {
    double worst = 0;
    for (const Row& row : rows) {
      FreeTop top(row, step_for(row.number("t"), 0.05), BREVE_RUNG_REFERENCE);
      top.world.run(row.number("t"));
      const double error = error_of(top.world, top.body, row);
      EXPECT_LE(error, 1e-7) << row.text("case") << " at " << row.text("t");
      worst = std::max(worst, error);
    }
    std::printf("  %-7s largest error %.1e\n", rows.front().text("case").c_str(), worst);
  }
}

TEST(ReferenceTops, KineticEnergyNeverGrows) {
  for (const std::vector<Row>& rows : groups("top_free", "case")) {
    for (const std::size_t rung : {0U, 1U, 3U, 4U}) {
      FreeTop top(rows.front(), 1.0 / 60, kRungs[rung]);
      const double start = top.world.energy().kinetic;
      double most = start, least = start;
      top.world.run(10, [&] {
        const double now = top.world.energy().kinetic;
        most = std::max(most, now);
        least = std::min(least, now);
      });
      // Round-off of 600 steps, and the tolerance of the rungs that have one.
      EXPECT_LE(most / start - 1, 1e-9) << rows.front().text("case") << " on " << kNames[rung];
      EXPECT_GT(least, 0.5 * start) << rows.front().text("case") << " on " << kNames[rung];
      std::printf("  %-7s %-10s kinetic energy %+.1e %+.1e\n", rows.front().text("case").c_str(), kNames[rung],
                  most / start - 1, least / start - 1);
    }
  }
}

/// A symmetric top whose point stands at the origin; gravity along -z.
struct HeavyTop {
  World world;
  breve_object body;
  double length;
  HeavyTop(const Row& row, double step, breve_rung rung) : world(step, rung), length(row.number("l")) {
    const double mass = row.number("mass"), theta = row.number("theta0");
    const double across = row.number("I1_pivot") - mass * length * length;
    world.set_guard(BREVE_GUARD_REPORT);
    world.set_gravity(Vector3(0, 0, -9.81));
    body = world.body(lump(mass, Vector3(across, across, row.number("I3")).asDiagonal()), Vector3::Zero());
    Hinge point;
    point.kind = BREVE_JOINT_BALL;
    point.child = body;
    point.child_point = Vector3(0, 0, -length);
    point.rotation = Quaternion(Eigen::AngleAxisd(theta, Vector3::UnitY()));
    const breve_object joint = world.join(point);
    breve_drive drive = world.drive(joint);
    for (int k = 0; k < 3; ++k) drive.low[k] = -INFINITY, drive.high[k] = INFINITY;
    world.set_drive(joint, drive);
    const Vector3 own(-row.number("phidot0") * std::sin(theta), row.number("thetadot0"), row.number("omega3"));
    const Vector3 spin = point.rotation * own;
    world.set_spin(body, spin);
    world.set_velocity(body, spin.cross(world.at(body)));
  }
};

TEST(ReferenceTops, AHeavyTopPrecessesAsTheFileSays) {
  for (const std::vector<Row>& rows : groups("top_heavy", "case")) {
    double worst = 0;
    for (const Row& row : rows) {
      HeavyTop top(row, step_for(row.number("t"), 0.05), BREVE_RUNG_REFERENCE);
      top.world.run(row.number("t"));
      const double error = error_of(top.world, top.body, row);
      EXPECT_LE(error, 1e-7) << row.text("case") << " at " << row.text("t");
      worst = std::max(worst, error);
    }
    std::printf("  %-7s largest error %.1e\n", rows.front().text("case").c_str(), worst);
  }
}

TEST(ReferenceTops, AHeavyTopKeepsItsEnergy) {
  for (const std::vector<Row>& rows : groups("top_heavy", "case")) {
    for (std::size_t rung = 1; rung < 5; ++rung) {
      HeavyTop top(rows.front(), 1.0 / 60, kRungs[rung]);
      const double start = top.world.mechanical();
      const double scale = top.world.energy().kinetic;
      double most = 0, least = 0;
      top.world.run(10, [&] {
        most = std::max(most, (top.world.mechanical() - start) / scale);
        least = std::min(least, (top.world.mechanical() - start) / scale);
      });
      EXPECT_LE(most, 0.01) << rows.front().text("case") << " on " << kNames[rung];
      EXPECT_TRUE(top.world.spin(top.body).allFinite());
      std::printf("  %-7s %-10s energy %+.1e %+.1e\n", rows.front().text("case").c_str(), kNames[rung], most, least);
    }
  }
}

}  // namespace
}  // namespace breve::reference
