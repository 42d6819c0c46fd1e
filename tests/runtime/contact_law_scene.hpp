// Islands of free boxes for the tests of the contact solver: bodies, the points where they touch, one velocity problem.
#pragma once

#include <deque>
#include <memory_resource>
#include <vector>

#include "runtime/contact/impact_law.hpp"
#include "runtime/contact/solver.hpp"

namespace breve::contact {

struct FreeBody {
  double mass;
  Vector3 position;
  Matrix3 inertia;  // world axes
  Eigen::Matrix<double, 6, 1> v = Eigen::Matrix<double, 6, 1>::Zero();

  Vector3 velocity_at(const Vector3& point) const {
    const Vector3 linear = v.head<3>(), spin = v.tail<3>();
    return linear + spin.cross(point - position);
  }
  double kinetic() const {
    const Vector3 spin = v.tail<3>();
    return 0.5 * mass * v.head<3>().squaredNorm() + 0.5 * spin.dot(inertia * spin);
  }
};

inline Matrix3 box_inertia(double mass, const Vector3& size) {
  const Vector3 s = size.cwiseProduct(size);
  return (Vector3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()) * (mass / 12)).asDiagonal();
}

inline Matrix3 frame_of(const Vector3& n) {
  Matrix3 axes;
  Vector3 t1, t2;
  tangents(n, t1, t2);
  axes.row(0) = n;
  axes.row(1) = t1;
  axes.row(2) = t2;
  return axes;
}

struct Scene {
  std::deque<FreeBody> bodies;  // whose addresses stay
  std::vector<Row> rows;
  std::vector<ScalarRow> scalars;
  Workspace work{std::pmr::get_default_resource()};
  SolveSettings settings{200, false, 1e-9};

  int add_box(double mass, const Vector3& position, const Vector3& size) {
    bodies.push_back({mass, position, box_inertia(mass, size)});
    return static_cast<int>(bodies.size()) - 1;
  }
  /// a touches b (-1: the ground) at a point; n from b toward a.
  Row& touch(int a, int b, const Vector3& point, const Vector3& n, double mu) {
    Row row;
    row.a = a;
    row.b = b;
    if (a >= 0) row.arm_a = point - bodies[static_cast<std::size_t>(a)].position;
    if (b >= 0) row.arm_b = point - bodies[static_cast<std::size_t>(b)].position;
    row.axes = frame_of(n);
    row.static_friction = row.dynamic_friction = mu;
    row.pair = a * 1000 + b;
    rows.push_back(row);
    return rows.back();
  }
  /// The four corners of the lower face of a box of this size.
  void rest_on(int a, int b, const Vector3& size, double mu) {
    const Vector3 centre = bodies[static_cast<std::size_t>(a)].position;
    for (const double x : {-0.5, 0.5})
      for (const double y : {-0.5, 0.5})
        touch(a, b, centre + Vector3(x * size.x(), y * size.y(), -0.5 * size.z()), Vector3::UnitZ(), mu);
  }
  /// Unit boxes on each other, on the ground at z = 0.
  void stack(const std::vector<double>& masses, double mu) {
    for (std::size_t i = 0; i < masses.size(); ++i) {
      const int box = add_box(masses[i], Vector3(0, 0, 0.5 + static_cast<double>(i)), Vector3::Ones());
      rest_on(box, box - 1, Vector3::Ones(), mu);
    }
  }
  /// What an acceleration gives in a step of h seconds.
  void pull(const Vector3& acceleration, double h) {
    for (FreeBody& body : bodies) body.v.head<3>() += h * acceleration;
  }
  std::vector<Mover> movers() {
    std::vector<Mover> out;
    for (FreeBody& body : bodies) {
      Mover mover;
      mover.v = body.v.data();
      mover.inverse_mass = 1 / body.mass;
      mover.inverse_inertia = body.inertia.inverse();
      out.push_back(mover);
    }
    return out;
  }
  SolveReport solve() { return solve_island(movers(), rows, scalars, settings, work); }
  double kinetic() const {
    double sum = 0;
    for (const FreeBody& body : bodies) sum += body.kinetic();
    return sum;
  }
  /// Velocity of a row's point on a less that on b, in its axes.
  Vector3 velocity_of(const Row& row) const {
    Vector3 u = Vector3::Zero();
    if (row.a >= 0) {
      const FreeBody& a = bodies[static_cast<std::size_t>(row.a)];
      u += a.velocity_at(a.position + row.arm_a);
    }
    if (row.b >= 0) {
      const FreeBody& b = bodies[static_cast<std::size_t>(row.b)];
      u -= b.velocity_at(b.position + row.arm_b);
    }
    return row.axes * u;
  }
  /// The velocities that the rows' impulses give to bodies that had `before`.
  double disagreement(const std::vector<Eigen::Matrix<double, 6, 1>>& before) const {
    std::vector<Eigen::Matrix<double, 6, 1>> v = before;
    for (const Row& row : rows) {
      const Vector3 p = row.axes.transpose() * row.impulse;
      const auto push = [&](int body, const Vector3& arm, double sign) {
        if (body < 0) return;
        const FreeBody& b = bodies[static_cast<std::size_t>(body)];
        v[static_cast<std::size_t>(body)].head<3>() += sign * p / b.mass;
        v[static_cast<std::size_t>(body)].tail<3>() += sign * (b.inertia.inverse() * arm.cross(p));
      };
      push(row.a, row.arm_a, 1);
      push(row.b, row.arm_b, -1);
    }
    double worst = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) worst = std::max(worst, (v[i] - bodies[i].v).cwiseAbs().maxCoeff());
    return worst;
  }
  std::vector<Eigen::Matrix<double, 6, 1>> velocities() const {
    std::vector<Eigen::Matrix<double, 6, 1>> out;
    for (const FreeBody& body : bodies) out.push_back(body.v);
    return out;
  }
};

}  // namespace breve::contact
