// The two broad phases look at what moves, and see all the same what is put elsewhere, scaled, added or freed.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "runtime/contact/collision_stage.hpp"
#include "runtime/dynamics/near_pairs.hpp"
#include "tests/runtime/solid_oracle.hpp"

namespace breve::broad_phase_tests {
namespace {

using Reports = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

/// Everything takes part. The order of creation is that of the places.
class Client final : public CollisionClient, public MechanicsClient {
 public:
  bool takes_part(BodyIndex) const override { return true; }
  bool reported(BodyIndex, BodyIndex) const override { return true; }
  std::uint64_t serial(BodyIndex body) const override { return body; }
  void touched(BodyIndex a, BodyIndex b, const Contact&, double) override { reports.emplace_back(a, b); }
  void work(std::uint64_t units) override { worked += units; }
  void expect(std::uint64_t) override {}
  bool handled(BodyIndex, BodyIndex) const override { return false; }
  bool ignored(BodyIndex, BodyIndex) const override { return false; }
  bool locates() const override { return false; }
  bool any_handled() const override { return false; }
  std::uint64_t rules() const override { return 0; }
  void impact(BodyIndex, BodyIndex, const Contact&, double) override {}
  Vector3 stage_force(BodyIndex, double, std::uint64_t) override { return Vector3::Zero(); }
  Reports reports;
  std::uint64_t worked = 0;
};

ObjectId owner_of(std::uint32_t number) { return {number, 1}; }

BodyIndex add(Bodies& bodies, BodyKind kind, const Vector3& location, std::shared_ptr<Shape> shape) {
  const BodyIndex body = bodies.add(kind, owner_of(static_cast<std::uint32_t>(bodies.index_end())));
  bodies.set_collision_shape(body, std::move(shape));
  bodies.set_location(body, location);
  return body;
}

class Stage {
 public:
  explicit Stage(Bodies& bodies) : bodies_(bodies), stage_(std::pmr::get_default_resource(), bodies) {}
  Reports step(bool at_impact) {
    constexpr double kStep = 0.1;
    client_.reports.clear();
    stage_.begin(client_, 1, Extent());
    bodies_.translate(kStep);
    bodies_.rotate(kStep);
    stage_.finish(client_, 0, kStep, Vector3::Zero(), at_impact);
    counters = stage_.take_counters();
    Reports found = client_.reports;
    std::sort(found.begin(), found.end());
    return found;
  }
  void forget(BodyIndex body) { stage_.forget(body); }
  CollisionStage::Counters counters;

 private:
  Bodies& bodies_;
  Client client_;
  CollisionStage stage_;
};

TEST(BroadPhase, ChangesOfShapesAreCountedWhereBodiesHaveThem) {
  Bodies one(std::pmr::get_default_resource()), other(std::pmr::get_default_resource());
  const auto shared = Shape::sphere(1), own = Shape::box(Vector3(1, 1, 1)), nobodys = Shape::sphere(1);
  add(one, BodyKind::Stationary, Vector3::Zero(), own);
  for (Bodies* bodies : {&one, &one, &other}) add(*bodies, BodyKind::Stationary, Vector3::Zero(), shared);
  {
    Bodies gone(std::pmr::get_default_resource());
    add(gone, BodyKind::Stationary, Vector3::Zero(), shared);
  }
  nobodys->set_scale(Vector3(2, 2, 2));
  EXPECT_EQ(one.shape_changes(), 0U);
  own->set_scale(Vector3(2, 2, 2));
  EXPECT_EQ(one.shape_changes(), 1U);
  EXPECT_EQ(other.shape_changes(), 0U);
  shared->set_scale(Vector3(3, 3, 3));
  EXPECT_EQ(one.shape_changes(), 2U);
  EXPECT_EQ(other.shape_changes(), 1U);
}

TEST(BroadPhase, OfTenThousandBodiesThatStandNoneIsLookedAt) {
  Bodies bodies(std::pmr::get_default_resource());
  const auto box = Shape::box(Vector3(1, 1, 1)), ball = Shape::sphere(0.3);
  for (int i = 0; i < 10000; ++i) add(bodies, BodyKind::Stationary, Vector3(1.5 * (i % 100), 0, 1.5 * (i / 100)), box);
  for (int i = 0; i < 10; ++i)
    bodies.set_velocity(add(bodies, BodyKind::Mobile, Vector3(3 * i, 1, 3), ball), Vector3(1, 0, 0));
  Stage stage(bodies);
  stage.step(true);
  EXPECT_GE(stage.counters.boxes, 10010U);
  for (int i = 0; i < 5; ++i) {
    stage.step(true);
    EXPECT_LE(stage.counters.boxes, 20U) << "the ten that move, as such and as those that did";
  }
}

TEST(BroadPhase, OfBodiesThatStandDynamicsLooksAtNoneEither) {
  Bodies bodies(std::pmr::get_default_resource());
  const auto box = Shape::box(Vector3(1, 1, 1)), ball = Shape::sphere(0.3);
  for (int i = 0; i < 10000; ++i) add(bodies, BodyKind::Stationary, Vector3(1.5 * (i % 100), 0, 1.5 * (i / 100)), box);
  for (int i = 0; i < 10; ++i) bodies.set_physics(add(bodies, BodyKind::Mobile, Vector3(3 * i, 1, 3), ball), true);
  NearPairs near(std::pmr::get_default_resource());
  const Client client;
  const auto update = [&] {
    near.update(bodies, client, Vector3(0, -10, 0), 0.1, 1, false, NearPairs::kNoMost, WorkBound{},
                [](PairKey& key) { key.pushes = true; });
  };
  const auto pairs = [&] {
    std::size_t count = 0;
    near.each([&](const PairKey&, const NearPair&) { ++count; });
    return count;
  };
  update();
  std::uint64_t before = near.boxes();
  EXPECT_GE(before, 10010U);
  for (int i = 0; i < 5; ++i) update();
  EXPECT_EQ(near.boxes() - before, 50U);
  const std::size_t near_before = pairs();
  // A wall that grows, and one that is put elsewhere, are seen.
  const auto wall = Shape::box(Vector3(1, 1, 1));
  const BodyIndex grown = add(bodies, BodyKind::Stationary, Vector3(-5, 1, 3), wall);
  const BodyIndex put = add(bodies, BodyKind::Stationary, Vector3(-50, 1, 3), wall);
  update();
  EXPECT_EQ(pairs(), near_before);
  EXPECT_EQ(near.find(grown, 10000), nullptr);
  wall->set_scale(Vector3(11, 1, 1));
  update();
  EXPECT_NE(near.find(grown, 10000), nullptr);
  EXPECT_EQ(near.find(put, 10009), nullptr);
  before = near.boxes();
  bodies.set_location(put, Vector3(27, 1, 3));
  update();
  EXPECT_NE(near.find(put, 10009), nullptr);
  EXPECT_EQ(near.boxes() - before, 11U);
}

TEST(BroadPhase, AGroundWhoseHeightsChangeIsSeen) {
  Bodies bodies(std::pmr::get_default_resource());
  const auto ground = Shape::height_field(20, 20, 1, std::vector<double>(400, 0.0));
  const BodyIndex low = add(bodies, BodyKind::Stationary, Vector3::Zero(), ground);
  const BodyIndex ball = add(bodies, BodyKind::Mobile, Vector3(0, 10, 0), Shape::sphere(0.3));
  bodies.set_physics(ball, true);
  NearPairs near(std::pmr::get_default_resource());
  const Client client;
  const auto update = [&] {
    near.update(bodies, client, Vector3(0, -10, 0), 0.1, 1, false, NearPairs::kNoMost, WorkBound{},
                [](PairKey& key) { key.pushes = true; });
  };
  update();
  EXPECT_EQ(near.find(low, ball), nullptr);
  for (int c = 8; c < 12; ++c)
    for (int r = 8; r < 12; ++r) ground->set_height(c, r, 9.8);
  update();
  EXPECT_NE(near.find(low, ball), nullptr);
}

/// What a script may do to bodies between sub-steps.
void disturb(Bodies& bodies, Stage& stage, oracle::Dice& dice, std::span<const std::shared_ptr<Shape>> shapes) {
  const auto some = [&] {
    BodyIndex body;
    do body = static_cast<BodyIndex>(dice.between(0, static_cast<double>(bodies.index_end()) - 0.001));
    while (!bodies.used(body));
    return body;
  };
  const BodyIndex body = some();
  const bool mobile = bodies.kind(body) == BodyKind::Mobile;
  switch (static_cast<int>(dice.between(0, 8))) {
    case 0: bodies.set_location(body, dice.vector(6)); break;
    case 1: bodies.set_orientation(body, dice.rotation()); break;
    case 2: bodies.set_collision_shape(body, shapes[static_cast<std::size_t>(dice.between(0, 2.99))]); break;
    case 3:
      shapes[static_cast<std::size_t>(dice.between(0, 2.99))]->set_scale(dice.vector(1).cwiseAbs() +
                                                                         Vector3::Constant(0.3));
      break;
    case 4:
    case 5:
      if (mobile) bodies.set_velocity(body, dice.between(0, 1) < 0.5 ? Vector3(Vector3::Zero()) : dice.vector(6));
      break;
    case 6:
      if (mobile)
        bodies.set_rotational_velocity(body, dice.between(0, 1) < 0.5 ? Vector3(Vector3::Zero()) : dice.vector(3));
      break;
    default:
      if (dice.between(0, 1) < 0.5 && bodies.size() > 30) {
        stage.forget(body);
        bodies.remove(body);
      } else if (bodies.index_end() < 90) {
        add(bodies, mobile ? BodyKind::Mobile : BodyKind::Stationary, dice.vector(6), shapes[0]);
      }
  }
}

TEST(BroadPhase, WhateverIsDoneToBodiesOneThatIsMadeAnewSeesTheSame) {
  oracle::Dice dice(96);
  std::size_t reports = 0;
  for (int run = 0; run < 20; ++run) {
    Bodies bodies(std::pmr::get_default_resource());
    const std::shared_ptr<Shape> shapes[] = {Shape::box(Vector3(1, 1, 1)), Shape::sphere(0.6), Shape::cone(5, 1, 0.5)};
    for (int i = 0; i < 60; ++i)
      add(bodies, i % 2 == 0 ? BodyKind::Mobile : BodyKind::Stationary, dice.vector(6), shapes[i % 3]);
    Stage stage(bodies);
    for (int step = 0; step < 60; ++step) {
      for (int i = 0; i < 3; ++i) disturb(bodies, stage, dice, shapes);
      const Reports kept = stage.step(false);
      // All pairs that overlap now, by the exact distances.
      Reports exact;
      for (BodyIndex a = 0; a < bodies.index_end(); ++a)
        for (BodyIndex b = a + 1; b < bodies.index_end(); ++b) {
          if (!bodies.used(a) || !bodies.used(b)) continue;
          if (bodies.kind(a) != BodyKind::Mobile && bodies.kind(b) != BodyKind::Mobile) continue;
          const Pose pa{bodies.location(a), bodies.orientation(a)}, pb{bodies.location(b), bodies.orientation(b)};
          const Shape &x = *bodies.collision_shape(a), &y = *bodies.collision_shape(b);
          if (closest(x, pa, y, pb).distance <= touch_tolerance(x, pa, y, pb)) exact.emplace_back(a, b);
        }
      ASSERT_EQ(kept, exact) << "run " << run << ", sub-step " << step;
      reports += kept.size();
    }
  }
  EXPECT_GT(reports, 2000U);
}

}  // namespace
}  // namespace breve::broad_phase_tests
