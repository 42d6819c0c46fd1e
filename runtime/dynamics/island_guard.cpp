// The guard: a step of an island in which something goes wrong (island_watch.cpp says what) is tried again more finely,
// and an island for which that does not help is put to rest. Nothing of it is silent.
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/base/error.hpp"
#include "runtime/dynamics/island.hpp"

namespace breve {

namespace {

constexpr int kFinest = 2;      // attempts after the first
constexpr double kSlow = 0.02;  // m/s and rad/s: slower is still
// Sub-steps of a step whose energy does not balance, times the bodies that it moves: a crowd's step stays bounded.
constexpr std::size_t kMostInParts = 40;
constexpr double kMended = 0.6;  // of the energy that a step of twice the length left unexplained

Accuracy finer_settings(const Accuracy& from, int attempt, double h) {
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
  to.step = h / 64;
  to.contact_step = 0;
  to.direct = true;
  to.iterations = std::max(from.iterations, kManyIterations);
  return to;
}

}  // namespace

void Island::use_accuracy(const Accuracy& accuracy) {
  accuracy_ = accuracy;
  for (Clustered& one : clusters_) one.entry->system->set_accuracy(accuracy);
}

void Island::step_guarded(MechanicsClient* client, double start, double h) {
  const GuardMode mode = core_.settings.guard;
  const Accuracy asked = accuracy_;
  follow_rotations(h);
  const Accuracy followed = accuracy_;
  Trouble trouble;
  int attempt = 0;
  const auto refine_from = [&] {
    intervene(trouble, GuardAction::Refined, start);
    use_accuracy(finer_settings(followed, ++attempt, h));
  };
  const bool refines = mode == GuardMode::Refine || mode == GuardMode::Rest;
  // Motion that is too fast for the sub-steps is found before anything has moved.
  if (mode != GuardMode::Off) trouble = foresee(h);
  while (trouble.found && refines && attempt < kFinest) {
    refine_from();
    trouble = foresee(h);
  }
  if (trouble.found) intervene(trouble, GuardAction::Reported, start);
  trouble = refines ? try_in_parts(client, start, h) : try_step(client, start, h);
  // Where a handler may have been called there is no going back.
  while (trouble.found && refines && !calls_out() && attempt < kFinest && !worn()) {
    back_to_start();
    refine_from();
    trouble = try_step(client, start, h);
  }
  // More than all that moves: whatever was solved there is wrong, and positions hold what cannot be paid for.
  constexpr double kMuch = 10;  // times what a step may leave unexplained
  const bool unpaid = refines && !dissolved_ && !trouble.found && gained_ > energy_of_stillness() &&
                      gained_ > kMuch * allowed_ && gained_ > moving();
  if (unpaid) trouble = {true, GuardReason::Residual, gained_, any_body()};
  if (refines && !dissolved_) take_back_rest();
  if (attempt > 0 || finished_ || followed.step != asked.step) use_accuracy(asked);
  if (trouble.found) give_in(trouble, unpaid && !calls_out() && !worn(), start, h);
}

/// A step of articulated bodies whose energy does not add up is taken again in 2, 4, 8, ... parts: what turns far in a
/// sub-step while a joint meets its limit or a foot the floor is not known well enough. Nothing of that is trouble.
Island::Trouble Island::try_in_parts(MechanicsClient* client, double start, double h) {
  const Accuracy asked = accuracy_;
  Trouble trouble = try_step(client, start, h);
  const bool coarse = accuracy_.rung == Rung::Fast || accuracy_.rung == Rung::Balanced;
  // Bodies without joints gain little, and a row of dominoes would cost four times as much.
  constexpr std::size_t kFewFree = 2;
  if (dissolved_ || (trees_.empty() && (coarse || free_.size() > kFewFree))) return trouble;
  std::size_t links = 0;
  for (const Tree* tree : trees_) links += tree->links.size();
  const std::size_t bodies = links + free_.size();
  const int most =
      bodies > kMostInParts || calls_out() ? 1 : static_cast<int>(std::max<std::size_t>(4, kMostInParts / bodies));
  double last = std::numeric_limits<double>::infinity();
  for (int parts = 2; parts <= most && unexplained_ > allowed_ && !worn(); parts *= 2) {
    // What finer steps do not mend is not theirs to mend.
    if (!(unexplained_ < kMended * last)) break;
    last = unexplained_;
    back_to_start();
    ++result.counters.rejected;
    accuracy_.step = (asked.step > 0 ? std::min(asked.step, h) : h) / parts;
    if (asked.contact_step > 0) accuracy_.contact_step = std::min(asked.contact_step, h) / parts;
    trouble = try_step(client, start, h);
  }
  accuracy_ = asked;
  return trouble;
}

/// Energy that a step of h seconds may leave unexplained, J: of what moves, by the second, and of what is turned over.
double Island::tolerated(double turnover, double h) const {
  switch (accuracy_.rung) {
    case Rung::Fast: return (5e-3 * h + 1e-3) * turnover;
    case Rung::Balanced: return (5e-3 * h + 5e-4) * turnover;
    default: return (5e-5 * h + 5e-6) * turnover;
  }
}

/// What lifting all by their own size takes, J: of that, what lies still may err by round-off of its solution.
double Island::weight() const {
  double sum = 0;
  for (const Tree* tree : trees_)
    for (const TreeLink& link : tree->links)
      sum += link.solid.mass * core_.bodies->collision_shape(link.body)->bounding_radius();
  return sum * core_.settings.gravity.norm();
}

/// Refining did not help: reports the trouble, and puts the island to rest if the settings say so.
/// @param unpaid  springs or heights hold energy that ending all motion does not pay for
void Island::give_in(const Trouble& trouble, bool unpaid, double start, double h) {
  const bool rest = core_.settings.guard == GuardMode::Rest;
  const bool unusable = trouble.reason == GuardReason::NotFinite || trouble.reason == GuardReason::NoSolution;
  // Unexplained energy ends with the speeds; positions, corrected on the way, are as good as any.
  const bool back = unusable || (rest && (unpaid || trouble.reason == GuardReason::Penetration));
  if (back) back_to_start();
  // An island that is slow enough to sleep and cannot be solved is resting: its velocities do not move it.
  const bool lies = trouble.reason == GuardReason::NoSolution && still();
  if (rest || lies) stop(Momenta::Keep, back ? 0 : h);
  if (rest && back) coast(h);
  intervene(trouble, rest ? GuardAction::Rested : GuardAction::Reported, start);
}

Island::Trouble Island::try_step(MechanicsClient* client, double start, double h) {
  const bool off = core_.settings.guard == GuardMode::Off;
  double kinetic = 0, residual = 0, turnover = 0;
  overlaps_.clear();
  overlapped_.clear();
  touched_ = false;
  unexplained_ = allowed_ = gained_ = handled_ = 0;
  booked_ = false;
  const double before = stored_start_ = stored(kinetic, true);
  try {
    step_once(client, start, h);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Numeric || off) throw;
    return {true, GuardReason::NoSolution, 0, any_body()};
  }
  if (dissolved_) return {};
  if (const BodyIndex body = not_finite(); body != kNoBody) return {!off, GuardReason::NotFinite, 0, body};
  balance(residual, turnover);
  unexplained_ = std::abs(residual) + gained_;
  allowed_ = tolerated(turnover, h) + kTiny * std::abs(before) + kStill * weight();
  if (off) return {};
  if (const Trouble deeper = measure_overlaps(); deeper.found) return deeper;
  return judge_residual(residual, turnover, before);
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

/// The energy that came in since the step began and that the energy ledger does not explain, J.
double Island::unexplained_since_start(double after) const {
  return after - stored_start_ - works(result.ledger, at_start_.ledger) + losses(result.ledger, at_start_.ledger) -
         handled_;
}

/// The part of the step's change in energy that the energy ledger does not explain, of all and of each tree.
/// @param turnover  J, of which the residual is to be a small part
void Island::balance(double& residual, double& turnover) {
  double kinetic = 0;
  const double after = stored(kinetic, false);
  const double in = works(result.ledger, at_start_.ledger), out = losses(result.ledger, at_start_.ledger);
  residual = unexplained_since_start(after);
  result.ledger.residual += residual;
  turnover = kinetic + std::abs(in) + std::abs(out);
  for (const Clustered& one : clusters_) {
    if (!one.alone()) continue;
    Tree& tree = *core_.trees[one.entry->trees.front()];
    const double change = tree.step_stored;
    tree.ledger.residual += change - works(tree.ledger, tree.step_ledger) + losses(tree.ledger, tree.step_ledger);
  }
}

void Island::keep_start() {
  at_start_ = {result.counters, result.ledger, result.impacts.size()};
  free_start_.clear();
  pair_start_.clear();
  for (const Free& one : free_) free_start_.push_back(one.now);
  for (Tree* tree : trees_) {
    tree->step_state = tree->state;
    tree->step_ledger = tree->ledger;
  }
  for (const NearPair* pair : pairs_) pair_start_.push_back(*pair);
}

void Island::back_to_start() {
  placed_ = booked_ = false;
  const std::uint64_t evaluations = result.counters.evaluations;
  result.counters = at_start_.counters;
  result.counters.evaluations = evaluations;
  result.ledger = at_start_.ledger;
  result.impacts.erase(result.impacts.begin() + static_cast<std::ptrdiff_t>(at_start_.impacts), result.impacts.end());
  for (std::size_t i = 0; i < free_.size(); ++i) free_[i].now = free_start_[i];
  for (Tree* tree : trees_) {
    tree->state = tree->step_state;
    tree->ledger = tree->step_ledger;
  }
  for (std::size_t i = 0; i < pairs_.size(); ++i) *pairs_[i] = pair_start_[i];
  for (Clustered& one : clusters_) one.entry->system->set_next_step(0);
  for (Free& one : free_) one.next = 0;
}

/// Takes velocities, and writes down that their energy is gone: first as what contacts and limits gave in the step.
void Island::stop(Momenta momenta, double h) {
  placed_ = booked_ = false;
  const auto take = [](Energy& ledger, const Energy& start, double lost) {
    const double rows = losses(start, ledger) + ledger.drag_loss - start.drag_loss;
    const double repaid = std::clamp(rows, 0.0, std::max(lost, 0.0));
    ledger.contact_loss += repaid;
    ledger.residual -= lost - repaid;
  };
  for (Free& one : loose_bodies()) {
    result.ledger.residual -= one.now.kinetic();
    one.now.velocity = one.now.spin = Vector3::Zero();
  }
  for (Clustered& one : clusters_) {
    const double lost = stop_links(one, momenta, h);
    take(result.ledger, at_start_.ledger, lost);
    if (!one.alone()) continue;
    Tree& tree = *core_.trees[one.entry->trees.front()];
    take(tree.ledger, tree.step_ledger, lost);
  }
}

/// Kinetic, potential and in springs, J. Notes for each tree its own: at the start of a step as it is, later as change.
double Island::stored(double& kinetic, bool start) {
  double sum = 0, moving = 0;
  for (const Free& one : loose_bodies()) {
    moving += one.now.kinetic();
    sum -= one.now.solid->mass * core_.settings.gravity.dot(one.now.center);
  }
  for (Tree* tree : trees_) {
    const Energy energy = core_.energy_of(*tree);
    moving += energy.kinetic;
    sum += energy.potential + energy.springs;
    tree->step_stored = start ? energy.total() : energy.total() - tree->step_stored;
    if (start) tree->step_kinetic = energy.kinetic;
    if (!start) tree->booked = energy.total();
  }
  sum += network_energy();
  for (const Clustered& one : clusters_) sum += spring_energy_in(one);
  for (const NearPair* pair : pairs_) sum += pair->stored;
  kinetic = moving;
  placed_ = true;
  booked_ = !start;
  return sum + moving;
}

/// The same, of what stands in the arrays: while a handler may change it.
double Island::held_energy() const {
  double sum = 0;
  for (const Free& one : loose_bodies()) sum += core_.free_energy(one.body).total();
  sum += held_network_energy();
  for (Tree* tree : trees_) sum += core_.energy_of(*tree).total();
  for (const Clustered& one : clusters_)
    for (const SpringIndex spring : one.entry->springs) sum += core_.spring_energy(core_.springs[spring].is);
  return sum;
}

/// Enters the state of the arrays into the energy ledger: scripts have made whatever differs from it later.
void Island::book() {
  const std::size_t first = networks_.empty() ? free_.size() : networks_.front().first, end = networks_end();
  const std::span<const Free> loose = loose_bodies();
  for (std::size_t i = 0; i < loose.size(); ++i) {
    if (i >= first && i < end) continue;
    const Free& one = loose[i];
    // Read back as it will be when a script sets something: a centre of mass off the origin is rounded on the way.
    const bool central = one.now.solid->center_of_mass == Vector3::Zero();
    core_.booked[one.body] = central
                                 ? one.now.kinetic() - one.now.solid->mass * core_.settings.gravity.dot(one.now.center)
                                 : core_.free_energy(one.body).total();
  }
  book_networks();
  for (Tree* tree : trees_) {
    if (!booked_) tree->booked = core_.energy_of(*tree).total();
    tree->changed = false;
  }
  for (const Clustered& one : clusters_)
    for (const SpringIndex spring : one.entry->springs)
      core_.springs[spring].booked = core_.spring_energy(core_.springs[spring].is);
}

/// What trees have at most that are still, J.
double Island::energy_of_stillness() const {
  double mass = 0;
  for (const Tree* tree : trees_)
    for (const TreeLink& link : tree->links) mass += link.solid.mass;
  return 0.5 * kSlow * kSlow * mass;
}

bool Island::still() const {
  for (const Free& one : loose_bodies())
    if (one.now.velocity.norm() > kSlow || one.now.spin.norm() > kSlow) return false;
  for (Tree* tree : trees_) {
    if (tree->state.v.size() > 0 && tree->state.v.cwiseAbs().maxCoeff() > kSlow) return false;
    // A motor that is to turn does not rest, however slowly it turns.
    const articulated::Vector& wanted = tree->loads.motor_speed;
    if (wanted.size() > 0 && (wanted.array() != 0).any()) return false;
  }
  return true;
}

BodyIndex Island::any_body() const {
  return loose_bodies().empty() ? trees_.front()->links.front().body : free_.front().body;
}

void Island::intervene(const Trouble& trouble, GuardAction action, double time) {
  result.interventions.push_back(
      {core_.iteration, time, core_.bodies->owner(trouble.body), trouble.reason, action, trouble.value});
}

}  // namespace breve
