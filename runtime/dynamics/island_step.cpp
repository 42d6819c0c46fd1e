// The step of an island: smooth motion, impacts at their moments, contacts that last.
#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/articulated/kinematics.hpp"
#include "runtime/base/rotation_vector.hpp"
#include "runtime/dynamics/island.hpp"
#include "runtime/dynamics/joint_frames.hpp"
#include "runtime/dynamics/spring_network.hpp"

namespace breve {

/// Schemes of order 4 and 5 hold rings inside their stages, others by a rule of order 2 that is theirs.
bool Island::holds_loops() const {
  using articulated::Scheme;
  const Scheme scheme = accuracy_.scheme;
  if (scheme == Scheme::RungeKutta4 || scheme == Scheme::Fehlberg4 || scheme == Scheme::Fehlberg5 ||
      scheme == Scheme::FehlbergAdaptive)
    return true;
  return std::all_of(clusters_.begin(), clusters_.end(),
                     [](const Clustered& one) { return one.entry->system->can_be_finer(); });
}

std::uint64_t Island::loop_units() const {
  std::uint64_t units = 0;
  for (const Tree* tree : trees_)
    if (!tree->loops.empty()) units += tree->hold_units();
  return units;
}

/// Known before rows are made: whether there will be some beside those of rings, and of rings.
bool Island::has_rows() const {
  const auto driven = [](const Tree* tree) {
    return std::any_of(tree->links.begin(), tree->links.end(), [](const TreeLink& link) { return link.motor; });
  };
  return !touches_.empty() || std::any_of(trees_.begin(), trees_.end(), driven) ||
         std::any_of(bounds_.begin(), bounds_.end(), [](const Bound& bound) { return bound.rests; });
}

bool Island::has_loops() const {
  return std::any_of(trees_.begin(), trees_.end(), [](const Tree* tree) { return !tree->loops.empty(); });
}

namespace {
/// Into how many equal parts of at most `step` seconds `left` goes; rounding is not to make one more.
double parts_of(double left, double step) {
  constexpr double kTolerance = 1e-9, kMost = 1e9;
  return std::clamp(std::ceil(left / step - kTolerance), 1.0, kMost);
}
}  // namespace

/// @param lies  nothing moves that contacts would have to be followed for
double Island::longest(double left, bool lies) const {
  double step = accuracy_.step > 0 ? accuracy_.step : left;
  const bool touching = !lies && (has_rows() || has_loops());
  if (touching && accuracy_.contact_step > 0) step = std::min(step, accuracy_.contact_step);
  return left / parts_of(left, step);
}

void Island::step_undisturbed(double start, double h) {
  const double part = longest(h, false);
  const auto parts = static_cast<int>(std::llround(h / part));
  for (int i = 0; i < parts; ++i) {
    gone_ = i * part;
    if (unaffordable()) return finish(start + gone_, h - gone_);
    smooth(start + gone_, part);
    commit();
  }
}

/// The rest of a step whose work is used up, in one sub-step as coarse as there is. If the host interrupts the step,
/// the rest is left out: the bodies stay where they are.
void Island::finish(double time, double left) {
  constexpr int kFew = 8;
  finished_ = true;
  intervene({true, GuardReason::Work, static_cast<double>(meter_.done()), any_body()}, GuardAction::Finished, time);
  if (meter_.ended()) return;
  Accuracy coarse = breve::accuracy_of(Rung::Fast);
  coarse.iterations = std::min(coarse.iterations, kFew);
  use_accuracy(coarse);
  meter_.open();
  spent_ = true;
  take_fast(time, left);
}

// --- fast: one look a sub-step, velocities first ---------------------------------------------------------------------

void Island::step_fast(double start, double h) {
  spent_ = true;
  const double step = accuracy_.step > 0 ? accuracy_.step : h;
  const int parts = static_cast<int>(parts_of(h, step));
  const double part = h / parts;
  for (int i = 0; i < parts; ++i) {
    gone_ = i * part;
    if (unaffordable()) return finish(start + gone_, h - gone_);
    take_fast(start + gone_, part);
  }
}

void Island::take_fast(double time, double h) {
  look(h, true);
  if (meter_.ended()) return;  // what touches was not looked for to the end
  for (Bound& bound : bounds_) bound.rests = bound.gap + h * std::min(0.0, 2 * bound.rate) <= kLimitSkin;
  remember();
  open_books();
  predict(h);
  advance_once(time, h);
  commit();
  book_rows();
  close_books();
  note_overlaps(h);
  note_forces(h);
  keep_warm(h);
  push_apart(h);
}

/// Limits that smooth motion of h seconds has passed and that are not located also become rows. The books of the
/// sub-step are opened for them, if they are not open.
/// @return  whether there are some
bool Island::catch_bounds(double time, double h) {
  if (!spent_) return false;
  bool any = false;
  for (Bound& bound : bounds_) {
    if (bound.rests || bound.held) continue;
    const double gap = bound.sign * (core_.read_position(core_.joints[bound.joint])[bound.axis] - bound.limit);
    bound.rests = gap < std::min(bound.gap, 0.0) - kLimitSkin;
    any = any || bound.rests;
  }
  if (!any || keeps_books_) return any;
  restore();
  open_books();
  smooth(time, h);
  return true;
}

// --- impacts at their time ---

void Island::advance_once(double time, double h) {
  // A step whose work is used up leaves rings that are dear to hold to the rows, which are swept.
  constexpr std::uint64_t kDear = 20'000;
  const bool dear = finished_ && loop_units() > kDear, alone = has_loops() && !has_rows() && !dear,
             in_stages = (!alone || holds_loops()) && !dear;
  for (Clustered& one : clusters_) one.stage->holds_loops = in_stages;
  if (!in_stages && !dear) {
    place();
    make_rows(Motors::Leave);
    if (hold_loops(time, h)) return;
    // An impulse that does not close the loops would add unexplained energy.
    restore();
    for (Clustered& one : clusters_) one.stage->holds_loops = true;
  }
  smooth(time, h);
  if (!catch_bounds(time, h) && alone) return;
  note_smooth();
  place(h);
  if (misled(h)) {
    forget_prediction();
    restore();
    smooth(time, h);
    note_smooth();
    place(h);
  }
  solve_after(h);
  // A force that is constant over the step moves by half of what its change of velocity would.
  correct_works(h);
  store_velocities(0.5 * h);
  hold_off(h);
  hold_bounds(h);
}

/// Books the unexplained energy of the part of a step that was taken; it ends because the island has changed.
/// @param held  J, as that part ended, but for contact springs
void Island::end_unfinished(double held) {
  for (const NearPair* pair : pairs_) held += pair->stored;
  result.ledger.residual += unexplained_since_start(held);
}

/// Calls the handler of a pair that touches for the first time. False if what it did leaves nothing of the island as it
/// was: the rest of the step is then taken by the islands that are found anew.
bool Island::call(MechanicsClient& client, int index, double moment, double left) {
  NearPair& pair = *pairs_[static_cast<std::size_t>(index)];
  pair.reported = true;
  const Contact contact = closest(*core_.bodies->collision_shape(pair.a), pose_of(pair.a),
                                  *core_.bodies->collision_shape(pair.b), pose_of(pair.b));
  booked_ = false;
  write();
  const double held = held_energy();
  const std::uint64_t before = core_.structure();
  client.impact(pair.a, pair.b, contact, moment);
  core_.sync_changes();
  core_.settle_books(true);
  // Something was made or freed, or a spring was set to what points cannot follow.
  if (core_.structure() != before || !begin_networks(left)) {
    end_unfinished(held);
    dissolved_ = true;
    unfinished_ = left;
    return false;
  }
  for (const Clustered& one : clusters_)
    if (one.entry->network) one.entry->network->begin(core_);
  handled_ += held_energy() - held;
  for (Free& one : loose_bodies()) one.now = read_free(*core_.bodies, one.body);
  place_links();
  return true;
}

double Island::contact_part(double left, bool lies) const {
  const double step = accuracy_.step > 0 ? std::min(accuracy_.step, left) : left;
  return accuracy_.contact_step > 0 && !lies ? std::min(step, accuracy_.contact_step) : step;
}

/// Free bodies that are at rest, as far as that can be seen in a step of h seconds: slower than a small part of what
/// gravity would make of it. The forces that hold them do not depend on how long a sub-step is.
bool Island::lies(double h) const {
  constexpr double kRest = 1e-3;
  if (accuracy_.rung != Rung::Balanced || !trees_.empty() || drivers_ > 0 || has_contact_springs()) return false;
  const double most = kRest * core_.settings.gravity.norm() * h;
  return std::all_of(free_.begin(), free_.end(), [&](const Free& one) {
    const double radius = core_.bodies->collision_shape(one.body)->bounding_radius();
    return one.now.velocity.squaredNorm() <= most * most && radius * radius * one.now.spin.squaredNorm() <= most * most;
  });
}

/// @param spent  no impact is located any more: rows are to stop whatever comes within h seconds
void Island::look(double h, bool spent) {
  if (has_contact_springs())
    place();
  else
    place_links();
  rows_.clear();
  scalars_.clear();
  motors_.clear();
  loop_errors_.clear();
  find_touches(h, spent);
  take_springs();
  find_bounds();
  hold_limits(h);
  rebounds_.resize(bounds_.size());
}

void Island::note_start_poses() {
  start_poses_.clear();
  for (const NearPair* pair : pairs_) {
    start_poses_.push_back(pose_of(pair->a));
    start_poses_.push_back(pose_of(pair->b));
  }
}

/// After a part that was to be `part` seconds long, and lasted `took`.
void Island::book_part(double part, double took) {
  commit();
  book_rows();
  close_books();
  keep_springs();
  note_overlaps(part);
  note_forces(took);
}

void Island::tell_impacts(double time) {
  if (impacts_ >= accuracy_.impacts && core_.settings.guard != GuardMode::Off)
    intervene({true, GuardReason::Impacts, static_cast<double>(impacts_), any_body()}, GuardAction::Reported, time);
}

void Island::step_located(MechanicsClient* client, double start, double h) {
  double now = 0;
  impacts_ = 0;
  rebounds_.clear();
  int stalls = 0;
  constexpr double kTelling = 0.1;   // of a sub-step: a shorter one does not say which forces there are
  constexpr double kSliver = 1e-12;  // of the step
  constexpr int kMostStalls = 8;     // impacts without progress in time
  const int most_impacts = located_impacts();
  // What lies takes its step as one, and as any other if it moves by that.
  bool whole = lies(h);
  while (now < h * (1 - kSliver)) {
    gone_ = now;
    if (unaffordable()) return finish(start + now, h - now);
    const double sub = contact_part(h - now, whole);
    spent_ = impacts_ >= most_impacts || stalls > kMostStalls;
    bool struck = false;
    look(sub, spent_);
    if (meter_.ended()) continue;  // what touches was not looked for to the end
    if (!spent_ && strikes(sub)) {
      ++impacts_;
      struck = true;
      collide(start + now);
      look(sub, spent_);
    }
    if (!spent_) find_roles(sub, struck);
    const double part = longest(h - now, whole);
    const Energy ledger = result.ledger;
    remember();
    note_start_poses();
    open_books();
    predict(part);
    advance_once(start + now, part);
    Event event = spent_ ? Event() : seek(start + now, part);
    if (whole && (event.found() || !lies(part))) {
      restore();
      result.ledger = ledger;
      whole = false;
      continue;
    }
    if (event.found()) {
      ++impacts_;
      locate(start + now, event, part);
      stalls = event.time > kSliver * h ? 0 : stalls + 1;
    }
    book_part(part, event.found() ? std::max(event.time, kSliver * h) : part);
    if (!event.found()) {
      keep_warm(part);
      push_apart(part);
      now += part;
      continue;
    }
    keep_warm(event.time > kTelling * part ? event.time : 0);
    now += event.time;
    place();
    meet(client, event, start + now, h - now);
    if (dissolved_) return;
  }
  tell_impacts(start + h);
}

/// How many impacts of this step are located in time. Each costs a look at all pairs, and some solutions of all rows:
/// so that a crowd's step stays as long as its bodies and pairs are many, it has fewer. Later impacts are met at the
/// end of a sub-step, all at once.
int Island::located_impacts() const {
  if (accuracy_.rung == Rung::Reference) return accuracy_.impacts;
  // At a body or a pair, for impacts of one step.
  constexpr double kFewLooks = 1000, kLooks = 4000, kPreciseLooks = 20000;
  const bool coarse = accuracy_.rung == Rung::Balanced;
  const double looks = coarse ? kFewLooks : accuracy_.rung == Rung::Precise ? kPreciseLooks : kLooks;
  const double items = static_cast<double>(free_.size() + trees_.size() + pairs_.size());
  const int least = coarse ? 0 : 1;
  return std::clamp(static_cast<int>(looks / std::max(items, 1.0)), least, std::max(least, accuracy_.impacts));
}

void Island::place_links() {
  if (std::exchange(placed_, false)) return;
  for (Tree* tree : trees_) articulated::forward_kinematics(tree->model, tree->data, tree->state);
}

}  // namespace breve
