// Arrows are where the physics says, as long as it says, and nowhere else.
#include <breve/view.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "stage.hpp"

namespace breve::seeing {
namespace {

constexpr int kWidth = 320, kHeight = 240;
/// 20 units away, seen from straight ahead: pixels of a length unit in the plane z = 0.
const double kUnit = kHeight / (2 * 20 * std::tan(20 * std::acos(-1) / 180));
// The pixels of a head's tip and of an edge.
constexpr double kTolerance = 3;  // pixels

// Wide bodies hide nothing: arrows are drawn over everything. A box of 2 x 2 x 2 rests on a floor whose top is at -2.
constexpr const char* kResting =
    "self set-background-color to (0, 0, 0). self point-camera at (0, 0, 0) from (0, 0, 20). "
    "land = new Stationary. land register with-shape ((new Cube) init-with size (40, 2, 40)) at-location (0, -3, 0). "
    "land set-texture-image to 0. land set-color to (0, 0, 0). "
    "thing = ((new Thing) become from ((new Sphere) init-with radius 1) at (0, -1, 0) in (0, 0, .2)). "
    "thing enable-physics. ";

bool is_red(const std::uint8_t* p) { return p[0] > 150 && p[1] < 120 && p[2] < 110; }
bool is_blue(const std::uint8_t* p) { return p[2] > 150 && p[1] > 110 && p[0] < 110; }
bool is_green(const std::uint8_t* p) { return p[1] > 130 && p[0] < 130 && p[2] < 150; }

struct Box {
  int left = kWidth, right = -1, top = kHeight, bottom = -1, count = 0;
};

Box box_of(const Pixels& pixels, bool (*wanted)(const std::uint8_t*)) {
  Box box;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      if (!wanted(pixels.rgba.data() + 4 * (static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x))))
        continue;
      box = {std::min(box.left, x), std::max(box.right, x), std::min(box.top, y), std::max(box.bottom, y),
             box.count + 1};
    }
  return box;
}

class Arrows : public testing::Test {
 protected:
  breve_world* rest() {
    breve_world* world = stage_.open(stage_.compile(kResting, "", 3, "PhysicalControl"));
    stage_.step(world, 20);
    return world;
  }
  Stage stage_{BREVE_LOOK_PLAIN, kWidth, kHeight};
};

TEST_F(Arrows, OfAContactForceIsAsLongAsTheWeightSays) {
  breve_world* world = rest();
  stage_.show_arrows(BREVE_ARROWS_FORCES);
  const Box box = box_of(stage_.draw(world), is_red);
  // m g upward: 9.8 / 10 of the ball's diameter, from the floor at y = -2.
  ASSERT_GT(box.count, 50);
  EXPECT_NEAR(box.top, kHeight / 2.0 - (-2 + 1.96) * kUnit, kTolerance);
  EXPECT_NEAR(box.bottom, kHeight / 2.0 + 2 * kUnit, kTolerance);
  EXPECT_NEAR((box.left + box.right) / 2.0, kWidth / 2.0, 1.5);
}

TEST_F(Arrows, OfAContactIsAlongItsNormal) {
  breve_world* world = rest();
  stage_.show_arrows(BREVE_ARROWS_CONTACTS);
  const Box box = box_of(stage_.draw(world), is_blue);
  ASSERT_GT(box.count, 30);
  EXPECT_NEAR(box.bottom - box.top, kUnit, 2 * kTolerance);  // the smaller radius
  EXPECT_LT(box.right - box.left, 14);                       // the head
}

TEST_F(Arrows, OfAVelocityGoesWhereTheBodyWillBe) {
  breve_world* world = stage_.open(stage_.compile(
      "self set-background-color to (0, 0, 0). self point-camera at (0, 0, 0) from (0, 0, 20). thing = ((new Thing) "
      "become from ((new Sphere) init-with radius .2) in (.2, 0, 0)). thing set-velocity to (4, 0, 0). "));
  stage_.show_arrows(BREVE_ARROWS_VELOCITIES);
  const Box box = box_of(stage_.draw(world), is_green);
  EXPECT_NEAR(box.right, kWidth / 2.0 + 4 * kUnit, kTolerance);
  EXPECT_NEAR(box.left, kWidth / 2.0, 4);
}

bool is_yellow(const std::uint8_t* p) { return p[0] > 200 && p[1] > 160 && p[2] < 120; }

/// A ball of radius 1 at (0, 3, 0) that hangs from the world at (0, 4, 0).
/// @param keywords  that the class of the joint has besides the others
std::string hangs_by(const std::string& joint, const std::string& keywords) {
  return "self set-background-color to (0, 0, 0). self point-camera at (0, 0, 0) from (0, 0, 20). body = (new Link). "
         "body set-shape to ((new Sphere) init-with radius 1). body set-color to (0, 0, .2). (new MultiBody) set-root "
         "to "
         "body. (new " +
         joint + ") link " + keywords + " with-parent-point (0, 4, 0) with-child-point (0, 1, 0) to-child body. ";
}

TEST_F(Arrows, OfAJointIsFromItsPivotAlongItsAxis) {
  breve_world* world =
      stage_.open(stage_.compile(hangs_by("RevoluteJoint", "with-normal (1, 0, 0)"), "", 3, "PhysicalControl"));
  stage_.show_arrows(BREVE_ARROWS_JOINTS);
  const Box box = box_of(stage_.draw(world), is_yellow);
  ASSERT_GT(box.count, 30);
  EXPECT_NEAR(box.right, kWidth / 2.0 + kUnit, kTolerance);  // the child's radius
  EXPECT_NEAR(box.left, kWidth / 2.0, 4);                    // the dot at the pivot
  EXPECT_NEAR((box.top + box.bottom) / 2.0, kHeight / 2.0 - 4 * kUnit, 1.5);
}

TEST_F(Arrows, OfAJointWithoutAnAxisIsADot) {
  breve_world* world = stage_.open(stage_.compile(hangs_by("FixedJoint", ""), "", 3, "PhysicalControl"));
  stage_.show_arrows(BREVE_ARROWS_JOINTS);
  const Box box = box_of(stage_.draw(world), is_yellow);
  ASSERT_GT(box.count, 4);
  EXPECT_NEAR((box.left + box.right) / 2.0, kWidth / 2.0, 1.5);
  EXPECT_LT(box.right - box.left, 8);
  EXPECT_NEAR((box.top + box.bottom) / 2.0, kHeight / 2.0 - 4 * kUnit, 1.5);
}

TEST_F(Arrows, OfAJointOfAFlatWorldIsADot) {
  breve_world* world = stage_.open(stage_.compile(
      "self set-background-color to (0, 0, 0). body = (new Link). body set-shape to ((new Sphere) init-with radius 1). "
      "body set-color to (0, 0, .2). (new MultiBody) set-root to body. (new RevoluteJoint) link with-normal (0, 0, 1) "
      "with-parent-point (0, 0, 0) with-child-point (1, 0, 0) to-child body. ",
      "", 2));
  stage_.show_arrows(BREVE_ARROWS_JOINTS);
  const Box box = box_of(stage_.draw(world), is_yellow);
  ASSERT_GT(box.count, 4);
  EXPECT_LT(box.right - box.left, 8);
  EXPECT_LT(box.bottom - box.top, 8);
}

TEST_F(Arrows, AreNotThereUnlessTheyAreAskedFor) {
  breve_world* world = rest();
  const Pixels without = stage_.draw(world);
  EXPECT_EQ(box_of(without, is_red).count + box_of(without, is_blue).count, 0);
  std::uint64_t before = 0, after = 0;
  EXPECT_EQ(breve_world_hash(world, &before), BREVE_OK);
  stage_.show_arrows(BREVE_ARROWS_FORCES | BREVE_ARROWS_CONTACTS);
  EXPECT_GT(pixels_that_differ(without, stage_.draw(world)), 100);
  EXPECT_EQ(breve_world_hash(world, &after), BREVE_OK);
  EXPECT_EQ(before, after);
  stage_.show_arrows(BREVE_ARROWS_NONE);
  EXPECT_EQ(pixels_that_differ(without, stage_.draw(world)), 0);
}

TEST_F(Arrows, ThatThereAreNotAreRefused) {
  breve_view* view = nullptr;
  ASSERT_EQ(breve_view_create(stage_.runtime(), nullptr, &view), BREVE_OK);
  EXPECT_EQ(breve_view_set_arrows(view, 16, 1), BREVE_ERROR_ARGUMENT);
  for (const double scale : {0.0, -1.0, std::nan(""), HUGE_VAL})
    EXPECT_EQ(breve_view_set_arrows(view, 0, scale), BREVE_ERROR_ARGUMENT);
  EXPECT_EQ(breve_view_set_arrows(view, 15, 3), BREVE_OK);
  EXPECT_EQ(breve_view_set_arrows(view, 1, 0), BREVE_ERROR_ARGUMENT);
  std::uint32_t arrows = 0;
  double scale = 0;
  EXPECT_EQ(breve_view_arrows(view, &arrows, &scale), BREVE_OK);
  EXPECT_EQ(arrows, 15U);
  EXPECT_EQ(scale, 3.0);
  breve_view_destroy(view);
}

}  // namespace
}  // namespace breve::seeing
