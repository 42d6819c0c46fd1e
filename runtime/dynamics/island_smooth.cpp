// Smooth motion of what an island holds; and what stands in for Euler's rule, which takes one look a step, where joints
// turn so far in one that it would invent energy.
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/articulated/energy.hpp"
#include "runtime/base/error.hpp"
#include "runtime/dynamics/island.hpp"

namespace breve {

namespace {

// Of the energy in motion: what a step of Euler's rule may gain or lose that no account explains. Where something turns
// further than that angle in a step, rad, it does not come back in the next quarter of a period, and none is allowed.
constexpr double kFreeGain = 0.01, kFurthestTurn = 0.5;
constexpr int kMostParts = 16;  // of a step
// Of step control where contacts act, if its tolerance is not finer than that.
constexpr double kContactSlack = 10;

double widest_turn(Cluster& system) {
  double most = 0;
  int i = 0;
  for (const Tree* tree : system.trees())
    for (const double v : tree->state.v)
      if (system.kind(i++) == articulated::Kind::Angle) most = std::max(most, std::abs(v));
  return most;
}

/// What springs take in one quarter of a period they give back in the next: the rule's gains there are no trouble.
bool has_springs(const Dynamics::Core& core, const ClusterEntry& cluster) {
  if (!cluster.ties.empty()) return true;
  for (const Tree* tree : cluster.system->trees())
    for (const TreeLink& link : tree->links)
      if (link.joint != kNoJoint && core.joints[link.joint].drive.stiffness > 0) return true;
  return false;
}

bool has_rings(const Cluster& system) {
  const std::span trees = system.trees();
  return std::any_of(trees.begin(), trees.end(), [](const Tree* tree) { return !tree->rings.empty(); });
}

}  // namespace

void Island::smooth(double time, double h) {
  if (springs_move()) return smooth_springs(time, h);
  free_work_ = 0;
  for (Free& one : free_) {
    const Vector3 center = one.now.center, spin = one.now.spin;
    move_free(one.now, accuracy_, core_.settings.gravity, time, h, one.next);
    free_work_ += one.now.force.dot(one.now.center - center) + 0.5 * h * one.now.torque.dot(spin + one.now.spin);
  }
  for (Clustered& one : clusters_) {
    one.pending = {};
    if (one.entry->system->can_be_finer())
      smooth_by_euler(one, time, h);
    else
      smooth_once(one, time, h);
  }
}

/// Impulses of contacts are taken as constant over a sub-step: where some act, more digits are not seen.
bool Island::coarse() const { return !rows_.empty() && accuracy_.tolerance >= kCoarse; }

void Island::smooth_once(Clustered& one, double time, double h) {
  Cluster& system = *one.entry->system;
  system.set_slack(coarse() ? kContactSlack : 1);
  system.step(time, h);
  result.counters.evaluations += static_cast<std::uint64_t>(system.count().evaluations);
  result.counters.rejected += static_cast<std::uint64_t>(system.count().rejected);
  one.pending.motor_work += system.motor_work();
  one.pending.script_work += system.script_work();
  one.pending.drag_loss += system.drag_loss();
}

/// Energy of a cluster, all of it; `kinetic` what is in motion.
/// @param shift  s, times the power of gravity: what semi-implicit Euler keeps to a higher order is not the energy but
///               that, with half a step (in a free fall it is exact). What falls onto its feet in each step and is
///               caught there has lost nothing.
double Island::stored_in(const Clustered& one, double shift, double& kinetic) {
  double sum = 0;
  kinetic = 0;
  for (const std::uint32_t index : one.entry->trees) {
    const Tree& tree = *core_.trees[index];
    const Energy energy = core_.energy_of(*core_.trees[index]);
    kinetic += energy.kinetic;
    sum += energy.total() + shift * core_.settings.gravity.dot(articulated::linear_momentum(tree.model, tree.data));
  }
  for (const SpringIndex tie : one.entry->ties) sum += core_.tie_energy_in(core_.springs[tie].is);
  return sum;
}

/// Semi-implicit Euler, or where it gains energy Runge-Kutta 4 in as many parts as keep it.
void Island::smooth_by_euler(Clustered& one, double time, double h) {
  const auto each_tree = [&](auto&& f) {
    for (const std::uint32_t index : one.entry->trees) f(*core_.trees[index]);
  };
  each_tree([](Tree& tree) { tree.part_state = tree.state; });
  const auto back = [&] {
    each_tree([](Tree& tree) { tree.state = tree.part_state; });
    one.pending = {};
  };
  Cluster& system = *one.entry->system;
  const double most = h * widest_turn(system) > kFurthestTurn ? 0 : kFreeGain;
  // In the air energy itself is kept, which looks better.
  // Rings are closed at the end of the step by hand: what Euler's rule leaves open of them is too much for that.
  const double gained = only_rings() && has_rings(system) ? std::numeric_limits<double>::infinity()
                                                          : gain_of(one, time, h, 1, rows_.empty() ? 0 : 0.5 * h);
  if (std::abs(gained) <= most || (most > 0 && gained <= 1 && has_springs(core_, *one.entry))) return;
  system.set_finer(true);
  double gain = 0;
  for (int parts = 1; parts <= kMostParts; parts *= 2) {
    ++result.counters.rejected;
    back();
    gain = gain_of(one, time, h, parts, 0);
    if (std::abs(gain) <= kFreeGain) break;
  }
  system.set_finer(false);
  if (gain <= kFreeGain) return;
  back();
  smooth_once(one, time, h);
}

/// Takes the step in parts. What it gained that no account explains, by the energy in motion; infinite if it gives no
/// numbers.
/// @param shift  see stored_in
double Island::gain_of(Clustered& one, double time, double h, int parts, double shift) {
  double kinetic = 0, moving = 0;
  const double before = stored_in(one, shift, kinetic);
  try {
    for (int i = 0; i < parts; ++i) smooth_once(one, time + i * h / parts, h / parts);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Numeric) throw;
    return std::numeric_limits<double>::infinity();
  }
  const double after = stored_in(one, shift, moving);
  if (!std::isfinite(after)) return std::numeric_limits<double>::infinity();
  const double explained = one.pending.motor_work + one.pending.script_work - one.pending.drag_loss;
  const double gain = after - before - explained;
  return std::abs(gain) <= kTiny * std::abs(before) ? 0 : gain / std::max(kinetic, moving);
}

}  // namespace breve
