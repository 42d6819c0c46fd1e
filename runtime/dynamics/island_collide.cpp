// What happens at the moment of an impact.
#include <algorithm>

#include "runtime/contact/impacts.hpp"
#include "runtime/dynamics/island_impacts.hpp"

namespace breve::island {

void Impacts::meet(MechanicsClient* client, const Event& event, double moment, double left) {
  ++state_.result.counters.impacts;
  if (event.point >= 0) return;
  if (event.pair >= 0) {
    NearPair& pair = *state_.pairs[static_cast<std::size_t>(event.pair)];
    pair.touching = true;
    const bool awaited = pair.handled && !pair.reported && client && client->locates();
    if (awaited && !handlers_.call(*client, pair, moment, left)) return;
    double rate = 0;
    gap_of(event, rate);
    if (state_.springs_for(pair.law) && rate > -std::max(pair.law.restitution_threshold, contacts_.resting())) return;
  } else {
    rebound(static_cast<std::size_t>(event.bound), moment);
  }
  collide(moment, event);
}

/// A joint that since it last came did not get further from its limit than what counts as resting there stays: so that
/// rebounds come to an end where other contacts press it on.
void Impacts::rebound(std::size_t index, double time) {
  contacts_.touches().clear();
  rows_.make_only(index);
  const auto& [bound, row] = rows_.limit(0);
  const JointEntry& joint = state_.core.joints[bound.joint];
  Tree& tree = *state_.core.trees[joint.tree];
  const int n = tree.model.velocities();
  const Eigen::Map<const articulated::Vector> j(row.ja, n), r(row.ra, n);
  const double rate = j.dot(tree.state.v), yields = j.dot(r);
  if (!(rate < 0) || !(yields > 0)) return;
  Rebound& last = contacts_.rebound_of(index);
  last.stays = 0.5 * last.rate * (time - last.time) <= kLimitSkin * bound.unit;
  const double e = last.stays ? 0 : joint.drive.limit_restitution;
  last.time = time;
  last.rate = -e * rate;
  tree.state.v -= ((1 + e) * rate / yields) * r;
  const double loss = 0.5 * (1 - e * e) * rate * rate / yields;
  state_.result.ledger.limit_loss += loss;
  tree.ledger.limit_loss += loss;
}

/// Contacts and limits that are met now. Limits that are struck rebound first, one after the other.
void Impacts::find_met(double time) {
  contacts_.find_touches_now();
  contacts_.find_bounds();
  const double met = contacts_.met_limit();
  for (std::size_t i = 0; i < contacts_.bounds().size(); ++i) {
    Bound& bound = contacts_.bounds()[i];
    bound.rests = bound.gap <= met * bound.unit;
    if (bound.rests && bound.rate < -contacts_.resting() * bound.unit / state_.unit()) rebound_later_.push_back(i);
  }
  if (rebound_later_.empty()) return;
  for (const std::size_t bound : rebound_later_) rebound(bound, time);
  rebound_later_.clear();
  contacts_.find_touches_now();
  contacts_.find_bounds();
  for (Bound& bound : contacts_.bounds()) bound.rests = bound.gap <= met * bound.unit;
}

/// A pair that since its last rebound did not get apart by more than the error of the moments of impacts stays, as a
/// joint does at its limit: what falls on by that much gains as much motion as a rebound loses. One that comes back
/// faster than by such a fall was struck meanwhile.
void Impacts::find_returned(double time) {
  constexpr double kMany = 10;  // times that error: what loses little of its speed also comes to rest
  constexpr double kFaster = 2;
  for (const Touch& touch : contacts_.touches()) {
    const NearPair& pair = contacts_.pair_of(touch);
    Rebound& last = contacts_.rebound_of(touch);
    const double past = time - last.time, error = contacts_.closeness(pair);
    if (!(0.5 * last.rate * past <= kMany * error)) continue;
    const Vector3 motion = state_.point_velocity(pair.a, touch.point) - state_.point_velocity(pair.b, touch.point);
    const double rate = touch.normal.dot(motion);
    // It left at last.rate, and fell by the error beyond where it was.
    if (rate < 0 && -rate * past <= kFaster * (last.rate * past + 2 * error)) last.stays = true;
  }
}

void Impacts::note_rebounds(double time) {
  for (std::size_t i = 0; i < rows_.contacts(); ++i) {
    const auto& [touch, pair, row, law] = rows_.contact(i);
    if (row.impulse == Vector3::Zero()) continue;
    Rebound& last = contacts_.rebound_of(touch);
    const double rate = std::max(0.0, rows_.rate_of(row, true)[0] - rows_.rate_of(row, false)[0]);
    last.rate = last.time == time ? std::max(last.rate, rate) : rate;
    last.time = time;
  }
}

/// A pair that does not collide although its event came at once stays for the rest of the step: as it is seen, it
/// approaches nowhere, and the same event would come again.
void Impacts::end_stall(const Event& met) {
  if (met.pair < 0 || !met.at_once) return;
  const auto pair = static_cast<std::uint32_t>(met.pair);
  for (std::size_t i = 0; i < rows_.contacts(); ++i)
    if (const auto& contact = rows_.contact(i); contact.touch.pair == pair && !contact.row.impulse.isZero(0)) return;
  contacts_.rebound_of_pair(pair).stays = true;
}

void Impacts::collide(double time, const Event& met) {
  state_.place();
  find_met(time);
  if (met.pair >= 0) contacts_.add_nearest(static_cast<std::size_t>(met.pair));
  find_returned(time);
  rows_.make(Rows::Motors::Leave);
  state_.load_velocities();
  rows_.read_rates();
  resolve();
  note_rebounds(time);
  end_stall(met);
  rows_.book();
  state_.store_velocities();
  if (momentum_.pushes_itself()) {
    momentum_.note(&Tree::smooth_v, false);
    momentum_.give_impacts();
  }
  const Bodies& bodies = *state_.core.bodies;
  for (std::size_t i = 0; i < rows_.contacts(); ++i) {
    const auto& [touch, pair, row, law] = rows_.contact(i);
    if (row.impulse == Vector3::Zero()) continue;
    state_.result.impacts.push_back({bodies.owner(pair.a), bodies.owner(pair.b), time, touch.point, touch.normal,
                                     row.axes.transpose() * row.impulse});
  }
}

void Impacts::resolve() {
  constexpr int kLeast = 50;  // sweeps
  contact::ImpactSettings settings;
  settings.tolerance *= state_.unit();
  settings.rest = state_.solve_settings();
  settings.rest.iterations = std::max(kLeast, settings.rest.iterations);
  settings.rest.direct = true;
  settings.rest.direct_share = solver_.direct_share();
  for (contact::Row& row : rows_.rows()) row.bias = 0, row.impulse = Vector3::Zero();
  for (contact::ScalarRow& row : rows_.scalars()) row.bias = 0, row.impulse = 0;
  const auto resolve_all = [&] {
    contact::resolve_impacts(rows_.movers(), rows_.rows(), rows_.laws(), rows_.scalars(), settings, rows_.workspace());
  };
  const double stopped = state_.drivers > 0 ? rows_.fastest() : 0;
  resolve_all();
  if (rows_.squeezed(stopped)) resolve_all();
}

}  // namespace breve::island
