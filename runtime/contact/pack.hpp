// The solver's own view of an island: rows packed for its loops, and how impulses and velocities go through them.
#pragma once

#include <span>

#include "runtime/contact/solver.hpp"

namespace breve::contact {

/// Fill `work` from an island. Velocities are those without any impulse; nothing is pushed.
void pack(std::span<const Mover> movers, std::span<const Row> rows, std::span<const ScalarRow> scalars,
          Workspace& work);

/// Velocities as they were before any impulse.
void restore_velocities(Workspace& work);

/// The packed problem as if it were at rest, without friction and impulses, and with other biases. Velocities of trees
/// are zero.
void start_over(std::span<const Push> rows, std::span<const double> scalar_biases, Workspace& work);

/// Velocities of free bodies go back where they came from.
void unpack_velocities(const Workspace& work);
/// The same, and all impulses.
void unpack(const Workspace& work, std::span<Row> rows, std::span<ScalarRow> scalars);

/// Velocity at a plain contact in its own axes.
inline void plain_velocity(const Point& c, const Packed& a, const Packed& b, double u[3]) {
  const double x =
      a.v[0] + a.v[4] * c.arm_a[2] - a.v[5] * c.arm_a[1] - (b.v[0] + b.v[4] * c.arm_b[2] - b.v[5] * c.arm_b[1]);
  const double y =
      a.v[1] + a.v[5] * c.arm_a[0] - a.v[3] * c.arm_a[2] - (b.v[1] + b.v[5] * c.arm_b[0] - b.v[3] * c.arm_b[2]);
  const double z =
      a.v[2] + a.v[3] * c.arm_a[1] - a.v[4] * c.arm_a[0] - (b.v[2] + b.v[3] * c.arm_b[1] - b.v[4] * c.arm_b[0]);
  u[0] = c.normal[0] * x + c.normal[1] * y + c.normal[2] * z;
  u[1] = c.tangent1[0] * x + c.tangent1[1] * y + c.tangent1[2] * z;
  u[2] = c.tangent2[0] * x + c.tangent2[1] * y + c.tangent2[2] * z;
}

/// An impulse (x, y, z) in world axes at an arm from the centre of mass.
inline void plain_push(Packed& m, const double arm[3], double x, double y, double z) {
  m.v[0] += m.inverse_mass * x;
  m.v[1] += m.inverse_mass * y;
  m.v[2] += m.inverse_mass * z;
  const double tx = arm[1] * z - arm[2] * y, ty = arm[2] * x - arm[0] * z, tz = arm[0] * y - arm[1] * x;
  m.v[3] += m.inertia[0] * tx + m.inertia[1] * ty + m.inertia[2] * tz;
  m.v[4] += m.inertia[1] * tx + m.inertia[3] * ty + m.inertia[4] * tz;
  m.v[5] += m.inertia[2] * tx + m.inertia[4] * ty + m.inertia[5] * tz;
}

/// An impulse in the contact's own axes on both bodies of a plain contact.
inline void plain_push(const Point& c, Packed& a, Packed& b, const double p[3]) {
  const double x = c.normal[0] * p[0] + c.tangent1[0] * p[1] + c.tangent2[0] * p[2];
  const double y = c.normal[1] * p[0] + c.tangent1[1] * p[1] + c.tangent2[1] * p[2];
  const double z = c.normal[2] * p[0] + c.tangent1[2] * p[1] + c.tangent2[2] * p[2];
  plain_push(a, c.arm_a, x, y, z);
  plain_push(b, c.arm_b, -x, -y, -z);
}

/// The same for any contact, by its place in `work`.
void velocity(const Workspace& work, std::size_t contact, double u[3]);
void push(Workspace& work, std::size_t contact, const double p[3]);
double velocity(const Workspace& work, const PackedScalar& row);
void push(Workspace& work, const PackedScalar& row, double impulse);

}  // namespace breve::contact
