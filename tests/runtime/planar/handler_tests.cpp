// Handlers of agents without physics in a flat world: exact in time, in the order of time, without a b2World.
#include "scene.hpp"

namespace breve::testing {
namespace {

constexpr double kExact = 1e-10;  // s: the search is right to 1e-10 of a step

struct Told {
  double time;
  ObjectId a, b;
  Vector3 point, normal;
};

struct Crowd : Flat {
  std::vector<Told> told;
  std::function<void(ObjectId, ObjectId)> then;
  explicit Crowd(double step = 0.1) : Flat(Rung::Balanced, step) {
    world.handle_collisions(1, 1, "met", controller);
    world.handle_collisions(1, 2, "met", controller);
    script.on_collided = [this](ObjectId a, ObjectId b, const Vector3& point, const Vector3& normal) {
      told.push_back({world.time(), a, b, point, normal});
      if (then) then(a, b);
      return true;
    };
  }
  ObjectId agent(std::shared_ptr<Shape> shape, double x, double y, double vx, double vy) {
    const ObjectId id = body(1, {x, y, 0}, BodyKind::Mobile, std::move(shape));
    set_velocity(id, {vx, vy, 0});
    return id;
  }
};

TEST(PlanarHandlers, TwoDiscsThatMoveMeetWhenTheirCentresAreTheirRadiiApart) {
  for (int i = 0; i < 20; ++i) {
    Crowd flat;
    const double p = 0.3 + 0.02 * i, r = 0.4, q = 0.25;
    flat.agent(Shape::sphere(r), -1, p, 3, -0.5);
    flat.agent(Shape::sphere(q), 1.1, -0.2, -2 - 0.1 * i, 0.7);
    // |d + v t| = r + q for d = (2.1, -0.2 - p), v = (-5 - 0.1 i, 1.2).
    const double dx = 2.1, dy = -0.2 - p, vx = -5 - 0.1 * i, vy = 1.2;
    const double a = vx * vx + vy * vy, b = dx * vx + dy * vy, c = dx * dx + dy * dy - (r + q) * (r + q);
    const double wanted = (-b - std::sqrt(b * b - a * c)) / a;
    for (int k = 0; k < 10; ++k) flat.world.step();
    ASSERT_GE(flat.told.size(), 1U);
    const Told& first = flat.told.front();
    EXPECT_NEAR(first.time, wanted, kExact);
    EXPECT_EQ(first.point.z(), 0);
    EXPECT_EQ(first.normal.z(), 0);
    // From b to a; the point lies between the two.
    const Vector3 way(dx + vx * wanted, dy + vy * wanted, 0);
    EXPECT_NEAR((first.normal + way / (r + q)).norm(), 0, 1e-8);
    const Vector3 from(-1 + 3 * wanted, p - 0.5 * wanted, 0);
    EXPECT_NEAR((first.point - from - r / (r + q) * way).norm(), 0, 1e-8);
    EXPECT_EQ(flat.physics().bytes(), 0U);
  }
}

TEST(PlanarHandlers, ABarThatRotatesMeetsAWallWithItsCorner) {
  // The farther corner, at R and phi from the bar's axis, is at d along x when R cos(phi - w t) = d.
  Crowd flat;
  const double w = 2, length = 2, width = 0.2, d = 0.7;
  const ObjectId bar = flat.agent(Shape::box({width, length, 1}), 0, 0, 0, 0);
  flat.bodies().set_rotational_velocity(flat.index(bar), {0, 0, -w});
  flat.fixed(Shape::box({2, 20, 1}), d + 1, 0);
  const double r = 0.5 * std::hypot(length, width), phi = std::atan2(length, width);
  // Agents turn by Euler's rule, 2 atan(w h / 2) in a step of h seconds, evenly within it.
  const double wanted = (phi - std::acos(d / r)) / (2 * std::atan(w * 0.1 / 2) / 0.1);
  for (int k = 0; k < 10; ++k) flat.world.step();
  ASSERT_GE(flat.told.size(), 1U);
  EXPECT_NEAR(flat.told.front().time, wanted, kExact);
  EXPECT_NEAR((flat.told.front().point - Vector3(d, std::sqrt(r * r - d * d), 0)).norm(), 0, 1e-8);
  EXPECT_NEAR((flat.told.front().normal - Vector3(-1, 0, 0)).norm(), 0, 1e-8);
}

TEST(PlanarHandlers, ImpactsOfOneStepAreToldInTheOrderOfTimeAndEachGoesOnFromThere) {
  // A disc between two walls 1 m apart, so fast that it meets them five times in one step; each turns it round.
  Crowd flat;
  flat.fixed(Shape::box({1, 4, 1}), -1, 0);
  flat.fixed(Shape::box({1, 4, 1}), 1, 0);
  const double r = 0.1, v = 40;
  const ObjectId disc = flat.agent(Shape::sphere(r), 0, 0, v, 0);
  flat.then = [&](ObjectId, ObjectId) { flat.set_velocity(disc, -flat.velocity(disc)); };
  flat.world.step();
  ASSERT_EQ(flat.told.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(flat.told[i].time, (0.4 + 0.8 * static_cast<double>(i)) / v, kExact) << i;
  // 4 m in all: 0.4 to the first wall, then 4.5 legs of 0.8.
  EXPECT_NEAR(flat.at(disc).x(), 0, 1e-9);
  EXPECT_EQ(flat.velocity(disc), Vector3(-v, 0, 0));
}

TEST(PlanarHandlers, AnAgentMeetsABodyWithPhysicsOnItsPath) {
  // Pairs that do not push are reported by the same stage: a ball that falls, and an agent that stands. The ball's path
  // within an integration step counts as straight, which is g h^2 / 8 from its parabola at most.
  const double h = 1.0 / 240;
  Crowd flat(h);
  const ObjectId ball = flat.ball(0.5, 0, 4);
  const ObjectId agent = flat.agent(Shape::sphere(0.5), 0, 0, 0, 0);
  flat.run(1);
  ASSERT_GE(flat.told.size(), 1U);
  const double wanted = std::sqrt(2 * 3 / 9.81);
  EXPECT_EQ(flat.told.front().a, ball);
  EXPECT_EQ(flat.told.front().b, agent);
  EXPECT_NEAR(flat.told.front().time, wanted, 9.81 * h * h / 8 / (9.81 * wanted) + 1e-5);
}

}  // namespace
}  // namespace breve::testing
