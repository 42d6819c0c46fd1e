// From contacts, limits, motors and loops to the solver's rows.
#include "runtime/dynamics/island_rows.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/joints.hpp"
#include "runtime/contact/impact_law.hpp"
#include "runtime/dynamics/jacobians.hpp"

namespace breve::island {

Rows::Rows(State& state, Contacts& contacts)
    : state_(state),
      contacts_(contacts),
      movers_(state.memory),
      rows_(state.memory),
      scalars_(state.memory),
      laws_(state.memory),
      before_(state.memory),
      started_(state.memory),
      limits_(state.memory),
      motors_(state.memory),
      loop_errors_(state.memory),
      scalars_before_(state.memory),
      numbers_(state.memory),
      before_force_(state.memory),
      workspace_(state.memory) {}

void Rows::begin() {
  rotated_ = pressed_ = 0;
  movers_.clear();
  for (Free& one : state_.free_bodies) {
    contact::Mover mover;
    mover.v = one.v;
    mover.inverse_mass = 1 / one.now.solid->mass;
    movers_.push_back(mover);
  }
  for (Tree* tree : state_.trees) {
    contact::Mover mover;
    mover.v = tree->state.v.data();
    mover.size = tree->model.velocities();
    movers_.push_back(mover);
  }
}

void Rows::clear() {
  rows_.clear();
  scalars_.clear();
  laws_.clear();
  limits_.clear();
  motors_.clear();
  loop_errors_.clear();
  numbers_.clear();
}

Rows::ContactRow Rows::contact(std::size_t i) {
  Touch& touch = contacts_.touches()[i];
  return {touch, contacts_.pair_of(touch), rows_[i], laws_[i]};
}

double* Rows::numbers_of(const Tree& tree, int count) {
  const auto size = static_cast<std::size_t>(tree.model.velocities() * count);
  const std::size_t at = numbers_.size();
  numbers_.resize(at + size);  // within what was reserved: pointers stay
  return numbers_.data() + at;
}

void Rows::respond(Tree& tree, const double* j, double* r) const {
  const int n = tree.model.velocities();
  tree.work_v = Eigen::Map<const articulated::Vector>(j, n);
  articulated::apply_inverse_mass(tree.model, tree.data, tree.work_v, tree.work_u);
  Eigen::Map<articulated::Vector>(r, n) = tree.work_u;
}

/// The force of a body that a script moves has no bound: others that it presses into a wedge would be thrown out at any
/// speed, or there is no solution. So its rows are soft, by a small part of what the mass of the island would give.
double Rows::yield_of_drivers() const {
  if (state_.drivers == 0) return 0;
  constexpr double kPart = 1e-4, kExactPart = 1e-6;
  const bool exact = state_.accuracy.rung == Rung::Precise || state_.accuracy.rung == Rung::Reference;
  return (exact ? kExactPart : kPart) / state_.mass();
}

void Rows::make(Motors motors) {
  clear();
  yield_ = yield_of_drivers();
  std::size_t widest = 0, loops = 0, driven = 0;
  for (Tree* tree : state_.trees) {
    widest = std::max(widest, static_cast<std::size_t>(tree->model.velocities()));
    loops += tree->loops.size();
    for (const TreeLink& link : tree->links) driven += link.motor;
  }
  const std::size_t touches = contacts_.touches().size(), bounds = contacts_.bounds().size();
  numbers_.reserve(widest * (12 * touches + 2 * bounds + 6 * driven + 12 * loops));
  for (Free& one : state_.loose_bodies()) {
    const Matrix3 r = one.now.orientation.toRotationMatrix();
    contact::Mover& mover = movers_[static_cast<std::size_t>(&one - state_.free_bodies.data())];
    mover.inverse_mass = 1 / one.now.solid->mass;  // a handler may have set another
    mover.inverse_inertia = r * Eigen::Matrix3d(one.now.solid->inertia).inverse() * r.transpose();
  }
  for (Tree* tree : state_.trees) tree->row_center = articulated::centre_of_mass(tree->model, tree->data);
  for (Touch& touch : contacts_.touches()) add_touch(touch);
  for (std::size_t i = 0; i < bounds; ++i)
    if (contacts_.bounds()[i].rests) add_limit(i);
  if (motors == Motors::Drive)
    for (Tree* tree : state_.trees) add_motors(*tree);
  for (Tree* tree : state_.trees) add_loops(*tree);
}

void Rows::make_only(std::size_t bound) {
  clear();
  const JointEntry& joint = state_.core.joints[contacts_.bounds()[bound].joint];
  numbers_.reserve(2 * static_cast<std::size_t>(state_.core.trees[joint.tree]->model.velocities()));
  add_limit(bound);
}

/// Whether a side's body carries the point where it touches: a round one does, and what touches no round one.
bool Rows::carries(const NearPair& pair, bool first) const {
  const BodyIndex body = first ? pair.a : pair.b, other = first ? pair.b : pair.a;
  if (state_.slot_of(body).mover < 0) return false;
  return is_round(state_.shape(body)) || !is_round(state_.shape(other));
}

/// Where one side's body has taken the point that was at `start` as the sub-step began. A link's point goes with the
/// shortest rotation of its axis.
Vector3 Rows::taken(const Touch& touch, bool first) const {
  const NearPair& pair = contacts_.pair_of(touch);
  const BodyIndex body = first ? pair.a : pair.b;
  const Pose &from = first ? touch.from_a : touch.from_b, to = state_.pose_of(body);
  return state_.slot_of(body).tree ? carried_by(state_.shape(body), touch.start, from, to)
                                   : carried_by(state_.shape(body), touch.start, touch.normal, from, to);
}

/// Where two bodies touch once they have moved, and the normal there: a round body's point goes with its centre, a
/// corner's with its body.
Meeting Rows::carried(const Touch& touch) const {
  const NearPair& pair = contacts_.pair_of(touch);
  const bool by_a = carries(pair, true), by_b = carries(pair, false);
  if (by_a != by_b) return {taken(touch, by_a), touch.normal};
  if (!by_a) return {touch.start, touch.normal};
  const Vector3 from_a = taken(touch, true), from_b = taken(touch, false);
  const Shape &a = state_.shape(pair.a), &b = state_.shape(pair.b);
  constexpr double kRolls = 1e-6, kSlides = 1e-3;  // of the smaller body: less is left out
  const double least = (is_round(a) ? kRolls : kSlides) * std::min(a.bounding_radius(), b.bounding_radius());
  const Vector3 apart = from_a - from_b, slip = apart - touch.normal.dot(apart) * touch.normal;
  if (!(slip.squaredNorm() > least * least)) return {0.5 * (from_a + from_b), touch.normal};
  return carried_between({a, state_.pose_of(pair.a), from_a}, {b, state_.pose_of(pair.b), from_b}, touch.normal);
}

/// m, in the last h seconds, of the arm of a free body's point by the body's rotation. One that is a small part of what
/// falls meanwhile counts as none: in a stack that sways, sweeps leave forces that are as wrong.
Vector3 Rows::arm_change(const Touch& touch, bool first, const Free& body, double h) const {
  constexpr double kSlow = 0.1;  // of g h^2
  if (!carries(contacts_.pair_of(touch), first)) return Vector3::Zero();
  const Vector3 change = taken(touch, first) - touch.start - (body.now.center - body.before.center);
  const double least = kSlow * h * h * state_.core.settings.gravity.norm();
  return change.squaredNorm() > least * least ? change : Vector3(Vector3::Zero());
}

/// m, after positions were moved, along the normal as it was; links are placed.
double Rows::gap_now(const Touch& touch) const {
  const NearPair& pair = contacts_.pair_of(touch);
  const bool a_moves = state_.slot_of(pair.a).mover >= 0, b_moves = state_.slot_of(pair.b).mover >= 0;
  const Vector3 a = a_moves ? taken(touch, true) : touch.start;
  const Vector3 b = b_moves ? taken(touch, false) : touch.start;
  return touch.gap + touch.normal.dot(a - b);
}

void Rows::add_touch(Touch& touch) {
  const NearPair& pair = contacts_.pair_of(touch);
  const Meeting now = carried(touch);
  touch.point = now.point;
  contact::Row row;
  Vector3 t1, t2;
  contact::tangents(now.normal, t1, t2);
  row.axes << now.normal.transpose(), t1.transpose(), t2.transpose();
  row.static_friction = pair.law.static_friction;
  row.dynamic_friction = pair.law.dynamic_friction;
  row.pair = static_cast<int>(touch.pair);
  BodySlot sides[2] = {state_.slot_of(pair.a), state_.slot_of(pair.b)};
  for (BodySlot& side : sides)
    if (state_.is_driver(side.mover)) side.mover = state_.pair_drivers[touch.pair];
  const bool same = sides[0].tree && sides[0].tree == sides[1].tree;
  for (int s = 0; s < 2; ++s) {
    const BodySlot& side = sides[s];
    if (side.mover < 0 || (s == 1 && same)) continue;
    (s == 0 ? row.a : row.b) = side.mover;
    if (!side.tree) {
      (s == 0 ? row.arm_a : row.arm_b) = state_.arm_of(side, touch.point);
      continue;
    }
    const int n = side.tree->model.velocities();
    double *j = numbers_of(*side.tree, 3), *r = numbers_of(*side.tree, 3);
    std::fill(j, j + 3 * n, 0.0);
    for (int k = 0; k < 3; ++k) {
      add_point_row(*side.tree, side.link, touch.point, row.axes.row(k), false, 1, j + k * n);
      if (same) add_point_row(*side.tree, sides[1].link, touch.point, row.axes.row(k), false, -1, j + k * n);
      respond(*side.tree, j + k * n, r + k * n);
    }
    (s == 0 ? row.ja : row.jb) = j;
    (s == 0 ? row.ra : row.rb) = r;
  }
  if (state_.is_driver(row.a) || state_.is_driver(row.b)) row.softness = yield_;
  if (const WarmPoint* warm = contacts_.warm_of(touch)) {
    row.impulse = row.axes * warm->force;  // made an impulse where the sub-step's length is known
    ++state_.result.counters.warm;
  }
  ++state_.result.counters.contacts;
  rows_.push_back(row);
  laws_.push_back(pair.law);
  if (contacts_.rebound_of(touch).stays) laws_.back().restitution = laws_.back().tangential_restitution = 0;
}

/// A row of one number of a tree's motion.
contact::ScalarRow Rows::tree_row(const Tree& tree, const double* j, const double* r) const {
  contact::ScalarRow row;
  row.a = state_.mover_of(tree);
  row.ja = j;
  row.ra = r;
  return row;
}

void Rows::add_limit(std::size_t index) {
  const Bound& bound = contacts_.bounds()[index];
  const JointEntry& joint = state_.core.joints[bound.joint];
  Tree& tree = *state_.core.trees[joint.tree];
  double *j = numbers_of(tree, 1), *r = numbers_of(tree, 1);
  fill_limit_row(tree, joint, bound.axis, bound.sign, j);
  respond(tree, j, r);
  contact::ScalarRow row = tree_row(tree, j, r);
  row.hi = JointDrive::kNoLimit;
  row.impulse = std::max(0.0, bound.sign * joint.limit[bound.axis]);
  scalars_.push_back(row);
  limits_.push_back(index);
  ++state_.result.counters.limits;
}

/// Each axis of a universal joint has a motor with the joint's strength; the three of a ball joint share one.
void Rows::add_motors(Tree& tree) {
  const int n = tree.model.velocities();
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const TreeLink& link = tree.links[i];
    if (!link.motor) continue;
    const articulated::Body& body = tree.model.body(static_cast<int>(i));
    const JointEntry& joint = state_.core.joints[link.joint];
    const int count = articulated::velocity_count(body.type);
    const bool ball = body.type == articulated::JointType::Ball;
    for (int k = 0; k < count; ++k) {
      double *j = numbers_of(tree, 1), *r = numbers_of(tree, 1);
      std::fill(j, j + n, 0.0);
      j[body.v + k] = 1;
      respond(tree, j, r);
      contact::ScalarRow row = tree_row(tree, j, r);
      row.impulse = joint.motor[k];
      scalars_.push_back(row);
      motors_.push_back({&tree, link.joint, k, body.v + k, !ball ? 1 : k == 0 ? count : 0, joint.drive.strength_limit});
    }
  }
}

void Rows::add_loops(Tree& tree) {
  for (const JointIndex index : tree.loops) {
    const LoopRows loop = state_.core.loop_rows(tree, state_.core.joints[index].is);
    for (int k = 0; k < loop.count; ++k) {
      const LoopRow& wanted = loop.rows[static_cast<std::size_t>(k)];
      double *j = numbers_of(tree, 1), *r = numbers_of(tree, 1);
      fill_loop_row(tree, loop, wanted, j);
      respond(tree, j, r);
      contact::ScalarRow row = tree_row(tree, j, r);
      row.lo = -JointDrive::kNoLimit;
      row.hi = JointDrive::kNoLimit;
      scalars_.push_back(row);
      loop_errors_.push_back({wanted.error, wanted.angular ? 1 : state_.unit()});
    }
  }
}

}  // namespace breve::island
