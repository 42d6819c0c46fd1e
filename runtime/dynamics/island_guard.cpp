// The guard: a step of an island that gives no numbers, or energy that nothing explains, is tried again more finely,
// and an island for which that does not help is put to rest. Nothing of it is silent.
#include <cmath>

#include "runtime/articulated/energy.hpp"
#include "runtime/base/error.hpp"
#include "runtime/dynamics/island.hpp"

namespace breve {

namespace {

// Of the energy in motion: what a step may gain that no account explains before the guard looks up. The fast rung is
// not meant to keep energy.
constexpr double kResidual = 0.1, kResidualFast = 10;

Accuracy finer_settings(const Accuracy& from, int attempt, double h) {
  Accuracy to = from;
  if (attempt == 1) {
    to.step = (from.step > 0 ? std::min(from.step, h) : h) / 4;
    if (from.contact_step > 0) to.contact_step = std::min(from.contact_step, h) / 4;
    return to;
  }
  to.scheme = articulated::Scheme::RungeKutta4;
  to.implicit_joints = false;
  to.step = h / 64;
  to.contact_step = 0;
  return to;
}

}  // namespace

void Island::step(DynamicsClient* client, double start, double h) {
  ++result.counters.islands;
  const GuardMode mode = core_.settings.guard;
  GuardReason reason{};
  double value = 0;
  // Where a handler may be called there is no going back.
  const bool again = !calls_out() && (mode == GuardMode::Refine || mode == GuardMode::Rest);
  keep_start();
  bool good = try_step(client, start, h, reason, value);
  if (mode == GuardMode::Off) {
    if (unfinished_ == 0) write();
    return;
  }
  if (!good && reason == GuardReason::Residual && mode == GuardMode::Report) {
    intervene(reason, GuardAction::Reported, start, value);
    good = true;
  }
  const Accuracy asked = accuracy_;
  for (int attempt = 1; !good && again && attempt <= 2; ++attempt) {
    intervene(reason, GuardAction::Refined, start, value);
    back_to_start();
    accuracy_ = finer_settings(asked, attempt, h);
    for (Clustered& one : clusters_) one.entry->system->set_accuracy(accuracy_);
    good = try_step(client, start, h, reason, value) || (attempt == 2 && reason == GuardReason::Residual);
  }
  if (accuracy_.step != asked.step || accuracy_.scheme != asked.scheme)
    for (Clustered& one : clusters_) one.entry->system->set_accuracy(asked);
  accuracy_ = asked;
  if (!good) {
    back_to_start();
    if (mode == GuardMode::Rest) stop();
    intervene(reason, mode == GuardMode::Rest ? GuardAction::Rested : GuardAction::Reported, start, value);
  }
  if (unfinished_ == 0) write();
}

bool Island::try_step(DynamicsClient* client, double start, double h, GuardReason& reason, double& value) {
  double kinetic = 0, residual = 0, turnover = 0;
  const double before = stored(kinetic, true);
  try {
    step_once(client, start, h);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Numeric || core_.settings.guard == GuardMode::Off) throw;
    reason = GuardReason::NoSolution;
    value = 0;
    return false;
  }
  if (unfinished_ > 0) return true;
  if (!finite()) {
    reason = GuardReason::NotFinite;
    value = 0;
    return false;
  }
  balance(before, residual, turnover);
  const double most = accuracy_.rung == Rung::Fast ? kResidualFast : kResidual;
  reason = GuardReason::Residual;
  value = residual;
  return !(residual > most * turnover + kTiny * std::abs(before));
}

namespace {

double works(const Energy& now, const Energy& then) {
  return now.motor_work + now.script_work - then.motor_work - then.script_work;
}
double losses(const Energy& now, const Energy& then) {
  return now.contact_loss + now.friction_loss + now.drag_loss + now.limit_loss - then.contact_loss -
         then.friction_loss - then.drag_loss - then.limit_loss;
}

}  // namespace

/// What of the step's change in energy no account explains, of all and of each tree.
/// @param turnover  J, of which the residual is to be a small part
void Island::balance(double before, double& residual, double& turnover) {
  double kinetic = 0;
  const double after = stored(kinetic, false);
  const double in = works(result.account, at_start_.account), out = losses(result.account, at_start_.account);
  residual = after - before - in + out;
  result.account.residual += residual;
  turnover = kinetic + std::abs(in) + std::abs(out);
  for (const Clustered& one : clusters_) {
    if (!one.alone()) continue;
    Tree& tree = *core_.trees[one.entry->trees.front()];
    const double change = tree.step_stored;
    tree.account.residual += change - works(tree.account, tree.step_account) + losses(tree.account, tree.step_account);
  }
}

void Island::keep_start() {
  at_start_ = {result.counters, result.account, result.impacts.size()};
  free_start_.clear();
  pair_start_.clear();
  for (const Free& one : free_) free_start_.push_back(one.now);
  for (Tree* tree : trees_) {
    tree->step_state = tree->state;
    tree->step_account = tree->account;
  }
  for (const NearPair* pair : pairs_) pair_start_.push_back(*pair);
}

void Island::back_to_start() {
  const std::uint64_t evaluations = result.counters.evaluations;
  result.counters = at_start_.counters;
  result.counters.evaluations = evaluations;
  result.account = at_start_.account;
  result.impacts.erase(result.impacts.begin() + static_cast<std::ptrdiff_t>(at_start_.impacts), result.impacts.end());
  for (std::size_t i = 0; i < free_.size(); ++i) free_[i].now = free_start_[i];
  for (Tree* tree : trees_) {
    tree->state = tree->step_state;
    tree->account = tree->step_account;
  }
  for (std::size_t i = 0; i < pairs_.size(); ++i) *pairs_[i] = pair_start_[i];
  for (Clustered& one : clusters_) one.entry->system->set_next_step(0);
  for (Free& one : free_) one.next = 0;
}

void Island::stop() {
  for (Free& one : free_) one.now.velocity = one.now.spin = Vector3::Zero();
  for (Tree* tree : trees_) tree->state.v.setZero();
}

bool Island::finite() const {
  for (const Free& one : free_)
    if (!one.now.center.allFinite() || !one.now.velocity.allFinite() || !one.now.spin.allFinite() ||
        !one.now.orientation.coeffs().allFinite())
      return false;
  for (Tree* tree : trees_)
    if (!tree->state.q.allFinite() || !tree->state.v.allFinite()) return false;
  return true;
}

/// Kinetic, potential and in springs, J. Notes for each tree its own: at the start of a step as it is, later as change.
double Island::stored(double& kinetic, bool start) {
  double sum = 0, moving = 0;
  for (const Free& one : free_) {
    moving += one.now.kinetic();
    sum -= one.now.solid->mass * core_.settings.gravity.dot(one.now.center);
  }
  for (Tree* tree : trees_) {
    const Energy energy = core_.energy_of(*tree);
    moving += energy.kinetic;
    sum += energy.potential + energy.springs;
    tree->step_stored = start ? energy.total() : energy.total() - tree->step_stored;
  }
  for (const Clustered& one : clusters_)
    for (const SpringIndex tie : one.entry->ties) sum += core_.tie_energy_in(core_.springs[tie].is);
  kinetic = moving;
  return sum + moving;
}

bool Island::still() const {
  constexpr double kSlow = 0.02;  // m/s and rad/s
  for (const Free& one : free_)
    if (one.now.velocity.norm() > kSlow || one.now.spin.norm() > kSlow) return false;
  for (Tree* tree : trees_)
    if (tree->state.v.cwiseAbs().maxCoeff() > kSlow) return false;
  return true;
}

BodyIndex Island::any_body() const { return free_.empty() ? trees_.front()->links.front().body : free_.front().body; }

void Island::intervene(GuardReason reason, GuardAction action, double time, double value) {
  result.interventions.push_back({core_.iteration, time, core_.bodies->owner(any_body()), reason, action, value});
}

}  // namespace breve
