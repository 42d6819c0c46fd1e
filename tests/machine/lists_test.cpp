// Lists against std::deque, deep copies, sorting.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>

#include "tests/machine/fakes.hpp"

namespace breve::steve::testing {
namespace {

void expect_same(const ListCell& list, const std::deque<std::int32_t>& model) {
  ASSERT_EQ(list.size, model.size());
  for (std::uint32_t i = 0; i < list.size; ++i) ASSERT_EQ(list[i].i, model[i]);
}

TEST(Lists, RandomOperationsAgreeWithADeque) {
  std::mt19937 random(42);
  for (int trial = 0; trial < 50; ++trial) {
    World w;
    ListCell& list = *w.heap.list(static_cast<std::uint32_t>(trial % 5));
    std::deque<std::int32_t> model;
    const int growth = trial % 3;  // shrinking, steady and growing lists
    for (int step = 0; step < 2000; ++step) {
      const auto value = static_cast<std::int32_t>(random());
      const auto at = static_cast<std::uint32_t>(random() % (model.size() + 1));
      switch (random() % 8) {
        case 0:
          w.heap.push(list, number(value));
          model.push_back(value);
          break;
        case 1:
          w.heap.prepend(list, number(value));
          model.push_front(value);
          break;
        case 2:
          w.heap.insert(list, at, number(value));
          model.insert(model.begin() + at, value);
          break;
        case 3:
          if (growth == 2) w.heap.push(list, number(value)), model.push_back(value);
          break;
        case 4:
          if (model.empty()) break;
          EXPECT_EQ(w.heap.pop(list).i, model.back());
          model.pop_back();
          break;
        case 5:
          if (model.empty()) break;
          EXPECT_EQ(w.heap.unprepend(list).i, model.front());
          model.pop_front();
          break;
        case 6:
          if (at >= model.size() || growth == 2) break;
          EXPECT_EQ(w.heap.remove(list, at).i, model[at]);
          model.erase(model.begin() + at);
          break;
        default:
          if (growth != 0 || step % 50 != 0) break;
          w.heap.resize(list, at);
          model.resize(at);
      }
    }
    expect_same(list, model);
  }
}

TEST(Lists, QueueOfAMillionUsesBoundedMemory) {
  World w;
  ListCell& list = *w.heap.list();
  for (int i = 0; i < 100; ++i) w.heap.push(list, number(i));
  for (int i = 100; i < 1'000'000; ++i) {
    w.heap.push(list, number(i));
    ASSERT_EQ(w.heap.unprepend(list).i, i - 100);
  }
  for (int i = 0; i < 1'000'000; ++i) {
    w.heap.prepend(list, number(-i));
    w.heap.pop(list);
  }
  EXPECT_EQ(list.size, 100u);
  EXPECT_LE(list.capacity, 1024u);
}

TEST(Lists, PushingAnElementOfTheListItselfIsSafe) {
  World w;
  ListCell& list = *w.heap.list();
  w.heap.push(list, w.string("seed"));
  for (int i = 0; i < 100; ++i) {
    w.heap.push(list, list[0]);
    w.heap.prepend(list, list[list.size - 1]);
    w.heap.insert(list, list.size / 2, list[0]);
  }
  for (const Value& v : list) EXPECT_EQ(v.string()->view(), "seed");
  EXPECT_EQ(list[0].string()->count, 301u);
}

TEST(Lists, GrownElementsAreNull) {
  World w;
  ListCell& list = *w.heap.list();
  w.heap.push(list, number(1));
  w.heap.resize(list, 5);
  EXPECT_EQ(list[4].tag, Tag::Null);
  w.heap.resize(list, 1);
  EXPECT_EQ(list.size, 1u);
}

// The kinds of elements in any order: what a list gives back does not depend on how it stands in memory.
TEST(Lists, ElementsOfAnyTypeInAnyOrderAgreeWithADeque) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 60; ++trial) {
    World w;
    ListCell& list = *w.heap.list();
    std::deque<Value> model;
    const auto value = [&]() {
      switch (random() % (trial % 6 + 1)) {
        case 0: return number(static_cast<std::int32_t>(random()));
        case 1: return number(static_cast<double>(random()) * 0.5);
        case 2: return Value::of(Vector3(1, static_cast<double>(random() % 9), 3));
        case 3: return Value();
        case 4: return Value::of(Tag::List, nullptr);
        default: return Value::of(Tag::Object, nullptr);
      }
    };
    for (int step = 0; step < 400; ++step) {
      const auto at = static_cast<std::uint32_t>(random() % (model.size() + 1));
      const Value v = value();
      const bool some = at < model.size();
      switch (random() % 7) {
        case 0:
        case 1: w.heap.push(list, v), model.push_back(v); break;
        case 2: w.heap.prepend(list, v), model.push_front(v); break;
        case 3: w.heap.insert(list, at, v), model.insert(model.begin() + at, v); break;
        case 4:
          if (some) w.heap.set(list, at, v), model[at] = v;
          break;
        case 5:
          if (some) w.heap.remove(list, at), model.erase(model.begin() + at);
          break;
        default:
          if (step % 60 == 0) w.heap.resize(list, 0), model.clear();
      }
      ASSERT_EQ(list.size, model.size());
    }
    const ListCell& copy = *w.heap.copy(list);
    for (std::uint32_t i = 0; i < list.size; ++i) {
      const Value a = list[i], b = copy[i], c = model[i];
      ASSERT_EQ(a.tag, c.tag);
      ASSERT_EQ(b.tag, c.tag);
      for (int k = 0; k < 3; ++k) ASSERT_TRUE(a.bits[k] == c.bits[k] && b.bits[k] == c.bits[k]) << i;
    }
  }
}

TEST(Lists, AListOfNumbersTakesEightBytesAnElement) {
  World w;
  ListCell& list = *w.heap.list();
  const std::size_t before = w.memory.used;
  for (int i = 0; i < 1 << 16; ++i) w.heap.push(list, number(0.5 * i));
  EXPECT_LE(w.memory.used - before, (1U << 16) * 8U + 64U);
  w.heap.set(list, 5, w.string("five"));
  EXPECT_EQ(list[4].d, 2.0);
  EXPECT_EQ(list[5].string()->view(), "five");
  EXPECT_EQ(list[5].string()->count, 1u);
}

TEST(Lists, AListThatHasBecomeEmptyMayHoldAnotherTypeInPlace) {
  World w;
  ListCell& list = *w.heap.list();
  w.heap.push(list, number(1));
  w.heap.push(list, number(1.5));
  EXPECT_FALSE(list.narrow());
  w.heap.resize(list, 0);
  w.heap.push(list, w.string("text"));
  EXPECT_TRUE(list.narrow());
  w.heap.resize(list, 0);
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 0u);
}

TEST(Lists, CopyKeepsSharingAndCyclesAndSharesObjectsAndHashes) {
  World w;
  ListCell* a = w.heap.list();
  ListCell* shared = w.heap.list();
  HashCell* hash = w.heap.hash();
  w.heap.push(*shared, number(7));
  w.heap.push(*a, Value::of(Tag::List, shared));
  w.heap.push(*a, Value::of(Tag::List, shared));
  w.heap.push(*a, Value::of(Tag::List, a));
  w.heap.push(*a, Value::of(Tag::Hash, hash));
  w.heap.push(*a, Value::of(Tag::List, nullptr));
  ListCell* b = w.heap.copy(*a);
  ASSERT_EQ(b->size, 5u);
  EXPECT_NE((*b)[0].ref, shared);
  EXPECT_EQ((*b)[0].ref, (*b)[1].ref);
  EXPECT_EQ((*b)[2].ref, b);
  EXPECT_EQ((*b)[3].ref, hash);
  EXPECT_EQ((*b)[4].ref, nullptr);
  EXPECT_EQ((*(*b)[0].list())[0].i, 7);
}

TEST(Lists, CopyOfDeepNestingDoesNotRecurse) {
  World w;
  Value inner = w.list();
  for (int i = 0; i < 200'000; ++i) {
    Value outer = w.list();
    w.heap.push(*outer.list(), inner);
    inner = outer;
  }
  const ListCell* copy = w.heap.copy(*inner.list());
  int depth = 0;
  for (; copy->size == 1; copy = (*copy)[0].list()) ++depth;
  EXPECT_EQ(depth, 200'000);
}

TEST(MergeSort, SortsStablyLikeTheStandardLibrary) {
  World w;
  std::mt19937 random(3);
  for (const std::uint32_t n : {0U, 1U, 2U, 3U, 17U, 1000U}) {
    ListCell& list = *w.heap.list();
    std::vector<std::int32_t> model;
    for (std::uint32_t i = 0; i < n; ++i) {
      const auto value = static_cast<std::int32_t>(random() % 20 * 10000 + i);
      model.push_back(value);
      w.heap.push(list, number(value));
    }
    merge_sort(w.heap, list, [](const Value& a, const Value& b) { return a.i / 10000 < b.i / 10000; });
    std::stable_sort(model.begin(), model.end(), [](auto a, auto b) { return a / 10000 < b / 10000; });
    expect_same(list, {model.begin(), model.end()});
  }
}

TEST(MergeSort, ComparisonThatThrowsLeavesTheListAsItWas) {
  World w;
  ListCell& list = *w.heap.list();
  for (int i = 0; i < 10; ++i) w.heap.push(list, number(9 - i));
  int calls = 0;
  const auto before = [&](const Value& a, const Value& b) {
    if (++calls == 12) throw RunError(RunErrorKind::User, "stop");
    return a.i < b.i;
  };
  EXPECT_THROW(merge_sort(w.heap, list, before), RunError);
  expect_same(list, {9, 8, 7, 6, 5, 4, 3, 2, 1, 0});
}

TEST(MergeSort, ComparisonThatEmptiesTheListAndCollectsIsSafe) {
  World w;
  ListCell& list = *w.heap.list();
  w.roots.frames.push_back(&list);
  for (int i = 0; i < 50; ++i) w.heap.push(list, w.string("text" + std::to_string(99 - i)));
  merge_sort(w.heap, list, [&](const Value& a, const Value& b) {
    w.heap.resize(list, 0);
    w.heap.reclaim();
    return a.string()->view() < b.string()->view();
  });
  ASSERT_EQ(list.size, 50u);
  EXPECT_EQ(list[0].string()->view(), "text50");
  EXPECT_EQ(list[49].string()->view(), "text99");
  w.heap.resize(list, 0);
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 1u);
}

TEST(MergeSort, ComparisonThatMakesTheListWideIsSafe) {
  World w;
  ListCell& list = *w.heap.list();
  for (int i = 0; i < 20; ++i) w.heap.push(list, number(19 - i));
  merge_sort(w.heap, list, [&](const Value& a, const Value& b) {
    w.heap.set(list, 0, Value::of(Vector3(1, 2, 3)));
    return a.i < b.i;
  });
  for (std::uint32_t i = 0; i < 20; ++i) ASSERT_EQ(list[i].i, static_cast<std::int32_t>(i));
}

TEST(MergeSort, InconsistentComparisonEnds) {
  World w;
  std::mt19937 random(5);
  ListCell& list = *w.heap.list();
  for (int i = 0; i < 1000; ++i) w.heap.push(list, number(i));
  merge_sort(w.heap, list, [&](const Value&, const Value&) { return random() % 2 == 0; });
  std::vector<std::int32_t> found;
  for (const Value& v : list) found.push_back(v.i);
  std::sort(found.begin(), found.end());
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(found[static_cast<std::size_t>(i)], i);
}

}  // namespace
}  // namespace breve::steve::testing
