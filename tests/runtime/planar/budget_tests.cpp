// The budget of physics in a flat world.
#include <atomic>

#include "runtime/base/error.hpp"
#include "scene.hpp"

namespace breve::testing {
namespace {

struct FlatHeap : Flat {
  std::vector<ObjectId> all;
  explicit FlatHeap(Rung rung = Rung::Balanced, int count = 40) : Flat(rung) {
    fixed(Shape::box({1000, 1, 1}), 0, -0.5);
    for (int i = 0; i < count; ++i) all.push_back(ball(0.5, 1.01 * (i % 5), 0.5 + 1.01 * (i / 5)));
  }
  int finished() {
    int count = 0;
    for (const Intervention& one : physics().interventions())
      count += one.reason == GuardReason::Work && one.action == GuardAction::Finished;
    return count;
  }
};

TEST(PlanarBudget, OneThatIsNotReachedChangesNothing) {
  FlatHeap free, bounded;
  bounded.world.bound_physics({1'000'000'000, nullptr});
  for (int i = 0; i < 60; ++i) {
    free.world.step();
    bounded.world.step();
    ASSERT_EQ(bounded.finished(), 0);
    ASSERT_EQ(free.world.hash(), bounded.world.hash()) << i;
  }
}

TEST(PlanarBudget, WhereItIsUsedUpTheStepIsFinishedCoarselyAndTheGuardTells) {
  FlatHeap alone(Rung::Reference);
  std::uint64_t usual = 0;
  for (int i = 0; i < 60; ++i) {
    alone.world.step();
    usual = std::max(usual, alone.physics().counters().work);
  }
  FlatHeap heap(Rung::Reference);
  heap.world.bound_physics({usual / 20, nullptr});
  int finished = 0;
  for (int i = 0; i < 120; ++i) {
    heap.world.step();
    finished += heap.finished();
    EXPECT_LE(heap.finished(), 1);
    EXPECT_LE(heap.physics().counters().work, usual / 20 + 10'000);
    for (const ObjectId id : heap.all) ASSERT_LT(heap.bodies().location(heap.index(id)).norm(), 30);
  }
  EXPECT_GT(finished, 0);
}

TEST(PlanarBudget, IterationsAndStepsThatAreFarTooManyAreNotTaken) {
  FlatHeap heap;
  Accuracy accuracy = accuracy_of(Rung::Precise);
  accuracy.custom = true;
  accuracy.iterations = kMostIterations;
  accuracy.step = 1e-8;
  heap.physics().set_accuracy(accuracy);
  heap.world.bound_physics({200'000, nullptr});
  for (int i = 0; i < 10; ++i) {
    heap.world.step();
    EXPECT_EQ(heap.finished(), 1);
    EXPECT_LE(heap.physics().counters().work, 210'000U);
  }
}

TEST(PlanarBudget, WhereTheEndIsAskedForBodiesStay) {
  FlatHeap heap(Rung::Reference);
  std::atomic<bool> ended{true};
  heap.world.bound_physics({0, &ended});
  heap.world.step();
  EXPECT_EQ(heap.finished(), 1);
  EXPECT_EQ(heap.physics().counters().sub_steps, 0U);
  ended = false;
  heap.world.step();
  EXPECT_EQ(heap.finished(), 0);
}

TEST(PlanarBudget, IterationsHaveAMost) {
  FlatHeap heap;
  Accuracy accuracy = accuracy_of(Rung::Precise);
  accuracy.iterations = kMostIterations + 1;
  EXPECT_THROW(heap.physics().set_accuracy(accuracy), Error);
  EXPECT_THROW(heap.physics().set_fast_contacts(kMostIterations + 1), Error);
}

}  // namespace
}  // namespace breve::testing
