// Kinematic and free rigid motion against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/runtime/fake_behaviour.hpp"

namespace breve {
namespace {

using testing::Scene;

constexpr double kRounding = 1e-12;  // some hundred operations on numbers of size 1

TEST(Kinematics, IsExplicitEulerFromTheValuesAtTheStart) {
  Scene s;
  const ObjectId id = s.body(1, Vector3(1, 2, 3));
  const BodyIndex b = s.world.body(id);
  const Vector3 v(1, -2, 0.5), a(0.3, 0, -1);
  s.world.bodies().set_velocity(b, v);
  s.world.bodies().set_acceleration(b, a);
  const double h = s.world.integration_step();
  constexpr int kIterations = 20, kSubsteps = 3 * kIterations;
  for (int i = 0; i < kIterations; ++i) s.world.step();
  // p_n = p_0 + n h v + h^2 a n (n - 1) / 2
  const double n = kSubsteps;
  EXPECT_LT((s.at(id) - (Vector3(1, 2, 3) + n * h * v + h * h * a * n * (n - 1) / 2)).norm(), kRounding);
  EXPECT_LT((s.velocity(id) - (v + n * h * a)).norm(), kRounding);
}

TEST(Kinematics, RotatesInItsOwnFrameByEulerAndNormalises) {
  Scene s;
  const ObjectId id = s.body(1, Vector3::Zero());
  const BodyIndex b = s.world.body(id);
  s.world.bodies().set_orientation(b, Quaternion(Eigen::AngleAxisd(0.7, Vector3(1, 0, 0))));
  s.world.bodies().set_rotational_velocity(b, Vector3(0, 3, 0));
  const double h = s.world.integration_step();
  s.world.step();
  // Three sub-steps, each turning by 2 atan(w h / 2) about the body's own axis.
  const Quaternion rotation(Eigen::AngleAxisd(3 * 2 * std::atan(3 * h / 2), Vector3(0, 1, 0)));
  const Quaternion expected = Quaternion(Eigen::AngleAxisd(0.7, Vector3(1, 0, 0))) * rotation;
  EXPECT_LT(expected.angularDistance(s.world.bodies().orientation(b)), 1e-7);
  EXPECT_LT((s.world.bodies().rotation(b) - Matrix3(expected.toRotationMatrix())).norm(), kRounding);
}

TEST(Kinematics, AStoppedBodyIsNotLoopedOver) {
  Scene s;
  const ObjectId id = s.body(1, Vector3::Zero());
  s.set_velocity(id, Vector3(1, 0, 0));
  EXPECT_EQ(s.world.bodies().translating(), 1U);
  s.set_velocity(id, Vector3::Zero());
  EXPECT_EQ(s.world.bodies().translating(), 0U);
}

TEST(Kinematics, SettersRefuseWhatIsNotFiniteAndChangeNothing) {
  Scene s;
  const BodyIndex b = s.world.body(s.body(1, Vector3(1, 2, 3)));
  const Bodies& bodies = s.world.bodies();
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Vector3 v(0, bad, 0);
    const std::uint64_t before = s.world.hash();
    EXPECT_THROW(s.world.bodies().set_location(b, v), Error);
    EXPECT_THROW(s.world.bodies().set_velocity(b, v), Error);
    EXPECT_THROW(s.world.bodies().set_acceleration(b, v), Error);
    EXPECT_THROW(s.world.bodies().set_rotational_velocity(b, v), Error);
    EXPECT_THROW(s.world.bodies().set_rotational_acceleration(b, v), Error);
    EXPECT_THROW(s.world.bodies().set_force(b, v), Error);
    EXPECT_THROW(s.world.bodies().set_torque(b, v), Error);
    EXPECT_THROW(s.world.bodies().set_neighborhood_size(b, bad), Error);
    EXPECT_THROW(s.world.bodies().set_orientation(b, Quaternion(bad, 0, 0, 1)), Error);
    EXPECT_THROW(s.world.bodies().set_rotation(b, Matrix3::Constant(bad)), Error);
    EXPECT_THROW(s.world.set_gravity(v), Error);
    EXPECT_EQ(s.world.hash(), before);
  }
  try {
    s.world.bodies().set_velocity(b, Vector3(0, std::nan(""), 0));
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("velocity"), std::string::npos);
  }
  EXPECT_THROW(s.world.bodies().set_collision_shape(b, nullptr), Error);
  EXPECT_EQ(bodies.location(b), Vector3(1, 2, 3));
}

TEST(Kinematics, ARotationMatrixIsMadeOrthonormalAndASingularOneRefused) {
  Scene s;
  const BodyIndex b = s.world.body(s.body(1, Vector3::Zero()));
  const Matrix3 rotation = Quaternion(Eigen::AngleAxisd(1.1, Vector3(1, 2, 3).normalized())).toRotationMatrix();
  s.world.bodies().set_rotation(b, 2.5 * rotation);
  EXPECT_LT((s.world.bodies().rotation(b) - rotation).norm(), kRounding);
  Matrix3 bad = Matrix3::Identity();
  bad.row(2) = bad.row(1);
  EXPECT_THROW(s.world.bodies().set_rotation(b, bad), Error);
  EXPECT_THROW(s.world.bodies().set_rotation(b, Matrix3::Zero()), Error);
  EXPECT_THROW(s.world.bodies().set_rotation(b, -Matrix3::Identity()), Error);
  EXPECT_LT((s.world.bodies().rotation(b) - rotation).norm(), kRounding);
}

TEST(RigidMotion, FallsExactlyOnEveryRung) {
  for (const Rung rung : {Rung::Fast, Rung::Balanced, Rung::Precise, Rung::Reference, Rung::Conserving}) {
    Scene s;
    s.world.mechanics().set_accuracy(rung);
    const ObjectId id = s.body(1, Vector3::Zero());
    s.world.bodies().set_physics(s.world.body(id), true);
    for (int i = 0; i < 10; ++i) s.world.step();
    const double h = s.world.integration_step(), n = 30;
    EXPECT_NEAR(s.at(id).y(), -9.81 * h * h * n * n / 2, kRounding) << name_of(rung);
  }
}

TEST(RigidMotion, GravityIsAnEffectOfTheScene) {
  Scene s;
  const ObjectId id = s.body(1, Vector3::Zero());
  s.world.bodies().set_physics(s.world.body(id), true);
  s.world.step();
  EXPECT_TRUE(s.world.effects()[EffectId::Gravity].active);
}

TEST(RigidMotion, AForceAcceleratesByItsMassUntilReplaced) {
  Scene s;
  s.world.set_gravity(Vector3::Zero());
  const ObjectId id = s.body(1, Vector3::Zero(), BodyKind::Mobile, Shape::box(Vector3(1, 2, 1)));
  const BodyIndex b = s.world.body(id);
  s.world.bodies().set_physics(b, true);
  s.world.bodies().set_force(b, Vector3(4, 0, 0));
  for (int i = 0; i < 5; ++i) s.world.step();
  EXPECT_NEAR(s.velocity(id).x(), 4.0 / 2.0 * 0.3, kRounding);
  EXPECT_FALSE(s.world.effects()[EffectId::Gravity].active);
}

TEST(RigidMotion, ATorqueOnASphereGivesTorqueOverInertia) {
  Scene s;
  const ObjectId id = s.body(1, Vector3::Zero());
  const BodyIndex b = s.world.body(id);
  s.world.bodies().set_physics(b, true);
  s.world.bodies().set_torque(b, Vector3(0, 0, 2));
  s.world.step();
  const double inertia = s.world.bodies().collision_shape(b)->inertia()(0, 0);
  EXPECT_NEAR(s.world.bodies().rotational_velocity(b).z(), 2 / inertia * 0.06, kRounding);
}

TEST(RigidMotion, ASpinningBoxKeepsItsEnergyAndTheSizeOfItsMomentum) {
  Scene s;
  s.world.set_gravity(Vector3::Zero());
  const ObjectId id = s.body(1, Vector3::Zero(), BodyKind::Mobile, Shape::box(Vector3(1, 2, 5)));
  const BodyIndex b = s.world.body(id);
  s.world.bodies().set_physics(b, true);
  s.world.bodies().set_rotational_velocity(b, Vector3(0.01, 5, 0.02));  // the unstable axis: it tumbles
  const Matrix3 inertia = s.world.bodies().collision_shape(b)->inertia();
  const auto momentum = [&] {
    const Quaternion q = s.world.bodies().orientation(b);
    return Vector3(inertia * (q.conjugate() * s.world.bodies().rotational_velocity(b)));
  };
  const auto energy = [&] {
    const Vector3 w = s.world.bodies().orientation(b).conjugate() * s.world.bodies().rotational_velocity(b);
    return 0.5 * w.dot(inertia * w);
  };
  const double e0 = energy(), l0 = momentum().norm();
  double lowest = 1;
  for (int i = 0; i < 1000; ++i) {
    s.world.step();
    lowest = std::min(lowest, s.world.bodies().rotational_velocity(b).normalized().y());
  }
  constexpr double kKept = 1e-11;  // 3000 steps of round-off
  EXPECT_NEAR(energy() / e0, 1, kKept);
  EXPECT_NEAR(momentum().norm() / l0, 1, kKept);
  EXPECT_NEAR(s.world.bodies().orientation(b).norm(), 1, kRounding);
}

TEST(RigidMotion, TheCentreOfMassOfASpinningConeMovesInAStraightLine) {
  Scene s;
  s.world.set_gravity(Vector3::Zero());
  const ObjectId id = s.body(1, Vector3::Zero(), BodyKind::Mobile, Shape::cone(8, 2, 1));
  const BodyIndex b = s.world.body(id);
  s.world.bodies().set_physics(b, true);
  s.world.bodies().set_rotational_velocity(b, Vector3(1, 2, 3));
  const Vector3 c = s.world.bodies().collision_shape(b)->center_of_mass();
  ASSERT_GT(c.norm(), 0.1);
  const Vector3 start = c, drift = Vector3(1, 2, 3).cross(c);
  for (int i = 0; i < 50; ++i) s.world.step();
  const Vector3 now = s.at(id) + s.world.bodies().orientation(b) * c;
  EXPECT_LT((now - (start + s.world.time() * drift)).norm(), 1e-10);
}

TEST(RigidMotion, DisablingPhysicsGivesBackTheKinematicVelocity) {
  Scene s;
  const ObjectId id = s.body(1, Vector3::Zero());
  const BodyIndex b = s.world.body(id);
  s.set_velocity(id, Vector3(1, 0, 0));
  s.world.bodies().set_physics(b, true);
  EXPECT_EQ(s.velocity(id), Vector3(1, 0, 0)) << "the solver takes over position and velocity";
  s.world.step();
  EXPECT_LT(s.velocity(id).y(), 0);
  const Vector3 position = s.at(id);
  s.world.bodies().set_physics(b, false);
  EXPECT_EQ(s.velocity(id), Vector3(1, 0, 0));
  EXPECT_EQ(s.at(id), position);
}

}  // namespace
}  // namespace breve
