// Small cycles: judged at the end of the iteration in which they are left behind. One iteration has to do here, while
// the collector of the whole heap, which is held back by nothing in these small heaps, is recognised by the request
// for its roots.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/machine/fakes.hpp"

namespace breve::steve::testing {
namespace {

/// Counts how often the collector of the whole heap begins.
struct CountingRoots : FakeRoots {
  int collections = 0;
  void visit_roots(const std::function<void(Cell*)>& visit) override {
    ++collections;
    FakeRoots::visit_roots(visit);
  }
};

class Suspects : public ::testing::Test {
 protected:
  Suspects() { roots_.heap = &heap_; }
  // A frame holds what is being built, as a method would.
  template <class T>
  T* hold(T* cell) {
    roots_.frames.push_back(cell);
    return cell;
  }
  ListCell* list() { return hold(heap_.list()); }
  HashCell* hash() { return hold(heap_.hash()); }
  Instance* auto_object() {
    Instance* instance = hold(heap_.instance(cls_));
    instance->auto_free = true;
    return instance;
  }
  Instance* object() {
    Instance* instance = heap_.instance(cls_);
    heap_.retain(instance);
    return instance;
  }
  static Value value(Cell* cell) { return Value::of(cell->tag, cell); }
  void link(ListCell* from, Cell* to) { heap_.push(*from, value(to)); }
  void link(Instance* from, Cell* to, int slot = 0) { heap_.store(from->slots[slot], to); }
  void drop_frames() { roots_.frames.clear(); }
  void end() { heap_.end_of_iteration(); }
  /// A ring of lists, each in the one before.
  ListCell* cycle(int length) {
    ListCell* first = list();
    ListCell* last = first;
    for (int i = 1; i < length; ++i) {
      ListCell* next = list();
      link(last, next);
      last = next;
    }
    link(last, first);
    return first;
  }

  FailingMemory memory_;
  CountingRoots roots_;
  Heap heap_{&memory_, roots_};
  ClassInfo cls_ = reference_class(2);
};

TEST_F(Suspects, AListInItselfGoesInItsIterationWithoutACollection) {
  cycle(1);
  drop_frames();
  end();
  EXPECT_EQ(heap_.live_cells(), 0u);
  EXPECT_EQ(roots_.collections, 0);
}

TEST_F(Suspects, TwoListsInEachOtherGo) {
  cycle(2);
  drop_frames();
  end();
  EXPECT_EQ(heap_.live_cells(), 0u);
  EXPECT_EQ(roots_.collections, 0);
}

TEST_F(Suspects, AnObjectInItsOwnListGoesAndIsDestroyedOnce) {
  Instance* object = auto_object();
  ListCell* things = list();
  link(object, things);
  link(things, object);
  const std::uint64_t serial = object->serial;
  drop_frames();
  end();
  EXPECT_EQ(roots_.destroyed, std::vector<std::uint64_t>{serial});
  EXPECT_EQ(heap_.live_cells(), 0u);
  EXPECT_EQ(roots_.collections, 0);
}

TEST_F(Suspects, AHashThatIsItsOwnValueGoes) {
  HashCell* table = hash();
  heap_.set(*table, number(1), value(table));
  drop_frames();
  end();
  EXPECT_EQ(heap_.live_cells(), 0u);
  EXPECT_EQ(roots_.collections, 0);
}

TEST_F(Suspects, AHashWhoseKeyLeadsBackGoes) {
  HashCell* table = hash();
  Instance* key = auto_object();
  heap_.set(*table, value(key), number(1));
  link(key, table);
  drop_frames();
  end();
  EXPECT_EQ(roots_.destroyed.size(), 1u);
  EXPECT_EQ(heap_.live_cells(), 0u);
  EXPECT_EQ(roots_.collections, 0);
}

// The short look at new cells goes three levels down: longer rings, and such as close beyond it, must also be found.
TEST_F(Suspects, CyclesOfEveryLengthGo) {
  for (int length = 1; length <= 40; ++length) {
    cycle(length);
    drop_frames();
    end();
    ASSERT_EQ(heap_.live_cells(), 0u) << length;
  }
  EXPECT_EQ(roots_.collections, 0);
}

TEST_F(Suspects, CyclesClosedAfterTheirCellsWereLookedAtGo) {
  for (int length = 1; length <= 12; ++length) {
    ListCell* first = list();
    ListCell* last = first;
    for (int i = 1; i < length; ++i) {
      ListCell* next = list();
      link(last, next);
      last = next;
      heap_.reclaim();  // a safe point: what is in the table of waiting cells by now has been looked at
    }
    link(last, first);
    drop_frames();
    end();
    ASSERT_EQ(heap_.live_cells(), 0u) << length;
  }
}

TEST_F(Suspects, ARingBehindManyElementsGoes) {
  ListCell* big = list();
  for (int i = 0; i < 500; ++i) heap_.push(*big, Value::of(Tag::String, heap_.string("text")));
  link(big, big);
  drop_frames();
  end();
  EXPECT_EQ(heap_.live_cells(), 0u);
  EXPECT_EQ(roots_.collections, 0);
}

TEST_F(Suspects, NewTreesAreNotSuspected) {
  Instance* owner = object();
  for (int i = 0; i < 20'000; ++i) {
    ListCell* outer = heap_.list();
    ListCell* inner = heap_.list();
    link(inner, owner);
    link(outer, inner);
    link(owner, outer);
  }
  end();
  EXPECT_EQ(heap_.live_cells(), 3u);
  EXPECT_EQ(roots_.collections, 0);  // twenty thousand suspects would not have fitted into the table
}

// --- what must stay --------------------------------------------------------------------------------------------------

TEST_F(Suspects, ARingThatAFrameHoldsStaysAndGoesAfterTheFrame) {
  ListCell* first = cycle(3);
  for (int i = 0; i < 5; ++i) end();
  ASSERT_EQ(heap_.live_cells(), 3u);
  ASSERT_EQ(first->size, 1u);
  drop_frames();
  end();
  EXPECT_EQ(heap_.live_cells(), 0u);
}

TEST_F(Suspects, ARingHeldByAPlainObjectStaysUntilThatLetsItGo) {
  Instance* owner = object();
  link(owner, cycle(3));
  drop_frames();
  for (int i = 0; i < 5; ++i) end();
  ASSERT_EQ(heap_.live_cells(), 4u);
  link(owner, nullptr);
  end();
  EXPECT_EQ(heap_.live_cells(), 1u);
  EXPECT_EQ(roots_.collections, 0);
}

TEST_F(Suspects, ARingThroughAPlainObjectStays) {
  Instance* owner = object();
  ListCell* things = list();
  link(things, owner);
  link(owner, things);
  drop_frames();
  for (int i = 0; i < 5; ++i) end();
  EXPECT_EQ(heap_.live_cells(), 2u);
}

TEST_F(Suspects, WhatALivingCycleLeadsToStays) {
  Instance* owner = object();
  ListCell* alive = cycle(2);
  link(owner, alive);
  ListCell* dead = cycle(2);
  link(dead, alive);
  drop_frames();
  end();
  EXPECT_EQ(heap_.live_cells(), 3u);
  link(owner, nullptr);
  end();
  EXPECT_EQ(heap_.live_cells(), 1u);
}

TEST_F(Suspects, ASuspectThatIsFreedByHandBeforeItIsJudgedDoesNoHarm) {
  Instance* a = auto_object();
  Instance* b = auto_object();
  link(a, b);
  link(b, a);
  heap_.reclaim();
  drop_frames();
  roots_.free_unreachable(*a);  // as the script's free does: it loses its references and stays as a husk
  end();
  EXPECT_EQ(roots_.destroyed.size(), 2u);
  EXPECT_TRUE(std::adjacent_find(roots_.destroyed.begin(), roots_.destroyed.end()) == roots_.destroyed.end());
  EXPECT_EQ(heap_.live_cells(), 0u);
}

TEST_F(Suspects, ARingOfFiveThousandListsGoesInItsIterationWithoutACollection) {
  ListCell* first = cycle(5000);
  for (ListCell* list = first; heap_.push(*list, number(1)), (list = (*list)[0].list()) != first;) {
  }
  drop_frames();
  end();
  EXPECT_EQ(heap_.live_cells(), 0u);
  EXPECT_EQ(roots_.collections, 0);
}

// What the first suspect of a large living structure leads to is alive with it, and is not gathered again for each.
TEST_F(Suspects, ASmallCycleBesideALargeLivingOneGoesInTheSameIteration) {
  Instance* owner = object();
  link(owner, cycle(9000));
  drop_frames();
  cycle(2);
  drop_frames();
  end();
  EXPECT_EQ(heap_.live_cells(), 9001u);
  EXPECT_EQ(roots_.collections, 0);
}

// --- what does not fit -----------------------------------------------------------------------------------------------

TEST_F(Suspects, ARingThatLeadsTooFarIsLeftToTheCollector) {
  cycle(12'000);
  drop_frames();
  for (int i = 0; i < 3; ++i) end();
  EXPECT_EQ(heap_.live_cells(), 0u);
  EXPECT_GE(roots_.collections, 1);
}

TEST_F(Suspects, MoreCyclesThanTheTableHoldsGoAllTheSame) {
  constexpr int kCycles = 40'000;
  for (int i = 0; i < kCycles; ++i) cycle(1);
  drop_frames();
  for (int i = 0; i < 3; ++i) end();
  EXPECT_EQ(heap_.live_cells(), 0u);
  EXPECT_GE(roots_.collections, 1);
}

// Judging is bounded by counted work. The rest must not wait for its turn: the collector takes it.
TEST_F(Suspects, ARingBehindManyLivingSuspectsGoesWithinThePromisedIterations) {
  Instance* owner = object();
  ListCell* kept = list();
  link(owner, kept);
  constexpr int kSuspects = 200, kLength = 900;
  for (int i = 0; i < kSuspects; ++i) link(kept, cycle(kLength));
  drop_frames();
  for (int i = 0; i < 40; ++i) end();
  const std::uint64_t live = heap_.live_cells();
  ASSERT_EQ(live, 2u + kSuspects * kLength);
  const auto disturb = [&] {  // each living ring loses a reference and is suspected
    for (std::uint32_t i = 0; i < kept->size; ++i) {
      Cell* first = (*kept)[i].ref;
      heap_.retain(first);
      heap_.release(first);
    }
  };
  disturb();
  cycle(1);
  drop_frames();
  const std::uint64_t most = (live + 19'999) / 20'000 + 2;
  std::uint64_t iterations = 0;
  for (; heap_.live_cells() > live && iterations <= most; ++iterations) {
    end();
    disturb();
  }
  EXPECT_LE(iterations, most);
}

// --- destroy ---------------------------------------------------------------------------------------------------------

TEST_F(Suspects, DestroyRunsInOrderOfCreationHoweverTheyAreLinked) {
  std::vector<Instance*> made;
  std::vector<std::uint64_t> serials;
  for (int i = 0; i < 30; ++i) {
    made.push_back(auto_object());
    serials.push_back(made.back()->serial);
  }
  for (std::size_t i = 0; i < 30; ++i) link(made[i], made[(i * 7 + 3) % 30]);
  drop_frames();
  end();
  EXPECT_EQ(roots_.destroyed, serials);
  EXPECT_EQ(heap_.live_cells(), 0u);
}

TEST_F(Suspects, WhatDestroyStoresIsWholeAndStays) {
  Instance* keeper = object();
  Instance* dying = auto_object();
  ListCell* things = list();
  ListCell* more = list();
  link(things, dying);
  link(things, more);
  link(more, things);
  heap_.push(*more, number(7));
  link(dying, things);
  drop_frames();
  roots_.on_destroy = [&](Instance& instance) { link(keeper, instance.slots[0].ref); };
  for (int i = 0; i < 5; ++i) end();
  EXPECT_EQ(roots_.destroyed.size(), 1u);
  ASSERT_EQ(things->size, 2u);
  EXPECT_FALSE((*things)[0].object()->live());
  ASSERT_EQ(more->size, 2u);
  EXPECT_EQ((*more)[1].i, 7);
  link(keeper, nullptr);
  end();
  EXPECT_EQ(heap_.live_cells(), 1u);
}

TEST_F(Suspects, ACycleThatDestroyLeavesBehindGoesInTheNextIterationAtTheLatest) {
  Instance* dying = auto_object();
  link(dying, cycle(2));
  drop_frames();
  end();
  end();
  EXPECT_EQ(roots_.destroyed.size(), 1u);
  EXPECT_EQ(heap_.live_cells(), 0u);
}

// --- no memory -------------------------------------------------------------------------------------------------------

TEST_F(Suspects, WithoutMemoryToJudgeNothingChangesAndTheyAreJudgedLater) {
  Instance* owner = object();
  link(owner, cycle(2));
  cycle(2);
  drop_frames();
  heap_.reclaim();
  memory_.fail_at = 0;
  EXPECT_THROW(end(), std::bad_alloc);
  memory_.fail_at = -1;
  EXPECT_EQ(heap_.live_cells(), 5u);
  end();
  EXPECT_EQ(heap_.live_cells(), 3u);
  EXPECT_EQ(roots_.collections, 0);
}

// Every allocation fails once: what is garbage goes later, what is alive never.
TEST_F(Suspects, WhicheverAllocationFailsNothingIsLostAndAllGarbageGoes) {
  Instance* owner = object();
  for (long n = 0; n < 12; ++n) {
    ListCell* alive = cycle(3);
    link(owner, alive);
    Instance* a = auto_object();
    Instance* b = auto_object();
    link(a, b);
    link(b, a);
    link(b, alive, 1);
    drop_frames();
    roots_.destroyed.clear();
    memory_.fail_at = n;
    try {
      end();
    } catch (const std::bad_alloc&) {
    }
    memory_.fail_at = -1;
    for (int i = 0; i < 4; ++i) end();
    ASSERT_EQ(roots_.destroyed.size(), 2u) << n;
    ASSERT_EQ(heap_.live_cells(), 4u) << n;
    ASSERT_EQ(alive->size, 1u) << n;
  }
}

// --- snapshots -------------------------------------------------------------------------------------------------------

TEST_F(Suspects, ARestoredHeapJudgesTheSameSuspects) {
  Instance* owner = object();
  ListCell* alive = cycle(1);
  link(owner, alive);
  ListCell* dead = cycle(1);
  link(dead, alive);
  heap_.reclaim();  // both are suspected now
  drop_frames();

  std::vector<const Cell*> cells(heap_.containers().begin(), heap_.containers().end());
  const auto number_of = [&cells](const Cell* cell) {
    return static_cast<std::uint64_t>(std::find(cells.begin(), cells.end(), cell) - cells.begin());
  };
  ByteWriter out;
  heap_.save_state(out, number_of);

  World other;
  std::vector<Container*> twins;
  for (const Cell* cell : cells) {
    if (cell->tag == Tag::Object)
      twins.push_back(other.heap.instance(cls_));
    else
      twins.push_back(other.heap.list());
  }
  const auto twin = [&](const Cell* cell) { return twins[number_of(cell)]; };
  other.heap.retain(twin(owner));
  other.heap.store(static_cast<Instance*>(twin(owner))->slots[0], twin(alive));
  for (const ListCell* original : {alive, dead})
    for (const Value& v : *original) other.heap.push(static_cast<ListCell&>(*twin(original)), value(twin(v.ref)));
  ByteReader in(out.bytes().data(), out.bytes().size());
  other.heap.load_state(in, [&twins](std::uint64_t n) -> Cell* { return twins.at(n); });

  end();
  other.heap.end_of_iteration();
  EXPECT_EQ(heap_.live_cells(), 2u);
  EXPECT_EQ(other.heap.live_cells(), 2u);
}

}  // namespace
}  // namespace breve::steve::testing
