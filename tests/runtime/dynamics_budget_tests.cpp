// The budget of physics: what is counted, where a step ends when it is used up, and that nothing else changes.
#include <gtest/gtest.h>

#include <atomic>

#include "dynamics_scene.hpp"

namespace breve::testing {
namespace {

/// Balls and chains that fall on one another.
struct Heap : Physics {
  std::vector<ObjectId> bodies;

  explicit Heap(Rung rung = Rung::Balanced, int count = 30, int workers = 1) {
    mechanics().set_accuracy(rung);
    mechanics().set_workers(workers);
    body(2, Vector3(0, -2.5, 0), BodyKind::Stationary, Shape::box(Vector3(1000, 5, 1000)));
    for (int i = 0; i < count; ++i) {
      const Vector3 at(1.05 * (i % 3), 0.5 + 1.05 * (i / 9), 1.05 * (i / 3 % 3));
      bodies.push_back(i % 2 ? rigid(Shape::sphere(0.5), at) : rigid(Shape::box(Vector3(1, 1, 1)), at));
      if (i % 5 != 4) continue;
      JointDescription is;
      is.parent = index(bodies[bodies.size() - 2]);
      is.child = index(bodies.back());
      is.parent_point = Vector3(0, 0.6, 0);
      is.child_point = Vector3(0, -0.6, 0);
      mechanics().link(is, bodies.back());
    }
  }
  void check_finite() {
    for (const ObjectId id : bodies) EXPECT_TRUE(world.bodies().location(index(id)).allFinite());
  }
  int finished() {
    int count = 0;
    for (const Intervention& one : mechanics().interventions())
      count += one.reason == GuardReason::Work && one.action == GuardAction::Finished;
    return count;
  }
};

constexpr Rung kRungs[] = {Rung::Fast, Rung::Balanced, Rung::Precise, Rung::Reference, Rung::Conserving};

TEST(DynamicsBudget, OneThatIsNotReachedChangesNothing) {
  for (const Rung rung : kRungs) {
    Heap free(rung, 12), bounded(rung, 12);
    bounded.world.bound_physics({1'000'000'000, nullptr});
    for (int i = 0; i < 30; ++i) {
      free.world.step();
      bounded.world.step();
      ASSERT_EQ(bounded.finished(), 0);
      ASSERT_EQ(free.world.hash(), bounded.world.hash()) << name_of(rung) << ", iteration " << i;
      ASSERT_EQ(free.mechanics().counters().work, bounded.mechanics().counters().work);
      ASSERT_GT(free.mechanics().counters().work, 0U);
    }
  }
}

TEST(DynamicsBudget, WhereItIsUsedUpTheStepIsFinishedCoarselyAndTheGuardTells) {
  for (const Rung rung : kRungs) {
    Heap alone(rung, 16);
    std::uint64_t usual = 0;
    for (int i = 0; i < 20; ++i) {
      alone.world.step();
      usual = std::max(usual, alone.mechanics().counters().work);
    }
    Heap heap(rung, 16);
    const std::uint64_t bound = usual / 10;
    heap.world.bound_physics({bound, nullptr});
    int finished = 0;
    for (int i = 0; i < 50; ++i) {
      heap.world.step();
      finished += heap.finished();
      // Work that was begun is finished; then one look and one solution of few sweeps, however small the budget.
      constexpr std::uint64_t kLeast = 60'000;
      EXPECT_LE(heap.mechanics().counters().work, bound + bound / 10 + kLeast) << name_of(rung) << ", iteration " << i;
      heap.check_finite();
    }
    // A sub-step of `fast` is as coarse as there is.
    EXPECT_EQ(finished > 0, rung != Rung::Fast) << name_of(rung);
    // All of it still lies on the floor, and nothing flew off.
    for (const ObjectId id : heap.bodies) EXPECT_LT(heap.world.bodies().location(heap.index(id)).norm(), 20);
  }
}

TEST(DynamicsBudget, WhatIsCutDoesNotDependOnWorkers) {
  Heap one(Rung::Balanced, 60), two(Rung::Balanced, 60, 2);
  for (Heap* heap : {&one, &two}) heap->world.bound_physics({20'000, nullptr});
  int finished = 0;
  for (int i = 0; i < 60; ++i) {
    one.world.step();
    two.world.step();
    finished += one.finished();
    ASSERT_EQ(one.world.hash(), two.world.hash()) << i;
    ASSERT_EQ(one.finished(), two.finished());
  }
  EXPECT_GT(finished, 0);
}

TEST(DynamicsBudget, AnotherIslandsTroubleCostsNobodyItsAccuracy) {
  // A heap, and far from it a ball that falls: the ball's part of the budget is its own.
  Heap heap(Rung::Precise);
  const ObjectId ball = heap.rigid(Shape::sphere(0.5), Vector3(500, 100, 0));
  heap.world.bound_physics({50'000, nullptr});
  int finished = 0;
  for (int i = 0; i < 60; ++i) {
    heap.world.step();
    for (const Intervention& one : heap.mechanics().interventions()) {
      finished += one.reason == GuardReason::Work;
      EXPECT_NE(one.body, ball);
    }
  }
  EXPECT_GT(finished, 0);
  EXPECT_NEAR(heap.world.bodies().location(heap.index(ball)).y(), 100 - 0.5 * 9.81, 1e-9);
}

TEST(DynamicsBudget, StepsThatAreFarTooManyAreTakenAtOnce) {
  for (const bool world_step : {false, true}) {
    Physics s;
    const ObjectId ball = s.rigid(Shape::sphere(0.5), Vector3(0, 10, 0));
    Accuracy accuracy = accuracy_of(Rung::Precise);
    accuracy.custom = true;
    if (world_step)
      s.world.set_integration_step(1e-9);
    else
      accuracy.step = 1e-11;
    s.mechanics().set_accuracy(accuracy);
    s.world.bound_physics({1'000'000, nullptr});
    s.run(0.5);
    EXPECT_NEAR(s.world.bodies().location(s.index(ball)).y(), 10 - 0.5 * 9.81 * 0.25, 1e-2);
    EXPECT_LE(s.mechanics().counters().work, 1'100'000U);
  }
}

TEST(DynamicsBudget, ALinkWithoutInertiaOnASpringIsToldAndNotFollowed) {
  for (const Rung rung : {Rung::Balanced, Rung::Precise, Rung::Reference}) {
    Physics s;
    s.mechanics().set_accuracy(rung);
    const ObjectId rod = s.rigid(Shape::box(Vector3(1, 0.2, 0.2)), Vector3::Zero());
    const ObjectId speck =
        s.rigid(solid(1e-3, 1e-12 * Matrix3::Identity(), Vector3(0.3, 0.2, 0.2)), Vector3(0.65, 0, 0));
    JointDescription is;
    is.kind = JointKind::Ball;
    is.parent = s.index(rod);
    is.child = s.index(speck);
    is.parent_point = Vector3(0.5, 0, 0);
    is.child_point = Vector3(-0.15, 0, 0);
    const JointIndex joint = s.mechanics().link(is, speck);
    JointDrive drive;
    drive.stiffness = 1;
    drive.damping = 0.01;
    s.mechanics().set_drive(joint, drive);
    s.world.bodies().set_rotational_velocity(s.index(rod), Vector3(1, 2, 3));
    int told = 0;
    for (int i = 0; i < 10; ++i) {
      s.world.step();
      EXPECT_LE(s.mechanics().counters().evaluations, rung == Rung::Balanced ? 100'000U : 700'000U);
      for (const Intervention& one : s.mechanics().interventions()) {
        if (one.reason != GuardReason::FastMotion) continue;
        ++told;
        EXPECT_EQ(one.body, speck);
        EXPECT_EQ(one.action, GuardAction::Finished);
        EXPECT_NEAR(one.value, 1e10, 1e8);  // 1/s: the damper's, 0.01 / 1e-12
      }
    }
    EXPECT_GT(told, 0) << name_of(rung);
    EXPECT_LT(s.at(speck).norm(), 10);
  }
}

TEST(DynamicsBudget, WhereTheEndIsAskedForTheStepThrowsAndBodiesStay) {
  for (const Rung rung : kRungs) {
    Heap heap(rung);
    std::atomic<bool> ended{true};
    heap.world.bound_physics({0, &ended});
    try {
      heap.world.step();
      ADD_FAILURE() << name_of(rung) << ": the step goes on";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Interrupted) << name_of(rung);
    }
    EXPECT_LT(heap.mechanics().counters().work, 1'000U) << name_of(rung);
    EXPECT_EQ(heap.mechanics().counters().sub_steps, 0U) << name_of(rung);
    ended = false;
    heap.world.step();
    EXPECT_EQ(heap.finished(), 0) << name_of(rung);
    heap.check_finite();
  }
}

}  // namespace
}  // namespace breve::testing
