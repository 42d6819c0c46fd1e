// The forces of joints that close rings, inside the stages of an integrator: such that the second derivative of what
// holds the ring closed is zero (Lagrange's multipliers, with the responses of the articulated body). What is left to
// drift is an integrator's error; positions and velocities are put on the ring at the end of the sub-step.
#include <algorithm>
#include <cmath>

#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/island.hpp"

namespace breve {

namespace {

/// Second derivative of a row's error by the links' accelerations, which forward dynamics left.
double curvature(const Tree& tree, const RingRows& ring, const RingRow& row) {
  const articulated::Work &c = tree.data.of(ring.child), &p = tree.data.of(ring.parent);
  if (row.angular) {
    const Vector3 spin = c.spin - p.spin;
    if (!ring.universal) return row.axis.dot(c.alpha - p.alpha - p.spin.cross(spin));
    const Vector3 bend = p.spin.cross(ring.first).cross(ring.second) + ring.first.cross(c.spin.cross(ring.second));
    return row.axis.dot(c.alpha - p.alpha) + spin.dot(bend);
  }
  const auto at = [&tree](int link, const Vector3& point, const articulated::Work& work) {
    const Vector3 arm = point - tree.data.motion_of(link).origin;
    return Vector3(work.acc + work.alpha.cross(arm) + work.spin.cross(work.spin.cross(arm)));
  };
  const Vector3 speed = articulated::point_velocity(tree.data, ring.child, row.on_child) -
                        articulated::point_velocity(tree.data, ring.parent, row.on_parent);
  return row.axis.dot(at(ring.child, row.on_child, c) - at(ring.parent, row.on_parent, p) - 2 * p.spin.cross(speed));
}

/// What a row's column would be by itself if nothing cancelled: arms for what turns, 1 for what slides.
double natural_size(const Tree& tree, int link, const RingRow& row, int column) {
  using articulated::JointType;
  const JointType type = tree.model.body(link).type;
  if (row.angular || type == JointType::Prismatic || (type == JointType::Free && column < 3)) return 1;
  const Vector3& origin = tree.data.motion_of(link).origin;
  return std::max((row.on_child - origin).norm(), (row.on_parent - origin).norm());
}

/// Solves the symmetric, positive semidefinite A x = b by Cholesky's method with the largest pivot next. Rows that
/// depend on others (a plane ring holds its plane several times over) get nothing. A is m x m and is overwritten.
void solve_semidefinite(int m, double* a, double* b, double* scale, int* order) {
  constexpr double kDependent = 1e-11;  // of a pivot, rows being scaled to 1
  for (int i = 0; i < m; ++i) {
    order[i] = i;
    scale[i] = a[i * m + i] > 0 ? 1 / std::sqrt(a[i * m + i]) : 0;
  }
  for (int i = 0; i < m; ++i) {
    b[i] *= scale[i];
    for (int k = 0; k < m; ++k) a[i * m + k] *= scale[i] * scale[k];
  }
  const auto at = [&](int i, int k) -> double& { return a[order[i] * m + order[k]]; };
  int rank = 0;
  for (; rank < m; ++rank) {
    int best = rank;
    for (int i = rank + 1; i < m; ++i)
      if (at(i, i) > at(best, best)) best = i;
    std::swap(order[rank], order[best]);
    if (!(at(rank, rank) > kDependent)) break;
    at(rank, rank) = std::sqrt(at(rank, rank));
    for (int i = rank + 1; i < m; ++i) at(i, rank) /= at(rank, rank);
    for (int i = rank + 1; i < m; ++i)
      for (int k = rank + 1; k <= i; ++k) at(i, k) = at(k, i) = at(i, k) - at(i, rank) * at(k, rank);
  }
  for (int i = 0; i < rank; ++i) {
    for (int k = 0; k < i; ++k) b[order[i]] -= at(i, k) * b[order[k]];
    b[order[i]] /= at(i, i);
  }
  for (int i = rank - 1; i >= 0; --i) {
    for (int k = i + 1; k < rank; ++k) b[order[i]] -= at(k, i) * b[order[k]];
    b[order[i]] /= at(i, i);
  }
  for (int i = rank; i < m; ++i) b[order[i]] = 0;
  for (int i = 0; i < m; ++i) b[i] *= scale[i];
}

}  // namespace

void Island::fill_ring(Tree& tree, const RingRows& ring, const RingRow& row, double* j) {
  constexpr double kRoundOff = 1e-9;  // of the natural size; arms far from the world's origin have fewer digits
  const int n = tree.model.velocities();
  std::fill(j, j + n, 0.0);
  if (ring.child >= 0) fill(tree, ring.child, row.on_child, row.axis, row.angular, 1, j);
  if (ring.parent >= 0) fill(tree, ring.parent, row.on_parent, row.axis, row.angular, -1, j);
  for (int i = 0; i < tree.model.size(); ++i) {
    const articulated::Body& body = tree.model.body(i);
    for (int k = 0; k < articulated::velocity_count(body.type); ++k)
      if (std::abs(j[body.v + k]) > kRoundOff * natural_size(tree, i, row, k)) return;
  }
  std::fill(j, j + n, 0.0);
}

void Dynamics::Core::hold_rings(Tree& tree, double* acceleration) {
  const int n = tree.model.velocities();
  const int most = kMostRingRows * static_cast<int>(tree.rings.size());
  double *j = tree.ring_numbers.data(), *r = j + most * n, *a = r + most * n, *scale = a + most * most;
  articulated::forward_kinematics(tree.model, tree.data, tree.state);
  int m = 0;
  // All second derivatives first: what answers impulses overwrites the accelerations that they are made of.
  for (const JointIndex index : tree.rings) {
    const RingRows ring = ring_rows(tree, joints[index].is);
    for (int i = 0; i < ring.count; ++i, ++m) {
      const RingRow& row = ring.rows[static_cast<std::size_t>(i)];
      tree.ring_forces[static_cast<std::size_t>(m)] = -curvature(tree, ring, row);
      Island::fill_ring(tree, ring, row, j + m * n);
    }
  }
  using Numbers = Eigen::Map<articulated::Vector>;
  for (int i = 0; i < m; ++i) {
    tree.work_v = Numbers(j + i * n, n);
    articulated::apply_inverse_mass(tree.model, tree.data, tree.work_v, tree.work_u);
    Numbers(r + i * n, n) = tree.work_u;
  }
  for (int i = 0; i < m; ++i)
    for (int k = 0; k <= i; ++k) a[i * m + k] = a[k * m + i] = Numbers(j + i * n, n).dot(Numbers(r + k * n, n));
  solve_semidefinite(m, a, tree.ring_forces.data(), scale, tree.ring_order.data());
  for (int i = 0; i < m; ++i)
    Numbers(acceleration, n) += tree.ring_forces[static_cast<std::size_t>(i)] * Numbers(r + i * n, n);
}

/// Adds what rings push with, as hold_rings found it last, to the forces on links. Gives that of one joint on its
/// child, about the joint's point.
JointReaction Dynamics::Core::push_by_rings(Tree& tree, JointIndex wanted) {
  JointReaction of;
  std::size_t m = 0;
  for (const JointIndex index : tree.rings) {
    const RingRows ring = ring_rows(tree, joints[index].is);
    for (int i = 0; i < ring.count; ++i, ++m) {
      const RingRow& row = ring.rows[static_cast<std::size_t>(i)];
      const Vector3 push = tree.ring_forces[m] * row.axis;
      if (index == wanted) (row.angular ? of.torque : of.force) += push;
      const auto act = [&](int link, const Vector3& point, double sign) {
        if (link < 0) return;
        articulated::Wrench& wrench = tree.loads.wrenches[static_cast<std::size_t>(link)];
        if (row.angular) {
          wrench.couple += sign * push;
          return;
        }
        wrench.force += sign * push;
        wrench.couple += (point - articulated::com_position(tree.model, tree.data, link)).cross(sign * push);
      };
      act(ring.child, row.on_child, 1);
      act(ring.parent, row.on_parent, -1);
    }
  }
  return of;
}

void Tree::reserve_rings() {
  const std::size_t n = static_cast<std::size_t>(model.velocities()), m = kMostRingRows * rings.size();
  ring_numbers.resize(2 * m * n + m * m + m);
  ring_forces.assign(m, 0.0);
  ring_order.resize(m);
}

}  // namespace breve
