// Pistons, mixers, presses and lifts that a host moves, in a shaft with bodies that cannot always escape. The force of
// such a machine has no bound, so a solution would throw the bodies that it squeezes out at any speed, or there is
// none.
#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "thrown.hpp"

namespace breve::reference {
namespace {

enum class Machine : std::uint8_t { Piston, Mixer, Press, Lift };

constexpr double kSide = 1.6;  // m, from the middle of the shaft to the middles of its walls, which are 1 m thick

struct Drive {
  double speed, rate;  // of the piston, press and lift, m/s, and of the mixer, rad/s
};

Solid solid_of(Machine machine) {
  const double wide = 2 * kSide - 1.2;
  switch (machine) {
    case Machine::Piston: return box(Vector3(0.3, 2, wide), 1);
    case Machine::Mixer: return box(Vector3(wide - 0.2, 0.3, 0.2), 1);
    default: return box(Vector3(wide, 0.3, wide), 1);
  }
}

breve_pose pose_of(Machine machine, const Drive& drive, double time, bool flat) {
  const double swing = 1 - std::cos(drive.speed * time);
  Vector3 at(0, flat ? 1.2 : 0.25, 0);
  double angle = 0;
  switch (machine) {
    case Machine::Piston: at = Vector3(-kSide + 0.8 + (kSide - 0.8) * swing, 1.02, 0); break;
    case Machine::Mixer: angle = drive.rate * time; break;
    case Machine::Press: at.y() = 5 - 2.3 * swing; break;
    case Machine::Lift: at.y() = 0.2 + swing; break;
  }
  const double half = std::cos(angle / 2), axis = std::sin(angle / 2);  // about z in a flat world, else about y
  return {{at.x(), at.y(), at.z()}, {half, 0, flat ? 0 : axis, flat ? axis : 0}};
}

struct Outcome {
  double fastest = 0;      // m/s, of a body
  std::uint64_t work = 0;  // units, of the physics of the iteration that had the most
};

Outcome drive_one(Machine machine, breve_rung rung, std::uint32_t dimension, std::uint32_t seed) {
  Chance chance{std::mt19937(seed)};
  const bool flat = dimension == 2;
  World world(1.0 / 60, rung, dimension);
  const double friction = chance.one_in(3) ? 0 : chance.between(0, 1.2), rebound = chance.between(0, 0.9);
  const breve_material material{friction, friction, rebound, 0, chance.one_in(2) ? 0.05 : 0};
  const auto place = [&](const Solid& solid, const Vector3& at) {
    const breve_object made = world.fixed(solid, at);
    world.set_material(made, material);
    return made;
  };
  place(box(Vector3(60, 2, 60), 1), Vector3(0, -1, 0));
  for (const double side : {-kSide, kSide}) {
    place(box(Vector3(1, 12, 2 * kSide + 2), 1), Vector3(side, 5, 0));
    if (!flat) place(box(Vector3(2 * kSide + 2, 12, 1), 1), Vector3(0, 5, side));
  }
  const double speed = chance.between(0.2, 3), rate = chance.between(0.5, 6);
  const Drive drive{speed, rate};
  const breve_pose begin = pose_of(machine, drive, 0, flat);
  const breve_object moved = place(solid_of(machine), vector(begin.location));
  std::vector<breve_object> bodies;
  const int count = 1 + static_cast<int>(chance.random() % 6);
  for (int i = 0; i < count; ++i) {
    Vector3 at = Vector3(0, 1.4 + 0.5 * i, 0) + chance.vector(0.4), about = chance.vector(1);
    if (flat) at.z() = 0, about = Vector3::UnitZ();
    const Quaternion turned(Eigen::AngleAxisd(chance.between(0, 3), about.normalized()));
    bodies.push_back(world.body(any_solid(chance, flat), at, turned));
    world.set_material(bodies.back(), material);
  }
  Outcome out;
  for (int i = 0; i < 480; ++i) {
    const breve_pose pose = pose_of(machine, drive, i / 60.0, flat);
    world.must(breve_object_set_target(world.get(), moved, &pose));
    world.step();
    for (const breve_object body : bodies)
      if (world.at(body).y() > -0.5) out.fastest = std::max(out.fastest, world.velocity(body).norm());
    out.work = std::max(out.work, world.counters().work);
  }
  return out;
}

/// Bodies fall by 4 m at most, which gives them 9 m/s, and machines are as fast as 5 m/s.
/// @param most_work  units: some tenths of a second
void drive_many(breve_rung rung, std::uint32_t dimension, double most_speed, std::uint64_t most_work) {
  Outcome worst;
  for (const Machine machine : {Machine::Piston, Machine::Mixer, Machine::Press, Machine::Lift})
    for (std::uint32_t seed = 1; seed <= 15; ++seed) {
      const Outcome out = drive_one(machine, rung, dimension, seed);
      EXPECT_LE(out.fastest, most_speed) << "machine " << static_cast<int>(machine) << ", seed " << seed;
      EXPECT_LE(out.work, most_work) << "machine " << static_cast<int>(machine) << ", seed " << seed;
      worst.fastest = std::max(worst.fastest, out.fastest);
      worst.work = std::max(worst.work, out.work);
    }
  std::printf("  at most %.0f m/s, and %.1e units of work in a step\n", worst.fastest, static_cast<double>(worst.work));
}

TEST(Squeeze, WhatIsSqueezedIsNotThrownOnFast) { drive_many(BREVE_RUNG_FAST, 3, 60, 6'000'000); }
TEST(Squeeze, WhatIsSqueezedIsNotThrownOnBalanced) { drive_many(BREVE_RUNG_BALANCED, 3, 60, 6'000'000); }

/// Box2D's sweeps throw farther. The work of collisions is not counted, but that of the pieces that fast bodies need
/// is.
TEST(Squeeze, WhatIsSqueezedInAPlaneIsNotThrownFar) {
  for (const breve_rung rung : {BREVE_RUNG_FAST, BREVE_RUNG_BALANCED}) drive_many(rung, 2, 300, 4'000'000);
}

/// Giving way is not to be seen where nothing is squeezed: a lift carries a load of fifty times a box's mass on it.
TEST(Squeeze, ALiftCarriesWhatIsHeavy) {
  for (const breve_rung rung : {BREVE_RUNG_FAST, BREVE_RUNG_BALANCED, BREVE_RUNG_PRECISE}) {
    World world(1.0 / 60, rung);
    const breve_object lift = world.fixed(box(Vector3(2, 0.2, 2), 1), Vector3(0, 0.1, 0));
    const breve_object light = world.body(box(Vector3(0.4, 0.4, 0.4), 1), Vector3(0, 0.4, 0));
    const breve_object heavy = world.body(box(Vector3(0.8, 0.4, 0.8), 50), Vector3(0, 0.8, 0));
    for (const breve_object one : {lift, light, heavy}) world.set_material(one, 0.5, 0);
    for (int i = 0; i <= 240; ++i) {
      const breve_pose pose{{0, 0.1 + 1.0 * i / 60, 0}, {1, 0, 0, 0}};
      world.must(breve_object_set_target(world.get(), lift, &pose));
      world.step();
    }
    EXPECT_NEAR(world.at(light).y(), 4.4, 0.005) << rung;
    // On `fast` it pressed itself into the box as the lift set off.
    EXPECT_NEAR(world.at(heavy).y(), 4.8, rung == BREVE_RUNG_FAST ? 0.05 : 0.01) << rung;
    EXPECT_NEAR(world.velocity(heavy).y(), 1, 0.01) << rung;
  }
}

}  // namespace
}  // namespace breve::reference
