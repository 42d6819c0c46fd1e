// A step takes no memory once the integrator is made: every call of malloc and of operator new in it is counted.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

#include "articulated_random.hpp"
#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/integrator.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/articulated/tree_system.hpp"

namespace {
std::atomic<long> allocations{0};
}

// Eigen calls malloc and not operator new, which also ends in malloc: here both pass.
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

namespace breve::articulated {
namespace {

struct Scene {
  Scene() : model(tree()), system(model) {
    system.loads.gravity = Vector3(0, 0, -9.81);
    system.loads.drives.resize(static_cast<std::size_t>(model.size()));
    for (int i = 1; i < model.size(); ++i) system.loads.drives[static_cast<std::size_t>(i)] = {1, 0.1, 10, 0.5};
  }
  static std::vector<Link> tree() {
    Random random(9);
    return random_tree(random, 12, true);
  }
  Model model;
  TreeSystem system;
};

TEST(Allocation, TheCounterSeesVectors) {
  const long before = allocations;
  const Vector v = Vector::Zero(100);
  EXPECT_GT(allocations, before);
  EXPECT_EQ(v.size(), 100);
}

TEST(Allocation, NoSchemeTakesMemoryInAStep) {
  Scene scene;
  for (const Scheme scheme : {Scheme::ExplicitEuler, Scheme::SemiImplicitEuler, Scheme::ImplicitEuler,
                              Scheme::VelocityVerlet, Scheme::ImplicitMidpoint, Scheme::RungeKutta4, Scheme::Fehlberg4,
                              Scheme::Fehlberg5, Scheme::FehlbergAdaptive}) {
    Settings settings;
    settings.implicit_joints = true;
    Integrator integrator(scene.system, scheme, settings);
    Random random(2);
    const State start = random_state(random, scene.model, 0.5);
    Instant at{0, start.q, start.v, 0};
    const long before = allocations;
    for (int i = 0; i < 3; ++i) integrator.step(at, 1e-3);
    EXPECT_EQ(allocations - before, 0) << "scheme " << static_cast<int>(scheme);
  }
}

TEST(Allocation, QuestionsTakeNone) {
  Scene scene;
  Data data(scene.model);
  const State state = neutral_state(scene.model);
  Vector change(scene.model.velocities());
  const Impulse impulses[] = {{3, Vector3(1, 0, 0), Vector3(0, 1, 0)}};
  const long before = allocations;
  forward_dynamics(scene.model, data, state, scene.system.loads);
  forward_kinematics(scene.model, data, state);
  factorize(scene.model, data, state, scene.system.loads);
  impulse_response(scene.model, data, impulses, change);
  collision_matrix(scene.model, data, 2, Vector3(0, 0, 0), 5, Vector3(0, 1, 0));
  kinetic_energy(scene.model, data);
  spring_energy(scene.model, scene.system.loads, state.q, data);
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace breve::articulated
