// Worlds that draw at once, each in a thread of its own, see what one sees alone.
#include <gtest/gtest.h>

#include <thread>

#include "stage.hpp"

namespace breve::seeing {
namespace {

constexpr int kPictures = 6;

Pixels run(std::uint32_t look) {
  Stage stage(look);
  breve_world* world = stage.open(stage.compile(
      "self floor. land catch-shadows. self enable-lighting. self enable-shadows. self move-light to (6, 20, 6). "
      "self point-camera at (0, 0, 0) from (0, 8, 24). self set-display-text to \"agents\" at-x -.9 at-y .8. "
      "for n = 0, n < 40, n++: { thing = ((new Thing) become from ball at random[(20.0, 6.0, 20.0)] - (10, 1, 10)). "
      "thing "
      "set-velocity to random[(4.0, 4.0, 4.0)]. if n % 3 == 0: thing set-texture-image to (self picture of \"noise\"). "
      "}"));
  Pixels last;
  for (int i = 0; i < kPictures; ++i) {
    stage.step(world, 1);
    last = stage.draw(world);
  }
  return last;
}

TEST(DrawingThreads, TwoWorldsDrawInTwoThreads) {
  const Pixels alone[] = {run(BREVE_LOOK_FULL), run(BREVE_LOOK_PLAIN)};
  ASSERT_GT(pixels_that_differ(alone[0], alone[1]), 1000);
  Pixels together[2];
  {
    std::jthread first([&] { together[0] = run(BREVE_LOOK_FULL); });
    std::jthread second([&] { together[1] = run(BREVE_LOOK_PLAIN); });
  }
  for (int i = 0; i < 2; ++i) EXPECT_EQ(pixels_that_differ(alone[i], together[i]), 0);
}

}  // namespace
}  // namespace breve::seeing
