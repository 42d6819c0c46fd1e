// What one look at the pairs of an island finds.
#include "runtime/dynamics/island_contacts.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/dynamics/corners.hpp"
#include "runtime/dynamics/joint_reader.hpp"

namespace breve::island {

Contacts::Contacts(State& state)
    : state_(state),
      touches_(state.memory),
      bounds_(state.memory),
      rebounds_(state.memory),
      pair_rebounds_(state.memory),
      roles_(state.memory),
      depths_(state.memory),
      manifolds_(state.memory),
      seen_(state.memory) {}

void Contacts::begin(bool awaited) {
  awaited_ = awaited;
  clear();
  forget_rebounds();
  spent_ = false;
}

void Contacts::forget_rebounds() {
  rebounds_.clear();
  pair_rebounds_.assign(state_.pairs.size(), Rebound());
}

void Contacts::clear() {
  touches_.clear();
  bounds_.clear();
}

namespace {

constexpr double kRotationRoom = 0.02;  // of the radius, which rotation may bring nearer in a sub-step
constexpr double kMissed = 0.005;       // of the size: an overlap that is seen only after the sub-step that made it
constexpr double kCoarse = 1e-3;        // tolerances of step control from which contacts are seen less exactly

Touch touch_at(std::size_t pair, const Pose& a, const Pose& b, const Manifold& manifold, const ContactPoint& point) {
  Touch touch;
  touch.pair = static_cast<std::uint32_t>(pair);
  touch.feature = point.feature;
  touch.point = touch.start = 0.5 * (point.on_a + point.on_b);
  touch.from_a = a;
  touch.from_b = b;
  touch.normal = manifold.normal;
  touch.gap = point.distance;
  return touch;
}

}  // namespace

/// A blow did not act along the way. What rests is not to be disturbed; and on rungs that take rises of energy back
/// from motion anyway, no more than what is much faster than rest.
double Contacts::unseen_spin(const Free& one) const {
  constexpr double kCoarse = 8;
  if (one.struck) return JointDrive::kNoLimit;
  const bool coarse = state_.accuracy.rung == Rung::Fast || state_.accuracy.rung == Rung::Balanced;
  return (coarse ? kCoarse : 1) * resting_ / state_.shape(one.body).bounding_radius();
}

void Contacts::find_touches(double h, bool speculative) {
  spent_ = speculative;
  touches_.clear();
  NarrowCounters narrow;
  narrow.stop = state_.meter.end();
  const double fall = state_.core.settings.gravity.norm() * h;
  resting_ = 1e-3 * fall + 1e-12 * state_.unit();
  looked_h_ = h;
  note_seen(speculative);
  // A row catches a body before it touches, if it comes as slowly as a body at rest falls in a sub-step.
  constexpr double kMostRoom = 0.05;  // of the size
  constexpr double kDeep = 0.05;      // likewise, of an overlap that takes long to find
  constexpr double kHastens = 1.5;    // of its speed, within a sub-step, of a point that comes nearer by rotation
  constexpr std::uint64_t kOfDeepCorner = 10;  // units; of others one
  std::uint64_t corners = 0;                   // units
  for (std::size_t i = 0; i < state_.pairs.size(); ++i) {
    NearPair& pair = *state_.pairs[i];
    const Shape &a = state_.shape(pair.a), &b = state_.shape(pair.b);
    const Pose pa = state_.pose_of(pair.a), pb = state_.pose_of(pair.b);
    const double size = state_.size_of_pair(pair);
    const double near = std::max(kSkin * size, std::min(2 * fall * h, kMostRoom * size));
    // What rotates comes down on points that lie farther off.
    const double swing = h * (state_.spin_of(pair.a) - state_.spin_of(pair.b)).norm() * size;
    double sure = near;  // what is no farther off is seen, however it moves
    double margin = near + 2 * swing;
    if (speculative) {
      const Vector3 rate = state_.point_velocity(pair.a, pa.location) - state_.point_velocity(pair.b, pb.location);
      const double way = h * (rate.norm() + fall);
      sure += way + kRotationRoom * size;
      margin = std::max(sure, near + way + swing);
    }
    manifolds_.clear();
    if (narrow.stopped()) break;
    find_manifolds(a, pa, b, pb, margin, manifolds_, pair.cache, narrow);
    if (!manifolds_.empty()) {
      const bool deep = manifolds_.front().points[0].distance < -kDeep * size;
      corners += (deep ? kOfDeepCorner : 1) * many_corners(a, b);
    }
    for (const Manifold& manifold : manifolds_) {
      ++state_.result.counters.manifolds;
      for (int k = 0; k < manifold.count; ++k) {
        const ContactPoint& point = manifold.points[static_cast<std::size_t>(k)];
        Touch touch = touch_at(i, pa, pb, manifold, point);
        touch.velocity_a = state_.point_velocity(pair.a, touch.point);
        touch.velocity_b = state_.point_velocity(pair.b, touch.point);
        const bool beyond = touch.gap > sure;
        if (beyond || !speculative) touch.approach = manifold.normal.dot(touch.velocity_a - touch.velocity_b);
        if (beyond && touch.gap + kHastens * h * touch.approach > near) continue;
        touch.far = beyond && !speculative;
        touches_.push_back(touch);
      }
    }
  }
  state_.result.counters.pairs += narrow.pairs;
  constexpr std::uint64_t kUnits = 10;  // of work, a pair
  state_.meter.add(kUnits * (state_.pairs.size() + narrow.pairs) + corners + narrow.facets + narrow.boxes +
                   touches_.size());
}

/// How the bodies of each pair move, for find_missed(). One without joints that is struck is not thrown down elsewhere
/// as hard, and what overlaps then is pushed apart freely.
void Contacts::note_seen(bool speculative) {
  seen_.clear();
  if (!speculative || state_.trees.empty()) return;
  for (const NearPair* pair : state_.pairs) seen_.push_back({seen(pair->a), seen(pair->b)});
}

Contacts::Seen Contacts::seen(BodyIndex body) const {
  const Pose pose = state_.pose_of(body);
  return {pose, state_.point_velocity(body, pose.location), state_.spin_of(body)};
}

/// The pair moves otherwise than it did, by more than a speculative look leaves room for in h seconds.
bool Contacts::deflected(const std::array<Seen, 2>& before, const NearPair& pair, double h) const {
  const Seen a = seen(pair.a), b = seen(pair.b);
  const double size = state_.size_of_pair(pair);
  const Vector3 velocity = a.velocity - b.velocity - (before[0].velocity - before[1].velocity);
  const Vector3 spin = a.spin - b.spin - (before[0].spin - before[1].spin);
  return h * (velocity.norm() + size * spin.norm()) > kRotationRoom * size;
}

bool Contacts::find_missed(double h) {
  NarrowCounters narrow;
  narrow.stop = state_.meter.end();
  bool any = false;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    const NearPair& pair = *state_.pairs[i];
    // What a script or the host moves is put where it will be only when the step is over.
    const bool left = pair.spring.stiffness > 0 || state_.pair_drivers[i] >= 0;
    if (left || !deflected(seen_[i], pair, h)) continue;
    PairCache cache = pair.cache;  // the next look is to begin as the last one did
    manifolds_.clear();
    find_manifolds(state_.shape(pair.a), state_.pose_of(pair.a), state_.shape(pair.b), state_.pose_of(pair.b), 0,
                   manifolds_, cache, narrow);
    for (const Manifold& manifold : manifolds_)
      for (int k = 0; k < manifold.count; ++k)
        any = add_missed(i, manifold, manifold.points[static_cast<std::size_t>(k)]) || any;
  }
  state_.result.counters.pairs += narrow.pairs;
  state_.meter.add(narrow.facets + narrow.boxes);
  return any;
}

/// The end of the touches of a pair.
std::pmr::vector<Touch>::const_iterator Contacts::end_of(std::size_t pair) const {
  return std::upper_bound(touches_.begin(), touches_.end(), pair,
                          [](std::size_t index, const Touch& touch) { return index < touch.pair; });
}

/// Where the sub-step began. What overlapped then was seen, or is pushed apart.
bool Contacts::add_missed(std::size_t pair, const Manifold& manifold, const ContactPoint& point) {
  const NearPair& is = *state_.pairs[pair];
  const double least = kMissed * state_.size_of_pair(is);
  if (point.distance > -least) return false;
  const auto after = end_of(pair);
  for (auto other = after; other != touches_.begin() && std::prev(other)->pair == pair; --other)
    if (std::prev(other)->feature == point.feature) return false;
  const auto& [a, b] = seen_[pair];
  ContactPoint before = point;
  before.on_a = carried_by(state_.shape(is.a), point.on_a, manifold.normal, state_.pose_of(is.a), a.pose);
  before.on_b = carried_by(state_.shape(is.b), point.on_b, manifold.normal, state_.pose_of(is.b), b.pose);
  before.distance = manifold.normal.dot(before.on_a - before.on_b);
  if (before.distance < -least) return false;
  Touch touch = touch_at(pair, a.pose, b.pose, manifold, before);
  touch.velocity_a = a.velocity_at(touch.point);
  touch.velocity_b = b.velocity_at(touch.point);
  touch.approach = manifold.normal.dot(touch.velocity_a - touch.velocity_b);
  touches_.insert(after, touch);
  return true;
}

Contacts::Speeds Contacts::speeds_of(const contact::Law& law, double size, double h) const {
  const double fall = state_.core.settings.gravity.norm() * h;
  if (law.restitution > 0) {
    const double slow = std::max(law.restitution_threshold, resting_);
    return {slow, slow};
  }
  // Nothing rebounds: a row stops it as well, but for the depth that it would reach until then.
  return {JointDrive::kNoLimit, std::max(2 * fall, kSkin * size / h) + resting_};
}

bool Contacts::strikes(double h) const {
  for (const Touch& touch : touches_) {
    const NearPair& pair = pair_of(touch);
    const double size = state_.size_of_pair(pair);
    if (touch.gap <= kMetSkin * size && touch.approach < -speeds_of(pair.law, size, h).strike) return true;
  }
  for (const Bound& bound : bounds_)
    if (!bound.held && bound.gap <= met_limit() * bound.unit && bound.rate < -bound.slow) return true;
  return false;
}

void Contacts::find_roles(double h, bool struck) {
  roles_.assign(state_.pairs.size(), Role::Far);
  for (std::size_t i = 0; i < state_.pairs.size(); ++i)
    if (state_.pairs[i]->spring.stiffness > 0) roles_[i] = Role::Springs;
  depths_.assign(state_.pairs.size(), 0.0);
  for (const Touch& touch : touches_) {
    const NearPair& pair = pair_of(touch);
    const double size = state_.size_of_pair(pair);
    const bool touching = touch.gap <= kTouchSkin * size;
    // It becomes a spring when it meets: that moment is looked for.
    const bool springs = state_.springs_for(pair.law) && touch.gap >= -kTouchSkin * size;
    const Speeds speeds = speeds_of(pair.law, size, h);
    Role& role = roles_[touch.pair];
    if (touch.far) continue;
    depths_[touch.pair] = std::max(depths_[touch.pair], -touch.gap);
    // A first touch that a handler waits for is met, however slow.
    if (awaited_ && pair.handled && !pair.touching && touch.gap > kMetSkin * size && touch.approach < 0) continue;
    const bool slow = std::abs(touch.approach) <= speeds.slow || (touching && rebound_of(touch).stays);
    if (!springs && (slow || (struck && touching && touch.approach < 0)))
      role = Role::Rests;
    else if (touching && touch.approach > 0 && role == Role::Far)
      role = Role::Leaves;
  }
  std::erase_if(touches_, [this](const Touch& touch) { return roles_[touch.pair] != Role::Rests; });
}

void Contacts::find_touches_now() {
  touches_.clear();
  NarrowCounters narrow;
  narrow.stop = state_.meter.end();
  for (std::size_t i = 0; i < state_.pairs.size(); ++i) {
    NearPair& pair = *state_.pairs[i];
    if (pair.spring.stiffness > 0) continue;  // it gives way to what is sudden
    const Shape &a = state_.shape(pair.a), &b = state_.shape(pair.b);
    const Pose pa = state_.pose_of(pair.a), pb = state_.pose_of(pair.b);
    const double size = state_.size_of_pair(pair);
    manifolds_.clear();
    find_manifolds(a, pa, b, pb, kTouchSkin * size, manifolds_, pair.cache, narrow);
    for (const Manifold& manifold : manifolds_)
      for (int k = 0; k < manifold.count; ++k) {
        const ContactPoint& point = manifold.points[static_cast<std::size_t>(k)];
        if (point.distance > kTouchSkin * size) continue;
        touches_.push_back(touch_at(i, pa, pb, manifold, point));
      }
  }
}

void Contacts::add_nearest(std::size_t pair) {
  const NearPair& is = *state_.pairs[pair];
  if (is.spring.stiffness > 0) return;
  const auto approaches = [&](const Vector3& normal, const Vector3& point) {
    return normal.dot(state_.point_velocity(is.a, point) - state_.point_velocity(is.b, point)) < 0;
  };
  const auto after = end_of(pair);
  for (auto other = after; other != touches_.begin() && std::prev(other)->pair == pair; --other)
    if (approaches(std::prev(other)->normal, std::prev(other)->point)) return;
  const Pose a = state_.pose_of(is.a), b = state_.pose_of(is.b);
  const Contact nearest = closest(state_.shape(is.a), a, state_.shape(is.b), b);
  if (!approaches(nearest.normal, nearest.point)) return;
  Manifold manifold;
  manifold.normal = nearest.normal;
  ContactPoint point;
  point.on_a = point.on_b = nearest.point;
  point.distance = nearest.distance;
  touches_.insert(after, touch_at(pair, a, b, manifold, point));
}

/// How fast what rests falls in a sub-step, as the rate of a joint: twice that of a free link's rim, m/s or rad/s.
double Contacts::falling(const JointEntry& joint) const {
  const double fall = 2 * state_.core.settings.gravity.norm() * looked_h_;
  if (joint.is.kind == JointKind::Prismatic) return fall;
  return fall / state_.shape(joint.is.child).bounding_radius();
}

void Contacts::find_bounds() {
  constexpr double kMostRoom = 1e-3;  // rad or length units
  bounds_.clear();
  for (Tree* tree : state_.trees) {
    for (const TreeLink& link : tree->links) {
      if (link.joint == kNoJoint) continue;
      const JointEntry& joint = state_.core.joints[link.joint];
      if (!Dynamics::Core::has_limits(joint)) continue;
      const JointVector position = state_.core.read_position(joint), velocity = state_.core.read_velocity(joint);
      const double unit = joint.is.kind == JointKind::Prismatic ? state_.unit() : 1;
      const double slow = resting_ * unit / state_.unit();
      for (int k = 0; k < axis_count(joint.is.kind); ++k) {
        for (const double sign : {1.0, -1.0}) {
          const double limit = sign > 0 ? joint.drive.low[k] : joint.drive.high[k];
          if (!std::isfinite(limit)) continue;
          Bound bound{link.joint, k, sign, limit, sign * (position[k] - limit), sign * velocity[k], unit, slow, false};
          const bool stays = bounds_.size() < rebounds_.size() && rebounds_[bounds_.size()].stays;
          // Inelastic limits may be met by a row; others are located. A row catches a joint before it is there, if it
          // comes as slowly as a body at rest falls in a sub-step and is not driven.
          if (joint.drive.limit_restitution > 0) {
            bound.rests = bound.gap <= kLimitSkin * unit && (stays || std::abs(bound.rate) <= slow);
          } else {
            if (!link.motor) bound.slow += falling(joint);
            const bool caught = bound.gap <= std::min(bound.slow * looked_h_, kMostRoom * unit);
            bound.rests = bound.gap <= kLimitSkin * unit || (caught && std::abs(bound.rate) <= bound.slow);
          }
          bounds_.push_back(bound);
        }
      }
    }
  }
  rebounds_.resize(bounds_.size());
}

bool Contacts::find_passed(double far) {
  bool any = false;
  JointReader joints(state_.core);
  for (Bound& bound : bounds_) {
    if (bound.rests || bound.held) continue;
    const double gap = bound.sign * (joints.position(bound.joint)[bound.axis] - bound.limit);
    bound.rests = gap < std::min(bound.gap, 0.0) - far * bound.unit;
    any = any || bound.rests;
  }
  return any;
}

/// How far from its limit a joint is taken to have met it, rad or length units: as exactly as the moments of events are
/// found.
double Contacts::met_limit() const {
  constexpr double kFound = 1e-12;
  return state_.accuracy.tolerance >= kCoarse ? kSeen : kFound;
}

bool Contacts::any() const {
  const auto driven = [](const Tree* tree) {
    return std::any_of(tree->links.begin(), tree->links.end(), [](const TreeLink& link) { return link.motor; });
  };
  return !touches_.empty() || std::any_of(state_.trees.begin(), state_.trees.end(), driven) ||
         std::any_of(bounds_.begin(), bounds_.end(), [](const Bound& bound) { return bound.rests; });
}

bool Contacts::coarse() const { return any() && state_.accuracy.tolerance >= kCoarse; }

const WarmPoint* Contacts::warm_of(const Touch& touch) const {
  const NearPair& pair = pair_of(touch);
  for (int k = 0; k < pair.warm_count; ++k) {
    const WarmPoint& warm = pair.warm[static_cast<std::size_t>(k)];
    if (warm.feature == touch.feature) return &warm;
  }
  return nullptr;
}

}  // namespace breve::island
