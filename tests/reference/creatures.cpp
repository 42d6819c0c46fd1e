#include "creatures.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "scenes.hpp"

namespace breve::reference {

namespace {

/// A body with one to six limbs of one or two sections, all boxes, lying together around `at`.
void creature(World& world, std::mt19937& random, const Vector3& at, const Habits& habits) {
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  };
  const auto any = [&] { return Vector3{between(-1, 1), between(-1, 1), between(-1, 1)}.normalized(); };
  const auto part = [&](double size) {
    const Vector3 edges{size * between(0.1, 0.4), size * between(0.5, 1), size * between(0.1, 0.4)};
    return std::pair(edges, world.body(box(edges, 1000 * edges.prod()), at));
  };
  const auto [trunk, body] = part(1);
  const int limbs = 1 + static_cast<int>(random() % 6);
  std::vector<breve_object> parts{body};
  for (int limb = 0; limb < limbs; ++limb) {
    breve_object parent = body;
    Vector3 where = 0.5 * trunk.cwiseProduct(any());
    for (int section = 0; section < 1 + static_cast<int>(random() % 2); ++section) {
      const auto [edges, made] = part(0.6);
      Hinge hinge;
      hinge.parent = parent;
      hinge.child = made;
      hinge.parent_point = where;
      hinge.child_point = Vector3(0, -0.5 * edges.y(), 0);
      hinge.normal = any();
      hinge.rotation = Quaternion(Eigen::AngleAxisd(between(0, 2 * kPi), any()));
      const breve_object joint = world.join(hinge);
      if (habits.limits) {
        breve_drive drive = world.drive(joint);
        drive.low[0] = -between(0, 0.6);
        drive.high[0] = between(0, 0.6);
        drive.limit_restitution = habits.rebound;
        world.set_drive(joint, drive);
      }
      parts.push_back(made);
      parent = made;
      where = Vector3(0, 0.5 * edges.y(), 0);
    }
  }
  for (const breve_object one : parts) {
    const double restitution = between(0, 0.8), friction = between(0, 1);
    world.set_material(one, breve_material{friction, friction, restitution, 0, habits.threshold});
  }
  const breve_pose pose{{at.x(), at.y(), at.z()}, {1, 0, 0, 0}};
  world.must(breve_object_set_assembly_pose(world.get(), body, &pose));
}

void creatures_above_a_plane(World& world, int count, const Habits& habits) {
  world.set_guard(BREVE_GUARD_REPORT);
  const breve_object floor = world.fixed(box(Vector3(200, 10, 200), 1), Vector3(0, -5, 0));
  world.set_material(floor, 0.7, 0.3);
  std::mt19937 random(7);
  for (int i = 0; i < count; ++i)
    creature(world, random, Vector3(5.0 * (i % 15) - 35, 2.5, 5.0 * (i / 15) - 35), habits);
}

}  // namespace

std::uint64_t drop_creatures(breve_rung rung, int count, double seconds, const Habits& habits) {
  World world(1.0 / 60, rung);
  creatures_above_a_plane(world, count, habits);
  const double begin = world.mechanical();
  double most = begin;
  world.run(seconds, [&] { most = std::max(most, world.mechanical()); });
  std::printf("  energy %.1f J at the start, %.1f at most, %.1f at the end; %.0f sub-steps a step, %lu interventions\n",
              begin, most, world.mechanical(), world.toll().per_iteration(), world.toll().interventions);
  EXPECT_LE(most - begin, 0.01 * begin);
  return world.toll().interventions;
}

Lying drop_and_lie(breve_rung rung, int count, double seconds) {
  World world(1.0 / 60, rung);
  creatures_above_a_plane(world, count, {});
  world.run(seconds);
  const double before = world.mechanical();
  const std::uint64_t impacts = world.toll().impacts;
  world.run(1);
  const Lying lying{world.toll().impacts - impacts, before - world.mechanical()};
  std::printf("  %lu impacts in a second, %.3f J of %.0f lost\n", lying.impacts, lying.lost, before);
  return lying;
}

}  // namespace breve::reference
