// State of the view: camera angles, pans, drawings, and that what is saved comes back.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "runtime/base/error.hpp"
#include "runtime/world/drawing.hpp"
#include "runtime/world/menu.hpp"
#include "runtime/world/view.hpp"

namespace breve {
namespace {

// Angles pass through asin and back: a few units in the last place of a distance of 30.
constexpr double kRoundOff = 1e-12;

template <class T>
std::uint64_t hash_of(const T& state) {
  Hasher hasher;
  state.hash(hasher);
  return hasher.value();
}

TEST(Camera, OffsetGivesTheDocumentedAngles) {
  CameraState camera;
  const Vector3 o(3, 4, 12);
  camera.set_offset(o);
  EXPECT_NEAR(camera.pitch, -std::asin(4.0 / 13.0), kRoundOff);
  EXPECT_NEAR(camera.yaw, std::asin(3.0 / (13.0 * std::cos(camera.pitch))), kRoundOff);
  camera.set_offset({3, 4, -12});
  EXPECT_NEAR(camera.yaw, std::numbers::pi - std::asin(3.0 / (13.0 * std::cos(camera.pitch))), kRoundOff);
}

TEST(Camera, AnglesGiveBackTheOffsetTheyCameFrom) {
  for (const Vector3& o : {Vector3(3, 4, 12), Vector3(-3, 4, 12), Vector3(3, -4, -12), Vector3(-3, 0, -1)}) {
    CameraState camera;
    camera.set_offset(o);
    camera.set_angles(camera.pitch, camera.yaw);
    EXPECT_NEAR((camera.offset - o).norm(), 0, 13 * kRoundOff);
  }
}

TEST(Camera, PivotKeepsTheDistanceAndZoomKeepsTheDirection) {
  CameraState camera;
  camera.set_offset({3, 4, 12});
  camera.set_angles(camera.pitch + 0.3, camera.yaw - 1);
  EXPECT_NEAR(camera.distance(), 13, 13 * kRoundOff);
  const Vector3 direction = camera.offset.normalized();
  camera.set_distance(26);
  EXPECT_NEAR((camera.offset - 26 * direction).norm(), 0, 26 * kRoundOff);
}

TEST(Camera, StraightAboveKeepsItsYaw) {
  CameraState camera;
  camera.set_offset({1, 0, 1});
  const double yaw = camera.yaw;
  camera.set_offset({0, 10, 0});
  EXPECT_EQ(camera.yaw, yaw);
  EXPECT_EQ(camera.offset, Vector3(0, 10, 0));
}

TEST(Camera, ZeroOffsetCanBeZoomedOutOfAgain) {
  CameraState camera;
  camera.set_offset({0, 0, 5});
  camera.set_offset({0, 0, 0});
  camera.set_distance(2);
  EXPECT_NEAR((camera.offset - Vector3(0, 0, 2)).norm(), 0, kRoundOff);
}

TEST(Camera, FarPlaneIsPositiveAndAtLeastOne) {
  CameraState camera;
  camera.set_far_plane(-20);
  EXPECT_EQ(camera.far_plane, 20);
  camera.set_far_plane(0.5);
  EXPECT_EQ(camera.far_plane, 1);
}

TEST(Camera, RefusesWhatIsNotFinite) {
  CameraState camera;
  const CameraState before = camera;
  EXPECT_THROW(camera.set_offset({NAN, 0, 0}), Error);
  EXPECT_THROW(camera.set_target({0, INFINITY, 0}), Error);
  EXPECT_THROW(camera.set_angles(NAN, 0), Error);
  EXPECT_THROW(camera.set_distance(-1), Error);
  EXPECT_THROW(camera.set_far_plane(NAN), Error);
  EXPECT_EQ(hash_of(camera), hash_of(before));
}

TEST(Pan, TakesEqualStepsAndLandsOnTheGoal) {
  Pan pan{{0, 0, 10}, 4};
  Vector3 at(0, 0, 2);
  for (double z : {4.0, 6.0, 8.0, 10.0}) {
    at = pan.advance(at);
    EXPECT_NEAR(at.z(), z, kRoundOff);
  }
  EXPECT_EQ(at, Vector3(0, 0, 10));
  EXPECT_EQ(pan.advance(at), at);
}

TEST(View, ComesBackFromAnImageBitForBit) {
  ViewState view;
  view.camera.set_offset({1, 2, 3});
  view.camera.watched = {7, 9};
  view.offset_pan = {{1, 1, 1}, 5};
  view.frozen = true;
  view.lights[3].diffuse = {0.5, 0, 0};
  view.fog.enabled = true;
  view.backdrop.skybox = {"a", "b"};
  view.flags.reflections = true;
  view.texts[7] = {"hello", 0.5, -0.5, {1, 0, 0}};
  view.clears = 2;
  ByteWriter out;
  view.save(out);
  ByteReader in(out.bytes().data(), out.bytes().size());
  ViewState again;
  again.load(in);
  EXPECT_EQ(in.left(), 0U);
  EXPECT_EQ(hash_of(again), hash_of(view));
  EXPECT_EQ(again.texts[7].text, "hello");
  EXPECT_NE(hash_of(ViewState{}), hash_of(view));
}

TEST(View, ACutImageIsAnError) {
  ByteWriter out;
  ViewState{}.save(out);
  for (std::size_t size : {std::size_t{0}, out.bytes().size() / 2, out.bytes().size() - 1}) {
    ByteReader in(out.bytes().data(), size);
    ViewState again;
    EXPECT_THROW(again.load(in), Error);
  }
}

TEST(Drawing, KeepsTheLastCommandsOfItsLimit) {
  DrawingResource drawing;
  drawing.set_limit(2);
  for (double z : {1.0, 2.0, 3.0}) {
    DrawCommand command{DrawCommand::Kind::PolygonPoint};
    command.vector = {0, 0, z};
    drawing.add(command);
  }
  ASSERT_EQ(drawing.commands.size(), 2U);
  EXPECT_EQ(drawing.commands.front().vector.z(), 2);
}

TEST(Drawing, LinePointsJoinUp) {
  DrawingResource drawing;
  drawing.add_line_point({1, 0, 0});
  EXPECT_EQ(drawing.commands.size(), 0U);
  drawing.add_line_point({2, 0, 0});
  ASSERT_EQ(drawing.commands.size(), 1U);
  EXPECT_EQ(drawing.commands[0].from, Vector3(1, 0, 0));
  EXPECT_EQ(drawing.commands[0].vector, Vector3(2, 0, 0));
}

TEST(Drawing, ComesBackFromAnImage) {
  DrawingResource drawing;
  drawing.set_limit(10);
  drawing.add_line_point({1, 0, 0});
  drawing.add_line_point({2, 0, 0});
  ByteWriter out;
  drawing.save(out);
  ByteReader in(out.bytes().data(), out.bytes().size());
  EXPECT_EQ(hash_of(*DrawingResource::load(in)), hash_of(drawing));
}

TEST(Drawing, StylesAreDashPatternsOfSixteen) {
  EXPECT_EQ(line_style("----------------"), 0xffff);
  EXPECT_EQ(line_style("- - "), 0x0005);
  EXPECT_EQ(line_style(""), 0);
  EXPECT_EQ(line_style("                -"), 0);
}

TEST(Menu, SeparatorsAndDisabledEntriesCannotBeChosen) {
  MenuItemResource item;
  EXPECT_TRUE(item.separator());
  EXPECT_FALSE(item.can_be_chosen());
  item.name = "Go";
  EXPECT_TRUE(item.can_be_chosen());
  item.enabled = false;
  EXPECT_FALSE(item.can_be_chosen());
}

TEST(Menu, ComesBackFromAnImage) {
  const auto item = std::make_unique<MenuItemResource>();
  item->owner = {3, 4};
  item->name = "Go";
  item->method = "go";
  item->checked = true;
  ByteWriter out;
  item->save(out);
  ByteReader in(out.bytes().data(), out.bytes().size());
  EXPECT_EQ(hash_of(*MenuItemResource::load(in)), hash_of(*item));
}

}  // namespace
}  // namespace breve
