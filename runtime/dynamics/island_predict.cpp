// Forces of contacts and limits that go on. Those that held something in the last two sub-steps act on trees inside the
// stages of smooth motion, as joint forces that do not change on the way: a limb that is pressed on its limit would
// otherwise leave it and come back in each sub-step. The solver, after it, corrects the prediction.
#include <algorithm>

#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/impulse.hpp"
#include "runtime/dynamics/island.hpp"

namespace breve {

namespace {

/// The part of a force that is taken to go on: as much as there was in the last two sub-steps. What stopped something
/// in one of them only is no more.
double steady(double last, double before) { return last > 0 ? std::clamp(before / last, 0.0, 1.0) : 0; }

void add(Tree& tree, const articulated::Vector& j, double force) {
  articulated::Loads& loads = tree.loads;
  if (!loads.reacts) loads.reaction.setZero();
  loads.reacts = true;
  loads.reaction += force * j;
}

}  // namespace

const WarmPoint* Island::warm_of(const Touch& touch) const {
  const NearPair& pair = *pairs_[touch.pair];
  for (int k = 0; k < pair.warm_count; ++k) {
    const WarmPoint& warm = pair.warm[static_cast<std::size_t>(k)];
    if (warm.feature == touch.feature) return &warm;
  }
  return nullptr;
}

/// After find_touches(), find_bounds() and open_books(), for the smooth motion of h seconds that follows.
void Island::predict(double h) {
  predicted_.clear();
  for (Tree* tree : trees_) {
    tree->loads.reacts = false;
    tree->outer_force.setZero();
    tree->outer_couple.setZero();
    tree->row_center = articulated::centre_of_mass(tree->model, tree->data);
  }
  for (const Touch& touch : touches_) {
    const WarmPoint* warm = warm_of(touch);
    const double share = warm ? steady(warm->force.dot(touch.normal), warm->before) : 0;
    predicted_.push_back(share > 0 ? Vector3(share * warm->force) : Vector3::Zero());
    if (share > 0) predict_contact(touch, predicted_.back());
  }
  for (const Bound& bound : bounds_) {
    if (!bound.rests) continue;
    const JointEntry& joint = core_.joints[bound.joint];
    const double last = std::max(0.0, bound.sign * joint.limit[bound.axis]);
    const double force = last * steady(last, bound.sign * joint.limit_before[bound.axis]);
    if (force == 0) continue;
    Tree& tree = *core_.trees[joint.tree];
    fill_limit(tree, joint, bound.axis, bound.sign, tree.work_v.data());
    add(tree, tree.work_v, force);
  }
  if (overpressed(h)) forget_prediction();
}

/// The prediction is far beyond all that moves and falls in h seconds: contacts on several sides of a link press
/// against one another, and parts of that do not balance.
bool Island::overpressed(double h) const {
  constexpr double kMost = 1e6;
  if (!keeps_books_) return false;
  double pressed = 0, mass = 0;
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    const NearPair& pair = *pairs_[touches_[i].pair];
    pressed += (h * predicted_[i]).squaredNorm() * (natural_response(pair.a) + natural_response(pair.b));
  }
  for (const Tree* tree : trees_) mass += tree->model.mass();
  return pressed > kMost * (books_.kinetic + mass * (h * core_.settings.gravity).squaredNorm());
}

void Island::predict_contact(const Touch& touch, const Vector3& force) {
  const NearPair& pair = *pairs_[touch.pair];
  const BodySlot a = slot_of(pair.a), b = slot_of(pair.b);
  const bool inner = a.tree && a.tree == b.tree;
  for (const auto& [side, sign] : {std::pair(&a, 1.0), std::pair(&b, -1.0)}) {
    if (!side->tree || side->mover < 0) continue;
    Tree& tree = *side->tree;
    tree.work_v.setZero();
    fill(tree, side->link, touch.point, force, false, sign, tree.work_v.data());
    add(tree, tree.work_v, 1);
    if (inner) continue;
    tree.outer_force += sign * force;
    tree.outer_couple += (touch.point - tree.row_center).cross(sign * force);
  }
}

/// After smooth motion of h seconds, of which rows were made: velocities as they were without what was predicted, and
/// the impulses at which the solver begins.
void Island::begin_solve(double h) {
  solved_h_ = h;
  load_velocities();
  // It acted along the rows as they lay when the sub-step began: what is taken away is what it gave, so that nothing is
  // left that no row pushes along.
  for (Tree* tree : trees_) {
    if (tree->loads.reacts) tree->free_v -= h * tree->reacted;
  }
  for (contact::Row& row : rows_) row.impulse *= h;
  if (strained())
    for (contact::Row& row : rows_) row.impulse = Vector3::Zero();
  for (contact::ScalarRow& row : scalars_) row.impulse *= h;
  for (Tree* tree : trees_) tree->state.v = tree->free_v;
  set_biases(h);
  bound_motors(h);
}

/// After place(): whether smooth motion of h seconds made of what was predicted motion, or heat in dampers, more than
/// there was, where it should have balanced other forces. What stops something in two sub-steps may be taken for a
/// force that lasts.
bool Island::misled(double h) {
  constexpr double kUnbalanced = 0.25;  // of the energy that the prediction gives by itself
  double alone = 0;
  for (Tree* tree : trees_) {
    if (!tree->loads.reacts) continue;
    articulated::apply_inverse_mass(tree->model, tree->data, tree->loads.reaction, tree->reacted);
    alone += 0.5 * h * h * tree->loads.reaction.dot(tree->reacted);
  }
  books_.predicted = alone;
  if (!keeps_books_ || !(alone > books_.kinetic)) return false;
  double heat = 0;
  for (const Clustered& one : clusters_) heat += std::min(one.held_work, one.pending.drag_loss);
  return std::max(heat, books_.smooth_kinetic - books_.kinetic) > kUnbalanced * alone;
}

/// Contacts on several sides of a link may press against one another as much as they like: no velocity tells. Impulses
/// of the last sub-step that are beyond all that moves and acts are not a good start.
bool Island::strained() const {
  constexpr double kMost = 1e8;  // times: a stack of many bodies with light ones below has some thousands
  if (!keeps_books_) return false;
  double pressed = 0;  // J
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const NearPair& pair = *pairs_[touches_[i].pair];
    pressed += rows_[i].impulse.squaredNorm() * (natural_response(pair.a) + natural_response(pair.b));
  }
  return pressed > kMost * (books_.smooth_kinetic + books_.predicted);
}

void Island::forget_prediction() {
  predicted_.assign(touches_.size(), Vector3::Zero());
  books_.predicted = 0;
  for (Tree* tree : trees_) {
    tree->loads.reacts = false;
    tree->outer_force.setZero();
    tree->outer_couple.setZero();
  }
}

/// Rows where smooth motion of h seconds has led to, where the trees are placed, and their solution.
void Island::solve_after(double h) {
  make_rows(Motors::Drive);
  recall_rates();
  begin_solve(h);
  solve(h);
}

}  // namespace breve
