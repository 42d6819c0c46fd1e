// The guard of an island.
#include "runtime/dynamics/island_guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/base/error.hpp"
#include "runtime/dynamics/island_energy.hpp"

namespace breve::island {

namespace {

constexpr int kFinest = 2;    // attempts after the first
constexpr double kMuch = 10;  // times what a step may leave unexplained
constexpr double kDebt = 2;   // likewise, that contacts gave and that motion may repay later

/// @param crowd  so many bodies that the step has to stay bounded
Accuracy finer_settings(const Accuracy& from, int attempt, double h, bool crowd) {
  Accuracy to = from;
  if (attempt == 1) {
    to.step = (from.step > 0 ? std::min(from.step, h) : h) / 4;
    if (from.contact_step > 0) to.contact_step = std::min(from.contact_step, h) / 4;
    return to;
  }
  constexpr int kManyIterations = 200;
  to.scheme = articulated::Scheme::RungeKutta4;
  to.implicit_joints = false;
  to.implicit_spin = false;
  to.step = h / (crowd ? 16 : 64);
  to.contact_step = 0;
  to.direct = true;
  if (!crowd) to.iterations = std::max(from.iterations, kManyIterations);
  return to;
}

}  // namespace

void Guard::step(MechanicsClient* client, double start, double h) {
  const GuardMode mode = state_.core.settings.guard;
  const Accuracy asked = state_.accuracy;
  state_.read_drives(h);
  loops_.see_whose_gaps();
  watch_.shorten_sub_steps(h);
  const Accuracy followed = state_.accuracy;
  Trouble trouble;
  int attempt = 0;
  const auto refine_from = [&] {
    state_.intervene(trouble, GuardAction::Refined, start);
    state_.use_accuracy(finer_settings(followed, ++attempt, h, state_.bodies() > kMostInParts));
  };
  const bool refines = mode == GuardMode::Refine || mode == GuardMode::Rest;
  // Motion that is too fast for the sub-steps is found before anything has moved.
  if (mode != GuardMode::Off) trouble = watch_.foresee(h);
  while (trouble.found && refines && attempt < kFinest) {
    refine_from();
    trouble = watch_.foresee(h);
  }
  if (trouble.found) state_.intervene(trouble, GuardAction::Reported, start);
  trouble = refines ? take_in_parts(client, start, h) : take(client, start, h);
  // Where a handler may have been called there is no going back.
  while (trouble.found && refines && !state_.calls_out() && attempt < finest(trouble) && !state_.worn()) {
    balance_.back_to_start();
    refine_from();
    trouble = take(client, start, h);
  }
  // Once a handler has dissolved the island there are no trees to read.
  const double owed = refines && !handlers_.dissolved() && !trouble.found ? books_.owed() : 0;
  const bool unpaid = owed > 0 && owed > energy_of_stillness(state_) && (astray() || unpayable(owed));
  if (unpaid) trouble = {true, GuardReason::Residual, owed, state_.any_body()};
  // A gain of a step that was finished coarsely also undoes it; but a loop that had to be closed stays closed.
  const bool coarse_gain = state_.finished && trouble.found && trouble.reason == GuardReason::Residual &&
                           trouble.value > momentum_.moving(Payers::Trees);
  const bool undone = ((unpaid && !state_.worn()) || coarse_gain) && !state_.calls_out();
  if (refines && !handlers_.dissolved()) {
    books_.take_back_rest(trouble.found && goes_back(trouble, undone));
    if (!trouble.found) undo_rise(asked.rung, start);
  }
  if (attempt > 0 || state_.finished || followed.step != asked.step) state_.end_use(asked);
  if (trouble.found) give_in(trouble, undone, start, h);
  if (handlers_.dissolved()) return;
  credit_.keep();
  balance_.settle();
}

/// How often a step is refined. What a script moves makes overlaps that no sub-step mends: one try tells.
int Guard::finest(const Trouble& trouble) const {
  return trouble.reason == GuardReason::Penetration && state_.drivers > 0 ? 1 : kFinest;
}

/// Contacts gave more than all that moved and worked, and than links may fall: positions are as wrong as velocities.
bool Guard::astray() const { return books_.gained() > balance_.supplied() + weight(state_); }

/// A debt that motion cannot repay is in the positions. A small one may be repaid later; a larger one undoes the step,
/// unless it only has what earlier steps left, and less of it.
/// @param owed  J
bool Guard::unpayable(double owed) const {
  const double all = momentum_.moving(Payers::All);
  return books_.gained() > all && owed - all > kDebt * allowed_;
}

/// Contacts have an error that may have the same sign in each step, as of a body that rotates on its edge. A rise of
/// energy of articulated bodies that is too small to try the step again is taken back from what moves: on `fast` any,
/// on the other rungs that of bodies which something outside touches. So is, on `fast` and `balanced`, one that no
/// finer sub-steps mended. Where that is all motion, the island was put to rest, which the guard reports.
void Guard::undo_rise(Rung rung, double start) {
  if (state_.trees.empty()) return undo_rise_of_free_bodies(rung);
  const double all = momentum_.moving(Payers::All), risen = balance_.risen();
  const bool drifts = rung == Rung::Fast || momentum_.touched_from_outside();
  const bool little = drifts && risen > kStill * weight(state_) && risen <= kFew * all;
  const bool coarse = rung == Rung::Fast || rung == Rung::Balanced;
  const bool unmended = coarse && tried_finer_ && risen > allowed_ && all > 0;
  if (!little && !unmended) return;
  momentum_.undo_gain(std::min(1.0, risen / all), true, Payers::All);
  if (risen >= all && all > energy_of_stillness(state_))
    state_.intervene({true, GuardReason::Residual, risen, state_.any_body()}, GuardAction::Rested, start);
}

/// The same on `fast` and `balanced` for bodies without joints, which may rotate far in a sub-step while they touch.
/// What flies or rolls pays for all of it; what lies has hardly any motion, and was put right where it overlapped.
/// What scripts move gives energy, and springs whose bodies nothing touches err on their own.
void Guard::undo_rise_of_free_bodies(Rung rung) {
  constexpr double kFlies = 4;  // times the rise
  if (rung != Rung::Fast && rung != Rung::Balanced) return;
  const double risen = balance_.risen();
  if (state_.drivers > 0 || !(risen > kStill * free_weight(state_))) return;
  if (!state_.networks.empty() && !momentum_.touched_from_outside()) return;
  const Common common = momentum_.common_of_free_bodies();
  if (!(common.inner > 0) || !std::isfinite(common.inner)) return;
  // A body that was pushed out of an overlap against a spring may gain more than moves in the end.
  const bool wound = !state_.networks.empty() && risen > kFew * state_.swung;
  const double most = wound ? common.inner : kFew * common.inner;
  const double taken = common.inner > kFlies * risen ? risen : std::min(risen, most);
  momentum_.slow_free_bodies(common, taken);
  state_.result.ledger.residual -= taken;
}

/// A step of articulated bodies whose energy does not add up is taken again in 2, 4, 8, ... parts: what rotates far in
/// a sub-step while a joint meets its limit or a foot the floor is not known well enough. Nothing of that is trouble.
Trouble Guard::take_in_parts(MechanicsClient* client, double start, double h) {
  const Accuracy asked = state_.accuracy;
  tried_finer_ = false;
  Trouble trouble = take(client, start, h);
  const bool coarse = state_.accuracy.rung == Rung::Fast || state_.accuracy.rung == Rung::Balanced;
  // Bodies without joints gain little, and a row of dominoes would cost four times as much.
  constexpr std::size_t kFewFree = 2;
  if (handlers_.dissolved() || (state_.trees.empty() && (coarse || state_.free_bodies.size() > kFewFree)))
    return trouble;
  const double debt = books_.debt();  // links that owe are followed more finely
  const std::size_t bodies = state_.bodies();
  const int most = bodies > kMostInParts || state_.calls_out()
                       ? 1
                       : static_cast<int>(std::max<std::size_t>(4, kMostInParts / bodies));
  // Finer steps go on while they leave less than this part of what the coarser one left unexplained. `balanced` is of
  // order 1 where motors meet contacts.
  const bool balanced = asked.rung == Rung::Balanced;
  const double mended = balanced ? 0.75 : 0.6;
  double last = std::numeric_limits<double>::infinity();
  const auto take_again = [&](int parts) {
    tried_finer_ = true;
    balance_.back_to_start();
    ++state_.result.counters.rejected;
    state_.accuracy.step = (asked.step > 0 ? std::min(asked.step, h) : h) / parts;
    if (asked.contact_step > 0) state_.accuracy.contact_step = std::min(asked.contact_step, h) / parts;
    trouble = take(client, start, h);
  };
  for (int parts = 2; parts <= most && unexplained_ + debt > allowed_ && !state_.worn(); parts *= 2) {
    // What finer steps do not mend is not theirs to mend, and what gains more on them is left as it was.
    if (!(unexplained_ < mended * last)) break;
    last = unexplained_;
    take_again(parts);
    if (!balanced || residual_ <= std::max(last, kMuch * allowed_)) continue;
    take_again(parts / 2);
    break;
  }
  state_.accuracy = asked;
  return trouble;
}

Trouble Guard::take(MechanicsClient* client, double start, double h) {
  const bool off = state_.core.settings.guard == GuardMode::Off;
  state_.squeezed = false;
  overlaps_.begin_try();
  momentum_.begin_try();
  books_.begin_try();
  residual_ = unexplained_ = allowed_ = 0;
  const double before = balance_.open();
  credit_.begin_try();
  try {
    step_.once(client, start, h);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Numeric || off) throw;
    return {true, GuardReason::NoSolution, 0, state_.any_body()};
  }
  if (handlers_.dissolved()) return {};
  if (const BodyIndex body = watch_.not_finite(); body != kNoBody) return {!off, GuardReason::NotFinite, 0, body};
  double turnover = 0;
  const double residual = balance_.close(turnover);
  if (!std::isfinite(residual)) return {!off, GuardReason::NotFinite, 0, state_.any_body()};
  if (balance_.absurd() && !off) return {true, GuardReason::NoSolution, 0, state_.any_body()};
  unexplained_ = std::abs(residual + books_.rotated()) + books_.gained();
  residual_ = residual;
  // Where links jam, what presses is beyond all numbers: its round-off counts up to what still links may have.
  const double sums = std::abs(before) + std::min(books_.pressed(), energy_of_stillness(state_) / kTiny);
  const double lying = state_.trees.empty() ? 0 : weight(state_) + free_weight(state_) + script_weight(state_);
  allowed_ = watch_.tolerated(turnover, h) + kTiny * sums + kStill * lying;
  if (off) return {};
  if (const Trouble deeper = overlaps_.measure(); deeper.found && !state_.squeezed) return deeper;
  return watch_.judge(residual, turnover, sums);
}

/// Unexplained energy ends with the speeds; positions, corrected meanwhile, are as good as any.
/// @param undone  springs or heights hold energy that ending all motion does not pay for
/// @return        whether the bodies stand in the end where they stood as the step began
bool Guard::goes_back(const Trouble& trouble, bool undone) const {
  const bool unusable = trouble.reason == GuardReason::NotFinite || trouble.reason == GuardReason::NoSolution;
  const bool rest = state_.core.settings.guard == GuardMode::Rest;
  return unusable || (rest && (undone || trouble.reason == GuardReason::Penetration));
}

/// Refining did not help: reports the trouble, and puts the island to rest if the settings say so.
void Guard::give_in(const Trouble& trouble, bool undone, double start, double h) {
  const bool rest = state_.core.settings.guard == GuardMode::Rest;
  const bool back = goes_back(trouble, undone);
  if (back) {
    balance_.back_to_start();
    forget_forces();
  }
  // An island that is slow enough to sleep and cannot be solved is resting: its velocities do not move it.
  const bool lies = trouble.reason == GuardReason::NoSolution && state_.still();
  if (rest || lies) put_to_rest(Momenta::Keep, back ? 0 : h);
  if (rest && back) momentum_.coast(h);
  if (watch_.not_finite() != kNoBody) stand_still();
  state_.intervene(trouble, rest ? GuardAction::Rested : GuardAction::Reported, start);
}

/// Where even the motion of the whole has no finite numbers, as under a gravity of 1e200, nothing moves at all.
void Guard::stand_still() {
  balance_.back_to_start();
  state_.place_links();
  double lost = 0;
  for (Free& one : state_.loose_bodies()) {
    lost += one.now.kinetic();
    one.now.velocity = one.now.spin = Vector3::Zero();
  }
  for (Clustered& one : state_.clusters) {
    double kinetic = 0;
    stored_energy(state_, one, kinetic);
    lost += kinetic;
    if (one.alone() && std::isfinite(kinetic)) one.entry->system->trees().front()->ledger.residual -= kinetic;
    for (Tree* tree : one.entry->system->trees()) tree->state.v.setZero();
  }
  if (std::isfinite(lost)) state_.result.ledger.residual -= lost;
  state_.booked = false;
}

/// The next step does not begin from the forces of contacts and limits that failed: else it would be the same step.
void Guard::forget_forces() {
  for (NearPair* pair : state_.pairs)
    if (!(pair->spring.stiffness > 0)) pair->warm_count = 0;
  for (const Tree* tree : state_.trees)
    for (const TreeLink& link : tree->links) {
      if (link.joint == kNoJoint) continue;
      JointEntry& joint = state_.core.joints[link.joint];
      joint.limit = joint.limit_before = Vector3::Zero();
    }
}

/// Takes velocities, and writes down that their energy is gone.
void Guard::put_to_rest(Momenta momenta, double h) {
  state_.booked = false;
  for (Free& one : state_.loose_bodies()) {
    state_.result.ledger.residual -= one.now.kinetic();
    one.now.velocity = one.now.spin = Vector3::Zero();
  }
  for (Clustered& one : state_.clusters) {
    const double lost = momentum_.stop(one, momenta, h);
    state_.result.ledger.residual -= lost;
    if (one.alone()) state_.core.trees[one.entry->trees.front()]->ledger.residual -= lost;
  }
  balance_.settle();
}

}  // namespace breve::island
