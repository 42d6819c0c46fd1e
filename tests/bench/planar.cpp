// A flat world beside Box2D driven directly: the same 1,000 bodies, the same sub-steps and iterations, in turns in one
// run, from the fall to rest. Prints the times of a step and the middle of the rounds' ratios; exits 1 if it is above
// 1.10. The guard reports: one that refines would take more sub-steps than the other side.
#include <box2d/box2d.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include "../runtime/fake_behaviour.hpp"

namespace {

using namespace breve;

constexpr int kBodies = 1000, kColumns = 40, kRounds = 7, kSteps = 60, kSubSteps = 4;
constexpr float kStep = 1.0F / 60;

float x_of(int i) { return -19.0F + 0.95F * static_cast<float>(i % kColumns); }
float y_of(int i) { return 0.6F + 0.9F * static_cast<float>(i / kColumns); }

struct Ours : testing::Scene {
  Ours() {
    script.recording = false;
    world.flatten();
    world.set_integration_step(kStep);
    world.set_iteration_step(kStep);
    world.mechanics().set_guard(GuardMode::Report);
    const auto wall = [&](double w, double h, double x, double y) {
      plain(body(2, {x, y, 0}, BodyKind::Stationary, Shape::box({w, h, 1})));
    };
    wall(60, 2, 0, -1), wall(2, 80, -21, 38), wall(2, 80, 21, 38);
    for (int i = 0; i < kBodies; ++i) {
      const auto shape = i % 2 == 0 ? Shape::box({0.7, 0.7, 1}) : Shape::sphere(0.35);
      const ObjectId id = body(1, {x_of(i), y_of(i), 0}, BodyKind::Mobile, shape);
      plain(id);
      world.bodies().set_physics(world.body(id), true);
    }
  }
  void plain(ObjectId id) {
    Material& m = world.bodies().material(world.body(id));
    m.static_friction = m.dynamic_friction = 0.5;
    m.normal_restitution = 0;
  }
  void step() { world.step(); }
};

struct Direct {
  b2World world{b2Vec2(0, -9.81F)};
  Direct() {
    const auto add = [&](b2BodyType type, const b2Shape& shape, float x, float y) {
      b2BodyDef def;
      def.type = type;
      def.position.Set(x, y);
      b2FixtureDef fixture;
      fixture.shape = &shape;
      fixture.density = 1;
      fixture.friction = 0.5F;
      world.CreateBody(&def)->CreateFixture(&fixture);
    };
    const auto wall = [&](float w, float h, float x, float y) {
      b2PolygonShape box;
      box.SetAsBox(w / 2, h / 2);
      add(b2_staticBody, box, x, y);
    };
    wall(60, 2, 0, -1), wall(2, 80, -21, 38), wall(2, 80, 21, 38);
    b2PolygonShape box;
    box.SetAsBox(0.34F, 0.34F);
    box.m_radius = b2_polygonRadius;
    b2CircleShape circle;
    circle.m_radius = 0.35F;
    for (int i = 0; i < kBodies; ++i)
      add(b2_dynamicBody, i % 2 == 0 ? static_cast<const b2Shape&>(box) : circle, x_of(i), y_of(i));
    world.SetAllowSleeping(false);
  }
  void step() {
    for (int i = 0; i < kSubSteps; ++i) world.Step(kStep / kSubSteps, 8, 3);
  }
};

/// CPU time of a step: the machine may do other things besides.
template <class World>
double seconds(World& world) {
  const std::clock_t start = std::clock();
  for (int i = 0; i < kSteps; ++i) world.step();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / kSteps;
}

}  // namespace

int main() {
  Ours ours;
  Direct direct;
  std::vector<double> ratios;
  for (int round = 0; round < kRounds; ++round) {
    const double first = seconds(ours), second = seconds(direct);
    ratios.push_back(first / second);
    std::printf("round %d: breve %.3f ms, Box2D %.3f ms a step, ratio %.3f; sub-steps %d, contacts %d\n", round,
                1e3 * first, 1e3 * second, ratios.back(), static_cast<int>(ours.world.mechanics().counters().sub_steps),
                direct.world.GetContactCount());
  }
  std::nth_element(ratios.begin(), ratios.begin() + kRounds / 2, ratios.end());
  const double ratio = ratios[kRounds / 2];
  std::printf("planar: ratio %.3f (at most 1.10)\n", ratio);
  return ratio <= 1.10 ? 0 : 1;
}
