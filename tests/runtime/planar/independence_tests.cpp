// Bodies that are far away, and images that are taken, change nothing of the rest, bit for bit.
#include <functional>
#include <memory>
#include <random>
#include <string>

#include "scene.hpp"

namespace breve::testing {
namespace {

using Watched = std::vector<ObjectId>;

void bouncing_balls(Flat& scene, Watched& watched) {
  for (int i = 0; i < 6; ++i) {
    watched.push_back(scene.ball(0.3 + 0.05 * i, 1.1 * i, 1 + 0.7 * i));
    scene.material(watched.back(), 0.3, 0.7);
  }
  scene.bodies().set_velocity(scene.index(watched[2]), {2, 0, 0});
}

/// Boxes that come to lie on one another: each touches several at once.
void pile(Flat& scene, Watched& watched) {
  for (int row = 0; row < 5; ++row)
    for (int i = 0; i < 5 - row; ++i) watched.push_back(scene.box(0.9, 0.5, i + 0.5 * row, 0.3 + 0.6 * row));
  for (const ObjectId id : watched) scene.material(id, 0.5, 0.3);
}

void creature(Flat& scene, Watched& watched) {
  const ObjectId trunk = scene.box(1, 0.3, 0, 2);
  watched.push_back(trunk);
  for (const double side : {-1.0, 1.0}) {
    const ObjectId leg = scene.box(0.2, 0.8, 0.45 * side, 1.5);
    watched.push_back(leg);
    const JointIndex joint = scene.hinge(trunk, leg, {0.45 * side, -0.1, 0}, {0, 0.4, 0});
    JointDrive drive = scene.physics().drive(joint);
    drive.low[0] = -0.6;
    drive.high[0] = 0.6;
    drive.limit_restitution = 0.5;
    drive.motor_speed[0] = 3 * side;
    drive.strength_limit = 8;
    scene.physics().set_drive(joint, drive);
  }
  for (const ObjectId id : watched) scene.material(id, 0.6, 0.4);
}

/// A shot at a wall of light boxes: it needs shorter sub-steps than they do.
void shot(Flat& scene, Watched& watched) {
  for (int i = 0; i < 4; ++i) watched.push_back(scene.box(0.4, 0.4, 4, 0.2 + 0.4 * i));
  watched.push_back(scene.ball(0.1, -12, 1));
  for (const ObjectId id : watched) scene.material(id, 0.4, 0.5);
  scene.bodies().set_velocity(scene.index(watched.back()), {400, 0, 0});
}

constexpr double kFar = 200;

void far_ball(Flat& scene) {
  const ObjectId id = scene.ball(0.5, kFar, 1.3);
  scene.material(id, 0.2, 0.9);
}

void far_crowd(Flat& scene) {
  for (int i = 0; i < 12; ++i) {
    const ObjectId id =
        i % 2 == 0 ? scene.ball(0.4, kFar + 0.9 * (i % 4), 1 + i) : scene.box(0.7, 0.4, kFar + i, 2 + i);
    scene.material(id, 0.2, 0.6);
  }
}

void far_shot(Flat& scene) {
  const ObjectId id = scene.ball(0.2, kFar, 3);
  scene.bodies().set_velocity(scene.index(id), {500, 20, 0});
  const ObjectId wheel = scene.ball(0.4, kFar, 40);
  scene.bodies().set_rotational_velocity(scene.index(wheel), {0, 0, 900});
}

void far_pendulum(Flat& scene) {
  const ObjectId beam = scene.fixed(Shape::box({1, 0.2, 1}), -kFar, 8), rod = scene.box(2, 0.2, 1 - kFar, 8);
  const JointIndex joint = scene.hinge(beam, rod, {0, 0, 0}, {-1, 0, 0});
  JointDrive drive = scene.physics().drive(joint);
  drive.low[0] = -1;
  drive.high[0] = 1;
  drive.limit_restitution = 0.8;
  scene.physics().set_drive(joint, drive);
}

void far_spring(Flat& scene) {
  const ObjectId a = scene.ball(0.3, kFar, 20), b = scene.ball(0.3, kFar + 2, 20);
  SpringDescription spring;
  spring.a = scene.index(a);
  spring.b = scene.index(b);
  spring.length = 1;
  spring.strength = 500;
  scene.physics().add_spring(spring, a);
}

struct Named {
  const char* name;
  std::function<void(Flat&)> make;
};

std::vector<double> states(Flat& scene, const Watched& watched) {
  std::vector<double> all;
  for (const ObjectId id : watched) {
    const BodyIndex body = scene.index(id);
    for (const Vector3& v :
         {scene.bodies().location(body), scene.bodies().velocity(body), scene.bodies().rotational_velocity(body)})
      all.insert(all.end(), {v.x(), v.y(), v.z()});
  }
  return all;
}

class PlanarIndependence : public ::testing::TestWithParam<Rung> {};

TEST_P(PlanarIndependence, WhatIsFarAwayChangesNothing) {
  const std::pair<const char*, void (*)(Flat&, Watched&)> scenes[] = {
      {"bouncing balls", bouncing_balls}, {"a pile", pile}, {"a creature", creature}, {"a shot", shot}};
  const Named others[] = {{"a ball that bounces", far_ball},
                          {"a crowd", far_crowd},
                          {"a shot", far_shot},
                          {"a pendulum", far_pendulum},
                          {"a spring", far_spring}};
  for (const auto& [name, make] : scenes)
    for (const Named& other : others) {
      Flat alone(GetParam()), both(GetParam());
      Watched watched_alone, watched_both;
      for (Flat* scene : {&alone, &both}) scene->ground();
      make(alone, watched_alone);
      make(both, watched_both);
      other.make(both);
      for (int i = 0; i < 240; ++i) {
        alone.world.step();
        both.world.step();
        ASSERT_EQ(states(alone, watched_alone), states(both, watched_both))
            << name << " beside " << other.name << ", after " << i << " steps";
      }
    }
}

// --- images ---------------------------------------------------------------------------------------------------------

/// Random bodies, joints and springs, and a script that meddles with them: the same from the same seed.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double between(double least, double most) {
    return least + (most - least) * static_cast<double>(engine_() >> 11) / 9007199254740992.0;
  }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(engine_() % count); }
  bool once_in(std::size_t count) { return below(count) == 0; }

 private:
  std::mt19937_64 engine_;
};

std::shared_ptr<Shape> random_shape(Random& random) {
  const double size = random.between(0.3, 1.2);
  switch (random.below(3)) {
    case 0: return Shape::sphere(size / 2);
    case 1: return Shape::capsule(size, 0.2);
    default: return Shape::box({size, random.between(0.3, 1), 1});
  }
}

void add_body(Flat& scene, Watched& all, Random& random) {
  const double x = random.between(-6, 6), y = random.between(0.5, 9), angle = random.between(0, 3);
  all.push_back(scene.rigid(random_shape(random), x, y, angle));
  scene.material(all.back(), random.between(0, 0.8), random.once_in(3) ? 0 : random.between(0, 0.9));
  const double speed = random.between(-60, 60);
  if (random.once_in(6)) scene.bodies().set_velocity(scene.index(all.back()), {speed, 0, 0});
}

void connect(Flat& scene, ObjectId a, ObjectId b, Random& random) {
  if (random.once_in(2)) {
    SpringDescription spring;
    spring.a = scene.index(a);
    spring.b = scene.index(b);
    spring.length = random.between(0.5, 2);
    spring.strength = random.between(10, 300);
    spring.damping = random.between(0, 3);
    scene.physics().add_spring(spring, a);
    return;
  }
  // One after the other: the order of arguments is the compiler's.
  const double on_a = random.between(-0.4, 0.4), on_b = random.between(-0.4, 0.4);
  const JointIndex joint = scene.hinge(a, b, {on_a, 0, 0}, {on_b, 0, 0});
  JointDrive drive = scene.physics().drive(joint);
  drive.motor_speed[0] = random.between(-5, 5);
  drive.strength_limit = random.once_in(2) ? random.between(1, 20) : 0;
  if (random.once_in(2)) {
    drive.low[0] = -1;
    drive.high[0] = 1;
    drive.limit_restitution = random.between(0, 0.9);
  }
  scene.physics().set_drive(joint, drive);
}

void fill(Flat& scene, Watched& all, std::uint64_t seed) {
  Random random(seed);
  scene.ground(40);
  if (random.once_in(2)) scene.physics().set_sleeping(true);
  const std::size_t count = 3 + random.below(20);
  for (std::size_t i = 0; i < count; ++i) add_body(scene, all, random);
  // Each is connected with an earlier one at most, so that no joint closes a loop.
  for (std::size_t i = 1; i < count; ++i)
    if (random.once_in(3)) connect(scene, all[random.below(i)], all[i], random);
}

void meddle(Flat& scene, Watched& all, Random random) {
  if (!random.once_in(12)) return;
  const std::size_t chosen = random.below(all.size());
  switch (random.below(4)) {
    case 0: add_body(scene, all, random); break;
    case 1: scene.bodies().set_velocity(scene.index(all[chosen]), {random.between(-4, 4), 5, 0}); break;
    case 2: scene.bodies().set_location(scene.index(all[chosen]), {random.between(-6, 6), 6, 0}); break;
    default:
      if (all.size() < 4) break;
      scene.world.release(all[chosen]);
      all.erase(all.begin() + static_cast<std::ptrdiff_t>(chosen));
  }
}

TEST_P(PlanarIndependence, TakingAnImageAndRestoringItChangeNothing) {
  constexpr int kSteps = 150;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const std::uint64_t saved_each = 1 + 7 * seed % 40;
    Flat untouched(GetParam()), saved(GetParam());
    std::unique_ptr<Flat> restored;
    Watched in_untouched, in_saved, in_restored;
    fill(untouched, in_untouched, seed);
    fill(saved, in_saved, seed);
    for (std::uint64_t i = 1; i <= kSteps; ++i) {
      const Random random(1000 * seed + i);
      meddle(untouched, in_untouched, random);
      meddle(saved, in_saved, random);
      untouched.world.step();
      saved.world.step();
      ASSERT_EQ(untouched.world.hash(), saved.world.hash()) << "seed " << seed << ", step " << i;
      if (restored) {
        meddle(*restored, in_restored, random);
        restored->world.step();
        ASSERT_EQ(untouched.world.hash(), restored->world.hash()) << "seed " << seed << ", step " << i;
      }
      if (i % saved_each != 0) continue;
      const auto image = saved.world.save(1);
      restored = std::make_unique<Flat>(GetParam());
      restored->world.load(image.data(), image.size(), 1);
      in_restored = in_saved;
      ASSERT_EQ(untouched.world.hash(), restored->world.hash()) << "seed " << seed << ", restored after step " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Rungs, PlanarIndependence, ::testing::Values(Rung::Fast, Rung::Balanced, Rung::Precise),
                         [](const ::testing::TestParamInfo<Rung>& param) { return std::string(name_of(param.param)); });

}  // namespace
}  // namespace breve::testing
