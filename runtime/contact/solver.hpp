// The impulses of one island's contacts, limits, motors and loops at one instant, in generalised velocities: no world,
// no bodies, no shapes. Start here; sweep.hpp and direct.hpp are the two ways to the solution.
#pragma once

#include <span>

#include "runtime/base/math.hpp"
#include "runtime/base/meter.hpp"
#include "runtime/contact/workspace.hpp"

namespace breve::contact {

/// Something that moves: a free body or a tree. Its velocity is read and written in place.
struct Mover {
  double* v = nullptr;
  int size = 6;  // numbers in v
  // A free body: v is the velocity of its centre of mass, then its spin, both in world axes. Its contacts may then be
  // given by arms instead of matrices, which is several times as fast.
  double inverse_mass = 0;                    // 1/kg; > 0: a free body
  Matrix3 inverse_inertia = Matrix3::Zero();  // about the centre of mass, world axes, 1/(kg*m^2), symmetric
};

/// A point where two movers touch. Relative velocity is a's point less b's, in (normal, tangent 1, tangent 2); the
/// impulse is what acts on a, in the same axes; its opposite acts on b.
/// A side is a free body (arm_*; j* null), or any mover with j* (3 x size, row-major: velocity of its point) and r* (3
/// x size, row-major: the change of its v by a unit impulse along each axis), or -1: something that does not give way.
/// The two sides are different movers: a tree that touches itself has one side, a, with the difference of the matrices.
struct Row {
  int a = -1, b = -1;
  const double *ja = nullptr, *ra = nullptr, *jb = nullptr, *rb = nullptr;
  Vector3 arm_a = Vector3::Zero(), arm_b = Vector3::Zero();  // from the centre of mass to the point, world axes, m
  Matrix3 axes = Matrix3::Identity();  // rows: normal (unit, from b toward a), tangent 1, tangent 2, world axes
  double static_friction = 0, dynamic_friction = 0;
  double bias = 0;      // wanted normal velocity, m/s: the contact demands v_n >= bias - softness * impulse_n
  double softness = 0;  // 1/kg; 0: rigid
  // Velocity along the tangents when the step began, before forces, m/s; zero if that is not known. It decides whether
  // a point that could stick with the static coefficient, but slides, goes on sliding. Unused if both coefficients
  // agree.
  double slip[2] = {0, 0};
  int pair = 0;                       // the same for all points between the same two bodies, for impacts in groups
  Vector3 impulse = Vector3::Zero();  // in: the warm start; out: the result, N*s
};

/// One scalar relation: a joint limit, a bounded motor, one number of a loop closure. Its velocity is ja.va - jb.vb and
/// it wants velocity + softness * impulse = bias, as far as lo <= impulse <= hi allows. lo <= 0 <= hi.
struct ScalarRow {
  int a = -1, b = -1;
  const double *ja = nullptr, *ra = nullptr, *jb = nullptr, *rb = nullptr;  // each `size` numbers; r = M^-1 j^T
  double bias = 0, softness = 0;
  double lo = 0, hi = 0;
  double impulse = 0;  // in: the warm start; out: the result
};

struct SolveSettings {
  int iterations = 10;          // sweeps of the iterative solver; an upper bound, also of its share of a direct solve
  bool direct = false;          // to `tolerance`, by Newton's method, and sweeps where it fails
  double tolerance = 1e-9;      // m/s; sweeps end early when no contact's velocity changes by more
  bool lean = false;            // a direct solution sets points without an impulse aside
  double direct_share = 1e300;  // a direct solution only where its operations, counted before, are at most this many
                                // times those of the sweeps
  double direct_most = 0;       // operations that a direct solution may take in any case
  double swept = 0;             // m/s, instead of `tolerance`, for a solution by sweeps alone; 0: the same
  Meter* meter = nullptr;       // counts the work, and ends it where it is over; null: nobody does
};

struct SolveReport {
  int iterations = 0;   // sweeps
  int newton = 0;       // linear solves of the direct solver
  double residual = 0;  // m/s: by how much the worst row violates its law (direct), or still changes (sweeps)
  bool direct = false;  // the result is the direct solver's, to tolerance
};

/// Find the impulses under which no contact approaches (v_n >= bias, complementary to the impulse), friction lies in
/// its cone and opposes what slides, and scalar rows keep their bounds; add them to the movers' v. Rows are gone
/// through as given, so the order of rows is part of the result. With all biases zero the kinetic energy never grows,
/// however few sweeps there were. No allocation once `workspace` has seen an island of this size. Never throws for
/// numbers: a row that nothing can move gets no impulse.
SolveReport solve_island(std::span<const Mover> movers, std::span<Row> rows, std::span<ScalarRow> scalars,
                         const SolveSettings& settings, Workspace& workspace);

/// How a contact's overlap is to be moved apart.
struct Push {
  double velocity = 0;  // m/s, at which the two points are to part
  double softness = 0;  // 1/kg, >= 0: what can hardly give way along the normal is not forced to
  double impulse = 0;   // along the normal; the result
};

/// The rows that `workspace` last solved once more, each with another bias, in m/s: from rest, without friction and
/// without the impulses it had. A free body's v is set to the result; a tree's, which is to be zero before, likewise.
SolveReport solve_again(std::span<Push> rows, std::span<const double> scalar_biases, const SolveSettings& settings,
                        Workspace& workspace);

}  // namespace breve::contact
