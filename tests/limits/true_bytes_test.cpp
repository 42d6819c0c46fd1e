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
    EXPECT_EQ(breve_world_profile_node_count(world, &nodes), BREVE_OK);
    EXPECT_GT(nodes, 20U);
    breve_profile_node node{};
    EXPECT_EQ(breve_world_profile_node(world, nodes - 1, &node), BREVE_OK);
  }
  const std::size_t outside = live_bytes() - outside_before, given = given_bytes() - given_before;
  breve_stats stats = breve_stats_default();
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

/// Bodies with physics that touch nobody but the floor: each an island of its own, stepped by workers, or by the
/// world's thread where a handler waits.
constexpr const char* kIslands = R"(
@use Mobile.
@use PhysicalControl.
@use Shape.
@use Stationary.
Controller Wide.
Mobile : Box {
  + to init:
    self set-shape to ((new Cube) init-with size (1, 1, 1)).
    self enable-physics.
}
Box : Heard {
  + to init: self handle-collisions with-type "Stationary" with-method "touch".
  + to touch with other (object): return 0.
}
PhysicalControl : Wide {
  + variables:
    boxes (list).
  + to init:
    i (int).
    (new Stationary) register with-shape ((new Cube) init-with size (4000, 1, 4000)) at-location (0, -0.5, 0).
    self set-gravity to (0, -9.81, 0).
    for i = 0, i < QUIET, i++: self put one (new Box) at (3.0 * i - 600, 0.51, -20).
    for i = 0, i < HEARD, i++: self put one (new Heard) at (3.0 * i - 600, 0.51, 20).
  + to put one box (object) at where (vector):
    box move to where.
    push box onto boxes.
}
)";

std::string islands_program(int quiet, int heard) {
  std::string text = kIslands;
  text.replace(text.find("QUIET"), 5, std::to_string(quiet));
  text.replace(text.find("HEARD"), 5, std::to_string(heard));
  return text;
}

/// Runtime, program and a world of kIslands with a limit, whose memory is counted.
class Islands {
 public:
  Islands(int workers, std::size_t limit, int quiet, int heard) {
    const breve_runtime_config config = counted_config();
    EXPECT_EQ(breve_runtime_create(&config, &runtime_), BREVE_OK);
    compile(islands_program(quiet, heard));
    breve_world_config of_world = breve_world_config_default();
    of_world.memory_limit = limit;
    outside_ = live_bytes(), given_ = given_bytes();
    status = breve_world_create(runtime_, program_, &of_world, &world);
    if (status == BREVE_OK) status = breve_world_set_workers(world, static_cast<std::uint32_t>(workers));
  }
  ~Islands() {
    breve_world_destroy(world);
    EXPECT_EQ(given_bytes(), given_);
    breve_program_destroy(program_);
    breve_runtime_destroy(runtime_);
  }
  Islands(const Islands&) = delete;
  Islands& operator=(const Islands&) = delete;

  void run(int steps) {
    for (int i = 0; i < steps && status == BREVE_OK; ++i) status = breve_world_step(world);
  }
  std::string said() const {
    const breve_error* error = world ? breve_world_last_error(world) : breve_runtime_last_error(runtime_);
    return error ? error->text : "nothing";
  }
  breve_stats stats() const {
    breve_stats out = breve_stats_default();
    EXPECT_EQ(breve_world_stats(world, &out), BREVE_OK);
    return out;
  }
  std::size_t outside() const { return live_bytes() - outside_; }

  breve_world* world = nullptr;
  breve_status status = BREVE_OK;

 private:
  void compile(const std::string& text) {
    EXPECT_EQ(breve_program_compile(runtime_, "wide.tz", text.c_str(), text.size(), &program_), BREVE_OK)
        << breve_runtime_last_error(runtime_)->text;
  }

  breve_runtime* runtime_ = nullptr;
  breve_program* program_ = nullptr;
  std::size_t outside_ = 0, given_ = 0;
};

// What threads work in is the world's, and in the meter: places for more islands at once than one thread needs, and as
// many whatever the number of threads.
TEST(TrueBytes, WhatWorkersTakeIsInTheMeter) {
  std::size_t by_one = 0, by_two = 0;
  for (const int workers : {1, 2, 4}) {
    Islands islands(workers, 0, 100, 100);
    islands.run(5);
    ASSERT_EQ(islands.status, BREVE_OK) << islands.said();
    const std::size_t used = islands.stats().memory_used;
    std::printf("%d workers: metered %zu, outside %zu bytes\n", workers, used, islands.outside());
    EXPECT_LE(islands.outside(), used / 100);
    if (workers == 1) by_one = used;
    if (workers == 2) by_two = used;
    if (workers > 1) {
      EXPECT_GT(used, by_one);
      EXPECT_EQ(used, by_two);
    }
  }
}

// Wherever a limit cuts, in whichever thread: an error that says so, nothing beyond the limit, nothing lost.
TEST(TrueBytes, ALimitCutsAWorldWithWorkersAnywhere) {
  constexpr int kQuiet = 64;
  std::size_t begun = 0, most = 0;
  std::uint64_t whole = 0;
  {
    Islands islands(3, 0, kQuiet, 0);
    ASSERT_EQ(islands.status, BREVE_OK) << islands.said();
    begun = islands.stats().memory_peak;
    islands.run(5);
    most = islands.stats().memory_peak;
    ASSERT_EQ(breve_world_hash(islands.world, &whole), BREVE_OK);
  }
  ASSERT_GT(most, begun + (64U << 10));
  int cut = 0, through = 0;
  constexpr std::size_t kTries = 48;
  for (std::size_t i = 0; i <= kTries; ++i) {
    Islands islands(3, begun + (most + most / 20 - begun) * i / kTries, kQuiet,
                    0);  // the last: a little more than it takes
    ASSERT_EQ(islands.status, BREVE_OK) << islands.said();
    islands.run(5);
    const breve_stats stats = islands.stats();
    EXPECT_LE(stats.memory_peak, stats.memory_limit);
    (islands.status == BREVE_OK ? through : cut) += 1;
    std::uint64_t hash = 0;
    const breve_status hashed = breve_world_hash(islands.world, &hash);  // which may also need more
    EXPECT_TRUE(hashed == BREVE_OK || hashed == BREVE_ERROR_MEMORY) << breve_status_name(hashed);
    // Where it took more than there is, whichever thread asked said so; what went through has missed nothing.
    if (stats.memory_limit < most - most / 20) {
      EXPECT_EQ(islands.status, BREVE_ERROR_MEMORY) << i;
    }
    if (islands.status == BREVE_OK && hashed == BREVE_OK) {
      EXPECT_EQ(hash, whole) << i;
    }
    if (islands.status != BREVE_OK) {
      EXPECT_EQ(islands.status, BREVE_ERROR_MEMORY) << islands.said();
    }
  }
  std::printf("peak %zu bytes when made, %zu after five steps; of %zu limits %d cut\n", begun, most, kTries + 1, cut);
  EXPECT_GT(cut, static_cast<int>(kTries) / 2);
  EXPECT_GE(through, 1);
}

}  // namespace
