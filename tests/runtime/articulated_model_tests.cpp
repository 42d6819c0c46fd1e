// Descriptions that are refused, and sizes that are not: long chains, far places, many roots.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "articulated_random.hpp"
#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/integrator.hpp"
#include "runtime/articulated/inverse_dynamics.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/articulated/tree_system.hpp"
#include "runtime/base/error.hpp"

namespace breve::articulated {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What the model says of a leg that `spoil` has spoiled; empty if it takes it.
std::string complaint(const std::function<void(Link&)>& spoil) {
  std::vector<Link> links(2);
  links[0].name = "trunk";
  links[1].name = "leg";
  links[1].parent = 0;
  spoil(links[1]);
  try {
    Model model(links);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Argument);
    return error.what();
  }
  return "";
}

TEST(Model, RefusesWhatCannotBeALinkAndNamesIt) {
  const std::vector<std::pair<std::function<void(Link&)>, const char*>> bad = {
      {[](Link& l) { l.mass = 0; }, "mass is 0 (must be > 0)"},
      {[](Link& l) { l.mass = -1; }, "mass is -1 (must be > 0)"},
      {[](Link& l) { l.mass = kNan; }, "mass is not finite"},
      {[](Link& l) { l.mass = kInfinity; }, "mass is not finite"},
      {[](Link& l) { l.com.x() = kNan; }, "centre of mass is not finite"},
      {[](Link& l) { l.com.x() = 1e200; }, "overflow"},
      {[](Link& l) { l.inertia(0, 1) = kInfinity; }, "inertia is not finite"},
      {[](Link& l) { l.inertia(0, 1) = 0.5; }, "inertia is not symmetric"},
      {[](Link& l) { l.inertia.setZero(); }, "inertia is not positive definite"},
      {[](Link& l) { l.inertia(2, 2) = -1; }, "inertia is not positive definite"},
      {[](Link& l) { l.inertia(0, 1) = l.inertia(1, 0) = 2; }, "inertia is not positive definite"},
      {[](Link& l) { l.axis = Vector3::Zero(); }, "joint axis has length 0"},
      {[](Link& l) { l.axis = Vector3(1, 1, 0); }, "joint axis has length 1.41"},
      {[](Link& l) { l.axis.y() = kNan; }, "joint axis is not finite"},
      {[](Link& l) { l.type = JointType::Universal, l.axis2 = l.axis; }, "not perpendicular"},
      {[](Link& l) { l.rotation = Quaternion(2, 0, 0, 0); }, "joint rotation has length 2"},
      {[](Link& l) { l.rotation.x() = kNan; }, "joint rotation is not finite"},
      {[](Link& l) { l.position.z() = kInfinity; }, "joint position is not finite"},
      {[](Link& l) { l.parent = 1; }, "parent is 1"},
      {[](Link& l) { l.parent = -2; }, "parent is -2"},
      {[](Link& l) { l.type = JointType::Free; }, "free joint must have the world"},
      {[](Link& l) { l.type = static_cast<JointType>(9); }, "joint type 9"},
  };
  for (const auto& [spoil, words] : bad) {
    const std::string text = complaint(spoil);
    EXPECT_NE(text.find("link 'leg'"), std::string::npos) << words;
    EXPECT_NE(text.find(words), std::string::npos) << text;
  }
  EXPECT_EQ(complaint([](Link&) {}), "");
  EXPECT_THROW(Model({}), Error);
}

TEST(Model, CallsALinkWithoutANameByItsNumber) {
  std::vector<Link> links(3);
  links[2].mass = -5;
  try {
    Model model(links);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "link 2: mass is -5 (must be > 0)");
  }
}

TEST(ForwardDynamics, OfAStateThatIsNoNumberIsAnErrorWithTheLinksName) {
  std::vector<Link> links(3);
  for (int i = 0; i < 3; ++i) links[static_cast<std::size_t>(i)].parent = i - 1;
  const Model model(links);
  Data data(model);
  State state = neutral_state(model);
  state.v[1] = kInfinity;
  try {
    forward_dynamics(model, data, state, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Numeric);
    EXPECT_NE(std::string(error.what()).find("link"), std::string::npos);
  }
  state.v[1] = 0;
  state.q[2] = kNan;
  EXPECT_THROW(forward_dynamics(model, data, state, {}), Error);
  state.q[2] = 0;
  EXPECT_NO_THROW(forward_dynamics(model, data, state, {}));  // the workspace keeps nothing of it
}

std::vector<Link> chain(int n) {
  std::vector<Link> links(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    Link& link = links[static_cast<std::size_t>(i)];
    link.parent = i - 1;
    link.position = Vector3(0, 0, i ? -0.1 : 0);
    link.axis = i % 2 ? Vector3::UnitX() : Vector3::UnitY();
    link.com = Vector3(0, 0, -0.05);
    link.mass = 0.1;
    link.inertia = Vector3(1e-4, 1e-4, 1e-5).asDiagonal();
  }
  return links;
}

TEST(LongChain, OfAThousandLinksHangsAndSwings) {
  const Model model(chain(1000));
  TreeSystem system(model);
  system.loads.gravity = Vector3(0, 0, -9.81);
  State state = neutral_state(model);
  const Vector& hanging = forward_dynamics(model, system.data(), state, system.loads);
  EXPECT_EQ(hanging.cwiseAbs().maxCoeff(), 0);
  for (int i = 0; i < 1000; ++i) state.q[i] = 0.02 * std::sin(0.1 * i);
  const Vector acceleration = forward_dynamics(model, system.data(), state, system.loads);
  Vector tau(1000);
  inverse_dynamics(model, system.data(), state, acceleration, system.loads, tau);
  Vector weight(1000);
  inverse_dynamics(model, system.data(), state, Vector::Zero(1000), system.loads, weight);
  EXPECT_LE(tau.cwiseAbs().maxCoeff(), 1e-10 * weight.cwiseAbs().maxCoeff());
  // The fastest waves of the chain turn a link within about 0.002 s.
  Integrator integrator(system, Scheme::RungeKutta4);
  Instant at{0, state.q, state.v, 0};
  const auto energy = [&] {
    forward_kinematics(model, system.data(), {at.q, at.v});
    return kinetic_energy(model, system.data()) + potential_energy(model, system.data(), system.loads.gravity);
  };
  const double before = energy();
  for (int i = 0; i < 50; ++i) integrator.step(at, 2e-4);
  EXPECT_NEAR(energy(), before, 1e-9 * std::abs(before));
  EXPECT_GT(at.v.norm(), 1e-3);
}

TEST(FarAway, TheDynamicsIsTheSameTenKilometresOut) {
  Random random(11);
  const Model model(random_tree(random, 9, true));
  Data data(model);
  State state = random_state(random, model, 3);
  Loads loads;
  loads.gravity = Vector3(0, 0, -9.81);
  const Vector here = forward_dynamics(model, data, state, loads);
  state.q.head<3>() += Vector3(1e4, -1e4, 1e4);
  EXPECT_EQ(forward_dynamics(model, data, state, loads), here);
}

TEST(Forest, TreesOfOneModelDoNotFeelEachOther) {
  Random random(5);
  const std::vector<Link> one = random_tree(random, 6, true), other = random_tree(random, 5, false);
  std::vector<Link> both = one;
  for (Link link : other) {
    if (link.parent >= 0) link.parent += 6;
    both.push_back(link);
  }
  const Model alone(one), forest(both);
  Data data_alone(alone), data_forest(forest);
  State state = random_state(random, forest, 2);
  Loads loads;
  loads.gravity = Vector3(0, 0, -9.81);
  const Vector expected =
      forward_dynamics(alone, data_alone, {state.q.head(alone.positions()), state.v.head(alone.velocities())}, loads);
  const Vector got = forward_dynamics(forest, data_forest, state, loads);
  EXPECT_EQ(Vector(got.head(alone.velocities())), expected);
}

TEST(Reactions, OfTheGroundCarryTheWeight) {
  const Model model(chain(20));
  Data data(model);
  Loads loads;
  loads.gravity = Vector3(0, 0, -9.81);
  Vector tau(model.velocities());
  inverse_dynamics(model, data, neutral_state(model), Vector::Zero(model.velocities()), loads, tau);
  EXPECT_NEAR(data.work.front().force.z(), 9.81 * model.mass(), 1e-11);
}

}  // namespace
}  // namespace breve::articulated
