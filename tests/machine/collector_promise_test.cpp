// How long the collector of the whole heap may take: the promise counts cells, whatever they refer to.
#include <gtest/gtest.h>

#include "tests/machine/fakes.hpp"

namespace breve::steve::testing {
namespace {

/// Rings that are too long to be judged by themselves, dropped while a collection runs.
void drop_long_cycle(World& w, int length = 12'000) {
  ListCell* first = w.heap.list();
  ListCell* last = first;
  for (int i = 1; i < length; ++i) {
    ListCell* next = w.heap.list();
    w.heap.push(*last, Value::of(Tag::List, next));
    last = next;
  }
  w.heap.push(*last, Value::of(Tag::List, first));
}
std::uint64_t iterations_until(World& w, std::uint64_t live, std::uint64_t most) {
  std::uint64_t iterations = 0;
  for (; w.heap.live_cells() > live && iterations <= most; ++iterations) w.heap.end_of_iteration();
  return iterations;
}

// The promise is by cells: references to few of them cost little.
TEST(CollectorsPromise, AMillionReferencesToAFewCellsDelayNothing) {
  World w;
  const ClassInfo cls = reference_class(1);
  Instance* owner = w.object(cls);
  ListCell* many = w.heap.list();
  w.heap.store(owner->slots[0], many);
  for (int i = 0; i < 1'000'000; ++i) w.heap.push(*many, Value::of(Tag::Object, owner));
  iterations_until(w, 0, 5);
  const std::uint64_t live = w.heap.live_cells();
  drop_long_cycle(w);
  w.heap.end_of_iteration();
  drop_long_cycle(w);
  const std::uint64_t most = bound(w.heap.live_cells());
  EXPECT_LE(iterations_until(w, live, most), most);
}

TEST(CollectorsPromise, CellsWithSixReferencesEachDelayNothing) {
  World w;
  const ClassInfo cls = reference_class(6);
  constexpr std::size_t kObjects = 200'000;
  std::vector<Instance*> objects;
  for (std::size_t i = 0; i < kObjects; ++i) objects.push_back(w.object(cls));
  for (std::size_t i = 0; i < kObjects; ++i) {
    for (std::size_t k = 0; k < 5; ++k)
      w.heap.store(objects[i]->slots[k], objects[(i * 7919 + k * 104'729) % kObjects]);
    ListCell* things = w.heap.list();
    w.heap.store(objects[i]->slots[5], things);
    for (std::size_t k = 0; k < 6; ++k) w.heap.push(*things, Value::of(Tag::Object, objects[(i * 31 + k) % kObjects]));
  }
  iterations_until(w, 0, 30);
  const std::uint64_t live = w.heap.live_cells();
  drop_long_cycle(w);
  w.heap.end_of_iteration();
  w.heap.end_of_iteration();
  drop_long_cycle(w);
  const std::uint64_t most = bound(w.heap.live_cells());
  EXPECT_LE(iterations_until(w, live, most), most);
}

// A cell skipped as a root must not be lost when it ceases to be one before its turn.
TEST(CollectorsPromise, AnObjectThatBecomesAutoFreeWhileACollectionRunsStays) {
  World w;
  const ClassInfo cls = reference_class(1);
  Instance* owner = w.object(cls);
  ListCell* list = w.heap.list();
  w.heap.store(owner->slots[0], list);
  for (int i = 0; i < 100'000; ++i) w.heap.push(*list, Value::of(Tag::List, w.heap.list()));
  std::vector<Instance*> late;
  for (int i = 0; i < 1000; ++i) {
    late.push_back(w.object(cls));
    w.heap.store(late.back()->slots[0], w.heap.list());
    w.heap.push(*list, Value::of(Tag::Object, late.back()));
  }
  for (std::size_t cut = 1; cut < 8; ++cut) {
    drop_long_cycle(w);
    for (std::size_t i = 0; i < cut; ++i) w.heap.end_of_iteration();
    for (std::size_t i = cut * 100; i < cut * 100 + 100; ++i) {
      late[i]->auto_free = true;
      w.heap.release(late[i]);
    }
    for (int i = 0; i < 12; ++i) w.heap.end_of_iteration();
    ASSERT_TRUE(w.roots.destroyed.empty()) << cut;
    for (Instance* instance : late) ASSERT_NE(instance->slots[0].ref, nullptr);
  }
  EXPECT_EQ(w.heap.live_cells(), 2u + 100'000 + 2 * 1000);
}

// The whole heap becomes garbage when a collection has just found it alive.
TEST(CollectorsPromise, ARingOfAllCellsGoesThoughACollectionHasBegun) {
  World w;
  const ClassInfo cls = reference_class(1);
  Instance* owner = w.object(cls);
  ListCell* first = w.heap.list();
  w.heap.store(owner->slots[0], first);
  ListCell* last = first;
  for (int i = 1; i < 300'000; ++i) {
    ListCell* next = w.heap.list();
    w.heap.push(*last, Value::of(Tag::List, next));
    last = next;
  }
  w.heap.push(*last, Value::of(Tag::List, first));
  iterations_until(w, 0, 40);
  drop_long_cycle(w);
  w.heap.end_of_iteration();
  w.heap.end_of_iteration();
  w.heap.store(owner->slots[0], nullptr);
  const std::uint64_t most = bound(w.heap.live_cells());
  EXPECT_LE(iterations_until(w, 1, most), most);
}

// A collection that is done early takes its garbage apart little by little, however it hangs together.
TEST(CollectorsPromise, ALongCycleIsFreedInParts) {
  World w;
  const ClassInfo cls = reference_class(1);
  for (int i = 0; i < 400'000; ++i) w.object(cls);
  iterations_until(w, 0, 30);
  const std::uint64_t live = w.heap.live_cells();
  drop_long_cycle(w, 20'000);
  const std::uint64_t promised = bound(w.heap.live_cells());
  std::uint64_t most = 0, iterations = 0;
  for (std::uint64_t before = w.heap.live_cells(); before > live && iterations <= promised; ++iterations) {
    w.heap.end_of_iteration();
    most = std::max(most, before - w.heap.live_cells());
    before = w.heap.live_cells();
  }
  EXPECT_LE(iterations, promised);
  EXPECT_LE(most, 8000u);
}

// They are left out of marking: they live and die by their counts.
TEST(CollectorsPromise, AnObjectThatCanReferToNothingGoesWithTheCycleThatHeldItAndNotBefore) {
  World w;
  const ClassInfo bare = reference_class(0);
  ListCell* kept = w.heap.list();
  w.heap.retain(kept);
  w.roots.roots.push_back(kept);
  w.heap.push(*kept, Value::of(Tag::Object, w.auto_object(bare)));
  Instance* doomed = w.auto_object(bare);
  const std::uint64_t serial = doomed->serial;
  ListCell* first = w.heap.list();
  ListCell* last = first;
  for (int i = 1; i < 30'000; ++i) {
    ListCell* next = w.heap.list();
    w.heap.push(*last, Value::of(Tag::List, next));
    last = next;
  }
  w.heap.push(*last, Value::of(Tag::Object, doomed));
  w.heap.push(*last, Value::of(Tag::List, first));
  const std::uint64_t most = bound(w.heap.live_cells());
  EXPECT_LE(iterations_until(w, 2, most), most);
  EXPECT_EQ(w.roots.destroyed, std::vector<std::uint64_t>{serial});
  for (int i = 0; i < 5; ++i) w.heap.end_of_iteration();
  EXPECT_EQ(w.heap.live_cells(), 2u);
}

// Cells that wait to be scanned change their places in the table when others die.
TEST(Collector, ListsThatMoveInTheTableWhileTheyWaitAreScanned) {
  constexpr int kLists = 80'000;
  World w;
  const ClassInfo cls = reference_class(3);
  Instance* owner = w.object(cls);
  ListCell* big = w.heap.list();
  ListCell* short_lived = w.heap.list();
  w.heap.store(owner->slots[0], big);
  w.heap.store(owner->slots[1], short_lived);
  const Value cycle = w.list();
  for (int i = 0; i < 30'000; ++i) {
    const Value link = w.list();
    w.heap.push(*link.list(), cycle);
    w.heap.push(*cycle.list(), link);
  }
  w.heap.store(owner->slots[2], cycle.ref);
  for (int i = 0; i < kLists; ++i) {
    if (i % 10 == 0) w.heap.push(*short_lived, w.list());
    const Value element = w.list(), inner = w.list();
    w.heap.push(*inner.list(), number(i));
    w.heap.push(*element.list(), inner);
    w.heap.prepend(*big, element);  // so that the last in the table wait longest
  }
  for (int i = 0; i < 30; ++i) w.heap.end_of_iteration();
  const std::uint64_t live = w.heap.live_cells();
  w.heap.store(owner->slots[2], nullptr);  // and a collection begins
  for (std::uint64_t i = 0; i < bound(live); ++i) {
    w.heap.end_of_iteration();
    for (int k = 0; k < 2000 && short_lived->size > 0; ++k) w.heap.pop(*short_lived);
    w.heap.reclaim();
  }
  for (int i = 0; i < kLists; ++i) {
    const Value element = (*big)[static_cast<std::uint32_t>(i)];
    ASSERT_EQ(element.list()->size, 1u) << i;
    ASSERT_EQ((*element.list())[0].list()->size, 1u) << i;
  }
}

}  // namespace
}  // namespace breve::steve::testing
