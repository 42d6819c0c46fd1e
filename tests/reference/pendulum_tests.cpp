// Pendulums and oscillators in a world, against the reference files.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "scenes.hpp"
#include "table.hpp"

namespace breve::reference {
namespace {

/// The bound on `reference`: what double precision allows where a tiny change has grown so much.
double allowed(double amplification) { return std::max(1e-7, 1e-16 * amplification * 1e3); }

TEST(ReferencePendulum, RodsInAPlaneFollowTheFile) {
  for (const std::vector<Row>& rows : groups("planar_pendulum", "case")) {
    World world(0.05, BREVE_RUNG_REFERENCE);
    std::vector<double> lengths, masses, angles, rates;
    for (const Row& row : rows) {
      if (row.number("t") != rows.front().number("t")) break;
      lengths.push_back(row.number("length"));
      masses.push_back(row.number("mass"));
      angles.push_back(row.number("theta0"));
      rates.push_back(row.number("omega0"));
    }
    const Chain chain = hang(world, lengths, masses);
    start(world, chain, angles, rates);
    double worst = 0;
    for (const Row& row : rows) {
      world.run(row.number("t") - world.time());
      const auto link = static_cast<std::size_t>(row.integer("rod"));
      const double error = std::max(std::abs(chain.total(world, link) - row.number("theta")),
                                    std::abs(chain.rate(world, link) - row.number("omega")));
      EXPECT_LE(error, allowed(row.number("amplification"))) << row.text("case") << " at " << row.text("t");
      worst = std::max(worst, error);
    }
    std::printf("  %-12s largest error %.1e\n", rows.front().text("case").c_str(), worst);
  }
}

TEST(ReferencePendulum, PeriodsAreRightAtEveryAmplitude) {
  double worst = 0;
  for (const Row& row : read("pendulum_period")) {
    const double length = row.number("dimensions_m"), period = row.number("period");
    const double amplitude = row.number("amplitude_deg") * kPi / 180;
    // It passes the lowest point, where time can be read off, after one and after three quarters.
    World world(period / 400, BREVE_RUNG_REFERENCE);
    const bool point = row.text("kind") == "point";
    const Solid solid = point ? lump(1, 1e-12 * Matrix3::Identity()) : rod(length, 1);
    Hinge hinge;
    hinge.child = world.body(solid, Vector3::Zero());
    hinge.child_point = Vector3(0, point ? length : 0.5 * length, 0);
    hinge.normal = -Vector3::UnitZ();
    const breve_object joint = world.join(hinge);
    world.set_joint(joint, amplitude, 0);
    for (const double quarters : {1.0, 3.0}) {
      world.run(0.25 * quarters * period - world.time());
      const breve_joint_info info = world.read(joint);
      const double late = std::abs(info.position[0] / info.velocity[0]) / period;
      // How much sooner it comes for a tiny change of the start: 1 / cos(amplitude / 2), roughly.
      EXPECT_LE(late, allowed(1 / std::cos(0.5 * amplitude))) << row.text("kind") << ' ' << row.text("amplitude_deg");
      worst = std::max(worst, late);
    }
  }
  std::printf("  quarter periods off by at most %.1e of the period\n", worst);
}

TEST(ReferencePendulum, SpringsInJointsOscillateAsTheFileSays) {
  for (const std::vector<Row>& rows : groups("oscillator", "case")) {
    const Row& first = rows.front();
    World world(first.number("t"), BREVE_RUNG_REFERENCE);
    world.set_gravity(Vector3::Zero());
    Hinge slide;
    slide.kind = BREVE_JOINT_PRISMATIC;
    slide.child = world.body(box(Vector3(0.1, 0.1, 0.1), first.number("mass")), Vector3::Zero());
    slide.normal = -Vector3::UnitX();
    const breve_object joint = world.join(slide);
    breve_drive drive = world.drive(joint);
    drive.stiffness = first.number("stiffness");
    drive.damping = first.number("damping");
    world.set_drive(joint, drive);
    world.set_joint(joint, first.number("x0"), first.number("v0"));
    const double speed = std::max(1.0, first.number("x0") * std::sqrt(drive.stiffness / first.number("mass")));
    double worst = 0;
    for (const Row& row : rows) {
      world.run(row.number("t") - world.time());
      const breve_joint_info info = world.read(joint);
      EXPECT_NEAR(info.position[0], row.number("x"), 1e-7) << row.text("case") << " at " << row.text("t");
      EXPECT_NEAR(info.velocity[0], row.number("v"), 1e-7 * speed) << row.text("case") << " at " << row.text("t");
      worst = std::max(
          {worst, std::abs(info.position[0] - row.number("x")), std::abs(info.velocity[0] - row.number("v")) / speed});
    }
    std::printf("  %-9s largest error %.1e\n", first.text("case").c_str(), worst);
  }
}

}  // namespace
}  // namespace breve::reference
