// The contact solver on trees of bodies, given by their matrices, and what it takes from memory.
#include <gtest/gtest.h>

#include "articulated_random.hpp"
#include "contact_law_scene.hpp"
#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/kinematics.hpp"

namespace breve::contact {
namespace {

using articulated::between;
using articulated::random_rotation;
using articulated::random_vector;

/// A random tree in a random state, and the matrices of points on it.
struct Tree {
  explicit Tree(Random& random)
      : model(articulated::random_tree(random, 1 + static_cast<int>(random.below(6)), random.below(2) == 0)),
        data(model),
        state(articulated::random_state(random, model, 1)) {
    articulated::forward_kinematics(model, data, state);
    articulated::factorize(model, data, state, articulated::Loads{});
  }
  double kinetic() {
    articulated::forward_kinematics(model, data, state);
    return articulated::kinetic_energy(model, data);
  }
  /// 3 x nv each, rows along `axes`, of a point of a link.
  void matrices(int link, const Vector3& point, const Matrix3& axes, std::vector<double>& j, std::vector<double>& r) {
    const auto n = static_cast<std::size_t>(model.velocities());
    j.assign(3 * n, 0);
    r.assign(3 * n, 0);
    articulated::Vector change(model.velocities());
    for (int k = 0; k < 3; ++k) {
      const articulated::Impulse impulse{link, point, axes.row(k).transpose()};
      articulated::impulse_response(model, data, {&impulse, 1}, change);
      std::copy_n(change.data(), n, r.data() + static_cast<std::size_t>(k) * n);
    }
    articulated::Data other(model);
    articulated::State one = state;
    for (std::size_t i = 0; i < n; ++i) {
      one.v.setZero();
      one.v[static_cast<Eigen::Index>(i)] = 1;
      articulated::forward_kinematics(model, other, one);
      const articulated::Motion& motion = other.motion_of(link);
      const Vector3 u = axes * (motion.velocity + other.of(link).spin.cross(point - motion.origin));
      for (std::size_t k = 0; k < 3; ++k) j[k * n + i] = u[static_cast<Eigen::Index>(k)];
    }
  }

  articulated::Model model;
  articulated::Data data;
  articulated::State state;
};

/// Trees that touch the ground, each other and a free box.
struct Wood {
  std::deque<Tree> trees;
  Scene scene;  // of the box: body 0, mover 0; the trees are the movers behind it
  std::deque<std::vector<double>> matrices;

  explicit Wood(Random& random) {
    const int box = scene.add_box(between(random, 0.2, 5), random_vector(random, 0.5), Vector3(0.5, 1, 0.8));
    for (int k = 0; k < 6; ++k) scene.bodies[0].v[k] = between(random, -1, 1);
    for (std::uint64_t i = 0; i < 1 + random.below(2); ++i) trees.emplace_back(random);
    const auto contacts = 1 + random.below(6);
    for (std::uint64_t i = 0; i < contacts; ++i) {
      const auto a = random.below(trees.size());
      const Matrix3 axes = frame_of(random_rotation(random) * Vector3::UnitZ());
      const Vector3 point = random_vector(random, 0.5);
      Row row;
      row.axes = axes;
      row.static_friction = row.dynamic_friction = random.uniform();
      side(row.a, row.ja, row.ra, a, point, axes, random);
      if (random.below(2) == 0) {
        row.b = box;
        row.arm_b = point - scene.bodies[0].position;
      } else if (trees.size() > 1) {
        side(row.b, row.jb, row.rb, 1 - a, point, axes, random);
      }
      scene.rows.push_back(row);
    }
  }
  void side(int& mover, const double*& j, const double*& r, std::size_t tree, const Vector3& point, const Matrix3& axes,
            Random& random) {
    std::vector<double>&own_j = matrices.emplace_back(), &own_r = matrices.emplace_back();
    const int link = static_cast<int>(random.below(static_cast<std::uint64_t>(trees[tree].model.size())));
    trees[tree].matrices(link, point, axes, own_j, own_r);
    mover = 1 + static_cast<int>(tree);
    j = own_j.data();
    r = own_r.data();
  }
  double kinetic() {
    double sum = scene.kinetic();
    for (Tree& tree : trees) sum += tree.kinetic();
    return sum;
  }
  SolveReport solve() {
    std::vector<Mover> movers = scene.movers();
    for (Tree& tree : trees) movers.push_back({tree.state.v.data(), tree.model.velocities()});
    return solve_island(movers, scene.rows, scene.scalars, scene.settings, scene.work);
  }
};

/// In case 1539 sweeps alone diverge: the longer, the farther.
TEST(Trees, NoSolveAddsEnergyAndTheConeHolds) {
  Random random(51);
  int direct = 0;
  for (int i = 0; i < 2000; ++i) {
    Wood wood(random);
    wood.scene.settings = {1 + static_cast<int>(random.below(20)), i % 2 == 0, 1e-9};
    if (i % 20 == 19) wood.scene.settings.iterations = 200;
    const double before = wood.kinetic();
    direct += wood.solve().direct ? 1 : 0;
    ASSERT_LE(wood.kinetic(), before * (1 + 1e-10)) << i;
    for (const Row& row : wood.scene.rows) {
      ASSERT_GE(row.impulse[0], 0);
      ASSERT_LE(row.impulse.tail<2>().norm(), row.static_friction * row.impulse[0] * (1 + 1e-12));
    }
  }
  EXPECT_GE(direct, 990);  // of 1000
}

TEST(Trees, AnIslandSeenFromItsRowsMovesAsOneSeenFromItsVelocities) {
  int fewer = 0, plain = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random first(seed), second(seed), third(seed);
    // The third shows how far apart round-off alone would bring them: some points can hardly be moved.
    Wood few(first), many(second), off(third);
    for (Tree& tree : off.trees) tree.state.v *= 1 + 1e-14;
    std::size_t velocities = 6;
    for (const Tree& tree : few.trees) velocities += static_cast<std::size_t>(tree.model.velocities());
    fewer += 3 * few.scene.rows.size() <= velocities;
    // Rows that nothing moves: too many to look at the island from.
    for (Wood* wood : {&many, &off}) wood->scene.scalars.resize(100);
    for (Wood* wood : {&few, &many, &off}) {
      wood->scene.settings = {20, false, 0};
      wood->solve();
    }
    double noise = 0;
    for (std::size_t i = 0; i < few.scene.rows.size(); ++i)
      noise = std::max(noise, (off.scene.rows[i].impulse - many.scene.rows[i].impulse).norm());
    plain += noise < 1e-10;
    const auto near = [noise](const auto& a, const auto& b) {
      return (a - b).norm() <= 1e-9 * (1 + b.norm()) + 1e3 * noise;
    };
    for (std::size_t i = 0; i < few.scene.rows.size(); ++i)
      EXPECT_TRUE(near(few.scene.rows[i].impulse, many.scene.rows[i].impulse)) << seed;
    EXPECT_TRUE(near(few.scene.bodies[0].v, many.scene.bodies[0].v)) << seed;
    for (std::size_t t = 0; t < few.trees.size(); ++t)
      EXPECT_TRUE(near(few.trees[t].state.v, many.trees[t].state.v)) << seed;
  }
  EXPECT_GE(fewer, 100);
  EXPECT_GE(plain, 270);
}

/// At rest, without friction and impulses, and with biases that depend on the seed.
std::vector<Push> lay_down(Wood& wood, std::uint64_t seed, double share) {
  Random random(seed);
  std::vector<Push> pushes;
  for (Row& row : wood.scene.rows) {
    row.static_friction = row.dynamic_friction = 0;
    row.impulse.setZero();
    row.bias = share * between(random, -0.1, 0.1);
    row.softness = between(random, 0, 1e-4);
    pushes.push_back({row.bias, row.softness, 0});
  }
  for (double& v : wood.scene.bodies[0].v) v = 0;
  for (Tree& tree : wood.trees) tree.state.v.setZero();
  return pushes;
}

/// Rows with bounds, one a tree, as motors and limits have them.
void bound(Wood& wood, std::deque<std::vector<double>>& numbers) {
  for (std::size_t t = 0; t < wood.trees.size(); ++t) {
    const articulated::Model& model = wood.trees[t].model;
    const auto n = static_cast<std::size_t>(model.velocities());
    std::vector<double>&j = numbers.emplace_back(n, 0.0), &r = numbers.emplace_back(n, 0.0);
    j[n - 1] = 1;
    articulated::Vector answer(model.velocities());
    const articulated::Vector unit = Eigen::Map<const articulated::Vector>(j.data(), model.velocities());
    articulated::apply_inverse_mass(model, wood.trees[t].data, unit, answer);
    std::copy_n(answer.data(), n, r.data());
    ScalarRow row;
    row.a = 1 + static_cast<int>(t);
    row.ja = j.data();
    row.ra = r.data();
    row.lo = -0.01;
    row.hi = 0.02;
    wood.scene.scalars.push_back(row);
  }
}

TEST(Trees, SolvedAgainByNormalsMoveAsInASolveFromRestWithoutFriction) {
  int moved = 0, plain = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random first(seed), second(seed), third(seed);
    Wood again(first), fresh(second), off(third);  // the last one shows what round-off alone does
    std::deque<std::vector<double>> numbers;
    for (Wood* wood : {&again, &fresh, &off}) {
      wood->scene.settings = {30, false, 0};
      bound(*wood, numbers);
    }
    again.solve();
    const std::vector<double> biases(again.trees.size(), 0.05);
    for (Wood* wood : {&fresh, &off})
      for (ScalarRow& row : wood->scene.scalars) row.bias = biases[0];
    std::vector<Push> pushes = lay_down(again, seed, 1);
    solve_again(pushes, biases, again.scene.settings, again.scene.work);
    lay_down(fresh, seed, 1);
    lay_down(off, seed, 1 + 1e-14);
    fresh.solve();
    off.solve();
    double noise = 0;
    for (std::size_t t = 0; t < fresh.trees.size(); ++t)
      noise = std::max(noise, (off.trees[t].state.v - fresh.trees[t].state.v).norm());
    plain += noise < 1e-10;
    for (std::size_t t = 0; t < fresh.trees.size(); ++t) {
      const articulated::Vector &a = again.trees[t].state.v, &b = fresh.trees[t].state.v;
      EXPECT_LE((a - b).norm(), 1e-9 * (1 + b.norm()) + 1e3 * noise) << seed;
      moved += b.norm() > 1e-3;
    }
    EXPECT_LE((again.scene.bodies[0].v - fresh.scene.bodies[0].v).norm(), 1e-9 + 1e3 * noise) << seed;
  }
  EXPECT_GE(moved, 250);
  EXPECT_GE(plain, 270);
}

TEST(Trees, AFreeBodyGivenByMatricesMovesAsOneGivenByArms) {
  Random random(52);
  for (int i = 0; i < 200; ++i) {
    Scene arms, dense;
    std::deque<std::vector<double>> matrices;
    for (Scene* scene : {&arms, &dense}) {
      scene->stack({1, 2, 0.5}, 0.3);
      scene->settings = {20, i % 2 == 0, 1e-9};
    }
    for (std::size_t k = 0; k < 3; ++k)
      for (int n = 0; n < 6; ++n) arms.bodies[k].v[n] = dense.bodies[k].v[n] = between(random, -1, 1);
    const auto give = [&](int body, const Vector3& arm, const Matrix3& axes, const double*& j, const double*& r) {
      if (body < 0) return;
      const FreeBody& b = dense.bodies[static_cast<std::size_t>(body)];
      std::vector<double>&own_j = matrices.emplace_back(18), &own_r = matrices.emplace_back(18);
      for (int k = 0; k < 3; ++k) {
        const Vector3 n = axes.row(k).transpose(), torque = arm.cross(n), spin = b.inertia.inverse() * torque;
        for (int m = 0; m < 3; ++m) {
          const auto at = static_cast<std::size_t>(6 * k + m);
          own_j[at] = n[m];
          own_j[at + 3] = torque[m];
          own_r[at] = n[m] / b.mass;
          own_r[at + 3] = spin[m];
        }
      }
      j = own_j.data();
      r = own_r.data();
    };
    for (Row& row : dense.rows) {
      give(row.a, row.arm_a, row.axes, row.ja, row.ra);
      if (i % 3 != 0) give(row.b, row.arm_b, row.axes, row.jb, row.rb);  // else a side of each kind
    }
    arms.solve();
    dense.solve();
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LE((arms.bodies[k].v - dense.bodies[k].v).norm(), 1e-7) << i;
  }
}

class Counter final : public std::pmr::memory_resource {
 public:
  int allocations = 0;

 private:
  void* do_allocate(std::size_t bytes, std::size_t alignment) override {
    ++allocations;
    return std::pmr::new_delete_resource()->allocate(bytes, alignment);
  }
  void do_deallocate(void* p, std::size_t bytes, std::size_t alignment) override {
    std::pmr::new_delete_resource()->deallocate(p, bytes, alignment);
  }
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }
};

TEST(Workspace, TakesNothingOnceItHasSeenAnIsland) {
  Counter counter;
  Workspace work(&counter);
  for (const bool direct : {false, true}) {
    Scene scene;
    scene.stack(std::vector<double>(8, 1.0), 0.5);
    scene.pull({0.5, 0, -9.81}, 1.0 / 60);
    const std::vector<Mover> movers = scene.movers();
    const SolveSettings settings{10, direct, 1e-9};
    solve_island(movers, scene.rows, {}, settings, work);
    const int seen = counter.allocations;
    EXPECT_GT(seen, 0);
    scene.pull({0.3, 0, -9.81}, 1.0 / 60);
    solve_island(movers, scene.rows, {}, settings, work);
    EXPECT_EQ(counter.allocations, seen);
  }
}

}  // namespace
}  // namespace breve::contact
