// Forces of contacts, limits and motors that go on.
#include "runtime/dynamics/island_predict.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/joints.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/island_energy.hpp"
#include "runtime/dynamics/jacobians.hpp"
#include "runtime/dynamics/joint_reader.hpp"

namespace breve::island {

namespace {

/// The part of a force that is taken to go on: as much as there was in the last two sub-steps. What stopped something
/// in one of them only is no more.
double steady(double last, double before) { return last > 0 ? std::clamp(before / last, 0.0, 1.0) : 0; }

template <class Row>
void add(Tree& tree, const Row& j, double force) {
  articulated::Loads& loads = tree.loads;
  if (!loads.reacts) loads.reaction.setZero();
  loads.reacts = true;
  loads.reaction += force * j;
}

/// Contacts act on its links inside the stages no more.
void release(Tree& tree) {
  tree.braced = false;
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    TreeLink& link = tree.links[i];
    link.predicted = {};
    tree.loads.wrenches[i] = {link.torque, link.force};
  }
}

/// A force on a link of a tree that something outside holds, or on one that hangs on far lighter links, acts by the
/// arms that the link's joints have at each stage. As a constant force of the joints it would not go on balancing
/// gravity, or what pulls at the same link, once light links between it and the root rotate.
void brace(Tree& tree, int link, const Vector3& force, const Vector3& point) {
  articulated::Wrench& wrench = tree.links[static_cast<std::size_t>(link)].predicted;
  wrench.force += force;
  wrench.couple += (point - articulated::com_position(tree.model, tree.data, link)).cross(force);
  tree.braced = true;
}

/// Adds to `j` (nv) what these wrenches are at the joints, where the links are placed.
void add_braces(const Tree& tree, articulated::Vector& j) {
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const articulated::Wrench& wrench = tree.links[i].predicted;
    const int link = static_cast<int>(i);
    if (wrench.force == Vector3::Zero() && wrench.couple == Vector3::Zero()) continue;
    const Vector3 center = articulated::com_position(tree.model, tree.data, link);
    add_point_row(tree, link, center, wrench.force, false, 1, j.data());
    add_point_row(tree, link, center, wrench.couple, true, 1, j.data());
  }
}

}  // namespace

void Prediction::make(double h) {
  clear();
  for (Tree* tree : state_.trees) tree->row_center = articulated::centre_of_mass(tree->model, tree->data);
  for (Touch& touch : contacts_.touches()) {
    const WarmPoint* warm = contacts_.warm_of(touch);
    const double share = warm ? steady(warm->force.dot(touch.normal), warm->before) : 0;
    touch.predicted = share > 0 ? Vector3(share * warm->force) : Vector3::Zero();
    if (share > 0) add_contact(touch);
  }
  add_joints();
  if (overpressed(h)) forget();
}

void Prediction::clear() {
  for (Tree* tree : state_.trees) {
    tree->loads.reacts = false;
    if (tree->braced) release(*tree);
    tree->outer_force.setZero();
    tree->outer_couple.setZero();
  }
}

/// Limits and motors.
void Prediction::add_joints() {
  for (const Bound& bound : contacts_.bounds()) {
    if (!bound.rests) continue;
    const JointEntry& joint = state_.core.joints[bound.joint];
    const double last = std::max(0.0, bound.sign * joint.limit[bound.axis]);
    add_limit(bound, last * steady(last, bound.sign * joint.limit_before[bound.axis]));
  }
  add_motors();
}

void Prediction::add_limit(const Bound& bound, double force) {
  if (force == 0) return;
  const JointEntry& joint = state_.core.joints[bound.joint];
  Tree& tree = *state_.core.trees[joint.tree];
  fill_limit_row(tree, joint, bound.axis, bound.sign, tree.work_v.data());
  add(tree, tree.work_v, force);
}

void Prediction::add_motors() {
  for (Tree* tree : state_.trees)
    if (!tree->loops.empty()) add_motors(*tree);
}

/// Motors of a tree with closed loops have no drives in the stages: there the force of the last sub-step goes on, so
/// that the loop's forces answer it along the way.
void Prediction::add_motors(Tree& tree) {
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const TreeLink& link = tree.links[i];
    if (!link.motor) continue;
    const articulated::Body& body = tree.model.body(static_cast<int>(i));
    const JointEntry& joint = state_.core.joints[link.joint];
    const double most = joint.drive.strength_limit;
    for (int k = 0; k < articulated::velocity_count(body.type); ++k) {
      const double force = std::clamp(joint.motor[k], -most, most);
      if (force == 0) continue;
      tree.work_v.setZero();
      tree.work_v[body.v + k] = 1;
      add(tree, tree.work_v, force);
    }
  }
}

/// The prediction is far beyond all that moves and falls, or that scripts push, in h seconds: contacts on several sides
/// of a link press against one another, and parts of that do not balance. What force methods will push is not known.
bool Prediction::overpressed(double h) const {
  constexpr double kMost = 1e6;
  const auto asked = [](const Clustered& one) { return one.entry->asked; };
  if (!books_.kept() || std::any_of(state_.clusters.begin(), state_.clusters.end(), asked)) return false;
  double pressed = 0, mass = 0;
  for (const Touch& touch : contacts_.touches()) {
    const NearPair& pair = contacts_.pair_of(touch);
    pressed +=
        (h * touch.predicted).squaredNorm() * (state_.natural_response(pair.a) + state_.natural_response(pair.b));
  }
  double pushed = 0;
  for (const Tree* tree : state_.trees) {
    mass += tree->model.mass();
    if (!tree->pushed) continue;
    for (const TreeLink& link : tree->links) pushed += (h * link.force).squaredNorm() / link.solid.mass;
  }
  const double falls = mass * (h * state_.core.settings.gravity).squaredNorm();
  return pressed > kMost * (books_.kinetic() + falls + pushed);
}

void Prediction::add_contact(const Touch& touch) {
  const Vector3& force = touch.predicted;
  const NearPair& pair = contacts_.pair_of(touch);
  const BodySlot a = state_.slot_of(pair.a), b = state_.slot_of(pair.b);
  const bool inner = a.tree && a.tree == b.tree;
  for (const auto& [side, sign] : {std::pair(&a, 1.0), std::pair(&b, -1.0)}) {
    if (!side->tree || side->mover < 0) continue;
    Tree& tree = *side->tree;
    if (!tree.loose || (!inner && tree.links[static_cast<std::size_t>(side->link)].behind_light)) {
      brace(tree, side->link, sign * force, touch.point);
    } else {
      tree.work_v.setZero();
      add_point_row(tree, side->link, touch.point, force, false, sign, tree.work_v.data());
      add(tree, tree.work_v, 1);
    }
    if (inner || !tree.loose) continue;
    tree.outer_force += sign * force;
    tree.outer_couple += (touch.point - tree.row_center).cross(sign * force);
  }
}

/// After place(): whether links on which forces were predicted rotate so far in h seconds that the forces do not act
/// along the rows that are solved as the sub-step ends.
bool Prediction::rotated_away(double h) const {
  constexpr double kFar = 0.25;  // rad
  return std::any_of(contacts_.touches().begin(), contacts_.touches().end(), [this, h](const Touch& touch) {
    if (touch.predicted == Vector3::Zero()) return false;
    const NearPair& pair = contacts_.pair_of(touch);
    return rotates(pair.a, kFar / h) || rotates(pair.b, kFar / h);
  });
}

/// A link that rotates faster than that, rad/s.
bool Prediction::rotates(BodyIndex body, double rate) const {
  const BodySlot side = state_.slot_of(body);
  return side.tree && side.mover >= 0 && articulated::spin(side.tree->data, side.link).squaredNorm() > rate * rate;
}

/// After place(): whether smooth motion of h seconds made of what was predicted motion, or heat in dampers, more than
/// there was, where it should have balanced other forces. What stops something in two sub-steps may be taken for a
/// force that lasts.
bool Prediction::misled(double h) {
  constexpr double kUnbalanced = 0.25;  // of the energy that the prediction gives by itself
  double alone = 0;
  for (Tree* tree : state_.trees) {
    if (!tree->loads.reacts && !tree->braced) continue;
    tree->work_w.setZero(tree->model.velocities());
    if (tree->loads.reacts) tree->work_w = tree->loads.reaction;
    if (tree->braced) add_braces(*tree, tree->work_w);
    articulated::apply_inverse_mass(tree->model, tree->data, tree->work_w, tree->reacted);
    alone += 0.5 * h * h * tree->work_w.dot(tree->reacted);
  }
  books_.set_predicted(alone);
  if (!books_.kept()) return false;
  if (rotated_away(h)) return true;
  if (!(alone > books_.kinetic())) return false;
  double heat = 0;
  for (const Clustered& one : state_.clusters) heat += std::min(one.held_work, one.pending.drag_loss);
  return std::max(heat, books_.smooth_kinetic() - books_.kinetic()) > kUnbalanced * alone;
}

/// After the rows: whether the solution moves trees far more than before, although the prediction was to balance what
/// acts on them. The rows begin without the effect of the prediction, and cannot take away what it did along the way of
/// links that have moved far from where it was made. Motors may do what they do, and a contact that opens frees what
/// scripts' forces pressed against it.
bool Prediction::threw() const {
  constexpr double kThrown = 0.02, kDriven = 0.25;  // of the energy that the prediction gives by itself
  if (!books_.kept() || !(books_.predicted() > books_.kinetic())) return false;
  bool faster = false, driven = false;
  for (Tree* tree : state_.trees) {
    const double now = tree->state.v.squaredNorm();
    driven = driven || tree->driven || tree->pushed;
    faster = faster || now > std::max(tree->sub_state.v.squaredNorm(), tree->smooth_v.squaredNorm());
  }
  if (!faster) return false;
  double moved = motion_of_trees(state_);
  for (std::size_t i = 0; i < rows_.motors(); ++i) {
    const auto& [motor, row] = rows_.motor(i);
    moved -= std::abs(row.impulse) * (std::abs(rows_.rate_of(row)) + std::abs(motor.tree->sub_state.v[motor.velocity]));
  }
  return moved > books_.smooth_kinetic() + (driven ? kDriven : kThrown) * books_.predicted();
}

/// After smooth motion of h seconds: whether a joint that stands at its limit swung so far beyond it that what was
/// predicted there is not the force that holds it: nothing is, when the joint has just come to stand there. What rows
/// change moves it back, to second order; where impacts are not located, that is all there is for a joint that arrives
/// fast, and the way of the speed at which it came says nothing of forces.
bool Prediction::limits_swing(double h) const {
  constexpr double kFar = 0.02, kFarUnlocated = 0.1;  // rad, or the world's length unit
  const bool located = state_.accuracy.locate_impacts;
  const double far = located ? kFar : kFarUnlocated, arrives = located ? 0 : h;
  JointReader joints(state_.core);
  return std::any_of(contacts_.bounds().begin(), contacts_.bounds().end(), [&](const Bound& bound) {
    if (!bound.rests || bound.held) return false;
    const double gap = bound.sign * (joints.position(bound.joint)[bound.axis] - bound.limit);
    return gap < std::min(bound.gap, 0.0) + arrives * std::min(bound.rate, 0.0) - far * bound.unit;
  });
}

/// After the rows: whether links of a loop that no stage holds swung apart, at the rate that the rows stopped. Where
/// they hardly do, near a pose in which the loop may fold either way, a force that does not change would cost energy.
bool Prediction::loops_swing(double h) const {
  constexpr double kFar = 0.02;  // rad, or the world's length unit
  for (std::size_t k = 0; k < rows_.loops(); ++k) {
    const contact::ScalarRow& row = rows_.loop(k);
    if (0.5 * h * std::abs(row.impulse) * rows_.response(row) > kFar * rows_.loop_error(k).unit) return true;
  }
  return false;
}

/// After the rows of a try of the sub-step of h seconds, back where it began: limits push in the next try as they did
/// in this one.
/// @param loops  so do loops, which no stage holds; else their links would swing apart and be drawn together each time
void Prediction::learn(double h, bool loops) {
  clear();
  for (const Touch& touch : contacts_.touches())
    if (touch.predicted != Vector3::Zero()) add_contact(touch);
  for (std::size_t i = 0; i < rows_.limits(); ++i) {
    const auto& [bound, row] = rows_.limit(i);
    add_limit(bound, row.impulse / h);
  }
  for (std::size_t k = 0; loops && k < rows_.loops(); ++k) add_loop(rows_.loop(k), h);
  add_motors();
}

void Prediction::add_loop(const contact::ScalarRow& row, double h) {
  Tree& tree = *state_.tree_of(row.a);  // a loop is within one tree
  add(tree, Eigen::Map<const articulated::Vector>(row.ja, tree.model.velocities()), row.impulse / h);
}

/// Contacts on several sides of a link may press against one another as much as they like: no velocity tells. Impulses
/// of the last sub-step that are beyond all that moves and acts are not a good start.
bool Prediction::strained() const {
  constexpr double kMost = 1e8;  // times: a stack of many bodies with light ones below has some thousands
  if (!books_.kept()) return false;
  double pressed = 0;  // J
  for (const contact::Row& row : rows_.rows()) {
    const NearPair& pair = rows_.pair_of(row);
    pressed += row.impulse.squaredNorm() * (state_.natural_response(pair.a) + state_.natural_response(pair.b));
  }
  return pressed > kMost * (books_.smooth_kinetic() + books_.predicted());
}

void Prediction::forget() {
  for (Touch& touch : contacts_.touches()) touch.predicted = Vector3::Zero();
  books_.set_predicted(0);
  clear();
}

/// All but limits and motors: a joint that a spring presses on its limit would swing far beyond it without.
void Prediction::forget_contacts() {
  forget();
  add_joints();
}

}  // namespace breve::island
