// Saving, loading and hashing a world: go on equals load and go on, and a damaged image changes nothing.
#include <gtest/gtest.h>

#include <limits>

#include "tests/runtime/fake_behaviour.hpp"

namespace breve {
namespace {

using testing::Scene;

constexpr std::uint64_t kFingerprint = 0xfeedULL;

/// Native data that shares a shape with bodies.
class ShapeHolder final : public Resource {
 public:
  explicit ShapeHolder(std::shared_ptr<Shape> shape) : shape_(std::move(shape)) {}
  std::string_view kind() const override { return "holder"; }
  void save(ByteWriter& out) const override { out.put_shared(shape_); }
  void hash(Hasher& hasher) const override { shape_->hash(hasher); }
  static std::unique_ptr<Resource> load(ByteReader& in) {
    return std::make_unique<ShapeHolder>(in.get_shared<Shape>());
  }
  const std::shared_ptr<Shape>& shape() const { return shape_; }

 private:
  std::shared_ptr<Shape> shape_;
};

/// A world with something of everything. `populate` is false for one that is to be loaded into.
struct Everything : Scene {
  explicit Everything(bool populate = true) : Scene(populate ? 42 : 7) {
    script.recording = false;
    world.add_resource_kind("holder", &ShapeHolder::load);
    script.on_scheduled = [this](ObjectId id, std::string_view) {
      if (world.has_body(id)) set_velocity(id, Vector3(world.random().gauss(), 1, 0));
      ++script.state;
    };
    script.on_collided = [this](ObjectId me, ObjectId other, const Vector3&, const Vector3& normal) {
      const double approach = (velocity(me) - velocity(other)).dot(normal);
      if (approach < 0) set_velocity(me, velocity(me) - 2 * approach * normal);
      if (world.random().uniform() < 0.02) world.release(other);
      return false;
    };
    script.on_notified = [this](ObjectId, std::string_view) { script.state += 3; };
    script.on_iterate = [this](ObjectId id) {
      if (id.index == 0) {
        world.advance_bodies();
        world.update_neighbors();
        world.announce(id, "tick");
      } else {
        script.state = script.state * 31 + world.neighbors(id).size();
      }
    };
    if (populate) fill();
  }
  void fill() {
    Random& r = world.random();
    const auto shared = Shape::sphere(0.6);
    const ObjectId holder = world.create(9, 0, false, false);
    world.attach(holder, std::make_unique<ShapeHolder>(shared));
    for (std::uint32_t i = 0; i < 40; ++i) {
      const ObjectId id = world.create(1 + i % 2, i, true, false);
      world.embody(id, BodyKind::Mobile);
      const BodyIndex b = world.body(id);
      Bodies& bodies = world.bodies();
      bodies.set_location(b, Vector3(r.uniform(), r.uniform(), r.uniform()) * 8);
      bodies.set_velocity(b, Vector3(r.gauss(), r.gauss(), r.gauss()) * 3);
      bodies.set_neighborhood_size(b, 1 + r.uniform());
      if (i % 3 == 0) bodies.set_collision_shape(b, shared);
      if (i % 4 == 0) bodies.set_rotational_velocity(b, Vector3(1, r.gauss(), 0));
      if (i % 5 == 0) bodies.set_collision_shape(b, Shape::box(Vector3(1, 1.5, 0.5)));
      if (i % 10 == 1) bodies.set_physics(b, true);
      if (i % 7 == 0) bodies.material(b).friction = 0.5;
      if (i % 6 == 0) bodies.appearance(b).label = "a label that is not short at all";
      world.schedule(id, "kick", 0.1 + 0.03 * i, i % 2 == 0 ? 0.2 : 0);
      world.observe(id, controller, "tick", "ticked");
    }
    world.handle_collisions(1, 2, "hit", holder);
    world.handle_collisions(1, 1, "hit", holder);
    world.ignore_collisions(2, 2);
    for (const ObjectId id : world.objects()) {
      if (id.index % 9 == 5) world.release(id);
    }
    world.queue_input({InputEvent::Kind::KeyDown, "q", {}});
  }
};

TEST(Snapshot, SaveAndGoOnEqualsLoadAndGoOnAtEveryStep) {
  Everything live;
  for (int i = 0; i < 50; ++i) {
    const auto image = live.world.save(kFingerprint);
    Everything twin(false);
    twin.world.load(image.data(), image.size(), kFingerprint);
    ASSERT_EQ(twin.world.hash(), live.world.hash()) << i;
    ASSERT_EQ(twin.world.save(kFingerprint), image) << i;
    twin.world.step();
    live.world.step();
    ASSERT_EQ(twin.world.hash(), live.world.hash()) << i;
  }
}

TEST(Snapshot, TakingOneChangesNothingAndFiftyStepsLaterBothAreEqual) {
  Everything live, plain;
  for (int i = 0; i < 10; ++i) {
    live.world.step();
    plain.world.step();
  }
  const auto image = live.world.save(kFingerprint);
  Everything twin(false);
  twin.world.load(image.data(), image.size(), kFingerprint);
  for (int i = 0; i < 50; ++i) {
    live.world.step();
    plain.world.step();
    twin.world.step();
    ASSERT_EQ(live.world.hash(), plain.world.hash());
    ASSERT_EQ(live.world.hash(), twin.world.hash());
  }
}

TEST(Snapshot, SharedShapesStaySharedBetweenBodiesAndResources) {
  Everything live;
  const auto image = live.world.save(kFingerprint);
  Everything twin(false);
  twin.world.load(image.data(), image.size(), kFingerprint);
  const ObjectId holder = twin.world.objects()[1];
  const auto* resource = static_cast<const ShapeHolder*>(twin.world.resource(holder));
  ASSERT_NE(resource, nullptr);
  int sharing = 0;
  for (const ObjectId id : twin.world.objects()) {
    if (twin.world.has_body(id))
      sharing += twin.world.bodies().collision_shape(twin.world.body(id)) == resource->shape();
  }
  EXPECT_GT(sharing, 5);
}

TEST(Snapshot, EveryTruncationIsAnErrorAndChangesNothing) {
  Everything live;
  live.world.step();
  const auto image = live.world.save(kFingerprint);
  Everything target;
  const std::uint64_t before = target.world.hash();
  for (std::size_t size = 0; size < image.size(); size += size < 200 ? 1 : 37) {
    EXPECT_THROW(target.world.load(image.data(), size, kFingerprint), Error) << size;
  }
  EXPECT_EQ(target.world.hash(), before);
  target.world.step();
}

TEST(Snapshot, EveryFlippedBitIsAnErrorAndChangesNothing) {
  Everything live;
  live.world.step();
  auto image = live.world.save(kFingerprint);
  Everything target;
  const std::uint64_t before = target.world.hash();
  Random r(1);
  for (int i = 0; i < 3000; ++i) {
    const std::size_t at = i < 320 ? static_cast<std::size_t>(i / 8) : static_cast<std::size_t>(r.below(image.size()));
    const auto mask = static_cast<std::uint8_t>(1U << (i % 8));
    image[at] = static_cast<std::uint8_t>(image[at] ^ mask);
    EXPECT_THROW(target.world.load(image.data(), image.size(), kFingerprint), Error) << at;
    image[at] = static_cast<std::uint8_t>(image[at] ^ mask);
  }
  EXPECT_EQ(target.world.hash(), before);
}

TEST(Snapshot, DamageUnderARightChecksumNeverCrashes) {
  Everything live;
  for (int i = 0; i < 3; ++i) live.world.step();
  const auto image = live.world.save(kFingerprint);
  constexpr std::size_t kHeader = 8 + 4 + 8 + 8 + 8, kChecksumAt = kHeader - 8;
  Random r(5);
  int loaded = 0;
  for (int i = 0; i < 3000; ++i) {
    auto damaged = image;
    for (int k = 0; k < 3; ++k) {
      const std::size_t at = kHeader + static_cast<std::size_t>(r.below(image.size() - kHeader));
      damaged[at] = static_cast<std::uint8_t>(r.next());
    }
    Hasher hasher;
    hasher.add(std::string_view(reinterpret_cast<const char*>(damaged.data()) + kHeader, damaged.size() - kHeader));
    const std::uint64_t sum = hasher.value();
    std::memcpy(damaged.data() + kChecksumAt, &sum, sizeof sum);
    Everything target(false);
    try {
      target.world.load(damaged.data(), damaged.size(), kFingerprint);
      ++loaded;
      target.world.hash();
      target.world.save(kFingerprint);
    } catch (const Error&) {
    }
  }
  EXPECT_GT(loaded, 0) << "most bytes are plain numbers";
}

TEST(Snapshot, AForeignImageIsRefused) {
  Everything live;
  const auto image = live.world.save(kFingerprint);
  EXPECT_THROW(live.world.load(image.data(), image.size(), kFingerprint + 1), Error);
  World bare(std::pmr::new_delete_resource());
  EXPECT_THROW(bare.load(image.data(), image.size(), kFingerprint), Error) << "no loaders, no script side";
}

TEST(Snapshot, IsRefusedInsideAStep) {
  Everything live;
  live.script.on_iterate = [&](ObjectId) {
    EXPECT_THROW(live.world.save(kFingerprint), Error);
    EXPECT_THROW(live.world.load(nullptr, 0, kFingerprint), Error);
  };
  live.world.step();
}

TEST(Snapshot, AScriptSideThatCannotReadItsPartLeavesTheWorldAsItWas) {
  class Picky : public testing::FakeBehaviour {
   public:
    void load(ByteReader&) override { ByteReader::fail(); }
  };
  Everything live;
  const auto image = live.world.save(kFingerprint);
  Everything target;
  Picky picky;
  target.world.set_behaviour(&picky);
  const std::uint64_t before = target.world.hash();
  EXPECT_THROW(target.world.load(image.data(), image.size(), kFingerprint), Error);
  EXPECT_EQ(target.world.hash(), before);
  target.world.set_behaviour(&target.script);
  target.world.step();
}

TEST(Hash, TellsWorldsApartThatDifferInOneThing) {
  const std::function<void(Everything&)> changes[] = {
      [](Everything& e) { e.world.random().next(); },
      [](Everything& e) { e.world.set_iteration_step(0.1); },
      [](Everything& e) { e.world.schedule(e.controller, "m", 9); },
      [](Everything& e) { e.world.observe(e.controller, e.controller, "a", "b"); },
      [](Everything& e) { e.world.handle_collisions(2, 2, "m", {}); },
      [](Everything& e) { e.world.set_gravity(Vector3(0, -1, 0)); },
      [](Everything& e) { e.world.set_impact_timing(false); },
      [](Everything& e) { e.world.set_exact_schedule(true); },
      [](Everything& e) { e.world.set_stable_schedule(true); },
      [](Everything& e) {
        e.world.queue_input({InputEvent::Kind::KeyUp, "z", {}});
      },
      [](Everything& e) { e.world.request_end(); },
      [](Everything& e) { e.world.create(1, 0, false, false); },
      [](Everything& e) { e.world.update_neighbors(); },
      [](Everything& e) { e.world.bodies().appearance(4).alpha = 0.5; },
      [](Everything& e) { e.world.bodies().material(4).restitution = 0.5; },
      [](Everything& e) { e.world.bodies().set_force(4, Vector3(1, 0, 0)); },
      [](Everything& e) { e.world.view().fog.enabled = true; },
      [](Everything& e) { e.script.state = 99; }};
  const std::uint64_t plain = Everything().world.hash();
  EXPECT_EQ(Everything().world.hash(), plain);
  for (std::size_t i = 0; i < std::size(changes); ++i) {
    Everything changed;
    changes[i](changed);
    EXPECT_NE(changed.world.hash(), plain) << i;
  }
}

TEST(Snapshot, LoadingGivesBackAllMemoryInTheEnd) {
  MemoryMeter memory;
  {
    World world(&memory);
    const ObjectId id = world.create(1, 0, false, false);
    world.embody(id, BodyKind::Mobile);
    const auto image = world.save(0);
    for (int i = 0; i < 10; ++i) world.load(image.data(), image.size(), 0);
    EXPECT_TRUE(world.has_body(id));
  }
  EXPECT_EQ(memory.used(), 0U);
}

}  // namespace
}  // namespace breve
