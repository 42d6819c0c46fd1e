// The step of an island: smooth motion, impacts at their moments, contacts that last.
#include <algorithm>
#include <cmath>

#include "runtime/articulated/kinematics.hpp"
#include "runtime/base/rotation_vector.hpp"
#include "runtime/dynamics/island.hpp"
#include "runtime/dynamics/joint_frames.hpp"

namespace breve {

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
    find_bounds(part);
    for (Bound& bound : bounds_) bound.rests = bound.gap + part * std::min(0.0, 2 * bound.rate) <= kLimitSkin;
    make_rows(part, true);
    for (std::size_t k = 0, s = 0; k < bounds_.size(); ++k) {
      if (!bounds_[k].rests) continue;
      const double e = core_.joints[bounds_[k].joint].drive.limit_restitution;
      if (bounds_[k].rate < -quiet_) scalars_[s].bias = std::max(scalars_[s].bias, -e * bounds_[k].rate);
      ++s;
    }
    smooth(start + i * part, part);
    commit();
    load_velocities();
    solve(part);
    account_rows();
    store_velocities(part);
    push_apart(part);
    keep_warm();
  }
}

// --- impacts at their time
// ---------------------------------------------------------------------------------------------

void Island::advance_once(double time, double h) {
  smooth(time, h);
  load_velocities();
  set_biases(h);
  for (contact::Row& row : rows_) row.impulse = Vector3::Zero();
  for (contact::ScalarRow& row : scalars_) row.impulse = 0;
  if (rows_.empty() && !ring_errors_.empty()) return hold_rings(h);
  solve(h);
  // A force that is constant over the step moves by half of what its change of velocity would.
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

/// Rings alone: half of their impulse at the start closes them at the end, the other half, at the end, is found by
/// close_rings. So the rule is symmetric in time and keeps the energy. Source: Andersen 1983 (RATTLE).
void Island::hold_rings(double h) {
  place_links();
  std::size_t k = scalars_.size() - ring_errors_.size();
  for (const Treed& one : trees_) {
    for (const JointIndex index : one.tree->rings) {
      const RingRows ring = core_.ring_rows(*one.tree, core_.joints[index].is);
      for (int i = 0; i < ring.count; ++i, ++k) {
        contact::ScalarRow& row = scalars_[k];
        const int n = one.tree->model.velocities();
        const double rate = Eigen::Map<const articulated::Vector>(row.ja, n).dot(one.tree->state.v);
        row.bias = rate - ring.rows[static_cast<std::size_t>(i)].error / h;
      }
    }
  }
  solve(h);
  store_velocities(h);
}

bool Island::approaches() const {
  for (const Touch& touch : touches_)
    if (touch.gap <= kTouchSkin && touch.approach < -quiet_) return true;
  for (const Bound& bound : bounds_)
    if (bound.gap <= 0 && bound.rate < -quiet_) return true;
  return false;
}

void Island::step_located(DynamicsClient* client, double start, double h) {
  double now = 0;
  int impacts = 0;
  constexpr double kSliver = 1e-12;
  while (now < h * (1 - kSliver)) {
    place();
    find_touches(h, false);
    find_bounds(h);
    make_rows(h, false);
    if (approaches() && impacts <= accuracy_.impacts) {
      ++impacts;
      collide(start + now);
      place();
      find_touches(h, false);
      find_bounds(h);
      make_rows(h, false);
    }
    const double part = longest(h - now);
    remember();
    start_poses_.clear();
    for (const NearPair* pair : pairs_) {
      start_poses_.push_back(pose_of(pair->a));
      start_poses_.push_back(pose_of(pair->b));
    }
    advance_once(start + now, part);
    Event event;
    if (impacts <= accuracy_.impacts) event = seek(part);
    if (!event.found()) {
      commit();
      account_rows();
      push_apart(part);
      keep_warm();
      now += part;
      continue;
    }
    ++impacts;
    refine(start + now, event, part);
    commit();
    account_rows();
    keep_warm();
    now += event.time;
    ++result.counters.impacts;
    place();
    if (event.pair >= 0) {
      NearPair& pair = *pairs_[static_cast<std::size_t>(event.pair)];
      pair.touching = true;
      if (pair.handled && !pair.reported && client && client->locates() &&
          !call(*client, event.pair, start + now, h - now))
        return;
    } else {
      rebound(bounds_[static_cast<std::size_t>(event.bound)]);
    }
    hit_ = event.pair;
    collide(start + now);
    hit_ = -1;
  }
  if (impacts > accuracy_.impacts)
    result.interventions.push_back(
        {core_.iteration, start + h, {}, GuardReason::Impacts, GuardAction::Reported, static_cast<double>(impacts)});
}

Island::Event Island::seek(double h) {
  Event first;
  first.time = h;
  Event found;
  place_links();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (roles_[i] == Role::Rests) continue;
    ++result.counters.searches;
    const NearPair& pair = *pairs_[i];
    const Shape &a = *core_.bodies->collision_shape(pair.a), &b = *core_.bodies->collision_shape(pair.b);
    const Pose a1 = pose_of(pair.a), b1 = pose_of(pair.b);
    double time = h;
    bool hit = false;
    if (roles_[i] == Role::Far) {
      Contact contact;
      const Motion ma = chord(start_poses_[2 * i], a1, h), mb = chord(start_poses_[2 * i + 1], b1, h);
      hit = time_of_impact(a, ma, b, mb, h, time, contact);
    }
    if (!hit) {
      // It left and came back, or its path bends.
      hit = closest(a, a1, b, b1).distance < 0;
      time = h;
    }
    if (hit && (time < first.time || !found.found())) {
      found.pair = static_cast<int>(i);
      found.time = first.time = time;
    }
  }
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    if (bounds_[i].rests) continue;
    double rate = 0;
    Event event;
    event.bound = static_cast<int>(i);
    const double gap = gap_of(event, rate);
    if (!(gap < 0)) continue;
    const double start_gap = std::max(bounds_[i].gap, 0.0);
    event.time = start_gap > 0 ? h * start_gap / (start_gap - gap) : h;
    if (event.time <= first.time || !found.found()) {
      found = event;
      first.time = event.time;
    }
  }
  return found;
}

double Island::gap_of(const Event& event, double& rate) const {
  if (event.bound >= 0) {
    const Bound& bound = bounds_[static_cast<std::size_t>(event.bound)];
    const JointEntry& joint = core_.joints[bound.joint];
    const double limit = bound.sign > 0 ? joint.drive.low[bound.axis] : joint.drive.high[bound.axis];
    rate = bound.sign * core_.read_velocity(joint)[bound.axis];
    return bound.sign * (core_.read_position(joint)[bound.axis] - limit);
  }
  const NearPair& pair = *pairs_[static_cast<std::size_t>(event.pair)];
  const Shape &a = *core_.bodies->collision_shape(pair.a), &b = *core_.bodies->collision_shape(pair.b);
  const Contact contact = closest(a, pose_of(pair.a), b, pose_of(pair.b));
  rate = contact.normal.dot(point_velocity(pair.a, contact.point) - point_velocity(pair.b, contact.point));
  return contact.distance;
}

void Island::refine(double time, Event& event, double h) {
  // Newton's method on the gap, kept between a time at which they are apart and one at which they overlap.
  double low = 0, high = h, at = event.time;
  constexpr int kMost = 30;
  for (int i = 0; i < kMost; ++i) {
    restore();
    advance_once(time, at);
    place_links();
    double rate = 0;
    const double gap = gap_of(event, rate);
    (gap < 0 ? high : low) = at;
    const bool done = std::abs(gap) <= 1e-13 + 1e-15 * std::abs(at) || high - low <= 1e-13 * h;
    double next = rate < 0 ? at - gap / rate : 0.5 * (low + high);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (done || next == at || std::abs(next - at) <= 1e-12 * h) break;
    at = next;
  }
  event.time = at;
}

void Island::place_links() {
  for (const Treed& one : trees_) articulated::forward_kinematics(one.tree->model, one.tree->data, one.tree->state);
}

Motion Island::chord(const Pose& from, const Pose& to, double h) {
  Motion motion;
  motion.start = from;
  motion.velocity = (to.location - from.location) / h;
  Quaternion turn = to.orientation * from.orientation.conjugate();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();
  if (sine > 0) motion.rotational_velocity_world = turn.vec() * (2 * std::atan2(sine, turn.w()) / (sine * h));
  return motion;
}

void Island::rebound(const Bound& bound) {
  const JointEntry& joint = core_.joints[bound.joint];
  rows_.clear();
  touches_.clear();
  scalars_.clear();
  numbers_.clear();
  numbers_.reserve(2 * static_cast<std::size_t>(core_.trees[joint.tree]->model.velocities()));
  add_bound_row(bound);
  const contact::ScalarRow& row = scalars_.front();
  Tree& tree = *core_.trees[joint.tree];
  const int n = tree.model.velocities();
  const Eigen::Map<const articulated::Vector> j(row.ja, n), r(row.ra, n);
  const double rate = j.dot(tree.state.v), yields = j.dot(r);
  if (!(rate < 0) || !(yields > 0)) return;
  const double e = joint.drive.limit_restitution;
  tree.state.v -= ((1 + e) * rate / yields) * r;
  result.account.limit_loss += 0.5 * (1 - e * e) * rate * rate / yields;
}

void Island::collide(double time) {
  place();
  // Everything that touches now, whatever its speed.
  find_touches_now();
  find_bounds(0);
  for (Bound& bound : bounds_) {
    bound.rests = bound.gap <= 0 && bound.rate <= 0;
    if (bound.rests && bound.rate < -quiet_) rebound_later_.push_back(bound);
  }
  for (const Bound& bound : rebound_later_) rebound(bound);
  if (!rebound_later_.empty()) {
    rebound_later_.clear();
    find_touches_now();
    find_bounds(0);
    for (Bound& bound : bounds_) bound.rests = bound.gap <= 0 && bound.rate <= quiet_;
  }
  make_rows(1, false);
  if (rows_.empty()) return;
  contact::ImpactSettings settings;
  settings.rest.iterations = std::max(50, accuracy_.iterations);
  settings.rest.direct = accuracy_.direct && rows_.size() <= 100;
  for (contact::Row& row : rows_) row.bias = 0, row.impulse = Vector3::Zero();
  for (contact::ScalarRow& row : scalars_) row.bias = 0, row.impulse = 0;
  contact::resolve_impacts(movers_, rows_, laws_, scalars_, settings, workspace_);
  account_rows();
  store_velocities(0);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (rows_[i].impulse == Vector3::Zero()) continue;
    const NearPair& pair = *pairs_[touches_[i].pair];
    result.impacts.push_back({core_.bodies->owner(pair.a), core_.bodies->owner(pair.b), time, touches_[i].point,
                              touches_[i].normal, rows_[i].axes.transpose() * rows_[i].impulse});
  }
}

// --- overlap and open rings: positions alone are put right, nothing gets velocity
// ------------------------------------------

void Island::push_apart(double h) {
  constexpr double kShare = 0.2;      // of the overlap, in one sub-step
  constexpr double kFastestPush = 3;  // m/s, along which nothing is moved faster
  bool any = false;
  apart_.assign(rows_.begin(), rows_.end());
  for (std::size_t i = 0; i < apart_.size(); ++i) {
    const NearPair& pair = *pairs_[touches_[i].pair];
    const Shape &a = *core_.bodies->collision_shape(pair.a), &b = *core_.bodies->collision_shape(pair.b);
    const double slop = 0.1 * kSkin * std::min(a.bounding_radius(), b.bounding_radius());
    const double deep = -touches_[i].gap - slop;
    apart_[i].impulse = Vector3::Zero();
    apart_[i].static_friction = apart_[i].dynamic_friction = 0;
    // What is not too deep may come nearer by what room there is.
    apart_[i].bias = deep > 0 ? std::min(kShare * deep / h, kFastestPush) : std::min(0.0, -touches_[i].gap / h);
    any = any || deep > 0;
  }
  apart_scalars_.assign(scalars_.begin(), scalars_.end());
  std::size_t k = 0;
  for (const Bound& bound : bounds_) {
    if (!bound.rests) continue;
    apart_scalars_[k].bias = -kShare * std::min(bound.gap, 0.0) / h;
    any = any || bound.gap < -kLimitSkin;
    ++k;
  }
  for (; k < apart_scalars_.size(); ++k) apart_scalars_[k].bias = 0;
  for (contact::ScalarRow& row : apart_scalars_) row.impulse = 0;
  if (any) move_by_rows(apart_, apart_scalars_, h);
  close_rings();
}

void Island::move_by_rows(std::span<contact::Row> rows, std::span<contact::ScalarRow> scalars, double h) {
  // The rows' solution is taken as a velocity that lasts h and then is gone.
  for (Free& one : free_) std::fill(one.v, one.v + 6, 0.0);
  for (Treed& one : trees_) {
    one.free_v = one.tree->state.v;
    one.tree->state.v.setZero();
  }
  contact::SolveSettings settings;
  settings.iterations = accuracy_.iterations;
  settings.direct = rows.empty();
  if (settings.direct) settings.tolerance = 1e-14;  // a length here: rings are closed to round-off
  contact::solve_island(movers_, rows, scalars, settings, workspace_);
  for (Free& one : free_) {
    one.now.center += h * Vector3(one.v[0], one.v[1], one.v[2]);
    const Vector3 turn = h * Vector3(one.v[3], one.v[4], one.v[5]);
    if (turn != Vector3::Zero()) one.now.orientation = (rotation_by(turn) * one.now.orientation).normalized();
  }
  for (Treed& one : trees_) {
    one.way = h * one.tree->state.v;
    one.tree->state.v = one.free_v;
    articulated::move(one.tree->model, one.tree->state.q, one.way, one.tree->state.q);
  }
}

void Island::close_rings() {
  bool any = false;
  for (const Treed& one : trees_) any = any || !one.tree->rings.empty();
  if (!any) return;
  touches_.clear();
  bounds_.clear();
  constexpr int kMost = 4;  // Newton's method from a small error: two are enough but far from the solution
  constexpr double kClosed = 1e-13;
  for (int i = 0; i < kMost; ++i) {
    place();
    make_rows(1, false);
    double worst = 0;
    for (std::size_t k = 0; k < scalars_.size(); ++k) {
      scalars_[k].bias = -ring_errors_[k];
      worst = std::max(worst, std::abs(ring_errors_[k]));
    }
    if (worst < kClosed) break;
    move_by_rows({}, scalars_, 1);
  }
  // Velocities along the rings where they stand now.
  for (contact::ScalarRow& row : scalars_) row.bias = 0, row.impulse = 0;
  load_velocities();
  contact::SolveSettings settings;
  settings.direct = true;
  settings.iterations = accuracy_.iterations;
  contact::solve_island(movers_, {}, scalars_, settings, workspace_);
  store_velocities(0);
}

}  // namespace breve
