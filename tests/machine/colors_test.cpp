// Colours: formulas and the way there and back.
#include <gtest/gtest.h>

#include <set>

#include "steve/machine/functions.hpp"

namespace breve::steve {
namespace {

constexpr double kRoundOff = 1e-12;  // a few operations on numbers of about 1

TEST(Colors, ThereAndBackGivesTheSameColor) {
  for (int r = 0; r <= 10; ++r)
    for (int g = 0; g <= 10; ++g)
      for (int b = 0; b <= 10; ++b) {
        const Vector3 rgb(r / 10.0, g / 10.0, b / 10.0);
        EXPECT_LT((hsv_to_rgb(rgb_to_hsv(rgb)) - rgb).norm(), kRoundOff) << rgb.transpose();
      }
}

TEST(Colors, KnownColors) {
  EXPECT_EQ(rgb_to_hsv({1, 0, 0}), Vector3(0, 1, 1));
  EXPECT_EQ(rgb_to_hsv({0, 1, 0}), Vector3(120, 1, 1));
  EXPECT_EQ(rgb_to_hsv({0, 0, 1}), Vector3(240, 1, 1));
  EXPECT_EQ(rgb_to_hsv({0.5, 0.5, 0.5}), Vector3(-1, 0, 0.5));
  EXPECT_EQ(hsv_to_rgb({-1, 0, 0.5}), Vector3(0.5, 0.5, 0.5));
  EXPECT_EQ(hsv_to_rgb({360, 1, 1}), hsv_to_rgb({0, 1, 1}));
  EXPECT_EQ(hsv_to_rgb({-120, 1, 1}), Vector3(0, 0, 1));
}

TEST(Colors, UniqueColorsFollowTheirRule) {
  EXPECT_EQ(unique_color(0), Vector3(0, 0, 0));
  EXPECT_EQ(unique_color(1), Vector3(1, 1, 1));
  EXPECT_EQ(unique_color(2), Vector3(1, 0, 0));
  EXPECT_EQ(unique_color(3), hsv_to_rgb({40, 1, 1}));
  EXPECT_EQ(unique_color(2 + 8), hsv_to_rgb({0, 1, 0.8}));
  EXPECT_EQ(unique_color(2 + 32), hsv_to_rgb({0, 0.4, 1}));
  EXPECT_EQ(unique_color(2 + 64), hsv_to_rgb({0, 0.2, 1}));
  EXPECT_EQ(unique_color(2 + 96), hsv_to_rgb({20, 1, 1}));
  EXPECT_EQ(unique_color(-5), Vector3(0, 0, 0));
}

}  // namespace
}  // namespace breve::steve
