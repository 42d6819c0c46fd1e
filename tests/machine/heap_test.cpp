// Counted cells: who lives, who goes, when, in which order, and what a failed allocation leaves behind.
#include <gtest/gtest.h>

#include "steve/machine/poison.hpp"
#include "tests/machine/fakes.hpp"

namespace breve::steve::testing {
namespace {

struct CountedPointer final : NativePointer {
  int& closed;
  explicit CountedPointer(int& c) : closed(c) {}
  ~CountedPointer() override { ++closed; }
};

TEST(Heap, TemporaryIsGoneAfterReclaim) {
  World w;
  w.heap.string("abc");
  w.heap.matrix(Matrix3::Identity());
  w.heap.list(3);
  w.heap.hash();
  w.heap.data("bytes");
  EXPECT_EQ(w.heap.live_cells(), 5u);
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 0u);
}

// Slots of freed cells stay with the heap, so the address sanitizer finds such a use only if the heap tells it.
TEST(HeapDeathTest, AddressSanitizerSeesAFreedCellRead) {
  if (!kPoisonIsSeen) GTEST_SKIP() << "built without AddressSanitizer";
  World w;
  // The first byte is the cell's own, the last one its contents'.
  const auto check = [&w](const auto* cell) {
    const auto* bytes = reinterpret_cast<const volatile unsigned char*>(cell);
    w.heap.reclaim();
    EXPECT_DEATH(static_cast<void>(bytes[0]), "use-after-poison");
    EXPECT_DEATH(static_cast<void>(bytes[sizeof *cell - 1]), "use-after-poison");
  };
  check(w.heap.string("abc"));
  check(w.heap.list(3));
  check(w.heap.matrix(Matrix3::Identity()));
}

TEST(Heap, EmptyStringIsTheNullReference) {
  World w;
  EXPECT_EQ(w.heap.string(""), nullptr);
  EXPECT_EQ(w.heap.concat("", ""), nullptr);
  EXPECT_EQ(view(w.heap.concat("ab", "cd")), "abcd");
  EXPECT_EQ(view(w.heap.concat("", "cd")), "cd");
}

TEST(Heap, StringsOfEverySizeKeepTheirBytes) {
  World w;
  for (std::size_t n = 1; n < 1200; ++n) {
    const std::string text(n, static_cast<char>('a' + n % 26));
    StringCell* cell = w.heap.string(text);
    EXPECT_EQ(cell->view(), text);
    EXPECT_EQ(cell->view().data()[n], '\0');
    if (n % 100 == 0) w.heap.reclaim();
  }
}

// Bytes that are asked for, all together: a text that is built up must not be copied each time.
TEST(Heap, AMillionAppendedBytesTakeMemoryLinearly) {
  World w;
  StringCell* text = nullptr;
  std::string model;
  w.roots.frames.push_back(nullptr);
  for (int i = 0; i < 1'000'000; ++i) {
    const char c = static_cast<char>('a' + i % 26);
    text = w.heap.append(text, {&c, 1});
    model += c;
    w.roots.frames[0] = text;
    if (w.heap.wants_reclaim()) w.heap.reclaim();
  }
  EXPECT_EQ(text->view(), model);
  EXPECT_LT(w.memory.used, 8'000'000u);
  EXPECT_LT(w.memory.given, 40'000'000u);
}

TEST(Heap, StringsThatShareABeginningStayAsTheyWere) {
  World w;
  StringCell* begin = w.heap.string(std::string(1000, 'x'));
  StringCell* one = w.heap.append(begin, "one");
  StringCell* two = w.heap.append(one, "two");
  StringCell* other = w.heap.append(one, "2nd");  // `one` is no longer the longest of its text
  StringCell* self = w.heap.append(two, two->view().substr(998, 6));
  EXPECT_EQ(one->view(), std::string(1000, 'x') + "one");
  EXPECT_EQ(two->view(), std::string(1000, 'x') + "onetwo");
  EXPECT_EQ(other->view(), std::string(1000, 'x') + "one2nd");
  EXPECT_EQ(self->view(), std::string(1000, 'x') + "onetwoxxonet");
  EXPECT_EQ(std::string(w.heap.terminated(one)), std::string(1000, 'x') + "one");
  EXPECT_EQ(std::string(w.heap.terminated(two)), std::string(1000, 'x') + "onetwo");
  EXPECT_EQ(self->view().substr(1000), "onetwoxxonet");
  EXPECT_EQ(std::string(w.heap.terminated(nullptr)), "");
  w.roots.frames.push_back(two);
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 1u);
  EXPECT_EQ(two->view(), std::string(1000, 'x') + "onetwo");
}

TEST(Heap, FrameKeepsACellWithoutCounting) {
  World w;
  StringCell* held = w.heap.string("held");
  w.heap.string("dropped");
  w.roots.frames.push_back(held);
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 1u);
  EXPECT_EQ(held->view(), "held");
  w.roots.frames.clear();
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 0u);
}

TEST(Heap, ElementLivesAsLongAsItsListAndGoesWithIt) {
  World w;
  ListCell* list = w.heap.list();
  w.roots.frames.push_back(list);
  w.heap.push(*list, w.string("element"));
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 2u);
  EXPECT_EQ((*list)[0].string()->count, 1u);
  w.roots.frames.clear();
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 0u);
}

TEST(Heap, FrameKeepsTheElementOfAListThatGoes) {
  World w;
  ListCell* list = w.heap.list();
  StringCell* element = w.heap.string("element");
  w.heap.push(*list, Value::of(Tag::String, element));
  w.roots.frames.push_back(element);
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 1u);
  EXPECT_EQ(element->view(), "element");
}

TEST(Heap, MillionNestedListsGoWithoutRecursion) {
  World w;
  Value inner = w.list();
  for (int i = 0; i < 1'000'000; ++i) {
    Value outer = w.list();
    w.heap.push(*outer.list(), inner);
    inner = outer;
  }
  w.roots.frames.push_back(inner.ref);
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 1'000'001u);
  w.roots.frames.clear();
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 0u);
}

TEST(Heap, ReclaimIsWantedWhenManyCellsWaitAndNotBefore) {
  World w;
  EXPECT_FALSE(w.heap.wants_reclaim());
  std::size_t made = 0;
  for (; !w.heap.wants_reclaim() && made < 1'000'000; ++made) w.heap.string("x");
  EXPECT_GT(made, 1000u);
  EXPECT_LT(made, 100'000u);
  w.heap.reclaim();
  EXPECT_FALSE(w.heap.wants_reclaim());
}

TEST(Heap, CellsHeldByFramesDoNotMakeEveryReclaimFutile) {
  World w;
  for (int i = 0; i < 100'000; ++i) w.roots.frames.push_back(w.heap.string("held"));
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 100'000u);
  EXPECT_FALSE(w.heap.wants_reclaim());
  for (int i = 0; i < 50'000; ++i) w.heap.string("x");
  EXPECT_FALSE(w.heap.wants_reclaim()) << "one reclaim for as many new cells as were kept";
}

TEST(Heap, PointerIsClosedWhenItGoesAndWhenTheHeapGoes) {
  int closed = 0;
  {
    World w;
    w.heap.pointer(std::make_unique<CountedPointer>(closed));
    w.heap.reclaim();
    EXPECT_EQ(closed, 1);
    w.heap.retain(w.heap.pointer(std::make_unique<CountedPointer>(closed)));
    w.heap.reclaim();
    EXPECT_EQ(closed, 1);
  }
  EXPECT_EQ(closed, 2);
}

TEST(Heap, HeapGivesBackEveryByteEvenOfWhatIsStillReferredTo) {
  FailingMemory memory;
  {
    FakeRoots roots;
    Heap heap(&memory, roots);
    roots.heap = &heap;
    const ClassInfo small = reference_class(2), large = reference_class(500);
    for (int i = 0; i < 1000; ++i) {
      ListCell* list = heap.list();
      heap.retain(list);
      heap.push(*list, Value::of(Tag::String, heap.string(std::string(static_cast<std::size_t>(1 + i), 'x'))));
      heap.push(*list, Value::of(Tag::Data, heap.data("data")));
      HashCell* hash = heap.hash();
      heap.set(*hash, number(i), Value::of(Tag::List, list));
      heap.push(*list, Value::of(Tag::Hash, hash));
      heap.retain(heap.instance(i % 2 == 0 ? small : large));
    }
    heap.reclaim();
    EXPECT_GT(memory.used, 0u);
  }
  EXPECT_EQ(memory.used, 0u);
}

TEST(Heap, MemoryOfDeadCellsIsUsedAgain) {
  World w;
  const ClassInfo cls = reference_class(4);
  for (int i = 0; i < 20'000; ++i) w.heap.list(4);
  w.heap.reclaim();
  const std::size_t used = w.memory.used;
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < 20'000; ++i) w.heap.list(4);
    w.heap.reclaim();
  }
  EXPECT_EQ(w.memory.used, used);
}

TEST(Heap, UnreachableAutoFreeInstancesAreDestroyedInOrderOfCreation) {
  World w;
  const ClassInfo cls = reference_class(1);
  std::vector<std::uint64_t> made;
  ListCell* list = w.heap.list();
  w.roots.frames.push_back(list);
  for (int i = 0; i < 100; ++i) {
    Instance* instance = w.auto_object(cls);
    made.push_back(instance->serial);
    w.heap.prepend(*list, Value::of(Tag::Object, instance));
  }
  w.heap.reclaim();
  EXPECT_TRUE(w.roots.destroyed.empty());
  w.roots.frames.clear();
  w.heap.end_of_iteration();
  EXPECT_EQ(w.roots.destroyed, made);
  EXPECT_EQ(w.heap.live_cells(), 0u);
}

TEST(Heap, ChainOfAutoFreeInstancesGoesInOneIteration) {
  World w;
  const ClassInfo cls = reference_class(1);
  Instance* next = nullptr;
  for (int i = 0; i < 100; ++i) {
    Instance* instance = w.auto_object(cls);
    w.heap.store(instance->slots[0], next);
    next = instance;
  }
  w.heap.end_of_iteration();
  EXPECT_EQ(w.roots.destroyed.size(), 100u);
  EXPECT_EQ(w.heap.live_cells(), 0u);
}

TEST(Heap, InstanceWithoutAutoFreeLivesUntilItIsFreedAndStaysAsAHuskWhileReferredTo) {
  World w;
  const ClassInfo cls = reference_class(1);
  Instance* instance = w.object(cls);
  ListCell* list = w.heap.list();
  w.heap.retain(list);
  w.heap.push(*list, Value::of(Tag::Object, instance));
  w.heap.end_of_iteration();
  EXPECT_EQ(w.heap.live_cells(), 2u);
  instance->state = Instance::State::Freed;
  w.heap.clear_slots(*instance);
  w.heap.release(instance);
  w.heap.end_of_iteration();
  EXPECT_EQ(w.heap.live_cells(), 2u) << "the list still refers to the husk";
  w.heap.pop(*list);
  w.heap.end_of_iteration();
  EXPECT_EQ(w.heap.live_cells(), 1u);
  EXPECT_TRUE(w.roots.destroyed.empty());
}

TEST(Heap, InstanceStoredAgainByAnEarlierDestroyLivesOn) {
  World w;
  const ClassInfo cls = reference_class(1);
  Instance* holder = w.object(cls);
  Instance* first = w.auto_object(cls);
  const std::uint64_t serial = first->serial;
  Instance* second = w.auto_object(cls);
  w.roots.on_destroy = [&](Instance& dying) {
    if (&dying == first) w.heap.store(holder->slots[0], second);
  };
  w.heap.end_of_iteration();
  EXPECT_EQ(w.roots.destroyed, std::vector<std::uint64_t>{serial});
  EXPECT_TRUE(second->live());
  EXPECT_EQ(holder->slots[0].ref, second);
  EXPECT_EQ(second->count, 1u);
}

TEST(Heap, DestroyMayReclaimAndMakeGarbage) {
  World w;
  const ClassInfo cls = reference_class(1);
  for (int i = 0; i < 10; ++i) w.auto_object(cls);
  int more = 5;
  w.roots.on_destroy = [&](Instance& dying) {
    w.roots.frames = {&dying};
    w.heap.string("garbage");
    if (more-- > 0) w.auto_object(cls);
    w.heap.reclaim();
    w.roots.frames.clear();
  };
  w.heap.end_of_iteration();
  EXPECT_EQ(w.roots.destroyed.size(), 15u);
  EXPECT_EQ(w.heap.live_cells(), 0u);
}

TEST(Heap, DestroyThatThrowsLosesNothing) {
  World w;
  const ClassInfo cls = reference_class(1);
  for (int i = 0; i < 3; ++i) w.auto_object(cls);
  bool thrown = false;
  w.roots.on_destroy = [&](Instance& dying) {
    if (thrown) return;
    thrown = true;
    dying.state = Instance::State::Freed;
    throw RunError(RunErrorKind::Budget, "cut");
  };
  EXPECT_THROW(w.heap.end_of_iteration(), RunError);
  w.heap.end_of_iteration();
  EXPECT_EQ(w.roots.destroyed.size(), 3u);
  EXPECT_EQ(w.heap.live_cells(), 0u);
}

TEST(Heap, ImmortalStringsAreNeitherCountedNorFreed) {
  World w;
  StringCell* literal = w.heap.string("literal");
  w.heap.retain(literal);
  literal->immortal = true;
  ListCell* list = w.heap.list();
  w.heap.push(*list, Value::of(Tag::String, literal));
  EXPECT_EQ(literal->count, 1u);
  w.heap.reclaim();
  EXPECT_EQ(literal->view(), "literal");
}

// Everything the heap can do, in a program that may be cut at any allocation.
void use_everything(Heap& heap, FakeRoots& roots, const ClassInfo& cls) {
  ListCell* list = heap.list();
  roots.frames.push_back(list);
  for (int i = 0; i < 40; ++i) {
    ListCell* inner = heap.list(static_cast<std::uint32_t>(i % 3));
    heap.push(*list, Value::of(Tag::List, inner));
    heap.push(*inner, Value::of(Tag::List, list));
    heap.prepend(*inner, Value::of(Tag::String, heap.string(std::string(static_cast<std::size_t>(i * 30), 'x'))));
    heap.insert(*inner, 1, Value::of(Tag::Matrix, heap.matrix(Matrix3::Identity())));
    HashCell* hash = heap.hash();
    heap.push(*inner, Value::of(Tag::Hash, hash));
    for (int k = 0; k < 20; ++k) heap.set(*hash, number(k), Value::of(Tag::String, heap.concat("a", "b")));
    heap.push(*inner, Value::of(Tag::List, heap.keys(*hash)));
    heap.push(*inner, Value::of(Tag::Data, heap.data("bytes")));
    Instance* instance = heap.instance(cls);
    instance->auto_free = true;
    heap.push(*inner, Value::of(Tag::Object, instance));
    heap.store(instance->slots[0], inner);
    heap.resize(*inner, 12);
    StringCell* text = heap.string(std::string(300, 'x'));
    for (int k = 0; k < 10; ++k) text = heap.append(text, "a little more");
    heap.push(*inner, Value::of(Tag::String, text));
  }
  heap.copy(*list);
  merge_sort(heap, *list, [](const Value& a, const Value& b) { return a.list()->serial > b.list()->serial; });
  roots.frames.clear();
  for (int i = 0; i < 4; ++i) heap.end_of_iteration();
}

TEST(Heap, FailedAllocationAnywhereLeavesAUsableHeapAndNoLeak) {
  const ClassInfo cls = reference_class(3);
  bool completed = false;
  for (long n = 0; !completed; ++n) {
    FailingMemory memory;
    {
      FakeRoots roots;
      Heap heap(&memory, roots);
      roots.heap = &heap;
      memory.fail_at = n;
      try {
        use_everything(heap, roots, cls);
        completed = memory.fail_at >= 0;
      } catch (const std::bad_alloc&) {
      }
      memory.fail_at = -1;
      roots.frames.clear();
      use_everything(heap, roots, cls);
      for (int i = 0; i < 6; ++i) heap.end_of_iteration();
      ASSERT_EQ(heap.live_cells(), 0u) << "allocation " << n << " failed";
    }
    ASSERT_EQ(memory.used, 0u) << "allocation " << n << " failed";
    ASSERT_LT(n, 5000);
  }
}

}  // namespace
}  // namespace breve::steve::testing
