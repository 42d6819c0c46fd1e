// Space that wraps or ends at walls: places, offsets, neighbours, motion, images of the world.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/base/error.hpp"
#include "runtime/base/random.hpp"
#include "runtime/space/neighbors.hpp"
#include "runtime/world/world.hpp"

namespace breve {
namespace {

Vector3 random_position(Random& random, double size) {
  return {size * random.uniform(), size * random.uniform(), size * random.uniform()};
}

TEST(Extent, WrapsAnyPlaceIntoItsBounds) {
  Extent space;
  space.set(0, Ending::Wrap, -2, 3);
  EXPECT_EQ(space.inside({-2, 9, 9}), Vector3(-2, 9, 9));
  EXPECT_EQ(space.inside({3, 0, 0}), Vector3(-2, 0, 0));
  EXPECT_EQ(space.inside({-2.5, 0, 0}), Vector3(2.5, 0, 0));
  EXPECT_EQ(space.inside({13.5, 0, 0}), Vector3(-1.5, 0, 0));
  Random random(1);
  for (int i = 0; i < 10000; ++i) {
    const double x = std::ldexp(random.uniform() - 0.5, static_cast<int>(random.below(60)) - 20);
    const Vector3 position = space.inside({x, 0, 0});
    EXPECT_TRUE(space.holds(position)) << x;
    if (std::abs(x) < 1e6) {
      EXPECT_NEAR(std::remainder(position.x() - x, 5.0), 0, 1e-9) << x;
    }
  }
  EXPECT_TRUE(space.holds(space.inside({std::nextafter(-2.0, -3.0), 0, 0})));
}

TEST(Extent, WallsReflectAsOftenAsNeeded) {
  Extent space;
  space.set(1, Ending::Wall, 0, 10);
  const auto thrown = [&](double y, double v) {
    Vector3 location(0, y, 0), velocity(1, v, 1);
    space.bring_inside(location, velocity);
    return std::pair(location.y(), velocity.y());
  };
  EXPECT_EQ(thrown(10.5, 3), std::pair(9.5, -3.0));
  EXPECT_EQ(thrown(-4, -3), std::pair(4.0, 3.0));
  EXPECT_EQ(thrown(23, 3), std::pair(3.0, 3.0));
  EXPECT_EQ(thrown(-13, -3), std::pair(7.0, -3.0));
  EXPECT_EQ(thrown(10, 3), std::pair(10.0, 3.0)) << "a wall itself is inside";
  EXPECT_TRUE(space.holds({1e9, 10, -1e9}));
}

TEST(Extent, OffsetsAreTheShortestAndTheWayBackIsTheOpposite) {
  Extent space;
  space.set(0, Ending::Wrap, 0, 10);
  space.set(2, Ending::Wall, 0, 10);
  EXPECT_EQ(space.offset({9, 1, 9}, {1, 2, 1}), Vector3(2, 1, -8));
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 a = random_position(random, 10), b = random_position(random, 10);
    const Vector3 way = space.offset(a, b);
    EXPECT_EQ(way, -space.offset(b, a));
    EXPECT_LE(std::abs(way.x()), 5.0);
  }
}

TEST(Extent, RefusesWhatIsNoBounds) {
  Extent space;
  EXPECT_THROW(space.set(3, Ending::Wrap, 0, 1), Error);
  EXPECT_THROW(space.set(0, Ending::Wrap, 1, 1), Error);
  EXPECT_THROW(space.set(0, Ending::Wall, 0, std::nan("")), Error);
  EXPECT_THROW(space.set(0, Ending::Wall, -std::numeric_limits<double>::max(), std::numeric_limits<double>::max()),
               Error);
  EXPECT_TRUE(space.open());
}

TEST(Neighbors, AcrossEdgesAreThoseByTheShortestOffset) {
  constexpr double kSize = 20;
  Random random(3);
  for (const int axes : {1, 2, 3}) {
    Extent space;
    for (int axis = 0; axis < axes; ++axis) space.set(axis, Ending::Wrap, 0, kSize);
    for (const double radius : {0.5, 3.0, 12.0, 50.0}) {
      Neighbors neighbors(std::pmr::get_default_resource());
      std::vector<Vector3> points;
      for (int i = 0; i < 200; ++i) {
        points.push_back(random_position(random, kSize));
        neighbors.add(points.back(), i % 7 == 0 ? 0.5 * radius : radius, 1000U + static_cast<unsigned>(i));
      }
      neighbors.close(space);
      ASSERT_EQ(neighbors.size(), points.size());
      for (int round = 0; round < 2; ++round) {  // the second is answered from what is kept
        for (std::uint32_t i = 0; i < points.size(); ++i) {
          std::vector<std::uint32_t> expected;
          for (std::uint32_t j = 0; j < points.size(); ++j)
            if (i != j && space.offset(points[i], points[j]).norm() < neighbors.radii()[i]) expected.push_back(j);
          const auto found = neighbors.query(i);
          ASSERT_TRUE(std::equal(found.points.begin(), found.points.end(), expected.begin(), expected.end()))
              << axes << " axes, radius " << radius << ", point " << i;
          for (std::size_t k = 0; k < expected.size(); ++k) ASSERT_EQ(found.labels[k], 1000U + expected[k]);
        }
      }
    }
  }
}

struct Moving {
  World world{std::pmr::get_default_resource()};
  std::vector<ObjectId> all;
  ObjectId add(const Vector3& location, const Vector3& velocity) {
    const ObjectId id = world.create(1, 0, false, false);
    world.embody(id, BodyKind::Mobile);
    world.bodies().set_location(world.body(id), location);
    world.bodies().set_velocity(world.body(id), velocity);
    world.bodies().set_neighborhood_size(world.body(id), 2);
    all.push_back(id);
    return id;
  }
  const Vector3& place(ObjectId id) { return world.bodies().location(world.body(id)); }
  std::uint64_t bounds_calls() { return world.effects()[EffectId::Bounds].calls; }
};

TEST(Space, BodiesThatMoveStayInsideAndAWorldWithoutBoundsHasNoStage) {
  Moving open;
  open.add({0, 0, 0}, {1, 0, 0});
  open.world.step();
  open.world.advance_bodies();
  EXPECT_EQ(open.bounds_calls(), 0U);
  EXPECT_FALSE(open.world.effects()[EffectId::Bounds].active);

  Moving m;
  m.world.set_space(0, Ending::Wrap, 0, 10);
  m.world.set_space(1, Ending::Wall, 0, 10);
  m.world.set_iteration_step(0.06);
  const ObjectId id = m.add({9.9, 9.9, 0}, {3, 4, 5});
  m.world.advance_bodies();
  EXPECT_NEAR(m.place(id).x(), 0.08, 1e-12);
  EXPECT_NEAR(m.place(id).y(), 9.86, 1e-12);
  EXPECT_NEAR(m.place(id).z(), 0.3, 1e-12);
  EXPECT_EQ(m.world.bodies().velocity(m.world.body(id)), Vector3(3, -4, 5));
  EXPECT_TRUE(m.world.effects()[EffectId::Bounds].active);
  EXPECT_EQ(m.bounds_calls(), 3U) << "once a sub-step";
}

TEST(Space, ABodyWithPhysicsWrapsAndGoesOnFalling) {
  Moving m;
  m.world.set_space(1, Ending::Wrap, 0, 10);
  m.world.set_gravity({0, -10, 0});
  const ObjectId id = m.add({0, 0.5, 0}, {0, 0, 0});
  m.world.bodies().set_physics(m.world.body(id), true);
  for (int i = 0; i < 100; ++i) m.world.advance_bodies();
  // 6 s of free fall: 180 m down from 0.5, wrapped every 10; the velocity knows nothing of it.
  EXPECT_NEAR(m.world.bodies().velocity(m.world.body(id)).y(), -60, 1e-6);
  EXPECT_NEAR(std::remainder(m.place(id).y() - (0.5 - 180), 10.0), 0, 0.7) << "up to the error of the rung";
  EXPECT_TRUE(m.world.space().holds(m.place(id)));
}

TEST(Space, IsInTheHashAndInTheImage) {
  Moving m, other;
  for (Moving* one : {&m, &other}) {
    one->world.set_space(0, Ending::Wrap, 0, 10);
    one->world.set_space(2, Ending::Wall, -1, 1);
    Random random(4);
    for (int i = 0; i < 40; ++i)
      one->add(random_position(random, 1) * 10, random_position(random, 20) - Vector3(10, 10, 10));
    for (int i = 0; i < 20; ++i) one->world.advance_bodies();
    one->world.update_neighbors();
  }
  EXPECT_EQ(m.world.hash(), other.world.hash());
  const auto image = m.world.save(0);
  other.world.set_space(0, Ending::Wrap, 0, 11);
  EXPECT_NE(m.world.hash(), other.world.hash());
  other.world.load(image.data(), image.size(), 0);
  EXPECT_EQ(m.world.hash(), other.world.hash());
  for (const ObjectId id : m.all) EXPECT_EQ(m.world.neighbors(id), other.world.neighbors(id));
  for (Moving* one : {&m, &other})
    for (int i = 0; i < 50; ++i) one->world.advance_bodies();
  EXPECT_EQ(m.world.hash(), other.world.hash());
  EXPECT_TRUE(std::all_of(m.all.begin(), m.all.end(), [&](ObjectId id) { return m.world.space().holds(m.place(id)); }));
}

}  // namespace
}  // namespace breve
