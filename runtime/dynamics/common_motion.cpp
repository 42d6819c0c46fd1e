// Trees that move as one rigid body.
#include "runtime/dynamics/common_motion.hpp"

#include <algorithm>
#include <cmath>

namespace breve {

using articulated::Whole;

void impose(std::span<Tree* const> trees, const Whole& now, const Whole& wanted) {
  articulated::Symmetric3 inverse;
  Vector3 spin = Vector3::Zero();
  // Bodies on one line rotate about it without momentum.
  if (articulated::invert(now.inertia, inverse)) spin = inverse * Vector3(wanted.spin - now.spin);
  const Vector3 way = wanted.center - now.center, velocity = (wanted.momentum - now.momentum) / now.mass;
  for (Tree* tree : trees)
    articulated::move_whole(tree->model, tree->data, way, velocity, spin, now.center, tree->state);
}

Whole measure(std::span<Tree* const> trees) {
  Whole sum;
  for (Tree* tree : trees) {
    const Whole& one = tree->measured();
    if (tree == trees.front())
      sum = one;
    else
      sum.add(one);
  }
  return sum;
}

Common common_of(std::span<Tree* const> trees, bool held) {
  Common common;
  const Whole whole = measure(trees);
  for (Tree* tree : trees) common.inner += tree->kinetic();
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
  // A position in the middle, of which only the velocities are kept.
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

}  // namespace breve
