// Smooth motion of what an island holds; and how Euler's rule, which takes one look a step, is kept from inventing
// energy where joints turn too far in a step.
#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/dynamics/island.hpp"

namespace breve {

namespace {

// Of the energy in motion: what a step of Euler's rule may gain that no account explains. An oscillation of w rad/s
// gains (w h)^2 in the worst part of its period, so this is where a step turns by a third of a radian.
constexpr double kMostGain = 0.1;
// What it gains beyond this is taken from the velocities: many steps that each gain a little would add up to anything.
// Where something turns further than that angle in a step, rad, a gain does not come back in the next quarter of a
// period, and nothing is left to it.
constexpr double kFreeGain = 0.005, kFurthestTurn = 0.5;
constexpr int kMostParts = 16;  // of a step

double fastest_turn(Cluster& system) {
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

}  // namespace

void Island::smooth(double time, double h) {
  free_work_ = 0;
  for (Free& one : free_) {
    const Vector3 center = one.now.center, spin = one.now.spin;
    move_free(one.now, accuracy_, core_.settings.gravity, time, h, one.next);
    free_work_ += one.now.force.dot(one.now.center - center) + 0.5 * h * one.now.torque.dot(spin + one.now.spin);
  }
  for (Clustered& one : clusters_) {
    one.pending = {};
    if (one.entry->system->accuracy().scheme == articulated::Scheme::SemiImplicitEuler)
      smooth_in_parts(one, time, h);
    else
      smooth_once(one, time, h);
  }
}

void Island::smooth_once(Clustered& one, double time, double h) {
  Cluster& system = *one.entry->system;
  system.step(time, h);
  result.counters.evaluations += static_cast<std::uint64_t>(system.count().evaluations);
  result.counters.rejected += static_cast<std::uint64_t>(system.count().rejected);
  one.pending.motor_work += system.motor_work();
  one.pending.script_work += system.script_work();
  one.pending.drag_loss += system.drag_loss();
}

/// Energy of a cluster, all of it; `kinetic` what is in motion.
double Island::stored_in(const Clustered& one, double& kinetic) {
  double sum = 0;
  kinetic = 0;
  for (const std::uint32_t index : one.entry->trees) {
    const Energy energy = core_.energy_of(*core_.trees[index]);
    kinetic += energy.kinetic;
    sum += energy.total();
  }
  for (const SpringIndex tie : one.entry->ties) sum += core_.tie_energy_in(core_.springs[tie].is);
  return sum;
}

void Island::smooth_in_parts(Clustered& one, double time, double h) {
  const auto keep = [&] {
    for (const std::uint32_t index : one.entry->trees) core_.trees[index]->part_state = core_.trees[index]->state;
  };
  const auto back = [&] {
    for (const std::uint32_t index : one.entry->trees) core_.trees[index]->state = core_.trees[index]->part_state;
  };
  keep();
  double kinetic = 0;
  const double before = stored_in(one, kinetic);
  for (int parts = 1; parts <= kMostParts; parts *= 2) {
    one.pending = {};
    bool good = true;
    double energy = before, moving = kinetic;
    for (int i = 0; i < parts && good; ++i)
      good = smooth_part(one, time + i * h / parts, h / parts, parts == kMostParts, energy, moving);
    if (good) return;
    ++result.counters.rejected;
    back();
  }
}

/// @param last     there are no shorter parts: if the velocities cannot give what was gained, the cluster is stopped
/// @param energy   J, stored, and `kinetic` of it in motion; before, and then after
/// @return         false if it gains too much
bool Island::smooth_part(Clustered& one, double time, double h, bool last, double& energy, double& kinetic) {
  const Energy works = one.pending;
  const auto trees = [&](auto&& f) {
    for (const std::uint32_t index : one.entry->trees) f(*core_.trees[index]);
  };
  double now = 0, moving = 0;
  bool finite = true;
  if (last) trees([](Tree& tree) { tree.last_state = tree.state; });
  try {
    smooth_once(one, time, h);
    now = stored_in(one, moving);
    finite = std::isfinite(now);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Numeric) throw;
    finite = false;
  }
  const Energy& done = one.pending;
  const double explained =
      done.motor_work + done.script_work - done.drag_loss - (works.motor_work + works.script_work - works.drag_loss);
  const double gain = now - energy - explained, turnover = std::max(kinetic, moving);
  const double rounding = kTiny * std::abs(energy);
  const bool turns = h * fastest_turn(*one.entry->system) > kFurthestTurn;
  const bool springs = !turns && has_springs(core_, *one.entry);
  if (finite && (springs || gain <= (turns ? 0 : kFreeGain) * turnover + rounding)) {
    energy = now;
    kinetic = moving;
    return true;
  }
  if (!last && !(finite && gain <= kMostGain * turnover + rounding)) return false;
  if (finite && gain < moving) {
    const double share = std::sqrt(1 - gain / moving);
    trees([share](Tree& tree) { tree.state.v *= share; });
    kinetic = moving - gain;
    energy = now - gain;
    return true;
  }
  trees([](Tree& tree) {
    tree.state = tree.last_state;
    tree.state.v.setZero();
  });
  one.pending = works;
  energy = stored_in(one, kinetic);
  return true;
}

}  // namespace breve
