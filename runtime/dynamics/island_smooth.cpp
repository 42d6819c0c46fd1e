// Smooth motion of what an island holds; on `fast` in as many parts as keep the energy.
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/articulated/energy.hpp"
#include "runtime/base/error.hpp"
#include "runtime/base/rotation_vector.hpp"
#include "runtime/dynamics/island.hpp"
#include "runtime/dynamics/spring_network.hpp"

namespace breve {

namespace {

constexpr int kMostParts = 16;  // of a step
// Of step control where contacts act, if its tolerance is not finer than that.
constexpr double kContactSlack = 10;

}  // namespace

void Island::move_driver(Free& one, double h) {
  one.now.center += h * one.now.velocity;
  if (one.now.spin != Vector3::Zero())
    one.now.orientation = (rotation_by(h * one.now.spin) * one.now.orientation).normalized();
}

void Island::smooth(double time, double h) {
  if (springs_move()) return smooth_springs(time, h);
  free_work_ = network_loss_ = 0;
  constexpr std::uint64_t kUnits = 10;  // of work, a body
  meter_.add(kUnits * free_.size());
  smooth_networks(time, h);
  const std::size_t first = networks_.empty() ? free_.size() : networks_.front().first, end = networks_end();
  for (std::size_t i = 0; i < free_.size(); ++i) {
    if (i >= first && i < end) continue;
    Free& one = free_[i];
    if (one.driver) {
      move_driver(one, h);
      continue;
    }
    const Vector3 center = one.now.center, spin = one.now.spin;
    move_free(one.now, accuracy_, core_.settings.gravity, time, h, one.next, meter_);
    free_work_ += one.now.force.dot(one.now.center - center) + 0.5 * h * one.now.torque.dot(spin + one.now.spin);
  }
  for (Clustered& one : clusters_) {
    forget_parts(one);
    one.semi = semi_implicit(accuracy_);
    if (one.entry->system->can_be_finer())
      smooth_fast(one, time, h);
    else
      smooth_whole(one, time, h);
  }
}

/// Impulses of contacts are taken as constant over a sub-step: where some act, more digits are not seen.
bool Island::coarse() const { return has_rows() && accuracy_.tolerance >= kCoarse; }

void Island::forget_parts(Clustered& one) {
  one.pending = {};
  one.held_work = 0;
  for (Tree* tree : one.entry->system->trees()) tree->motor_impulse.setZero();
}

void Island::smooth_once(Clustered& one, double time, double h) {
  Cluster& system = *one.entry->system;
  system.set_slack(coarse() ? kContactSlack : 1);
  system.step(time, h);
  for (Tree* tree : system.trees()) tree->motor_impulse += tree->part_impulse;
  if (one.entry->network) one.entry->network->note_forces(core_);
  result.counters.evaluations += static_cast<std::uint64_t>(system.count().evaluations);
  result.counters.rejected += static_cast<std::uint64_t>(system.count().rejected);
  one.pending.motor_work += system.motor_work();
  one.pending.script_work += system.script_work();
  one.pending.drag_loss += system.drag_loss();
  one.held_work += system.reaction_work();
}

/// The energy of the springs between its trees, whose links are placed, J.
double Island::spring_energy_in(const Clustered& one) const {
  if (one.entry->network) return one.entry->network->spring_energy(core_);
  double sum = 0;
  for (const SpringIndex spring : one.entry->springs) sum += core_.spring_energy_in(core_.springs[spring].is);
  return sum;
}

/// Energy of a cluster, all of it; `kinetic` what is in motion.
double Island::stored_in(const Clustered& one, double& kinetic) {
  double sum = 0;
  kinetic = 0;
  for (const std::uint32_t index : one.entry->trees) {
    const Energy energy = core_.energy_of(*core_.trees[index]);
    kinetic += energy.kinetic;
    sum += energy.kinetic + energy.potential + energy.springs;
  }
  return sum + spring_energy_in(one);
}

/// Runge-Kutta 4, or semi-implicit Euler where springs are too fast for it, in as many parts as leave little for
/// projection to the energy. A gain that remains is taken back; a loss of implicit springs is lost.
void Island::smooth_fast(Clustered& one, double time, double h) {
  Cluster& system = *one.entry->system;
  for (Tree* tree : system.trees()) tree->part_state = tree->state;
  bool implicit = stiff(one) || finished_;
  system.set_finer(!implicit);
  const double still = kStill * weight();
  for (int parts = 1;; parts *= 2) {
    const bool last = 2 * parts > kMostParts || worn();
    double gain = std::numeric_limits<double>::infinity();
    try {
      gain = gain_of(one, time, h, parts);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::Numeric || (last && implicit)) throw;
    }
    if ((implicit && gain <= 0) || std::abs(gain) <= still || take_back(one, gain)) break;
    if (last && (implicit || std::isfinite(gain))) {
      take_back_most(one, gain);
      break;
    }
    ++result.counters.rejected;
    for (Tree* tree : system.trees()) tree->state = tree->part_state;
    forget_parts(one);
    if (!last) continue;
    implicit = true;
    system.set_finer(false);
    parts /= 2;
  }
  system.set_finer(false);
  one.semi = implicit;
}

/// Some joint has a spring or damper that a step may not follow: semi-implicit Euler holds it whatever its stiffness,
/// and takes energy from it.
bool Island::stiff(const Clustered& one) const {
  for (const std::uint32_t index : one.entry->trees)
    for (const articulated::Drive& drive : core_.trees[index]->loads.drives)
      if (drive.stiffness > 0 || drive.damping > 0) return true;
  return false;
}

/// Takes the step in parts. What it gained that nothing explains, J.
double Island::gain_of(Clustered& one, double time, double h, int parts) {
  double kinetic = 0;
  const double before = stored_in(one, kinetic);
  for (int i = 0; i < parts; ++i) smooth_whole(one, time + i * h / parts, h / parts);
  const Energy& did = one.pending;
  const double gain =
      stored_in(one, kinetic) - before - (did.motor_work + did.script_work + one.held_work - did.drag_loss);
  return std::abs(gain) <= kTiny * std::abs(before) ? 0 : gain;
}

}  // namespace breve
