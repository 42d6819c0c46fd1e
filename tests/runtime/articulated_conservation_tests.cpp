// Orders of the schemes, attitude included, and what they keep: energy and momentum on fixed and floating bases.
#include <gtest/gtest.h>

#include <cmath>

#include "articulated_random.hpp"
#include "runtime/articulated/carried.hpp"
#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/integrator.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/articulated/tree_system.hpp"

namespace breve::articulated {
namespace {

struct Named {
  const char* name;
  Scheme scheme;
  double order;
  bool refine = false;
};

const Named kOrders[] = {{"ExplicitEuler", Scheme::ExplicitEuler, 1},
                         {"SemiImplicitEuler", Scheme::SemiImplicitEuler, 1},
                         {"ImplicitEuler", Scheme::ImplicitEuler, 1},
                         {"VelocityVerlet", Scheme::VelocityVerlet, 2},
                         {"ImplicitMidpoint", Scheme::ImplicitMidpoint, 2},
                         {"ComposedMidpoint", Scheme::ImplicitMidpoint, 4, true},
                         {"RungeKutta4", Scheme::RungeKutta4, 4},
                         {"Fehlberg4", Scheme::Fehlberg4, 4},
                         {"Fehlberg5", Scheme::Fehlberg5, 5}};

/// A body with an arm and a leg: ball, universal, revolute and prismatic joints; the root is free, or hangs by a ball.
Model creature(bool floating) {
  std::vector<Link> links(5);
  const JointType types[] = {floating ? JointType::Free : JointType::Ball, JointType::Ball, JointType::Revolute,
                             JointType::Universal, JointType::Prismatic};
  const int parents[] = {-1, 0, 1, 0, 3};
  for (std::size_t i = 0; i < links.size(); ++i) {
    links[i].type = types[i];
    links[i].parent = parents[i];
    links[i].position = i == 0 ? Vector3(0, 0, 0) : Vector3(0.3, i == 3 ? -0.2 : 0.2, 0.1);
    links[i].axis = i % 2 ? Vector3::UnitY() : Vector3::UnitX();
    links[i].axis2 = Vector3::UnitZ();
    links[i].mass = 1 + 0.3 * static_cast<double>(i);
    links[i].com = Vector3(0.2, 0.05, -0.1);
    links[i].inertia = Vector3(0.05, 0.08, 0.11).asDiagonal();
  }
  return Model(links);
}

class Creature {
 public:
  explicit Creature(bool floating) : model_(creature(floating)), system_(model_) {
    system_.loads.gravity = Vector3(0, 0, floating ? 0 : -9.81);
    Random random(3);
    const State start = random_state(random, model_, 2);
    start_ = {0, start.q, start.v, 0};
  }

  Instant run(const Named& named, double seconds, int steps) {
    Settings settings;
    settings.tolerance.relative = 1e-11;
    settings.refine = named.refine;
    Integrator integrator(system_, named.scheme, settings);
    Instant at = start_;
    for (int i = 0; i < steps; ++i) integrator.step(at, seconds / steps);
    return at;
  }
  /// Distance of two states; attitudes by the angle between them.
  double error(const Instant& a, const Instant& b) {
    Vector d(model_.velocities());
    difference(model_, b.q, a.q, d);
    return std::max(d.cwiseAbs().maxCoeff(), (a.v - b.v).cwiseAbs().maxCoeff());
  }
  double energy(const Instant& at) {
    forward_kinematics(model_, system_.data(), {at.q, at.v});
    return kinetic_energy(model_, system_.data()) + potential_energy(model_, system_.data(), system_.loads.gravity);
  }
  Vector3 angular(const Instant& at) {
    forward_kinematics(model_, system_.data(), {at.q, at.v});
    return angular_momentum(model_, system_.data(), Vector3::Zero());
  }
  Vector3 linear(const Instant& at) {
    forward_kinematics(model_, system_.data(), {at.q, at.v});
    return linear_momentum(model_, system_.data());
  }
  const Instant& start() const { return start_; }

 private:
  Model model_;
  TreeSystem system_;
  Instant start_;
};

class Orders : public testing::TestWithParam<std::tuple<Named, bool>> {};

TEST_P(Orders, AreFullOnTheTreeWithItsAttitude) {
  const auto& [named, floating] = GetParam();
  Creature creature(floating);
  constexpr double kSeconds = 0.4;
  const Instant exact = creature.run({"exact", Scheme::FehlbergAdaptive, 5}, kSeconds, 1);
  // Steps so fine that the next power of h is small, and so coarse that round-off is.
  const int steps = named.order < 2 ? 1600 : named.order < 4 ? 400 : 60;
  const double coarse = creature.error(creature.run(named, kSeconds, steps), exact);
  const double fine = creature.error(creature.run(named, kSeconds, 2 * steps), exact);
  const double order = std::log2(coarse / fine);
  std::printf("  %-18s %s base: order %.2f, error %.1e\n", named.name, floating ? "floating" : "fixed", order, fine);
  EXPECT_GT(order, named.order - 0.15);
  EXPECT_LT(order, named.order + 0.6);
}

TEST_P(Orders, OfWhatIsLostOfEnergyAndMomentumAreFull) {
  const Named named = std::get<0>(GetParam());
  const bool floating = std::get<1>(GetParam());
  Creature creature(floating);
  constexpr double kSeconds = 0.4;
  const int steps = named.order < 2 ? 1600 : named.order < 4 ? 400 : 60;
  const Instant coarse = creature.run(named, kSeconds, steps);
  const Instant fine = creature.run(named, kSeconds, 2 * steps);
  const auto falls = [&](double big, double small, const char* what) {
    constexpr double kRoundOff = 1e-11;
    if (small > kRoundOff) {
      EXPECT_GT(std::log2(big / small), named.order - 0.25) << what;
    }
    EXPECT_LE(small, std::max(big, kRoundOff)) << what;
  };
  const double energy = creature.energy(creature.start());
  falls(std::abs(creature.energy(coarse) - energy), std::abs(creature.energy(fine) - energy), "energy");
  if (!floating) return;
  const Vector3 l = creature.angular(creature.start()), p = creature.linear(creature.start());
  falls((creature.angular(coarse) - l).norm(), (creature.angular(fine) - l).norm(), "angular momentum");
  falls((creature.linear(coarse) - p).norm(), (creature.linear(fine) - p).norm(), "momentum");
}

INSTANTIATE_TEST_SUITE_P(Schemes, Orders, testing::Combine(testing::ValuesIn(kOrders), testing::Bool()),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param).name) +
                                  (std::get<1>(info.param) ? "Floating" : "Fixed");
                         });

TEST(Midpoint, KeepsEnergyAndAngularMomentumOfAFastLopsidedBodyToRoundOff) {
  Link link;
  link.type = JointType::Free;
  link.inertia = Vector3(0.01, 0.5, 1).asDiagonal();  // 100 to 1
  const Model model({link});
  TreeSystem system(model);
  Integrator integrator(system, Scheme::ImplicitMidpoint);
  const State start = neutral_state(model);
  Instant at{0, start.q, start.v, 0};
  at.v.tail<3>() = 20 * Vector3(1, 1, 1).normalized();
  Data data(model);
  forward_kinematics(model, data, {at.q, at.v});
  const double energy = kinetic_energy(model, data);
  const Vector3 momentum = angular_momentum(model, data, Vector3::Zero());
  int evaluations = 0;
  constexpr int kSteps = 600;
  for (int i = 0; i < kSteps; ++i) {
    integrator.step(at, 1.0 / 60);
    evaluations += integrator.count().evaluations;
  }
  forward_kinematics(model, data, {at.q, at.v});
  const Vector3 after = angular_momentum(model, data, Vector3::Zero());
  std::printf("  energy %.1e, momentum with its direction %.1e, %.1f evaluations a step\n",
              kinetic_energy(model, data) / energy - 1, (after - momentum).norm() / momentum.norm(),
              static_cast<double>(evaluations) / kSteps);
  EXPECT_NEAR(kinetic_energy(model, data), energy, 1e-11 * energy);
  EXPECT_LE((after - momentum).norm(), 1e-11 * momentum.norm());  // also the direction, thanks to Cayley's rotations
}

TEST(Midpoint, EnergyOfAHeavyTopDoesNotDrift) {
  Link link;
  link.type = JointType::Ball;
  link.com = Vector3(0, 0, 0.1);
  link.inertia = Vector3(0.005, 0.005, 0.004).asDiagonal();
  const Model model({link});
  TreeSystem system(model);
  system.loads.gravity = Vector3(0, 0, -9.81);
  Integrator integrator(system, Scheme::ImplicitMidpoint);
  Instant at{0, Vector(4), Vector(3), 0};
  at.q << std::cos(0.5), 0, std::sin(0.5), 0;
  at.v << -0.8, 0.5, 60;
  const auto energy = [&] {
    forward_kinematics(model, system.data(), {at.q, at.v});
    return kinetic_energy(model, system.data()) + potential_energy(model, system.data(), system.loads.gravity);
  };
  const double start = energy();
  // The error swings with the nutation; over ten times as long it must swing no further.
  double early = 0, late = 0;
  for (int i = 0; i < 6000; ++i) {
    integrator.step(at, 1.0 / 300);
    double& worst = i < 600 ? early : late;
    worst = std::max(worst, std::abs(energy() - start));
  }
  std::printf("  energy error %.1e of %.2f in 2 s, %.1e in 20 s\n", early, start, late);
  EXPECT_LE(late, 1.2 * early);
}

TEST(Midpoint, ComposedDampsWhatTheStepCannotFollow) {
  // One part of the composition goes back in time: of a damper of 3.04 a step it alone would make a hundredfold.
  for (const double ratio : {0.1, 1.0, 2.5, 3.0, 3.04, 3.1, 10.0, 1e4}) {
    Link link;
    link.type = JointType::Revolute;
    const Model model({link});
    TreeSystem system(model);
    Data data(model);
    const State neutral = neutral_state(model);
    Instant at{0, neutral.q, neutral.v, 0};
    at.v[0] = 1;
    forward_kinematics(model, data, {at.q, at.v});
    constexpr double kStep = 0.01;
    system.loads.drives = {Drive{0, ratio * 2 * kinetic_energy(model, data) / kStep, 0, 0}};
    Settings settings;
    settings.refine = true;
    Integrator integrator(system, Scheme::ImplicitMidpoint, settings);
    for (int i = 0; i < 100; ++i) {
      const double before = std::abs(at.v[0]);
      integrator.step(at, kStep);
      EXPECT_LE(std::abs(at.v[0]), before) << ratio << ", step " << i;
    }
  }
}

TEST(StiffJoints, StayCalmAtAnyStiffnessIfImplicit) {
  // k h^2 / I from 1 to 1e6, on semi-implicit Euler at 1/60 s: explicit springs would blow up at 4.
  for (const double ratio : {1.0, 100.0, 1e6}) {
    std::vector<Link> links(4);
    for (int i = 0; i < 4; ++i) {
      Link& link = links[static_cast<std::size_t>(i)];
      link.parent = i - 1;
      link.type = i == 1 ? JointType::Ball : i == 2 ? JointType::Universal : JointType::Revolute;
      link.axis = Vector3::UnitY();
      link.position = Vector3(i ? 0.3 : 0, 0, 0);
      link.com = Vector3(0.15, 0, 0);
      link.inertia = Matrix3::Identity() * 0.01;
    }
    const Model model(links);
    TreeSystem system(model);
    system.loads.gravity = Vector3(0, 0, -9.81);
    constexpr double kStep = 1.0 / 60;
    system.loads.drives.assign(4, Drive{ratio * 0.03 / (kStep * kStep), 0, 0, 0});
    Settings settings;
    settings.implicit_joints = true;
    Integrator integrator(system, Scheme::SemiImplicitEuler, settings);
    const State start = neutral_state(model);
    Instant at{0, start.q, start.v, 0};
    for (int i = 0; i < 600; ++i) integrator.step(at, kStep);
    EXPECT_LE(at.v.cwiseAbs().maxCoeff(), 3) << ratio;
    EXPECT_TRUE(at.q.allFinite());
  }
}

TEST(Carried, LinksKeepTheirMomentaWhereRatesOfJointsWouldGain) {
  constexpr double kMost = 0.01;
  Random random(11);
  std::pmr::vector<Impulse> momenta;
  int changed = 0;
  for (int i = 0; i < 200; ++i) {
    const bool floating = i % 2 == 0;
    const Model model(random_tree(random, 2 + i % 9, floating));
    Data data(model);
    State state = random_state(random, model, 3);
    forward_kinematics(model, data, state);
    const double before = kinetic_energy(model, data);
    const Vector3 momentum = linear_momentum(model, data);
    const Vector rates = state.v, way = 0.2 * random_forces(random, model.velocities());
    Vector there = state.q;
    move(model, state.q, way, there);
    const bool other = move_carried(model, data, state, way, kMost, momenta);
    forward_kinematics(model, data, state);
    EXPECT_LE(kinetic_energy(model, data), (1 + (other ? 1e-12 : kMost)) * before);
    EXPECT_EQ(state.q, there);
    changed += other;
    if (!other) {
      EXPECT_EQ(state.v, rates);
    }
    if (!other || !floating) continue;
    // All of it, or what is left of it along the same direction where a link's inertia rotates with the link.
    const Vector3 now = linear_momentum(model, data);
    const double kept = now.dot(momentum) / momentum.squaredNorm();
    EXPECT_LE(kept, 1 + 1e-12);
    EXPECT_GT(kept, 0.5);
    EXPECT_LT((now - kept * momentum).norm(), 1e-12 * momentum.norm());
  }
  EXPECT_GT(changed, 50);
  EXPECT_LT(changed, 150);
}

}  // namespace
}  // namespace breve::articulated
