// The promises about garbage: anything that is not part of a cycle is freed at the end of the iteration, cycles in a
// bounded number of them.
#include <gtest/gtest.h>

#include <string>

#include "breve/breve.h"

namespace {

constexpr const char* kProgram = R"(
@use Control.
Controller Keeper.
Object : Spark {
  + variables:
    name (string).
    other (object).
    things (list).
  + to init:
    self enable-auto-free.
  + to call-it n n (string):
    name = n.
  + to tie to o (object):
    other = o.
  + to destroy:
    if name: print "$name".
}
Object : Plain { }
Control : Keeper {
  + variables:
    kept, live (list).
    one (object).
    table (hash).
  + to keep count n (int):
    live = n new Plain.
  + to drop-each:
    i (int).
    s (object).
    for i = 0, i < 5, i++: { s = new Spark. s call-it n "spark $i". push s onto kept. }
    kept = {}.
  + to drop-chain:
    a, b (object).
    a = new Spark. b = new Spark.
    a call-it n "first". b call-it n "second".
    a tie to b.
  + to drop-lists count n (int):
    i (int).
    kept = {}.
    for i = 0, i < n, i++: push { i } onto kept.
    kept = {}.
  + to drop-deep count n (int):
    i (int).
    kept = {}.
    for i = 0, i < n, i++: kept = { kept }.
    kept = {}.
  + to drop-hash:
    unused (hash).
    table{"a"} = { 1, { 2 } }. table{"b"} = "text".
    table = unused.
  + to tie-lists count n (int):
    i (int).
    k (list).
    for i = 0, i < n, i++: { k = { i }. push k onto k. }
    k = {}.
  + to tie-hashes count n (int):
    i (int).
    for i = 0, i < n, i++: self tie-hash.
  + to tie-hash:
    h (hash).
    h{"self"} = h.
    h{1} = 2.
  + to tie-sparks count n (int):
    i (int).
    a, b (object).
    for i = 0, i < n, i++: { a = new Spark. b = new Spark. a tie to b. b tie to a. }
    a = 0. b = 0.
  + to tie-large-list count n (int):
    i (int).
    k (list).
    k = { 0 }.
    for i = 0, i < n, i++: push { i } onto k.
    push k onto k.
    k = {}.
}
)";

class Garbage : public ::testing::Test {
 protected:
  void SetUp() override {
    breve_runtime_config config = breve_runtime_config_default();
    config.user = &printed_;
    config.print = [](void* user, breve_world*, breve_channel, const char* text, std::size_t size) {
      static_cast<std::string*>(user)->append(text, size);
    };
    ASSERT_EQ(breve_runtime_create(&config, &runtime_), BREVE_OK);
    ASSERT_EQ(breve_program_compile(runtime_, "keeper.tz", kProgram, std::string(kProgram).size(), &program_), BREVE_OK)
        << breve_runtime_last_error(runtime_)->text;
    ASSERT_EQ(breve_world_create(runtime_, program_, nullptr, &world_), BREVE_OK);
    ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  }
  void TearDown() override {
    breve_world_destroy(world_);
    breve_program_destroy(program_);
    breve_runtime_destroy(runtime_);
  }
  void call(const char* method, int count = -1) {
    const breve_keyword keyword{"count", breve_value_int(count)};
    ASSERT_EQ(breve_object_call(world_, breve_world_controller(world_), method, &keyword, count < 0 ? 0 : 1, nullptr),
              BREVE_OK)
        << breve_world_last_error(world_)->text;
  }
  std::uint64_t cells() const {
    breve_stats stats = breve_stats_default();
    EXPECT_EQ(breve_world_stats(world_, &stats), BREVE_OK);
    return stats.heap_cells;
  }
  /// Iterations until only `left` cells are there; `most` + 1 if they never are.
  int iterations_until(std::uint64_t left, int most) {
    for (int i = 0; i <= most; ++i) {
      if (cells() <= left) return i;
      EXPECT_EQ(breve_world_step(world_), BREVE_OK);
    }
    return most + 1;
  }
  static int bound(std::uint64_t live) { return static_cast<int>((live + 19'999) / 20'000 + 2); }

  std::string printed_;
  breve_runtime* runtime_ = nullptr;
  breve_program* program_ = nullptr;
  breve_world* world_ = nullptr;
};

TEST_F(Garbage, InNoCycleIsGoneAtTheEndOfTheIteration) {
  // Everything is called once before, so that what a first call makes is made.
  for (int round = 0; round < 2; ++round) {
    call("drop-each");
    call("drop-chain");
    call("drop-hash");
    call("drop-lists", 1000);
    ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  }
  const std::uint64_t before = cells();
  call("drop-each");
  call("drop-chain");
  call("drop-hash");
  call("drop-lists", 1000);
  ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  EXPECT_EQ(cells(), before);
}

TEST_F(Garbage, DestroyRunsInOrderOfCreation) {
  call("drop-each");
  ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  EXPECT_EQ(printed_, "spark 0\nspark 1\nspark 2\nspark 3\nspark 4\n");
}

TEST_F(Garbage, DestroyOfWhatRefersComesBeforeThatOfWhatIsReferredTo) {
  call("drop-chain");
  ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  EXPECT_EQ(printed_, "first\nsecond\n");
}

TEST_F(Garbage, AMillionListsDroppedAtOnceAreGoneAtTheEndOfTheIteration) {
  call("drop-lists", 10);
  ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  const std::uint64_t before = cells();
  call("drop-lists", 1'000'000);
  ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  EXPECT_EQ(cells(), before);
}

TEST_F(Garbage, AMillionListsInsideEachOtherGoWithoutRecursion) {
  call("drop-deep", 10);
  ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  const std::uint64_t before = cells();
  call("drop-deep", 1'000'000);
  ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  EXPECT_EQ(cells(), before);
}

class Cycles : public Garbage, public ::testing::WithParamInterface<const char*> {};

TEST_P(Cycles, AreGoneWithinThePromisedIterations) {
  for (const int live : {0, 100'000}) {
    call("keep", live);
    iterations_until(0, 12);
    const std::uint64_t before = cells();
    call(GetParam(), 1000);
    const int most = bound(cells());
    EXPECT_LE(iterations_until(before, most), most) << live << " objects live";
  }
}

// The same when a collection is under way already, so that the cycles have to wait for the next.
TEST_P(Cycles, AreGoneWithinThePromisedIterationsThoughACollectionHasBegun) {
  call("keep", 100'000);
  iterations_until(0, 12);
  const std::uint64_t before = cells();
  call("tie-lists", 10);
  ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  call(GetParam(), 1000);
  const int most = bound(cells());
  EXPECT_LE(iterations_until(before, most), most);
}

TEST_P(Cycles, ThatNeverEndDoNotPileUp) {
  call("keep", 50'000);
  iterations_until(0, 12);
  const std::uint64_t before = cells();
  std::uint64_t made = 0;
  for (int i = 0; i < 60; ++i) {
    call(GetParam(), 200);
    if (i == 0) made = cells() - before;
    ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  }
  EXPECT_LE(cells(), before + made * static_cast<std::uint64_t>(bound(cells())));
}

INSTANTIATE_TEST_SUITE_P(All, Cycles, ::testing::Values("tie-lists", "tie-hashes", "tie-sparks", "tie-large-list"),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

}  // namespace
