// Contact springs: the sphere of 1 kg with k = 1e4 and zeta = 0.2, moved by the engine's own integrators.
#include <gtest/gtest.h>

#include <numbers>

#include "articulated_random.hpp"
#include "runtime/articulated/integrator.hpp"
#include "runtime/contact/springs.hpp"

namespace breve::contact {
namespace {

using articulated::between;

constexpr double kStiffness = 1e4, kDamping = 0.2, kMass = 1;

Spring sphere_spring() { return make_spring(kStiffness, calibrate(kDamping), kMass, Law{0, 0, 0.5, 0.5, 0}); }

/// A point mass over the ground.
class Sphere : public articulated::System {
 public:
  explicit Sphere(double gravity) : gravity_(gravity) {}
  int positions() const override { return 1; }
  int velocities() const override { return 1; }
  articulated::Kind kind(int) const override { return articulated::Kind::Length; }
  void acceleration(double, const articulated::Vector& q, const articulated::Vector& v, double,
                    articulated::Vector& a) override {
    a[0] = press(spring_, q[0], v[0]).force / kMass - gravity_;
  }
  double energy(const articulated::Instant& at) const {
    return 0.5 * kMass * at.v[0] * at.v[0] + kMass * gravity_ * at.q[0] + press(spring_, at.q[0], at.v[0]).stored;
  }

 private:
  double gravity_;
  Spring spring_ = sphere_spring();
};

articulated::Instant falling(double gap, double speed) {
  articulated::Instant at;
  at.q.resize(1);
  at.v.resize(1);
  at.q[0] = gap;
  at.v[0] = -speed;
  return at;
}

TEST(ContactSprings, ASphereAtRestSinksByItsWeight) {
  const Press at_rest = press(sphere_spring(), -9.81e-4, 0);
  EXPECT_NEAR(at_rest.force, 9.81 * kMass, 1e-12);
  Sphere sphere(9.81);
  articulated::Integrator integrator(sphere, articulated::Scheme::RungeKutta4);
  articulated::Instant at = falling(0, 0);
  for (int i = 0; i < 2000; ++i) integrator.step(at, 1.0 / 960);
  EXPECT_NEAR(at.q[0], -9.81e-4, 1e-10);
}

TEST(ContactSprings, ReboundAndDurationAreThoseOfTheOscillator) {
  Sphere sphere(0);
  articulated::Integrator integrator(sphere, articulated::Scheme::RungeKutta4);
  for (const double speed : {0.01, 0.03, 0.1}) {
    articulated::Instant at = falling(-1e-15, speed);
    double contact = 0;
    const double h = 1e-5;
    for (int i = 0; i < 10000 && at.q[0] < 0; ++i) {
      const double gap = at.q[0];
      integrator.step(at, h);
      contact += at.q[0] < 0 ? h : h * gap / (gap - at.q[0]);
    }
    EXPECT_NEAR(at.v[0] / speed, 0.5266, 5e-5);
    EXPECT_NEAR(contact, 0.03206, 5e-6);
  }
}

TEST(ContactSprings, EnergyAfterIsNeverAboveEnergyBefore) {
  Sphere sphere(9.81);
  for (const double h : {1.0 / 480, 1.0 / 960, 1e-4}) {
    articulated::Integrator integrator(sphere, articulated::Scheme::RungeKutta4);
    double last = 0;
    for (int i = 0; i <= 180; ++i) {
      const double speed = 0.01 + 0.0005 * i;
      articulated::Instant at = falling(0, speed);
      const double before = sphere.energy(at);
      double highest = 0;
      for (int k = 0; k * h < 0.08; ++k) {
        integrator.step(at, h);
        highest = std::max(highest, at.v[0]);
        ASSERT_LE(sphere.energy(at), before * (1 + 1e-9)) << speed << ' ' << k;
      }
      // The result changes continuously with the input.
      if (i > 0) {
        EXPECT_NEAR(highest, last, 0.1 * last) << speed;
      }
      last = highest;
    }
  }
}

TEST(ContactSprings, CalibrationHoldsForEveryDamping) {
  for (const double zeta : {0.0, 0.01, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9}) {
    const Dashpots d = calibrate(zeta);
    const auto time = [](double z) {
      return z < 1 ? std::acos(z) / std::sqrt(1 - z * z) : std::acosh(z) / std::sqrt(z * z - 1);
    };
    const double s = std::sqrt(1 - zeta * zeta);
    EXPECT_NEAR(d.in * time(d.in) + d.out * time(d.out), std::numbers::pi * zeta / s, 1e-9) << zeta;
    EXPECT_NEAR(time(d.in) + time(d.out) + 2 * d.out, std::numbers::pi / s, 1e-9) << zeta;
    EXPECT_GE(d.in, 0);
    EXPECT_GE(d.out, 0);
  }
}

TEST(ContactSprings, NeverPullAndNeverGainInAnyState) {
  Random random(41);
  Spring spring = make_spring(kStiffness, calibrate(kDamping), kMass, Law{0, 0, 0.8, 0.5, 0});
  for (int i = 0; i < 10000; ++i) {
    spring.linear_depth = i % 2 * 1e-3;
    spring.damped_depth = i % 3 * 1e-4;
    const double gap = between(random, -2e-3, 5e-4), rate = between(random, -0.2, 0.2);
    const Press normal = press(spring, gap, rate);
    EXPECT_GE(normal.force, 0);
    EXPECT_GE(normal.loss, 0);
    if (gap >= 0) {
      EXPECT_EQ(normal.force + normal.stored, 0);
    }
    const Vector2 stretch(between(random, -1e-3, 1e-3), between(random, -1e-3, 1e-3));
    const Vector2 slip(between(random, -0.2, 0.2), between(random, -0.2, 0.2));
    const Drag tangential = drag(spring, stretch, slip, normal.force);
    EXPECT_LE(tangential.force.norm(), 0.8 * normal.force * (1 + 1e-14));
    EXPECT_GE(tangential.loss, -1e-15);
    // The account closes: what the surfaces give is stored or lost.
    const double stored_rate = spring.tangential_stiffness * stretch.dot(tangential.stretch_rate);
    EXPECT_NEAR(stored_rate, -tangential.force.dot(slip) - tangential.loss, 1e-12);
    const double beyond = spring.linear_depth > 0 ? std::max(0.0, -gap - spring.linear_depth) : 0;
    const double elastic = -kStiffness * gap + (beyond > 0 ? 4.5 * kStiffness * beyond * beyond / 1e-3 : 0);
    if (gap < 0) {
      EXPECT_NEAR(-elastic * rate, -normal.force * rate - normal.loss, 1e-12);
      const double tiny = 1e-7 * gap;
      const double slope = (press(spring, gap + tiny, 0).stored - press(spring, gap - tiny, 0).stored) / (2 * tiny);
      EXPECT_NEAR(slope, -elastic, 1e-5 * elastic);
    }
  }
}

}  // namespace
}  // namespace breve::contact
