// Scenes of single bodies: what clumps, bounces, stacks, falls and is poured.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/scenes/builders.hpp"

namespace breve::scenes {
namespace {

constexpr double kPull = 4, kSoft = 0.4;  // N*m^2, m: of balls that attract each other
constexpr double kSpeed = 3;              // m/s, of the crowd

}  // namespace

/// Balls that attract each other as masses do; they fall into one clump and stay there.
Scene clump(int count, bool flat) {
  constexpr double kRadius = 0.4;  // m
  Scene scene;
  scene.flat = flat;
  scene.gravity = 0;
  scene.restitution = 0.3;
  Draw draw(7);
  Body one;
  one.shape = scene.add(ball(kRadius, 1 / 0.268));  // 1 kg
  const double half = flat ? 0.55 * std::sqrt(count) : 0.6 * std::cbrt(count);
  while (static_cast<int>(scene.bodies.size()) < count) {
    one.at = draw.within({half, half, flat ? 0 : half});
    const bool free = std::none_of(scene.bodies.begin(), scene.bodies.end(),
                                   [&](const Body& other) { return (other.at - one.at).norm() < 2 * kRadius; });
    if (free) scene.add(one);
  }
  scene.act = [count](Side& side, double) {
    std::vector<Vector3> positions, forces(static_cast<std::size_t>(count), Vector3::Zero());
    for (int i = 0; i < count; ++i) positions.push_back(side.at(i));
    for (std::size_t i = 0; i < positions.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) {
        const Vector3 apart = positions[k] - positions[i];
        const Vector3 pull = kPull * apart / std::pow(apart.squaredNorm() + kSoft * kSoft, 1.5);
        forces[i] += pull;
        forces[k] -= pull;
      }
    for (int i = 0; i < count; ++i) side.set_force(i, forces[static_cast<std::size_t>(i)]);
  };
  return scene;
}

/// A block of balls, each on springs to its neighbours along the axes and the diagonals of faces, falls on a floor.
Scene springs(int side, bool flat) {
  constexpr double kRadius = 0.2, kReach = 1.5, kStart = 1;  // m
  Scene scene;
  scene.flat = flat;
  scene.restitution = 0.3;
  add_floor(scene);
  Body one;
  one.shape = scene.add(ball(kRadius, 1 / 0.03351));  // 1 kg
  const int deep = flat ? 1 : side;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      for (int z = 0; z < deep; ++z) {
        one.at = Vector3(x - 0.5 * (side - 1), kStart + y, z - 0.5 * (deep - 1));
        scene.add(one);
      }
  for (std::size_t i = 1; i < scene.bodies.size(); ++i)
    for (std::size_t k = i + 1; k < scene.bodies.size(); ++k) {
      const double length = (scene.bodies[i].at - scene.bodies[k].at).norm();
      if (length < kReach) scene.springs.push_back({static_cast<int>(i), static_cast<int>(k), length, 300, 1});
    }
  return scene;
}

/// Three closed meshes of 6,000 triangles each on a floor: two rings, one leaning on the other, and a ball with bumps.
Scene meshes() {
  Scene scene;
  add_floor(scene);
  Body one;
  one.shape = scene.add(torus(1, 0.35, 60, 50, 100));
  one.at = {0, 0.4, 0};
  scene.add(one);
  one.at = {1.1, 1.5, 0};
  one.orientation = Eigen::AngleAxisd(0.9, Vector3::UnitZ());
  scene.add(one);
  one.shape = scene.add(bumpy(0.8, 60, 51, 100));
  one.at = {-2.8, 1, 0.2};
  one.orientation = Eigen::AngleAxisd(0.5, Vector3::UnitX());
  scene.add(one);
  return scene;
}

/// Agents that drift above flat ground; one far peak makes the box of the ground hold them all.
Scene terrain_agents() {
  constexpr std::uint32_t kSide = 33;
  Scene scene;
  Shape ground;
  ground.form = Form::Field;
  ground.columns = ground.rows = kSide;
  ground.tile = 1;
  ground.heights.assign(std::size_t{kSide} * kSide, 0);
  ground.heights[0] = 20;
  Body one;
  one.shape = scene.add(ground);
  one.motion = Motion::Fixed;
  scene.add(one);
  one.shape = scene.add(cone(5, 0.2, 0.5));
  one.motion = Motion::Agent;
  one.velocity = {0.01, 0, 0};
  Draw draw(11);
  for (int i = 0; i < 60; ++i) {
    one.at = Vector3(0, 5, 0) + draw.within({5, 0, 5});
    scene.add(one);
  }
  return scene;
}

/// Balls roll to rest in the valleys of a ground of waves.
Scene terrain_balls(bool flat) {
  constexpr std::uint32_t kSide = 33;
  Scene scene;
  scene.flat = flat;
  scene.restitution = 0.3;
  Shape ground;
  ground.form = Form::Field;
  ground.columns = ground.rows = kSide;
  for (std::uint32_t z = 0; z < kSide; ++z)
    for (std::uint32_t x = 0; x < kSide; ++x)
      ground.heights.push_back(1.5 * std::sin(0.7 * x) * (flat ? 1 : std::sin(0.7 * z)));
  // Walls around, so that none leaves.
  for (std::uint32_t z = 0; z < kSide; ++z)
    for (std::uint32_t x = 0; x < kSide; ++x)
      if (x == 0 || x == kSide - 1 || (!flat && (z == 0 || z == kSide - 1))) ground.heights[z * kSide + x] = 8;
  Body one;
  one.shape = scene.add(ground);
  one.motion = Motion::Fixed;
  scene.add(one);
  one.shape = scene.add(ball(0.5));
  one.motion = Motion::Free;
  Draw draw(13);
  for (int i = 0; i < 26; ++i) {
    const Vector3 aside = draw.within({0.3, 0.5, 0.3});
    one.at = flat ? Vector3(-13 + 1.04 * i + 0.1 * aside.x(), 3 + aside.y(), 0)
                  : Vector3(-10 + 4 * (i % 6), 3, -8 + 4 * (i / 6)) + aside;
    scene.add(one);
  }
  return scene;
}

Scene pyramid(bool flat) {
  constexpr int kRows = 15;
  Scene scene;
  scene.flat = flat;
  add_floor(scene);
  Body one;
  one.shape = scene.add(box(Vector3::Ones()));
  for (int row = 0; row < kRows; ++row)
    for (int i = 0; i < kRows - row; ++i) {
      one.at = {i * 1.05 - (kRows - 1 - row) * 0.525, 0.5 + row, 0};
      scene.add(one);
    }
  return scene;
}

Scene dominoes(bool flat) {
  constexpr int kCount = 100;
  Scene scene;
  scene.flat = flat;
  scene.friction = 0.4;
  add_floor(scene);
  Body one;
  one.shape = scene.add(box({0.2, 1, 0.5}, 10));
  for (int i = 0; i < kCount; ++i) {
    one.at = {0.6 * (i - kCount / 2), 0.5, 0};
    one.velocity = i == 0 ? Vector3(0.75, 0, 0) : Vector3::Zero();
    one.spin = i == 0 ? Vector3(0, 0, -1.5) : Vector3::Zero();
    scene.add(one);
  }
  return scene;
}

/// Balls that run at one ball in their middle, in a plane.
Scene crowd(bool flat) {
  constexpr int kCount = 300;
  Scene scene;
  scene.flat = flat;
  scene.gravity = 0;
  scene.restitution = 0.4;
  Body one;
  one.shape = scene.add(ball(0.5));
  scene.add(one);
  one.shape = scene.add(ball(0.3));
  Draw draw(17);
  for (int i = 0; i < kCount; ++i) {
    one.at = flat ? draw.within({20, 20, 0}) : draw.within({20, 0, 20});
    scene.add(one);
  }
  scene.act = [](Side& side, double) {
    const Vector3 goal = side.at(0);
    for (int i = 1; i <= kCount; ++i) {
      const Vector3 way = goal - side.at(i);
      if (way.norm() > 0.001) side.set_velocity(i, kSpeed * way.normalized());
    }
  };
  return scene;
}

namespace {

/// Half a circle of boxes, open above: what a bowl is in the plane.
void add_flat_bowl(Scene& scene, double radius) {
  constexpr int kBoxes = 24;
  Body one;
  const double edge = 1.1 * std::numbers::pi * (radius + 1) / kBoxes;
  one.shape = scene.add(box({1, edge, 1}));
  one.motion = Motion::Fixed;
  for (int i = 0; i < kBoxes; ++i) {
    const double angle = std::numbers::pi * (i + 0.5) / kBoxes;
    one.at = (radius + 0.5) * Vector3(std::cos(angle), -std::sin(angle), 0);
    one.orientation = Eigen::AngleAxisd(-angle, Vector3::UnitZ());
    scene.add(one);
  }
}

}  // namespace

/// 500 convex bodies of five kinds are poured into a bowl, ten every 0.2 s.
Scene pour(bool flat) {
  constexpr int kCount = 500, kAtOnce = 10, kEvery = 12;
  constexpr double kDensity = 500;
  Scene scene;
  scene.flat = flat;
  scene.friction = 0.4;
  scene.restitution = 0.2;
  Body one;
  if (flat) {
    add_flat_bowl(scene, 6);
  } else {
    one.shape = scene.add(bowl(3, 3.6, 48, 24));
    one.motion = Motion::Fixed;
    scene.add(one);
  }
  const std::size_t first = scene.add(box({0.3, 0.3, 0.3}, kDensity));
  scene.add(ball(0.17, kDensity));
  scene.add(prism(8, 0.18, 0.25, kDensity));
  scene.add(flat ? prism(3, 0.2, 0.25, kDensity) : cone(6, 0.2, 0.35, kDensity));
  scene.add(box({0.5, 0.15, 0.2}, kDensity));
  one.motion = Motion::Free;
  Draw draw(19);
  for (int i = 0; i < kCount; ++i) {
    const int n = i % kAtOnce;
    one.shape = first + static_cast<std::size_t>(i % 5);
    one.at = flat ? Vector3(n * 0.9 - 4.05, 2.2 + 0.02 * (i % 7), 0)
                  : Vector3(n % 4 * 0.7 - 1.05, 2.2 + 0.02 * (i % 7) + n / 4 * 0.7, i / 4 % 4 * 0.6 - 0.9);
    one.orientation = draw.orientation(flat);
    one.born = i / kAtOnce * kEvery;
    if (flat) one.velocity = {0, -3, 0};  // or the next ten would appear in these
    scene.add(one);
  }
  return scene;
}

}  // namespace breve::scenes
