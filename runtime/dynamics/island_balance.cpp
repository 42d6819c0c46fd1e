// The state as a step began, and the balance of energy since then.
#include "runtime/dynamics/island_balance.hpp"

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
  state_.placed = state_.booked = false;
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

double Balance::open() {
  handled_ = 0;
  state_.booked = false;
  return stored_start_ = measure(kinetic_start_, true);
}

double Balance::unexplained(double after) const {
  return after - stored_start_ - works(state_.result.ledger, start_.ledger) +
         losses(state_.result.ledger, start_.ledger) - handled_;
}

double Balance::close(double& turnover) {
  double kinetic = 0;
  const double after = measure(kinetic, false);
  const double in = works(state_.result.ledger, start_.ledger), out = losses(state_.result.ledger, start_.ledger);
  const double residual = unexplained(after);
  risen_ = residual - out;
  works_ = in;
  state_.result.ledger.residual += residual;
  turnover = kinetic + std::abs(in) + std::abs(out);
  for (const Clustered& one : state_.clusters) {
    if (!one.alone()) continue;
    Tree& tree = *state_.core.trees[one.entry->trees.front()];
    const double change = tree.step_stored;
    tree.ledger.residual += change - works(tree.ledger, tree.step_ledger) + losses(tree.ledger, tree.step_ledger);
  }
  return residual;
}

/// Kinetic, potential and in springs, J. Notes for each tree its own: at the start of a step as it is, later as change.
double Balance::measure(double& kinetic, bool start) {
  double sum = 0, moving = 0;
  for (const Free& one : state_.loose_bodies()) {
    moving += one.now.kinetic();
    sum -= one.now.solid->mass * state_.core.settings.gravity.dot(one.now.center);
  }
  for (Tree* tree : state_.trees) {
    const Energy energy = state_.core.energy_of(*tree);
    moving += energy.kinetic;
    sum += energy.potential + energy.springs;
    tree->step_stored = start ? energy.total() : energy.total() - tree->step_stored;
    if (start) tree->step_kinetic = energy.kinetic;
    if (!start) tree->booked = energy.total();
  }
  sum += network_energy(state_);
  for (const Clustered& one : state_.clusters) sum += spring_energy(state_, one);
  for (const NearPair* pair : state_.pairs) sum += pair->stored;
  kinetic = moving;
  state_.placed = true;
  state_.booked = !start;
  return sum + moving;
}

}  // namespace breve::island
