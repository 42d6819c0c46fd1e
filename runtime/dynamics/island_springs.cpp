// Contacts that are springs: when slow surfaces become so, which of their points are followed through a sub-step, and
// when they are rigid again. A pair with restitution that comes slower than its threshold is caught so, instead of
// being stopped dead: what a touch leaves of a speed does not jump where it becomes slow.
#include <algorithm>

#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/contact/impact_law.hpp"
#include "runtime/dynamics/sprung_motion.hpp"

namespace breve {

namespace {

// Parts of the smaller body's radius: deeper than the first a spring hardens, so that it carries what lies on it;
// deeper than the second it is too weak all the same, and the surfaces become rigid.
constexpr double kLinear = 5e-3, kDeepest = 0.1;

bool sprung(const NearPair& pair) { return pair.spring.stiffness > 0; }

/// The reduced mass of two masses; 0 stands for the mass of something that does not move.
double reduced(double a, double b) { return a > 0 && b > 0 ? a * b / (a + b) : std::max(a, b); }

}  // namespace

bool Island::has_contact_springs() const {
  return accuracy_.contact_springs && accuracy_.locate_impacts && networks_.empty() &&
         (accuracy_.link_springs || trees_.empty());
}

bool Island::springs_for(const contact::Law& law) const {
  return has_contact_springs() && law.restitution > 0 && law.restitution_threshold > 0;
}

/// What an impulse along `normal` has to move there, kg.
double Island::effective_mass(const NearPair& pair, const Vector3& point, const Vector3& normal) const {
  const BodySlot a = slot_of(pair.a), b = slot_of(pair.b);
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
    const contact::Mover& mover = movers_[static_cast<std::size_t>(side.mover)];
    const Vector3 arm = arm_of(side, point).cross(normal);
    const FreeBody& free = free_[static_cast<std::size_t>(side.mover)].now;
    yields += mover.inverse_mass + arm.dot(Eigen::Matrix3d(free.inertia()).inverse() * arm);
  }
  return yields > 0 ? 1 / yields : 0;
}

/// Surfaces that touch become springs. Their stiffness goes with the whole mass on either side, so that a foot carries
/// its animal; their dampers with what the point feels.
void Island::begin_spring(NearPair& pair, const Touch& touch) {
  const auto whole = [this](const BodySlot& side) {
    if (side.mover < 0) return 0.0;
    return side.tree ? side.tree->model.mass() : free_[static_cast<std::size_t>(side.mover)].now.solid->mass;
  };
  const double mass = reduced(whole(slot_of(pair.a)), whole(slot_of(pair.b)));
  const double effective = effective_mass(pair, touch.point, touch.normal);
  if (!(effective > 0)) return;
  const double own = accuracy_.contact_damping;
  const double zeta = own > 0 ? own : contact::damping_ratio(pair.law.restitution);
  if (zeta != calibrated_) dashpots_ = contact::calibrate(calibrated_ = zeta);
  pair.spring = contact::make_spring(accuracy_.contact_stiffness * mass, dashpots_, effective, pair.law);
  pair.stored = 0;
  pair.warm_count = 0;
}

/// The surfaces are rigid from now on; what the spring still held is lost.
void Island::end_spring(NearPair& pair) {
  result.ledger.contact_loss += pair.stored;
  pair.spring = {};
  pair.stored = 0;
  pair.warm_count = 0;
}

/// Takes the points of pairs that are springs out of touches_ into those that are followed. A former spring is rigid
/// if the settings, which may change between steps, do not ask for springs any more.
void Island::take_springs() {
  if (sprung_) sprung_->points.clear();
  followed_.assign(pairs_.size(), 0);
  if (!has_contact_springs()) {
    for (NearPair* pair : pairs_)
      if (sprung(*pair)) end_spring(*pair);
    return;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < touches_.size();) {
    std::size_t end = i;
    double nearest = JointDrive::kNoLimit;
    bool arrives = false;
    NearPair& pair = *pairs_[touches_[i].pair];
    const double size = size_of_pair(pair), slow = std::max(pair.law.restitution_threshold, resting_);
    for (; end < touches_.size() && touches_[end].pair == touches_[i].pair; ++end) {
      const Touch& touch = touches_[end];
      nearest = std::min(nearest, touch.gap);
      arrives = arrives || (touch.gap <= kMetSkin * size && touch.approach <= resting_ && touch.approach >= -slow);
    }
    const bool apart = nearest >= kMetSkin * size, deep = nearest < -kDeepest * size;
    if (sprung(pair) && (apart || deep)) end_spring(pair);
    if (!sprung(pair) && arrives && nearest >= -kTouchSkin * size && springs_for(pair.law))
      begin_spring(pair, touches_[i]);
    followed_[touches_[i].pair] = sprung(pair);
    if (sprung(pair)) {
      const std::size_t first = sprung_ ? sprung_->points.size() : 0;
      for (; i < end; ++i) add_sprung_point(pair, touches_[i]);
      hand_on(pair, std::span(sprung_->points).subspan(first));
      continue;
    }
    for (; i < end; ++i) touches_[kept++] = touches_[i];
  }
  touches_.resize(kept);
  // Springs of pairs that are not even near any more end.
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    if (sprung(*pairs_[i]) && !followed_[i]) end_spring(*pairs_[i]);
}

/// Where springs act, limits that joints are near and slow act inside the stages, too: one that let the joint go and
/// stopped it at the end of each sub-step would shake what stands on springs.
/// @param h  s, of the sub-step
void Island::hold_limits(double h) {
  constexpr double kNear = 1e-4, kSlow = 0.05;  // rad or m; rad/s or m/s
  for (Tree* tree : trees_) tree->held.clear();
  if (!springs_move()) return;
  for (Bound& bound : bounds_) {
    if (bound.gap > kNear || std::abs(bound.rate) > kSlow) continue;
    Tree& tree = *core_.trees[core_.joints[bound.joint].tree];
    tree.held.push_back({bound.joint, bound.axis, bound.sign, bound.limit});
    bound.held = true;
  }
  for (Tree* tree : trees_) {
    tree->hold_time = h;
    tree->reserve_rows();
  }
}

void Island::add_sprung_point(const NearPair& pair, const Touch& touch) {
  if (!sprung_) sprung_ = make_in<SprungMotion>(memory_, *this, memory_);
  const Shape &a = *core_.bodies->collision_shape(pair.a), &b = *core_.bodies->collision_shape(pair.b);
  const bool round_a = a.kind() == ShapeKind::Sphere, round_b = b.kind() == ShapeKind::Sphere;
  const auto patchy = [](const Shape& shape) {
    return shape.kind() == ShapeKind::Mesh || shape.kind() == ShapeKind::HeightField;
  };
  const Pose pa = pose_of(pair.a), pb = pose_of(pair.b);
  SprungPoint point;
  point.pair = touch.pair;
  point.feature = touch.feature;
  point.round = (round_a || round_b) && !patchy(a) && !patchy(b);
  point.with_a = round_b || (!round_a && !core_.moves_now(pair.a));
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
  point.skin = kMetSkin * size_of_pair(pair);
  point.apart = touch.gap > point.skin ? touch.gap : 0;
  point.spring = pair.spring;
  point.spring.damped_depth = point.skin;
  point.spring.linear_depth = kLinear * size_of_pair(pair);
  sprung_->points.push_back(point);
}

/// What the pair's points remember of the sub-step before. Where a corner of one body lies on a corner of the other,
/// features change their names: a point that is new goes on with what one left that is no more.
void Island::hand_on(const NearPair& pair, std::span<SprungPoint> points) {
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

/// After a sub-step that counts: what its springs lost, and what they remember.
void Island::keep_springs() {
  if (!sprung_ || sprung_->points.empty()) return;
  sprung_->look();
  for (NearPair* pair : pairs_)
    if (sprung(*pair)) pair->warm_count = 0, pair->stored = 0, pair->touching = true;
  for (const SprungPoint& point : sprung_->points) {
    NearPair& pair = *pairs_[point.pair];
    pair.stored += point.stored;
    if (pair.warm_count == static_cast<int>(pair.warm.size())) continue;
    pair.warm[static_cast<std::size_t>(pair.warm_count++)] = {point.feature, point.slips, point.stretched,
                                                              point.force.dot(point.axes.row(0).transpose())};
  }
}

bool Island::springs_move() const { return sprung_ && !sprung_->points.empty(); }

void Island::smooth_springs(double time, double h) {
  sprung_->step(time, h);
  free_work_ = sprung_->lost().script_work;
  for (Clustered& one : clusters_) {
    const Cluster& system = *one.entry->system;
    forget_parts(one);
    for (Tree* tree : system.trees()) tree->motor_impulse = tree->part_impulse;
    one.pending.motor_work = system.motor_work();
    one.pending.script_work = system.script_work();
    one.pending.drag_loss = system.drag_loss();
  }
}

void Island::commit_springs() {
  const auto add = [](const Energy& from, Energy& to) {
    to.contact_loss += from.contact_loss;
    to.friction_loss += from.friction_loss;
    to.limit_loss += from.limit_loss;
  };
  add(sprung_->lost(), result.ledger);
  for (Tree* tree : trees_) add(sprung_->lost(*tree), tree->ledger);
}

/// Adds to found_ the points of springs that closed in the sub-step; they are to push from that moment on.
void Island::seek_closing(double h) {
  if (!springs_move()) return;
  for (std::size_t i = 0; i < sprung_->points.size(); ++i) {
    const double apart = sprung_->points[i].apart;
    if (apart == 0) continue;
    double rate = 0;
    const double gap = sprung_->gap_of(i, rate);
    if (!(gap < 0)) continue;
    Event event;
    event.time = h * apart / (apart - gap);
    event.point = static_cast<int>(i);
    found_.push_back(event);
  }
}

std::size_t Island::pair_of_point(int point) const { return sprung_->points[static_cast<std::size_t>(point)].pair; }

double Island::gap_of_point(int point, double& rate) { return sprung_->gap_of(static_cast<std::size_t>(point), rate); }

/// Notes the forces of pairs of springs on links: the reaction of a joint is made of them.
void Island::note_spring_forces() {
  if (!springs_move()) return;
  for (Tree* tree : trees_)
    if (!tree->held.empty()) tree->limit_force += tree->held_force;
  for (const SprungPoint& point : sprung_->points) {
    const NearPair& pair = *pairs_[point.pair];
    add_force(pair.a, point.at, point.force);
    add_force(pair.b, point.at, -point.force);
  }
}

}  // namespace breve
