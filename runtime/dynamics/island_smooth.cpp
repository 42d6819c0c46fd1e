// Smooth motion of what an island holds; on `fast` in as many parts as keep the energy.
#include "runtime/dynamics/island_smooth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "runtime/articulated/energy.hpp"
#include "runtime/base/error.hpp"
#include "runtime/base/rotation_vector.hpp"
#include "runtime/dynamics/common_motion.hpp"
#include "runtime/dynamics/island_energy.hpp"
#include "runtime/dynamics/spring_network.hpp"

namespace breve::island {

namespace {

constexpr int kMostParts = 16;  // of a step
// Of step control where contacts act, if its tolerance is not finer than that.
constexpr double kContactSlack = 10;

void move_driver(Free& one, double h) {
  one.now.center += h * one.now.velocity;
  if (one.now.spin != Vector3::Zero())
    one.now.orientation = (rotation_by(h * one.now.spin) * one.now.orientation).normalized();
}

/// Shortens the motion of a cluster's links among one another to so much of it as `scale_of` says to its energy, J.
/// @return  whether it says anything
template <class Scale>
bool shorten_by(const Clustered& one, const Scale& scale_of) {
  std::optional<double> scale;
  if (one.entry->asked) {
    scale = scale_of(inner_energy(one));
    if (scale) shorten_inner_motion(one, *scale);
  } else {
    const std::span trees = one.entry->system->trees();
    const Common common = common_of(trees);
    scale = scale_of(common.inner);
    if (scale) shorten_inner(trees, common, *scale);
  }
  return scale.has_value();
}

/// Takes from the motion of a cluster's links among one another what a step gained that nothing explains, or gives it
/// back: momenta and loops stay as they are, since all their velocities are shortened alike.
/// Source: Hairer, Lubich and Wanner 2006, IV.4 (projection to the energy).
/// @param gain  J
/// @return  false if that is more than a small part of that motion's energy: nothing was changed
bool take_back(Clustered& one, double gain) {
  return shorten_by(one, [gain](double inner) {
    return std::abs(gain) <= kFew * inner ? std::optional(std::sqrt(1 - gain / inner)) : std::nullopt;
  });
}

/// The same where no finer step would help: whatever it is, down to links at rest among one another.
void take_back_most(Clustered& one, double gain) {
  if (!(gain > 0)) return;
  shorten_by(one, [gain](double inner) {
    return inner > 0 ? std::optional(std::sqrt(std::max(0.0, 1 - gain / inner))) : std::nullopt;
  });
}

void add_works(const Energy& from, Energy& to) {
  to.motor_work += from.motor_work;
  to.script_work += from.script_work;
  to.drag_loss += from.drag_loss;
}

}  // namespace

void SmoothMotion::move(double time, double h) {
  if (springs_.move()) {
    free_work_ = springs_.smooth(time, h);
    return;
  }
  free_work_ = 0;
  constexpr std::uint64_t kUnits = 10;  // of work, a body
  state_.meter.add(kUnits * state_.free_bodies.size());
  networks_.move(time, h, free_work_);
  const std::size_t first = state_.networks_begin(), end = state_.networks_end();
  for (std::size_t i = 0; i < state_.free_bodies.size(); ++i) {
    if (i >= first && i < end) continue;
    Free& one = state_.free_bodies[i];
    if (one.driver) {
      move_driver(one, h);
      continue;
    }
    const Vector3 center = one.now.center, spin = one.now.spin;
    move_free(one.now, state_.accuracy, state_.core.settings.gravity, time, h, one.next, state_.meter);
    free_work_ += one.now.force.dot(one.now.center - center) + 0.5 * h * one.now.torque.dot(spin + one.now.spin);
  }
  for (Clustered& one : state_.clusters) move_cluster(one, time, h);
}

void SmoothMotion::move_cluster(Clustered& one, double time, double h) {
  one.forget_parts();
  one.semi = semi_implicit(state_.accuracy) || one.fast_springs;
  if (one.entry->system->can_be_finer())
    move_fast(one, time, h);
  else
    move_whole(one, time, h);
}

void SmoothMotion::move_once(Clustered& one, double time, double h) {
  Cluster& system = *one.entry->system;
  system.set_slack(contacts_.coarse() ? kContactSlack : 1);
  system.step(time, h);
  for (Tree* tree : system.trees()) tree->motor_impulse += tree->part_impulse;
  if (one.entry->network) one.entry->network->note_forces(state_.core);
  state_.result.counters.evaluations += static_cast<std::uint64_t>(system.count().evaluations);
  state_.result.counters.rejected += static_cast<std::uint64_t>(system.count().rejected);
  one.pending.motor_work += system.motor_work();
  one.pending.script_work += system.script_work();
  one.pending.drag_loss += system.drag_loss();
  one.held_work += system.reaction_work();
}

namespace {

/// What trees together have, and h seconds later by gravity and by contacts that go on.
articulated::Whole going_on(std::span<Tree* const> trees, const Vector3& gravity, double h) {
  articulated::Whole wanted = measure(trees);
  Vector3 force = Vector3::Zero();
  for (const Tree* tree : trees) {
    force += tree->outer_force;
    wanted.spin += h * (tree->outer_couple + (tree->row_center - wanted.center).cross(tree->outer_force));
  }
  force += wanted.mass * gravity;
  wanted.center += h / wanted.mass * (wanted.momentum + 0.5 * h * force);
  wanted.momentum += h * force;
  return wanted;
}

}  // namespace

/// One piece of smooth motion of h seconds, after which a cluster that nothing holds has the momenta it had, and what
/// gravity gave it. Where force methods push, that holds for each tree, with what they gave.
void SmoothMotion::move_whole(Clustered& one, double time, double h) {
  const Vector3& gravity = state_.core.settings.gravity;
  if (one.loose) {
    const std::span trees = one.entry->system->trees();
    const articulated::Whole wanted = going_on(trees, gravity, h);
    move_once(one, time, h);
    return impose(trees, measure(trees), wanted);
  }
  const std::span all = one.entry->system->received();
  for (const Cluster::Received& received : all) received.tree->whole = going_on({&received.tree, 1}, gravity, h);
  move_once(one, time, h);
  for (const Cluster::Received& received : all) {
    articulated::Whole wanted = received.tree->whole;
    wanted.center += received.way;
    wanted.momentum += received.impulse;
    wanted.spin += received.spin;
    impose({&received.tree, 1}, measure({&received.tree, 1}), wanted);
  }
}

/// Runge-Kutta 4, or semi-implicit Euler where springs are too fast for it, in as many parts as leave little for
/// projection to the energy. A gain that remains is taken back; a loss of implicit springs is lost.
void SmoothMotion::move_fast(Clustered& one, double time, double h) {
  Cluster& system = *one.entry->system;
  for (Tree* tree : system.trees()) tree->part_state = tree->state;
  bool implicit = state_.stiff(one) || state_.finished;
  system.set_finer(!implicit);
  const double still = kStill * weight(state_);
  for (int parts = 1;; parts *= 2) {
    const bool last = 2 * parts > kMostParts || state_.worn();
    double gain = std::numeric_limits<double>::infinity();
    try {
      gain = gain_of(one, time, h, parts);
    } catch (const Error& error) {
      // Stages that took too many evaluations to hold loops take as many in parts.
      const bool too_long = one.stage->holds_loops && system.over();
      if (error.code() != ErrorCode::Numeric || (last && implicit) || too_long) throw;
    }
    if ((implicit && gain <= 0) || std::abs(gain) <= still || take_back(one, gain)) break;
    if (last && (implicit || std::isfinite(gain))) {
      take_back_most(one, gain);
      break;
    }
    ++state_.result.counters.rejected;
    for (Tree* tree : system.trees()) tree->state = tree->part_state;
    one.forget_parts();
    if (!last) continue;
    implicit = true;
    system.set_finer(false);
    parts /= 2;
  }
  system.set_finer(false);
  one.semi = implicit;
}

/// Takes the step in parts. What it gained that nothing explains, J.
double SmoothMotion::gain_of(Clustered& one, double time, double h, int parts) {
  double kinetic = 0;
  const double before = stored_energy(state_, one, kinetic);
  for (int i = 0; i < parts; ++i) move_whole(one, time + i * h / parts, h / parts);
  const Energy& did = one.pending;
  const double gain =
      stored_energy(state_, one, kinetic) - before - (did.motor_work + did.script_work + one.held_work - did.drag_loss);
  return std::abs(gain) <= kTiny * std::abs(before) ? 0 : gain;
}

/// Motors, dampers and scripts pushed along the path of smooth motion; they also worked along what the rows' impulses
/// added to it: half of the change of velocity for h.
void SmoothMotion::correct_works(double h) {
  for (const Free& one : state_.free_bodies) {
    for (int k = 0; k < 3; ++k)
      free_work_ +=
          0.5 * h *
          (one.now.force[k] * (one.v[k] - one.free_v[k]) + one.now.torque[k] * (one.v[3 + k] - one.free_v[3 + k]));
  }
  networks_.correct_drag();
  for (Clustered& clustered : state_.clusters) {
    for (const std::uint32_t index : clustered.entry->trees) {
      Tree& tree = *state_.core.trees[index];
      if (!tree.driven) continue;
      const bool semi = clustered.semi;
      const articulated::Vector &before = tree.sub_state.v, &free = tree.smooth_v, &after = tree.state.v;
      for (int i = 0; i < tree.model.size(); ++i) {
        const TreeLink& link = tree.links[static_cast<std::size_t>(i)];
        if (link.joint == kNoJoint) continue;
        const articulated::Body& body = tree.model.body(i);
        const double damping = state_.core.joints[link.joint].drive.damping;
        for (int k = body.v; k < body.v + articulated::velocity_count(body.type); ++k) {
          const double change = tree.row_share * (after[k] - free[k]), mean = 0.5 * (before[k] + free[k]);
          clustered.pending.motor_work += 0.5 * change * tree.motor_impulse[k];
          clustered.pending.script_work += (semi ? 1 : 0.5) * change * h * tree.set_tau[k];
          // An implicit damper pushes against the velocity that comes of it.
          if (semi && !link.slow_spring)
            clustered.pending.drag_loss += damping * h * (after[k] * after[k] - free[k] * mean);
          else
            clustered.pending.drag_loss += 0.5 * change * damping * h * (semi ? before[k] : mean);
        }
      }
    }
    clustered.pending.drag_loss = std::max(0.0, clustered.pending.drag_loss);  // dampers give nothing
  }
}

void SmoothMotion::commit() {
  ++state_.result.counters.sub_steps;
  state_.result.ledger.script_work += free_work_;
  if (springs_.move())
    springs_.commit();
  else
    state_.result.ledger.drag_loss += networks_.loss();
  for (const Clustered& one : state_.clusters) {
    add_works(one.pending, state_.result.ledger);
    // What springs between trees do is nobody's own.
    if (one.alone()) add_works(one.pending, state_.core.trees[one.entry->trees.front()]->ledger);
  }
}

}  // namespace breve::island
