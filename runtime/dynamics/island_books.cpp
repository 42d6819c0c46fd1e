// What the rows of a sub-step did to the energy.
#include "runtime/dynamics/island_books.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/dynamics/island_energy.hpp"

namespace breve::island {

namespace {

double works_of(const Energy& ledger) { return ledger.motor_work + ledger.script_work; }

/// Of contacts and limits, J.
double rows_took(const Energy& ledger) { return ledger.contact_loss + ledger.friction_loss + ledger.limit_loss; }

/// Of `change`, what works and losses since `start` do not explain, J.
double missing(double change, const Energy& start, const Energy& now) {
  return change - works_of(now) + works_of(start) + rows_took(now) + now.drag_loss - rows_took(start) - start.drag_loss;
}

/// Contacts and limits give nothing. Where motors press against them the mean of velocities may say that they did and
/// that the motors took it, to and fro within the sub-step: then neither did. Likewise what they gave, and smooth
/// motion lost by its error, are one.
/// @param lost  J, by the error of smooth motion
void settle_rows(const Energy& start, double lost, Energy& now) {
  const double gave = rows_took(start) - rows_took(now);
  if (!(gave > 0)) return;
  const double by_motors = std::clamp(start.motor_work - now.motor_work, 0.0, gave);
  now.motor_work += by_motors;
  now.contact_loss += by_motors + std::clamp(lost, 0.0, gave - by_motors);
}

}  // namespace

/// At the start of a sub-step, once it is known which touches and limits will be rows.
void Books::open() {
  kept_ = !state_.trees.empty() && contacts_.any() && !springs_.move();
  if (!kept_) return;
  double moving = 0;
  for (Clustered& one : state_.clusters) {
    double kinetic = 0;
    const Tree& first = *state_.core.trees[one.entry->trees.front()];
    one.sub_start = {stored_energy(state_, one, kinetic), 0, 0, 0, first.ledger, 0};
    moving += kinetic;
  }
  sub_start_ = {stored_energy(state_), moving, 0, 0, state_.result.ledger, 0};
}

/// After smooth motion: what it gained that nothing explains is its error, not the rows'.
void Books::note_smooth() {
  if (!kept_) return;
  sub_start_.smooth_kinetic = 0;
  for (Clustered& one : state_.clusters) {
    const Energy& did = one.pending;
    double kinetic = 0;
    one.sub_start.unexplained = stored_energy(state_, one, kinetic) - one.sub_start.stored - did.motor_work -
                                did.script_work - one.held_work + did.drag_loss;
    sub_start_.smooth_kinetic += kinetic;
  }
  state_.placed = true;
}

/// After the works of smooth motion and of the rows went to the ledger.
void Books::close() {
  if (!kept_ || rows_.empty()) return;
  const bool only_motors = rows_.contacts() == 0 && rows_.limits() == 0;
  const auto close = [this, only_motors](const SubStepEnergy& start, double stored, const Tree* tree, Energy& ledger) {
    const double more = missing(stored - start.stored - start.unexplained, start.ledger, ledger);
    const double doubt = rows_.motor_doubt(tree);
    if (only_motors)  // the rest is the error of the motion that they changed
      ledger.motor_work += std::clamp(more, -doubt, doubt);
    else
      ledger.contact_loss -= more;
    settle_rows(start.ledger, -start.unexplained, ledger);
  };
  double kinetic = 0;
  for (Clustered& one : state_.clusters) {
    // An implicit step and its rows are one: what it lost on the way to them is not the motion's error.
    if (one.semi && !only_motors) one.sub_start.unexplained = std::max(0.0, one.sub_start.unexplained);
    sub_start_.unexplained += one.sub_start.unexplained;
    if (!one.alone()) continue;
    Tree& tree = *state_.core.trees[one.entry->trees.front()];
    close(one.sub_start, stored_energy(state_, one, kinetic), &tree, tree.ledger);
  }
  close(sub_start_, stored_energy(state_), nullptr, state_.result.ledger);
  const double gained = rows_took(sub_start_.ledger) - rows_took(state_.result.ledger);
  if (!(gained > kTiny * std::abs(sub_start_.stored))) return;
  const double all = momentum_.moving();
  if (gained <= kFew * all) {
    momentum_.take_from_all(gained / all);
    return;
  }
  gained_ += gained;
  momentum_.note_touched();
}

void Books::note_start() {
  stored_ = stored_energy(state_);
  ledger_ = state_.result.ledger;
}

void Books::take_gain() {
  const double stored = stored_energy(state_);
  const double gain = missing(stored - stored_, ledger_, state_.result.ledger);
  const double all = momentum_.moving();
  if (gain > kTiny * std::abs(stored) && all > 0) momentum_.undo_gain(std::min(1.0, gain / all), false);
}

double Books::owed() const {
  double sum = gained_;
  for (const Tree* tree : state_.trees) sum += tree->owed;
  return sum;
}

/// What they gave all the same, however finely the step was taken. Links that move too little among one another owe it.
/// @param undone  the step will be: it gave nothing
void Books::take_back_rest(bool undone) {
  const double sum = undone ? owed() - gained_ : owed();
  gained_ = 0;
  for (Tree* tree : state_.trees) tree->owed = 0;
  if (!(sum > 0)) return;
  const double all = undone ? 0 : momentum_.moving(), taken = std::min(sum, all);
  if (taken > 0) momentum_.take_from_all(taken / all);
  state_.trees.front()->owed = sum - taken;
}

}  // namespace breve::island
