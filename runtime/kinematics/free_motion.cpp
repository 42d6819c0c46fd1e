// Implicit midpoint for the gyroscopic term: one 3x3 Newton solve a step.
#include "runtime/kinematics/free_motion.hpp"

#include <Eigen/LU>
#include <cmath>

namespace breve {

namespace {

Eigen::Matrix3d cross_matrix(const Vector3& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

Vector3 advance_spin(const Matrix3& inertia, const Vector3& spin, const Vector3& torque, double h, Vector3& middle) {
  // Solved for the midpoint m: I (m - w0) + h/2 (m x I m - torque) = 0; then w1 = 2 m - w0.
  constexpr int kMostIterations = 30;  // Newton converges in 3 to 6; more only where |w| h is far beyond use
  constexpr double kResidual = 4e-16;  // relative to the momentum: round-off of one evaluation
  Vector3 m = spin;
  const double scale = (inertia * spin).norm() + h * torque.norm();
  for (int i = 0; i < kMostIterations; ++i) {
    const Vector3 momentum = inertia * m;
    const Vector3 residual = inertia * (m - spin) + 0.5 * h * (m.cross(momentum) - torque);
    if (!(residual.norm() > kResidual * scale)) break;
    const Eigen::Matrix3d slope =
        Eigen::Matrix3d(inertia) + 0.5 * h * (cross_matrix(m) * inertia - cross_matrix(momentum));
    m -= slope.partialPivLu().solve(residual);
  }
  middle = m;
  return 2 * m - spin;
}

}  // namespace breve
