// Plots, texts and sub-windows over the world; springs; and the camera that follows by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "runtime/scene/camera_math.hpp"
#include "runtime/scene/mesh.hpp"
#include "stage.hpp"

namespace breve::seeing {
namespace {

const std::string kDark = "self set-background-color to (0, 0, 0). self point-camera at (0, 0, 0) from (0, 0, 20). ";

int brightest(const Pixels& pixels, int x, int y) {
  const std::size_t at = 4 * static_cast<std::size_t>(y * pixels.width + x);
  return std::max({pixels.rgba[at], pixels.rgba[at + 1], pixels.rgba[at + 2]});
}

Pixels draw(Stage& stage, const std::string& setup) { return stage.draw(stage.open(stage.compile(setup))); }

/// The columns of a picture in which a pixel has the first line's colour, which is pure red.
int red_columns(const Pixels& pixels, int first, int end) {
  int count = 0;
  for (int x = first; x < end; ++x) {
    bool red = false;
    for (int y = 0; y < pixels.height; ++y) {
      const std::size_t at = 4 * static_cast<std::size_t>(y * pixels.width + x);
      red = red || (pixels.rgba[at] > 200 && pixels.rgba[at + 1] < 60 && pixels.rgba[at + 2] < 60);
    }
    count += red ? 1 : 0;
  }
  return count;
}

TEST(PointsToDraw, KeepASpikeTheLastPointAndAGap) {
  std::vector<double> values(10'000, 0.0);
  values[4711] = 5;
  values[815] = -5;
  values[2222] = std::nan("");
  values.back() = 1;
  const std::vector<std::size_t> drawn = points_to_draw(values, values.size(), 100);
  EXPECT_LE(drawn.size(), 500U);
  EXPECT_TRUE(std::is_sorted(drawn.begin(), drawn.end()));
  for (const std::size_t i : {0U, 4711U, 815U, 2222U, 9999U})
    EXPECT_NE(std::find(drawn.begin(), drawn.end(), i), drawn.end()) << i;
  EXPECT_EQ(points_to_draw(values, 3, 100), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(points_to_draw({}, 0, 100).empty());
}

TEST(GraphOfAView, ReachesItsRightEnd) {
  Stage stage(BREVE_LOOK_PLAIN, 320, 240);
  const Pixels pixels =
      draw(stage, kDark +
                      "graph = new Graph. graph add-line with-color (1, 0, 0). for n = 0, n < 1003, n++: graph "
                      "add-point on-line 0 with-value 0. for n = 0, n < 40, n++: graph add-point on-line 0 with-value "
                      "(n == 20) * 9. ");
  EXPECT_GT(red_columns(pixels, 0, 320), 150);
  EXPECT_GT(red_columns(pixels, 295, 303), 4);  // the last points
}

TEST(GraphOfAView, EightOfThemAreAllSeen) {
  Stage stage(BREVE_LOOK_PLAIN, 640, 400);
  std::string setup = kDark;
  Pixels before = draw(stage, setup);
  for (int i = 0; i < 8; ++i) {
    setup +=
        "graph = new Graph. graph add-line with-color (1, 0, 0). graph add-point on-line 0 with-value 0. graph "
        "add-point on-line 0 with-value 1. ";
    const Pixels now = draw(stage, setup);
    EXPECT_GT(pixels_that_differ(before, now), 2000) << i + 1;
    before = now;
  }
}

TEST(PlotFile, ItsKeyHasRowsThatFitThePage) {
  ScenePlot plot;
  for (int i = 0; i < 12; ++i) plot.lines.push_back({{0, 0, 0}, "a-method-with-a-name-" + std::to_string(i), {0, 1}});
  const std::string svg = plot_svg(plot);
  std::size_t names = 0;
  for (std::size_t at = svg.find("a-method"); at != std::string::npos; at = svg.find("a-method", at + 1)) ++names;
  EXPECT_EQ(names, 12U);
  double most = 0;
  for (std::size_t at = svg.find("<rect x='"); at != std::string::npos; at = svg.find("<rect x='", at + 1))
    most = std::max(most, std::stod(svg.substr(at + 9)));
  EXPECT_LT(most, 600);  // of 900, and a name is 250 wide
}

TEST(PlotFile, ANameThatIsTooLongIsCutBetweenCharacters) {
  const std::string name = "\u00e4\u00f6\u20ac";  // of two, two and three bytes
  for (int before = 0; before < 7; ++before) {
    ScenePlot plot;
    std::string words(static_cast<std::size_t>(before), 'x');
    while (words.size() < 120) words += name;
    plot.lines.push_back({{0, 0, 0}, words, {0, 1}});
    const std::string svg = plot_svg(plot);
    const std::size_t end = svg.find("...</text>");
    ASSERT_NE(end, std::string::npos);
    const std::size_t begin = svg.rfind('>', end) + 1;
    const std::string kept = svg.substr(begin, end - begin);
    EXPECT_EQ(words.compare(0, kept.size(), kept), 0);
    EXPECT_GT(kept.size(), 50U);
    EXPECT_NE(static_cast<unsigned char>(words[kept.size()]) & 0xC0U, 0x80U) << "before " << before;
  }
}

TEST(WordsOfAView, AreLeftOutWhereTheyWouldCoverAll) {
  Stage stage(BREVE_LOOK_FULL, 80, 48);
  const std::string world = kDark + "thing = ((new Thing) become from box). ";
  const Pixels plain = draw(stage, world);
  const Pixels words =
      draw(stage, world +
                      "thing set-label to \"box\". self set-display-text to \"text\" at-x -.9 at-y 0. graph = new "
                      "Graph. graph add-line with-color (1, 0, 0). graph add-point on-line 0 with-value 0. ");
  EXPECT_EQ(pixels_that_differ(plain, words), 0);
}

TEST(WordsOfAView, ALabelIsDrawnWhereItsPlaceIsProjected) {
  constexpr int kWidth = 640, kHeight = 400;
  Stage stage(BREVE_LOOK_PLAIN, kWidth, kHeight);
  const std::string world = kDark + "thing = ((new Thing) become from ball at (3, -2, 1)). ";
  const Pixels plain = draw(stage, world), words = draw(stage, world + "thing set-label to \"a ball\". ");
  int left = kWidth, right = 0, low = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (std::abs(brightest(plain, x, y) - brightest(words, x, y)) > 8) {
        left = std::min(left, x);
        right = std::max(right, x + 1);
        low = std::max(low, y + 1);
      }
  SceneCamera camera;
  camera.offset = {0, 0, 20};
  double seen[3];
  ASSERT_TRUE(project(lens_of(camera, double{kWidth} / kHeight), {3, 0, 1}, kWidth, kHeight, seen));
  EXPECT_NEAR((left + right) / 2.0, seen[0], 0.01 * kWidth);
  constexpr double kGap = 3;  // below the plate
  EXPECT_NEAR(low + kGap, seen[1], 0.01 * kHeight);
}

TEST(WindowsOfAView, HaveAFrameOutside) {
  Stage stage(BREVE_LOOK_FULL);
  const std::string world = kDark +
                            "eye = new Camera. eye set-size with-height 70 with-width 70. eye set-position with-x 20 "
                            "with-y 20. eye look at (0, 0, 0) from (0, 0, 20). ";
  const Pixels pixels = draw(stage, world);
  for (const int x : {19, 90}) EXPECT_GT(brightest(pixels, x, 60), 60) << x;
  for (const int x : {18, 20, 89, 91}) EXPECT_LT(brightest(pixels, x, 60), 40) << x;
}

TEST(WindowsOfAView, MayBeLargerThanAnyPictureAndAnywhere) {
  Stage stage(BREVE_LOOK_PLAIN);
  const std::string world = kDark + "thing = ((new Thing) become from box). ";
  const Pixels plain = draw(stage, world);
  const Pixels far = draw(stage, world +
                                     "eye = new Camera. eye set-size with-height 1e30 with-width 10. eye set-position "
                                     "with-x 1e30 with-y -1e30. ");
  EXPECT_EQ(pixels_that_differ(plain, far), 0);
}

TEST(SpringOfAView, IsALineOfItsPattern) {
  Stage stage(BREVE_LOOK_PLAIN);
  const auto line = [&](const std::string& pattern) {
    const Pixels pixels = draw(
        stage,
        "self set-background-color to (1, 1, 1). self point-camera at (0, 0, 0) from (0, 0, 20). thing = ((new Thing) "
        "become from ball at (-6, 0, 0)). other = ((new Thing) become from ball at (6, 0, 0)). thing enable-physics. "
        "other enable-physics. tie = ((new Spring) connect from thing to other). tie set-pattern to \"" +
            pattern + "\". ");
    int dark = 0;
    for (int x = 60; x < 100; ++x) dark += std::min(brightest(pixels, x, 59), brightest(pixels, x, 60)) < 128 ? 1 : 0;
    return dark;
  };
  EXPECT_EQ(line("----------------"), 40);
  EXPECT_EQ(line("                "), 0);
  EXPECT_NEAR(line("----    ----    "), 20, 6);
}

TEST(SpringOfAView, EndsWhereItIsAttached) {
  Stage stage(BREVE_LOOK_PLAIN);
  const Pixels pixels = draw(
      stage,
      "self set-background-color to (1, 1, 1). self point-camera at (0, 0, 0) from (0, 0, 20). thing = ((new Thing) "
      "become from box at (-6, 0, 0)). other = ((new Thing) become from box at (6, 0, 0)). tie = ((new Spring) connect "
      "from thing to other from-point (0, 3, 0) to-point (0, 3, 0)). tie set-pattern to \"----------------\". ");
  const int row = 60 - static_cast<int>(3 * 60 / (20 * std::tan(20 * std::acos(-1.0) / 180)));
  EXPECT_LT(std::min({brightest(pixels, 80, row - 1), brightest(pixels, 80, row), brightest(pixels, 80, row + 1)}),
            128);
  EXPECT_GT(brightest(pixels, 80, 60), 200);
}

TEST(ShadowsOfAView, MayBeAskedForBeforeThereIsAFloor) {
  Stage stage(BREVE_LOOK_PLAIN);
  const std::string begin =
      "self enable-lighting. self move-light to (8, 20, 2). self point-camera at (0, 0, 0) from (0, 5, 20). ";
  const std::string things = "self floor. land catch-shadows. thing = ((new Thing) become from ball). ";
  for (const std::string wish : {"self enable-shadows. ", "self enable-reflections. "}) {
    const Pixels after = draw(stage, begin + things + wish);
    EXPECT_EQ(pixels_that_differ(after, draw(stage, begin + wish + things)), 0) << wish;
    EXPECT_GT(pixels_that_differ(after, draw(stage, begin + things)), 20) << wish;
  }
}

TEST(AutomaticCamera, CutsNothingOffHoweverFastThingsSpread) {
  Scene scene;
  scene.meshes.push_back(make_sphere_mesh(1));
  scene.cameras.emplace_back().automatic = true;
  scene.instances.resize(2);
  Framing kept;
  constexpr int kWidth = 160, kHeight = 100;
  for (const float reach : {1.0F, 30.0F, 31.0F, 400.0F}) {
    for (int i = 0; i < 2; ++i) {
      SceneInstance& one = scene.instances[static_cast<std::size_t>(i)];
      one.transform.leftCols<3>() = Eigen::Matrix3f::Identity();
      one.transform.col(3) = Vector3f(i == 0 ? reach : -reach, reach / 3, 0);
    }
    const SceneCamera camera = framed(scene, scene.cameras[0], 1.6, kept);
    const Lens lens = lens_of(camera, 1.6);
    for (const SceneInstance& one : scene.instances) {
      double seen[3];
      ASSERT_TRUE(project(lens, one.transform.col(3).cast<double>(), kWidth, kHeight, seen));
      const double radius = lens.scale_at(one.transform.col(3), kHeight);
      EXPECT_GE(seen[0] - radius, 0) << reach;
      EXPECT_LE(seen[0] + radius, kWidth) << reach;
      EXPECT_GE(seen[1] - radius, 0) << reach;
      EXPECT_LE(seen[1] + radius, kHeight) << reach;
    }
  }
}

}  // namespace
}  // namespace breve::seeing
