// What a question about space counts is the same in every world of the same state: a restored one is cut off where the
// one that was saved is, whatever was asked before.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "breve/breve.h"

namespace {

constexpr std::uint64_t kBudget = 200000;
constexpr const char* kProgram = R"(
@use PhysicalControl.
@use Mobile.
@use Shape.
Controller Asker.
PhysicalControl : Asker {
  + variables:
    bodies, found (list).
    ball, box (object).
    asked (int).
  + to make-body:
    body (object).
    body = new Mobile.
    if |bodies| % 3: body set-shape to ball.
    else: body set-shape to box.
    body move to random[(9, 9, 9)].
    push body onto bodies.
  + to init:
    i (int).
    ball = (new Sphere init-with radius 1.0).
    box = (new Cube init-with size (1, 2, 1)).
    for i = 0, i < 200, i++: self make-body.
  + to ask-everything:
    found = (self cast-ray from-location (5, -1, 5) with-direction (0, 12, 0)).
    found = (self find-on-ray from-location (5, -1, 5) with-direction (0, 12, 0)).
    found = (self cast-shape item box from-location (5, -3, 5) with-direction (0, 12, 0)).
    found = (self find-closest to-location (4, 4, 4) within 3.0).
    found = (self find-in-box at-location (4, 4, 4) with-size (3, 3, 3)).
    found = (self find-near location (4, 4, 4) within 3.0).
    found = (bodies{7} check-for-penetrations).
    asked += 1.
  + to disturb:
    # The tree of boxes has seen other places, and some bodies are not in it.
    i (int).
    for i = 0, i < 150, i++: {
      bodies{i} move to random[(9, 9, 9)].
      found = (self cast-ray from-location (5, -1, 5) with-direction (0, 12, 0)).
    }
    for i = 0, i < 20, i++: self make-body.
    for i = 0, i < 30, i++: found = (self find-closest to-location (i, 4, 4)).
  + to ask-on:
    asked = 0.
    while 1: self ask-everything.
  + to get-asked: return asked.
}
)";

class QuestionCost : public testing::Test {
 protected:
  void SetUp() override {
    const breve_runtime_config config = breve_runtime_config_default();
    ASSERT_EQ(breve_runtime_create(&config, &runtime_), BREVE_OK);
    ASSERT_EQ(breve_program_compile(runtime_, "asker.tz", kProgram, std::string(kProgram).size(), &program_), BREVE_OK);
  }
  void TearDown() override {
    for (breve_world* world : worlds_) breve_world_destroy(world);
    breve_program_destroy(program_);
    breve_runtime_destroy(runtime_);
  }
  breve_world* make() {
    breve_world_config config = breve_world_config_default();
    config.budget = kBudget;
    breve_world* world = nullptr;
    EXPECT_EQ(breve_world_create(runtime_, program_, &config, &world), BREVE_OK);
    worlds_.push_back(world);
    return world;
  }
  static breve_status call(breve_world* world, const char* method, breve_value* result = nullptr) {
    return breve_object_call(world, breve_world_controller(world), method, nullptr, 0, result);
  }
  /// How often everything can be asked within the budget.
  static int asked(breve_world* world) {
    EXPECT_EQ(call(world, "ask-on"), BREVE_ERROR_BUDGET);
    breve_value value{};
    EXPECT_EQ(call(world, "get-asked", &value), BREVE_OK);
    return static_cast<int>(value.as.integer);
  }

  breve_runtime* runtime_ = nullptr;
  breve_program* program_ = nullptr;
  std::vector<breve_world*> worlds_;
};

TEST_F(QuestionCost, DoesNotDependOnWhatWasAskedBefore) {
  breve_world* saved = make();
  ASSERT_EQ(call(saved, "disturb"), BREVE_OK);
  std::size_t size = 0;
  breve_world_snapshot(saved, nullptr, 0, &size);
  std::vector<char> image(size);
  ASSERT_EQ(breve_world_snapshot(saved, image.data(), image.size(), &size), BREVE_OK);
  breve_world* restored = make();
  ASSERT_EQ(breve_world_restore(restored, image.data(), size), BREVE_OK);
  const int count = asked(restored);
  EXPECT_EQ(asked(saved), count);
  EXPECT_GT(count, 10);
}

}  // namespace
