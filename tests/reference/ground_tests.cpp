// Bodies at random on ground that is made of triangles: meshes that are plane, hilly or hollow, and height fields.
#include <gtest/gtest.h>

#include <cstdio>
#include <vector>

#include "thrown.hpp"

namespace breve::reference {
namespace {

enum class Ground : std::uint8_t { Plane, Hills, Field, Bowl };

constexpr std::uint32_t kPoints = 41;  // along an edge

/// Heights of ground, row by row.
struct Relief {
  double cell;                  // m
  std::vector<double> heights;  // m

  double middle() const { return 0.5 * cell * (kPoints - 1); }
};

Relief relief_of(Ground ground, Chance& chance) {
  Relief relief{chance.between(0.3, 1.2), {}};
  const double high = chance.between(0.05, 0.4), wide = chance.between(0.3, 2);
  const double rough = chance.between(0, 0.1), often = chance.between(2, 5);
  const auto height = [&](double x, double z) {
    switch (ground) {
      case Ground::Plane: return 0.0;
      case Ground::Bowl: return 0.08 * (x * x + z * z);
      default: break;
    }
    return high * std::sin(wide * x + 0.3) * std::cos(wide * z) + rough * std::sin(often * x) * std::sin(often * z + 1);
  };
  for (std::uint32_t row = 0; row < kPoints; ++row)
    for (std::uint32_t column = 0; column < kPoints; ++column)
      relief.heights.push_back(height(column * relief.cell - relief.middle(), row * relief.cell - relief.middle()));
  return relief;
}

Solid field_of(const Relief& relief) {
  Solid solid;
  solid.geometry.kind = BREVE_SHAPE_HEIGHT_FIELD;
  solid.geometry.heights = relief.heights.data();
  solid.geometry.columns = solid.geometry.rows = kPoints;
  solid.geometry.tile = relief.cell;
  return solid;
}

Solid mesh_of(const Relief& relief) {
  Solid solid;
  solid.geometry.kind = BREVE_SHAPE_MESH;
  for (std::uint32_t i = 0; i < kPoints * kPoints; ++i) {
    solid.corners.push_back(i % kPoints * relief.cell - relief.middle());
    solid.corners.push_back(relief.heights[i]);
    solid.corners.push_back(i / kPoints * relief.cell - relief.middle());
  }
  for (std::uint32_t i = 0; i + kPoints < kPoints * kPoints; ++i) {
    if (i % kPoints == kPoints - 1) continue;
    for (const std::uint32_t corner : {i, i + kPoints, i + 1, i + 1, i + kPoints, i + kPoints + 1})
      solid.indices.push_back(corner);
    solid.sizes.insert(solid.sizes.end(), {3, 3});
  }
  return solid;
}

/// Its inertia is that of a ball.
Solid octahedron(Chance& chance) {
  Solid solid;
  solid.geometry.kind = chance.one_in(2) ? BREVE_SHAPE_CONVEX : BREVE_SHAPE_MESH;
  const double reach = 0.6 * chance.between(0.15, 0.5);
  solid.corners = {reach, 0, 0, -reach, 0, 0, 0, reach, 0, 0, -reach, 0, 0, 0, reach, 0, 0, -reach};
  solid.indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  solid.sizes.assign(8, 3);
  solid.mass = std::exp(chance.between(-1.5, 1.5));
  return solid;
}

/// What came of some bodies that were thrown on ground.
struct Outcome {
  double gained = 0;                // the largest rise of energy, as a part of what they lost
  double lowest = 0;                // m, the height of what is lowest
  std::uint64_t impacts = 0;        // in the iteration that had the most
  std::uint64_t interventions = 0;  // of the guard
};

/// Up to six bodies, until one leaves the ground.
Outcome throw_on(Ground ground, breve_rung rung, std::uint32_t seed) {
  Chance chance{std::mt19937(seed)};
  World world(1.0 / 60, rung);
  const double friction = chance.one_in(3) ? 0 : chance.between(0, 1.2);
  const double rebound = chance.one_in(4) ? 1 : chance.one_in(3) ? 0 : chance.between(0, 1);
  const double tangential = chance.one_in(3) ? chance.between(-1, 1) : 0;
  const breve_material material{friction, friction, rebound, tangential, chance.one_in(2) ? 0.05 : 0};
  const Relief relief = relief_of(ground, chance);
  const Solid solid = ground == Ground::Field ? field_of(relief) : mesh_of(relief);
  world.set_material(world.fixed(solid, Vector3::Zero()), material);
  std::vector<breve_object> bodies;
  const int count = 1 + static_cast<int>(chance.random() % 6);
  for (int i = 0; i < count; ++i) {
    const Solid shape = chance.one_in(3) ? octahedron(chance) : any_solid(chance, false);
    const Vector3 about = chance.vector(1), at = Vector3(0, 1 + 0.8 * i, 0) + chance.vector(0.5);
    const Quaternion turned(Eigen::AngleAxisd(chance.between(0, 3), about.normalized()));
    bodies.push_back(world.body(shape, at, turned));
    world.set_material(bodies.back(), material);
    world.set_velocity(bodies.back(), chance.vector(3));
    if (chance.one_in(2)) world.set_spin(bodies.back(), chance.vector(9));
  }
  Outcome out;
  Rise rise(world);
  const double begin = world.mechanical();
  bool inside = true;
  const auto look = [&] {
    for (const breve_object body : bodies) {
      const Vector3 at = world.at(body);
      inside = inside && std::max(std::abs(at.x()), std::abs(at.z())) < relief.middle() - 1;
      if (inside) out.lowest = std::min(out.lowest, at.y());
    }
    if (inside) rise.look(world);
    out.impacts = std::max(out.impacts, world.counters().impacts);
  };
  for (int i = 0; i < 600 && inside; ++i) world.run(1.0 / 60, look);
  constexpr double kSome = 0.1;  // J: with a rebound of 1 nothing is lost
  out.gained = rise.most / std::max(begin - rise.low, kSome);
  out.interventions = world.toll().interventions;
  return out;
}

constexpr Ground kAll[] = {Ground::Plane, Ground::Hills, Ground::Field, Ground::Bowl};

/// Contact points of triangles in one patch have one normal, so where the nearest points meet they may part. A step
/// looked for the same impact a hundred times then, which took seconds where the bodies were cylinders.
void throw_many(breve_rung rung, std::uint64_t most_impacts, double bound) {
  Outcome worst;
  for (const Ground ground : kAll)
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
      const Outcome out = throw_on(ground, rung, seed);
      EXPECT_LE(out.gained, bound) << "seed " << seed;
      EXPECT_LE(out.impacts, most_impacts) << "seed " << seed;
      EXPECT_EQ(out.interventions, 0U) << "seed " << seed;
      worst.gained = std::max(worst.gained, out.gained);
      worst.impacts = std::max(worst.impacts, out.impacts);
    }
  std::printf("  gained at most %.1e of what was lost; at most %d impacts in a step\n", worst.gained,
              static_cast<int>(worst.impacts));
}

TEST(Ground, BodiesThatAreThrownGainNothingOnFast) { throw_many(BREVE_RUNG_FAST, 0, 1e-3); }
TEST(Ground, BodiesThatAreThrownMeetItSeldomOnBalanced) { throw_many(BREVE_RUNG_BALANCED, 50, 1e-4); }

/// A surface has two sides: what once is below it stays there.
TEST(Ground, NothingFallsThroughASurface) {
  for (const breve_rung rung : {BREVE_RUNG_FAST, BREVE_RUNG_BALANCED})
    for (std::uint32_t seed = 1; seed <= 100; ++seed)
      EXPECT_GE(throw_on(Ground::Plane, rung, seed).lowest, 0) << rung << ": seed " << seed;
}

}  // namespace
}  // namespace breve::reference
