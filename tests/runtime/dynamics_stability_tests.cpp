// Hard scenes with the bounds that are promised for them, on `balanced` at an outer step of 1/60 s with the guard on
// `report`, unless a test says otherwise. Sub-steps are printed.
#include <gtest/gtest.h>

#include <cstdio>
#include <limits>

#include "dynamics_scene.hpp"

namespace breve::testing {
namespace {

struct Hard : Physics {
  explicit Hard(Rung rung = Rung::Balanced, double step = 1.0 / 60) : Physics(step) {
    mechanics().set_accuracy(rung);
    mechanics().set_guard(GuardMode::Report);
  }
  ObjectId floor() { return body(2, Vector3(0, -2.5, 0), BodyKind::Stationary, Shape::box(Vector3(1000, 5, 1000))); }
  void measure(double seconds, const std::function<void()>& look = {}) {
    const auto steps = std::llround(seconds / world.iteration_step());
    for (long long i = 0; i < steps; ++i) {
      world.step();
      sub_steps += mechanics().counters().sub_steps;
      most = std::max(most, mechanics().counters().sub_steps);
      evaluations += mechanics().counters().evaluations;
      interventions += mechanics().counters().interventions;
      ++iterations;
      if (look) look();
    }
  }
  void print(const char* name) const {
    std::printf("  %-28s %.1f sub-steps (at most %lu), %.1f evaluations a step; %lu interventions\n", name,
                static_cast<double>(sub_steps) / static_cast<double>(iterations), most,
                static_cast<double>(evaluations) / static_cast<double>(iterations), interventions);
  }
  std::uint64_t sub_steps = 0, most = 0, evaluations = 0, interventions = 0, iterations = 0;
};

void stack(int count, double seconds) {
  Hard s;
  s.floor();
  s.mechanics().set_sleeping(true);
  std::vector<ObjectId> boxes;
  for (int i = 0; i < count; ++i) boxes.push_back(s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(0, 0.5 + i, 0)));
  s.measure(seconds);
  s.print("stack");
  const Vector3 top = s.at(boxes.back());
  EXPECT_NEAR(top.y(), count - 0.5, 0.01 * (count - 0.5));
  EXPECT_LT(std::hypot(top.x(), top.z()), 0.01);
  for (const ObjectId box : boxes) EXPECT_TRUE(s.mechanics().asleep(s.index(box)));
}

TEST(DynamicsStability, TenBoxesStandForAMinute) { stack(10, 60); }
TEST(DynamicsStability, TwentyBoxesStandForAMinute) { stack(20, 60); }

TEST(DynamicsStability, AThousandKilogramsOnOne) {
  Hard s;
  s.floor();
  std::shared_ptr<Shape> heavy = Shape::box(Vector3(1, 1, 1));
  heavy->set_mass(1000);
  s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(0, 0.5, 0));
  const ObjectId top = s.rigid(heavy, Vector3(0, 1.5, 0));
  s.measure(20);
  s.print("1000 kg on 1 kg");
  EXPECT_NEAR(s.at(top).y(), 1.5, 0.01);
}

/// Links of a chain along `way` from the origin, hinged about z. Returns the bodies.
std::vector<ObjectId> chain(Physics& s, int count, double length, double mass, const Vector3& way) {
  std::vector<ObjectId> links;
  const Quaternion rotation = Quaternion::FromTwoVectors(-Vector3::UnitY(), way);
  for (int i = 0; i < count; ++i) {
    std::shared_ptr<Shape> shape = Shape::box(Vector3(0.05, length, 0.05));
    shape->set_mass(mass);
    links.push_back(s.rigid(shape, Vector3::Zero(), rotation));
    JointDescription is;
    is.child = s.index(links.back());
    is.child_point = Vector3(0, 0.5 * length, 0);
    is.normal = Vector3::UnitZ();
    if (i == 0) {
      is.relative_rotation = rotation;
    } else {
      is.parent = s.index(links[static_cast<std::size_t>(i - 1)]);
      is.parent_point = Vector3(0, -0.5 * length, 0);
    }
    s.mechanics().link(is, links.back());
  }
  return links;
}

void heavy_ball(double degrees, Rung rung, double bound) {
  Hard s(rung);
  const double angle = degrees * 3.14159265358979323846 / 180;
  const Vector3 way(std::sin(angle), -std::cos(angle), 0);
  const std::vector<ObjectId> links = chain(s, 20, 0.5, 0.1, way);
  std::shared_ptr<Shape> ball = Shape::sphere(0.5);
  ball->set_mass(1000);
  const ObjectId weight = s.rigid(ball, Vector3::Zero());
  JointDescription is;
  is.child = s.index(weight);
  is.parent = s.index(links.back());
  is.parent_point = Vector3(0, -0.25, 0);
  is.child_point = Vector3(0, 0.5, 0);
  is.normal = Vector3::UnitZ();
  s.mechanics().link(is, weight);
  const double start = s.mechanics().energy().total(), scale = 1000 * 9.81 * 10.5;
  double worst = 0, open = 0, gained = 0;
  s.measure(10, [&] {
    gained = std::max(gained, (s.mechanics().energy().total() - start) / scale);
    worst = std::max(worst, std::abs(s.mechanics().energy().total() - start) / scale);
    const Bodies& bodies = s.world.bodies();
    const Vector3 gap = bodies.location(is.child) + bodies.orientation(is.child) * is.child_point -
                        bodies.location(is.parent) - bodies.orientation(is.parent) * is.parent_point;
    open = std::max(open, gap.norm());
  });
  s.print("1000 kg on 20 links");
  std::printf("    %.0f degrees, %s: dE %.1e, joints open by %.1e\n", degrees, std::string(name_of(rung)).c_str(),
              worst, open);
  EXPECT_LE(worst, bound);
  EXPECT_LE(gained, 0.01);
  EXPECT_LE(open, 1e-9);
}

TEST(DynamicsStability, AHeavyBallOnALightChainFromTenDegrees) { heavy_ball(10, Rung::Balanced, 0.01); }
TEST(DynamicsStability, AHeavyBallOnALightChainFromNinetyDegrees) { heavy_ball(90, Rung::Balanced, 0.01); }
TEST(DynamicsStability, AHeavyBallOnALightChainOnPrecise) { heavy_ball(90, Rung::Precise, 1e-4); }

TEST(DynamicsStability, AFastSpinningFlatBodyKeepsItsAngularMomentum) {
  for (const Rung rung : {Rung::Balanced, Rung::Conserving, Rung::Precise}) {
    Hard s(rung, rung == Rung::Precise ? 1.0 / 480 : 1.0 / 60);
    s.mechanics().set_gravity(Vector3::Zero());
    Matrix3 inertia = Matrix3::Identity();
    inertia.diagonal() << 100, 60, 1;
    inertia(0, 0) = 60.5;  // a body: no moment above the sum of the other two
    inertia(1, 1) = 60;
    inertia(2, 2) = 0.6;
    const ObjectId id = s.rigid(solid(10, inertia), Vector3::Zero());
    s.world.bodies().set_rotational_velocity(s.index(id), Vector3(12, 3, 15.7).normalized() * 20);
    const auto momentum = [&] {
      const Matrix3 r = s.world.bodies().rotation(s.index(id));
      return Vector3(r * (inertia * (r.transpose() * s.world.bodies().rotational_velocity(s.index(id)))));
    };
    const Vector3 start = momentum();
    double worst = 0;
    s.measure(10, [&] { worst = std::max(worst, (momentum() - start).norm() / start.norm()); });
    std::printf("  100:1 at 20 rad/s, %s: L off by %.1e\n", std::string(name_of(rung)).c_str(), worst);
    EXPECT_LE(worst, rung == Rung::Precise ? 1e-6 : 1e-9);
  }
}

TEST(DynamicsStability, APassivePendulumOfFiveLinksKeepsItsEnergyForAMinute) {
  Hard s;
  chain(s, 5, 0.5, 1, Vector3(1, 0, 0));
  const double start = s.mechanics().energy().total(), scale = 5 * 9.81 * 2.5;
  double worst = 0;
  s.measure(60, [&] { worst = std::max(worst, std::abs(s.mechanics().energy().total() - start) / scale); });
  s.print("pendulum of 5");
  std::printf("    dE %.1e\n", worst);
  EXPECT_LE(worst, 0.01);
}

TEST(DynamicsStability, AThousandLinksHang) {
  Hard s;
  chain(s, 1000, 0.1, 0.1, Vector3(0, -1, 0));
  const double start = s.mechanics().energy().total();
  s.measure(0.5);
  s.print("1000 links");
  EXPECT_NEAR(s.mechanics().energy().total(), start, 1e-6 * std::abs(start));
}

TEST(DynamicsStability, ABulletDoesNotPassAThinWall) {
  for (const double speed : {300.0, 1000.0}) {
    for (const double thick : {0.01, 0.001}) {
      for (const Rung rung : {Rung::Balanced, Rung::Precise}) {
        Hard s(rung);
        s.mechanics().set_gravity(Vector3::Zero());
        s.body(2, Vector3(20, 0, 0), BodyKind::Stationary, Shape::box(Vector3(thick, 10, 10)));
        const ObjectId ball = s.rigid(Shape::sphere(0.01), Vector3::Zero());
        s.set_velocity(ball, Vector3(speed, 0, 0));
        s.measure(0.5);
        EXPECT_LT(s.at(ball).x(), 20) << speed << ' ' << thick << ' ' << name_of(rung);
      }
    }
  }
}

TEST(DynamicsStability, ManyAtOnePointPartGently) {
  for (const int count : {2, 100}) {
    Hard s;
    s.mechanics().set_gravity(Vector3::Zero());
    std::vector<ObjectId> balls;
    for (int i = 0; i < count; ++i) balls.push_back(s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3::Zero()));
    double fastest = 0;
    s.measure(count == 2 ? 2.0 : 0.2, [&] {
      for (const ObjectId id : balls) fastest = std::max(fastest, s.velocity(id).norm());
    });
    Vector3 momentum = Vector3::Zero();
    for (const ObjectId id : balls) momentum += s.velocity(id);
    std::printf("  %d at one point: fastest %.2e m/s, momentum %.1e\n", count, fastest, momentum.norm());
    EXPECT_LT(fastest, 4);
    EXPECT_LT(momentum.norm(), 1e-9);
  }
}

TEST(DynamicsStability, PlatesThatClapStayWhereTheyAre) {
  Hard s;
  s.mechanics().set_gravity(Vector3::Zero());
  const ObjectId a = s.rigid(Shape::box(Vector3(1, 0.1, 1)), Vector3(0, 0.5, 0));
  const ObjectId b = s.rigid(Shape::box(Vector3(1, 0.1, 1)), Vector3(0, -0.5, 0));
  SpringDescription is;
  is.a = s.index(a);
  is.b = s.index(b);
  is.strength = 5;
  is.damping = 0;
  s.mechanics().add_spring(is, a);
  double moved = 0;
  s.measure(20, [&] { moved = std::max(moved, (0.5 * (s.at(a) + s.at(b))).norm()); });
  s.print("plates");
  std::printf("    centre of mass moved by %.1e\n", moved);
  EXPECT_LE(moved, 1e-6);
}

// --- fast: finite, figures published, not promised -----------------------------------------------------------------

TEST(DynamicsStability, OnFastAPassivePendulumStaysFinite) {
  Hard s(Rung::Fast);
  chain(s, 5, 0.5, 1, Vector3(1, 0, 0));
  const double start = s.mechanics().energy().total(), scale = 5 * 9.81 * 2.5;
  double most = 0;
  s.measure(60, [&] { most = std::max(most, (s.mechanics().energy().total() - start) / scale); });
  s.print("pendulum of 5, fast");
  std::printf("    dE at most %+.2f, at the end %+.2f\n", most, (s.mechanics().energy().total() - start) / scale);
  EXPECT_LE(most, 0.1);
}

TEST(DynamicsStability, OnFastAHeavyBallOnALightChainGainsNoEnergy) {
  // It loses what it likes.
  for (const double degrees : {10.0, 90.0}) heavy_ball(degrees, Rung::Fast, std::numeric_limits<double>::infinity());
}

TEST(DynamicsStability, OnFastAHeavyTopStaysFinite) {
  for (const double spin : {20.0, 100.0}) {
    Hard s(Rung::Fast);
    Matrix3 inertia = Matrix3::Identity();
    inertia(2, 2) = 1.5;
    const ObjectId top = s.rigid(solid(1, inertia), Vector3::Zero());
    JointDescription is;
    is.kind = JointKind::Ball;
    is.child = s.index(top);
    is.child_point = Vector3(0, 0, -0.5);
    is.relative_rotation = Quaternion(Eigen::AngleAxisd(0.5, Vector3::UnitY()));
    s.mechanics().link(is, top);
    s.world.bodies().set_rotational_velocity(s.index(top), is.relative_rotation * Vector3(0, 0, spin));
    const double start = s.mechanics().energy().kinetic;
    double most = 0;
    s.measure(20, [&] { most = std::max(most, s.mechanics().energy().kinetic / start); });
    s.print("heavy top, fast");
    std::printf("    at %.0f rad/s: kinetic energy at most %.2f of the start's\n", spin, most);
    EXPECT_LE(most, 1.5);
  }
}

TEST(DynamicsStability, OnFastAStackOfBoxesStaysFinite) {
  for (const int count : {10, 20}) {
    Hard s(Rung::Fast);
    s.floor();
    std::vector<ObjectId> boxes;
    for (int i = 0; i < count; ++i) boxes.push_back(s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(0, 0.5 + i, 0)));
    double stands = 0, most = 0;
    s.measure(60, [&] {
      const Vector3 top = s.at(boxes.back());
      if (top.y() > 0.99 * (count - 0.5)) stands = s.world.time();
      most = std::max(most, s.velocity(boxes.back()).norm());
    });
    s.print("stack, fast");
    std::printf("    %d boxes stand for %.1f s; the top one at most %.1f m/s\n", count, stands, most);
    EXPECT_LE(most, 1.5 * std::sqrt(2 * 9.81 * count));  // a tower that tips over is faster than what falls
  }
}

TEST(DynamicsStability, WhatHasNoFiniteMotionStandsStill) {
  for (const Rung rung : {Rung::Fast, Rung::Balanced, Rung::Precise, Rung::Reference, Rung::Conserving})
    for (const GuardMode guard : {GuardMode::Report, GuardMode::Refine, GuardMode::Rest})
      for (const double pull : {1e100, 1e200, 1e300})
        for (const int links : {1, 2, 3}) {
          Hard s(rung);
          s.mechanics().set_guard(guard);
          s.mechanics().set_gravity(Vector3(0, -pull, 0));
          std::vector<ObjectId> bodies;
          for (int i = 0; i < links; ++i) {
            bodies.push_back(s.rigid(Shape::box(Vector3(1, 0.2, 0.2)), Vector3(1.2 * i, 0, 0)));
            if (i == 0) continue;
            JointDescription is;
            is.kind = i == 1 ? JointKind::Revolute : JointKind::Ball;
            is.parent = s.index(bodies[static_cast<std::size_t>(i - 1)]);
            is.child = s.index(bodies.back());
            is.normal = Vector3::UnitZ();
            is.parent_point = Vector3(0.6, 0, 0);
            is.child_point = Vector3(-0.6, 0, 0);
            s.mechanics().link(is, bodies.back());
          }
          for (int step = 0; step < 3; ++step) s.world.step();
          for (const ObjectId body : bodies) {
            EXPECT_TRUE(s.at(body).allFinite()) << links << " links under " << pull;
            EXPECT_TRUE(s.velocity(body).allFinite()) << links << " links under " << pull;
          }
        }
}

TEST(DynamicsStability, OnFastTwentyBoxesStandWhereSmallIslandsAreSolvedDirectly) {
  Hard s(Rung::Fast);
  Accuracy accuracy = accuracy_of(Rung::Fast);
  accuracy.direct = true;
  s.mechanics().set_accuracy(accuracy);
  s.floor();
  std::vector<ObjectId> boxes;
  for (int i = 0; i < 20; ++i) boxes.push_back(s.rigid(Shape::box(Vector3(1, 1, 1)), Vector3(0, 0.5 + i, 0)));
  s.measure(60);
  s.print("stack, fast, direct");
  const Vector3 top = s.at(boxes.back());
  EXPECT_NEAR(top.y(), 19.5, 0.01 * 19.5);
  EXPECT_LT(std::hypot(top.x(), top.z()), 0.01);
}

}  // namespace
}  // namespace breve::testing
