// Momenta that trees keep, and motion that is taken from them.
#include "runtime/dynamics/island_momentum.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/dynamics/common_motion.hpp"
#include "runtime/dynamics/island_energy.hpp"

namespace breve::island {

Momentum::Momentum(State& state, Rows& rows) : state_(state), rows_(rows), outer_(state.memory) {}

/// Something that nothing moves touches what is in the island, or did in this step: momenta are not kept then.
bool Momentum::touched_from_outside() const {
  const auto holds = [this](BodyIndex body) {
    const int mover = state_.slot_of(body).mover;
    return mover < 0 || state_.is_driver(mover);
  };
  const std::span rows = std::as_const(rows_).rows();
  return touched_ || std::any_of(rows.begin(), rows.end(), [&](const contact::Row& row) {
           const NearPair& pair = rows_.pair_of(row);
           return holds(pair.a) || holds(pair.b);
         });
}

void Momentum::note(articulated::Vector Tree::*velocity, bool now) {
  for (Tree* tree : state_.trees) {
    if (!tree->loose) continue;
    if (!now) std::swap(tree->state.v, tree->*velocity);
    Tree* const one[] = {tree};
    tree->whole = measure(one);
    if (!now) std::swap(tree->state.v, tree->*velocity);
  }
}

/// Sums for each tree the impulses of contacts that push it from outside.
/// @param impulse_of  of a contact row, on its first side, in world axes
template <class Impulse>
void Momentum::sum_outer(const Impulse& impulse_of) {
  outer_.assign(state_.trees.size(), {});
  const auto add = [this](int mover, const Vector3& impulse, const Vector3& point) {
    const Tree* tree = state_.tree_of(mover);
    if (!tree) return;
    Outer& outer = outer_[static_cast<std::size_t>(tree->slot)];
    outer.linear += impulse;
    outer.angular += (point - tree->row_center).cross(impulse);
  };
  for (std::size_t i = 0; i < rows_.contacts(); ++i) {
    const auto& [touch, pair, row, law] = rows_.contact(i);
    const BodySlot a = state_.slot_of(pair.a), b = state_.slot_of(pair.b);
    if (a.tree && a.tree == b.tree) continue;
    const Vector3 impulse = impulse_of(i);
    add(row.a, impulse, touch.point);
    add(row.b, -impulse, touch.point);
  }
}

/// Moves a tree by the impulse that was summed for it.
void Momentum::give(std::size_t tree, double moved_h, Velocities velocities) {
  Tree* const one[] = {state_.trees[tree]};
  const Outer& outer = outer_[tree];
  articulated::Whole wanted = one[0]->whole;
  wanted.center += moved_h / wanted.mass * outer.linear;
  if (velocities == Velocities::Change) {
    wanted.momentum += outer.linear;
    wanted.spin += outer.angular;
  }
  impose(one, measure(one), wanted);
}

void Momentum::give_impulses(double moved_h) {
  sum_outer([this](std::size_t i) {
    const auto& [touch, pair, row, law] = rows_.contact(i);
    // The predicted part has moved the tree already.
    return Vector3(row.axes.transpose() * row.impulse - rows_.length() * touch.predicted);
  });
  for (std::size_t i = 0; i < state_.trees.size(); ++i)
    if (state_.trees[i]->loose) give(i, state_.trees[i]->row_share * moved_h, Velocities::Change);
}

void Momentum::give_impacts() {
  sum_outer([this](std::size_t i) {
    const contact::Row& row = rows_.contact(i).row;
    return Vector3(row.axes.transpose() * row.impulse);
  });
  for (std::size_t i = 0; i < state_.trees.size(); ++i)
    if (state_.trees[i]->loose) give(i, 0, Velocities::Change);
}

void Momentum::give_positions(double moved_h, std::span<const std::uint8_t> movers) {
  sum_outer([this](std::size_t i) {
    const contact::Row& row = rows_.contact(i).row;
    return Vector3(row.axes.transpose() * row.impulse);
  });
  for (std::size_t i = 0; i < state_.trees.size(); ++i) {
    const Tree& tree = *state_.trees[i];
    if (!tree.loose || !movers[static_cast<std::size_t>(state_.mover_of(tree))]) continue;
    outer_[i].linear += rows_.length() * tree.whole.mass * state_.core.settings.gravity;
    give(i, moved_h, Velocities::Stay);
  }
}

void Momentum::give_pushes(double moved_h, std::span<const contact::Push> pushes) {
  sum_outer([this, pushes](std::size_t i) {
    return Vector3(rows_.contact(i).row.axes.transpose() * Vector3(pushes[i].impulse, 0, 0));
  });
  for (std::size_t i = 0; i < state_.trees.size(); ++i)
    if (state_.trees[i]->loose) give(i, moved_h, Velocities::Stay);
}

/// Links of one tree press against each other: of large impulses that cancel, round-off is left.
bool Momentum::pushes_itself() const {
  const std::span rows = std::as_const(rows_).rows();
  return std::any_of(rows.begin(), rows.end(), [this](const contact::Row& row) {
    const NearPair& pair = rows_.pair_of(row);
    const Tree* tree = state_.slot_of(pair.a).tree;
    return tree && tree->loose && tree == state_.slot_of(pair.b).tree && row.impulse != Vector3::Zero();
  });
}

/// Energy that take_from_all() may take, J: of links among one another; where something outside touches, momenta are
/// not kept, and it is all that they have.
double Momentum::moving(Payers payers) const {
  const bool held = touched_from_outside();
  double sum = paying_free_bodies(payers).inner;
  for (const Clustered& one : state_.clusters)
    if (pays(one, payers)) sum += inner_energy(one, held);
  return std::max(sum, 0.0);  // links that stand still among one another may have less than nothing, by round-off
}

bool Momentum::pays(const Clustered& one, Payers payers) {
  const std::span trees = one.entry->system->trees();
  return payers != Payers::Looped ||
         std::any_of(trees.begin(), trees.end(), [](const Tree* tree) { return !tree->loops.empty(); });
}

/// What bodies without joints may pay in an island of trees. A box that tips over a link that stands still, or slides
/// down it, gains by contacts as links do, and the link has no motion to pay with.
Common Momentum::paying_free_bodies(Payers payers) const {
  return payers == Payers::All && !state_.trees.empty() ? common_of_free_bodies() : Common();
}

/// Takes a part of moving(), which contacts and limits gave: it is booked as taken by them. Bodies at rest stay at
/// rest.
void Momentum::take_from_all(double part, Payers payers) {
  if (!(part > 0)) return;
  const bool held = touched_from_outside();
  const Common free = paying_free_bodies(payers);
  if (free.inner > 0) {
    slow_free_bodies(free, part * free.inner);
    state_.result.ledger.contact_loss += part * free.inner;
  }
  for (const Clustered& one : state_.clusters) {
    if (!pays(one, payers)) continue;
    const double taken = shorten(one, part, held);
    state_.result.ledger.contact_loss += taken;
    if (one.alone()) one.entry->system->trees().front()->ledger.contact_loss += taken;
  }
  state_.booked = false;
}

/// Takes a part of moving() that nothing gave.
/// @param told  the balance was closed: it is in the residual
void Momentum::undo_gain(double part, bool told, Payers payers) {
  const bool held = touched_from_outside();
  const Common free = paying_free_bodies(payers);
  if (free.inner > 0) {
    slow_free_bodies(free, part * free.inner);
    if (told) state_.result.ledger.residual -= part * free.inner;
  }
  for (const Clustered& one : state_.clusters) {
    if (!pays(one, payers)) continue;
    const double taken = shorten(one, part, held);
    if (!told) continue;
    state_.result.ledger.residual -= taken;
    if (one.alone()) one.entry->system->trees().front()->ledger.residual -= taken;
  }
  state_.booked = false;
}

/// What bodies without joints have in common, if nothing outside touches them: they keep their momenta.
Common Momentum::common_of_free_bodies() const {
  Common common;
  for (const Free& one : state_.loose_bodies()) common.inner += one.now.kinetic();
  if (touched_from_outside()) return common;
  double mass = 0;
  Vector3 momentum = Vector3::Zero(), spin = Vector3::Zero();
  for (const Free& one : state_.loose_bodies()) {
    mass += one.now.solid->mass;
    common.center += one.now.solid->mass * one.now.center;
    momentum += one.now.solid->mass * one.now.velocity;
  }
  common.center /= mass;
  Matrix3 inertia = Matrix3::Zero();
  for (const Free& one : state_.loose_bodies()) {
    const Vector3 arm = one.now.center - common.center;
    const Matrix3 own = one.now.inertia();
    spin += own * one.now.spin + one.now.solid->mass * arm.cross(one.now.velocity);
    inertia += own + one.now.solid->mass * (arm.squaredNorm() * Matrix3::Identity() - arm * arm.transpose());
  }
  common.velocity = momentum / mass;
  common.spin = inertia.ldlt().solve(spin);
  common.energy = 0.5 * (momentum.dot(common.velocity) + spin.dot(common.spin));
  // Bodies of the largest numbers have nothing that could be taken without making others of them.
  common.inner = std::isfinite(common.energy) ? common.inner - common.energy : 0;
  return common;
}

/// Takes so much of the inner motion of bodies without joints, J; who asks books it.
void Momentum::slow_free_bodies(const Common& common, double taken) {
  const double left = std::sqrt(std::max(0.0, 1 - taken / common.inner));
  for (Free& one : state_.loose_bodies()) {
    const Vector3 whole = common.velocity + common.spin.cross(one.now.center - common.center);
    one.now.velocity = whole + left * (one.now.velocity - whole);
    one.now.spin = common.spin + left * (one.now.spin - common.spin);
  }
  state_.booked = false;
}

/// @return  J, that this took
double Momentum::shorten(const Clustered& one, double part, bool held) {
  return part * shorten_inner_motion(one, std::sqrt(1 - part), held);
}

/// Ends the motion of a cluster's links among one another, and all of it if something may hold the cluster from
/// outside or its momenta are not kept.
/// @param h  s, since the step began
/// @return   J, that this took
double Momentum::stop(Clustered& one, Momenta momenta, double h) {
  const std::span trees = one.entry->system->trees();
  const bool taken = momenta == Momenta::Take || !one.loose || touched_from_outside();
  const Common common = taken ? common_of(trees, true) : started_with(trees, h * state_.core.settings.gravity);
  shorten_inner(trees, common, 0);
  return common.inner;
}

/// Clusters whose links stand still among one another, and which nothing holds or touches, go on as rigid bodies for h
/// seconds: their centres of mass go on as they did.
void Momentum::coast(double h) {
  if (touched_from_outside()) return;
  for (Clustered& one : state_.clusters) {
    if (!one.loose) continue;
    const std::span trees = one.entry->system->trees();
    const Vector3 fall = h * state_.core.settings.gravity;
    double kinetic = 0;
    const double before = stored_energy(state_, one, kinetic);
    articulated::Whole wanted = measure(trees);
    rotate_freely(trees, wanted, h);
    wanted.center += h * (wanted.momentum / wanted.mass + 0.5 * fall);
    wanted.momentum += wanted.mass * fall;
    impose(trees, measure(trees), wanted);
    const double more = stored_energy(state_, one, kinetic) - before;
    state_.result.ledger.residual += more;
    if (one.alone()) trees.front()->ledger.residual += more;
  }
  state_.booked = false;
}

}  // namespace breve::island
