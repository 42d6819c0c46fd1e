// Impacts of an island: which comes first in a sub-step and when.
#include "runtime/dynamics/island_impacts.hpp"

#include <algorithm>
#include <cmath>

namespace breve::island {

namespace {

Motion chord(const Pose& from, const Pose& to, double h) {
  Motion motion;
  motion.start = from;
  motion.velocity = (to.location - from.location) / h;
  Quaternion rotation = to.orientation * from.orientation.conjugate();
  if (rotation.w() < 0) rotation.coeffs() = -rotation.coeffs();
  const double sine = rotation.vec().norm();
  if (sine > 0) motion.rotational_velocity_world = rotation.vec() * (2 * std::atan2(sine, rotation.w()) / (sine * h));
  return motion;
}

}  // namespace

Impacts::Impacts(State& state, Contacts& contacts, ContactSprings& springs, Rows& rows, Solver& solver,
                 Momentum& momentum, SubStep& sub_step, Handlers& handlers)
    : state_(state),
      contacts_(contacts),
      springs_(springs),
      rows_(rows),
      solver_(solver),
      momentum_(momentum),
      sub_step_(sub_step),
      handlers_(handlers),
      start_poses_(state.memory),
      found_(state.memory),
      light_(state.memory),
      rebound_later_(state.memory) {}

void Impacts::note_start() {
  start_poses_.clear();
  for (const NearPair* pair : state_.pairs) start_poses_.push_back({state_.pose_of(pair->a), state_.pose_of(pair->b)});
}

/// All events are in found_ then, with times that are guesses.
Event Impacts::seek(double time, double h) {
  constexpr std::uint64_t kUnits = 10;  // of work, a pair
  state_.meter.add(kUnits * state_.pairs.size());
  found_.clear();
  light_.clear();
  state_.place_links();
  seek_pairs(h);
  seek_bounds(h);
  seek_closing(h);
  const auto sooner = [](const Event& a, const Event& b) { return a.time < b.time; };
  const auto first = std::min_element(found_.begin(), found_.end(), sooner);
  Event event = first == found_.end() ? Event() : *first;
  if (!light_.empty()) check_light_touches(time, h, event);
  return event;
}

void Impacts::seek_pairs(double h) {
  for (std::size_t i = 0; i < state_.pairs.size(); ++i) {
    const Role role = contacts_.role(i);
    if (role == Role::Rests || role == Role::Springs) continue;
    ++state_.result.counters.searches;
    const NearPair& pair = *state_.pairs[i];
    const Shape &a = state_.shape(pair.a), &b = state_.shape(pair.b);
    const Pose a1 = state_.pose_of(pair.a), b1 = state_.pose_of(pair.b);
    double depth = contacts_.depth(i), moment = h;
    bool hit = false, apart = false;
    if (role == Role::Far) {
      Contact contact;
      const Motion ma = chord(start_poses_[i].a, a1, h), mb = chord(start_poses_[i].b, b1, h);
      apart = pair.cache.axis != Vector3::Zero() && stay_apart(a, ma, b, mb, h, pair.cache.axis);
      hit = !apart && time_of_impact(a, ma, b, mb, h, moment, contact);
    }
    if (!hit && !apart) {
      // It left and came back, or its path bends.
      Contact contact;
      const auto deeper = [&] { return contact.distance < -depth; };
      hit = closest_within(a, a1, b, b1, -depth, contact) && deeper();
      moment = h;
      if (hit) {
        // Contact points of round solids and facets are not always as deep as the nearest points.
        depth = std::max(depth, -closest(a, start_poses_[i].a, b, start_poses_[i].b).distance);
        hit = deeper();
      }
    }
    Event light;
    if (hit)
      found_.push_back({moment, static_cast<int>(i), -1, -1, depth});
    else if (role == Role::Far && touches_lightly(i, a1, b1, h, light))
      light_.push_back(light);
  }
}

void Impacts::seek_bounds(double h) {
  for (std::size_t i = 0; i < contacts_.bounds().size(); ++i) {
    const Bound& bound = contacts_.bounds()[i];
    if (bound.rests || bound.held) continue;
    double rate = 0;
    Event event;
    event.bound = static_cast<int>(i);
    event.depth = std::max(-bound.gap, 0.0);
    const double gap = gap_of(event, rate);
    if (!(gap < -event.depth)) continue;
    const bool leaves = bound.gap <= contacts_.met_limit() * bound.unit && bound.rate >= 0;  // and comes back
    event.time = leaves || bound.gap <= 0 ? h : h * bound.gap / (bound.gap - gap);
    found_.push_back(event);
  }
}

/// Points of springs that closed in the sub-step: they are to push from that moment on.
void Impacts::seek_closing(double h) {
  for (std::size_t i = 0; i < springs_.points(); ++i) {
    Event event;
    if (!springs_.closes(i, h, event.time)) continue;
    event.point = static_cast<int>(i);
    found_.push_back(event);
  }
}

/// Whether two bodies may touch within a sub-step of h seconds and have parted again at its end, where they are at `a`
/// and `b`: the path bends toward the other body and back, as a ball's that just reaches a ceiling.
/// @param event  when they would meet, if both paths were parabolas
bool Impacts::touches_lightly(std::size_t index, const Pose& a, const Pose& b, double h, Event& event) const {
  const NearPair& pair = *state_.pairs[index];
  const auto& [from_a, from_b] = start_poses_[index];
  const Vector3 after = state_.point_velocity(pair.a, a.location) - state_.point_velocity(pair.b, b.location);
  const Vector3 way = (a.location - from_a.location) - (b.location - from_b.location), before = 2 / h * way - after;
  // Half of the acceleration times the square of the time: the path lies that much off its chord, times s (1 - s).
  const Vector3 bend = h * after - way;
  const double size = state_.size_of_pair(pair);
  if (!(bend.norm() > kMetSkin * size)) return false;
  const Vector3 axis = from_a.orientation * pair.cache.axis;
  if (axis != Vector3::Zero() && !(axis.dot(before) < 0 && axis.dot(after) > 0 && axis.dot(bend) > 0)) return false;
  const Shape &one = state_.shape(pair.a), &two = state_.shape(pair.b);
  Contact last;
  if (!closest_within(one, a, two, b, bend.norm(), last)) return false;
  const double bulge = last.normal.dot(bend), more = last.distance - closest(one, from_a, two, from_b).distance;
  if (!(std::abs(more) < bulge)) return false;
  // The gap after a part s of the sub-step is first + more s - bulge s (1 - s).
  const double first = last.distance - more, half = 0.5 * (bulge - more) / bulge, root = half * half - first / bulge;
  if (!(first > 0 && root > kMetSkin * size / bulge)) return false;
  event = {h * (half - std::sqrt(root)), static_cast<int>(index), -1, -1, contacts_.depth(index), h * half};
  return true;
}

/// Whether the first of the light touches, if it comes before `first`, is one: the island is moved to where it would be
/// deepest. Where none is, the island stands at the end of the sub-step again.
void Impacts::check_light_touches(double time, double h, Event& first) {
  std::sort(light_.begin(), light_.end(), [](const Event& x, const Event& y) { return x.time < y.time; });
  for (const Event& light : light_) {
    if (first.found() && first.time <= light.time) break;
    state_.restore();
    sub_step_.advance(time, light.until);
    state_.place_links();
    if (!is_past(light)) continue;
    found_.push_back(light);
    first = light;
    return;  // whoever finds its moment moves the island there
  }
  if (first.found()) return;
  state_.restore();
  sub_step_.advance(time, h);
  state_.place_links();
}

double Impacts::gap_of(const Event& event, double& rate) {
  if (event.point >= 0) return springs_.gap_of(static_cast<std::size_t>(event.point), rate);
  if (const Bound* bound = bound_of(event)) {
    const JointEntry& joint = state_.core.joints[bound->joint];
    rate = bound->sign * state_.core.read_velocity(joint)[bound->axis];
    return bound->sign * (state_.core.read_position(joint)[bound->axis] - bound->limit);
  }
  const NearPair& pair = *state_.pairs[static_cast<std::size_t>(event.pair)];
  const Shape &a = state_.shape(pair.a), &b = state_.shape(pair.b);
  const Contact contact = closest(a, state_.pose_of(pair.a), b, state_.pose_of(pair.b));
  rate =
      contact.normal.dot(state_.point_velocity(pair.a, contact.point) - state_.point_velocity(pair.b, contact.point));
  return contact.distance;
}

const Bound* Impacts::bound_of(const Event& event) const {
  return event.bound >= 0 ? &contacts_.bounds()[static_cast<std::size_t>(event.bound)] : nullptr;
}

const NearPair& Impacts::pair_of(const Event& event) const {
  if (event.point >= 0) return *state_.pairs[springs_.pair_of(static_cast<std::size_t>(event.point))];
  return *state_.pairs[static_cast<std::size_t>(event.pair)];
}

/// How far from zero the gap may be at the moment of an event, m or rad.
double Impacts::closeness(const Event& event) const {
  const Bound* bound = bound_of(event);
  return bound ? contacts_.closeness() * bound->unit : contacts_.closeness(pair_of(event));
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

void Impacts::refine(double time, Event& event, double h) {
  // Newton's method on the gap, then with a memory of one: between a time at which they are apart and one at which they
  // overlap.
  double low = 0, high = event.until > 0 ? std::min(event.until, h) : h;
  Sight now{event.time, 0, 0}, last{};
  const double close = closeness(event);
  constexpr int kMost = 30;
  constexpr std::uint64_t kDear = 200'000;  // units of work: where bodies jam, each look may take a thousand sweeps
  const std::uint64_t enough = state_.meter.done() + kDear;
  for (int i = 0;; ++i) {
    state_.restore();
    sub_step_.advance(time, now.time);
    state_.place_links();
    now.gap = gap_of(event, now.rate);
    now.gap += event.depth;
    (now.gap < 0 ? high : low) = now.time;
    // Bodies that are near but separating are about to come back.
    const bool close_by = now.rate <= 0 && std::abs(now.gap) <= close + 1e-15 * std::abs(now.time);
    const bool done = close_by || high - low <= 1e-13 * h || i + 1 == kMost || state_.meter.done() > enough;
    const bool remembers = i > 0 && now.rate < 0 && last.rate < 0 && now.gap != last.gap;
    double next = remembers ? closed_between(last, now) : now.rate < 0 ? now.time - now.gap / now.rate : low - 1;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (done || next == now.time || std::abs(next - now.time) <= 1e-12 * h) break;
    last = now;
    now.time = next;
  }
  event.time = now.time;
  event.at_once = low == 0;
}

void Impacts::locate(double time, Event& event, double h) {
  refine(time, event, h);
  for (std::size_t left = found_.size(); left > 0; --left) {
    state_.place_links();
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

/// The gap is closed where the island stands, or it is deeper than when the sub-step began.
bool Impacts::is_past(const Event& event) {
  double rate = 0;
  const Bound* bound = bound_of(event);
  return gap_of(event, rate) + event.depth < -kMetSkin * (bound ? bound->unit : state_.size_of_pair(pair_of(event)));
}

}  // namespace breve::island
