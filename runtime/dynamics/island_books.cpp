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

/// What motors changed by rows, and smooth motion erred by before in the other direction, are one: what is left of the
/// first, J.
double uncancelled(double by_rows, double erred) {
  return by_rows < 0 ? std::min(0.0, by_rows + std::max(0.0, erred)) : std::max(0.0, by_rows + std::min(0.0, erred));
}

/// Contacts and limits are solved together, and what a limit took may be booked as given by contacts, or the reverse:
/// as much as both have of it, neither did. Friction gives nothing: what it seems to give, contacts did not take.
void settle_exchange(const Energy& start, Energy& now) {
  const double rubbed =
      std::clamp(start.friction_loss - now.friction_loss, 0.0, std::max(0.0, now.contact_loss - start.contact_loss));
  now.friction_loss += rubbed;
  now.contact_loss -= rubbed;
  const double contact = now.contact_loss - start.contact_loss, limit = now.limit_loss - start.limit_loss;
  const double passed = contact < 0 ? std::clamp(limit, 0.0, -contact) : -std::clamp(-limit, 0.0, contact);
  now.contact_loss += passed;
  now.limit_loss -= passed;
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

/// The work that a motor can do in a sub-step of h seconds at most, J: its strength for the way of its joint, there and
/// back.
/// @param moved  the tangent by which its tree moved
double most_work(const MotorRow& motor, const articulated::Vector& moved, double h) {
  if (motor.shared == 0) return 0;  // counted with the first of its numbers
  const auto length = [&motor](const articulated::Vector& v) { return v.segment(motor.velocity, motor.shared).norm(); };
  const double way = std::max({length(moved), h * length(motor.tree->sub_state.v), h * length(motor.tree->state.v)});
  return way > 0 ? motor.strength * way : 0;  // a strength may be infinite
}

/// Motors cannot have given more than `most`, J: contacts and limits did not take that from them.
void give_back(const Energy& start, double most, Energy& now) {
  const double beyond = now.motor_work - start.motor_work - most;
  const double given = std::clamp(beyond, 0.0, std::max(0.0, rows_took(now) - rows_took(start)));
  now.motor_work -= given;
  now.contact_loss -= given;
}

}  // namespace

/// At the start of a sub-step, once it is known which touches and limits will be rows.
void Books::open() {
  kept_ = !state_.trees.empty() && contacts_.any() && !springs_.move();
  sprung_ = state_.trees.empty() && !state_.networks.empty() && state_.drivers == 0 && contacts_.any() &&
            !springs_.move() && !state_.accuracy.locate_impacts;
  if (sprung_) sub_start_ = {state_.followed ? stored_energy(state_) : 0, 0, 0, 0, 0, state_.result.ledger, 0};
  if (!kept_) return;
  double moving = 0;
  for (Clustered& one : state_.clusters) {
    double kinetic = 0;
    const Tree& first = *state_.core.trees[one.entry->trees.front()];
    one.sub_start = {stored_energy(state_, one, kinetic), 0, 0, 0, 0, first.ledger, 0};
    moving += kinetic;
  }
  sub_start_ = {stored_energy(state_), moving, 0, 0, 0, state_.result.ledger, 0};
}

/// After smooth motion: what it gained that nothing explains is its error, not the rows'.
/// @param free_works  J, what scripts gave bodies without joints, less what dampers between these took
void Books::note_smooth(double free_works) {
  if (sprung_) smooth_stored_ = stored_energy(state_), smooth_works_ = free_works;
  if (!kept_) return;
  sub_start_.smooth_kinetic = smooth_stored_ = 0;
  for (Clustered& one : state_.clusters) {
    const Energy& did = one.pending;
    double kinetic = 0;
    const double stored = stored_energy(state_, one, kinetic);
    one.sub_start.unexplained =
        stored - one.sub_start.stored - did.motor_work - did.script_work - one.held_work + did.drag_loss;
    smooth_stored_ += stored;
    sub_start_.smooth_kinetic += kinetic;
  }
  if (!state_.has_loops()) return;
  smooth_all_ = stored_energy(state_);
  smooth_done_ = works_of(state_.result.ledger);
  for (const Clustered& one : state_.clusters) smooth_done_ += works_of(one.pending);
}

double Books::taken() {
  double now = 0, kinetic = 0;
  for (const Clustered& one : state_.clusters) now += stored_energy(state_, one, kinetic);
  return smooth_stored_ - now;
}

Given Books::payable(bool by_rows) {
  const double now = stored_energy(state_);
  if (!kept_) {
    const double left = by_rows ? std::max(0.0, -missing(now - stored_, ledger_, state_.result.ledger)) : 0;
    return {left, left};
  }
  // Links may have given it to bodies without joints, to motors or to scripts' forces instead, and the error of smooth
  // motion to links: of that, springs are given nothing, since no motion pays it back.
  const Energy& ledger = state_.result.ledger;
  const double by_rows_alone = std::min(taken(), smooth_all_ - now) + std::min(0.0, works_of(ledger) - smooth_done_);
  const double in_all = sub_start_.stored + works_of(ledger) - works_of(sub_start_.ledger) - ledger.drag_loss +
                        sub_start_.ledger.drag_loss - now;
  return {std::max(0.0, by_rows_alone), std::max(0.0, std::min(by_rows_alone, in_all))};
}

bool Books::only_motors() const { return rows_.contacts() == 0 && rows_.limits() == 0; }

/// The work that a tree's motors can do at most along the way of a sub-step of h seconds, J.
/// @param next  its first motor among the rows, which are in the order of trees; the first of the next tree afterwards
double Books::most_work_of(Tree& tree, double h, std::size_t& next) const {
  if (next == rows_.motors() || rows_.motor(next).motor.tree != &tree) return 0;
  articulated::difference(tree.model, tree.sub_state.q, tree.state.q, tree.work_v);
  double sum = 0;
  for (; next < rows_.motors() && rows_.motor(next).motor.tree == &tree; ++next)
    sum += most_work(rows_.motor(next).motor, tree.work_v, h);
  return sum;
}

/// The same for a tree, or for all (null).
double Books::most_work_of(const Tree* tree) const {
  double sum = 0;
  for (std::size_t next = 0; next < rows_.motors();) {
    Tree& own = *rows_.motor(next).motor.tree;
    const double most = most_work_of(own, rows_.length(), next);
    if (!tree || &own == tree) sum += most;
  }
  return sum;
}

/// After the rows' solution, which has not moved anything yet.
void Books::note_solved() {
  if (!kept_ || !only_motors()) return;
  sub_start_.solved_kinetic = 0;
  for (Clustered& one : state_.clusters) {
    one.sub_start.solved_kinetic = 0;
    for (const std::uint32_t index : one.entry->trees)
      one.sub_start.solved_kinetic += state_.core.energy_of(*state_.core.trees[index]).kinetic;
    sub_start_.solved_kinetic += one.sub_start.solved_kinetic;
  }
}

/// After the works of smooth motion and of the rows went to the ledger.
void Books::close() {
  momentum_.note_touched();
  if (sprung_ && !rows_.empty()) close_networks();
  if (!kept_ || rows_.empty()) return;
  double erred = 0;  // J, by the motion that motors changed
  const auto close = [&](const SubStepEnergy& start, double stored, double kinetic, const Tree* tree, Energy& ledger) {
    const double more = missing(stored - start.stored - start.unexplained, start.ledger, ledger);
    if (only_motors()) {
      // The same rates are another motion where their impulses moved the links to: beyond the doubt about their work,
      // motors did not do that.
      const double moved = kinetic - start.solved_kinetic, left = uncancelled(more, start.unexplained);
      const double doubt = rows_.motor_doubt(tree), did = std::abs(uncancelled(more - moved, start.unexplained));
      const double most = did > doubt ? std::max(doubt, std::min(did, most_work_of(tree))) : doubt;
      const double by_motors = std::clamp(left, -most, most);
      ledger.motor_work += by_motors;
      erred = left - by_motors;
    } else {
      ledger.contact_loss -= more;
    }
    settle_exchange(start.ledger, ledger);
    settle_rows(start.ledger, -start.unexplained, ledger);
  };
  for (Clustered& one : state_.clusters) {
    // An implicit step and its rows are one: what it lost on the way to them is not the motion's error.
    if (one.semi && !only_motors()) one.sub_start.unexplained = std::max(0.0, one.sub_start.unexplained);
    sub_start_.unexplained += one.sub_start.unexplained;
    if (!one.alone()) continue;
    double kinetic = 0;
    const double stored = stored_energy(state_, one, kinetic);
    Tree& tree = *state_.core.trees[one.entry->trees.front()];
    close(one.sub_start, stored, kinetic, &tree, tree.ledger);
  }
  close(sub_start_, stored_energy(state_), only_motors() ? motion_of_trees(state_) : 0, nullptr, state_.result.ledger);
  const double gained = rows_took(sub_start_.ledger) - rows_took(state_.result.ledger);
  const double tiny = kTiny * std::abs(sub_start_.stored), links = momentum_.moving(Payers::Trees);
  constexpr double kErred = 0.1;  // of the energy in motion: what is taken back at once
  if (erred > tiny && erred <= kErred * links) momentum_.undo_gain(erred / links, false, Payers::Trees);
  if (!(gained > tiny)) return;
  // Where the step will not be tried more finely, it is paid at once: as the step ends, motion may be less than the
  // sum.
  const double all = momentum_.moving(Payers::All);
  const bool little = gained <= kFew * all;
  const double taken = little || state_.bodies() > kMostInParts ? std::min(gained, all) : 0;
  if (taken > 0) momentum_.take_from_all(taken / all, Payers::All);
  if (little) return;
  gained_ += gained;
  unpaid_ += gained - taken;
}

/// Of bodies on springs that contacts push. Errors of smooth motion keep within bounds only where nothing disturbs it:
/// in the parts of a sub-step they would add up.
void Books::close_networks() {
  if (!rows_.push()) return;
  constexpr double kErred = 0.1;  // of the energy in motion: what is taken back at once
  const double started = smooth_stored_ - smooth_works_, tiny = kTiny * std::abs(smooth_stored_);
  Energy& ledger = state_.result.ledger;
  ledger.contact_loss -= missing(stored_energy(state_) - started, sub_start_.ledger, ledger);
  settle_exchange(sub_start_.ledger, ledger);
  lent_ += std::max(0.0, rows_took(sub_start_.ledger) - rows_took(ledger));
  if (lent_ > tiny) {
    const double taken = pay(lent_, 1);
    lent_ -= taken;
    ledger.contact_loss += taken;
  }
  if (!state_.followed) return;
  erred_ += started - sub_start_.stored;
  if (erred_ > tiny) erred_ -= pay(erred_, kErred);
}

/// The motion of bodies without joints pays for energy that they were given.
/// @param most  of it, that pays
/// @return      J, that it paid
double Books::pay(double given, double most) {
  const Common common = momentum_.common_of_free_bodies();
  if (!(common.inner > 0)) return 0;
  const double taken = std::min(given, most * common.inner);
  momentum_.slow_free_bodies(common, taken);
  return taken;
}

/// @param pushed  J, that pushing bodies out of overlaps gave
void Books::settle_pushes(double pushed) {
  if (sprung_ && pushed > 0) state_.result.ledger.contact_loss += pay(pushed, kFew);
}

/// Once positions were put right after a sub-step of h seconds. Motors work at most by their strength along the way on
/// which their joints end: where one pressed on into a contact, and was pushed back, neither gave nor took.
void Books::settle_motors(double h) {
  if (!kept_ || rows_.motors() == 0) return;
  double all = 0;
  std::size_t next = 0;  // rows of motors are in the order of the clusters' trees
  for (Clustered& one : state_.clusters) {
    double most = 0;
    for (const std::uint32_t index : one.entry->trees) most += most_work_of(*state_.core.trees[index], h, next);
    all += most;
    if (one.alone()) give_back(one.sub_start.ledger, most, state_.core.trees[one.entry->trees.front()]->ledger);
  }
  give_back(sub_start_.ledger, all, state_.result.ledger);
}

void Books::note_start() {
  stored_ = stored_energy(state_);
  ledger_ = state_.result.ledger;
}

void Books::take_gain() {
  const double stored = stored_energy(state_);
  const double gain = missing(stored - stored_, ledger_, state_.result.ledger);
  const double all = momentum_.moving(Payers::Trees);
  if (gain > kTiny * std::abs(stored) && all > 0) momentum_.undo_gain(std::min(1.0, gain / all), false, Payers::Trees);
}

double Books::debt() const {
  double sum = 0;
  for (const Tree* tree : state_.trees) sum += tree->owed;
  return sum;
}

/// What they gave all the same, however finely the step was taken. Links that move too little among one another owe it.
/// @param undone  the step will be: it gave nothing
void Books::take_back_rest(bool undone) {
  const double sum = undone ? debt() : owed();
  gained_ = unpaid_ = 0;
  for (Tree* tree : state_.trees) tree->owed = 0;
  if (!(sum > 0)) return;
  const double all = undone ? 0 : momentum_.moving(Payers::All), taken = std::min(sum, all);
  if (taken > 0) momentum_.take_from_all(taken / all, Payers::All);
  state_.trees.front()->owed = sum - taken;
}

}  // namespace breve::island
