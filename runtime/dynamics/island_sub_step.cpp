// One sub-step of an island.
#include "runtime/dynamics/island_sub_step.hpp"

#include <algorithm>

#include "runtime/base/error.hpp"
#include "runtime/dynamics/island_energy.hpp"

namespace breve::island {

void SubStep::look(double h, bool spent) {
  if (state_.has_contact_springs())
    state_.place();
  else
    state_.place_links();
  rows_.clear();
  contacts_.find_touches(h, spent);
  springs_.take();
  contacts_.find_bounds();
  springs_.hold_limits(h);
}

void SubStep::open(double h) {
  state_.remember();
  books_.open();
  prediction_.make(h);
  // A step whose work is used up leaves loops that are dear to hold to the rows, which are swept.
  constexpr std::uint64_t kDear = 20'000;
  by_rows_ = false;
  if ((state_.finished && state_.loop_units() > kDear) || loops_.left_to_rows()) leave_to_rows();
}

/// From the state that was noted.
void SubStep::leave_to_rows() {
  by_rows_ = true;
  books_.note_start();
  for (Clustered& one : state_.clusters) one.stage->holds_loops = false;
}

/// Limits that smooth motion of h seconds has passed and that are not located also become rows. The books of the
/// sub-step are opened for them, if they are not open.
/// @return  whether there are some
bool SubStep::catch_bounds(double time, double h) {
  if (!contacts_.spent()) return false;
  const bool any = contacts_.find_passed(kLimitSkin);
  if (!any || books_.kept()) return any;
  state_.restore();
  books_.open();
  move(time, h);
  return true;
}

/// Smooth motion of h seconds from the state that was noted. Stages that take too long to hold loops do not hold them.
/// @return  false if they did not hold what they were to hold
bool SubStep::move(double time, double h) {
  // Ordinary motion takes some ten.
  constexpr int kMostEvaluations = 400, kMostOfReference = 6000;
  const bool held = std::any_of(state_.clusters.begin(), state_.clusters.end(),
                                [](const Clustered& one) { return one.stage->holds_loops; });
  const bool bounded = held && state_.has_loops();
  const int most = state_.accuracy.rung == Rung::Reference ? kMostOfReference : kMostEvaluations;
  const auto allow = [this](int evaluations) {
    for (Clustered& one : state_.clusters) one.entry->system->set_most_evaluations(evaluations);
  };
  allow(bounded ? most : 0);
  try {
    smooth_.move(time, h);
    allow(0);
    return true;
  } catch (const Error& error) {
    allow(0);
    if (error.code() != ErrorCode::Numeric || !bounded || state_.meter.over()) throw;
  }
  loops_.leave_to_rows();
  state_.restore();
  leave_to_rows();
  smooth_.move(time, h);
  return false;
}

void SubStep::advance(double time, double h) {
  const bool alone = state_.has_loops() && !contacts_.any() && !by_rows_;
  const bool in_stages = (!alone || loops_.in_stages()) && !by_rows_;
  for (Clustered& one : state_.clusters) one.stage->holds_loops = in_stages;
  if (!in_stages && !by_rows_) {
    state_.place();
    rows_.make(Rows::Motors::Leave);
    if (loops_.hold(time, h)) return;
    // An impulse that does not close the loops would add unexplained energy.
    state_.restore();
    for (Clustered& one : state_.clusters) one.stage->holds_loops = true;
  }
  const bool held = move(time, h);
  if (!catch_bounds(time, h) && alone && held) return;
  solve_moved(time, h);
  solve_as_learned(time, h);
  move_by_rows(h);
  // What the rows stop may come down, or meet a limit, elsewhere.
  if (missed(h)) {
    state_.restore();
    if (!books_.kept()) books_.open();
    solve(time, h);
    move_by_rows(h);
  }
}

/// Smooth motion of h seconds from the state that was noted, and the rows' solution.
void SubStep::solve(double time, double h) {
  move(time, h);
  solve_moved(time, h);
}

/// The rows' solution after smooth motion of h seconds; without what was predicted if that threw something.
void SubStep::solve_moved(double time, double h) {
  const auto solve_rows = [&] {
    check_prediction(time, h);
    solver_.solve_after(h);
  };
  solve_rows();
  for (const bool all : {false, true}) {
    if (!prediction_.threw()) return;
    all ? prediction_.forget() : prediction_.forget_contacts();
    state_.restore();
    move(time, h);
    solve_rows();
  }
}

/// Where joints or loops swing too far before the rows stop them, a solution with the forces that these rows gave; the
/// first one again if that throws links.
void SubStep::solve_as_learned(double time, double h) {
  constexpr double kThrown = 2, kLifted = 0.01;  // times the motion of the first solution; of weight()
  const bool loops = by_rows_ && prediction_.loops_swing(h);
  if (!loops && !prediction_.limits_swing(h)) return;
  const double most = kThrown * motion_of_trees(state_) + kLifted * weight(state_);
  state_.restore();
  prediction_.learn(h, loops);
  solve(time, h);
  if (motion_of_trees(state_) <= most) return;
  state_.restore();
  state_.place_links();
  prediction_.make(h);
  solve(time, h);
}

/// What the rows gave in h seconds moves the island. A force that is constant over the step moves by half of what its
/// change of velocity would.
void SubStep::move_by_rows(double h) {
  for (Clustered& one : state_.clusters) note_pushed(one);
  solver_.limit_moves(0.5 * h);
  smooth_.correct_works(h);
  state_.store_velocities();
  books_.note_solved();
  solver_.move_by_impulses(0.5 * h, books_.smooth_stored());
  for (Clustered& one : state_.clusters) one.pending.script_work += work_on_pushed(one);
  const bool struck = positions_.hold_off(h) || positions_.went_on();
  positions_.put_back(h, struck);
  if (!struck && books_.kept() && positions_.sank()) positions_.raise(h, std::max(0.0, books_.taken()));
}

/// After the rows of h seconds: contacts and limits of articulated bodies that no row was made for, and that they have
/// passed. They become rows. Where impacts are located, what is passed ends the sub-step instead; where work is used
/// up, no sub-step is repeated.
/// @return  whether there are some
bool SubStep::missed(double h) {
  constexpr double kPassed = 0.01;  // rad, or the world's length unit
  if (state_.trees.empty() || state_.accuracy.locate_impacts || state_.finished) return false;
  state_.place_links();
  const bool points = contacts_.find_missed(h), bounds = contacts_.find_passed(kPassed);
  return points || bounds;
}

/// After smooth motion of h seconds: its books, and those of a motion without what was predicted if that misled it.
void SubStep::check_prediction(double time, double h) {
  books_.note_smooth(smooth_.free_works());
  state_.place(h);
  for (const bool all : {false, true}) {
    if (!prediction_.misled(h)) return;
    all ? prediction_.forget() : prediction_.forget_contacts();
    state_.restore();
    move(time, h);
    books_.note_smooth(smooth_.free_works());
    state_.place(h);
  }
}

void SubStep::keep(double part, double took) {
  loops_.note_left();
  smooth_.commit();
  rows_.book();
  books_.close();
  springs_.keep();
  overlaps_.note(part);
  if (state_.trees.empty()) return;
  rows_.note_contact_forces(took);
  springs_.note_forces();
  rows_.note_limit_forces(took);
}

void SubStep::put_right(double h) {
  const double before = state_.result.ledger.contact_loss;
  positions_.push_apart(h);
  books_.settle_pushes(before - state_.result.ledger.contact_loss);
  loops_.close(by_rows_);
  if (by_rows_) books_.take_gain();
  books_.settle_motors(h);
}

}  // namespace breve::island
