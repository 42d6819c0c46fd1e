// Across edges of space that wrap, and at its walls: collisions of agents, and machines of joints; in space and flat.
#include <gtest/gtest.h>

#include <cmath>

#include "fake_behaviour.hpp"
#include "runtime/base/random.hpp"
#include "runtime/mechanics/mechanics.hpp"

namespace breve::testing {
namespace {

Vector3 random_position(Random& random, double size) {
  return {size * random.uniform(), size * random.uniform(), size * random.uniform()};
}

struct Meeting : Scene {
  struct Told {
    double time;
    ObjectId a, b;
    Vector3 point, normal;
  };
  std::vector<Told> told;
  bool bounce = false;
  explicit Meeting(bool flat) {
    if (flat) world.flatten();
    world.set_integration_step(0.05);
    world.set_iteration_step(0.05);
    script.recording = false;
    world.handle_collisions(1, 1, "met", controller);
    script.on_collided = [this](ObjectId a, ObjectId b, const Vector3& point, const Vector3& normal) {
      told.push_back({world.time(), a, b, point, normal});
      if (!bounce) return true;
      // Equal and elastic: what is along the normal is exchanged.
      Bodies& all = world.bodies();
      const Vector3 v = all.velocity(world.body(a)), w = all.velocity(world.body(b));
      const Vector3 change = normal.dot(v - w) * normal;
      if (normal.dot(v - w) >= 0) return true;
      all.set_velocity(world.body(a), v - change);
      all.set_velocity(world.body(b), w + change);
      return true;
    };
  }
  ObjectId ball(double r, const Vector3& at, const Vector3& v) {
    const ObjectId id = body(1, at, BodyKind::Mobile, Shape::sphere(r));
    set_velocity(id, v);
    return id;
  }
};

TEST(Space, BodiesMeetAcrossAnEdgeThatWrapsAtTheirMoment) {
  for (const bool flat : {false, true}) {
    Meeting m(flat);
    m.world.set_space(0, Ending::Wrap, 0, 10);
    m.world.set_space(1, Ending::Wrap, 0, 10);
    const ObjectId a = m.ball(0.2, {0.3, 9.9, 0}, {-1, 0.5, 0}), b = m.ball(0.1, {9.8, 0.05, 0}, {0, 0, 0});
    for (int i = 0; i < 10; ++i) m.world.step();
    // The image of b is at (-0.2, 10.05): |(-0.5 + t, 0.15 - t / 2)| = 0.3.
    const double t = (0.575 - std::sqrt(0.575 * 0.575 - 1.25 * (0.2725 - 0.09))) / 1.25;
    ASSERT_GE(m.told.size(), 2U);
    EXPECT_NEAR(m.told[0].time, t, 1e-10);
    EXPECT_EQ(m.told[0].a, a);
    EXPECT_EQ(m.told[0].b, b);
    EXPECT_NEAR((m.told[0].normal - Vector3(0.5 - t, t / 2 - 0.15, 0) / 0.3).norm(), 0, 1e-8);
    // It lasts while a goes over the edge: once a sub-step.
    for (std::size_t i = 1; i < m.told.size(); ++i) EXPECT_GT(m.told[i].time, m.told[i - 1].time + 1e-9);
  }
}

/// Balls that bounce in a space that wraps along all its axes: when they met.
std::vector<double> meetings(bool flat, const Vector3& moved_by) {
  Meeting m(flat);
  m.bounce = true;
  for (int axis = 0; axis < (flat ? 2 : 3); ++axis) m.world.set_space(axis, Ending::Wrap, 0, 4);
  Random random(7);
  for (int i = 0; i < 27; ++i) {
    const Vector3 position(0.5 + 1.3 * (i % 3), 0.5 + 1.3 * (i / 3 % 3), flat ? 0 : 0.5 + 1.3 * (i / 9));
    Vector3 v = random_position(random, 2) - Vector3(1, 1, 1);
    if (flat) v.z() = 0;
    if (!flat || i < 9) m.ball(0.3, m.world.space().inside(position + moved_by), v);
  }
  for (int i = 0; i < 100; ++i) m.world.step();
  std::vector<double> times;
  for (const Meeting::Told& one : m.told) times.push_back(one.time);
  return times;
}

TEST(Space, ThatWrapsHasNoPlaceThatIsDifferent) {
  for (const bool flat : {false, true}) {
    const std::vector<double> here = meetings(flat, {0, 0, 0});
    EXPECT_GT(here.size(), flat ? 8U : 20U);
    for (const Vector3& way : {Vector3(2, 2, flat ? 0 : 2), Vector3(0.7, 3.1, 0)}) {
      const std::vector<double> there = meetings(flat, way);
      ASSERT_EQ(here.size(), there.size());
      for (std::size_t i = 0; i < here.size(); ++i) ASSERT_NEAR(here[i], there[i], 1e-7) << i;
    }
  }
}

/// Two boxes on a hinge, somewhere in space.
struct Machine : Scene {
  ObjectId first, second;
  explicit Machine(bool flat, const Vector3& at) {
    if (flat) world.flatten();
    script.recording = false;
    world.set_gravity(Vector3::Zero());
    first = body(1, at, BodyKind::Mobile, Shape::box({1, 0.2, 0.2}));
    second = body(1, at + Vector3(1, 0, 0), BodyKind::Mobile, Shape::box({1, 0.2, 0.2}));
    JointDescription is;
    is.parent = world.body(first);
    is.child = world.body(second);
    is.parent_point = {0.5, 0, 0};
    is.child_point = {-0.5, 0, 0};
    is.normal = {0, 0, 1};
    world.mechanics().link(is, second);
  }
  Vector3 between() { return at(second) - at(first); }
  double energy() { return world.mechanics().energy().total(); }
};

TEST(Space, AMachineWrapsAsAWholeByItsFirstBody) {
  for (const bool flat : {false, true}) {
    Machine m(flat, {8, 5, 0});
    m.world.set_space(0, Ending::Wrap, 0, 10);
    m.world.mechanics().set_assembly_velocity(m.world.body(m.first), {1, 0, 0}, {0, 0, 0});
    for (int i = 0; i < 180; ++i) {
      m.world.step();
      ASSERT_NEAR((m.between() - Vector3(1, 0, 0)).norm(), 0, 1e-3);
      ASSERT_LT(m.at(m.first).x(), 10);
      ASSERT_GE(m.at(m.first).x(), 0);
    }
    EXPECT_NEAR(m.at(m.first).x(), std::fmod(8 + m.world.time(), 10), 1e-3);
    EXPECT_NEAR(m.world.bodies().velocity(m.world.body(m.second)).x(), 1, 1e-5);
  }
}

TEST(Space, AWallThrowsAMachineBackWithAllItsEnergy) {
  for (const bool flat : {false, true}) {
    Machine m(flat, {5, 5, 0});
    m.world.set_space(0, Ending::Wall, 0, 10);
    m.world.mechanics().set_assembly_velocity(m.world.body(m.first), {3, 0.5, 0}, {0, 0, 0});
    m.world.bodies().set_rotational_velocity(m.world.body(m.second), {0, 0, 1});
    m.world.mechanics().take_changes();
    m.world.step();
    const double energy = m.energy();
    int returns = 0;
    double last = 1;
    for (int i = 0; i < 600; ++i) {
      m.world.step();
      ASSERT_NEAR(m.energy(), energy, 0.01 * energy) << i;
      ASSERT_LE(m.at(m.first).x(), 10);
      ASSERT_GE(m.at(m.first).x(), 0);
      const double now =
          m.world.bodies().velocity(m.world.body(m.first)).x() + m.world.bodies().velocity(m.world.body(m.second)).x();
      returns += now * last < 0 ? 1 : 0;
      last = now;
    }
    EXPECT_GE(returns, 2);
    EXPECT_NEAR(m.world.mechanics().energy().residual, 0, 0.01 * energy);
  }
}

TEST(Space, WhatHangsOnTheWorldStaysWhereItIs) {
  for (const bool flat : {false, true}) {
    Machine m(flat, {-5, 5, 0});
    JointDescription is;
    is.child = m.world.body(m.first);
    is.parent_point = {-5, 5, 0};
    is.normal = {0, 0, 1};
    m.world.mechanics().link(is, m.first);
    m.world.set_space(0, Ending::Wrap, 0, 10);
    for (int i = 0; i < 10; ++i) m.world.step();
    EXPECT_NEAR((m.at(m.first) - Vector3(-5, 5, 0)).norm(), 0, 1e-6);
  }
}

}  // namespace
}  // namespace breve::testing
