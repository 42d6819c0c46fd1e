// The contact solver as a velocity problem: forces act for a step, and the impulses that answer them are looked at.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "articulated_random.hpp"
#include "articulated_reference.hpp"
#include "contact_law_scene.hpp"

namespace breve::contact {
namespace {

namespace reference = articulated::reference;
using articulated::between;
using articulated::random_rotation;
using articulated::random_vector;

constexpr double kStep = 1.0 / 60, kGravity = 9.81;
constexpr double kRadian = std::numbers::pi / 180;

Vector3 down_a_slope(double degrees) {
  return kGravity * Vector3(-std::sin(degrees * kRadian), 0, -std::cos(degrees * kRadian));  // x is up the slope
}

double fastest(const Scene& scene) {
  double v = 0;
  for (const FreeBody& body : scene.bodies) v = std::max(v, body.v.cwiseAbs().maxCoeff());
  return v;
}

class BothWays : public testing::TestWithParam<bool> {
 protected:
  void use(Scene& scene) const {
    scene.settings.direct = GetParam();
    scene.settings.iterations = 3000;  // to tolerance: these tests are about the solution
    scene.settings.tolerance = 1e-11;
  }
};
INSTANTIATE_TEST_SUITE_P(Solver, BothWays, testing::Values(false, true),
                         [](const auto& way) { return way.param ? "Direct" : "Sweeps"; });

TEST_P(BothWays, ABoxOnFourPointsRestsAndBearsItsWeight) {
  Scene scene;
  scene.stack({2}, 0.5);
  scene.pull({0, 0, -kGravity}, kStep);
  use(scene);
  const auto before = scene.velocities();
  EXPECT_LE(scene.solve().residual, 1e-9);
  EXPECT_LE(fastest(scene), 1e-9);
  double weight = 0;
  for (const Row& row : scene.rows) weight += row.impulse[0];
  EXPECT_NEAR(weight, 2 * kGravity * kStep, 1e-9);
  EXPECT_LE(scene.disagreement(before), 1e-15);
}

double speed_on_slope(double degrees, const Vector3& size, double mu, bool direct) {
  Scene scene;
  scene.add_box(1, Vector3(0, 0, size.z() / 2), size);
  scene.rest_on(0, -1, size, mu);
  scene.pull(down_a_slope(degrees), kStep);
  scene.settings = {20000, direct, 1e-12};
  scene.solve();
  return fastest(scene);
}

TEST_P(BothWays, BoxesLetGoWithinAHundredthOfADegreeOfTheirThreshold) {
  for (const reference::Row& row : reference::read("box_on_incline")) {
    const Vector3 size(row.number("width_along_slope"), 1, row.number("height"));
    const double critical = row.number("critical_angle_deg"), mu = row.number("mu");
    EXPECT_LE(speed_on_slope(critical - 0.01, size, mu, GetParam()), 1e-8) << critical;
    EXPECT_GE(speed_on_slope(critical + 0.01, size, mu, GetParam()), 1e-6) << critical;
  }
}

/// One step of a block on a slope that moves with `v`. @return its velocity along the slope afterwards.
double block(const reference::Row& row, double v, bool direct) {
  Scene scene;
  scene.stack({1}, row.number("mu_static"));
  for (Row& contact : scene.rows) {
    contact.dynamic_friction = row.number("mu_dynamic");
    const Vector3 slip = contact.axes * Vector3(v, 0, 0);
    contact.slip[0] = slip[1];
    contact.slip[1] = slip[2];
  }
  scene.bodies[0].v[0] = v;
  scene.pull(down_a_slope(row.number("incline_deg")), kStep);
  scene.settings = {3000, direct, 1e-11};
  scene.solve();
  return scene.bodies[0].v[0];
}

TEST_P(BothWays, ABlockSlidesWithDynamicFrictionAndIsHeldByStaticFriction) {
  for (const reference::Row& row : reference::read("sliding_block")) {
    const double slope = row.number("incline_deg") * kRadian, v0 = row.number("v0_upslope");
    const double pull = -kGravity * std::sin(slope), press = kGravity * std::cos(slope);
    if (v0 != 0) {
      const double friction = -std::copysign(row.number("mu_dynamic") * press, v0);
      EXPECT_NEAR(block(row, v0, GetParam()), v0 + (pull + friction) * kStep, 1e-8) << row.text("case");
      // The step in which it stops: then it stays, or turns round and slides.
      const double slow = 0.2 * kStep * (pull + friction) * (v0 < 0 && pull + friction < 0 ? 1 : -1);
      if (row.text("after") == "stays") {
        EXPECT_NEAR(block(row, slow, GetParam()), 0, 1e-8) << row.text("case");
      }
    }
    if (row.text("after") == "stays") {
      EXPECT_NEAR(block(row, 0, GetParam()), 0, 1e-8) << row.text("case");
    } else {
      const double free = pull + row.number("mu_dynamic") * press;
      EXPECT_NEAR(block(row, 0, GetParam()), free * kStep, 1e-8) << row.text("case");
    }
  }
}

/// A block on a slope of `degrees`, static friction 0.5 and dynamic 0.3, that moved up it with `v`.
double sticky_block(double degrees, double v, bool direct) {
  Scene scene;
  scene.stack({1}, 0.5);
  for (Row& contact : scene.rows) {
    contact.dynamic_friction = 0.3;
    const Vector3 slip = contact.axes * Vector3(v, 0, 0);
    contact.slip[0] = slip[1];
    contact.slip[1] = slip[2];
  }
  scene.bodies[0].v[0] = v;
  scene.pull(down_a_slope(degrees), kStep);
  scene.settings = {3000, direct, 1e-11};
  scene.solve();
  return scene.bodies[0].v[0];
}

TEST_P(BothWays, WhatSlidesGoesOnThoughStaticFrictionCouldHoldIt) {
  const double gh = kGravity * kStep;
  EXPECT_NEAR(sticky_block(0, 0.4 * gh, GetParam()), 0.1 * gh, 1e-8);
  // Faster down a slope that would hold it at rest: tan 20 = 0.36.
  const double sine = std::sin(20 * kRadian), cosine = std::cos(20 * kRadian);
  EXPECT_NEAR(sticky_block(20, -gh, GetParam()), -gh + gh * (0.3 * cosine - sine), 1e-8);
  EXPECT_NEAR(sticky_block(20, 0, GetParam()), 0, 1e-8);
  // Where its way up ends within the step, it stays.
  EXPECT_NEAR(sticky_block(20, 0.03 * gh, GetParam()), 0, 1e-8);
  EXPECT_NEAR(sticky_block(20, 0.4 * gh, GetParam()), 0, 1e-8);
}

TEST_P(BothWays, FrictionIsACone) {
  for (const reference::Row& row : reference::read("friction_isotropy")) {
    const double angle = row.number("direction_deg") * kRadian;
    // The answer may not depend on how the tangents lie.
    for (const double rotation : {0.0, 0.3, 1.1}) {
      Scene scene;
      scene.stack({row.number("mass")}, row.number("mu"));
      for (Row& contact : scene.rows)
        contact.axes = (contact.axes * Eigen::AngleAxisd(rotation, Vector3::UnitZ()).toRotationMatrix()).eval();
      // Pushed at the height of the floor, so that it does not tip.
      scene.bodies[0].inertia *= 1e9;
      scene.pull(Vector3(row.number("force") * std::cos(angle), row.number("force") * std::sin(angle), -kGravity),
                 kStep);
      use(scene);
      scene.solve();
      EXPECT_NEAR(scene.bodies[0].v[0], row.number("ax") * kStep, 1e-8) << angle << ' ' << rotation;
      EXPECT_NEAR(scene.bodies[0].v[1], row.number("ay") * kStep, 1e-8) << angle << ' ' << rotation;
    }
  }
}

/// A round body on a slope or floor: one contact.
struct Round : Scene {
  Round(double mass, double ratio, double radius, double mu) {
    bodies.push_back({mass, Vector3(0, 0, radius), Matrix3::Identity() * (ratio * mass * radius * radius)});
    touch(0, -1, Vector3::Zero(), Vector3::UnitZ(), mu);
  }
};

TEST_P(BothWays, RoundBodiesRollOrSlipDownASlope) {
  for (const reference::Row& row : reference::read("rolling_incline")) {
    Round scene(1.7, row.number("I_over_mr2"), row.number("radius"), row.number("mu"));
    scene.pull(down_a_slope(row.number("incline_deg")), kStep);
    use(scene);
    scene.solve();
    const double t = row.number("t");
    EXPECT_NEAR(-scene.bodies[0].v[0], row.number("v") / t * kStep, 1e-10);
    EXPECT_NEAR(-scene.bodies[0].v[4], row.number("omega") / t * kStep, 1e-10);
  }
}

TEST_P(BothWays, SlippingBallsTendToTheirRollingSpeed) {
  for (const reference::Row& row : reference::read("slip_to_roll")) {
    const double mu = row.number("mu"), v0 = row.number("v0"), w0 = row.number("omega0"), r = row.number("radius");
    // One long step over all the slipping: the impulse of friction is then known, whatever happens in between.
    const double h = row.number("t_roll");
    for (const double part : {0.5, 1.0, 1.5}) {
      Round scene(0.8, row.number("I_over_mr2"), r, mu);
      scene.bodies[0].v[0] = v0;
      scene.bodies[0].v[4] = w0;
      scene.pull({0, 0, -kGravity}, part * h);
      use(scene);
      scene.solve();
      const double to_go = std::max(0.0, 1 - part);
      EXPECT_NEAR(scene.bodies[0].v[0], row.number("v_final") + to_go * (v0 - row.number("v_final")), 1e-9 * (1 + v0));
      EXPECT_NEAR(scene.bodies[0].v[4], row.number("omega_final") + to_go * (w0 - row.number("omega_final")),
                  1e-9 * (1 + std::abs(w0)));
    }
  }
}

TEST(DirectSolver, TallStacksAndGreatRatiosOfMassRest) {
  const auto worst = [](const std::vector<double>& masses) {
    Scene scene;
    scene.stack(masses, 0.5);
    scene.pull({0, 0, -kGravity}, kStep);
    scene.settings = {10, true, 1e-9};
    const SolveReport report = scene.solve();
    EXPECT_TRUE(report.direct);
    EXPECT_EQ(report.iterations, 0) << "no sweeps were needed";
    return fastest(scene);
  };
  EXPECT_LE(worst(std::vector<double>(10, 1.0)), 1e-7);
  EXPECT_LE(worst(std::vector<double>(25, 1.0)), 1e-7);  // a hundred contacts
  EXPECT_LE(worst({1, 1000}), 1e-7);
  EXPECT_LE(worst({1, 1000, 1, 1000, 1, 1000, 1, 1000}), 1e-6);
}

/// Boxes of any mass, touching each other and the ground in random points with random normals.
void torture(Scene& scene, Random& random, double most_mu, double decades) {
  const int n = 1 + static_cast<int>(random.below(6));
  for (int i = 0; i < n; ++i) {
    const double mass = std::pow(10, between(random, 0, decades));
    scene.add_box(mass, random_vector(random, 1), Vector3::Constant(0.3) + 0.5 * random_vector(random, 0.5));
  }
  const auto contacts = 1 + random.below(static_cast<std::uint64_t>(4 * n));
  for (std::uint64_t i = 0; i < contacts; ++i) {
    const int a = static_cast<int>(random.below(static_cast<std::uint64_t>(n)));
    int b = static_cast<int>(random.below(static_cast<std::uint64_t>(n + 1))) - 1;
    if (a == b) b = -1;
    const Vector3 point = scene.bodies[static_cast<std::size_t>(a)].position + random_vector(random, 0.5);
    const double dynamic = most_mu * random.uniform();
    Row& row = scene.touch(a, b, point, random_rotation(random) * Vector3::UnitZ(), dynamic);
    if (random.below(3) == 0) row.static_friction *= 1.3;
    // A warm start that has nothing to do with the case.
    row.impulse = 0.5 * random_vector(random, 1);
  }
  for (FreeBody& body : scene.bodies)
    for (int k = 0; k < 6; ++k) body.v[k] = between(random, -1, 1);
}

TEST(Energy, NoSolveAddsAnyHoweverFewSweeps) {
  Random random(21);
  for (int i = 0; i < 10000; ++i) {
    Scene scene;
    torture(scene, random, 1.5, 2);
    scene.settings = {1 + static_cast<int>(random.below(12)), random.below(8) == 0, 1e-9};
    const double before = scene.kinetic();
    const auto velocities = scene.velocities();
    scene.solve();
    ASSERT_LE(scene.kinetic(), before * (1 + 1e-13)) << i;
    ASSERT_LE(scene.disagreement(velocities), 1e-9) << i;
    for (const Row& row : scene.rows) {
      ASSERT_TRUE(row.impulse.allFinite());
      ASSERT_GE(row.impulse[0], 0);
      ASSERT_LE(row.impulse.tail<2>().norm(), row.static_friction * row.impulse[0] * (1 + 1e-12));
    }
  }
}

TEST(DirectSolver, FrictionlessIslandsAlwaysConverge) {
  Random random(22);
  for (int i = 0; i < 1000; ++i) {
    Scene scene;
    torture(scene, random, 0, 1);
    scene.settings = {10, true, 1e-9};
    const SolveReport report = scene.solve();
    EXPECT_TRUE(report.direct) << i << ' ' << report.residual;
    for (const Row& row : scene.rows) {
      const double u = scene.velocity_of(row)[0];
      EXPECT_GE(u, -1e-6) << i;
    }
  }
}

TEST(DirectSolver, SolvesAlmostAllIslandsWithFrictionThatHaveNothingInCommonWithRealOnes) {
  Random random(23);
  int direct = 0;
  for (int i = 0; i < 1000; ++i) {
    Scene scene;
    torture(scene, random, 0.6, 1);
    scene.settings = {10, true, 1e-9};
    direct += scene.solve().direct ? 1 : 0;
  }
  EXPECT_GE(direct, 990);
}

TEST(DirectSolver, ABoxWhoseCornersAreHardlyOffStandsOnThreeOfThem) {
  // Corners that may sink by a few micrometres: which of them bears nothing is decided by a millionth of what the
  // weight does in a step.
  Scene scene;
  scene.stack({2}, 0.8);
  const double room[4] = {0, 9e-6, 3.7e-5, 2.6e-5};
  for (std::size_t i = 0; i < 4; ++i) scene.rows[i].bias = -room[i];
  scene.pull({0.1, 0.2, -kGravity}, kStep);
  scene.settings = {10, true, 1e-9};
  const SolveReport report = scene.solve();
  EXPECT_TRUE(report.direct) << report.residual;
  EXPECT_LE(report.newton, 60);
  EXPECT_EQ(report.iterations, 0);
}

TEST(ScalarRows, KeepTheirBoundsAndBiases) {
  double v[3] = {2, -1, 0.5};
  const Mover mover{v, 3};
  const double j[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, r[3][3] = {{0.5, 0, 0}, {0, 0.25, 0}, {0, 0, 2}};
  ScalarRow rows[3];
  for (int i = 0; i < 3; ++i) {
    rows[i].a = 0;
    rows[i].ja = j[i];
    rows[i].ra = r[i];
  }
  rows[0].lo = -1;  // a motor that is too weak to stop it
  rows[0].hi = 1;
  rows[1].hi = 1e300;  // a limit
  rows[1].bias = 0.25;
  rows[2].lo = -1e300;  // a loop
  rows[2].hi = 1e300;
  for (const bool direct : {false, true}) {
    v[0] = 2, v[1] = -1, v[2] = 0.5;
    for (ScalarRow& row : rows) row.impulse = 0;
    Workspace work(std::pmr::get_default_resource());
    solve_island({&mover, 1}, {}, rows, {100, direct, 1e-12}, work);
    EXPECT_NEAR(v[0], 1.5, 1e-9);
    EXPECT_NEAR(v[1], 0.25, 1e-9);
    EXPECT_NEAR(v[2], 0, 1e-9);
    EXPECT_NEAR(rows[0].impulse, -1, 1e-12);
    EXPECT_NEAR(rows[1].impulse, 5, 1e-8);
  }
}

TEST(ScalarRows, ThatContradictOneAnotherLeaveTheLeastErrorWithoutThrowingImpulses) {
  double v[3] = {0, 0, 0};
  const Mover mover{v, 3};
  const double part = std::sqrt(0.5), without_bound = std::numeric_limits<double>::infinity();
  const double j[3][3] = {{1, 0, 0}, {0, 1, 0}, {part, part, 0}};  // the third is made of the others
  ScalarRow rows[3];
  for (int i = 0; i < 3; ++i) {
    rows[i].a = 0;
    rows[i].ja = rows[i].ra = j[i];
    rows[i].lo = -without_bound;
    rows[i].hi = without_bound;
    rows[i].bias = i < 2 ? 1 : 0;
  }
  Workspace work(std::pmr::get_default_resource());
  const SolveReport report = solve_island({&mover, 1}, {}, rows, {100, true, 1e-12}, work);
  EXPECT_FALSE(report.direct);
  EXPECT_NEAR(report.residual, part, 1e-12);
  EXPECT_NEAR(v[0], 0.5, 1e-12);
  EXPECT_NEAR(v[1], 0.5, 1e-12);
  for (const ScalarRow& row : rows) EXPECT_LT(std::abs(row.impulse), 1);
}

TEST(Softness, LetsAContactGiveWay) {
  for (const bool direct : {false, true}) {
    Round scene(2, 0.4, 0.5, 0.5);
    scene.rows[0].softness = 1.5;  // the body's own response along the normal is 0.5
    scene.bodies[0].v[2] = -1;
    scene.settings = {100, direct, 1e-12};
    scene.solve();
    EXPECT_NEAR(scene.bodies[0].v[2], -0.75, 1e-9);
    EXPECT_NEAR(scene.rows[0].impulse[0], 0.5, 1e-9);
  }
}

/// Two islands that are the same.
struct Twins {
  Scene first, second;

  explicit Twins(Random& random) {
    Random again = random;
    torture(first, again, 1, 2);
    torture(second, random, 1, 2);
  }
  void expect_equal_solutions() {
    first.solve();
    second.solve();
    for (std::size_t k = 0; k < first.bodies.size(); ++k) EXPECT_EQ(first.bodies[k].v, second.bodies[k].v);
  }
};

TEST(Order, TheSameIslandGivesTheSameBits) {
  Random random(24);
  for (int i = 0; i < 100; ++i) {
    Twins twins(random);
    for (Scene* scene : {&twins.first, &twins.second}) {
      scene->settings.direct = i % 2 == 0;
      scene->settings.iterations = 8;
    }
    if (i % 3 == 0) {
      Scene other;  // what a workspace was used for before leaves no trace
      Random ahead = random;
      torture(other, ahead, 1, 2);
      solve_island(other.movers(), other.rows, other.scalars, other.settings, twins.second.work);
    }
    twins.expect_equal_solutions();
  }
}

TEST(Order, WhateverNumbersAWorkspaceHoldsLeaveNoTrace) {
  // As an island leaves them that flew out of the numbers.
  constexpr double kLost[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
  Random random(25);
  for (int i = 0; i < 100; ++i) {
    Twins twins(random);
    twins.first.settings = twins.second.settings = {10, true, 1e-9};
    Workspace& work = twins.second.work;
    for (std::pmr::vector<double>* some :
         {&work.began, &work.numbers, &work.saved, &work.earlier, &work.biases, &work.answers, &work.rates})
      some->assign(100'000, kLost[i % 2]);
    twins.expect_equal_solutions();
  }
}

/// A uniform rod of 1 m and 1 kg with its lower tip on the ground, sliding in -x.
struct Rod : Scene {
  Rod(double theta, double mu, double spin, double slide) {
    const Vector3 along(std::cos(theta), 0, std::sin(theta));
    bodies.push_back({1, 0.5 * along, Matrix3::Identity() * (1.0 / 12)});
    touch(0, -1, Vector3::Zero(), Vector3::UnitZ(), mu);
    // Turning so that theta grows; the tip slides with `slide` along the ground.
    const Vector3 omega(0, -spin, 0);
    bodies[0].v.tail<3>() = omega;
    bodies[0].v.head<3>() = Vector3(-slide, 0, 0) + omega.cross(0.5 * along);
  }
};

/// A box between two jaws that both want to throw it to the other: no velocity does that.
TEST_P(BothWays, OpposedBouncesThrowNoImpulses) {
  for (const double mu : {0.0, 0.3, 1.2}) {
    for (const double tilt : {0.0, 0.2, 0.6}) {
      Scene scene;
      scene.add_box(1, Vector3(0, 0, 0.5), Vector3::Ones());
      scene.bodies[0].v << 0.3, 0, -1, 0, 0.5, 0;
      scene.rest_on(0, -1, Vector3::Ones(), mu);
      for (const double side : {-1.0, 1.0})
        scene.touch(0, -1, Vector3(0.5 * side, 0, 1), Vector3(-side * std::sin(tilt), 0, -std::cos(tilt)), mu);
      for (Row& row : scene.rows) row.bias = 0.8;
      use(scene);
      const double before = scene.kinetic();
      const SolveReport report = scene.solve();
      EXPECT_TRUE(std::isfinite(report.residual));
      EXPECT_LE(scene.kinetic(), before + 1e-12);
      for (const Row& row : scene.rows) {
        EXPECT_LT(row.impulse.norm(), 200) << mu << ' ' << tilt;          // N*s, of a box that brings 1
        EXPECT_GE(scene.velocity_of(row)[0], -0.5) << mu << ' ' << tilt;  // it came with -1
      }
    }
  }
}

TEST_P(BothWays, ThePainleveRodIsAnsweredWhateverItsClass) {
  int classes = 0;
  for (const reference::Row& row : reference::read("painleve_rod")) {
    for (const double slide : {1.0, 1e-3}) {
      const double theta = row.number("theta_deg") * kRadian, omega = row.number("omega"), h = 1e-4;
      Rod scene(theta, row.number("mu"), omega, slide);
      // What turns the tip up or down without a contact force: gravity, and the turning of the rod.
      scene.pull({0, 0, -kGravity}, h);
      const double lift = 0.5 * omega * omega * std::sin(theta) * h;
      scene.rows[0].bias = -lift;  // the centripetal part is in no velocity of this instant
      const double before = scene.kinetic();
      use(scene);
      scene.solve();
      const Row& contact = scene.rows[0];
      const Vector3 u = scene.velocity_of(contact);
      ASSERT_TRUE(contact.impulse.allFinite());
      EXPECT_GE(u[0] + lift, -1e-9);
      EXPECT_LE(contact.impulse.tail<2>().norm(), row.number("mu") * contact.impulse[0] * (1 + 1e-12));
      EXPECT_LE(scene.kinetic(), before + std::abs(lift) * contact.impulse[0] + 1e-12);
      const std::string kind = row.text("class");
      if (kind == "lifts off" || kind == "indeterminate") {
        EXPECT_EQ(contact.impulse[0], 0);
      }
      if (kind == "slides" && slide == 1 && row.number("N_per_mass_if_sliding") < 100) {
        EXPECT_NEAR(contact.impulse[0], row.number("N_per_mass_if_sliding") * h, 1e-3 * contact.impulse[0]);
      }
      classes += kind == "inconsistent" ? 1 : 0;
    }
  }
  EXPECT_GE(classes, 20);
}

}  // namespace
}  // namespace breve::contact
