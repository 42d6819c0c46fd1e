// Impacts of an island: which comes first in a sub-step and when, and what happens then.
#include <algorithm>
#include <cmath>

#include "runtime/dynamics/island.hpp"

namespace breve {

namespace {
constexpr double kSeen = 1e-6;  // rad, or of the radius: closer than that is not looked at where contacts act
}

/// The event that seems to come first; found_ has all, whose times are guesses.
Island::Event Island::seek(double time, double h) {
  constexpr std::uint64_t kUnits = 10;  // of work, a pair
  meter_.add(kUnits * pairs_.size());
  found_.clear();
  light_.clear();
  place_links();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (roles_[i] == Role::Rests || roles_[i] == Role::Springs) continue;
    ++result.counters.searches;
    const NearPair& pair = *pairs_[i];
    const Shape &a = *core_.bodies->collision_shape(pair.a), &b = *core_.bodies->collision_shape(pair.b);
    const Pose a1 = pose_of(pair.a), b1 = pose_of(pair.b);
    double moment = h;
    bool hit = false, apart = false;
    if (roles_[i] == Role::Far) {
      Contact contact;
      const Motion ma = chord(start_poses_[2 * i], a1, h), mb = chord(start_poses_[2 * i + 1], b1, h);
      apart = pair.cache.axis != Vector3::Zero() && stay_apart(a, ma, b, mb, h, pair.cache.axis);
      hit = !apart && time_of_impact(a, ma, b, mb, h, moment, contact);
    }
    if (!hit && !apart) {
      // It left and came back, or its path bends.
      Contact contact;
      hit = closest_within(a, a1, b, b1, -depths_[i], contact) && contact.distance < -depths_[i];
      moment = h;
    }
    Event light;
    if (hit)
      found_.push_back({moment, static_cast<int>(i), -1, -1, depths_[i]});
    else if (roles_[i] == Role::Far && touches_lightly(i, a1, b1, h, light))
      light_.push_back(light);
  }
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    const Bound& bound = bounds_[i];
    if (bound.rests || bound.held) continue;
    double rate = 0;
    Event event;
    event.bound = static_cast<int>(i);
    event.depth = std::max(-bound.gap, 0.0);
    const double gap = gap_of(event, rate);
    if (!(gap < -event.depth)) continue;
    const bool leaves = bound.gap <= met_limit() && bound.rate >= 0;  // and comes back
    event.time = leaves || bound.gap <= 0 ? h : h * bound.gap / (bound.gap - gap);
    found_.push_back(event);
  }
  seek_closing(h);
  const auto sooner = [](const Event& a, const Event& b) { return a.time < b.time; };
  const auto first = std::min_element(found_.begin(), found_.end(), sooner);
  Event event = first == found_.end() ? Event() : *first;
  if (!light_.empty()) check_light_touches(time, h, event);
  return event;
}

/// Whether two bodies may touch within a sub-step of h seconds and have parted again at its end, where they are at `a`
/// and `b`: the way bends toward the other body and back, as a ball's that just reaches a ceiling.
/// @param event  when they would meet, if both ways were parabolas
bool Island::touches_lightly(std::size_t index, const Pose& a, const Pose& b, double h, Event& event) const {
  const NearPair& pair = *pairs_[index];
  const Pose &from_a = start_poses_[2 * index], &from_b = start_poses_[2 * index + 1];
  const Vector3 after = point_velocity(pair.a, a.location) - point_velocity(pair.b, b.location);
  const Vector3 way = (a.location - from_a.location) - (b.location - from_b.location), before = 2 / h * way - after;
  // Half of the acceleration times the square of the time: the way lies that much off its chord, times s (1 - s).
  const Vector3 bend = h * after - way;
  const double size = size_of_pair(pair);
  if (!(bend.norm() > kMetSkin * size)) return false;
  const Vector3 axis = from_a.orientation * pair.cache.axis;
  if (axis != Vector3::Zero() && !(axis.dot(before) < 0 && axis.dot(after) > 0 && axis.dot(bend) > 0)) return false;
  const Shape &one = *core_.bodies->collision_shape(pair.a), &two = *core_.bodies->collision_shape(pair.b);
  Contact last;
  if (!closest_within(one, a, two, b, bend.norm(), last)) return false;
  const double bulge = last.normal.dot(bend), more = last.distance - closest(one, from_a, two, from_b).distance;
  if (!(std::abs(more) < bulge)) return false;
  // The gap after a part s of the sub-step is first + more s - bulge s (1 - s).
  const double first = last.distance - more, half = 0.5 * (bulge - more) / bulge, root = half * half - first / bulge;
  if (!(first > 0 && root > kMetSkin * size / bulge)) return false;
  event = {h * (half - std::sqrt(root)), static_cast<int>(index), -1, -1, depths_[index], h * half};
  return true;
}

/// Whether the first of the light touches, if it comes before `first`, is one: the island is moved to where it would be
/// deepest. Where none is, the island stands at the end of the sub-step again.
void Island::check_light_touches(double time, double h, Event& first) {
  std::sort(light_.begin(), light_.end(), [](const Event& x, const Event& y) { return x.time < y.time; });
  for (const Event& light : light_) {
    if (first.found() && first.time <= light.time) break;
    restore();
    advance_once(time, light.until);
    place_links();
    if (!is_past(light)) continue;
    found_.push_back(light);
    first = light;
    return;  // whoever finds its moment moves the island there
  }
  if (first.found()) return;
  restore();
  advance_once(time, h);
  place_links();
}

double Island::gap_of(const Event& event, double& rate) {
  if (event.point >= 0) return gap_of_point(event.point, rate);
  if (event.bound >= 0) {
    const Bound& bound = bounds_[static_cast<std::size_t>(event.bound)];
    const JointEntry& joint = core_.joints[bound.joint];
    rate = bound.sign * core_.read_velocity(joint)[bound.axis];
    return bound.sign * (core_.read_position(joint)[bound.axis] - bound.limit);
  }
  const NearPair& pair = *pairs_[static_cast<std::size_t>(event.pair)];
  const Shape &a = *core_.bodies->collision_shape(pair.a), &b = *core_.bodies->collision_shape(pair.b);
  const Contact contact = closest(a, pose_of(pair.a), b, pose_of(pair.b));
  rate = contact.normal.dot(point_velocity(pair.a, contact.point) - point_velocity(pair.b, contact.point));
  return contact.distance;
}

const NearPair& Island::pair_of(const Event& event) const {
  return *pairs_[event.point >= 0 ? pair_of_point(event.point) : static_cast<std::size_t>(event.pair)];
}

/// How far from zero the gap may be at the moment of an event, m or rad.
double Island::closeness(const Event& event) const {
  constexpr double kRoundOff = 1e-13;
  if (!coarse()) return kRoundOff;
  return event.bound >= 0 ? kSeen : kSeen * size_of_pair(pair_of(event));
}

/// How far from its limit a joint is taken to have met it, rad or m: as exactly as the moments of events are found.
double Island::met_limit() const {
  constexpr double kFound = 1e-12;
  return accuracy_.tolerance >= kCoarse ? kSeen : kFound;
}

namespace {

/// One look at an event: when, how wide the gap is then, and its rate.
struct Sight {
  double time, gap, rate;
};

/// When the gap of two sights is zero, by the cubic for the time through both and their rates.
double closed_between(const Sight& a, const Sight& b) {
  const double s = a.gap / (a.gap - b.gap), rest = 1 - s, size = b.gap - a.gap;
  return (1 + 2 * s) * rest * rest * a.time + s * s * (3 - 2 * s) * b.time +
         s * rest * size * (rest / a.rate - s / b.rate);
}

}  // namespace

void Island::refine(double time, Event& event, double h) {
  // Newton's method on the gap, then with a memory of one: between a time at which they are apart and one at which they
  // overlap.
  double low = 0, high = event.until > 0 ? std::min(event.until, h) : h;
  Sight now{event.time, 0, 0}, last{};
  const double close = closeness(event);
  constexpr int kMost = 30;
  for (int i = 0; i < kMost; ++i) {
    restore();
    advance_once(time, now.time);
    place_links();
    now.gap = gap_of(event, now.rate);
    now.gap += event.depth;
    (now.gap < 0 ? high : low) = now.time;
    // Bodies that are near but separating are about to come back.
    const bool close_by = now.rate <= 0 && std::abs(now.gap) <= close + 1e-15 * std::abs(now.time);
    const bool done = close_by || high - low <= 1e-13 * h;
    const bool remembers = i > 0 && now.rate < 0 && last.rate < 0 && now.gap != last.gap;
    double next = remembers ? closed_between(last, now) : now.rate < 0 ? now.time - now.gap / now.rate : low - 1;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (done || next == now.time || std::abs(next - now.time) <= 1e-12 * h) break;
    last = now;
    now.time = next;
  }
  event.time = now.time;
}

/// Finds the moment of the event that comes first: not always that which seemed to.
void Island::locate(double time, Event& event, double h) {
  refine(time, event, h);
  for (std::size_t left = found_.size(); left > 0; --left) {
    place_links();
    const auto earlier = [this, &event](const Event& other) {
      const bool same = other.pair == event.pair && other.bound == event.bound && other.point == event.point;
      return !same && is_past(other);
    };
    const auto other = std::find_if(found_.begin(), found_.end(), earlier);
    if (other == found_.end()) return;
    const double end = event.time;
    event = *other;
    event.time = end;
    refine(time, event, end);
  }
}

/// The gap was open when the sub-step began, and it is closed where the island stands.
bool Island::is_past(const Event& event) {
  double rate = 0;
  if (event.bound >= 0)
    return bounds_[static_cast<std::size_t>(event.bound)].gap > 0 && gap_of(event, rate) < -kMetSkin;
  return gap_of(event, rate) + event.depth < -kMetSkin * size_of_pair(pair_of(event));
}

Motion Island::chord(const Pose& from, const Pose& to, double h) {
  Motion motion;
  motion.start = from;
  motion.velocity = (to.location - from.location) / h;
  Quaternion rotation = to.orientation * from.orientation.conjugate();
  if (rotation.w() < 0) rotation.coeffs() = -rotation.coeffs();
  const double sine = rotation.vec().norm();
  if (sine > 0) motion.rotational_velocity_world = rotation.vec() * (2 * std::atan2(sine, rotation.w()) / (sine * h));
  return motion;
}

// --- what happens then -----------------------------------------------------------------------------------------------

/// The moment of an event has come: calls the handler first, then applies the impulses.
void Island::meet(MechanicsClient* client, const Event& event, double moment, double left) {
  ++result.counters.impacts;
  if (event.point >= 0) return;
  if (event.pair >= 0) {
    NearPair& pair = *pairs_[static_cast<std::size_t>(event.pair)];
    pair.touching = true;
    if (pair.handled && !pair.reported && client && client->locates() && !call(*client, event.pair, moment, left))
      return;
    double rate = 0;
    gap_of(event, rate);
    if (springs_for(pair.law) && rate > -std::max(pair.law.restitution_threshold, resting_)) return;
  } else {
    rebound(static_cast<std::size_t>(event.bound), moment);
  }
  collide(moment);
}

/// A joint that since it last came did not get further from its limit than what counts as resting there stays: so that
/// rebounds come to an end where other contacts press it on.
void Island::rebound(std::size_t index, double time) {
  const Bound& bound = bounds_[index];
  const JointEntry& joint = core_.joints[bound.joint];
  rows_.clear();
  touches_.clear();
  scalars_.clear();
  motors_.clear();
  loop_errors_.clear();
  numbers_.clear();
  numbers_.reserve(2 * static_cast<std::size_t>(core_.trees[joint.tree]->model.velocities()));
  add_bound_row(bound);
  const contact::ScalarRow& row = scalars_.front();
  Tree& tree = *core_.trees[joint.tree];
  const int n = tree.model.velocities();
  const Eigen::Map<const articulated::Vector> j(row.ja, n), r(row.ra, n);
  const double rate = j.dot(tree.state.v), yields = j.dot(r);
  if (!(rate < 0) || !(yields > 0)) return;
  Rebound& last = rebounds_[index];
  last.stays = 0.5 * last.rate * (time - last.time) <= kLimitSkin;
  const double e = last.stays ? 0 : joint.drive.limit_restitution;
  last.time = time;
  last.rate = -e * rate;
  tree.state.v -= ((1 + e) * rate / yields) * r;
  const double loss = 0.5 * (1 - e * e) * rate * rate / yields;
  result.ledger.limit_loss += loss;
  tree.ledger.limit_loss += loss;
}

void Island::collide(double time) {
  place();
  // Everything that touches now, whatever its speed.
  find_touches_now();
  find_bounds();
  const double met = met_limit();
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    Bound& bound = bounds_[i];
    bound.rests = bound.gap <= met;
    if (bound.rests && bound.rate < -resting_) rebound_later_.push_back(i);
  }
  for (const std::size_t bound : rebound_later_) rebound(bound, time);
  if (!rebound_later_.empty()) {
    rebound_later_.clear();
    find_touches_now();
    find_bounds();
    for (Bound& bound : bounds_) bound.rests = bound.gap <= met;
  }
  make_rows(Motors::Leave);
  load_velocities();
  read_rates();
  contact::ImpactSettings settings;
  settings.rest.iterations = std::max(50, accuracy_.iterations);
  settings.rest.direct = true;
  settings.rest.direct_share = direct_share();
  settings.rest.meter = &meter_;
  for (contact::Row& row : rows_) row.bias = 0, row.impulse = Vector3::Zero();
  for (contact::ScalarRow& row : scalars_) row.bias = 0, row.impulse = 0;
  contact::resolve_impacts(movers_, rows_, laws_, scalars_, settings, workspace_);
  book_rows();
  store_velocities(0);
  if (pushes_itself()) {
    note_wholes(&Tree::smooth_v, false);
    keep_wholes(0, Given::Impacts);
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (rows_[i].impulse == Vector3::Zero()) continue;
    const NearPair& pair = *pairs_[touches_[i].pair];
    result.impacts.push_back({core_.bodies->owner(pair.a), core_.bodies->owner(pair.b), time, touches_[i].point,
                              touches_[i].normal, rows_[i].axes.transpose() * rows_[i].impulse});
  }
}

}  // namespace breve
