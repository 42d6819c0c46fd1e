// What the meter counts is what a world takes: almost nothing of a big world stands outside the runtime's allocator.
#include <gtest/gtest.h>

#include <string>

#include "counted_new.hpp"

namespace {

using namespace limits;

constexpr const char* kProgram = R"(
@use Control.
@use Image.
@use Matrix.
@use Mobile.
@use Shape.
@use Drawing.
Controller Big.
Object : Note {
  + variables:
    words (list).
    table (hash).
    text (string).
  + to init:
    words = { 1, "two", { 3 } }.
    table{"key"} = words.
    text = "a note of its own, number $words".
}
Mobile : Walker {
  + to init:
    self set-shape to ((new Cube) init-with size (1, 1, 1)).
    self set-velocity to random[(2, 2, 2)].
    self move to random[(50, 50, 50)].
    self set-neighborhood-size to 5.
    self set-rotational-velocity to (0, 1, 0).
    self set-color to (1, 0, 0).
    self handle-collisions with-type "Walker" with-method "touch".
  + to touch with other (object):
    return 0.
  + to iterate:
    self get-neighbors.
}
Control : Big {
  + variables:
    things, many (list).
    drawing (object).
  + to init:
    i (int).
    things = 5000 new Note.
    many = 1000 new Walker.
    for i = 0, i < 30, i++: {
      push ((new Image) init-with width 64 height 64) onto things.
      push ((new Matrix3D) init-with x-size 16 y-size 16 z-size 16) onto things.
      self set-display-text to "a long text for the display, which is more than a small string holds" number 1.
    }
    for i = 0, i < 5000, i++: {
      self schedule method-call "wait" at-time 1000 + i.
      self observe instance things{i} for-notification "message $i" with-method "wait".
    }
    drawing = new Drawing.
    for i = 0, i < 2000, i++: drawing draw-line from (0, 0, 0) to (i, i, i).
  + to wait:
    return 0.
  + to iterate:
    self update-neighbors.
    super iterate.
}
)";

/// Runs the big world, and compares what it took by operator new and by the allocator with what its meter tells.
std::size_t compare_with_meter(bool profile) {
  const breve_runtime_config config = counted_config();
  breve_runtime* runtime = nullptr;
  breve_program* program = nullptr;
  breve_world* world = nullptr;
  EXPECT_EQ(breve_runtime_create(&config, &runtime), BREVE_OK);
  EXPECT_EQ(breve_program_compile(runtime, "big.tz", kProgram, std::string(kProgram).size(), &program), BREVE_OK)
      << breve_runtime_last_error(runtime)->text;
  breve_world_config world_config = breve_world_config_default();
  world_config.profile = profile;
  const std::size_t outside_before = live_bytes(), given_before = given_bytes();
  EXPECT_EQ(breve_world_create(runtime, program, &world_config, &world), BREVE_OK)
      << breve_runtime_last_error(runtime)->text;
  if (world == nullptr) return 0;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(breve_world_step(world), BREVE_OK) << breve_world_last_error(world)->text;
  if (profile) {
    // The nodes as they are read are a table of their own.
    std::size_t nodes = 0;
    EXPECT_EQ(breve_world_profile_count(world, &nodes), BREVE_OK);
    EXPECT_GT(nodes, 20U);
    breve_profile_node node{};
    EXPECT_EQ(breve_world_profile_node(world, nodes - 1, &node), BREVE_OK);
  }
  const std::size_t outside = live_bytes() - outside_before, given = given_bytes() - given_before;
  breve_stats stats{};
  stats.struct_size = sizeof stats;
  EXPECT_EQ(breve_world_stats(world, &stats), BREVE_OK);
  std::printf("metered %zu, given by the allocator %zu, outside %zu bytes\n", stats.memory_used, given, outside);
  EXPECT_GT(stats.memory_used, 10U << 20);
  EXPECT_LE(outside, stats.memory_used / 100);
  // The handle of the world itself stands in the runtime's memory and is not the world's.
  EXPECT_GE(given, stats.memory_used);
  EXPECT_LE(given, stats.memory_used + 8192);
  breve_world_destroy(world);
  EXPECT_EQ(live_bytes(), outside_before);
  EXPECT_EQ(given_bytes(), given_before);
  breve_program_destroy(program);
  breve_runtime_destroy(runtime);
  return stats.memory_used;
}

TEST(TrueBytes, AtMostOnePercentOfABigWorldIsOutsideTheMeter) { compare_with_meter(false); }

// Its tables are counted: with a profile the meter tells more, and no more is outside of it.
TEST(TrueBytes, AProfileIsInTheMeterToo) {
  const std::size_t without = compare_with_meter(false), with = compare_with_meter(true);
  EXPECT_GT(with, without + 2048);
}

}  // namespace
