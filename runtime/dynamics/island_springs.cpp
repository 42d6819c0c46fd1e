// Contacts that are springs: when they become so, and what they remember.
#include "runtime/dynamics/island_springs.hpp"

#include <algorithm>

#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/contact/impact_law.hpp"
#include "runtime/dynamics/sprung_motion.hpp"

namespace breve::island {

namespace {

// Parts of the smaller body's radius: deeper than the first a spring hardens, so that it carries what lies on it;
// deeper than the second it is too weak all the same, and the surfaces become rigid.
constexpr double kLinear = 5e-3, kDeepest = 0.1;

bool sprung(const NearPair& pair) { return pair.spring.stiffness > 0; }

/// The reduced mass of two masses; 0 stands for the mass of something that does not move.
double reduced(double a, double b) { return a > 0 && b > 0 ? a * b / (a + b) : std::max(a, b); }

}  // namespace

ContactSprings::ContactSprings(State& state, Contacts& contacts)
    : state_(state), contacts_(contacts), followed_(state.memory) {}

ContactSprings::~ContactSprings() = default;

void ContactSprings::clear() {
  if (motion_) motion_->points.clear();
}

/// What an impulse along `normal` has to move there, kg.
double ContactSprings::effective_mass(const NearPair& pair, const Vector3& point, const Vector3& normal) const {
  const BodySlot a = state_.slot_of(pair.a), b = state_.slot_of(pair.b);
  double yields = 0;
  const auto of_tree = [&](Tree& tree, int first, int second) {
    const articulated::Symmetric3 w = articulated::collision_matrix(tree.model, tree.data, first, point, second, point);
    yields += normal.dot(w * normal);
  };
  if (a.tree && a.tree == b.tree) {
    of_tree(*a.tree, a.link, b.link);
    return yields > 0 ? 1 / yields : 0;
  }
  for (const BodySlot& side : {a, b}) {
    if (side.mover < 0) continue;
    if (side.tree) {
      of_tree(*side.tree, -1, side.link);
      continue;
    }
    const Vector3 arm = state_.arm_of(side, point).cross(normal);
    const FreeBody& free = state_.free_bodies[static_cast<std::size_t>(side.mover)].now;
    yields += 1 / free.solid->mass + arm.dot(Eigen::Matrix3d(free.inertia()).inverse() * arm);
  }
  return yields > 0 ? 1 / yields : 0;
}

/// Surfaces that touch become springs. Their stiffness goes with the whole mass on either side, so that a foot carries
/// its animal; their dampers with the effective mass at the point.
void ContactSprings::begin_spring(NearPair& pair, const Touch& touch) {
  const auto whole = [this](const BodySlot& side) {
    if (side.mover < 0) return 0.0;
    return side.tree ? side.tree->model.mass()
                     : state_.free_bodies[static_cast<std::size_t>(side.mover)].now.solid->mass;
  };
  const double mass = reduced(whole(state_.slot_of(pair.a)), whole(state_.slot_of(pair.b)));
  const double effective = effective_mass(pair, touch.point, touch.normal);
  if (!(effective > 0)) return;
  const double own = state_.accuracy.contact_damping;
  const double zeta = own > 0 ? own : contact::damping_ratio(pair.law.restitution);
  if (zeta != calibrated_) dashpots_ = contact::calibrate(calibrated_ = zeta);
  pair.spring = contact::make_spring(state_.accuracy.contact_stiffness * mass, dashpots_, effective, pair.law);
  pair.stored = 0;
  pair.warm_count = 0;
}

/// The surfaces are rigid from now on; what the spring still held is lost.
void ContactSprings::end_spring(NearPair& pair) {
  state_.result.ledger.contact_loss += pair.stored;
  pair.spring = {};
  pair.stored = 0;
  pair.warm_count = 0;
}

/// Takes the points of pairs that are springs out of the touches into those that are followed. A former spring is rigid
/// if the settings, which may change between steps, do not ask for springs any more.
void ContactSprings::take() {
  if (motion_) motion_->points.clear();
  followed_.assign(state_.pairs.size(), 0);
  if (!state_.has_contact_springs()) {
    for (NearPair* pair : state_.pairs)
      if (sprung(*pair)) end_spring(*pair);
    return;
  }
  std::pmr::vector<Touch>& touches = contacts_.touches();
  const double resting = contacts_.resting();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < touches.size();) {
    std::size_t end = i;
    double nearest = JointDrive::kNoLimit;
    bool arrives = false;
    NearPair& pair = contacts_.pair_of(touches[i]);
    const double size = state_.size_of_pair(pair), slow = std::max(pair.law.restitution_threshold, resting);
    for (; end < touches.size() && touches[end].pair == touches[i].pair; ++end) {
      const Touch& touch = touches[end];
      nearest = std::min(nearest, touch.gap);
      arrives = arrives || (touch.gap <= kMetSkin * size && touch.approach <= resting && touch.approach >= -slow);
    }
    const bool apart = nearest >= kMetSkin * size, deep = nearest < -kDeepest * size;
    if (sprung(pair) && (apart || deep)) end_spring(pair);
    if (!sprung(pair) && arrives && nearest >= -kTouchSkin * size && state_.springs_for(pair.law))
      begin_spring(pair, touches[i]);
    followed_[touches[i].pair] = sprung(pair);
    if (sprung(pair)) {
      const std::size_t first = motion_ ? motion_->points.size() : 0;
      for (; i < end; ++i) add_point(pair, touches[i]);
      hand_on(pair, std::span(motion_->points).subspan(first));
      continue;
    }
    for (; i < end; ++i) touches[kept++] = touches[i];
  }
  touches.resize(kept);
  // Springs of pairs that are not even near any more end.
  for (std::size_t i = 0; i < state_.pairs.size(); ++i)
    if (sprung(*state_.pairs[i]) && !followed_[i]) end_spring(*state_.pairs[i]);
}

/// Where springs act, limits that joints are near and slow also act inside the stages: one that let the joint go and
/// stopped it at the end of each sub-step would shake what stands on springs.
/// @param h  s, of the sub-step
void ContactSprings::hold_limits(double h) {
  constexpr double kNear = 1e-4, kSlow = 0.05;  // rad or length units; per second
  for (Tree* tree : state_.trees) tree->held.clear();
  if (!move()) return;
  for (Bound& bound : contacts_.bounds()) {
    if (bound.gap > kNear * bound.unit || std::abs(bound.rate) > kSlow * bound.unit) continue;
    Tree& tree = *state_.core.trees[state_.core.joints[bound.joint].tree];
    tree.held.push_back({bound.joint, bound.axis, bound.sign, bound.limit});
    bound.held = true;
  }
  for (Tree* tree : state_.trees) {
    tree->hold_time = h;
    tree->reserve_rows();
  }
}

void ContactSprings::add_point(const NearPair& pair, const Touch& touch) {
  if (!motion_) motion_ = make_in<SprungMotion>(state_.memory, state_);
  const Shape &a = state_.shape(pair.a), &b = state_.shape(pair.b);
  const bool round_a = a.kind() == ShapeKind::Sphere, round_b = b.kind() == ShapeKind::Sphere;
  const auto patchy = [](const Shape& shape) {
    return shape.kind() == ShapeKind::Mesh || shape.kind() == ShapeKind::HeightField;
  };
  const Pose pa = state_.pose_of(pair.a), pb = state_.pose_of(pair.b);
  SprungPoint point;
  point.pair = touch.pair;
  point.feature = touch.feature;
  point.round = (round_a || round_b) && !patchy(a) && !patchy(b);
  point.with_a = round_b || (!round_a && !state_.core.moves_now(pair.a));
  const Pose& with = point.with_a ? pa : pb;
  Vector3 first, second;
  contact::tangents(touch.normal, first, second);
  point.normal = with.orientation.conjugate() * touch.normal;
  point.tangent = with.orientation.conjugate() * first;
  const double half = 0.5 * touch.gap;
  point.on_a = pa.orientation.conjugate() * (touch.point + half * touch.normal - pa.location);
  point.on_b = pb.orientation.conjugate() * (touch.point - half * touch.normal - pb.location);
  if (!point.round && (round_a || round_b)) {
    (round_a ? point.on_a : point.on_b).setZero();
    point.radius = (round_a ? a : b).radius();
  }
  point.skin = kMetSkin * state_.size_of_pair(pair);
  point.apart = touch.gap > point.skin ? touch.gap : 0;
  point.spring = pair.spring;
  point.spring.damped_depth = point.skin;
  point.spring.linear_depth = kLinear * state_.size_of_pair(pair);
  motion_->points.push_back(point);
}

/// What the pair's points remember of the sub-step before. Where a corner of one body lies on a corner of the other,
/// features change their names: a point that is new goes on with what one left that is no more.
void ContactSprings::hand_on(const NearPair& pair, std::span<SprungPoint> points) {
  const std::span old = std::span(pair.warm).first(static_cast<std::size_t>(pair.warm_count));
  const auto has = [](const auto& all, std::uint32_t feature) {
    return std::any_of(all.begin(), all.end(), [feature](const auto& one) { return one.feature == feature; });
  };
  auto left = old.begin();
  for (SprungPoint& point : points) {
    auto from =
        std::find_if(old.begin(), old.end(), [&](const WarmPoint& one) { return one.feature == point.feature; });
    if (from == old.end()) {
      left = std::find_if(left, old.end(), [&](const WarmPoint& one) { return !has(points, one.feature); });
      from = left;
      if (left != old.end()) ++left;
    }
    if (from != old.end()) {
      point.stretch = from->force;
      point.slides = from->slides;
    }
    point.spring.dynamic_friction = pair.law.dynamic_friction;
    point.spring.static_friction = point.slides ? pair.law.dynamic_friction : pair.law.static_friction;
    if (!point.slides) point.spring.dynamic_friction = point.spring.static_friction;
  }
}

void ContactSprings::keep() {
  if (!motion_ || motion_->points.empty()) return;
  motion_->look();
  for (NearPair* pair : state_.pairs)
    if (sprung(*pair)) pair->warm_count = 0, pair->stored = 0, pair->touching = true;
  for (const SprungPoint& point : motion_->points) {
    NearPair& pair = *state_.pairs[point.pair];
    pair.stored += point.stored;
    if (pair.warm_count == static_cast<int>(pair.warm.size())) continue;
    pair.warm[static_cast<std::size_t>(pair.warm_count++)] = {point.feature, point.slips, point.stretched,
                                                              point.force.dot(point.axes.row(0).transpose())};
  }
}

bool ContactSprings::move() const { return motion_ && !motion_->points.empty(); }

double ContactSprings::smooth(double time, double h) {
  motion_->step(time, h);
  for (Clustered& one : state_.clusters) {
    const Cluster& system = *one.entry->system;
    one.forget_parts();
    for (Tree* tree : system.trees()) tree->motor_impulse = tree->part_impulse;
    one.pending.motor_work = system.motor_work();
    one.pending.script_work = system.script_work();
    one.pending.drag_loss = system.drag_loss();
  }
  return motion_->lost().script_work;
}

void ContactSprings::commit() {
  const auto add = [](const Energy& from, Energy& to) {
    to.contact_loss += from.contact_loss;
    to.friction_loss += from.friction_loss;
    to.limit_loss += from.limit_loss;
  };
  add(motion_->lost(), state_.result.ledger);
  for (Tree* tree : state_.trees) add(motion_->lost(*tree), tree->ledger);
}

std::size_t ContactSprings::points() const { return motion_ ? motion_->points.size() : 0; }

bool ContactSprings::closes(std::size_t point, double h, double& time) {
  const double apart = motion_->points[point].apart;
  if (apart == 0) return false;
  double rate = 0;
  const double gap = motion_->gap_of(point, rate);
  if (!(gap < 0)) return false;
  time = h * apart / (apart - gap);
  return true;
}

std::size_t ContactSprings::pair_of(std::size_t point) const { return motion_->points[point].pair; }

double ContactSprings::gap_of(std::size_t point, double& rate) { return motion_->gap_of(point, rate); }

/// Notes the forces of pairs of springs on links: the reaction of a joint is made of them.
void ContactSprings::note_forces() {
  if (!move()) return;
  for (Tree* tree : state_.trees)
    if (!tree->held.empty()) tree->limit_force += tree->held_force;
  for (const SprungPoint& point : motion_->points) {
    const NearPair& pair = *state_.pairs[point.pair];
    state_.add_force(pair.a, point.at, point.force);
    state_.add_force(pair.b, point.at, -point.force);
  }
}

}  // namespace breve::island
