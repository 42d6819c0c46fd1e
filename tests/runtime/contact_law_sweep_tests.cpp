// Sweeps: what momentum is worth, and a solve again with other biases.
#include <gtest/gtest.h>

#include "articulated_random.hpp"
#include "contact_law_scene.hpp"
#include "runtime/contact/pack.hpp"
#include "runtime/contact/sweep.hpp"

namespace breve::contact {
namespace {

using articulated::between;
using articulated::random_vector;

/// The remaining energy of a stack that sways after so many sweeps.
double left_in_motion(bool plain, bool momentum, int sweeps) {
  Scene scene;
  scene.stack(std::vector<double>(10, 1.0), 0.5);
  for (FreeBody& body : scene.bodies) {
    body.v[0] = 0.01 * body.position.z();
    body.v[4] = 0.01;
  }
  scene.pull({0, 0, -9.81}, 1.0 / 60);
  const double before = scene.kinetic();
  const double unit[] = {1, 0, 0, 0, 0, 0};
  ScalarRow idle;  // nothing can move it, but it takes the island out of the plain ones
  idle.a = 0;
  idle.ja = idle.ra = unit;
  if (!plain) scene.scalars.push_back(idle);
  pack(scene.movers(), scene.rows, scene.scalars, scene.work);
  {
    Sweeps series(scene.work, momentum);
    for (int i = 0; i < sweeps; ++i) series.next();
  }
  unpack(scene.work, scene.rows, scene.scalars);
  return scene.kinetic() / before;
}

TEST(Sweeps, WithMomentumAFewDoWhatManyDo) {
  for (const bool plain : {true, false}) {
    const double end = left_in_motion(plain, false, 3000);
    for (const int sweeps : {20, 40, 60})
      EXPECT_LE(left_in_motion(plain, true, sweeps) - end, 0.35 * (left_in_motion(plain, false, sweeps) - end));
    EXPECT_LE(left_in_motion(plain, true, 20), left_in_motion(plain, false, 60));
    EXPECT_NEAR(left_in_motion(plain, true, 3000), end, 1e-3);
  }
}

TEST(Sweeps, OfPlainPointsGiveWhatOthersGive) {
  for (const bool momentum : {false, true})
    for (const int sweeps : {1, 7, 50})
      EXPECT_NEAR(left_in_motion(true, momentum, sweeps), left_in_motion(false, momentum, sweeps), 1e-9);
}

/// Random boxes in a heap, and rows with random biases.
void heap(Scene& scene, Random& random, int boxes, int contacts) {
  for (int i = 0; i < boxes; ++i) {
    scene.add_box(between(random, 1, 10), random_vector(random, 1), Vector3::Ones());
    for (int k = 0; k < 6; ++k) scene.bodies.back().v[k] = between(random, -1, 1);
  }
  for (int i = 0; i < contacts; ++i) {
    const int a = static_cast<int>(random.below(static_cast<std::uint64_t>(boxes)));
    const Vector3 point = scene.bodies[static_cast<std::size_t>(a)].position + random_vector(random, 0.5);
    scene.touch(a, a - 1, point, Vector3::UnitZ(), 0.5).impulse = Vector3(0.1, 0, 0);
  }
}

TEST(SolveAgain, IsASolveFromRestWithoutFriction) {
  Random random(77);
  for (int i = 0; i < 300; ++i) {
    Scene scene, fresh;
    // Some have fewer rows than velocities, some have more.
    const int boxes = 1 + static_cast<int>(random.below(4)), contacts = 1 + static_cast<int>(random.below(12));
    heap(scene, random, boxes, contacts);
    scene.settings.direct = i % 2 == 0;
    fresh.bodies = scene.bodies;
    fresh.rows = scene.rows;
    fresh.settings = {5, i % 3 == 0, 1e-9};
    scene.solve();
    std::vector<Push> pushes;
    for (Row& row : fresh.rows) {
      row.static_friction = row.dynamic_friction = 0;
      row.impulse.setZero();
      row.bias = between(random, -0.1, 0.1);
      pushes.push_back({row.bias, 0, 0});
    }
    for (FreeBody& body : fresh.bodies) body.v.setZero();
    solve_island(fresh.movers(), fresh.rows, {}, fresh.settings, fresh.work);
    const SolveReport again = solve_again(pushes, {}, fresh.settings, scene.work);
    EXPECT_EQ(again.direct, fresh.settings.direct);
    for (int k = 0; k < boxes; ++k) {
      const auto at = static_cast<std::size_t>(k);
      EXPECT_LE((scene.bodies[at].v - fresh.bodies[at].v).norm(), 1e-9) << i;
    }
  }
}

}  // namespace
}  // namespace breve::contact
