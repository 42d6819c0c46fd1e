// The step of an island: smooth motion, impacts at their moments, contacts that last.
#include <algorithm>
#include <cmath>

#include "runtime/articulated/kinematics.hpp"
#include "runtime/base/rotation_vector.hpp"
#include "runtime/dynamics/island.hpp"
#include "runtime/dynamics/joint_frames.hpp"

namespace breve {

/// Schemes of order 4 and 5 hold rings inside their stages, others by a rule of order 2 that is theirs.
bool Island::holds_rings() const {
  using articulated::Scheme;
  const Scheme scheme = accuracy_.scheme;
  if (scheme == Scheme::RungeKutta4 || scheme == Scheme::Fehlberg4 || scheme == Scheme::Fehlberg5 ||
      scheme == Scheme::FehlbergAdaptive)
    return true;
  return std::all_of(clusters_.begin(), clusters_.end(),
                     [](const Clustered& one) { return one.entry->system->can_be_finer(); });
}

bool Island::only_rings() const { return rows_.empty() && !scalars_.empty() && scalars_.size() == ring_errors_.size(); }

double Island::longest(double left) const {
  double step = accuracy_.step > 0 ? accuracy_.step : left;
  const bool touching = !rows_.empty() || !scalars_.empty();
  if (touching && accuracy_.contact_step > 0) step = std::min(step, accuracy_.contact_step);
  // Equal parts, and rounding is not to make one more.
  constexpr double kTolerance = 1e-9;
  return left / std::max(1.0, std::ceil(left / step - kTolerance));
}

void Island::step_quiet(double start, double h) {
  const double part = longest(h);
  const auto parts = static_cast<int>(std::llround(h / part));
  for (int i = 0; i < parts; ++i) {
    smooth(start + i * part, part);
    commit();
  }
}

// --- fast: one look a sub-step, velocities first ---------------------------------------------------------------------

void Island::step_fast(double start, double h) {
  const double step = accuracy_.step > 0 ? accuracy_.step : h;
  const int parts = static_cast<int>(std::max(1.0, std::ceil(h / step - 1e-9)));
  const double part = h / parts;
  for (int i = 0; i < parts; ++i) {
    place();
    find_touches(part, true);
    take_springs();
    find_bounds();
    for (Bound& bound : bounds_) bound.rests = bound.gap + part * std::min(0.0, 2 * bound.rate) <= kLimitSkin;
    make_rows(part, true);
    for (std::size_t k = 0, s = 0; k < bounds_.size(); ++k) {
      if (!bounds_[k].rests) continue;
      const double e = core_.joints[bounds_[k].joint].drive.limit_restitution;
      if (bounds_[k].rate < -quiet_) scalars_[s].bias = std::max(scalars_[s].bias, -e * bounds_[k].rate);
      ++s;
    }
    if (only_rings()) {
      remember();
      advance_once(start + i * part, part);
      commit();
    } else {
      for (Clustered& one : clusters_) one.stage->holds_rings = false;
      smooth(start + i * part, part);
      commit();
      load_velocities();
      solve();
      account_rows();
      note_overlaps(part);
      store_velocities(part);
    }
    note_forces(part);
    keep_warm();
    push_apart(part);
  }
}

// --- impacts at their time ---

void Island::advance_once(double time, double h) {
  const bool alone = only_rings(), in_stages = !alone || holds_rings();
  for (Clustered& one : clusters_) one.stage->holds_rings = in_stages;
  if (!in_stages) {
    if (hold_rings(time, h)) return;
    // An impulse that does not close the rings would be energy from nowhere.
    restore();
    for (Clustered& one : clusters_) one.stage->holds_rings = true;
  }
  smooth(time, h);
  if (alone) return;
  load_velocities();
  set_biases(h);
  for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i].impulse = warm_[i];
  solve();
  // A force that is constant over the step moves by half of what its change of velocity would.
  correct_works(h);
  store_velocities(0.5 * h);
}

/// Calls the handler of a pair that touches for the first time. False if what it did leaves nothing of the island as it
/// was: the rest of the step is then taken by the islands that are found anew.
bool Island::call(DynamicsClient& client, int index, double moment, double left) {
  NearPair& pair = *pairs_[static_cast<std::size_t>(index)];
  pair.reported = true;
  const Contact contact = closest(*core_.bodies->collision_shape(pair.a), pose_of(pair.a),
                                  *core_.bodies->collision_shape(pair.b), pose_of(pair.b));
  write();
  const std::uint64_t before = core_.structure();
  client.impact(pair.a, pair.b, contact, moment);
  core_.sync_changes();
  if (core_.structure() != before) {
    unfinished_ = left;
    return false;
  }
  for (Free& one : free_) one.now = read_free(*core_.bodies, one.body);
  place();
  return true;
}

double Island::contact_part(double left) const {
  const double step = accuracy_.step > 0 ? std::min(accuracy_.step, left) : left;
  return accuracy_.contact_step > 0 ? std::min(step, accuracy_.contact_step) : step;
}

/// @param spent  no impact is located any more: rows are to stop whatever comes within h seconds
void Island::look(double h, bool spent) {
  place();
  find_touches(h, spent);
  take_springs();
  find_bounds();
  hold_limits(h);
  rebounds_.resize(bounds_.size());
}

void Island::step_located(DynamicsClient* client, double start, double h) {
  double now = 0;
  impacts_ = 0;
  rebounds_.clear();
  int stalls = 0;
  constexpr double kSliver = 1e-12;  // of the step
  constexpr int kMostStalls = 8;     // impacts without progress in time
  while (now < h * (1 - kSliver)) {
    const double sub = contact_part(h - now);
    const bool spent = impacts_ > accuracy_.impacts || stalls > kMostStalls;
    bool struck = false;
    look(sub, spent);
    if (!spent && strikes(sub)) {
      ++impacts_;
      struck = true;
      collide(start + now);
      look(sub, spent);
    }
    if (!spent) find_roles(sub, struck);
    make_rows(sub, false);
    const double part = longest(h - now);
    remember();
    start_poses_.clear();
    for (const NearPair* pair : pairs_) {
      start_poses_.push_back(pose_of(pair->a));
      start_poses_.push_back(pose_of(pair->b));
    }
    advance_once(start + now, part);
    Event event;
    if (!spent) event = seek(part);
    if (event.found()) {
      ++impacts_;
      locate(start + now, event, part);
      stalls = event.time > kSliver * h ? 0 : stalls + 1;
    }
    commit();
    account_rows();
    keep_springs();
    note_overlaps(part);
    note_forces(event.found() ? std::max(event.time, kSliver * h) : part);
    if (!event.found()) {
      keep_warm();
      push_apart(part);
      now += part;
      continue;
    }
    keep_warm();
    now += event.time;
    place();
    meet(client, event, start + now, h - now);
    if (unfinished_ > 0) return;
  }
  if (impacts_ > accuracy_.impacts && core_.settings.guard != GuardMode::Off)
    intervene({true, GuardReason::Impacts, static_cast<double>(impacts_), any_body()}, GuardAction::Reported,
              start + h);
}

void Island::place_links() {
  for (Tree* tree : trees_) articulated::forward_kinematics(tree->model, tree->data, tree->state);
}

}  // namespace breve
