// Cycles: found within the promised number of iterations, in slices, in a defined order, and never a live cell.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "tests/machine/fakes.hpp"

namespace breve::steve::testing {
namespace {

TEST(Collector, ListThatHoldsItselfGoes) {
  World w;
  ListCell* list = w.heap.list();
  w.roots.frames.push_back(list);
  w.heap.push(*list, Value::of(Tag::List, list));
  w.heap.reclaim();
  w.roots.frames.clear();
  w.heap.end_of_iteration();
  w.heap.end_of_iteration();
  EXPECT_EQ(w.heap.live_cells(), 0u);
}

TEST(Collector, CycleThroughListHashAndInstanceGoes) {
  World w;
  const ClassInfo cls = reference_class(1);
  ListCell* list = w.heap.list();
  HashCell* hash = w.heap.hash();
  Instance* instance = w.auto_object(cls);
  w.heap.push(*list, Value::of(Tag::Hash, hash));
  w.heap.set(*hash, w.string("next"), Value::of(Tag::Object, instance));
  w.heap.store(instance->slots[0], list);
  for (std::uint64_t i = 0; i < bound(5); ++i) w.heap.end_of_iteration();
  EXPECT_EQ(w.heap.live_cells(), 0u);
  EXPECT_EQ(w.roots.destroyed.size(), 1u);
}

TEST(Collector, CycleHeldByALiveInstanceStaysAndGoesWhenItIsDropped) {
  World w;
  const ClassInfo cls = reference_class(1);
  Instance* owner = w.object(cls);
  ListCell* a = w.heap.list();
  ListCell* b = w.heap.list();
  w.heap.push(*a, Value::of(Tag::List, b));
  w.heap.push(*b, Value::of(Tag::List, a));
  w.heap.store(owner->slots[0], a);
  for (int i = 0; i < 10; ++i) w.heap.end_of_iteration();
  EXPECT_EQ(w.heap.live_cells(), 3u);
  w.heap.store(owner->slots[0], nullptr);
  for (std::uint64_t i = 0; i < bound(3); ++i) w.heap.end_of_iteration();
  EXPECT_EQ(w.heap.live_cells(), 1u);
}

TEST(Collector, CycleHeldByAPinnedRootStays) {
  World w;
  ListCell* list = w.heap.list();
  w.heap.push(*list, Value::of(Tag::List, list));
  w.heap.retain(list);
  w.roots.roots.push_back(list);
  for (int i = 0; i < 10; ++i) w.heap.end_of_iteration();
  EXPECT_EQ(w.heap.live_cells(), 1u);
}

TEST(Collector, CycleHeldByAFrameWhileACollectionRunsGoesAfterTheFrame) {
  World w;
  ListCell* list = w.heap.list();
  w.heap.push(*list, Value::of(Tag::List, list));
  w.roots.frames.push_back(list);
  for (int i = 0; i < 3; ++i) w.heap.end_of_iteration();
  EXPECT_EQ(w.heap.live_cells(), 1u);
  w.roots.frames.clear();
  for (std::uint64_t i = 0; i < bound(1); ++i) w.heap.end_of_iteration();
  EXPECT_EQ(w.heap.live_cells(), 0u);
}

TEST(Collector, DestroyInACycleRunsOnceInOrderOfCreation) {
  World w;
  const ClassInfo cls = reference_class(1);
  std::vector<Instance*> cycle;
  std::vector<std::uint64_t> made;
  for (int i = 0; i < 50; ++i) {
    cycle.push_back(w.auto_object(cls));
    made.push_back(cycle.back()->serial);
  }
  for (std::size_t i = 0; i < cycle.size(); ++i) w.heap.store(cycle[i]->slots[0], cycle[(i * 7 + 3) % cycle.size()]);
  for (std::uint64_t i = 0; i < bound(50); ++i) w.heap.end_of_iteration();
  EXPECT_EQ(w.roots.destroyed, made);
  EXPECT_EQ(w.heap.live_cells(), 0u);
}

TEST(Collector, WhatDestroyBringsBackIsNotTakenApart) {
  World w;
  const ClassInfo cls = reference_class(2);
  Instance* keeper = w.object(cls);
  Instance* dying = w.auto_object(cls);
  ListCell* list = w.heap.list();
  w.heap.push(*list, Value::of(Tag::Object, dying));
  w.heap.push(*list, w.string("kept"));
  w.heap.store(dying->slots[0], list);
  w.roots.on_destroy = [&](Instance& instance) { w.heap.store(keeper->slots[0], instance.slots[0].ref); };
  for (int i = 0; i < 10; ++i) w.heap.end_of_iteration();
  EXPECT_EQ(w.roots.destroyed.size(), 1u);
  ASSERT_EQ(list->size, 2u);
  EXPECT_EQ((*list)[1].string()->view(), "kept");
  EXPECT_FALSE((*list)[0].object()->live());
}

TEST(Collector, GarbageOfABigHeapGoesWithinTheBound) {
  World w;
  const ClassInfo cls = reference_class(2);
  Instance* owner = w.object(cls);
  // 300,000 live cells, and rings of lists that become garbage in the middle of a running collection.
  ListCell* live = w.heap.list();
  w.heap.store(owner->slots[0], live);
  for (int i = 0; i < 300'000; ++i) w.heap.push(*live, Value::of(Tag::List, w.heap.list(1)));
  ListCell* cycles = w.heap.list();
  w.heap.store(owner->slots[1], cycles);
  for (int i = 0; i < 50'000; ++i) {
    Value cycle = w.list();
    w.heap.push(*cycle.list(), cycle);
    w.heap.push(*cycles, cycle);
  }
  const std::uint64_t all = w.heap.live_cells();
  w.heap.end_of_iteration();
  w.heap.end_of_iteration();
  w.heap.store(owner->slots[1], nullptr);
  for (std::uint64_t i = 0; i < bound(all); ++i) w.heap.end_of_iteration();
  EXPECT_EQ(w.heap.live_cells(), 300'002u);
}

TEST(Collector, NothingIsMarkedWhenNothingCanHaveBecomeACycle) {
  class Watcher final : public RootSource {
   public:
    int visits = 0;
    void visit_frames(const std::function<void(Cell*)>&) override {}
    void visit_roots(const std::function<void(Cell*)>&) override { ++visits; }
    void free_unreachable(Instance&) override {}
  } watcher;
  FailingMemory memory;
  Heap heap(&memory, watcher);
  ListCell* flat = heap.list();
  heap.retain(flat);
  for (int i = 0; i < 100; ++i) {
    heap.push(*flat, number(i));
    heap.push(*flat, Value::of(Tag::String, heap.string("text")));
    heap.pop(*flat);
    heap.list(3);
    heap.end_of_iteration();
  }
  EXPECT_EQ(watcher.visits, 0);
}

// The oracle: reachability computed from scratch. Random changes between slices must never lose a reachable cell, and
// when the changes stop, exactly the reachable cells are left.
class RandomGraph {
 public:
  explicit RandomGraph(unsigned seed) : random_(seed) {
    for (int i = 0; i < 3; ++i) owners_.push_back(w_.object(cls_));
  }

  void change() {
    Container* from = pick();
    Container* to = below(3) == 0 ? make() : pick();
    switch (from->tag) {
      case Tag::Object:
        w_.heap.store(static_cast<Instance*>(from)->slots[below(3)], below(4) == 0 ? nullptr : to);
        break;
      case Tag::List: change_list(*static_cast<ListCell*>(from), Value::of(to->tag, to)); break;
      default: change_hash(*static_cast<HashCell*>(from), Value::of(to->tag, to)); break;
    }
  }
  void slice() { w_.heap.end_of_iteration(); }
  void check(bool exactly) {
    const auto reached = reachable();
    std::set<const Cell*> present(w_.heap.containers().begin(), w_.heap.containers().end());
    for (const Container* cell : reached) {
      ASSERT_TRUE(present.count(cell) != 0) << "a live cell was freed";
    }
    if (exactly) {
      ASSERT_EQ(present.size(), reached.size());
    }
  }

 private:
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }
  Container* make() {
    switch (below(3)) {
      case 0: return w_.heap.list(below(3));
      case 1: return w_.heap.hash();
      default: return w_.auto_object(cls_);
    }
  }
  std::vector<Container*> children(Container* cell) const {
    std::vector<Container*> found;
    const auto add = [&found](const Value& v) {
      if (v.is_reference() && v.ref != nullptr && is_container(v.tag)) found.push_back(static_cast<Container*>(v.ref));
    };
    if (cell->tag == Tag::Object)
      for (int i = 0; i < 3; ++i) add(Value::of(Tag::Object, static_cast<Instance*>(cell)->slots[i].ref));
    if (cell->tag == Tag::List)
      for (const Value& v : *static_cast<ListCell*>(cell)) add(v);
    if (cell->tag == Tag::Hash) {
      const auto* hash = static_cast<HashCell*>(cell);
      for (std::uint32_t i = 0; i < hash->used; ++i) add(hash->entries[i].value);
    }
    return found;
  }
  std::vector<Container*> reachable() const {
    std::vector<Container*> order(owners_.begin(), owners_.end());
    std::set<Container*> seen(order.begin(), order.end());
    for (std::size_t i = 0; i < order.size(); ++i)
      for (Container* child : children(order[i]))
        if (seen.insert(child).second) order.push_back(child);
    return order;
  }
  Container* pick() {  // a random walk from an owner, so that only what a script could reach is touched
    Container* cell = owners_[below(3)];
    for (std::uint32_t steps = below(12); steps > 0; --steps) {
      const auto next = children(cell);
      if (next.empty()) break;
      cell = next[below(static_cast<std::uint32_t>(next.size()))];
    }
    return cell;
  }
  void change_list(ListCell& list, const Value& v) {
    switch (below(7)) {
      case 0: w_.heap.push(list, v); break;
      case 1: w_.heap.prepend(list, v); break;
      case 2: w_.heap.insert(list, below(list.size + 1), v); break;
      case 3:
        if (list.size != 0) w_.heap.remove(list, below(list.size));
        break;
      case 4:
        if (list.size != 0) w_.heap.pop(list);
        break;
      case 5:
        if (list.size != 0) w_.heap.unprepend(list);
        break;
      default:
        if (list.size != 0) w_.heap.set(list, below(list.size), v);
        break;
    }
  }
  void change_hash(HashCell& hash, const Value& v) {
    Value removed;
    const Value key = number(static_cast<std::int32_t>(below(20)));
    if (below(3) == 0)
      w_.heap.remove(hash, key, removed);
    else
      w_.heap.set(hash, key, v);
  }

  std::mt19937 random_;
  World w_;
  ClassInfo cls_ = reference_class(3);
  std::vector<Instance*> owners_;
};

TEST(Collector, RandomGraphsKeepExactlyWhatIsReachable) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    RandomGraph graph(seed);
    for (int round = 0; round < 60; ++round) {
      for (int i = 0; i < 200; ++i) graph.change();
      graph.slice();
      graph.check(false);
      if (::testing::Test::HasFatalFailure()) return;
    }
    for (int i = 0; i < 6; ++i) graph.slice();
    graph.check(true);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

// The same with a heap so big that collections stretch over many slices: half-scanned lists, changed behind the mark.
TEST(Collector, ListsThatChangeWhileTheyAreScannedLoseNothing) {
  World w;
  const ClassInfo cls = reference_class(2);
  Instance* owner = w.object(cls);
  ListCell* big = w.heap.list();
  w.heap.store(owner->slots[0], big);
  std::vector<Value> elements;
  for (int i = 0; i < 200'000; ++i) {
    Value element = w.list();
    w.heap.push(*element.list(), number(i));
    w.heap.push(*big, element);
  }
  std::mt19937 random(7);
  std::int64_t sum = 0;
  for (int round = 0; round < 40; ++round) {
    Value cycle = w.list();
    w.heap.push(*cycle.list(), cycle);  // reason enough for a collection
    w.heap.end_of_iteration();
    for (int i = 0; i < 50; ++i) {
      const auto from = static_cast<std::uint32_t>(random() % big->size);
      const Value moved = w.heap.remove(*big, from);
      switch (random() % 4) {
        case 0: w.heap.push(*big, moved); break;
        case 1: w.heap.prepend(*big, moved); break;
        case 2: w.heap.insert(*big, static_cast<std::uint32_t>(random() % big->size), moved); break;
        default: {
          Value box = w.list();
          w.heap.push(*box.list(), number(-1));
          w.heap.push(*box.list(), moved);
          w.heap.prepend(*big, box);
          const Value inner = (*box.list())[1];
          w.heap.push(*big, inner);
          w.heap.unprepend(*big);
        }
      }
    }
  }
  ASSERT_EQ(big->size, 200'000u);
  for (const Value& v : *big) sum += (*v.list())[0].i;
  EXPECT_EQ(sum, std::int64_t{200'000} * 199'999 / 2);
}

// Objects that must be destroyed do not keep other garbage from being taken apart in the same collection.
TEST(Collector, CyclesOfListsGoThoughObjectsDieInEveryCollection) {
  World w;
  const ClassInfo cls = reference_class(1);
  std::uint64_t most = 0;
  for (int i = 0; i < 40; ++i) {
    Instance* a = w.auto_object(cls);
    Instance* b = w.auto_object(cls);
    w.heap.store(a->slots[0], b);
    w.heap.store(b->slots[0], a);
    Value cycle = w.list();
    w.heap.push(*cycle.list(), cycle);
    w.heap.end_of_iteration();
    most = std::max(most, w.heap.live_cells());
  }
  EXPECT_LE(most, 3u * bound(3));
}

TEST(Collector, WhatADyingObjectRefersToIsWholeWhenItsDestroyRuns) {
  World w;
  const ClassInfo cls = reference_class(2);
  Instance* a = w.auto_object(cls);
  Instance* b = w.auto_object(cls);
  Value cycle = w.list();
  w.heap.push(*cycle.list(), cycle);
  w.heap.push(*cycle.list(), number(7));
  w.heap.store(a->slots[0], b);
  w.heap.store(b->slots[0], a);
  w.heap.store(b->slots[1], cycle.ref);
  std::vector<std::uint32_t> sizes;
  w.roots.on_destroy = [&](Instance& instance) {
    if (&instance == b) sizes.push_back(static_cast<ListCell*>(instance.slots[1].ref)->size);
  };
  for (std::uint64_t i = 0; i < 2 * bound(3); ++i) w.heap.end_of_iteration();
  EXPECT_EQ(sizes, std::vector<std::uint32_t>{2});
  EXPECT_EQ(w.heap.live_cells(), 0u);
}

// By counted work: no iteration takes apart much more than a slice, however large one list is.
TEST(Collector, OneLargeCycleIsTakenApartInSlices) {
  World w;
  constexpr std::uint64_t kMany = 300'000;
  {
    Value cycle = w.list();
    for (std::uint64_t i = 0; i < kMany; ++i) w.heap.push(*cycle.list(), w.list());
    w.heap.push(*cycle.list(), cycle);
  }
  std::uint64_t before = w.heap.live_cells(), most = 0, iterations = 0;
  for (; w.heap.live_cells() > 0 && iterations <= bound(kMany); ++iterations) {
    w.heap.end_of_iteration();
    most = std::max(most, before - w.heap.live_cells());
    before = w.heap.live_cells();
  }
  EXPECT_LE(iterations, bound(kMany));
  EXPECT_LE(most, 60'000u);
}

// When there is no memory to note what is to be destroyed, something is destroyed all the same, and the host gets a
// report.
TEST(Collector, WithoutMemoryToNoteThemObjectsAreDestroyedLittleByLittle) {
  World w;
  const ClassInfo cls = reference_class(1);
  for (int i = 0; i < 4; ++i) w.auto_object(cls);
  w.heap.end_of_iteration();
  for (int i = 0; i < 1000; ++i) w.auto_object(cls);
  w.memory.fail_at = 0;
  EXPECT_THROW(w.heap.end_of_iteration(), std::bad_alloc);
  EXPECT_GT(w.roots.destroyed.size(), 4u);
  w.memory.fail_at = -1;
  w.heap.end_of_iteration();
  EXPECT_EQ(w.roots.destroyed.size(), 1004u);
  EXPECT_EQ(w.heap.live_cells(), 0u);
}

// --- snapshots -------------------------------------------------------------------------------------------------------

/// Copies a heap of lists and instances through its image, as a snapshot does, and returns the copy's owner.
Instance* restore(World& from, World& to, const ClassInfo& cls) {
  std::map<const Cell*, std::uint64_t> numbers;
  std::vector<Cell*> made;
  for (const Container* cell : from.heap.containers()) {
    numbers[cell] = made.size();
    if (cell->tag == Tag::List) {
      made.push_back(to.heap.list());
      static_cast<ListCell*>(made.back())->serial = static_cast<const ListCell*>(cell)->serial;
    } else {
      Instance* instance = to.heap.instance(cls);
      const auto* original = static_cast<const Instance*>(cell);
      instance->serial = original->serial;
      instance->state = original->state;
      instance->auto_free = original->auto_free;
      made.push_back(instance);
    }
  }
  const auto twin = [&](const Cell* cell) { return cell != nullptr ? made[numbers.at(cell)] : nullptr; };
  Instance* owner = nullptr;
  for (const Container* cell : from.heap.containers()) {
    if (cell->tag == Tag::List) {
      for (const Value& v : *static_cast<const ListCell*>(cell))
        to.heap.push(*static_cast<ListCell*>(twin(cell)), v.is_reference() ? Value::of(v.tag, twin(v.ref)) : v);
    } else {
      auto* instance = static_cast<Instance*>(twin(cell));
      const auto* original = static_cast<const Instance*>(cell);
      for (int i = 0; i < 2; ++i) to.heap.store(instance->slots[i], twin(original->slots[i].ref));
      if (original->auto_free || !original->live()) continue;
      to.heap.retain(instance);
      owner = instance;
    }
  }
  ByteWriter out;
  from.heap.save_state(out, [&](const Cell* cell) { return numbers.at(cell); });
  ByteReader in(out.bytes().data(), out.bytes().size());
  to.heap.load_state(in, [&](std::uint64_t n) {
    if (n >= made.size()) ByteReader::fail();
    return made[n];
  });
  return owner;
}

void live_on(World& w, Instance* owner, const ClassInfo& cls, unsigned seed) {
  std::mt19937 random(seed);
  auto* list = static_cast<ListCell*>(owner->slots[0].ref);
  for (int i = 0; i < 20; ++i) {
    Instance* a = w.auto_object(cls);
    ListCell* cycle = w.heap.list();
    w.heap.push(*cycle, Value::of(Tag::Object, a));
    w.heap.store(a->slots[0], cycle);
    const auto place = static_cast<std::uint32_t>(random() % (list->size + 1));
    w.heap.insert(*list, place, Value::of(Tag::List, cycle));
    w.heap.remove(*list, random() % 2 == 0 ? place : static_cast<std::uint32_t>(random() % list->size));
  }
  w.heap.end_of_iteration();
}

TEST(Collector, RestoredHeapDestroysTheSameObjectsInTheSameIterations) {
  const ClassInfo cls = reference_class(2);
  for (int cut = 0; cut < 6; ++cut) {
    World live;
    Instance* owner = live.object(cls);
    ListCell* list = live.heap.list();
    live.heap.store(owner->slots[0], list);
    for (int i = 0; i < 60'000; ++i) {  // two slices to mark
      const Value outer = live.list();
      live.heap.push(*outer.list(), live.list());
      live.heap.push(*list, outer);
    }
    for (int i = 0; i < cut; ++i) live_on(live, owner, cls, static_cast<unsigned>(i));
    live.roots.destroyed.clear();
    World restored;
    Instance* new_owner = restore(live, restored, cls);
    for (unsigned i = 0; i < 10; ++i) {
      live_on(live, owner, cls, 100 + i);
      live_on(restored, new_owner, cls, 100 + i);
      ASSERT_EQ(live.roots.destroyed, restored.roots.destroyed) << "cut " << cut << ", iteration " << i;
      ASSERT_EQ(live.heap.live_cells(), restored.heap.live_cells()) << "cut " << cut << ", iteration " << i;
    }
    EXPECT_FALSE(live.roots.destroyed.empty());
  }
}

TEST(Collector, DamagedStateIsRefused) {
  const ClassInfo cls = reference_class(2);
  World w;
  Instance* owner = w.object(cls);
  w.heap.store(owner->slots[0], w.heap.list());
  w.heap.end_of_iteration();
  ByteWriter out;
  w.heap.save_state(out, [](const Cell*) { return std::uint64_t{0}; });
  for (std::size_t size = 0; size < out.bytes().size(); ++size) {
    World other;
    ByteReader in(out.bytes().data(), size);
    EXPECT_THROW(other.heap.load_state(in, [](std::uint64_t) -> Cell* { ByteReader::fail(); }), Error);
  }
}

}  // namespace
}  // namespace breve::steve::testing
