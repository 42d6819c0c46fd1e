// The course of a solve: pack, start warm, sweep or solve directly, settle static against dynamic friction, unpack.
#include "runtime/contact/solver.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/contact/bilateral.hpp"
#include "runtime/contact/condensed.hpp"
#include "runtime/contact/direct.hpp"
#include "runtime/contact/elimination_order.hpp"
#include "runtime/contact/friction.hpp"
#include "runtime/contact/pack.hpp"
#include "runtime/contact/sweep.hpp"
#include "runtime/contact/wedge.hpp"

namespace breve::contact {

namespace {

constexpr int kPatientSweeps = 1000;
constexpr double kOperations = 64;  // in a unit of work

/// Rounds of settling friction. Each point changes its coefficient at most twice, so this ends what could chatter.
constexpr int kRounds = 4;

void run_sweeps(Workspace& work, int most, double tolerance, Meter* meter, SolveReport& report) {
  const auto units = static_cast<std::uint64_t>(sweep_operations(work) / kOperations) + 1;
  constexpr int kFew = 4;  // are over before momentum is worth its cost
  Sweeps sweeps(work, most > kFew);
  for (int i = 0; i < most; ++i) {
    report.residual = sweeps.next();
    ++report.iterations;
    if (report.residual <= tolerance || sweeps.diverge()) return;
    if (!meter) continue;
    meter->add(units);
    if (meter->over()) return;
  }
}

/// Whether the bodies of an island too large for the interior-point method move on: the last impulses are off by more
/// than this share of what they change. Newton's method fails there nearly always, and the next step has other forces,
/// so more sweeps than usual are wasted on them. A pile that comes to rest is worth more of them.
bool moves_on(const Workspace& work, const LinearSolves& solves) {
  constexpr double kOff = 1e-3;
  const double changed = largest_change(work);
  return changed > 0 && violation(work) > kOff * changed && !enough_from_far(work, solves);
}

/// @param most  operations of the linear solves
/// @param each  of one of them
void solve_directly(Workspace& work, const SolveSettings& settings, double most, double each, SolveReport& report) {
  constexpr double kAlways = 1e6, kUnbounded = 1e6;  // operations that are not seen; solves
  const auto units = static_cast<std::uint64_t>(each / kOperations) + 1;
  LinearSolves solves{0, static_cast<int>(std::min((most + kAlways) / each, kUnbounded)), units, settings.meter};
  const bool moves = moves_on(work, solves);
  if (moves) {
    run_sweeps(work, settings.iterations, settings.tolerance * 0.1, settings.meter, report);
    report.residual = violation(work);
    report.direct = report.residual <= attainable(work, settings.tolerance);
    if (report.direct || !within_reach(work, report.residual)) return;
  }
  report.residual = solve_direct(work, settings.tolerance, settings.lean, solves, report.direct);
  if (!report.direct && !moves) {
    // The operations that are left may go into more sweeps than there would be without a direct solution.
    constexpr double kPatience = 3.3e5;  // operations, times the share, that there are in any case
    const double left = std::max(most + kAlways - solves.made * each, kPatience * settings.direct_share);
    const int sweeps = std::max(settings.iterations,
                                static_cast<int>(std::min<double>(left / sweep_operations(work), kPatientSweeps)));
    run_sweeps(work, sweeps, settings.tolerance * 0.1, settings.meter, report);
    report.residual = solve_direct(work, settings.tolerance, settings.lean, solves, report.direct);  // from nearer
  }
  report.newton += solves.made;
}

void solve_once(Workspace& work, const SolveSettings& settings, SolveReport& report) {
  if (settings.direct && work.condensed && is_bilateral(work)) {
    const BilateralSolution found = solve_bilateral(work, settings.tolerance, settings.meter);
    report.residual = found.left;
    report.direct = found.solved;
    report.newton += 1;
    if (found.solved || found.contradictory) return;
  }
  constexpr double kSolves = 5;  // of a direct solution that begins near the last step's
  const double swept = settings.iterations * sweep_operations(work);
  const double most = settings.direct ? std::max(settings.direct_share * swept, settings.direct_most) : 0;
  const double each = settings.direct ? order_elimination(work, most / kSolves) : 1;
  if (kSolves * each <= most)
    solve_directly(work, settings, most, each, report);
  else
    run_sweeps(work, settings.iterations, std::max(settings.tolerance, settings.swept), settings.meter, report);
}

/// Nothing is to bounce: rest is then possible for all rows at once.
void make_plastic(Workspace& work) {
  for (Point& c : work.points) c.bias = std::min(c.bias, 0.0);
  for (PackedScalar& row : work.scalars) {
    if (row.lo == 0) row.bias = std::min(row.bias, 0.0);
    if (row.hi == 0) row.bias = std::max(row.bias, 0.0);
  }
}

/// Where impulses were thrown ever farther, what is wedged does not bounce; and where friction throws them all the
/// same, it is found in turns with what presses.
void solve_wedged(std::span<const Row> rows, Workspace& work, const SolveSettings& settings, SolveReport& report) {
  forget_impulses(work);
  make_plastic(work);
  solve_once(work, settings, report);
  if (report.direct && !thrown(work, true)) return;
  forget_impulses(work);
  for (std::size_t i = 0; i < rows.size(); ++i) work.points[i].friction = rows[i].dynamic_friction;
  report.iterations += solve_staggered(work, settings.tolerance);
  report.direct = false;
  report.residual = violation(work);
}

}  // namespace

SolveReport solve_island(std::span<const Mover> movers, std::span<Row> rows, std::span<ScalarRow> scalars,
                         const SolveSettings& settings, Workspace& work) {
  SolveReport report;
  pack(movers, rows, scalars, work);
  condense(work);
  push_all(work);
  for (int round = 0; round < kRounds; ++round) {
    solve_once(work, settings, report);
    if (thrown(work, report.direct)) {
      solve_wedged(rows, work, settings, report);
      break;
    }
    if (round + 1 == kRounds || !settle_friction(rows, settings.tolerance, work)) break;
  }
  hold_energy(work);
  expand(work);
  unpack(work, rows, scalars);
  return report;
}

SolveReport solve_again(std::span<Push> rows, std::span<const double> scalar_biases, const SolveSettings& settings,
                        Workspace& work) {
  SolveReport report;
  start_over(rows, scalar_biases, work);
  work.by_normals = !settings.direct && condense_normals(work);
  solve_once(work, settings, report);
  expand(work);
  unpack_velocities(work);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].impulse = work.points[i].impulse[0];
  return report;
}

}  // namespace breve::contact
