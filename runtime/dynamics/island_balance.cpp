// The state as a step began, and the balance of energy since then.
#include "runtime/dynamics/island_balance.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/articulated/energy.hpp"
#include "runtime/dynamics/island_energy.hpp"

namespace breve::island {

Balance::Balance(State& state) : state_(state), free_start_(state.memory), pair_start_(state.memory) {}

void Balance::keep_start() {
  start_ = {state_.result.counters, state_.result.ledger, state_.result.impacts.size()};
  free_start_.clear();
  pair_start_.clear();
  for (const Free& one : state_.free_bodies) free_start_.push_back(one.now);
  for (Tree* tree : state_.trees) {
    tree->step_state = tree->state;
    tree->step_ledger = tree->ledger;
  }
  for (const NearPair* pair : state_.pairs) pair_start_.push_back(*pair);
}

void Balance::back_to_start() {
  state_.booked = false;
  const std::uint64_t evaluations = state_.result.counters.evaluations;
  state_.result.counters = start_.counters;
  state_.result.counters.evaluations = evaluations;
  state_.result.ledger = start_.ledger;
  state_.result.impacts.erase(state_.result.impacts.begin() + static_cast<std::ptrdiff_t>(start_.impacts),
                              state_.result.impacts.end());
  for (std::size_t i = 0; i < state_.free_bodies.size(); ++i) state_.free_bodies[i].now = free_start_[i];
  for (Tree* tree : state_.trees) {
    tree->state = tree->step_state;
    tree->ledger = tree->step_ledger;
  }
  for (std::size_t i = 0; i < state_.pairs.size(); ++i) *state_.pairs[i] = pair_start_[i];
  for (Clustered& one : state_.clusters) one.entry->system->set_next_step(0);
  for (Free& one : state_.free_bodies) one.next = 0;
}

namespace {

double works(const Energy& now, const Energy& then) {
  return now.motor_work + now.script_work - then.motor_work - then.script_work;
}

}  // namespace

double losses(const Energy& now, const Energy& then) {
  return now.contact_loss + now.friction_loss + now.drag_loss + now.limit_loss - then.contact_loss -
         then.friction_loss - then.drag_loss - then.limit_loss;
}

namespace {

/// Of one account, whatever others make up for, J.
double largest_loss(const Energy& now, const Energy& then) {
  return std::max({std::abs(now.contact_loss - then.contact_loss), std::abs(now.friction_loss - then.friction_loss),
                   std::abs(now.drag_loss - then.drag_loss), std::abs(now.limit_loss - then.limit_loss)});
}

}  // namespace

double Balance::open() {
  handled_ = 0;
  state_.swung = 0;
  state_.booked = false;
  state_.read_springs();
  opened_ = measure(true);
  return opened_.total();
}

double Balance::unexplained(double after) const {
  return after - opened_.total() - works(state_.result.ledger, start_.ledger) +
         losses(state_.result.ledger, start_.ledger) - handled_;
}

double Balance::close(double& turnover) {
  const Stored after = measure(false);
  const double in = works(state_.result.ledger, start_.ledger), out = losses(state_.result.ledger, start_.ledger);
  const double residual = unexplained(after.total());
  risen_ = residual - out;
  works_ = in;
  state_.result.ledger.residual += residual;
  // No more moves and is lost than there was: a step that claims so has gone astray, and is measured by what there was.
  const double fallen = std::max(0.0, opened_.height - after.height);
  const double most = 3 * (supplied() + opened_.springs + fallen + std::abs(handled_));
  turnover = std::min(after.kinetic + std::abs(in) + std::abs(out), most);
  absurd_ = goes_astray(largest_loss(state_.result.ledger, start_.ledger), most);
  for (const Clustered& one : state_.clusters) {
    if (!one.alone()) continue;
    Tree& tree = *state_.core.trees[one.entry->trees.front()];
    const double change = tree.step_stored;
    tree.ledger.residual += change - works(tree.ledger, tree.step_ledger) + losses(tree.ledger, tree.step_ledger);
  }
  return residual;
}

namespace {

void settle_ledger(const Energy& start, Energy& now) {
  const double gave = losses(start, now) + now.drag_loss - start.drag_loss;
  const double neither = std::clamp(start.residual - now.residual, 0.0, std::max(0.0, gave));
  now.contact_loss += neither;
  now.residual += neither;
}

}  // namespace

void Balance::settle() {
  settle_ledger(start_.ledger, state_.result.ledger);
  for (const Clustered& one : state_.clusters) {
    if (!one.alone()) continue;
    Tree& tree = *state_.core.trees[one.entry->trees.front()];
    settle_ledger(tree.step_ledger, tree.ledger);
  }
}

/// What an account lost is absurd, however slowly all that may move moved.
/// @param most  J, that moved and worked
bool Balance::goes_astray(double lost, double most) const {
  constexpr double kAbsurd = 1e4;
  if (!(lost > kAbsurd * most)) return false;
  const double slow = kSlow * state_.unit();
  return lost > kAbsurd * (most + state_.mass() * slow * slow + weight(state_) + free_weight(state_));
}

/// Notes for each tree its own energy: at the start of a step as it is, later as change.
Balance::Stored Balance::measure(bool start) {
  Stored all;
  for (const Free& one : state_.loose_bodies()) {
    all.kinetic += one.now.kinetic();
    all.height -= one.now.solid->mass * state_.core.settings.gravity.dot(one.now.center);
  }
  for (Tree* tree : state_.trees) {
    const Energy energy = state_.core.energy_of(*tree);
    all.kinetic += energy.kinetic;
    all.height += energy.potential;
    all.springs += energy.springs;
    tree->step_stored = start ? energy.total() : energy.total() - tree->step_stored;
    if (start) tree->step_kinetic = energy.kinetic;
    if (start && energy.kinetic > tree->fastest && std::isfinite(energy.kinetic)) tree->fastest = energy.kinetic;
    if (!start) tree->booked = energy.total();
  }
  all.springs += network_energy(state_);
  for (const Clustered& one : state_.clusters) all.springs += spring_energy(state_, one);
  for (const NearPair* pair : state_.pairs) all.springs += pair->stored;
  state_.booked = !start;
  return all;
}

}  // namespace breve::island
