// From contacts, limits and rings to the solver's rows, and from its impulses back to states.
#include <algorithm>
#include <cmath>

#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/joints.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/base/rotation_vector.hpp"
#include "runtime/contact/impact_law.hpp"
#include "runtime/dynamics/island.hpp"
#include "runtime/dynamics/joint_frames.hpp"

namespace breve {

namespace {

double size_of(const Shape& a, const Shape& b) { return std::min(a.bounding_radius(), b.bounding_radius()); }

}  // namespace

void Island::find_touches(double h, bool speculative) {
  touches_.clear();
  NarrowCounters narrow;
  const double fall = core_.settings.gravity.norm() * h;
  quiet_ = 1e-3 * fall + 1e-12;
  // What comes as slowly as something at rest falls in a sub-step is caught by a row before it touches.
  constexpr double kMostRoom = 0.05;  // of the size
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    NearPair& pair = *pairs_[i];
    const Shape &a = *core_.bodies->collision_shape(pair.a), &b = *core_.bodies->collision_shape(pair.b);
    const Pose pa = pose_of(pair.a), pb = pose_of(pair.b);
    const double skin = kSkin * size_of(a, b);
    double margin = std::max(skin, std::min(2 * fall * h, kMostRoom * size_of(a, b)));
    if (speculative) {
      const Vector3 rate = point_velocity(pair.a, pa.location) - point_velocity(pair.b, pb.location);
      margin += h * (rate.norm() + fall) + kTurnRoom * size_of(a, b);
    }
    manifolds_.clear();
    find_manifolds(a, pa, b, pb, margin, manifolds_, pair.cache, narrow);
    for (const Manifold& manifold : manifolds_) {
      ++result.counters.manifolds;
      for (int k = 0; k < manifold.count; ++k) {
        const ContactPoint& point = manifold.points[static_cast<std::size_t>(k)];
        Touch touch{static_cast<std::uint32_t>(i),
                    point.feature,
                    0.5 * (point.on_a + point.on_b),
                    manifold.normal,
                    point.distance,
                    0};
        touch.approach = manifold.normal.dot(point_velocity(pair.a, touch.point) - point_velocity(pair.b, touch.point));
        touches_.push_back(touch);
      }
    }
  }
  result.counters.pairs += narrow.pairs;
}

double Island::size_of_pair(const NearPair& pair) const {
  return size_of(*core_.bodies->collision_shape(pair.a), *core_.bodies->collision_shape(pair.b));
}

Island::Speeds Island::speeds_of(const contact::Law& law, double size, double h) const {
  const double fall = core_.settings.gravity.norm() * h;
  if (law.restitution > 0) {
    const double slow = std::max(law.restitution_threshold, quiet_);
    return {slow, slow};
  }
  // Nothing rebounds: a row stops it as well, but for the depth that it would reach until then.
  return {JointDrive::kNoLimit, std::max(2 * fall, kSkin * size / h) + quiet_};
}

bool Island::strikes(double h) const {
  for (const Touch& touch : touches_) {
    const NearPair& pair = *pairs_[touch.pair];
    const double size = size_of_pair(pair);
    if (touch.gap <= kMetSkin * size && touch.approach < -speeds_of(pair.law, size, h).strike) return true;
  }
  for (const Bound& bound : bounds_)
    if (bound.gap <= 0 && bound.rate < -quiet_) return true;
  return false;
}

/// @param struck  what touches has collided already: what still approaches then is stopped by rows
void Island::find_roles(double h, bool struck) {
  roles_.assign(pairs_.size(), Role::Far);
  depths_.assign(pairs_.size(), 0.0);
  for (const Touch& touch : touches_) {
    const NearPair& pair = *pairs_[touch.pair];
    const double size = size_of_pair(pair);
    const bool touching = touch.gap <= kTouchSkin * size;
    const Speeds speeds = speeds_of(pair.law, size, h);
    Role& role = roles_[touch.pair];
    depths_[touch.pair] = std::max(depths_[touch.pair], -touch.gap);
    // A first touch that a handler waits for is met, however slow.
    const bool awaited =
        locates_ && pair.handled && !pair.touching && touch.gap > kMetSkin * size && touch.approach < 0;
    if (awaited) continue;
    if (std::abs(touch.approach) <= speeds.slow || (struck && touching && touch.approach < 0))
      role = Role::Rests;
    else if (touching && touch.approach > 0 && role == Role::Far)
      role = Role::Leaves;
  }
  std::erase_if(touches_, [this](const Touch& touch) { return roles_[touch.pair] != Role::Rests; });
}

void Island::find_touches_now() {
  touches_.clear();
  NarrowCounters narrow;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    NearPair& pair = *pairs_[i];
    const Shape &a = *core_.bodies->collision_shape(pair.a), &b = *core_.bodies->collision_shape(pair.b);
    manifolds_.clear();
    find_manifolds(a, pose_of(pair.a), b, pose_of(pair.b), kTouchSkin * size_of(a, b), manifolds_, pair.cache, narrow);
    for (const Manifold& manifold : manifolds_)
      for (int k = 0; k < manifold.count; ++k) {
        const ContactPoint& point = manifold.points[static_cast<std::size_t>(k)];
        if (point.distance > kTouchSkin * size_of(a, b)) continue;
        touches_.push_back({static_cast<std::uint32_t>(i), point.feature, 0.5 * (point.on_a + point.on_b),
                            manifold.normal, point.distance, 0});
      }
  }
}

void Island::find_bounds() {
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
          Bound bound{link.joint, k, sign, sign * (position[k] - limit), sign * velocity[k], false};
          // Inelastic limits may be met by a row; others are located.
          const double slow = joint.drive.limit_restitution > 0 ? quiet_ : JointDrive::kNoLimit;
          bound.rests = bound.gap <= kLimitSkin && std::abs(bound.rate) <= slow;
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
    const Vector3 turn =
        angular ? Vector3(sign * axis) : Vector3((point - tree.data.motion_of(i).origin).cross(linear));
    double* at = j + body.v;
    switch (body.type) {
      case JointType::Revolute: at[0] += work.axis.dot(turn); break;
      case JointType::Prismatic: at[0] += work.axis.dot(linear); break;
      case JointType::Universal:
        at[0] += work.axis.dot(turn);
        at[1] += tree.data.wide_of(body).axis2.dot(turn);
        break;
      case JointType::Ball: Eigen::Map<Vector3>{at} += work.rotation.transpose() * turn; break;
      case JointType::Free:
        Eigen::Map<Vector3>{at} += body.turn.transpose() * linear;
        Eigen::Map<Vector3>{at + 3} += work.rotation.transpose() * turn;
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

void Island::make_rows(double h, bool restitution) {
  rows_.clear();
  scalars_.clear();
  laws_.clear();
  numbers_.clear();
  ring_errors_.clear();
  std::size_t widest = 0, rings = 0;
  for (Tree* tree : trees_) {
    widest = std::max(widest, static_cast<std::size_t>(tree->model.velocities()));
    rings += tree->rings.size();
  }
  numbers_.reserve(widest * (12 * touches_.size() + 2 * bounds_.size() + 12 * rings));
  for (Free& one : free_) {
    const Matrix3 r = one.now.orientation.toRotationMatrix();
    contact::Mover& mover = movers_[static_cast<std::size_t>(&one - free_.data())];
    mover.inverse_inertia = r * Eigen::Matrix3d(one.now.solid->inertia).inverse() * r.transpose();
  }
  for (const Touch& touch : touches_) add_touch_row(touch);
  for (const Bound& bound : bounds_)
    if (bound.rests) add_bound_row(bound);
  for (Tree* tree : trees_) add_ring_rows(*tree);
  load_velocities();
  before_.clear();
  warm_.clear();
  scalars_before_.clear();
  for (contact::Row& row : rows_) {
    const Vector3 a = rate_of(row, true), b = rate_of(row, false);
    warm_.push_back(row.impulse);
    before_.push_back(a);
    before_.push_back(b);
    row.slip[0] = a[1] - b[1];
    row.slip[1] = a[2] - b[2];
  }
  for (const contact::ScalarRow& row : scalars_) scalars_before_.push_back(rate_of(row));
  set_biases(h);
  if (!restitution) return;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Touch& touch = touches_[i];
    const contact::Law& law = laws_[i];
    const bool hits = touch.gap + h * touch.approach < 0;
    // What gravity alone adds in two steps is no impact: resting stacks would hop.
    const double slow = std::max(law.restitution_threshold, 2 * core_.settings.gravity.norm() * h);
    if (hits && touch.approach < -slow) rows_[i].bias = std::max(rows_[i].bias, -law.restitution * touch.approach);
  }
}

void Island::set_biases(double h) {
  for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i].bias = std::min(0.0, -touches_[i].gap / h);
  for (std::size_t i = 0, k = 0; i < bounds_.size(); ++i)
    if (bounds_[i].rests) scalars_[k++].bias = std::min(0.0, -bounds_[i].gap / h);
}

void Island::add_touch_row(const Touch& touch) {
  NearPair& pair = *pairs_[touch.pair];
  contact::Row row;
  Vector3 t1, t2;
  contact::tangents(touch.normal, t1, t2);
  row.axes << touch.normal.transpose(), t1.transpose(), t2.transpose();
  row.static_friction = pair.law.static_friction;
  row.dynamic_friction = pair.law.dynamic_friction;
  row.pair = static_cast<int>(touch.pair);
  const Side sides[2] = {side_of(pair.a), side_of(pair.b)};
  const bool same = sides[0].tree && sides[0].tree == sides[1].tree;
  for (int s = 0; s < 2; ++s) {
    const Side& side = sides[s];
    if (side.mover < 0 || (s == 1 && same)) continue;
    (s == 0 ? row.a : row.b) = side.mover;
    if (!side.tree) {
      (s == 0 ? row.arm_a : row.arm_b) = touch.point - side.center;
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
  for (int k = 0; k < pair.warm_count; ++k) {
    const WarmPoint& warm = pair.warm[static_cast<std::size_t>(k)];
    if (warm.feature != touch.feature) continue;
    row.impulse = row.axes * warm.impulse;
    ++result.counters.warm;
    break;
  }
  ++result.counters.contacts;
  rows_.push_back(row);
  laws_.push_back(pair.law);
}

void Island::add_bound_row(const Bound& bound) {
  const JointEntry& joint = core_.joints[bound.joint];
  Tree& tree = *core_.trees[joint.tree];
  const articulated::Body& body = tree.model.body(joint.link);
  const int n = tree.model.velocities();
  double *j = rows_of(tree, 1), *r = rows_of(tree, 1);
  std::fill(j, j + n, 0.0);
  // Rate of the position by each of the joint's velocities, read off column by column.
  for (int k = 0; k < articulated::velocity_count(body.type); ++k) {
    double unit[3] = {0, 0, 0};
    unit[k] = 1;
    j[body.v + k] =
        bound.sign * joint_velocity(joint.is, joint.flipped, tree.state.q.data() + body.q, unit)[bound.axis];
  }
  respond(tree, j, r);
  contact::ScalarRow row;
  row.a = static_cast<int>(free_.size()) + tree.slot;
  row.ja = j;
  row.ra = r;
  row.hi = JointDrive::kNoLimit;
  scalars_.push_back(row);
  ++result.counters.limits;
}

void Island::add_ring_rows(const Tree& of) {
  Tree& tree = *trees_[static_cast<std::size_t>(of.slot)];
  for (const JointIndex index : tree.rings) {
    const RingRows ring = core_.ring_rows(tree, core_.joints[index].is);
    for (int k = 0; k < ring.count; ++k) {
      const RingRow& wanted = ring.rows[static_cast<std::size_t>(k)];
      const int n = tree.model.velocities();
      double *j = rows_of(tree, 1), *r = rows_of(tree, 1);
      std::fill(j, j + n, 0.0);
      if (ring.child >= 0) fill(tree, ring.child, wanted.on_child, wanted.axis, wanted.angular, 1, j);
      if (ring.parent >= 0) fill(tree, ring.parent, wanted.on_parent, wanted.axis, wanted.angular, -1, j);
      respond(tree, j, r);
      contact::ScalarRow row;
      row.a = static_cast<int>(free_.size()) + tree.slot;
      row.ja = j;
      row.ra = r;
      row.lo = -JointDrive::kNoLimit;
      row.hi = JointDrive::kNoLimit;
      scalars_.push_back(row);
      ring_errors_.push_back(wanted.error);
    }
  }
}

void Island::load_velocities() {
  for (Free& one : free_) {
    for (int k = 0; k < 3; ++k) {
      one.v[k] = one.free_v[k] = one.now.velocity[k];
      one.v[3 + k] = one.free_v[3 + k] = one.now.spin[k];
    }
  }
  for (Tree* tree : trees_) tree->free_v = tree->state.v;
}

void Island::store_velocities(double moved_h) {
  for (Free& one : free_) {
    const Vector3 change(one.v[0] - one.free_v[0], one.v[1] - one.free_v[1], one.v[2] - one.free_v[2]);
    const Vector3 turn(one.v[3] - one.free_v[3], one.v[4] - one.free_v[4], one.v[5] - one.free_v[5]);
    one.now.velocity = Vector3(one.v[0], one.v[1], one.v[2]);
    one.now.spin = Vector3(one.v[3], one.v[4], one.v[5]);
    if (moved_h == 0) continue;
    one.now.center += moved_h * change;
    if (turn != Vector3::Zero()) one.now.orientation = (rotation_by(moved_h * turn) * one.now.orientation).normalized();
  }
  if (moved_h == 0) return;
  for (Tree* tree : trees_) {
    tree->way = moved_h * (tree->state.v - tree->free_v);
    articulated::move(tree->model, tree->state.q, tree->way, tree->state.q);
  }
}

/// Motors, dampers and scripts pushed along the way that smooth motion took; what the rows' impulses added to it, half
/// of the change of velocity for h, is worked along too.
void Island::correct_works(double h) {
  for (const Free& one : free_) {
    for (int k = 0; k < 3; ++k)
      free_work_ +=
          0.5 * h *
          (one.now.force[k] * (one.v[k] - one.free_v[k]) + one.now.torque[k] * (one.v[3 + k] - one.free_v[3 + k]));
  }
  for (Clustered& clustered : clusters_)
    for (const std::uint32_t index : clustered.entry->trees) {
      Tree& tree = *core_.trees[index];
      if (!tree.driven) continue;
      const articulated::Vector &before = tree.sub_state.v, &free = tree.free_v, &after = tree.state.v;
      for (int i = 0; i < tree.model.size(); ++i) {
        const TreeLink& link = tree.links[static_cast<std::size_t>(i)];
        if (link.joint == kNoJoint) continue;
        const articulated::Body& body = tree.model.body(i);
        const double damping = core_.joints[link.joint].drive.damping;
        for (int k = body.v; k < body.v + articulated::velocity_count(body.type); ++k) {
          const double change = 0.5 * (after[k] - free[k]);
          clustered.pending.motor_work += change * tree.motor_impulse[k];
          clustered.pending.drag_loss += change * damping * h * 0.5 * (before[k] + free[k]);
          clustered.pending.script_work += change * h * tree.set_tau[k];
        }
      }
    }
}

void Island::solve() {
  if (rows_.empty() && scalars_.empty()) return;
  contact::SolveSettings settings;
  const int fast = core_.settings.fast_contacts;
  settings.iterations = fast > 0 ? fast : accuracy_.iterations;
  constexpr std::size_t kMostDirect = 100;  // contacts
  settings.direct = accuracy_.direct && fast == 0 && rows_.size() <= kMostDirect;
  const contact::SolveReport report = contact::solve_island(movers_, rows_, scalars_, settings, workspace_);
  result.counters.solver_iterations += static_cast<std::uint64_t>(report.iterations + report.newton);
  result.counters.direct += report.direct;
}

/// Of one side's point along the row's axes, from the movers' v as they are. A tree that touches itself is one side.
Vector3 Island::rate_of(const contact::Row& row, bool first) const {
  const int index = first ? row.a : row.b;
  if (index < 0) return Vector3::Zero();
  const contact::Mover& mover = movers_[static_cast<std::size_t>(index)];
  const double *v = mover.v, *j = first ? row.ja : row.jb;
  if (!j) {
    const Vector3& arm = first ? row.arm_a : row.arm_b;
    return row.axes * (Vector3(v[0], v[1], v[2]) + Vector3(v[3], v[4], v[5]).cross(arm));
  }
  const Eigen::Map<const articulated::Vector> velocity(v, mover.size);
  Vector3 rate;
  for (int k = 0; k < 3; ++k)
    rate[k] = Eigen::Map<const articulated::Vector>(j + k * mover.size, mover.size).dot(velocity);
  return rate;
}

double Island::rate_of(const contact::ScalarRow& row) const {
  const contact::Mover& mover = movers_[static_cast<std::size_t>(row.a)];
  return Eigen::Map<const articulated::Vector>(row.ja, mover.size)
      .dot(Eigen::Map<const articulated::Vector>(mover.v, mover.size));
}

void Island::account_rows() {
  // A contact force that is constant over the sub-step works along the mean of the velocities before and after. Each
  // tree's own account has what left it through the contact, were it into another body.
  const auto tree_at = [this](int mover) {
    const int first = static_cast<int>(free_.size());
    return mover < first ? nullptr : trees_[static_cast<std::size_t>(mover - first)];
  };
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const contact::Row& row = rows_[i];
    if (row.impulse == Vector3::Zero()) continue;
    for (const bool first : {true, false}) {
      const Vector3 mean = (first ? 0.5 : -0.5) * (rate_of(row, first) + before_[2 * i + (first ? 0 : 1)]);
      const double along = row.impulse[0] * mean[0], across = row.impulse[1] * mean[1] + row.impulse[2] * mean[2];
      result.account.contact_loss -= along;
      result.account.friction_loss -= across;
      if (Tree* tree = tree_at(first ? row.a : row.b)) {
        tree->account.contact_loss -= along;
        tree->account.friction_loss -= across;
      }
    }
  }
  const std::size_t limits = scalars_.size() - ring_errors_.size();
  for (std::size_t i = 0; i < limits; ++i) {
    const contact::ScalarRow& row = scalars_[i];
    const double loss = -0.5 * row.impulse * (scalars_before_[i] + rate_of(row));
    result.account.limit_loss += loss;
    tree_at(row.a)->account.limit_loss += loss;
  }
}

/// What contacts and limits did to trees, as forces that last the h seconds of a sub-step, for who asks what joints
/// hold.
void Island::note_forces(double h) {
  for (Tree* tree : trees_) {
    for (TreeLink& link : tree->links) link.contact = {};
    tree->limit_force.setZero();
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (rows_[i].impulse == Vector3::Zero()) continue;
    const NearPair& pair = *pairs_[touches_[i].pair];
    const Vector3 force = rows_[i].axes.transpose() * rows_[i].impulse / h;
    for (const auto& [body, sign] : {std::pair{pair.a, 1.0}, std::pair{pair.b, -1.0}}) {
      const Side side = side_of(body);
      if (!side.tree) continue;
      articulated::Wrench& wrench = side.tree->links[static_cast<std::size_t>(side.link)].contact;
      const Vector3 arm = touches_[i].point - articulated::com_position(side.tree->model, side.tree->data, side.link);
      wrench.force += sign * force;
      wrench.couple += sign * arm.cross(force);
    }
  }
  const std::size_t limits = scalars_.size() - ring_errors_.size();
  for (std::size_t i = 0; i < limits; ++i) {
    Tree& tree = *trees_[static_cast<std::size_t>(scalars_[i].a) - free_.size()];
    tree.limit_force +=
        scalars_[i].impulse / h * Eigen::Map<const articulated::Vector>(scalars_[i].ja, tree.model.velocities());
  }
}

void Island::keep_warm() {
  for (NearPair* pair : pairs_) {
    pair->warm_count = 0;
    pair->touching = false;
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    NearPair& pair = *pairs_[touches_[i].pair];
    const Shape &a = *core_.bodies->collision_shape(pair.a), &b = *core_.bodies->collision_shape(pair.b);
    pair.touching = pair.touching || touches_[i].gap <= kSkin * size_of(a, b) || rows_[i].impulse[0] > 0;
    if (pair.warm_count == static_cast<int>(pair.warm.size()) || rows_[i].impulse == Vector3::Zero()) continue;
    pair.warm[static_cast<std::size_t>(pair.warm_count++)] = {touches_[i].feature,
                                                              rows_[i].axes.transpose() * rows_[i].impulse};
  }
}

}  // namespace breve
