// Many bodies in one place.
#include <gtest/gtest.h>

#include <stdexcept>

#include "runtime/render/renderer.hpp"
#include "runtime/scene/mesh.hpp"
#include "stage.hpp"

namespace breve::seeing {
namespace {

TEST(CrowdOfAView, BodiesThatStandWhereAnotherIsDrawnAreNotDrawn) {
  Stage stage;
  const auto crowd = [&stage](const char* count) {
    return stage.open(stage.compile("self point-camera at (0, 0, 0) from (0, 2, 6). for n = 0, n < " +
                                    std::string(count) +
                                    ", n++: thing = ((new Thing) become from ball at (0, 0, 0))."));
  };
  const Pixels many = stage.draw(crowd("500"));
  const std::uint64_t drawn = stage.counts().instances;
  const Pixels one = stage.draw(crowd("1"));
  EXPECT_EQ(drawn, stage.counts().instances);
  EXPECT_EQ(pixels_that_differ(one, many), 0);
}

/// Spheres in front of one another, of which every third is transparent.
Scene spheres() {
  constexpr int kCount = 300;
  Scene scene;
  scene.meshes.push_back(make_sphere_mesh(1));
  for (int i = 0; i < kCount; ++i) {
    SceneInstance one;
    one.transform.leftCols<3>() = 2 * Eigen::Matrix3f::Identity();
    one.transform.col(3) = Vector3f(0.004F * static_cast<float>(i), 0.01F * static_cast<float>(i % 7), 0);
    one.color = Vector4f(0.003F * static_cast<float>(i), 0.5F, 0.2F, i % 3 == 0 ? 0.4F : 1.0F);
    scene.instances.push_back(one);
  }
  scene.cameras.emplace_back();
  return scene;
}

TEST(CrowdOfAView, DrawnInPiecesIsTheSamePicture) {
  const Scene scene = spheres();
  render::Renderer renderer;
  Picture whole, pieces;
  renderer.paint(scene, 320, 240, whole);
  std::uint64_t units = 0, told = 0;
  renderer.set_meter([&](std::uint64_t some) {
    units += some;
    ++told;
  });
  renderer.paint(scene, 320, 240, pieces);
  EXPECT_EQ(whole.rgba, pieces.rgba);
  EXPECT_GT(told, 5U);
  EXPECT_GT(units, 300U * 1000);
}

TEST(CrowdOfAView, EndsWithWhatItsMeterThrows) {
  const Scene scene = spheres();
  render::Renderer renderer;
  renderer.set_meter([](std::uint64_t) { throw std::out_of_range("enough"); });
  Picture picture;
  EXPECT_THROW(renderer.paint(scene, 320, 240, picture), std::out_of_range);
}

}  // namespace
}  // namespace breve::seeing
