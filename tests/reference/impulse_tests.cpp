// The impact law in a world: impulses of Chatterjee and Ruina, read from the events of collisions.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "scenes.hpp"
#include "table.hpp"

namespace breve::reference {
namespace {

constexpr double kImpulse = 1e-10;  // the bound on impulses, relative
constexpr double kStep = 1e-6;      // s, so short that what else happens in it is of that size

Vector3 numbers(const Row& row, const std::string& stem) {
  return Vector3(row.number(stem + "x"), row.number(stem + "y"), row.number(stem + "z"));
}

Matrix3 inertia_of(const Row& row, const std::string& body) {
  const auto element = [&](const char* name) { return row.number("I_" + body + "_" + name); };
  Matrix3 inertia;
  inertia << element("xx"), element("xy"), element("xz"), element("xy"), element("yy"), element("yz"), element("xz"),
      element("yz"), element("zz");
  return inertia;
}

void set_law(World& world, breve_object body, const Row& row) {
  world.set_material(body, row.number("mu"), row.number("e"), row.number("e_t"));
}

/// A box about `centre` with one face through the point `c`, where its normal is `n`. It is wide enough to hold c.
Solid slab(const Vector3& centre, const Vector3& c, const Vector3& n, Quaternion* orientation) {
  *orientation = Quaternion::FromTwoVectors(Vector3::UnitZ(), n);
  const double depth = n.dot(c - centre), side = 4 * (c - centre).norm() + 2;
  return box(Vector3(side, side, 2 * depth), 1);
}

struct Pair {
  breve_object a, b;
};

Pair build_pair(World& world, const Row& row) {
  const Vector3 c = numbers(row, "c"), n = numbers(row, "n").normalized();
  Pair out;
  Quaternion orientation;
  if (row.text("m_A") == "fixed") {
    const Vector3 centre = c - n;
    const Solid solid = slab(centre, c, n, &orientation);
    out.a = world.fixed(solid, centre, orientation);
  } else {
    const Vector3 centre = numbers(row, "x_A_");
    Solid solid = slab(centre, c, n, &orientation);
    solid.mass = row.number("m_A");
    const Matrix3 rotation = orientation.toRotationMatrix();
    solid.inertia = rotation.transpose() * inertia_of(row, "A") * rotation;
    out.a = world.body(solid, centre, orientation);
    world.set_velocity(out.a, numbers(row, "v_A_"));
    world.set_spin(out.a, numbers(row, "w_A_"));
  }
  const Vector3 centre = numbers(row, "x_B_");
  out.b = world.body(needle(c - centre, row.number("m_B"), inertia_of(row, "B")), centre);
  world.set_velocity(out.b, numbers(row, "v_B_"));
  world.set_spin(out.b, numbers(row, "w_B_"));
  set_law(world, out.a, row);
  set_law(world, out.b, row);
  return out;
}

TEST(ReferenceImpulses, FreeBodiesCollideAsTheFileSays) {
  int cases = 0;
  for (const Row& row : read("cr_collisions")) {
    World world(kStep, BREVE_RUNG_PRECISE);
    world.set_guard(BREVE_GUARD_REPORT);
    world.set_gravity(Vector3::Zero());
    const Pair pair = build_pair(world, row);
    world.step();
    const std::vector<breve_impact> impacts = world.impacts();
    ++cases;
    EXPECT_EQ(impacts.size(), 1U) << row.text("case");
    if (impacts.empty()) continue;
    const breve_impact& impact = impacts.front();
    const Vector3 on_b = (same(impact.a, pair.b) ? 1 : -1) * vector(impact.impulse);
    const double error = (on_b - numbers(row, "P_")).norm() / numbers(row, "P_").norm();
    EXPECT_LE(error, kImpulse) << row.text("case");
    const double after = (world.velocity(pair.b) - numbers(row, "vB_after_")).norm() / numbers(row, "v_B_").norm();
    EXPECT_LE(after, kImpulse) << row.text("case");
    std::printf("  %-16s impulse off by %.1e, velocity by %.1e\n", row.text("case").c_str(), error, after);
  }
  EXPECT_EQ(cases, 8);
}

TEST(ReferenceImpulses, PendulumsStrikeAsTheFileSays) {
  for (const Row& row : read("cr_pendulum")) {
    World world(kStep, BREVE_RUNG_PRECISE);
    world.set_guard(BREVE_GUARD_REPORT);
    world.set_gravity(Vector3::Zero());
    // The file's z is our y.
    Chain chain;
    const double lengths[] = {row.number("L1"), row.number("L2")}, masses[] = {row.number("m1"), row.number("m2")};
    for (int i = 0; i < 2; ++i) {
      const double across = masses[i] * lengths[i] * lengths[i] / 12;
      const Matrix3 inertia = Vector3(across, 1e-4 * across, across).asDiagonal();
      Hinge hinge;
      hinge.child = world.body(needle(Vector3(0, -0.5 * lengths[i], 0), masses[i], inertia), Vector3::Zero());
      hinge.child_point = Vector3(0, 0.5 * lengths[i], 0);
      hinge.normal = -Vector3::UnitZ();
      if (i > 0) hinge.parent = chain.links[0], hinge.parent_point = Vector3(0, -0.5 * lengths[0], 0);
      chain.links.push_back(hinge.child);
      chain.joints.push_back(world.join(hinge));
    }
    start(world, chain, {row.number("theta1"), row.number("theta2")}, {row.number("omega1"), row.number("omega2")});
    const Vector3 n(row.number("nx"), row.number("nz"), 0);
    const Vector3 tip = lengths[0] * Vector3(std::sin(row.number("theta1")), -std::cos(row.number("theta1")), 0) +
                        lengths[1] * Vector3(std::sin(row.number("theta2")), -std::cos(row.number("theta2")), 0);
    const breve_object wall =
        world.fixed(box(Vector3(10, 2, 10), 1), tip - n, Quaternion::FromTwoVectors(Vector3::UnitY(), n));
    set_law(world, wall, row);
    set_law(world, chain.links[1], row);
    world.step();
    const std::vector<breve_impact> impacts = world.impacts();
    EXPECT_EQ(impacts.size(), 1U) << row.text("case");
    if (impacts.empty()) continue;
    const Vector3 expected(row.number("P_x"), row.number("P_z"), 0);
    const Vector3 got = (same(impacts[0].a, chain.links[1]) ? 1 : -1) * vector(impacts[0].impulse);
    const double error = (got - expected).norm() / expected.norm();
    EXPECT_LE(error, kImpulse) << row.text("case");
    EXPECT_NEAR(chain.rate(world, 0), row.number("omega1_after"), 20 * kStep) << row.text("case");
    EXPECT_NEAR(chain.rate(world, 1), row.number("omega2_after"), 20 * kStep) << row.text("case");
    std::printf("  %-22s impulse off by %.1e\n", row.text("case").c_str(), error);
  }
}

}  // namespace
}  // namespace breve::reference
