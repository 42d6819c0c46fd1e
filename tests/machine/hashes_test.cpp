// Hashes against std::map, keys of every type, order of insertion.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "steve/machine/operators.hpp"
#include "tests/machine/fakes.hpp"

namespace breve::steve::testing {
namespace {

TEST(Hashes, RandomOperationsAgreeWithAMapAndKeepTheOrderOfInsertion) {
  std::mt19937 random(11);
  for (const std::uint32_t range : {10U, 300U, 5000U}) {
    World w;
    HashCell& hash = *w.heap.hash();
    std::map<std::int32_t, std::int32_t> model;
    std::vector<std::int32_t> order;
    for (int step = 0; step < 20'000; ++step) {
      const auto key = static_cast<std::int32_t>(random() % range);
      if (random() % 3 != 0) {
        if (!model.count(key)) order.push_back(key);
        model[key] = step;
        w.heap.set(hash, number(key), number(step));
      } else {
        Value removed;
        ASSERT_EQ(w.heap.remove(hash, number(key), removed), model.erase(key) == 1);
        std::erase(order, key);
      }
      const auto probe = static_cast<std::int32_t>(random() % range);
      const Value* found = w.heap.find(hash, number(probe));
      ASSERT_EQ(found != nullptr, model.count(probe) == 1);
      if (found != nullptr) {
        ASSERT_EQ(found->i, model[probe]);
      }
    }
    const ListCell& keys = *w.heap.keys(hash);
    ASSERT_EQ(keys.size, order.size());
    for (std::uint32_t i = 0; i < keys.size; ++i) ASSERT_EQ(keys[i].i, order[i]);
  }
}

TEST(Hashes, KeysCompareWithTheirType) {
  World w;
  HashCell& hash = *w.heap.hash();
  w.heap.set(hash, number(1), number(10));
  w.heap.set(hash, number(1.0), number(20));
  w.heap.set(hash, w.string("1"), number(30));
  EXPECT_EQ(hash.count_live, 3u);
  EXPECT_EQ(w.heap.find(hash, number(1))->i, 10);
  EXPECT_EQ(w.heap.find(hash, number(1.0))->i, 20);
  EXPECT_EQ(w.heap.find(hash, w.string("1"))->i, 30);
}

TEST(Hashes, NumbersVectorsMatricesAndStringsAreKeysByValue) {
  World w;
  HashCell& hash = *w.heap.hash();
  const auto matrix = [&w](double x) { return Value::of(Tag::Matrix, w.heap.matrix(Matrix3::Constant(x))); };
  w.heap.set(hash, Value::of(Vector3(1, 2, 3)), number(1));
  w.heap.set(hash, matrix(2), number(2));
  w.heap.set(hash, w.string("text"), number(3));
  w.heap.set(hash, Value(), number(4));
  w.heap.set(hash, w.string(""), number(5));
  EXPECT_EQ(w.heap.find(hash, Value::of(Vector3(1, 2, 3)))->i, 1);
  EXPECT_EQ(w.heap.find(hash, matrix(2))->i, 2);
  EXPECT_EQ(w.heap.find(hash, matrix(3)), nullptr);
  EXPECT_EQ(w.heap.find(hash, w.string("text"))->i, 3);
  EXPECT_EQ(w.heap.find(hash, Value())->i, 4);
  EXPECT_EQ(w.heap.find(hash, w.string(""))->i, 5);
}

TEST(Hashes, NotANumberIsAKeyAndZeroHasOneSign) {
  World w;
  HashCell& hash = *w.heap.hash();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  w.heap.set(hash, number(nan), number(1));
  w.heap.set(hash, number(nan), number(2));
  w.heap.set(hash, number(0.0), number(3));
  w.heap.set(hash, number(-0.0), number(4));
  EXPECT_EQ(hash.count_live, 2u);
  EXPECT_EQ(w.heap.find(hash, number(nan))->i, 2);
  EXPECT_EQ(w.heap.find(hash, number(0.0))->i, 4);
}

TEST(Hashes, ListsAndObjectsAreKeysByIdentity) {
  World w;
  const ClassInfo cls = reference_class(1);
  HashCell& hash = *w.heap.hash();
  const Value a = w.list(), b = w.list();
  const Value x = Value::of(Tag::Object, w.object(cls)), none = Value::of(Tag::Object, nullptr);
  w.heap.set(hash, a, number(1));
  w.heap.set(hash, x, number(2));
  w.heap.set(hash, none, number(3));
  w.heap.set(hash, Value::of(Tag::Pointer, nullptr), number(4));
  EXPECT_EQ(w.heap.find(hash, a)->i, 1);
  EXPECT_EQ(w.heap.find(hash, b), nullptr);
  EXPECT_EQ(w.heap.find(hash, x)->i, 2);
  EXPECT_EQ(w.heap.find(hash, none)->i, 3);
  w.heap.push(*a.list(), number(1));
  EXPECT_EQ(w.heap.find(hash, a)->i, 1) << "the key is the list, not what it holds";
}

TEST(Hashes, HashesOfKeysNeedNoAddress) {
  World one, other;
  one.string("shifts every address");
  const auto keys = [](World& w) {
    return std::vector<Value>{number(5),
                              number(2.5),
                              w.string("text"),
                              Value::of(Vector3(1, 2, 3)),
                              w.list(),
                              Value::of(Tag::Hash, w.heap.hash()),
                              Value::of(Tag::Data, w.heap.data("x"))};
  };
  const auto a = keys(one), b = keys(other);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(key_hash(a[i]), key_hash(b[i])) << i;
}

TEST(Hashes, MemoryStaysBoundedWhenKeysComeAndGo) {
  World w;
  HashCell& hash = *w.heap.hash();
  Value removed;
  for (int i = 0; i < 200'000; ++i) {
    w.heap.set(hash, number(i), number(i));
    if (i >= 10) {
      ASSERT_TRUE(w.heap.remove(hash, number(i - 10), removed));
    }
  }
  EXPECT_LE(hash.entry_capacity, 64u);
  EXPECT_EQ(hash.count_live, 10u);
}

TEST(Hashes, RemovedKeyAndValueAreReleased) {
  World w;
  HashCell& hash = *w.heap.hash();
  w.roots.frames.push_back(&hash);
  w.heap.set(hash, w.string("key"), w.string("value"));
  w.heap.set(hash, w.string("key"), w.string("other"));
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 3u);
  Value removed;
  EXPECT_TRUE(w.heap.remove(hash, w.string("key"), removed));
  EXPECT_EQ(removed.string()->view(), "other");
  w.heap.reclaim();
  EXPECT_EQ(w.heap.live_cells(), 1u);
}

}  // namespace
}  // namespace breve::steve::testing
