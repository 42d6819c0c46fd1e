// Every drawing selector has its effect in the picture: two worlds run the same program, and only one uses the
// selector.
#include "selectors.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>

#include "stage.hpp"
#include "tests/library/selector_table.hpp"

namespace breve::seeing {
namespace {

constexpr int kSeen = 6;  // pixels of 19,200 that differ

void expect_effects(std::span<const Selector> selectors) {
  auto stage_kept = std::make_unique<Stage>();
  for (const Selector& one : selectors) {
    SCOPED_TRACE(one.name);
    // Motion blur is what one picture leaves to the next.
    if ((std::string(one.setup) + one.effect).find("blur") != std::string::npos) stage_kept = std::make_unique<Stage>();
    Stage& stage = *stage_kept;
    breve_program* program = stage.compile(one.setup, one.effect);
    Pixels pictures[2];
    for (int i = 0; i < 2; ++i) {
      breve_world* world = stage.open(program);
      stage.draw(world);  // motion blur mixes with it
      if (i == 1) stage.call(world, "later");
      for (int step = 0; step < one.steps; ++step) {
        stage.step(world, 1);
        pictures[i] = stage.draw(world);
      }
      if (one.steps == 0) pictures[i] = stage.draw(world);
    }
    EXPECT_GE(pixels_that_differ(pictures[0], pictures[1]), kSeen);
  }
}

TEST(DrawingSelectors, OfControlAndCameraAreSeen) { expect_effects(control_selectors()); }
TEST(DrawingSelectors, OfBodiesAreSeen) { expect_effects(body_selectors()); }
TEST(DrawingSelectors, OfImagesDrawingsLinesAndGridsAreSeen) { expect_effects(other_selectors()); }

/// Words of selectors about what is drawn. Those of the table that have one are in the lists above, or excused here.
TEST(DrawingSelectors, NoneOfTheTableIsForgotten) {
  const char* const words[] = {"color",      "transparency", "image", "texture", "bitmap",  "lightmap", "shadow",
                               "light",      "fog",          "blur",  "outline", "text",    "label",    "axis",
                               "bounding",   "lines",        "line",  "visible", "draw",    "camera",   "skybox",
                               "background", "turtle",       "pen",   "polygon", "pattern", "style"};
  const std::set<std::string> excused = {
      // Conversions, and a count of rays.
      "Control unique-color", "Control enable-light-exposure-detection", "Control disable-light-exposure-detection",
      // Whether a window draws as often as the world steps: a picture that is asked for is always drawn.
      "Control enable-draw-every-frame", "Control disable-draw-every-frame",
      // Obsolete.
      "Camera set-camera-pointer",
      // Text.
      "File read-line", "File read-line-as-whitespace-delimited-list", "File read-line-as-list", "File write-line",
      "Vector print-matlab-style", "Matrix2D print-matlab-style"};
  std::set<std::string> known;
  for (const auto list : {control_selectors(), body_selectors(), other_selectors()})
    for (const Selector& one : list) known.insert(one.name);
  std::string forgotten;
  for (const SelectorRow& row : selector_rows(BREVE_SELECTORS)) {
    const std::string padded = "-" + row.selector + "-";
    bool drawing = false;
    for (const char* word : words) drawing = drawing || padded.find("-" + std::string(word) + "-") != std::string::npos;
    const std::string name = row.cls + " " + row.selector;
    if (row.selector.starts_with("get-") || excused.contains(name)) continue;
    if (drawing && !known.contains(name)) forgotten += name + "\n";
  }
  EXPECT_EQ(forgotten, "");
}

}  // namespace
}  // namespace breve::seeing
