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
  if (mode == GuardMode::Off) {
    step_once(client, start, h);
    if (unfinished_ == 0) write();
    return;
  }
  // Where a handler may be called there is no going back.
  const bool again = !calls_out() && mode != GuardMode::Report;
  keep_start();
  bool good = try_step(client, start, h, reason, value);
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
  const double before = stored();
  const Energy accounts = result.account;
  try {
    step_once(client, start, h);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Numeric) throw;
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
  const Energy& now = result.account;
  const double works = now.motor_work + now.script_work - accounts.motor_work - accounts.script_work;
  const double losses = now.contact_loss + now.friction_loss + now.drag_loss + now.limit_loss - accounts.contact_loss -
                        accounts.friction_loss - accounts.drag_loss - accounts.limit_loss;
  double kinetic = 0;
  const double after = stored(&kinetic);
  const double residual = after - before - works + losses;
  result.account.residual += residual;
  if (trees_.size() == 1 && free_.empty()) trees_.front().tree->account.residual += residual;
  const double most = accuracy_.rung == Rung::Fast ? kResidualFast : kResidual;
  reason = GuardReason::Residual;
  value = residual;
  return !(residual > most * (kinetic + std::abs(works) + std::abs(losses)) + kTiny * std::abs(before));
}

void Island::keep_start() {
  at_start_.counters = result.counters;
  at_start_.account = result.account;
  free_start_.clear();
  tree_start_.clear();
  pair_start_.clear();
  for (const Free& one : free_) free_start_.push_back(one.now);
  for (const Treed& one : trees_) tree_start_.push_back(one.tree->state);
  for (const NearPair* pair : pairs_) pair_start_.push_back(*pair);
}

void Island::back_to_start() {
  const std::uint64_t evaluations = result.counters.evaluations;
  result.counters = at_start_.counters;
  result.counters.evaluations = evaluations;
  result.account = at_start_.account;
  for (std::size_t i = 0; i < free_.size(); ++i) free_[i].now = free_start_[i];
  for (std::size_t i = 0; i < trees_.size(); ++i) trees_[i].tree->state = tree_start_[i];
  for (std::size_t i = 0; i < pairs_.size(); ++i) *pairs_[i] = pair_start_[i];
  for (Clustered& one : clusters_) one.entry->system->set_next_step(0);
  for (Free& one : free_) one.next = 0;
}

void Island::stop() {
  for (Free& one : free_) one.now.velocity = one.now.spin = Vector3::Zero();
  for (Treed& one : trees_) one.tree->state.v.setZero();
}

bool Island::finite() const {
  for (const Free& one : free_)
    if (!one.now.center.allFinite() || !one.now.velocity.allFinite() || !one.now.spin.allFinite() ||
        !one.now.orientation.coeffs().allFinite())
      return false;
  for (const Treed& one : trees_)
    if (!one.tree->state.q.allFinite() || !one.tree->state.v.allFinite()) return false;
  return true;
}

double Island::stored(double* kinetic) const {
  double sum = 0, moving = 0;
  for (const Free& one : free_) {
    moving += one.now.kinetic();
    sum -= one.now.solid->mass * core_.settings.gravity.dot(one.now.center);
  }
  for (const Treed& one : trees_) {
    const Energy energy = core_.energy_of(*one.tree);
    moving += energy.kinetic;
    sum += energy.potential + energy.springs;
  }
  for (const Clustered& one : clusters_)
    for (const SpringIndex tie : one.entry->ties) sum += core_.tie_energy_in(core_.springs[tie].is);
  if (kinetic) *kinetic = moving;
  return sum + moving;
}

bool Island::still() const {
  constexpr double kSlow = 0.02;  // m/s and rad/s
  for (const Free& one : free_)
    if (one.now.velocity.norm() > kSlow || one.now.spin.norm() > kSlow) return false;
  for (const Treed& one : trees_)
    if (one.tree->state.v.cwiseAbs().maxCoeff() > kSlow) return false;
  return true;
}

BodyIndex Island::any_body() const {
  return free_.empty() ? trees_.front().tree->links.front().body : free_.front().body;
}

void Island::intervene(GuardReason reason, GuardAction action, double time, double value) {
  result.interventions.push_back({core_.iteration, time, core_.bodies->owner(any_body()), reason, action, value});
}

}  // namespace breve
