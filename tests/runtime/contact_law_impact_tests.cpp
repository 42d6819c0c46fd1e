// The law of one impact: against the reference impulses, and what must hold for every collision there is.
#include <gtest/gtest.h>

#include "articulated_random.hpp"
#include "articulated_reference.hpp"
#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/contact/impact_law.hpp"

namespace breve::contact {
namespace {

using articulated::between;
using articulated::random_rotation;
using articulated::random_vector;
namespace reference = articulated::reference;

constexpr double kReference = 1e-10;  // the bound on impulses

Matrix3 cross_matrix(const Vector3& r) {
  Matrix3 m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
}

/// What a free body adds to the collision matrix at a point `r` from its centre of mass.
Matrix3 response(double mass, const Matrix3& inertia, const Vector3& r) {
  const Matrix3 cross = cross_matrix(r);
  return Matrix3::Identity() / mass - cross * inertia.inverse() * cross;
}

Law law_of(const reference::Row& row) {
  Law law;
  law.restitution = row.number("e");
  law.tangential_restitution = row.number("e_t");
  law.static_friction = law.dynamic_friction = row.number("mu");
  return law;
}

Matrix3 response_of(const reference::Row& row, const std::string& body, const Vector3& point) {
  if (row.text("m_" + body) == "fixed") return Matrix3::Zero();
  const auto element = [&](const char* name) { return row.number("I_" + body + "_" + name); };
  Matrix3 inertia;
  inertia << element("xx"), element("xy"), element("xz"), element("xy"), element("yy"), element("yz"), element("xz"),
      element("yz"), element("zz");
  return response(row.number("m_" + body), inertia, point - row.vector("x_" + body + "_"));
}

TEST(ImpactLaw, GivesTheReferenceImpulsesOfFreeBodies) {
  int cases = 0;
  for (const reference::Row& row : reference::read("cr_collisions")) {
    const Vector3 point = row.vector("c");
    const Matrix3 W = response_of(row, "A", point) + response_of(row, "B", point);
    const Vector3 v = row.vector("vrel_");
    const Vector3 p = impact_impulse(W, v, row.vector("n").normalized(), law_of(row));
    EXPECT_LE((p - row.vector("P_")).norm(), kReference * row.vector("P_").norm()) << row.text("case");
    EXPECT_LE((v + W * p - row.vector("vrel_after_")).norm(), kReference * v.norm()) << row.text("case");
    EXPECT_NEAR(p.dot(v) + 0.5 * p.dot(W * p), row.number("energy_change"), 1e-10) << row.text("case");
    ++cases;
  }
  EXPECT_EQ(cases, 8);
}

/// Two uniform rods in the x-z plane; angles of the file are absolute, from straight down.
articulated::Model pendulum_of(const reference::Row& row) {
  std::vector<articulated::Link> links(2);
  for (int i = 0; i < 2; ++i) {
    articulated::Link& link = links[static_cast<std::size_t>(i)];
    const std::string number = std::to_string(i + 1);
    const double length = row.number("L" + number), mass = row.number("m" + number);
    link.parent = i - 1;
    link.axis = -Vector3::UnitY();  // positive: from -z toward +x
    if (i == 1) link.position = Vector3(0, 0, -row.number("L1"));
    link.mass = mass;
    link.com = Vector3(0, 0, -length / 2);
    const double across = mass * length * length / 12;
    link.inertia = Vector3(across, across, 1e-4 * across).asDiagonal();
  }
  return articulated::Model(links);
}

TEST(ImpactLaw, GivesTheReferenceImpulsesOfPendulums) {
  int cases = 0;
  for (const reference::Row& row : reference::read("cr_pendulum")) {
    const articulated::Model model = pendulum_of(row);
    articulated::Data data(model);
    articulated::State state = articulated::neutral_state(model);
    state.q << row.number("theta1"), row.number("theta2") - row.number("theta1");
    state.v << row.number("omega1"), row.number("omega2") - row.number("omega1");
    articulated::forward_kinematics(model, data, state);
    articulated::factorize(model, data, state, articulated::Loads{});
    const Vector3 tip = data.motion_of(1).origin + data.of(1).rotation * Vector3(0, 0, -row.number("L2"));
    const Matrix3 W = articulated::collision_matrix(model, data, 1, tip, -1, tip).matrix();
    const Vector3 n(row.number("nx"), 0, row.number("nz"));
    const Vector3 v(row.number("vrel_x"), 0, row.number("vrel_z"));
    const Vector3 p = impact_impulse(W, v, n, law_of(row));
    EXPECT_LE((p - Vector3(row.number("P_x"), 0, row.number("P_z"))).norm(), kReference * p.norm()) << row.text("case");
    articulated::Vector change(2);
    const articulated::Impulse impulse{1, tip, p};
    articulated::impulse_response(model, data, {&impulse, 1}, change);
    EXPECT_NEAR(state.v[0] + change[0], row.number("omega1_after"), kReference) << row.text("case");
    EXPECT_NEAR(state.v[0] + state.v[1] + change[0] + change[1], row.number("omega2_after"), kReference);
    ++cases;
  }
  EXPECT_EQ(cases, 2);
}

struct Collision {
  Matrix3 W;
  Vector3 v, n;
  Law law;
};

/// Two bodies, or one against a wall, with masses to 1e4:1, thin bodies, points far out, all laws.
Collision random_collision(Random& random) {
  Collision out;
  out.W.setZero();
  const int bodies = 1 + static_cast<int>(random.below(2));
  for (int i = 0; i < bodies; ++i) {
    const double mass = std::pow(10, between(random, -2, 2));
    const Vector3 size(std::pow(10, between(random, -2, 1)), std::pow(10, between(random, -2, 1)), 1);
    const Vector3 squares = size.cwiseProduct(size);
    const Matrix3 rotation = random_rotation(random).toRotationMatrix();
    const Matrix3 inertia =
        mass / 12 * rotation *
        Vector3(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y()).asDiagonal() *
        rotation.transpose();
    out.W += response(mass, inertia, rotation * (0.5 * size.cwiseProduct(random_vector(random, 1))));
  }
  out.W = (0.5 * (out.W + out.W.transpose())).eval();
  out.n = random_vector(random, 1).normalized();
  out.v = random_vector(random, 5);
  if (random.below(10) == 0) out.v -= out.n.dot(out.v) * (1 - 1e-9) * out.n;  // grazing
  if (random.below(10) == 0) out.v = out.n.dot(out.v) * out.n;                // head on
  if (out.n.dot(out.v) > 0) out.v = -out.v;
  const auto one_of = [&](double a, double b, double c) {
    const auto which = random.below(3);
    return which == 0 ? a : which == 1 ? b : c;
  };
  out.law.restitution = one_of(0, 1, random.uniform());
  out.law.tangential_restitution = one_of(0, between(random, -1, 1), 1);
  out.law.dynamic_friction = one_of(0, 0.2 * random.uniform(), 3 * random.uniform());
  out.law.static_friction = out.law.dynamic_friction * one_of(1, 1, 1.5);
  return out;
}

TEST(ImpactLaw, KeepsConeRestitutionAndEnergyInAHundredThousandCollisions) {
  Random random(11);
  double cone = 0, restitution = 0, energy = 0;
  int sliding = 0;
  for (int i = 0; i < 100000; ++i) {
    const Collision c = random_collision(random);
    const Vector3 p = impact_impulse(c.W, c.v, c.n, c.law);
    ASSERT_TRUE(p.allFinite());
    const double p_n = c.n.dot(p), approach = -c.n.dot(c.v);
    const double p_t = (p - p_n * c.n).norm();
    const double limit =
        c.law.static_friction * p_n * (1 + 1e-12) + 1e-15 * p.norm();  // the round-off of taking P apart
    if (p_t > limit) cone = std::max(cone, (p_t - limit) / p.norm());
    if (p_t > 0 && p_t > 0.999 * c.law.dynamic_friction * p_n) ++sliding;
    restitution = std::max(restitution, std::abs(c.n.dot(c.v + c.W * p) - c.law.restitution * approach) / c.v.norm());
    energy = std::max(energy, (p.dot(c.v) + 0.5 * p.dot(c.W * p)) / (p.norm() * c.v.norm() + 1e-300));
  }
  EXPECT_EQ(cone, 0);
  EXPECT_LE(restitution, 1e-11);
  EXPECT_LE(energy, 1e-15);  // of what the impulse does: round-off
  EXPECT_GT(sliding, 10000);
}

TEST(ImpactLaw, WithoutFrictionTheImpulseIsNormal) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    Collision c = random_collision(random);
    c.law.static_friction = c.law.dynamic_friction = 0;
    const Vector3 p = impact_impulse(c.W, c.v, c.n, c.law);
    EXPECT_LE((p - c.n.dot(p) * c.n).norm(), 1e-15 * p.norm());
  }
}

TEST(ImpactLaw, WhatPartsOrCannotMoveGetsNoImpulse) {
  Law law{1, 0, 0.5, 0.5, 0};
  EXPECT_EQ(impact_impulse(Matrix3::Identity(), Vector3(1, 0, 2), Vector3::UnitZ(), law), Vector3::Zero());
  EXPECT_EQ(impact_impulse(Matrix3::Identity(), Vector3(1, 0, 0), Vector3::UnitZ(), law), Vector3::Zero());
  EXPECT_EQ(impact_impulse(Matrix3::Zero(), Vector3(0, 0, -2), Vector3::UnitZ(), law), Vector3::Zero());
  // A slider that can only move across the normal.
  const Matrix3 across = Vector3(1, 0, 0).asDiagonal();
  EXPECT_EQ(impact_impulse(across, Vector3(3, 0, -2), Vector3::UnitZ(), law), Vector3::Zero());
}

TEST(ImpactLaw, SingularResponsesChangeWhatTheyCan) {
  Random random(5);
  double restitution = 0, energy = 0;
  for (int i = 0; i < 20000; ++i) {
    Collision c = random_collision(random);
    // One or two directions in which the point can move; velocities that no impulse reaches besides.
    Matrix3 W = Matrix3::Zero();
    for (int k = 0; k < 1 + i % 2; ++k) {
      const Vector3 way = random_vector(random, 1);
      W += way * way.transpose();
    }
    if (c.n.dot(W * c.n) < 1e-3) continue;
    const Vector3 p = impact_impulse(W, c.v, c.n, c.law);
    const double p_n = c.n.dot(p);
    ASSERT_TRUE(p.allFinite());
    ASSERT_LE((p - p_n * c.n).norm(), c.law.static_friction * p_n * (1 + 1e-12) + 1e-15 * p.norm());
    restitution = std::max(restitution, std::abs(c.n.dot(c.v + W * p) + c.law.restitution * c.n.dot(c.v)) /
                                            (c.v.norm() + W.norm() * p.norm()));
    energy = std::max(energy, (p.dot(c.v) + 0.5 * p.dot(W * p)) / (p.norm() * c.v.norm() + 1e-300));
  }
  EXPECT_LE(restitution, 1e-13);
  EXPECT_LE(energy, 1e-13);
}

TEST(ImpactLaw, SlowApproachesDoNotBounce) {
  Law law{0.8, 0.5, 0, 0, 0.05};
  const Vector3 n = Vector3::UnitZ();
  EXPECT_NEAR(impact_impulse(Matrix3::Identity(), -0.06 * n, n, law).z(), 1.8 * 0.06, 1e-15);
  EXPECT_NEAR(impact_impulse(Matrix3::Identity(), -0.04 * n, n, law).z(), 0.04, 1e-15);
}

TEST(ImpactLaw, StaticFrictionHoldsWhatDynamicFrictionWouldLetSlide) {
  // A unit mass point: to stop a slip of 1 with a normal impulse of 2 takes a coefficient of 0.5.
  const Vector3 v(1, 0, -2), n = Vector3::UnitZ();
  EXPECT_NEAR(impact_impulse(Matrix3::Identity(), v, n, Law{0, 0, 0.51, 0.3, 0}).x(), -1, 1e-14);
  EXPECT_NEAR(impact_impulse(Matrix3::Identity(), v, n, Law{0, 0, 0.49, 0.3, 0}).x(), -0.6, 1e-14);
}

TEST(ImpactLaw, TangentsAreUnitAndPerpendicularForEveryNormal) {
  Random random(8);
  for (int i = 0; i < 1000; ++i) {
    Vector3 n = random_rotation(random) * Vector3::UnitZ(), t1, t2;
    if (i < 6) n = (i % 2 == 0 ? 1 : -1) * Vector3::Unit(i / 2);
    tangents(n, t1, t2);
    EXPECT_LE((t1.cross(t2) - n).norm(), 1e-15);
    EXPECT_LE(std::abs(t1.dot(n)) + std::abs(t1.norm() - 1) + std::abs(t2.norm() - 1), 2e-15);
  }
}

TEST(Materials, OldNumbersCombineAsTheTableSays) {
  Material a, b;
  a.friction = 0.2;
  b.friction = 0.6;
  a.restitution = 0.4;
  b.restitution = 0.8;
  const Law law = combine(a, b);
  EXPECT_DOUBLE_EQ(law.static_friction, 1.4);
  EXPECT_DOUBLE_EQ(law.dynamic_friction, 1.4);
  EXPECT_DOUBLE_EQ(law.restitution, 0.6);
  EXPECT_DOUBLE_EQ(law.restitution_threshold, 0.05);
  EXPECT_EQ(law.tangential_restitution, 0);
}

TEST(Materials, ExactNumbersCombineExactlyIfBothBodiesHaveThem) {
  Material a, b;
  a.static_friction = 0.9;
  a.dynamic_friction = 0.4;
  b.static_friction = 0.4;
  b.dynamic_friction = 0.1;
  a.normal_restitution = 0.3;
  b.normal_restitution = 0.5;
  a.tangential_restitution = 0.2;
  b.restitution_threshold = 0.01;
  const Law law = combine(a, b);
  EXPECT_DOUBLE_EQ(law.static_friction, 0.6);
  EXPECT_DOUBLE_EQ(law.dynamic_friction, 0.2);
  EXPECT_DOUBLE_EQ(law.restitution, 0.5);
  EXPECT_DOUBLE_EQ(law.tangential_restitution, 0.2);
  EXPECT_DOUBLE_EQ(law.restitution_threshold, 0.01);
  // Equal bodies give their own number back, bit for bit.
  EXPECT_EQ(combine(a, a).static_friction, 0.9);
  EXPECT_EQ(combine(b, b).dynamic_friction, 0.1);
}

TEST(Materials, MixedKindsFallBackOnTheOldNumbers) {
  Material exact, old;
  exact.static_friction = exact.dynamic_friction = 0;
  exact.normal_restitution = 1;
  EXPECT_DOUBLE_EQ(combine(exact, old).static_friction, 1.15);
  EXPECT_DOUBLE_EQ(combine(old, exact).restitution, 0.4);
  old.restitution = 5;
  EXPECT_DOUBLE_EQ(combine(old, old).restitution, 1);
}

}  // namespace
}  // namespace breve::contact
