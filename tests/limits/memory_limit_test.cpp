// A world's memory limit: it cuts whatever grows, the world stays usable, and what is dropped is given back.
#include <gtest/gtest.h>

#include <string>

#include "breve/breve.h"

namespace {

constexpr std::size_t kLimit = 48U << 20;
constexpr const char* kProgram = R"(
@use Control.
@use Image.
@use Matrix.
@use Mobile.
@use Shape.
Controller Hungry.
Object : Thing {
  + variables:
    text (string).
}
Control : Hungry {
  + variables:
    kept (list).
    table (hash).
    text (string).
    thing, spare (object).   # spare: given back to have room for dropping the rest
    turns (int).
  + to iterate:
    turns += 1.
    super iterate.
  + to grow-list:
    while 1: push 1.5 onto kept.
  + to grow-lists:
    while 1: push { 1, 2 } onto kept.
  + to grow-string:
    text = "0123456789".
    while 1: text = text + text.
  + to grow-strings:
    while 1: push "number $turns" + "!" onto kept.
  + to grow-hash:
    i (int).
    while 1: { table{i} = i. i += 1. }
  + to grow-objects:
    while 1: push (new Thing) onto kept.
  + to grow-bodies:
    while 1: push (new Mobile) onto kept.
  + to grow-shapes:
    while 1: push ((new Cube) init-with size (1, 2, 3)) onto kept.
  + to grow-image:
    thing = new Image.
    thing init-with width 8192 height 8192.
  + to grow-matrix:
    thing = new Matrix2D.
    thing init-with x-size 8192 y-size 8192.
  + to grow-grid:
    thing = new Matrix3D.
    thing init-with x-size 256 y-size 256 z-size 256.
  + to grow-schedule:
    i (int).
    for i = 0, i < 1000000, i++: self schedule method-call "ring" at-time 1000000 + i.
  + to grow-observers:
    while 1: self observe instance self for-notification "news" with-method "ring".
  + to grow-copies:
    kept = { 1, 2, 3, 4 }.
    while 1: push copylist kept onto kept.
  + to grow-text:
    i (int).
    for i = 0, i < 200000, i++: push "an element of some length" onto kept.
    while 1: push "$kept" onto kept.
  + to ring:
    turns += 1.
  + to drop-spare:
    if spare: free spare.
  + to drop-kept:
    unused (hash).
    kept = {}. text = "". table = unused.
  + to drop-all:
    self unschedule method-call "ring".
    self unobserve instance self for-notification "news".
    free all Thing. free all Mobile. free all Shape.
    if thing: free thing.
    spare = ((new Image) init-with width 1536 height 1024).
}
)";

class MemoryLimit : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    ASSERT_EQ(breve_runtime_create(nullptr, &runtime_), BREVE_OK);
    ASSERT_EQ(breve_program_compile(runtime_, "hungry.tz", kProgram, std::string(kProgram).size(), &program_), BREVE_OK)
        << breve_runtime_last_error(runtime_)->text;
    breve_world_config config = breve_world_config_default();
    config.memory_limit = kLimit;
    ASSERT_EQ(breve_world_create(runtime_, program_, &config, &world_), BREVE_OK);
    drop_all();  // what a first call makes is made
  }
  void TearDown() override {
    breve_world_destroy(world_);
    breve_program_destroy(program_);
    breve_runtime_destroy(runtime_);
  }
  breve_status call(const char* method) {
    return breve_object_call(world_, breve_world_controller(world_), method, nullptr, 0, nullptr);
  }
  /// First what takes no memory, then what makes lists of all objects: garbage goes after the call that follows an
  /// error.
  void drop_all() {
    ASSERT_EQ(call("drop-spare"), BREVE_OK) << breve_world_last_error(world_)->text;
    ASSERT_EQ(call("drop-kept"), BREVE_OK) << breve_world_last_error(world_)->text;
    const breve_status stepped = breve_world_step(world_);
    ASSERT_TRUE(stepped == BREVE_OK || stepped == BREVE_ERROR_MEMORY) << breve_status_name(stepped);
    ASSERT_EQ(call("drop-all"), BREVE_OK) << breve_world_last_error(world_)->text;
  }
  breve_stats stats() const {
    breve_stats s = breve_stats_default();
    EXPECT_EQ(breve_world_stats(world_, &s), BREVE_OK);
    return s;
  }

  breve_runtime* runtime_ = nullptr;
  breve_program* program_ = nullptr;
  breve_world* world_ = nullptr;
};

// Small cells come from chunks that are kept, so that other kinds of memory may stay short: then calls go on to say so.
TEST_P(MemoryLimit, CutsWhatGrowsAndLeavesAConsistentWorld) {
  for (int i = 0; i < 3; ++i) ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  EXPECT_EQ(call(GetParam()), BREVE_ERROR_MEMORY);
  EXPECT_LE(stats().memory_peak, kLimit);
  EXPECT_EQ(stats().memory_limit, kLimit);
  std::uint64_t hash = 0;
  std::size_t size = 0;
  const auto fine = [](breve_status status) { return status == BREVE_OK || status == BREVE_ERROR_MEMORY; };
  for (const char* drop : {"drop-spare", "drop-kept", "drop-all"}) EXPECT_PRED1(fine, call(drop));
  for (int i = 0; i < 3; ++i) EXPECT_PRED1(fine, breve_world_step(world_));
  EXPECT_PRED1(fine, breve_world_hash(world_, &hash));
  EXPECT_PRED1(fine, breve_world_snapshot(world_, nullptr, 0, &size));
  EXPECT_EQ(call(GetParam()), BREVE_ERROR_MEMORY);
  EXPECT_LE(stats().memory_peak, kLimit);
}

INSTANTIATE_TEST_SUITE_P(All, MemoryLimit,
                         ::testing::Values("grow-list", "grow-lists", "grow-string", "grow-strings", "grow-hash",
                                           "grow-objects", "grow-bodies", "grow-shapes", "grow-image", "grow-matrix",
                                           "grow-grid", "grow-schedule", "grow-observers", "grow-copies", "grow-text"),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

class LargeThings : public MemoryLimit {};

// Stores of their own, not cells in chunks: all of it comes back.
TEST_P(LargeThings, AreGivenBackWhenDropped) {
  for (int i = 0; i < 3; ++i) ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  const std::size_t before = stats().memory_used;
  ASSERT_EQ(call(GetParam()), BREVE_ERROR_MEMORY);
  drop_all();
  for (int i = 0; i < 3; ++i) ASSERT_EQ(breve_world_step(world_), BREVE_OK);
  EXPECT_LT(stats().memory_used, before + (64U << 10));
}

INSTANTIATE_TEST_SUITE_P(All, LargeThings,
                         ::testing::Values("grow-list", "grow-string", "grow-hash", "grow-image", "grow-matrix",
                                           "grow-grid"),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

TEST_F(MemoryLimit, TooSmallForAWorldIsAnErrorOfItsCreation) {
  breve_world_config config = breve_world_config_default();
  config.memory_limit = 1000;
  breve_world* none = nullptr;
  EXPECT_EQ(breve_world_create(runtime_, program_, &config, &none), BREVE_ERROR_MEMORY);
  EXPECT_EQ(none, nullptr);
}

}  // namespace
