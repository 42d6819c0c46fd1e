// Neighbours against trying all pairs, in worlds of every shape; and the structures behind them.
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/space/box_tree.hpp"
#include "tests/runtime/fake_behaviour.hpp"

namespace breve {
namespace {

using testing::Scene;

struct Crowd {
  const char* name;
  std::function<Vector3(Random&, int)> position;
  std::function<double(Random&, int)> radius;
};

Vector3 in_cube(Random& r, double side) {
  const double x = r.uniform(), y = r.uniform(), z = r.uniform();
  return Vector3(x, y, z) * side;
}

const Crowd kCrowds[] = {
    {"uniform", [](Random& r, int) -> Vector3 { return in_cube(r, 10); }, [](Random&, int) { return 1.0; }},
    {"flat", [](Random& r, int) -> Vector3 { return Vector3(r.uniform() * 30, r.uniform() * 30, 0); },
     [](Random& r, int) { return 0.5 + r.uniform(); }},
    {"clumps", [](Random& r, int i) -> Vector3 { return Vector3(1000.0 * (i % 4), 0, 0) + in_cube(r, 0.1); },
     [](Random&, int) { return 0.02; }},
    {"wide", [](Random& r, int) -> Vector3 { return in_cube(r, 1e6); }, [](Random&, int) { return 9e4; }},
    {"wide with tiny radius", [](Random& r, int) -> Vector3 { return in_cube(r, 1e6); },
     [](Random&, int) { return 1e-5; }},
    {"all sizes", [](Random& r, int) -> Vector3 { return in_cube(r, 100); },
     [](Random& r, int) { return std::pow(10.0, -6 + 9 * r.uniform()); }},
    {"crowd just out of reach",
     [](Random& r, int i) -> Vector3 {
       return i % 2 == 0 ? in_cube(r, 1e-3) : Vector3(Vector3(1.5, 0, 0) + in_cube(r, 0.3));
     },
     [](Random&, int i) { return i % 2 == 0 ? 1e-4 : 1.2; }},
    {"lattice at the radius exactly", [](Random&, int i) -> Vector3 { return Vector3(i % 10, i / 10 % 10, i / 100); },
     [](Random&, int) { return 1.0; }},
    {"one place", [](Random&, int) -> Vector3 { return Vector3(3, 3, 3); },
     [](Random&, int i) { return i % 7 == 0 ? 1.0 : 0.0; }},
    {"far away", [](Random& r, int) -> Vector3 { return Vector3(1e15, -1e15, 1e300) + in_cube(r, 10); },
     [](Random&, int) { return 3.0; }}};

TEST(Neighbors, EqualTheBruteForceAnswerInEveryKindOfCrowd) {
  for (const Crowd& crowd : kCrowds) {
    Scene s(5);
    constexpr int kAgents = 1000;
    std::vector<ObjectId> ids;
    for (int i = 0; i < kAgents; ++i) {
      ids.push_back(s.body(1, crowd.position(s.world.random(), i)));
      s.world.bodies().set_neighborhood_size(s.world.body(ids.back()), crowd.radius(s.world.random(), i));
    }
    s.world.update_neighbors();
    for (const ObjectId a : ids) {
      std::vector<ObjectId> expected;
      const double set = s.world.bodies().neighborhood_size(s.world.body(a));
      const double radius = set == 0 ? 0.00001 : set;
      for (const ObjectId b : ids) {
        if (b != a && (s.at(a) - s.at(b)).norm() < radius) expected.push_back(b);
      }
      const auto& found = s.world.neighbors(a);
      ASSERT_EQ(std::vector<ObjectId>(found.begin(), found.end()), expected) << crowd.name << " " << a.index;
    }
  }
}

TEST(Neighbors, AreOfTheLastUpdateAndOnlyTheLiving) {
  Scene s;
  const ObjectId a = s.body(1, Vector3::Zero());
  const ObjectId b = s.body(1, Vector3(1, 0, 0), BodyKind::Stationary);
  s.world.bodies().set_neighborhood_size(s.world.body(a), 2);
  EXPECT_TRUE(s.world.neighbors(a).empty()) << "nothing happens by itself";
  s.world.update_neighbors();
  s.world.bodies().set_location(s.world.body(b), Vector3(50, 0, 0));
  EXPECT_EQ(s.world.neighbors(a).size(), 1U);
  EXPECT_TRUE(s.world.neighbors(b).empty()) << "its own radius is tiny";
  const ObjectId late = s.body(1, Vector3::Zero());
  EXPECT_EQ(s.world.neighbors(a).size(), 1U);
  EXPECT_TRUE(s.world.neighbors(late).empty());
  s.world.release(b);
  EXPECT_TRUE(s.world.neighbors(a).empty());
  EXPECT_TRUE(s.world.neighbors(b).empty()) << "a stale id has none";
}

TEST(Neighbors, AreKnownByTheirUserWordsInTheSameOrder) {
  Scene s(3);
  std::vector<ObjectId> ids;
  for (int i = 0; i < 300; ++i) {
    ids.push_back(s.body(1, in_cube(s.world.random(), 6)));
    s.world.bodies().set_neighborhood_size(s.world.body(ids.back()), 1.5);
    s.world.set_user(ids.back(), 1000 + static_cast<std::uint64_t>(i));
  }
  const auto expect_same = [&](const char* when) {
    std::size_t all = 0;
    for (const ObjectId id : ids) {
      const std::pmr::vector<ObjectId> neighbors = s.world.neighbors(id);
      const auto users = s.world.neighbor_users(id);
      ASSERT_EQ(users.size(), neighbors.size()) << when;
      for (std::size_t i = 0; i < users.size(); ++i) ASSERT_EQ(users[i], s.world.user(neighbors[i])) << when;
      all += users.size();
    }
    EXPECT_GT(all, ids.size()) << when;
  };
  s.world.update_neighbors();
  expect_same("after the update");
  for (std::size_t i = 0; i < ids.size(); i += 3) s.world.set_user(ids[i], 5000 + i);
  expect_same("after new user words");
  for (std::size_t i = 0; i < ids.size(); i += 5) s.world.release(ids[i]);
  expect_same("after some were released");
}

TEST(Neighbors, AllocateNothingOnceWarm) {
  Scene s;
  std::vector<ObjectId> ids;
  for (int i = 0; i < 2000; ++i) {
    ids.push_back(s.body(1, in_cube(s.world.random(), 12)));
    s.world.bodies().set_neighborhood_size(s.world.body(ids.back()), 1 + (i % 3));
  }
  const auto ask_all = [&] {
    s.world.update_neighbors();
    for (const ObjectId id : ids) s.world.neighbors(id);
  };
  ask_all();
  ask_all();
  s.memory.set_limit(1);  // any allocation now throws
  EXPECT_NO_THROW(ask_all());
  s.memory.set_limit(0);
}

TEST(BoxTree, FindsExactlyTheBoxesThatMeetWhileBoxesComeMoveAndGo) {
  MemoryMeter memory;
  Random r(11);
  {
    BoxTree tree(&memory);
    struct Item {
      Eigen::AlignedBox3d box;
      BoxTree::Leaf leaf = BoxTree::kNoLeaf;
    };
    std::vector<Item> items(300);
    const auto random_box = [&] {
      const Vector3 low = in_cube(r, 20);
      return Eigen::AlignedBox3d(low, low + in_cube(r, r.uniform() < 0.02 ? 30.0 : 1.0));
    };
    for (int round = 0; round < 5000; ++round) {
      const auto i = static_cast<std::uint32_t>(r.below(items.size()));
      Item& item = items[i];
      if (item.leaf == BoxTree::kNoLeaf) {
        item.box = random_box();
        item.leaf = tree.insert(item.box, i);
      } else if (r.uniform() < 0.3) {
        tree.remove(item.leaf);
        item.leaf = BoxTree::kNoLeaf;
      } else {
        item.box = random_box();
        tree.move(item.leaf, item.box);
      }
      if (round % 10 != 0) continue;
      const Eigen::AlignedBox3d query = random_box();
      std::pmr::vector<std::uint32_t> found;
      tree.query(query, found);
      std::sort(found.begin(), found.end());
      std::pmr::vector<std::uint32_t> expected;
      for (std::uint32_t k = 0; k < items.size(); ++k) {
        if (items[k].leaf != BoxTree::kNoLeaf && items[k].box.intersects(query)) expected.push_back(k);
      }
      ASSERT_EQ(found, expected);
    }
  }
  EXPECT_EQ(memory.used(), 0U);
}

}  // namespace
}  // namespace breve
