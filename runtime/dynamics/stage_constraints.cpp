// The forces of joints that close loops, inside the stages of an integrator: such that the second derivative of what
// holds the loop closed is zero (Lagrange's multipliers, with the responses of the articulated body); and those of
// limits, which push as long as a joint would otherwise come too fast. The drift that remains is an integrator's error;
// positions and velocities are put right at the end of the sub-step.
#include <algorithm>
#include <cmath>

#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/contact/semidefinite.hpp"
#include "runtime/dynamics/core.hpp"
#include "runtime/dynamics/jacobians.hpp"

namespace breve {

namespace {

/// Second derivative of a row's error by the links' accelerations, which forward dynamics left.
double curvature(const Tree& tree, const LoopRows& loop, const LoopRow& row) {
  const articulated::Work &c = tree.data.of(loop.child), &p = tree.data.of(loop.parent);
  if (row.angular) {
    const Vector3 spin = c.spin - p.spin;
    if (!loop.universal) return row.axis.dot(c.alpha - p.alpha - p.spin.cross(spin));
    const Vector3 bend = p.spin.cross(loop.first).cross(loop.second) + loop.first.cross(c.spin.cross(loop.second));
    return row.axis.dot(c.alpha - p.alpha) + spin.dot(bend);
  }
  const auto at = [&tree](int link, const Vector3& point, const articulated::Work& work) {
    const Vector3 arm = point - tree.data.motion_of(link).origin;
    return Vector3(work.acc + work.alpha.cross(arm) + work.spin.cross(work.spin.cross(arm)));
  };
  const Vector3 speed = articulated::point_velocity(tree.data, loop.child, row.on_child) -
                        articulated::point_velocity(tree.data, loop.parent, row.on_parent);
  return row.axis.dot(at(loop.child, row.on_child, c) - at(loop.parent, row.on_parent, p) - 2 * p.spin.cross(speed));
}

/// Rows of loops, then of limits, in a tree's row_numbers.
struct HeldRows {
  int count, first_limit;
  const double* responses;  // count x count: how a force along one changes the acceleration along another
  double* part;             // as large
  const double* wanted;     // accelerations
  double* scale;            // count
  const WorkBound& bound;   // says whether the host wants the end
};

/// Finds the tree's row_forces. Limits push only, and where they do not, the acceleration is above what is wanted: a
/// linear complementarity problem, by principal pivots of the first row that is wrong.
/// Source: Murty 1974 (finite for rows that are independent; else it ends somewhere, and the next sub-step goes on).
/// @return  how many equations were solved
int solve_pushing(const HeldRows& rows, Tree& tree) {
  constexpr double kRoundOff = 1e-9;  // of the largest force, of the largest acceleration
  const int m = rows.count, first = rows.first_limit;
  double* force = tree.row_forces.data();
  const auto holds = [&](int row) { return row < first || tree.held[static_cast<std::size_t>(row - first)].holds; };
  const auto largest = [m](const double* of) {
    double most = 0;
    for (int i = 0; i < m; ++i) most = std::max(most, std::abs(of[i]));
    return most;
  };
  const auto wrong = [&](int row, double least_force, double most_lack) {
    if (holds(row)) return force[row] < -least_force;
    double lack = rows.wanted[row];
    for (int k = 0; k < m; ++k) lack -= rows.responses[row * m + k] * force[k];
    return lack > most_lack;
  };
  const int most = 2 * (m - first) * (m - first) + 1;
  for (int solved = 1;; ++solved) {
    for (int i = 0; i < m; ++i) {
      force[i] = holds(i) ? rows.wanted[i] : 0;
      for (int k = 0; k < m; ++k) rows.part[i * m + k] = holds(i) && holds(k) ? rows.responses[i * m + k] : 0;
    }
    contact::Semidefinite equations(m, rows.part, rows.scale, tree.row_order.data());
    equations.factorize(rows.bound);
    equations.solve(force);
    const double least_force = kRoundOff * largest(force), most_lack = kRoundOff * largest(rows.wanted);
    int row = first;
    while (row < m && !wrong(row, least_force, most_lack)) ++row;
    if (row == m || solved == most) return solved;
    bool& of_row = tree.held[static_cast<std::size_t>(row - first)].holds;
    of_row = !of_row;
  }
}

/// Units of work of how m rows of n numbers answer each other, and of as many symmetric equations as were solved.
std::uint64_t dense_units(std::size_t m, std::size_t n, std::size_t solved) {
  constexpr std::size_t kOperations = 64;  // a unit
  return m * m * (3 * n + 2 * solved * m) / (6 * kOperations);
}

}  // namespace

std::uint64_t Tree::hold_units() const {
  const std::size_t rows = static_cast<std::size_t>(kMostLoopRows) * loops.size() + held.size();
  return dense_units(rows, static_cast<std::size_t>(model.velocities()), 1);
}

/// @return  units of work that it took
std::uint64_t Dynamics::Core::hold(Tree& tree, double* acceleration, bool loops, bool limits) {
  const int n = tree.model.velocities();
  const int most = kMostLoopRows * static_cast<int>(tree.loops.size()) + static_cast<int>(tree.held.size());
  double *j = tree.row_numbers.data(), *r = j + most * n, *a = r + most * n, *part = a + most * most,
         *wanted = part + most * most, *scale = wanted + most;
  using Numbers = Eigen::Map<articulated::Vector>;
  articulated::forward_kinematics(tree.model, tree.data, tree.state);
  int m = 0;
  // All second derivatives first: what answers impulses overwrites the accelerations that they are made of.
  for (std::size_t k = 0; loops && k < tree.loops.size(); ++k) {
    bound.poll();
    const LoopRows loop = loop_rows(tree, joints[tree.loops[k]].is);
    for (int i = 0; i < loop.count; ++i, ++m) {
      const LoopRow& row = loop.rows[static_cast<std::size_t>(i)];
      wanted[m] = -curvature(tree, loop, row);
      fill_loop_row(tree, loop, row, j + m * n);
    }
  }
  const int first_limit = m;
  for (HeldLimit& held : tree.held) {
    if (!limits) break;
    const JointEntry& joint = joints[held.joint];
    fill_limit_row(tree, joint, held.axis, held.sign, j + m * n);
    const Numbers row(j + m * n, n);
    // Overlap is for positions to put right: a force that did would add energy.
    const double gap = std::max(held.sign * (read_position(joint)[held.axis] - held.limit), 0.0);
    const double pace = 1 / tree.hold_time;
    wanted[m] = -row.dot(Numbers(acceleration, n)) - pace * (2 * row.dot(tree.state.v) + pace * gap);
    held.holds = true;
    ++m;
  }
  for (int i = 0; i < m; ++i) {
    bound.poll();
    tree.work_v = Numbers(j + i * n, n);
    articulated::apply_inverse_mass(tree.model, tree.data, tree.work_v, tree.work_u);
    Numbers(r + i * n, n) = tree.work_u;
  }
  for (int i = 0; i < m; ++i) {
    bound.poll();
    for (int k = 0; k <= i; ++k) a[i * m + k] = a[k * m + i] = Numbers(j + i * n, n).dot(Numbers(r + k * n, n));
  }
  const int solved = solve_pushing({m, first_limit, a, part, wanted, scale, bound}, tree);
  tree.held_force.setZero();
  for (int i = 0; i < m; ++i) {
    const double force = tree.row_forces[static_cast<std::size_t>(i)];
    Numbers(acceleration, n) += force * Numbers(r + i * n, n);
    if (i >= first_limit) tree.held_force += force * Numbers(j + i * n, n);
  }
  return dense_units(static_cast<std::size_t>(m), static_cast<std::size_t>(n), static_cast<std::size_t>(solved));
}

/// Adds what loops push with, as hold() found it last, to the forces on links. Gives that of one joint on its
/// child, about the joint's point.
JointReaction Dynamics::Core::push_by_loops(Tree& tree, JointIndex wanted) {
  JointReaction of;
  std::size_t m = 0;
  for (const JointIndex index : tree.loops) {
    const LoopRows loop = loop_rows(tree, joints[index].is);
    for (int i = 0; i < loop.count; ++i, ++m) {
      const LoopRow& row = loop.rows[static_cast<std::size_t>(i)];
      const Vector3 push = tree.row_forces[m] * row.axis;
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
      act(loop.child, row.on_child, 1);
      act(loop.parent, row.on_parent, -1);
    }
  }
  return of;
}

void Tree::reserve_rows() {
  const std::size_t n = static_cast<std::size_t>(model.velocities()), m = kMostLoopRows * loops.size() + held.size();
  row_numbers.resize(std::max(row_numbers.size(), 2 * m * (n + m + 1)));
  row_forces.resize(std::max(row_forces.size(), m));
  row_order.resize(std::max(row_order.size(), m));
}

}  // namespace breve
