// Coulomb's friction in a world, on `balanced`, against the reference files: sliding, sticking, tipping, rolling.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "scenes.hpp"
#include "table.hpp"

namespace breve::reference {
namespace {

constexpr double kAngle = 0.05 * kPi / 180;  // the bound on thresholds
constexpr double kFriction = 0.01;           // the bound on friction's strength in every direction

/// A body on a slope that rises toward +x, with friction as given between the two.
struct Slope {
  World world;
  double tilt;
  breve_object body;
  Slope(double angle, double static_friction, double dynamic_friction, const Solid& solid, double height)
      : world(1.0 / 60, BREVE_RUNG_BALANCED), tilt(angle) {
    world.set_guard(BREVE_GUARD_REPORT);
    const breve_object plane = incline(world, tilt);
    const bool round = solid.geometry.kind == BREVE_SHAPE_SPHERE;
    body = world.body(solid, height * across(tilt),
                      round ? Quaternion::Identity() : Quaternion(Eigen::AngleAxisd(tilt, Vector3::UnitZ())));
    for (const breve_object one : {plane, body})
      world.set_material(one, breve_material{static_friction, dynamic_friction, 0, 0, 0});
  }
  double x() const { return along(tilt).dot(world.at(body)); }
  double v() const { return along(tilt).dot(world.velocity(body)); }
};

Solid flat_block() { return box(Vector3(0.4, 0.05, 0.4), 1); }

/// Runs to a time that need not be a whole number of steps: the rest in a straight line.
double position_at(Slope& slope, double t) {
  slope.world.run(std::floor((t - slope.world.time()) * 60 + 1e-9) / 60);
  return slope.x() + slope.v() * (t - slope.world.time());
}

TEST(ReferenceFriction, BlocksSlideAndStickAsTheFileSays) {
  for (const std::vector<Row>& rows : groups("sliding_block", "case")) {
    const Row& first = rows.front();
    Slope slope(first.number("incline_deg") * kPi / 180, first.number("mu_static"), first.number("mu_dynamic"),
                flat_block(), 0.025);
    slope.world.set_velocity(slope.body, first.number("v0_upslope") * along(slope.tilt));
    for (const Row& row : rows) {
      const double x = position_at(slope, row.number("t")), v = slope.v();
      std::printf("  %-12s at %4.1f s: x off by %+.1e, v by %+.1e\n", row.text("case").c_str(), row.number("t"),
                  x - row.number("x"), v - row.number("v"));
      EXPECT_NEAR(x, row.number("x"), kFriction * std::max(0.1, std::abs(row.number("x"))))
          << row.text("case") << ' ' << row.text("t");
      EXPECT_NEAR(v, row.number("v"), kFriction * std::max(1.0, std::abs(row.number("v"))))
          << row.text("case") << ' ' << row.text("t");
    }
  }
}

TEST(ReferenceFriction, ItIsAsStrongInEveryDirection) {
  double worst = 0;
  for (const Row& row : read("friction_isotropy")) {
    Slope slope(0, row.number("mu"), row.number("mu"), flat_block(), 0.025);
    slope.world.run(0.1);  // it comes to rest first, and is then pushed along the floor
    const double angle = row.number("direction_deg") * kPi / 180;
    slope.world.set_force(slope.body, row.number("force") * Vector3(std::cos(angle), 0, std::sin(angle)));
    slope.world.run(1);
    const Vector3 expected(row.number("vx_at_1s"), 0, row.number("vy_at_1s"));
    const double error = (slope.world.velocity(slope.body) - expected).norm();
    EXPECT_LE(error, kFriction * 2.076) << row.text("direction_deg") << ' ' << row.text("force");
    worst = std::max(worst, error);
  }
  std::printf("  isotropy: velocity off by at most %.1e of 2.076 m/s\n", worst);
}

TEST(ReferenceFriction, BoxesTipAndSlideBeyondTheirAngles) {
  for (const Row& row : read("box_on_incline")) {
    for (const double beyond : {-kAngle, kAngle}) {
      const double width = row.number("width_along_slope"), height = row.number("height"), mu = row.number("mu");
      Slope slope(row.number("critical_angle_deg") * kPi / 180 + beyond, mu, mu, box(Vector3(width, height, 1), 1),
                  0.5 * height);
      const double x = slope.x();
      const Quaternion orientation = slope.world.orientation(slope.body);
      slope.world.run(3);
      const double slid = std::abs(slope.x() - x),
                   tipped = slope.world.orientation(slope.body).angularDistance(orientation);
      std::printf("  %.1f x %.1f at %+.2f degrees: slid %.1e m, tipped %.1e rad\n", width, height, beyond * 180 / kPi,
                  slid, tipped);
      if (beyond < 0) {
        EXPECT_LE(slid, 1e-3) << row.text("first");
        EXPECT_LE(tipped, 1e-3) << row.text("first");
      } else {
        EXPECT_GE(row.text("first") == "tips" ? tipped : slid, 0.01) << row.text("first");
      }
    }
  }
}

Solid ball_of(const Row& row) {
  const double radius = row.number("radius");
  Solid out = sphere(radius, 1);
  out.inertia = Matrix3::Identity() * (row.number("I_over_mr2") * radius * radius);
  return out;
}

TEST(ReferenceFriction, RoundBodiesRollDownAsTheFileSays) {
  for (const Row& row : read("rolling_incline")) {
    const double mu = row.number("mu"), radius = row.number("radius");
    Slope slope(row.number("incline_deg") * kPi / 180, mu, mu, ball_of(row), radius);
    slope.world.run(row.number("t"));
    const double x = -slope.x(), v = -slope.v(), omega = slope.world.spin(slope.body).z();
    std::printf("  %-8s %2.0f degrees: x off by %+.1e of itself, v by %+.1e, spin by %+.1e\n",
                row.text("shape").c_str(), row.number("incline_deg"), x / row.number("x_downslope") - 1,
                v / row.number("v") - 1, omega / row.number("omega") - 1);
    EXPECT_NEAR(x, row.number("x_downslope"), kFriction * row.number("x_downslope"));
    EXPECT_NEAR(v, row.number("v"), kFriction * row.number("v"));
    EXPECT_NEAR(omega, row.number("omega"), kFriction * row.number("omega"));
  }
}

TEST(ReferenceFriction, SlidingTurnsIntoRollingAsTheFileSays) {
  for (const Row& row : read("slip_to_roll")) {
    const double mu = row.number("mu"), radius = row.number("radius"), end = row.number("t_roll") + 0.5;
    Slope slope(0, mu, mu, ball_of(row), radius);
    slope.world.set_velocity(slope.body, Vector3(row.number("v0"), 0, 0));
    slope.world.set_spin(slope.body, Vector3(0, 0, -row.number("omega0")));
    const double expected = row.number("x_at_roll") + 0.5 * row.number("v_final");
    const double x = position_at(slope, end), v = slope.v(), omega = -slope.world.spin(slope.body).z();
    const double speed = std::max(row.number("v0"), std::abs(row.number("omega0")) * radius);
    std::printf("  %-8s x off by %+.1e, v by %+.1e, spin by %+.1e\n", row.text("shape").c_str(), x - expected,
                v - row.number("v_final"), omega - row.number("omega_final"));
    EXPECT_NEAR(x, expected, kFriction * std::abs(expected));
    EXPECT_NEAR(v, row.number("v_final"), kFriction * speed);
    EXPECT_NEAR(omega * radius, row.number("omega_final") * radius, kFriction * speed);
  }
}

/// A uniform rod whose lower tip touches the ground and slides toward -x; the rest of it is on the +x side.
TEST(ReferenceFriction, TheRodOfPainleveGetsAFiniteAnswer) {
  double cone = 0, energy = -INFINITY, depth = 0, force = 0;
  for (const Row& row : read("painleve_rod")) {
    const double h = 1e-4, theta = row.number("theta_deg") * kPi / 180, mu = row.number("mu"), slip = 2;
    World world(h, BREVE_RUNG_BALANCED);
    world.set_guard(BREVE_GUARD_REPORT);
    const breve_object floor = incline(world, 0);
    const Vector3 tip = -0.5 * Vector3(std::cos(theta), std::sin(theta), 0);
    const Matrix3 inertia = Matrix3::Identity() / 12;
    const breve_object body = world.body(needle(tip, 1, inertia), -tip);
    for (const breve_object one : {floor, body}) world.set_material(one, mu, 0);
    const Vector3 spin(0, 0, row.number("omega"));
    const Vector3 velocity = Vector3(-slip, 0, 0) - spin.cross(tip);
    world.set_spin(body, spin);
    world.set_velocity(body, velocity);
    const double before = world.mechanical();
    world.step();
    const Vector3 impulse = world.velocity(body) - velocity - Vector3(0, -9.81 * h, 0);
    ASSERT_TRUE(impulse.allFinite() && world.spin(body).allFinite());
    cone = std::max(cone, std::hypot(impulse.x(), impulse.z()) - mu * impulse.y());
    energy = std::max(energy, world.mechanical() - before);
    const Vector3 low = world.at(body) + world.orientation(body) * tip;
    depth = std::max(depth, -low.y());
    // What the turning of the rod adds to the force comes a step later.
    const bool slides = row.text("class") == "slides" && row.number("omega") == 0;
    // Where the force is so large that the rod turns much within a step, another force is right.
    const double expected = slides ? row.number("N_per_mass_if_sliding") : INFINITY;
    if (expected < 50) force = std::max(force, std::abs(impulse.y() / h - expected) / expected);
  }
  std::printf("  rod: out of the cone by %.1e N*s, energy %+.1e J, depth %.1e m, force while sliding off by %.1e\n",
              cone, energy, depth, force);
  EXPECT_LE(cone, 1e-9);
  EXPECT_LE(energy, 1e-9);
  EXPECT_LE(depth, 1e-6);
  EXPECT_LE(force, kFriction);
}

}  // namespace
}  // namespace breve::reference
