// Bodies without joints that rebound, rotate and slide, at random: nothing of that may make energy. Measured from poses
// and velocities, not by the ledger.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "thrown.hpp"

namespace breve::reference {
namespace {

/// A box dropped askew on a floor without friction: each impact makes it rotate, up to a radian in a step. Returns its
/// largest rise as a part of the height that it falls from.
double drop_askew(breve_rung rung, double rebound, double height) {
  World world(1.0 / 60, rung);
  const breve_object floor = world.fixed(box(Vector3(50, 2, 50), 1), Vector3(0, -1, 0));
  const Quaternion askew(Eigen::AngleAxisd(0.3, Vector3(1, 0.2, 0.7).normalized()));
  const breve_object body = world.body(box(Vector3(0.4, 0.4, 0.4), 1), Vector3(0, height, 0), askew);
  for (const breve_object one : {floor, body}) world.set_material(one, 0, rebound);
  Rise rise(world);
  world.run(10, [&] { rise.look(world); });
  return rise.most / (9.81 * height);
}

TEST(Rebounds, ABoxThatFallsAskewGainsNothing) {
  for (const breve_rung rung : {BREVE_RUNG_FAST, BREVE_RUNG_BALANCED})
    for (const double rebound : {0.5, 0.9, 0.97, 1.0})
      for (double height = 0.5; height < 8; height += 0.57)
        EXPECT_LE(drop_askew(rung, rebound, height), 1e-4) << rung << ": rebound " << rebound << " from " << height;
}

enum class Springs : bool { None, Some };

void tie(World& world, Chance& chance, breve_object from, breve_object to) {
  breve_spring spring = breve_spring_default();
  spring.from = from, spring.to = to;
  spring.length = chance.between(0.3, 1.5);
  spring.strength = std::exp(chance.between(1, 8));
  spring.damping = chance.one_in(2) ? 0 : std::exp(chance.between(-3, 2));
  breve_object made;
  world.must(breve_spring_create(world.get(), &spring, &made));
}

/// Up to five bodies that are thrown on a floor, or into a shaft with walls that may lean. Returns their largest rise
/// as a part of their energy at the start.
double throw_some(breve_rung rung, std::uint32_t dimension, Springs springs, std::uint32_t seed) {
  Chance chance{std::mt19937(seed)};
  const bool flat = dimension == 2;
  const auto in_space = [flat](const Vector3& v) { return flat ? Vector3(v.x(), v.y(), 0) : v; };
  const auto axis = [flat](const Vector3& v) { return flat ? Vector3::UnitZ() : Vector3(v.normalized()); };
  World world(1.0 / 60, rung, dimension);
  const double friction = chance.one_in(3) ? 0 : chance.between(0, 1.2);
  const double rebound = chance.one_in(4) ? 1 : chance.between(0, 1);
  const double tangential = chance.one_in(3) ? chance.between(-1, 1) : 0;
  const breve_material material{friction, friction, rebound, tangential, chance.one_in(2) ? 0.05 : 0};
  world.set_material(world.fixed(box(Vector3(50, 2, 50), 1), Vector3(0, -1, 0)), material);
  const bool shaft = chance.one_in(2);
  const Quaternion lean(Eigen::AngleAxisd(chance.one_in(2) ? 0.15 : 0, axis(Vector3(1, 0, 1))));
  for (int k = 0; shaft && k < (flat ? 2 : 4); ++k) {
    const double side = k % 2 == 0 ? -1.6 : 1.6;
    const Vector3 at = k < 2 ? Vector3(side, 5, 0) : Vector3(0, 5, side);
    world.set_material(world.fixed(box(k < 2 ? Vector3(1, 12, 4) : Vector3(4, 12, 1), 1), at, lean), material);
  }
  const int count = 1 + static_cast<int>(chance.random() % 5);
  breve_object last{};
  for (int i = 0; i < count; ++i) {
    const double z = chance.between(-0.4, 0.4),
                 x = chance.between(-0.4, 0.4);  // one after the other: the same everywhere
    const Vector3 at(x, 0.6 + 1.2 * i, z), about = axis(chance.vector(1));
    const Quaternion turned(Eigen::AngleAxisd(chance.between(0, 3), about));
    const breve_object body = world.body(any_solid(chance, flat), in_space(at), turned);
    world.set_material(body, material);
    world.set_velocity(body, in_space(chance.vector(3)));
    const Vector3 spin = chance.vector(9);
    if (chance.one_in(2)) world.set_spin(body, flat ? Vector3(0, 0, 3 * spin.z()) : spin);
    if (springs == Springs::Some && i > 0 && !chance.one_in(3)) tie(world, chance, last, body);
    last = body;
  }
  const double begin = world.mechanical();
  Rise rise(world);
  world.run(10, [&] { rise.look(world); });
  return rise.most / begin;
}

void throw_many(breve_rung rung, std::uint32_t dimension, double bound, Springs springs = Springs::None) {
  double worst = 0;
  for (std::uint32_t seed = 1; seed <= 150; ++seed) {
    const double gained = throw_some(rung, dimension, springs, seed);
    EXPECT_LE(gained, bound) << "seed " << seed;
    worst = std::max(worst, gained);
  }
  std::printf("  gained at most %.1e of the energy at the start\n", worst);
}

TEST(Rebounds, BodiesThatAreThrownGainNothingOnFast) { throw_many(BREVE_RUNG_FAST, 3, 5e-3); }
TEST(Rebounds, BodiesThatAreThrownGainNothingOnBalanced) { throw_many(BREVE_RUNG_BALANCED, 3, 1e-4); }

/// Springs gain and lose by their own error while they swing, most on `fast`.
TEST(Rebounds, BodiesOnSpringsThatAreThrownGainLittle) {
  throw_many(BREVE_RUNG_FAST, 3, 0.1, Springs::Some);
  throw_many(BREVE_RUNG_BALANCED, 3, 0.02, Springs::Some);
}

/// Bodies that meet in flight with a rebound of 1 are what is left.
TEST(Rebounds, BodiesThatAreThrownInAPlaneGainLittle) {
  throw_many(BREVE_RUNG_FAST, 2, 0.04);
  throw_many(BREVE_RUNG_BALANCED, 2, 0.015);
}

}  // namespace
}  // namespace breve::reference
