// Impacts in groups: chains of balls in the order of time, shocks through bodies that touch, boxes that land flat.
#include <gtest/gtest.h>

#include "articulated_random.hpp"
#include "articulated_reference.hpp"
#include "contact_law_scene.hpp"
#include "runtime/contact/impacts.hpp"

namespace breve::contact {
namespace {

namespace reference = articulated::reference;
using articulated::between;
using articulated::random_vector;

/// Points on a line, a wall of infinite mass among them if its mass is 0. Between collisions they move uniformly.
struct Line {
  std::vector<double> mass, x, v;
  double t = 0;
  int collisions = 0;

  void collide(std::size_t i, double e) {
    Matrix3 W = Matrix3::Zero();
    for (const std::size_t k : {i, i + 1})
      if (mass[k] > 0) W += Vector3(1 / mass[k], 0, 0).asDiagonal();
    const Vector3 p = impact_impulse(W, Vector3(v[i + 1] - v[i], 0, 0), Vector3::UnitX(), Law{e, 0, 0, 0, 0});
    if (mass[i + 1] > 0) v[i + 1] += p.x() / mass[i + 1];
    if (mass[i] > 0) v[i] -= p.x() / mass[i];
  }
  /// The next collision of neighbours; false if there is none.
  bool advance(double e) {
    double soonest = 1e300;
    std::size_t which = 0;
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      const double closing = v[i] - v[i + 1];
      if (closing <= 1e-14) continue;
      const double wait = std::max(0.0, (x[i + 1] - x[i]) / closing);
      if (wait < soonest) {
        soonest = wait;
        which = i;
      }
    }
    if (soonest > 1e200) return false;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += v[i] * soonest;
    t += soonest;
    collide(which, e);
    ++collisions;
    return true;
  }
};

TEST(ImpactGroups, ChainsOfBallsCollideInTheOrderOfTime) {
  const std::vector<reference::Row> all = reference::read("collision_chain");
  for (const std::string& name : reference::case_names("collision_chain")) {
    const std::vector<reference::Row> rows = reference::rows_of(all, name);
    Line line;
    for (const reference::Row& row : rows) {
      line.mass.push_back(row.number("mass"));
      line.x.push_back(row.number("x0_surface_gap_frame"));
      line.v.push_back(row.number("v_before"));
    }
    while (line.collisions < 100 && line.advance(rows[0].number("e"))) {
    }
    EXPECT_EQ(line.collisions, rows[0].integer("collisions")) << name;
    EXPECT_NEAR(line.t, rows[0].number("time_of_last"), 1e-9) << name;
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_NEAR(line.v[i], rows[i].number("v_after"), 1e-12) << name;
  }
}

TEST(ImpactGroups, CollisionsCountTheDigitsOfPi) {
  for (const reference::Row& row : reference::read("billiard_pi")) {
    Line line;
    line.mass = {0, row.number("mass_small"), row.number("mass_big")};
    line.x = {0, row.number("x_small0"), row.number("x_big0")};
    line.v = {0, row.number("v_small0"), row.number("v_big0")};
    while (line.collisions < 10000 && line.advance(1)) {
    }
    EXPECT_EQ(line.collisions, row.integer("collisions"));
    EXPECT_NEAR(line.t, row.number("time_of_last"), 1e-9);
    EXPECT_NEAR(line.v[2], row.number("v_big_final"), 1e-9);
    EXPECT_NEAR(line.v[1], row.number("v_small_final"), 1e-7);
  }
}

struct Group : Scene {
  ImpactSettings impacts;

  ImpactReport collide(const Law& law) {
    const std::vector<Law> laws(rows.size(), law);
    for (Row& row : rows) row.static_friction = row.dynamic_friction = law.dynamic_friction;
    return resolve_impacts(movers(), rows, laws, scalars, impacts, work);
  }
  void balls(const std::vector<double>& velocities) {
    for (std::size_t i = 0; i < velocities.size(); ++i) {
      bodies.push_back({1, Vector3(static_cast<double>(i), 0, 0), Matrix3::Identity() * 0.1});
      bodies.back().v[0] = velocities[i];
      if (i > 0)
        touch(static_cast<int>(i), static_cast<int>(i) - 1, Vector3(static_cast<double>(i) - 0.5, 0, 0),
              Vector3::UnitX(), 0);
    }
  }
};

TEST(ImpactGroups, ACradleWhoseBallsTouchPassesTheShockOn) {
  for (int moving = 1; moving <= 4; ++moving) {
    Group scene;
    std::vector<double> v(5, 0.0);
    for (int i = 0; i < moving; ++i) v[static_cast<std::size_t>(i)] = 1.5;
    scene.balls(v);
    EXPECT_TRUE(scene.collide(Law{1, 0, 0, 0, 0}).settled);
    for (int i = 0; i < 5; ++i)
      EXPECT_NEAR(scene.bodies[static_cast<std::size_t>(i)].v[0], i >= 5 - moving ? 1.5 : 0, 1e-12)
          << moving << ' ' << i;
  }
}

TEST(ImpactGroups, ABoxThatLandsFlatStaysFlat) {
  for (const double e : {0.0, 0.5, 1.0}) {
    Group scene;
    scene.stack({3}, 0.4);
    scene.bodies[0].v[2] = -2;
    scene.collide(Law{e, 0, 0.4, 0.4, 0});
    EXPECT_NEAR(scene.bodies[0].v[2], 2 * e, 1e-9);
    EXPECT_LE(scene.bodies[0].v.tail<3>().norm(), 1e-9);
    double sum = 0;
    for (const Row& row : scene.rows) sum += row.impulse[0];
    EXPECT_NEAR(sum, 6 * (1 + e), 1e-8);
  }
}

TEST(ImpactGroups, ABallOnAStackShakesItAndGainsNothing) {
  Group scene;
  scene.stack({1, 1, 1}, 0.5);
  scene.add_box(5, Vector3(0.3, 0.2, 3.5), Vector3::Ones());
  scene.touch(3, 2, Vector3(0.3, 0.2, 3), Vector3::UnitZ(), 0.5);
  scene.bodies[3].v[2] = -3;
  const double before = scene.kinetic();
  const ImpactReport report = scene.collide(Law{0.6, 0, 0.5, 0.5, 0.05});
  EXPECT_GT(report.impacts, 1);
  EXPECT_LE(scene.kinetic(), before * (1 + 1e-12));
  for (const Row& row : scene.rows) EXPECT_GE(scene.velocity_of(row)[0], -1e-7);
}

TEST(ImpactGroups, NoGroupGainsEnergyOrStaysInApproach) {
  Random random(31);
  double worst = -1;
  for (int i = 0; i < 3000; ++i) {
    Group scene;
    const int n = 1 + static_cast<int>(random.below(5));
    for (int k = 0; k < n; ++k)
      scene.add_box(std::pow(10, between(random, -1, 1)), random_vector(random, 1), Vector3(1, 0.5, 0.7));
    for (int k = 0; k < 3 * n; ++k) {
      const int a = static_cast<int>(random.below(static_cast<std::uint64_t>(n)));
      scene.touch(a, a == 0 ? -1 : a - 1,
                  scene.bodies[static_cast<std::size_t>(a)].position + random_vector(random, 0.5),
                  articulated::random_rotation(random) * Vector3::UnitZ(), 0);
    }
    for (FreeBody& body : scene.bodies)
      for (int k = 0; k < 6; ++k) body.v[k] = between(random, -2, 2);
    const double before = scene.kinetic();
    const double mu = i % 3 == 0 ? 0 : random.uniform();
    const auto velocities = scene.velocities();
    scene.collide(Law{random.uniform(), 0, mu, mu, i % 2 == 0 ? 0.1 : 0});
    ASSERT_LE(scene.disagreement(velocities), 1e-9);
    worst = std::max(worst, (scene.kinetic() - before) / before);
    if (mu > 0) continue;  // with friction such overdetermined points may have no solution that is found
    for (const Row& row : scene.rows) ASSERT_GE(scene.velocity_of(row)[0], -1e-6) << i;
  }
  EXPECT_LE(worst, 1e-12);
}

}  // namespace
}  // namespace breve::contact
