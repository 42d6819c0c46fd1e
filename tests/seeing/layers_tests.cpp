// What lies behind what, and what is seen through what; colours that programs choose are those of the picture.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "stage.hpp"

namespace breve::seeing {
namespace {

using Color = std::array<int, 3>;

constexpr Color kBlack{0, 0, 0};
const std::string kDark = "self set-background-color to (0, 0, 0). self point-camera at (0, 0, 0) from (0, 0, 20). ";

Color color_at(const Pixels& pixels, int x, int y) {
  const std::size_t at = 4 * static_cast<std::size_t>(y * pixels.width + x);
  return {pixels.rgba[at], pixels.rgba[at + 1], pixels.rgba[at + 2]};
}

Color middle_of(const Pixels& pixels) { return color_at(pixels, pixels.width / 2, pixels.height / 2); }

void expect_near(const Color& one, const Color& two, int tolerance = 2) {
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(one[k], two[k], tolerance) << "channel " << k;
}

/// A part of light as a picture holds it.
int encoded(double light) { return static_cast<int>(std::lround(255 * (1.055 * std::pow(light, 1 / 2.4) - 0.055))); }

class Layers : public testing::Test {
 protected:
  Pixels draw(const std::string& setup, int dimension = 3) {
    return stage_.draw(stage_.open(stage_.compile(setup, "", dimension)));
  }
  Stage stage_{BREVE_LOOK_PLAIN};
};

// The corners of the star are nothing; with a scale of 3, four of them meet in the middle of each face.
TEST_F(Layers, HolesOfATextureShowWhatIsBehind) {
  const char* star = "thing set-texture-image to (self picture of \"star\"). thing set-texture-scale to 3. ";
  const std::string front = kDark + "thing = ((new Thing) become from box at (0, 0, 4) in (1, 0, 0)). " + star;
  expect_near(middle_of(draw(front)), kBlack);
  expect_near(middle_of(draw(front + "(new Thing) become from box at (0, 0, -4) in (0, 0, 1). ")), {0, 0, 255});
  const std::string behind =
      "thing = ((new Thing) become from box at (0, 0, -4) in (0, 0, 1)). thing "
      "set-texture-image to (self picture of \"checker\"). thing set-texture-scale to 3. ";
  expect_near(middle_of(draw(front + behind)), middle_of(draw(kDark + behind)));
}

// Eight by eight pixels of one colour, (254, 0, 0).
TEST_F(Layers, ATextureMayBeAJpegFile) {
  const std::string setup = kDark +
                            "thing = ((new Thing) become from box in (1, 1, 1)). thing set-texture-image to "
                            "((new Image) load from \"red.jpg\"). ";
  expect_near(middle_of(draw(setup)), {254, 0, 0}, 3);
}

TEST_F(Layers, HolesOfATextureThrowNoShadow) {
  const std::string setup =
      kDark +
      "self floor. land catch-shadows. self enable-lighting. self enable-shadows. self move-light to (0, 60, 0). "
      "self point-camera at (0, -2, 0) from (0, 16, 0.001). thing = ((new Thing) become from ((new Cube) "
      "init-with size (6, .2, 6)) at (0, 4, 0)). thing set-texture-image to (self picture of \"star\"). thing "
      "set-texture-scale to 6. ";
  const Color through = middle_of(draw(setup));
  expect_near(through, middle_of(draw(setup + "thing make-invisible. ")), 6);
}

TEST_F(Layers, TransparentThingsOfAllKindsAreSortedTogether) {
  const std::string things =
      "thing = ((new Thing) become from box at (0, 0, -4) in (0, 0, 1)). thing set-transparency to .5. "
      "cells = ((new PatchGrid) init-with x-count 2 y-count 2 z-count 1 patch-size (3, 3, 1)). foreach other in "
      "(cells get-patches): { other set-color to (1, 0, 0). other set-transparency to .5. } "
      "thing = ((new Thing) become from ball at (0, 0, 4) in (0, 1, 0)). thing draw-as-point. thing "
      "set-transparency to .5. ";
  const int front = encoded(0.5), middle = encoded(0.25), back = encoded(0.125);
  expect_near(middle_of(draw(kDark + things)), {middle, front, back});
  expect_near(middle_of(draw(kDark + "self point-camera at (0, 0, 0) from (0, 0, -20). " + things)),
              {middle, back, front});
}

TEST_F(Layers, AFarMiddleOfASheetDoesNotBringItBehindWhatItHides) {
  const std::string things =
      "thing = ((new Thing) become from box at (0, 0, -4) in (0, 0, 1)). thing set-transparency to .5. "
      "cells = ((new PatchGrid) init-with location (60, 0, 0) x-count 130 y-count 2 z-count 1 patch-size (1, 3, 1)). "
      "foreach other in (cells get-patches): { other set-color to (1, 0, 0). other set-transparency to .5. } ";
  const Color seen = middle_of(draw(kDark + "self point-camera at (0, 0, 0) from (-6, 0, 19). " + things));
  EXPECT_GT(seen[0], seen[2]);
}

TEST_F(Layers, OpaqueCellsOfAClearSheetHideByDepth) {
  const std::string things =
      "cells = ((new PatchGrid) init-with x-count 2 y-count 1 z-count 1 patch-size (6, 6, 1)). foreach other in (cells "
      "get-patches): { other set-color to (1, 0, 0). other set-transparency to 1 - (other get-x-index) * .5. } "
      "pen = new Drawing. pen set-line-width to 5. pen set-color to (0, 1, 0). pen draw-line from (-5, 0, -3) to (5, "
      "0, -3). ";
  const Pixels pixels = draw(kDark + things);
  expect_near(color_at(pixels, 64, 60), {255, 0, 0});
  EXPECT_GT(color_at(pixels, 96, 60)[1], 100);
}

TEST_F(Layers, FogHidesAllKinds) {
  const std::string fog = kDark +
                          "self enable-fog. self set-fog-limits with-start 10 with-end 40. self "
                          "set-fog-intensity to 1. self set-fog-color to (.2, .4, .6). ";
  const std::string pen = "pen = new Drawing. pen set-line-width to 9. pen set-color to (1, 0, 0). ";
  const char* const things[] = {
      "(new Thing) become from box at (0, 0, -30). ",
      "((new Thing) become from ball at (0, 0, -30)) draw-as-point. ",
      "pen draw-line from (-5, 0, -30) to (5, 0, -30). ",
      "pen add-polygon-point at (-5, -5, -30). pen add-polygon-point at (5, -5, -30). pen add-polygon-point at (0, 5, "
      "-30). pen end-polygon. ",
      "cells = ((new PatchGrid) init-with location (0, 0, -30) x-count 1 y-count 1 z-count 1 patch-size (9, 9, 1)). "
      "foreach other in (cells get-patches): { other set-color to (1, 0, 0). other set-transparency to 1. } ",
  };
  for (const std::string thing : things) {
    SCOPED_TRACE(thing);
    expect_near(middle_of(draw(fog + pen + thing)), {51, 102, 153});
    EXPECT_GT(middle_of(draw(fog + "self disable-fog. " + pen + thing))[0], 200);
  }
}

TEST_F(Layers, FogOfAFlatWorldIsTheSameEverywhere) {
  const Pixels pixels = draw(
      "self set-background-color to (0, 0, 0). self point-camera at (0, 0, 0) from (0, 0, 40). self enable-fog. self "
      "set-fog-limits with-start 20 with-end 60. self "
      "set-fog-intensity to .05. self set-fog-color to (0, 0, 1). (new Thing) become from ((new Cube) init-with size "
      "(100, 100, 1)). ",
      2);
  EXPECT_GT(middle_of(pixels)[2], 60);
  expect_near(color_at(pixels, 4, 4), middle_of(pixels), 1);
}

/// The same box as one that moves is.
TEST(ChosenColors, AreThoseOfTheGroundToo) {
  Stage stage(BREVE_LOOK_FULL);
  const std::string begin =
      "self point-camera at (0, 0, 0) from (0, 5, 20). self enable-lighting. self move-light to (8, 14, 12). ";
  const char* const looks[] = {
      "set-color to (1, 0, 0). thing set-texture-image to 0. ",
      "set-color to (.9, .8, 1). thing set-texture-image to (self picture of \"clouds\"). ",
  };
  for (const std::string look : looks) {
    const auto draw = [&](const std::string& thing) {
      return middle_of(stage.draw(stage.open(stage.compile(begin + thing + " thing set-shape to box. thing " + look))));
    };
    expect_near(draw("thing = new Stationary."), draw("thing = new Thing."), 1);
    expect_near(draw("thing = new Floor. thing move to (0, 0, 0)."), draw("thing = new Thing."), 1);
  }
}

}  // namespace
}  // namespace breve::seeing
