// The algorithms against each other on random trees of all joint types: each is the other's second method.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "articulated_random.hpp"
#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/inverse_dynamics.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/articulated/mass_matrix.hpp"

namespace breve::articulated {
namespace {

constexpr int kTrees = 1000;

// Round-off of some hundred operations times the condition number of these mass matrices, a few thousand.
constexpr double kRelative = 1e-10;

Loads random_loads(Random& random, const Model& model) {
  Loads loads;
  loads.gravity = random_vector(random, 10);
  loads.tau = random_forces(random, model.velocities());
  loads.wrenches.resize(static_cast<std::size_t>(model.size()));
  for (Wrench& wrench : loads.wrenches) wrench = {random_vector(random, 2), random_vector(random, 2)};
  return loads;
}

/// Some spring, damper and motor on each joint that may have one.
void add_drives(Random& random, const Model& model, Loads& loads) {
  loads.drives.resize(static_cast<std::size_t>(model.size()));
  for (int i = 0; i < model.size(); ++i)
    if (model.body(i).type != JointType::Free)
      loads.drives[static_cast<std::size_t>(i)] = {between(random, 0, 20), between(random, 0, 2), between(random, 0, 3),
                                                   between(random, 0, 5)};
  loads.motor_speed = random_forces(random, model.velocities());
}

/// One random tree after the other, every second one floating.
template <class F>
void for_random_trees(int count, F f) {
  Random random(7);
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE("tree " + std::to_string(i));
    const Model model(random_tree(random, 1 + static_cast<int>(random.below(12)), i % 2 == 1));
    if (model.velocities() == 0) continue;
    Data data(model);
    f(random, model, data, random_state(random, model, 3));
    if (testing::Test::HasFailure()) return;
  }
}

void expect_close(const Vector& got, const Vector& expected, double relative = kRelative) {
  EXPECT_LE((got - expected).cwiseAbs().maxCoeff(), relative * (1 + expected.cwiseAbs().maxCoeff()));
}

TEST(RandomTrees, ForwardDynamicsSolvesTheMassMatrix) {
  for_random_trees(kTrees, [](Random& random, const Model& model, Data& data, const State& state) {
    const Loads loads = random_loads(random, model);
    const Vector acceleration = forward_dynamics(model, data, state, loads);
    Vector bias(model.velocities());
    inverse_dynamics(model, data, state, Vector::Zero(model.velocities()), loads, bias);
    Eigen::MatrixXd mass;
    mass_matrix(model, data, state.q, mass);
    EXPECT_EQ(mass, mass.transpose());
    const Vector expected = mass.llt().solve(loads.tau - bias);
    expect_close(acceleration, expected);
  });
}

TEST(RandomTrees, InverseDynamicsUndoesForwardDynamics) {
  for_random_trees(kTrees, [](Random& random, const Model& model, Data& data, const State& state) {
    Loads loads = random_loads(random, model);
    add_drives(random, model, loads);
    const Vector acceleration = forward_dynamics(model, data, state, loads);
    Vector tau(model.velocities());
    inverse_dynamics(model, data, state, acceleration, loads, tau);
    expect_close(tau, loads.tau);
  });
}

TEST(RandomTrees, KineticEnergyAndMomentumAreThoseOfTheMassMatrix) {
  for_random_trees(200, [](Random&, const Model& model, Data& data, const State& state) {
    Eigen::MatrixXd mass;
    mass_matrix(model, data, state.q, mass);
    forward_kinematics(model, data, state);
    const double expected = 0.5 * state.v.dot(mass * state.v);
    EXPECT_NEAR(kinetic_energy(model, data), expected, kRelative * expected);
    Vector3 velocity = Vector3::Zero();
    for (int i = 0; i < model.size(); ++i) velocity += model.body(i).mass * com_velocity(model, data, i);
    EXPECT_LE((linear_momentum(model, data) - velocity).norm(), kRelative * (1 + velocity.norm()));
  });
}

TEST(RandomTrees, PowerOfAllForcesIsTheRateOfEnergy) {
  for_random_trees(200, [](Random& random, const Model& model, Data& data, const State& state) {
    Loads loads;
    loads.gravity = random_vector(random, 10);
    loads.tau = random_forces(random, model.velocities());
    const Vector acceleration = forward_dynamics(model, data, state, loads);
    const auto energy = [&](double t) {
      State moved = state;
      const Vector d = t * state.v;
      move(model, state.q, d, moved.q);
      moved.v = state.v + t * acceleration;
      forward_kinematics(model, data, moved);
      return kinetic_energy(model, data) + potential_energy(model, data, loads.gravity);
    };
    constexpr double kStep = 1e-5;  // cutting error of the central difference 1e-10 of the energy's third derivative
    const double rate = (energy(kStep) - energy(-kStep)) / (2 * kStep);
    const double power = loads.tau.dot(state.v);
    EXPECT_NEAR(rate, power, 1e-6 * (1 + std::abs(energy(0)) + std::abs(power)));
  });
}

TEST(RandomTrees, ImpulsesChangeVelocitiesByTheInverseMassMatrix) {
  for_random_trees(kTrees, [](Random& random, const Model& model, Data& data, const State& state) {
    Eigen::MatrixXd mass;
    mass_matrix(model, data, state.q, mass);
    factorize(model, data, state, {});
    const Vector f = random_forces(random, model.velocities());
    Vector change(model.velocities());
    apply_inverse_mass(model, data, f, change);
    expect_close(change, mass.llt().solve(f));
    // An impulse on a link is a joint impulse J^T P; and J is known from the velocities it gives.
    forward_kinematics(model, data, state);
    const int link = static_cast<int>(random.below(static_cast<std::uint64_t>(model.size())));
    const Vector3 point = com_position(model, data, link) + random_vector(random, 0.3);
    const Vector3 linear = random_vector(random, 1), angular = random_vector(random, 1);
    Vector generalized(model.velocities());
    for (int k = 0; k < model.velocities(); ++k) {
      State unit = state;
      unit.v = Vector::Unit(model.velocities(), k);
      Data other(model);
      forward_kinematics(model, other, unit);
      generalized[k] = linear.dot(point_velocity(other, link, point)) + angular.dot(spin(other, link));
    }
    const Impulse impulses[] = {{link, point, linear, angular}};
    impulse_response(model, data, impulses, change);
    expect_close(change, mass.llt().solve(generalized));
  });
}

TEST(RandomTrees, DiagonalOfTheInverseMassMatrixIsFoundInOnePass) {
  for_random_trees(kTrees, [](Random&, const Model& model, Data& data, const State& state) {
    Eigen::MatrixXd mass;
    mass_matrix(model, data, state.q, mass);
    factorize(model, data, state, {});
    const Eigen::MatrixXd inverse = mass.llt().solve(Eigen::MatrixXd::Identity(mass.rows(), mass.cols()));
    expect_close(inverse_mass_diagonal(model, data), inverse.diagonal());
  });
}

TEST(RandomTrees, WrenchesAccelerateAsImpulsesChangeVelocities) {
  for_random_trees(300, [](Random& random, const Model& model, Data& data, const State& state) {
    Loads loads;
    const Vector without = forward_dynamics(model, data, state, loads);
    const auto link = static_cast<std::size_t>(random.below(static_cast<std::uint64_t>(model.size())));
    loads.wrenches.resize(static_cast<std::size_t>(model.size()));
    loads.wrenches[link] = {random_vector(random, 2), random_vector(random, 2)};
    const Vector with = forward_dynamics(model, data, state, loads);
    forward_kinematics(model, data, state);
    const int at = static_cast<int>(link);
    const Wrench& wrench = loads.wrenches[link];
    const Impulse impulses[] = {{at, com_position(model, data, at), wrench.force, wrench.couple}};
    Vector change(model.velocities());
    impulse_response(model, data, impulses, change);
    // Differences of accelerations that gyroscopic forces may make large.
    const double scale = 1 + without.cwiseAbs().maxCoeff() + change.cwiseAbs().maxCoeff();
    EXPECT_LE((with - without - change).cwiseAbs().maxCoeff(), kRelative * scale);
  });
}

TEST(RandomTrees, CollisionMatrixIsTheAnswerToUnitImpulses) {
  for_random_trees(kTrees, [](Random& random, const Model& model, Data& data, const State& state) {
    Loads loads;
    const bool implicit = random.below(2) == 1;
    if (implicit) {
      add_drives(random, model, loads);
      for (Drive& drive : loads.drives) drive.motor_limit = 1e9;
    }
    factorize(model, data, state, loads, implicit ? 0.05 : 0);
    forward_kinematics(model, data, state);
    const auto any = static_cast<std::uint64_t>(model.size());
    const int a = static_cast<int>(random.below(any + 1)) - 1, b = static_cast<int>(random.below(any));
    const Vector3 point_a = random_vector(random, 1), point_b = random_vector(random, 1);
    const Matrix3 got = collision_matrix(model, data, a, point_a, b, point_b).matrix();
    Matrix3 expected;
    Vector change(model.velocities());
    for (int k = 0; k < 3; ++k) {
      std::vector<Impulse> impulses = {{b, point_b, Vector3::Unit(k)}};
      if (a >= 0) impulses.push_back({a, point_a, -Vector3::Unit(k)});
      impulse_response(model, data, impulses, change);
      State moved = state;
      moved.v = change;
      Data other(model);
      forward_kinematics(model, other, moved);
      expected.col(k) = point_velocity(other, b, point_b);
      if (a >= 0) expected.col(k) -= point_velocity(other, a, point_a);
    }
    EXPECT_LE((got - expected).cwiseAbs().maxCoeff(), kRelative * (1 + expected.cwiseAbs().maxCoeff()));
    EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix3>(got).eigenvalues().minCoeff(), -1e-12 * got.norm());
  });
}

TEST(RandomTrees, ImplicitDrivesAreASolveWithTheirOwnDiagonal) {
  for_random_trees(300, [](Random& random, const Model& model, Data& data, const State& state) {
    constexpr double kStep = 0.1;
    Loads loads = random_loads(random, model);
    add_drives(random, model, loads);
    for (Drive& drive : loads.drives) drive.motor_limit = 1e9;
    const Vector got = forward_dynamics(model, data, state, loads, kStep);
    const Vector tau = data.tau, diagonal = data.diagonal;
    Loads bare = loads;
    bare.drives.clear();
    Vector bias(model.velocities());
    inverse_dynamics(model, data, state, Vector::Zero(model.velocities()), bare, bias);
    Eigen::MatrixXd mass;
    mass_matrix(model, data, state.q, mass);
    mass.diagonal() += diagonal;
    expect_close(got, mass.llt().solve(tau - bias));
    // Springs, dampers and motors are at the step's end: their force is linear in the new velocity.
    const Vector v = state.v + kStep * got;
    Vector deflection(model.velocities());
    difference(model, data.rest, state.q, deflection);
    for (int i = 0; i < model.size(); ++i) {
      const Drive& drive = loads.drives[static_cast<std::size_t>(i)];
      for (int k = model.body(i).v; k < model.body(i).v + velocity_count(model.body(i).type); ++k) {
        const double force = loads.tau[k] - drive.stiffness * (deflection[k] + kStep * v[k]) - drive.damping * v[k] +
                             drive.motor_gain * (loads.motor_speed[k] - v[k]);
        EXPECT_NEAR(force, tau[k] - diagonal[k] * got[k], 1e-9 * (1 + std::abs(force)));
      }
    }
  });
}

TEST(RandomTrees, MovingAndDifferenceAreInverse) {
  for_random_trees(200, [](Random& random, const Model& model, Data&, const State& state) {
    const Vector d = random_forces(random, model.velocities());  // up to 2 rad along each axis: below 180 degrees...
    const Vector small = 0.8 * d;                                // ...in all three together
    Vector q(model.positions()), back(model.velocities());
    move(model, state.q, small, q);
    difference(model, state.q, q, back);
    expect_close(back, small, 1e-13);
  });
}

TEST(Motors, ReachTheirSpeedWithinTheirLimit) {
  Link link;
  link.axis = Vector3::UnitY();
  const Model model({link});  // 1 kg*m^2 about its axis
  Data data(model);
  Loads loads;
  loads.drives = {Drive{0, 0, 1e9, 5}};
  loads.motor_speed = Vector::Constant(1, 2);
  State state = neutral_state(model);
  constexpr double kStep = 0.1;
  // 5 N*m make 0.5 rad/s a step: at full force for four steps, then no more than is needed.
  for (const double expected : {0.5, 1.0, 1.5, 2.0, 2.0, 2.0}) {
    state.v += kStep * forward_dynamics(model, data, state, loads, kStep);
    EXPECT_NEAR(state.v[0], expected, 1e-8);
  }
}

}  // namespace
}  // namespace breve::articulated
