// The gallery has a picture of each sample world, and they are what `docs/gallery/draw.sh` draws.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "stage.hpp"

namespace breve::seeing {
namespace {

namespace fs = std::filesystem;

// Worlds run for a while here: bodies may lie a little elsewhere on another processor.
constexpr double kMean = 1.5;  // CIE L*a*b*

std::string picture_of(const fs::path& world) {
  std::string name = world.filename().string();
  name.replace(name.rfind('.'), 1, "_");
  return name + ".png";
}

TEST(GalleryPictures, AreOfEverySampleWorld) {
  std::ifstream in(BREVE_SOURCES "/docs/gallery.md");
  const std::string page((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  for (const auto& world : fs::directory_iterator(BREVE_SOURCES "/samples/worlds")) {
    const std::string picture = picture_of(world.path());
    EXPECT_NE(page.find("(gallery/" + picture + ")"), std::string::npos) << picture;
    EXPECT_EQ(read_png(BREVE_SOURCES "/docs/gallery/" + picture).width, 240) << picture;
  }
}

/// BREVE_DRAWN is the directory that the script drew into just now.
TEST(GalleryPictures, AreWhatTheScriptDraws) {
  const char* drawn = std::getenv("BREVE_DRAWN");
  if (!drawn) GTEST_SKIP() << "the test seeing.Gallery runs it";
  int count = 0;
  for (const auto& entry : fs::directory_iterator(BREVE_SOURCES "/docs/gallery")) {
    if (entry.path().extension() != ".png") continue;
    ++count;
    const Pixels now = read_png((fs::path(drawn) / entry.path().filename()).string());
    EXPECT_LT(difference(read_png(entry.path().string()), now).mean, kMean) << entry.path();
  }
  EXPECT_GT(count, 30);
}

}  // namespace
}  // namespace breve::seeing
