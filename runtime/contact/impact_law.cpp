// Chatterjee and Ruina's law, written so that singular collision matrices need no case of their own.
#include "runtime/contact/impact_law.hpp"

#include <algorithm>
#include <cmath>

namespace breve::contact {

namespace {

using Vector2 = Eigen::Vector2d;
using Matrix2 = Eigen::Matrix2d;

/// x with S x = b for a positive semidefinite S; where S cannot reach b, the shortest x that comes nearest.
/// @param noise  eigenvalues up to this count as zero
Vector2 solve_semidefinite(const Matrix2& S, const Vector2& b, double noise) {
  const double half_trace = 0.5 * (S(0, 0) + S(1, 1)), half_difference = 0.5 * (S(0, 0) - S(1, 1));
  const double spread = std::hypot(half_difference, S(0, 1));
  const double larger = half_trace + spread, smaller = half_trace - spread;
  if (!(larger > noise)) return Vector2::Zero();
  if (smaller > noise)
    return Vector2(S(1, 1) * b[0] - S(0, 1) * b[1], S(0, 0) * b[1] - S(0, 1) * b[0]) /
           (S(0, 0) * S(1, 1) - S(0, 1) * S(0, 1));
  // The eigenvector of the larger eigenvalue; of its two forms the one without cancellation.
  const Vector2 axis =
      half_difference >= 0 ? Vector2(half_difference + spread, S(0, 1)) : Vector2(S(0, 1), spread - half_difference);
  return axis * (axis.dot(b) / (larger * axis.squaredNorm()));
}

}  // namespace

void tangents(const Vector3& n, Vector3& t1, Vector3& t2) {
  // Duff et al. 2017, "Building an orthonormal basis, revisited": exact for every unit n.
  const double sign = std::copysign(1.0, n.z());
  const double a = -1 / (sign + n.z()), b = n.x() * n.y() * a;
  t1 = Vector3(1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
  t2 = Vector3(b, sign + n.y() * n.y() * a, -n.y());
}

Vector3 impact_impulse(const Matrix3& W, const Vector3& v, const Vector3& n, const Law& law) {
  const double approach = -n.dot(v);
  const Vector3 Wn = W * n;
  const double give = n.dot(Wn);
  // A response to a push along n that is only round-off counts as zero.
  if (!(approach > 0) || !(give > 1e-15 * W.trace())) return Vector3::Zero();

  const bool bounces = approach >= law.restitution_threshold;
  const double e = bounces ? law.restitution : 0, e_t = bounces ? law.tangential_restitution : 0;
  const double stop = approach / give;  // P_I = stop n
  if (law.static_friction == 0) return (1 + e) * stop * n;

  // D = P_II - P_I does no work along n: n . W D = 0. So it is known by its tangential part, through the response S of
  // the tangential velocity while the normal one is held.
  Vector3 t1, t2;
  tangents(n, t1, t2);
  const Vector2 across(t1.dot(Wn), t2.dot(Wn));
  const Vector3 W1 = W * t1, W2 = W * t2;
  Matrix2 S;
  S << t1.dot(W1), t1.dot(W2), t1.dot(W2), t2.dot(W2);
  const double noise = 1e-13 * (S.trace() + across.squaredNorm() / give);
  S -= across * across.transpose() / give;
  const Vector2 slip = Vector2(t1.dot(v), t2.dot(v)) + across * stop;  // left over by P_I
  const Vector2 d = solve_semidefinite(S, -slip, noise);
  const double d_n = -across.dot(d) / give, d_t = d.norm();

  double kappa = 1 + e_t;
  const double base = (1 + e) * stop;
  if (kappa * d_t > law.static_friction * (base + kappa * d_n)) {
    const double mu = law.dynamic_friction;
    kappa = std::min(kappa, mu * base / (d_t - mu * d_n));
  }
  const Vector2 p_t = kappa * d;
  return (base + kappa * d_n) * n + p_t[0] * t1 + p_t[1] * t2;
}

}  // namespace breve::contact
