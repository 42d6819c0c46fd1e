// From contacts, limits and rings to the solver's rows.
#include <algorithm>
#include <cmath>

#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/joints.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/contact/impact_law.hpp"
#include "runtime/dynamics/island.hpp"
#include "runtime/dynamics/joint_frames.hpp"

namespace breve {

namespace {

double size_of(const Shape& a, const Shape& b) { return std::min(a.bounding_radius(), b.bounding_radius()); }

}  // namespace

Island::Touch Island::touch_at(std::size_t pair, const Pose& a, const Pose& b, const Manifold& manifold,
                               const ContactPoint& point) {
  Touch touch;
  touch.pair = static_cast<std::uint32_t>(pair);
  touch.feature = point.feature;
  touch.point = 0.5 * (point.on_a + point.on_b);
  touch.on_a = a.orientation.conjugate() * (touch.point - a.location);
  touch.on_b = b.orientation.conjugate() * (touch.point - b.location);
  touch.from_a = a.location;
  touch.from_b = b.location;
  touch.orientation_a = a.orientation;
  touch.orientation_b = b.orientation;
  touch.normal = manifold.normal;
  touch.gap = point.distance;
  return touch;
}

void Island::find_touches(double h, bool speculative) {
  touches_.clear();
  NarrowCounters narrow;
  narrow.stop = meter_.end();
  const double fall = core_.settings.gravity.norm() * h;
  resting_ = 1e-3 * fall + 1e-12;
  looked_h_ = h;
  // A row catches a body before it touches, if it comes as slowly as a body at rest falls in a sub-step.
  constexpr double kMostRoom = 0.05;  // of the size
  constexpr double kHastens = 1.5;    // of its speed, within a sub-step, of a point that comes nearer by rotation
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    NearPair& pair = *pairs_[i];
    const Shape &a = *core_.bodies->collision_shape(pair.a), &b = *core_.bodies->collision_shape(pair.b);
    const Pose pa = pose_of(pair.a), pb = pose_of(pair.b);
    const double skin = kSkin * size_of(a, b);
    const double near = std::max(skin, std::min(2 * fall * h, kMostRoom * size_of(a, b)));
    double margin = near;
    if (speculative) {
      const Vector3 rate = point_velocity(pair.a, pa.location) - point_velocity(pair.b, pb.location);
      margin += h * (rate.norm() + fall) + kRotationRoom * size_of(a, b);
    } else {
      // What rests on an edge and tips comes down on points that lie farther off.
      margin += 2 * h * (spin_of(pair.a) - spin_of(pair.b)).norm() * size_of(a, b);
    }
    manifolds_.clear();
    find_manifolds(a, pa, b, pb, margin, manifolds_, pair.cache, narrow);
    for (const Manifold& manifold : manifolds_) {
      ++result.counters.manifolds;
      for (int k = 0; k < manifold.count; ++k) {
        const ContactPoint& point = manifold.points[static_cast<std::size_t>(k)];
        Touch touch = touch_at(i, pa, pb, manifold, point);
        touch.velocity_a = point_velocity(pair.a, touch.point);
        touch.velocity_b = point_velocity(pair.b, touch.point);
        if (!speculative) {
          touch.approach = manifold.normal.dot(touch.velocity_a - touch.velocity_b);
          touch.far = touch.gap > near;
          if (touch.far && touch.gap + kHastens * h * touch.approach > near) continue;
        }
        touches_.push_back(touch);
      }
    }
  }
  result.counters.pairs += narrow.pairs;
  constexpr std::uint64_t kUnits = 10;  // of work, a pair
  meter_.add(kUnits * (pairs_.size() + narrow.pairs) + narrow.facets + narrow.boxes + touches_.size());
}

double Island::size_of_pair(const NearPair& pair) const {
  return size_of(*core_.bodies->collision_shape(pair.a), *core_.bodies->collision_shape(pair.b));
}

Island::Speeds Island::speeds_of(const contact::Law& law, double size, double h) const {
  const double fall = core_.settings.gravity.norm() * h;
  if (law.restitution > 0) {
    const double slow = std::max(law.restitution_threshold, resting_);
    return {slow, slow};
  }
  // Nothing rebounds: a row stops it as well, but for the depth that it would reach until then.
  return {JointDrive::kNoLimit, std::max(2 * fall, kSkin * size / h) + resting_};
}

bool Island::strikes(double h) const {
  for (const Touch& touch : touches_) {
    const NearPair& pair = *pairs_[touch.pair];
    const double size = size_of_pair(pair);
    if (touch.gap <= kMetSkin * size && touch.approach < -speeds_of(pair.law, size, h).strike) return true;
  }
  for (const Bound& bound : bounds_)
    if (!bound.held && bound.gap <= met_limit() && bound.rate < -bound.slow) return true;
  return false;
}

/// @param struck  what touches has collided already: what still approaches then is stopped by rows
void Island::find_roles(double h, bool struck) {
  roles_.assign(pairs_.size(), Role::Far);
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    if (pairs_[i]->spring.stiffness > 0) roles_[i] = Role::Springs;
  depths_.assign(pairs_.size(), 0.0);
  for (const Touch& touch : touches_) {
    const NearPair& pair = *pairs_[touch.pair];
    const double size = size_of_pair(pair);
    const bool touching = touch.gap <= kTouchSkin * size;
    // It becomes a spring when it meets: that moment is looked for.
    const bool springs = springs_for(pair.law) && touch.gap >= -kTouchSkin * size;
    const Speeds speeds = speeds_of(pair.law, size, h);
    Role& role = roles_[touch.pair];
    if (touch.far) continue;
    depths_[touch.pair] = std::max(depths_[touch.pair], -touch.gap);
    // A first touch that a handler waits for is met, however slow.
    const bool awaited =
        locates_ && pair.handled && !pair.touching && touch.gap > kMetSkin * size && touch.approach < 0;
    if (awaited) continue;
    const bool slow = std::abs(touch.approach) <= speeds.slow;
    if (!springs && (slow || (struck && touching && touch.approach < 0)))
      role = Role::Rests;
    else if (touching && touch.approach > 0 && role == Role::Far)
      role = Role::Leaves;
  }
  std::erase_if(touches_, [this](const Touch& touch) { return roles_[touch.pair] != Role::Rests; });
}

void Island::find_touches_now() {
  touches_.clear();
  NarrowCounters narrow;
  narrow.stop = meter_.end();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    NearPair& pair = *pairs_[i];
    if (pair.spring.stiffness > 0) continue;  // it gives way to what is sudden
    const Shape &a = *core_.bodies->collision_shape(pair.a), &b = *core_.bodies->collision_shape(pair.b);
    const Pose pa = pose_of(pair.a), pb = pose_of(pair.b);
    manifolds_.clear();
    find_manifolds(a, pa, b, pb, kTouchSkin * size_of(a, b), manifolds_, pair.cache, narrow);
    for (const Manifold& manifold : manifolds_)
      for (int k = 0; k < manifold.count; ++k) {
        const ContactPoint& point = manifold.points[static_cast<std::size_t>(k)];
        if (point.distance > kTouchSkin * size_of(a, b)) continue;
        touches_.push_back(touch_at(i, pa, pb, manifold, point));
      }
  }
}

/// How fast what rests falls in a sub-step, as the rate of a joint: twice that of a free link's rim, m/s or rad/s.
double Island::falling(const JointEntry& joint) const {
  const double fall = 2 * core_.settings.gravity.norm() * looked_h_;
  if (joint.is.kind == JointKind::Prismatic) return fall;
  return fall / core_.bodies->collision_shape(joint.is.child)->bounding_radius();
}

void Island::find_bounds() {
  constexpr double kMostRoom = 1e-3;  // rad or m
  bounds_.clear();
  for (Tree* tree : trees_) {
    for (const TreeLink& link : tree->links) {
      if (link.joint == kNoJoint) continue;
      const JointEntry& joint = core_.joints[link.joint];
      if (!Dynamics::Core::has_limits(joint)) continue;
      const JointVector position = core_.read_position(joint), velocity = core_.read_velocity(joint);
      for (int k = 0; k < axis_count(joint.is.kind); ++k) {
        for (const double sign : {1.0, -1.0}) {
          const double limit = sign > 0 ? joint.drive.low[k] : joint.drive.high[k];
          if (!std::isfinite(limit)) continue;
          Bound bound{link.joint, k, sign, limit, sign * (position[k] - limit), sign * velocity[k], resting_, false};
          const bool stays = bounds_.size() < rebounds_.size() && rebounds_[bounds_.size()].stays;
          // Inelastic limits may be met by a row; others are located. A row catches a joint before it is there, if it
          // comes as slowly as a body at rest falls in a sub-step and is not driven.
          if (joint.drive.limit_restitution > 0) {
            bound.rests = bound.gap <= kLimitSkin && (stays || std::abs(bound.rate) <= resting_);
          } else {
            if (!link.motor) bound.slow += falling(joint);
            const bool caught = bound.gap <= std::min(bound.slow * looked_h_, kMostRoom);
            bound.rests = bound.gap <= kLimitSkin || (caught && std::abs(bound.rate) <= bound.slow);
          }
          bounds_.push_back(bound);
        }
      }
    }
  }
}

double* Island::rows_of(Tree& tree, int count) {
  const auto size = static_cast<std::size_t>(tree.model.velocities() * count);
  const std::size_t at = numbers_.size();
  numbers_.resize(at + size);  // within what make_rows reserved: pointers stay
  return numbers_.data() + at;
}

void Island::fill(Tree& tree, int link, const Vector3& point, const Vector3& axis, bool angular, double sign,
                  double* j) {
  using articulated::JointType;
  for (int i = link; i >= 0; i = tree.model.body(i).parent) {
    const articulated::Body& body = tree.model.body(i);
    const articulated::Work& work = tree.data.of(i);
    const Vector3 linear = angular ? Vector3(Vector3::Zero()) : Vector3(sign * axis);
    const Vector3 rotation =
        angular ? Vector3(sign * axis) : Vector3((point - tree.data.motion_of(i).origin).cross(linear));
    double* at = j + body.v;
    // A push along the axis turns nothing: round-off there, taken for a lever, would turn it without bound.
    constexpr double kRoundOff = 1e-13;
    switch (body.type) {
      case JointType::Revolute: {
        const double lever = work.axis.dot(rotation);
        const Vector3& origin = tree.data.motion_of(i).origin;
        if (angular || std::abs(lever) > kRoundOff * (point - origin).lpNorm<1>()) at[0] += lever;
        break;
      }
      case JointType::Prismatic: at[0] += work.axis.dot(linear); break;
      case JointType::Universal:
        at[0] += work.axis.dot(rotation);
        at[1] += tree.data.wide_of(body).axis2.dot(rotation);
        break;
      case JointType::Ball: Eigen::Map<Vector3>{at} += work.rotation.transpose() * rotation; break;
      case JointType::Free:
        Eigen::Map<Vector3>{at} += body.rotation.transpose() * linear;
        Eigen::Map<Vector3>{at + 3} += work.rotation.transpose() * rotation;
        break;
      case JointType::Fixed: break;
    }
  }
}

void Island::respond(Tree& tree, const double* j, double* r) const {
  const int n = tree.model.velocities();
  tree.work_v = Eigen::Map<const articulated::Vector>(j, n);
  articulated::apply_inverse_mass(tree.model, tree.data, tree.work_v, tree.work_u);
  Eigen::Map<articulated::Vector>(r, n) = tree.work_u;
}

/// Rows where the island stands, whose links are placed.
void Island::make_rows(Motors motors) {
  rows_.clear();
  scalars_.clear();
  motors_.clear();
  laws_.clear();
  numbers_.clear();
  loop_errors_.clear();
  std::size_t widest = 0, loops = 0, driven = 0;
  for (Tree* tree : trees_) {
    widest = std::max(widest, static_cast<std::size_t>(tree->model.velocities()));
    loops += tree->loops.size();
    for (const TreeLink& link : tree->links) driven += link.motor;
  }
  numbers_.reserve(widest * (12 * touches_.size() + 2 * bounds_.size() + 6 * driven + 12 * loops));
  for (Free& one : loose_bodies()) {
    const Matrix3 r = one.now.orientation.toRotationMatrix();
    contact::Mover& mover = movers_[static_cast<std::size_t>(&one - free_.data())];
    mover.inverse_inertia = r * Eigen::Matrix3d(one.now.solid->inertia).inverse() * r.transpose();
  }
  for (Tree* tree : trees_) tree->row_center = articulated::centre_of_mass(tree->model, tree->data);
  for (Touch& touch : touches_) add_touch_row(touch);
  for (const Bound& bound : bounds_)
    if (bound.rests) add_bound_row(bound);
  if (motors == Motors::Drive)
    for (Tree* tree : trees_) add_motor_rows(*tree);
  for (Tree* tree : trees_) add_loop_rows(*tree);
}

/// Velocities at the rows when the sub-step began: seen then, where the rows were found.
void Island::recall_rates() {
  before_.clear();
  scalars_before_.clear();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    contact::Row& row = rows_[i];
    const Touch& touch = touches_[i];
    const Vector3 a = row.axes * touch.velocity_a, b = row.axes * touch.velocity_b;
    const BodySlot of_a = slot_of(pairs_[touch.pair]->a), of_b = slot_of(pairs_[touch.pair]->b);
    const bool inner = of_a.tree && of_a.tree == of_b.tree;
    before_.push_back(inner ? Vector3(a - b) : a);
    before_.push_back(inner ? Vector3::Zero() : b);
    row.slip[0] = a[1] - b[1];
    row.slip[1] = a[2] - b[2];
  }
  for (const Bound& bound : bounds_)
    if (bound.rests) scalars_before_.push_back(bound.rate);
  for (const MotorRow& motor : motors_) scalars_before_.push_back(motor.tree->sub_state.v[motor.velocity]);
  scalars_before_.resize(scalars_.size(), 0.0);
}

/// The same where the movers stand, with the velocities that they have.
void Island::read_rates() {
  before_.clear();
  scalars_before_.clear();
  for (contact::Row& row : rows_) {
    const Vector3 a = rate_of(row, true), b = rate_of(row, false);
    before_.push_back(a);
    before_.push_back(b);
    row.slip[0] = a[1] - b[1];
    row.slip[1] = a[2] - b[2];
  }
  for (const contact::ScalarRow& row : scalars_) scalars_before_.push_back(rate_of(row));
}

void Island::set_biases(double h) {
  for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i].bias = std::min(0.0, -touches_[i].gap / h);
  for (std::size_t i = 0, k = 0; i < bounds_.size(); ++i)
    if (bounds_[i].rests) scalars_[k++].bias = std::min(0.0, -bounds_[i].gap / h);
}

namespace {

bool is_round(const Shape& shape) { return shape.kind() == ShapeKind::Sphere || shape.round().is_round(); }

/// The point of a body that stood and was turned so, once it is at `now`: what is round about an axis turns about it
/// without taking its point along, so that only the shortest rotation of the axis counts; a ball has no axis to turn.
Vector3 carried_by(const Shape& shape, const Vector3& point, const Vector3& on, const Vector3& from,
                   const Quaternion& rotation, const Pose& now) {
  if (!is_round(shape)) return now.location + now.orientation * on;
  if (shape.kind() == ShapeKind::Sphere) return point + now.location - from;
  const Vector3 axis = Vector3::Unit(shape.round().axis);
  return now.location + Quaternion::FromTwoVectors(rotation * axis, now.orientation * axis) * (point - from);
}

}  // namespace

/// Where two bodies touch once they have moved: a round body's point goes with its centre, a corner's with its body;
/// where both are alike and both move, in the middle.
Vector3 Island::carried(const Touch& touch) const {
  const NearPair& pair = *pairs_[touch.pair];
  const Shape &a = *core_.bodies->collision_shape(pair.a), &b = *core_.bodies->collision_shape(pair.b);
  const auto with_a = [&] {
    return carried_by(a, touch.point, touch.on_a, touch.from_a, touch.orientation_a, pose_of(pair.a));
  };
  const auto with_b = [&] {
    return carried_by(b, touch.point, touch.on_b, touch.from_b, touch.orientation_b, pose_of(pair.b));
  };
  const bool a_moves = slot_of(pair.a).mover >= 0, b_moves = slot_of(pair.b).mover >= 0;
  const bool by_a = a_moves && (is_round(a) || !is_round(b)), by_b = b_moves && (is_round(b) || !is_round(a));
  if (by_a && by_b) return 0.5 * (with_a() + with_b());
  if (by_a) return with_a();
  return by_b ? with_b() : touch.point;
}

void Island::add_touch_row(Touch& touch) {
  const NearPair& pair = *pairs_[touch.pair];
  touch.point = carried(touch);
  contact::Row row;
  Vector3 t1, t2;
  contact::tangents(touch.normal, t1, t2);
  row.axes << touch.normal.transpose(), t1.transpose(), t2.transpose();
  row.static_friction = pair.law.static_friction;
  row.dynamic_friction = pair.law.dynamic_friction;
  row.pair = static_cast<int>(touch.pair);
  BodySlot sides[2] = {slot_of(pair.a), slot_of(pair.b)};
  for (BodySlot& side : sides)
    if (is_driver(side.mover)) side.mover = pair_drivers_[touch.pair];
  const bool same = sides[0].tree && sides[0].tree == sides[1].tree;
  for (int s = 0; s < 2; ++s) {
    const BodySlot& side = sides[s];
    if (side.mover < 0 || (s == 1 && same)) continue;
    (s == 0 ? row.a : row.b) = side.mover;
    if (!side.tree) {
      (s == 0 ? row.arm_a : row.arm_b) = arm_of(side, touch.point);
      continue;
    }
    const int n = side.tree->model.velocities();
    double *j = rows_of(*side.tree, 3), *r = rows_of(*side.tree, 3);
    std::fill(j, j + 3 * n, 0.0);
    for (int k = 0; k < 3; ++k) {
      fill(*side.tree, side.link, touch.point, row.axes.row(k), false, 1, j + k * n);
      if (same) fill(*side.tree, sides[1].link, touch.point, row.axes.row(k), false, -1, j + k * n);
      respond(*side.tree, j + k * n, r + k * n);
    }
    (s == 0 ? row.ja : row.jb) = j;
    (s == 0 ? row.ra : row.rb) = r;
  }
  if (const WarmPoint* warm = warm_of(touch)) {
    row.impulse = row.axes * warm->force;  // made an impulse where the sub-step's length is known
    ++result.counters.warm;
  }
  ++result.counters.contacts;
  rows_.push_back(row);
  laws_.push_back(pair.law);
}

/// Rate of the position by each of the joint's velocities, read off column by column.
void Island::fill_limit(const Tree& tree, const JointEntry& joint, int axis, double sign, double* j) {
  std::fill(j, j + tree.model.velocities(), 0.0);
  const articulated::Body& body = tree.model.body(joint.link);
  for (int k = 0; k < articulated::velocity_count(body.type); ++k) {
    double unit[3] = {0, 0, 0};
    unit[k] = 1;
    j[body.v + k] = sign * joint_velocity(joint.is, joint.flipped, tree.state.q.data() + body.q, unit)[axis];
  }
}

void Island::add_bound_row(const Bound& bound) {
  const JointEntry& joint = core_.joints[bound.joint];
  Tree& tree = *core_.trees[joint.tree];
  double *j = rows_of(tree, 1), *r = rows_of(tree, 1);
  fill_limit(tree, joint, bound.axis, bound.sign, j);
  respond(tree, j, r);
  contact::ScalarRow row;
  row.a = static_cast<int>(free_.size()) + tree.slot;
  row.ja = j;
  row.ra = r;
  row.hi = JointDrive::kNoLimit;
  row.impulse = std::max(0.0, bound.sign * joint.limit[bound.axis]);
  scalars_.push_back(row);
  ++result.counters.limits;
}

/// Each axis of a universal joint has a motor with the joint's strength; the three of a ball joint share one.
void Island::add_motor_rows(Tree& tree) {
  const int n = tree.model.velocities();
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const TreeLink& link = tree.links[i];
    if (!link.motor) continue;
    const articulated::Body& body = tree.model.body(static_cast<int>(i));
    const JointEntry& joint = core_.joints[link.joint];
    const int count = articulated::velocity_count(body.type);
    const bool ball = body.type == articulated::JointType::Ball;
    for (int k = 0; k < count; ++k) {
      double *j = rows_of(tree, 1), *r = rows_of(tree, 1);
      std::fill(j, j + n, 0.0);
      j[body.v + k] = 1;
      respond(tree, j, r);
      contact::ScalarRow row;
      row.a = static_cast<int>(free_.size()) + tree.slot;
      row.ja = j;
      row.ra = r;
      row.impulse = joint.motor[k];
      scalars_.push_back(row);
      motors_.push_back({&tree, link.joint, k, body.v + k, !ball ? 1 : k == 0 ? count : 0, joint.drive.strength_limit});
    }
  }
}

void Island::add_loop_rows(const Tree& of) {
  Tree& tree = *trees_[static_cast<std::size_t>(of.slot)];
  for (const JointIndex index : tree.loops) {
    const LoopRows loop = core_.loop_rows(tree, core_.joints[index].is);
    for (int k = 0; k < loop.count; ++k) {
      const LoopRow& wanted = loop.rows[static_cast<std::size_t>(k)];
      double *j = rows_of(tree, 1), *r = rows_of(tree, 1);
      fill_loop(tree, loop, wanted, j);
      respond(tree, j, r);
      contact::ScalarRow row;
      row.a = static_cast<int>(free_.size()) + tree.slot;
      row.ja = j;
      row.ra = r;
      row.lo = -JointDrive::kNoLimit;
      row.hi = JointDrive::kNoLimit;
      scalars_.push_back(row);
      loop_errors_.push_back(wanted.error);
    }
  }
}

}  // namespace breve
