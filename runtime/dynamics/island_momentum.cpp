// Momentum of trees that nothing outside holds. Joint coordinates do not know of it: an integrator keeps it to its own
// order, and impulses between links, applied where the links stood a moment ago, do not quite cancel. So after each
// piece of motion the tree is moved, as one rigid body, to the centre of mass and the momenta that outer impulses and
// gravity give it.
#include <algorithm>
#include <cmath>

#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/island.hpp"

namespace breve {

namespace {

using articulated::Whole;

/// Moves trees together, which stand where their data say and are `now`, to what is wanted.
void impose(std::span<Tree* const> trees, const Whole& now, const Whole& wanted) {
  articulated::Symmetric3 inverse;
  Vector3 spin = Vector3::Zero();
  // Bodies on one line turn about it by no momentum.
  if (articulated::invert(now.inertia, inverse)) spin = inverse * Vector3(wanted.spin - now.spin);
  const Vector3 way = wanted.center - now.center, velocity = (wanted.momentum - now.momentum) / now.mass;
  for (Tree* tree : trees)
    articulated::move_whole(tree->model, tree->data, way, velocity, spin, now.center, tree->state);
}

Whole measure(std::span<Tree* const> trees) {
  Whole sum;
  for (Tree* tree : trees) {
    articulated::forward_kinematics(tree->model, tree->data, tree->state);
    const Whole one = articulated::measure_whole(tree->model, tree->data);
    if (tree == trees.front())
      sum = one;
    else
      sum.add(one);
  }
  return sum;
}

/// What trees have in common that nothing outside holds: the motion of one rigid body with their momenta. Of others
/// nothing.
struct Common {
  Vector3 center = Vector3::Zero(), velocity = Vector3::Zero(), spin = Vector3::Zero();
  double energy = 0;  // J, of that motion
  double inner = 0;   // J, of the links among one another
};

/// @param held  something outside may hold them
Common common_of(std::span<Tree* const> trees, bool held = false) {
  Common common;
  const Whole whole = measure(trees);
  for (const Tree* tree : trees) common.inner += articulated::kinetic_energy(tree->model, tree->data);
  if (held || !std::all_of(trees.begin(), trees.end(), [](const Tree* tree) { return tree->loose; })) return common;
  articulated::Symmetric3 inverse;
  if (articulated::invert(whole.inertia, inverse)) common.spin = inverse * whole.spin;
  common.center = whole.center;
  common.velocity = whole.momentum / whole.mass;
  common.energy = 0.5 * (whole.momentum.dot(common.velocity) + whole.spin.dot(common.spin));
  if (!std::isfinite(common.energy)) return {Vector3::Zero(), Vector3::Zero(), Vector3::Zero(), 0, common.inner};
  common.inner -= common.energy;
  return common;
}

/// The same with the momenta that the trees had when the step began, and what gravity gave them since.
/// @param fall  m/s, by gravity
Common started_with(std::span<Tree* const> trees, const Vector3& fall) {
  for (Tree* tree : trees) std::swap(tree->state, tree->step_state);
  const Whole then = measure(trees);
  for (Tree* tree : trees) std::swap(tree->state, tree->step_state);
  Common common = common_of(trees, true);
  const Whole now = measure(trees);
  articulated::Symmetric3 inverse;
  if (articulated::invert(now.inertia, inverse)) common.spin = inverse * then.spin;
  common.center = now.center;
  common.velocity = then.momentum / now.mass + fall;
  common.energy = 0.5 * (now.mass * common.velocity.squaredNorm() + then.spin.dot(common.spin));
  common.inner -= common.energy;
  return common;
}

/// Turns trees that stand still among one another as one rigid body for h seconds, with the momenta that they have, by
/// the midpoint rule: with the spin that the same angular momentum gives half-way.
void rotate_freely(std::span<Tree* const> trees, const Whole& kept, double h) {
  constexpr double kRotation = 0.01, kMostParts = 100;  // rad in a part
  const double rotation = h * common_of(trees).spin.norm();
  const double parts = std::clamp(std::ceil(rotation / kRotation), 1.0, kMostParts), part = h / parts;
  const auto move = [trees](double time) {
    for (Tree* tree : trees) {
      tree->way = time * tree->state.v;
      articulated::move(tree->model, tree->state.q, tree->way, tree->state.q);
    }
  };
  // A place in the middle of which only the velocities are kept.
  const auto settle = [trees, &kept] {
    const Whole now = measure(trees);
    Whole wanted = kept;
    wanted.center = now.center;
    impose(trees, now, wanted);
  };
  for (int i = 0; i < static_cast<int>(parts); ++i) {
    for (Tree* tree : trees) tree->part_state.q = tree->state.q;
    move(0.5 * part);
    settle();
    for (Tree* tree : trees) tree->state.q = tree->part_state.q;
    move(part);
    settle();
  }
}

/// Velocities of the links among one another times `scale`; trees stand where their data say.
void shorten_inner(std::span<Tree* const> trees, const Common& common, double scale) {
  for (Tree* tree : trees) {
    tree->way = tree->state.v;
    tree->state.v.setZero();
    if (common.energy > 0)
      articulated::move_whole(tree->model, tree->data, Vector3::Zero(), common.velocity, common.spin, common.center,
                              tree->state);
    if (scale > 0) tree->state.v += scale * (tree->way - tree->state.v);
  }
}

}  // namespace

/// Nothing but contacts and gravity acts on it from outside.
bool Island::loose(const Clustered& one) const {
  for (const std::uint32_t index : one.entry->trees) {
    const Tree& tree = *core_.trees[index];
    if (!tree.loose || tree.pushed) return false;
    for (const TreeLink& link : tree.links)
      if (core_.find(link.body)->force_method) return false;
  }
  for (const SpringIndex spring : one.entry->springs) {
    const SpringDescription& is = core_.springs[spring].is;
    for (const BodyIndex body : {is.a, is.b}) {
      const BodyEntry* known = core_.find(body);
      if (!known || known->tree == kNone) return false;
    }
  }
  return true;
}

/// One piece of smooth motion of h seconds, after which a cluster that nothing holds has the momenta it had, and what
/// gravity gave it.
void Island::smooth_whole(Clustered& one, double time, double h) {
  if (!one.loose) return smooth_once(one, time, h);
  const std::span trees = one.entry->system->trees();
  Whole wanted = measure(trees);
  Vector3 force = Vector3::Zero();
  for (const Tree* tree : trees) {
    force += tree->outer_force;
    wanted.spin += h * (tree->outer_couple + (tree->row_center - wanted.center).cross(tree->outer_force));
  }
  const Vector3& gravity = core_.settings.gravity;
  force += wanted.mass * gravity;
  wanted.center += h / wanted.mass * (wanted.momentum + 0.5 * h * force);
  wanted.momentum += h * force;
  smooth_once(one, time, h);
  impose(trees, measure(trees), wanted);
}

/// Takes from the motion of a cluster's links among one another what a step gained that nothing explains, or gives it
/// back: momenta and loops stay as they are, since all their velocities are shortened alike.
/// Source: Hairer, Lubich and Wanner 2006, IV.4 (projection to the energy).
/// @param gain  J
/// @return  false if that is more than a small part of that motion's energy: nothing was changed
bool Island::take_back(Clustered& one, double gain) {
  const std::span trees = one.entry->system->trees();
  const Common common = common_of(trees);
  if (!(std::abs(gain) <= kFew * common.inner)) return false;
  shorten_inner(trees, common, std::sqrt(1 - gain / common.inner));
  return true;
}

/// The same where no finer step would help: whatever it is, down to links at rest among one another.
void Island::take_back_most(Clustered& one, double gain) {
  if (!(gain > 0)) return;
  const std::span trees = one.entry->system->trees();
  const Common common = common_of(trees);
  if (common.inner > 0) shorten_inner(trees, common, std::sqrt(std::max(0.0, 1 - gain / common.inner)));
}

/// Something that nothing moves touches what is in the island, or did in this step: momenta are not kept then.
bool Island::touched_from_outside() const {
  const auto holds = [this](BodyIndex body) {
    const int mover = slot_of(body).mover;
    return mover < 0 || is_driver(mover);
  };
  return touched_ || std::any_of(rows_.begin(), rows_.end(), [&](const contact::Row& row) {
           const NearPair& pair = *pairs_[static_cast<std::size_t>(row.pair)];
           return holds(pair.a) || holds(pair.b);
         });
}

/// Energy that take_from_all() may take, J: of links among one another; where something outside touches, momenta are
/// not kept, and it is all that trees have.
double Island::moving() const {
  const bool held = touched_from_outside();
  double sum = 0;
  for (const Clustered& one : clusters_) sum += common_of(one.entry->system->trees(), held).inner;
  return sum;
}

/// Takes a part of moving(), which contacts and limits gave: it is booked as taken by them. Bodies at rest stay at
/// rest.
void Island::take_from_all(double part) {
  if (!(part > 0)) return;
  const bool held = touched_from_outside();
  for (Clustered& one : clusters_) {
    const std::span trees = one.entry->system->trees();
    const Common common = common_of(trees, held);
    shorten_inner(trees, common, std::sqrt(1 - part));
    result.ledger.contact_loss += part * common.inner;
    if (one.alone()) trees.front()->ledger.contact_loss += part * common.inner;
  }
  placed_ = booked_ = false;
}

/// Ends the motion of a cluster's links among one another, and all of it if something may hold the cluster from
/// outside or its momenta are not kept.
/// @param h  s, since the step began
/// @return   J, that this took
double Island::stop_links(Clustered& one, Momenta momenta, double h) {
  const std::span trees = one.entry->system->trees();
  const bool taken = momenta == Momenta::Take || !one.loose || touched_from_outside();
  const Common common = taken ? common_of(trees, true) : started_with(trees, h * core_.settings.gravity);
  shorten_inner(trees, common, 0);
  return common.inner;
}

/// Clusters whose links stand still among one another, and which nothing holds or touches, go on as rigid bodies for h
/// seconds: their centres of mass stay on their way.
void Island::coast(double h) {
  if (touched_from_outside()) return;
  for (Clustered& one : clusters_) {
    if (!one.loose) continue;
    const std::span trees = one.entry->system->trees();
    const Vector3 fall = h * core_.settings.gravity;
    double kinetic = 0;
    const double before = stored_in(one, kinetic);
    Whole wanted = measure(trees);
    rotate_freely(trees, wanted, h);
    wanted.center += h * (wanted.momentum / wanted.mass + 0.5 * fall);
    wanted.momentum += wanted.mass * fall;
    impose(trees, measure(trees), wanted);
    const double more = stored_in(one, kinetic) - before;
    result.ledger.residual += more;
    if (one.alone()) trees.front()->ledger.residual += more;
  }
  placed_ = booked_ = false;
}

/// Each tree as it moves with one of the velocities that are kept for it.
/// @param now  that of its state
void Island::note_wholes(articulated::Vector Tree::*velocity, bool now) {
  for (Tree* tree : trees_) {
    if (!tree->loose) continue;
    if (!now) std::swap(tree->state.v, tree->*velocity);
    Tree* const one[] = {tree};
    tree->whole = measure(one);
    if (!now) std::swap(tree->state.v, tree->*velocity);
  }
}

/// Links of one tree press against each other: of large impulses that cancel, round-off is left.
bool Island::pushes_itself() const {
  return std::any_of(rows_.begin(), rows_.end(), [this](const contact::Row& row) {
    const NearPair& pair = *pairs_[static_cast<std::size_t>(row.pair)];
    const Tree* tree = slot_of(pair.a).tree;
    return tree && tree->loose && tree == slot_of(pair.b).tree && row.impulse != Vector3::Zero();
  });
}

/// What the rows' impulses, or those of pushing overlap apart, give each tree from outside.
/// @param moved_h  s, for which positions move by the change of velocity
/// @param given    by what: by impulses that were not predicted; by those of impacts; by all of the sub-step and
///                 gravity, but no velocity; by those that push overlap apart, likewise
void Island::keep_wholes(double moved_h, Given given) {
  outer_.assign(trees_.size(), {});
  const auto add = [this](int mover, const Vector3& impulse, const Vector3& point) {
    if (mover < static_cast<int>(free_.size())) return;
    const std::size_t slot = static_cast<std::size_t>(mover) - free_.size();
    outer_[slot].linear += impulse;
    outer_[slot].angular += (point - trees_[slot]->row_center).cross(impulse);
  };
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const contact::Row& row = rows_[i];
    const BodySlot a = slot_of(pairs_[touches_[i].pair]->a), b = slot_of(pairs_[touches_[i].pair]->b);
    if (a.tree && a.tree == b.tree) continue;
    // The predicted part has moved the tree already.
    Vector3 impulse = row.axes.transpose() * row.impulse;
    if (given == Given::All) impulse -= solved_h_ * predicted_[i];
    if (given == Given::Pushes) impulse = row.axes.transpose() * Vector3(pushes_[i].impulse, 0, 0);
    add(row.a, impulse, touches_[i].point);
    add(row.b, -impulse, touches_[i].point);
  }
  for (std::size_t i = 0; i < trees_.size(); ++i) {
    Tree* const one[] = {trees_[i]};
    if (!one[0]->loose) continue;
    Whole wanted = one[0]->whole;
    if (given == Given::Places && !struck_[free_.size() + i]) continue;
    if (given == Given::Places) outer_[i].linear += solved_h_ * wanted.mass * core_.settings.gravity;
    wanted.center += moved_h / wanted.mass * outer_[i].linear;
    if (given == Given::All || given == Given::Impacts) {
      wanted.momentum += outer_[i].linear;
      wanted.spin += outer_[i].angular;
    }
    impose(one, measure(one), wanted);
  }
}

}  // namespace breve
