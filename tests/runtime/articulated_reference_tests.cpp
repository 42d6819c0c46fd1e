// Accelerations, energies and momenta of the twenty systems of mb_accel and mb_scalars.
#include <gtest/gtest.h>

#include "articulated_reference.hpp"
#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/inverse_dynamics.hpp"
#include "runtime/articulated/kinematics.hpp"

namespace breve::articulated::reference_tests {
namespace {

using reference::Row;

// The references have more digits than a double; of its sixteen the algorithm may lose five, at condition numbers of
// the mass matrix up to 1e5.
constexpr double kRelative = 1e-11;

class MultibodyReference : public testing::TestWithParam<std::string> {
 protected:
  MultibodyReference() : given_(reference::load(GetParam())), model_(given_.links), data_(model_) {}

  /// Largest difference, relative to the largest number of the same kind in the system.
  void expect_near(const std::vector<Vector3>& got, const std::vector<Vector3>& expected, const char* what) {
    double scale = 0, error = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      scale = std::max(scale, expected[i].cwiseAbs().maxCoeff());
      error = std::max(error, (got[i] - expected[i]).cwiseAbs().maxCoeff());
    }
    RecordProperty(what, std::to_string(error / scale));
    EXPECT_LE(error, kRelative * scale) << what << ", relative " << error / scale;
    worst_ = std::max(worst_, scale > 0 ? error / scale : 0);
  }
  void TearDown() override { std::printf("  %-14s largest relative error %.1e\n", GetParam().c_str(), worst_); }

  reference::Case given_;
  Model model_;
  Data data_;
  double worst_ = 0;
};

TEST_P(MultibodyReference, JointAccelerationsAreMet) {
  Vector expected;
  for (const Row& row : reference::rows_of(reference::read("mb_accel"), GetParam()))
    reference::append(expected, reference::numbers(row, "qdd", 6));
  const Vector& got = forward_dynamics(model_, data_, given_.state, given_.loads);
  ASSERT_EQ(got.size(), expected.size());
  for (Eigen::Index i = 0; i < got.size(); ++i) {
    // Relative to the component, or to a thousandth of the largest one where it is smaller than that.
    const double scale = std::max(std::abs(expected[i]), 1e-3 * expected.cwiseAbs().maxCoeff());
    EXPECT_LE(std::abs(got[i] - expected[i]), kRelative * scale) << "acceleration " << i;
    worst_ = std::max(worst_, std::abs(got[i] - expected[i]) / scale);
  }
}

TEST_P(MultibodyReference, WorldAccelerationsAreMet) {
  std::vector<Vector3> acom, alpha, acom_expected, alpha_expected;
  for (const Row& row : reference::rows_of(reference::read("mb_accel"), GetParam())) {
    acom_expected.push_back(row.vector("acom_"));
    alpha_expected.push_back(row.vector("alpha_"));
  }
  forward_kinematics(model_, data_, given_.state);
  forward_dynamics(model_, data_, given_.state, given_.loads);
  for (int i = 0; i < model_.size(); ++i) {
    acom.push_back(com_acceleration(model_, data_, given_.loads, i));
    alpha.push_back(rotational_acceleration(data_, i));
  }
  ASSERT_EQ(acom.size(), acom_expected.size());
  expect_near(acom, acom_expected, "centres of mass");
  expect_near(alpha, alpha_expected, "rotational");
}

TEST_P(MultibodyReference, InverseDynamicsGivesTheForcesBack) {
  Vector acceleration;
  for (const Row& row : reference::rows_of(reference::read("mb_accel"), GetParam()))
    reference::append(acceleration, reference::numbers(row, "qdd", 6));
  Vector tau(model_.velocities());
  inverse_dynamics(model_, data_, given_.state, acceleration, given_.loads, tau);
  // Forces that gravity and motion balance are what round-off is relative to.
  Vector holding(model_.velocities());
  inverse_dynamics(model_, data_, given_.state, Vector::Zero(model_.velocities()), given_.loads, holding);
  const double scale = holding.cwiseAbs().maxCoeff() + tau.cwiseAbs().maxCoeff() + 1;
  worst_ = (tau - given_.loads.tau).cwiseAbs().maxCoeff() / scale;
  EXPECT_LE(worst_, kRelative);
}

TEST_P(MultibodyReference, EnergyAndMomentumAreMet) {
  const Row row = reference::rows_of(reference::read("mb_scalars"), GetParam()).at(0);
  forward_kinematics(model_, data_, given_.state);
  const double kinetic = kinetic_energy(model_, data_);
  const double potential = potential_energy(model_, data_, given_.loads.gravity);
  EXPECT_NEAR(kinetic, row.number("kinetic"), kRelative * row.number("kinetic"));
  EXPECT_NEAR(potential, row.number("potential"), kRelative * (std::abs(row.number("potential")) + model_.mass()));
  const Vector3 p = linear_momentum(model_, data_), l = angular_momentum(model_, data_, Vector3::Zero());
  expect_near({p}, {row.vector("P")}, "momentum");
  expect_near({l}, {row.vector("L")}, "angular momentum");
  worst_ = std::max(worst_, std::abs(kinetic / row.number("kinetic") - 1));
}

INSTANTIATE_TEST_SUITE_P(Files, MultibodyReference, testing::ValuesIn(reference::case_names("mb_scalars")),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace breve::articulated::reference_tests
