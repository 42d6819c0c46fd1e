// What a script has drawn counts by what is in the picture: the budget ends it, as it ends a loop.
#include <breve/breve.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace breve::seeing {
namespace {

bool open_nothing(void*, breve_world*, const char*, bool, breve_file* file, breve_write_fn, void*) {
  file->write = [](void*, const void*, std::size_t) { return true; };
  file->close = [](void*, bool) { return true; };
  return true;
}

/// A world with a budget calls a method that makes something so many times, then one that draws.
breve_status draw_with(std::uint64_t budget, int times, const std::string& make, const std::string& draw) {
  breve_runtime_config files = breve_runtime_config_default();
  files.files.open_for_writing = open_nothing;
  breve_runtime* made_runtime = nullptr;
  EXPECT_EQ(breve_runtime_create(&files, &made_runtime), BREVE_OK);
  const std::unique_ptr<breve_runtime, decltype(&breve_runtime_destroy)> runtime(made_runtime, breve_runtime_destroy);
  const std::string text =
      "@use Control. @use Graph. @use Drawing.\nController Show.\nControl : Show {\n"
      "  + variables: graph, drawing (object). n, end (int).\n"
      "  + to init: graph = new Graph. drawing = new Drawing.\n  + to make: " +
      make + "\n  + to draw: " + draw + "\n}\n";
  breve_program* made_program = nullptr;
  EXPECT_EQ(breve_program_compile(runtime.get(), "show.tz", text.data(), text.size(), &made_program), BREVE_OK)
      << breve_runtime_last_error(runtime.get())->text;
  const std::unique_ptr<breve_program, decltype(&breve_program_destroy)> program(made_program, breve_program_destroy);
  breve_world_config config = breve_world_config_default();
  config.budget = budget;
  breve_world* made_world = nullptr;
  EXPECT_EQ(breve_world_create(runtime.get(), program.get(), &config, &made_world), BREVE_OK);
  const std::unique_ptr<breve_world, decltype(&breve_world_destroy)> world(made_world, breve_world_destroy);
  const breve_object controller = breve_world_controller(world.get());
  for (int i = 0; i < times; ++i)
    EXPECT_EQ(breve_object_call(world.get(), controller, "make", nullptr, 0, nullptr), BREVE_OK);
  return breve_object_call(world.get(), controller, "draw", nullptr, 0, nullptr);
}

// A thousand more; of a graph with two points each, across the whole plot.
constexpr const char* kLines =
    "end = n + 1000. for n = n, n < end, n++: { graph add-line with-color (1, 0, 0). graph add-point on-line n "
    "with-value 0. graph add-point on-line n with-value 1. }";
constexpr const char* kDrawn =
    "end = n + 1000. for n = n, n < end, n++: drawing draw-line from (-10, n % 7 - 3, 0) to (10, n % 5 - 2, 1).";

TEST(BudgetOfPictures, APlotCountsItsLinesAndItsTableItsCells) {
  for (const char* name : {"plot.png", "plot.svg", "plot.csv"}) {
    const std::string write = std::string("graph write to \"") + name + "\".";
    EXPECT_EQ(draw_with(100'000, 40, kLines, write), BREVE_ERROR_BUDGET) << name;
    EXPECT_EQ(draw_with(5'000'000, 1, kLines, write), BREVE_OK) << name;
  }
  EXPECT_EQ(draw_with(5'000'000, 20, kLines, "graph write to \"plot.png\"."), BREVE_ERROR_BUDGET);
  // A row for each of the longest line's values, with a cell for each line.
  EXPECT_EQ(draw_with(5'000'000, 5, kLines,
                      "for n = 0, n < 5000, n++: graph add-point on-line 0 with-value n. graph write to \"plot.csv\"."),
            BREVE_ERROR_BUDGET);
}

TEST(BudgetOfPictures, APictureCountsItsLinesAndPlots) {
  const std::string save = "self save-snapshot to \"picture.png\".";
  for (const char* make : {kLines, kDrawn}) {
    EXPECT_EQ(draw_with(5'000'000, 1, make, save), BREVE_OK) << make;
    EXPECT_EQ(draw_with(5'000'000, 50, make, save), BREVE_ERROR_BUDGET) << make;
  }
}

}  // namespace
}  // namespace breve::seeing
