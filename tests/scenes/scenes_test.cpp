// The scenes themselves, and what breve makes of them.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/scenes/breve_side.hpp"

namespace breve::scenes {
namespace {

constexpr double kStep = 1.0 / 60;

TEST(Scenes, BreveGivesBodiesTheMassesThatPeersAreGiven) {
  for (const std::string& name : names()) {
    const Scene scene = make(name);
    BreveSide side(scene, BREVE_RUNG_FAST, kStep);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (scene.bodies[i].motion != Motion::Free) continue;
      const int number = static_cast<int>(i);
      side.appear(number);
      double mass = 0;
      side.world().must(breve_object_mass(side.world().get(), side.body(number), &mass));
      EXPECT_NEAR(mass / mass_properties(scene.shapes[scene.bodies[i].shape]).mass, 1, 1e-9) << name << " body " << i;
    }
  }
}

TEST(Scenes, NothingMovesBeforeTheFirstStep) {
  for (const std::string& name : names()) {
    const Scene scene = make(name);
    const BreveSide side(scene, BREVE_RUNG_FAST, kStep);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (scene.bodies[i].born > 0) continue;
      EXPECT_LT((side.at(static_cast<int>(i)) - scene.bodies[i].at).norm(), 1e-12) << name << " body " << i;
    }
  }
}

/// A small body on a heavy one, without gravity.
Scene pair(const Vector3& at, const Joint& joint) {
  Scene scene;
  scene.gravity = 0;
  Body body;
  body.assembly = 0;
  body.shape = scene.add(box({1, 1, 1}, 1000));
  scene.add(body);
  body.shape = scene.add(box({0.2, 0.2, 0.2}));
  body.at = at;
  scene.add(body);
  scene.joints.push_back(joint);
  return scene;
}

TEST(Scenes, MotorsAndStopsOfHingesRotateTheChildAboutTheAxis) {
  Joint hinge;
  hinge.child = 1;
  hinge.at = {0.6, 0, 0};
  hinge.strength = 5;
  hinge.low[0] = -0.3, hinge.high[0] = 0.7;
  const Scene scene = pair({1.2, 0, 0}, hinge);
  for (const double speed : {1.0, -1.0}) {
    BreveSide side(scene, BREVE_RUNG_BALANCED, kStep);
    for (int i = 0; i < 120; ++i) {
      side.set_motor(0, speed);
      side.step();
    }
    const double stop = speed > 0 ? 0.7 : -0.3;
    EXPECT_NEAR(side.angle(0), stop, 1e-3);
    EXPECT_NEAR(side.at(1).y(), 0.6 * std::sin(stop), 1e-2);
  }
}

TEST(Scenes, StopsOfBallJointsAreAboutXAndZ) {
  Joint joint;
  joint.kind = Link::Ball;
  joint.child = 1;
  joint.at = {0, 0.6, 0};
  joint.low = {-0.3, -0.4, -0.5};
  joint.high = {0.6, 0.7, 0.8};
  const Scene scene = pair({0, 1.2, 0}, joint);
  const auto pushed = [&](const Vector3& force) {
    BreveSide side(scene, BREVE_RUNG_BALANCED, kStep);
    for (int i = 0; i < 600; ++i) {
      side.set_force(1, 0.01 * force);
      side.set_force(0, -0.01 * force);
      side.step();
    }
    return Vector3(side.world().orientation(side.body(0)).conjugate() * (side.at(1) - side.at(0)));
  };
  // The heavy body hardly moves; a hundredth is what the stops give.
  EXPECT_NEAR(pushed({0, 0, 1}).z(), 0.6 * std::sin(0.6), 1e-2);
  EXPECT_NEAR(pushed({0, 0, -1}).z(), 0.6 * std::sin(-0.3), 1e-2);
  EXPECT_NEAR(pushed({-1, 0, 0}).x(), -0.6 * std::sin(0.8), 1e-2);
  EXPECT_NEAR(pushed({1, 0, 0}).x(), 0.6 * std::sin(0.5), 1e-2);
}

}  // namespace
}  // namespace breve::scenes
