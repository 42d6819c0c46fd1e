// Pictures are as they were when somebody looked at them. To draw them anew, after a change that is meant to be seen:
//   BREVE_RENEW_GOLDEN=1 build/release/tests/seeing/seeing_tests --gtest_filter='Golden*'
// and look at each that git says has changed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "golden_scenes.hpp"
#include "stage.hpp"

namespace breve::seeing {
namespace {

// What OSMesa's versions and processors differ by is at edges, which the squares of the comparison average. A lamp that
// is a fifth darker, or a body that is moved by a pixel, is beyond these (see the tests below).
constexpr double kMean = 0.1, kMost = 4;  // CIE L*a*b*

Pixels draw(const GoldenScene& scene) {
  Stage stage(scene.full ? BREVE_LOOK_FULL : BREVE_LOOK_PLAIN);
  breve_world* world = stage.open(stage.compile(scene.setup, "", scene.dimension, scene.parent));
  stage.show_arrows(scene.arrows);
  Pixels pixels = stage.draw(world);
  for (int step = 0; step < scene.steps; ++step) {
    stage.step(world, 1);
    pixels = stage.draw(world);
  }
  return pixels;
}

std::string file_of(const GoldenScene& scene) { return std::string(BREVE_GOLDEN) + "/" + scene.name + ".png"; }

TEST(GoldenPictures, AreWhatIsDrawn) {
  const bool renew = std::getenv("BREVE_RENEW_GOLDEN") != nullptr;
  for (const GoldenScene& scene : golden_scenes()) {
    SCOPED_TRACE(scene.name);
    const Pixels now = draw(scene);
    if (renew) {
      write_png(now, file_of(scene));
      continue;
    }
    const Difference away = difference(read_png(file_of(scene)), now);
    EXPECT_LT(away.mean, kMean);
    EXPECT_LT(away.most, kMost);
    if (away.mean >= kMean || away.most >= kMost) write_png(now, std::string(scene.name) + ".png");  // to be looked at
  }
}

TEST(GoldenPictures, AreEachOfAScene) {
  std::set<std::string> names;
  for (const GoldenScene& scene : golden_scenes()) EXPECT_TRUE(names.insert(scene.name).second) << scene.name;
  for (const auto& entry : std::filesystem::directory_iterator(BREVE_GOLDEN))
    EXPECT_TRUE(names.contains(entry.path().stem().string())) << entry.path();
}

const GoldenScene& scene_named(std::string_view name) {
  for (const GoldenScene& scene : golden_scenes())
    if (scene.name == name) return scene;
  throw std::runtime_error("there is no such scene");
}

TEST(GoldenPictures, ToleranceDoesNotTakeAMovedBodyOrAnotherColor) {
  const GoldenScene& scene = scene_named("sphere");
  const Pixels picture = read_png(file_of(scene));
  for (const char* change : {"thing move to (.2, 0, 0). ", "thing set-color to (1, .42, .1). ",
                             "self set-light-diffuse-color to (.8, .8, .8). ", "thing set-texture-image to 0. "}) {
    const bool same = std::string(change).find("texture") != std::string::npos;  // there is none
    const std::string setup = std::string(scene.setup) + change;
    const Difference away = difference(picture, draw({scene.name, setup.c_str()}));
    EXPECT_EQ(away.mean < kMean && away.most < kMost, same) << change << away.mean << " " << away.most;
  }
}

TEST(GoldenPictures, ToleranceTakesWhatNobodySees) {
  Pixels picture = read_png(file_of(scene_named("sphere"))), other = picture;
  for (std::size_t i = 0; i < other.rgba.size(); ++i) {
    const int noise = static_cast<int>((i * 2654435761U >> 16) % 3) - 1;  // of rounding
    if (i % 4 != 3) other.rgba[i] = static_cast<std::uint8_t>(std::clamp(other.rgba[i] + noise, 0, 255));
  }
  const Difference away = difference(picture, other);
  EXPECT_LT(away.mean, kMean);
  EXPECT_LT(away.most, kMost);
}

}  // namespace
}  // namespace breve::seeing
