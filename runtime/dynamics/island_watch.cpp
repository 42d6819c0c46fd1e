// What the guard looks for.
#include "runtime/dynamics/island_watch.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/island_energy.hpp"

namespace breve::island {

namespace {

// The unexplained gain that a step may have, as a part of the energy in motion. `fast` is not meant to keep energy.
constexpr double kResidual = 0.1, kResidualFast = 0.5;

// The unexplained gain that resting bodies may have, as a part of the energy that lifts each by its own size.
constexpr double kLying = 1e-5;

constexpr double kMostDamping = 1.0;  // c h / I

/// The scheme looks itself at how much a step errs, and takes smaller ones.
bool controlled(articulated::Scheme scheme) {
  return scheme == articulated::Scheme::FehlbergAdaptive || scheme == articulated::Scheme::RungeKutta4;
}

bool damps_without_limit(const Accuracy& accuracy) {
  using articulated::Scheme;
  if (accuracy.implicit_joints &&
      (accuracy.scheme == Scheme::SemiImplicitEuler || accuracy.scheme == Scheme::ExplicitEuler))
    return true;
  return accuracy.scheme == Scheme::ImplicitEuler || accuracy.scheme == Scheme::ImplicitMidpoint;
}

}  // namespace

BodyIndex Watch::not_finite() const {
  for (const Free& one : state_.free_bodies)
    if (!one.now.center.allFinite() || !one.now.velocity.allFinite() || !one.now.spin.allFinite() ||
        !one.now.orientation.coeffs().allFinite())
      return one.body;
  for (const Tree* tree : state_.trees)
    if (!tree->state.q.allFinite() || !tree->state.v.allFinite()) return tree->links.front().body;
  return kNoBody;
}

Trouble Watch::judge(double residual, double turnover, double sums) const {
  const double most = state_.accuracy.rung == Rung::Fast ? kResidualFast : kResidual;
  // What lies still is put right by round-off of its solution, and no other energy is converted.
  const double still = weight(state_) + free_weight(state_) + script_weight(state_);
  // What swings on springs may stand still as the step ends: its energy errs by a part of what moved before that.
  const double swings = kResidual * state_.swung;
  if (!(residual > std::max(most * turnover, swings) + kTiny * sums + kLying * still)) return {};
  return {true, GuardReason::Residual, residual, state_.any_body()};
}

/// So much of what moves each second, and so much of what is converted.
double Watch::tolerated(double turnover, double h) const {
  switch (state_.accuracy.rung) {
    case Rung::Fast: return (5e-3 * h + 1e-3) * turnover;
    case Rung::Balanced: return (5e-3 * h + 5e-4) * turnover;
    default: return (5e-5 * h + 5e-6) * turnover;
  }
}

/// What would go wrong in a step of h seconds with the settings as they are, from the state now.
Trouble Watch::foresee(double h) {
  const double part = state_.accuracy.step > 0 ? std::min(state_.accuracy.step, h) : h;
  Trouble worst = fastest_rotation(part);
  if (worst.value > kMostRotation) return worst;
  worst = strongest_damper(part);
  return worst.value > kMostDamping ? worst : Trouble{};
}

/// Shortens the sub-steps of a step of h seconds in which a body rotates farther, or a driven spring swings farther,
/// than the integrator can follow, so that a fast spin needs no guard. Explicit Euler is there to be studied: its step
/// is the one that was set.
void Watch::shorten_sub_steps(double h) {
  if (state_.accuracy.scheme == articulated::Scheme::ExplicitEuler) return;
  constexpr double kMostParts = 16;     // of a sub-step
  constexpr double kImplicitParts = 4;  // likewise, of order 1
  const double part = state_.accuracy.step > 0 ? std::min(state_.accuracy.step, h) : h;
  // Without contacts `reference` leaves a step to step control, but its rows err as in a sub-step with contacts.
  const double rows = state_.accuracy.contact_step;
  const double finer = state_.accuracy.rung == Rung::Reference && rows > 0 ? std::max(1.0, std::ceil(part / rows)) : 1;
  const bool fast_springs = find_fast_springs(kMostRotation * finer * kMostParts / part);
  const double rotation = std::max(fastest_rotation(part).value, driven_swing(part));
  const double wanted = std::min(std::ceil(rotation / kMostRotation), finer * kMostParts);
  const double parts = std::max(wanted, fast_springs ? finer * kImplicitParts : 1);
  if (parts > 1) {
    Accuracy shorter = state_.accuracy;
    shorter.step = part / parts;
    state_.use_accuracy(shorter);
  }
}

/// The rows of a sub-step push joints as if no spring pulled them back meanwhile, and no sub-step is short enough for
/// the springs that are faster than this: they have to be implicit, and the rows to know of them.
/// @param fastest  rad/s
/// @return  whether there is one
bool Watch::find_fast_springs(double fastest) {
  if (state_.accuracy.implicit_joints) return false;
  bool any = false;
  for (Clustered& one : state_.clusters) {
    if (!one.entry->springs.empty() || !has_rows(one)) continue;
    for (const Tree* tree : one.entry->system->trees())
      for (const TreeLink& link : tree->links)
        if (link.joint != kNoJoint && link.gain_unit > 0 &&
            state_.core.joints[link.joint].drive.stiffness > fastest * fastest * link.gain_unit)
          one.fast_springs = any = true;
  }
  return any;
}

/// Motors, limits, loops or contacts may push the cluster's links in this step.
bool Watch::has_rows(const Clustered& one) const {
  if (!state_.pairs.empty()) return true;
  for (const Tree* tree : one.entry->system->trees()) {
    if (!tree->loops.empty()) return true;
    for (const TreeLink& link : tree->links)
      if (link.motor || (link.joint != kNoJoint && Dynamics::Core::has_limits(state_.core.joints[link.joint])))
        return true;
  }
  return false;
}

/// rad, the largest part of its swing that a joint's spring makes in h seconds while motors drive the assembly. Their
/// rows move the joints as if nothing pulled them back within a sub-step.
double Watch::driven_swing(double h) const {
  if (state_.accuracy.implicit_joints) return 0;
  double most = 0;
  for (const Clustered& one : state_.clusters) {
    if (one.fast_springs) continue;
    for (const Tree* tree : one.entry->system->trees()) {
      if (std::none_of(tree->links.begin(), tree->links.end(), [](const TreeLink& link) { return link.motor; }))
        continue;
      for (const TreeLink& link : tree->links)
        if (link.joint != kNoJoint && link.gain_unit > 0)
          most = std::max(most, h * std::sqrt(state_.core.joints[link.joint].drive.stiffness / link.gain_unit));
    }
  }
  return most;
}

Trouble Watch::fastest_rotation(double h) const {
  Trouble worst{true, GuardReason::FastRotation, 0, kNoBody};
  const auto look = [&worst, h](double spin, BodyIndex body) {
    if (spin * h > worst.value) worst.value = spin * h, worst.body = body;
  };
  // The rotation of a body whose inertia is that of a ball is exact, and a scheme with step control takes what steps it
  // needs. But contacts see where corners are only as a sub-step begins.
  const auto exact = [this](const Free& one) {
    return one.now.solid->round && (state_.pairs.empty() || state_.shape(one.body).kind() == ShapeKind::Sphere);
  };
  for (const Free& one : state_.free_bodies)
    if (!exact(one) && (state_.accuracy.implicit_spin || !controlled(state_.accuracy.scheme)))
      look(one.now.spin.norm(), one.body);
  if (controlled(state_.accuracy.scheme)) return worst;
  for (const Clustered& one : state_.clusters) {
    if (one.entry->system->can_be_finer() && !state_.stiff(one)) continue;  // likewise
    for (Tree* tree : one.entry->system->trees()) {
      articulated::forward_kinematics(tree->model, tree->data, tree->state);
      for (std::size_t i = 0; i < tree->links.size(); ++i)
        look(articulated::spin(tree->data, static_cast<int>(i)).norm(), tree->links[i].body);
    }
  }
  return worst;
}

Trouble Watch::strongest_damper(double h) const {
  Trouble worst{true, GuardReason::FastDamping, 0, kNoBody};
  if (controlled(state_.accuracy.scheme)) return worst;
  const auto look = [&worst, h](double rate, BodyIndex body) {
    if (rate * h > worst.value) worst.value = rate * h, worst.body = body;
  };
  if (!damps_without_limit(state_.accuracy))
    for (const Tree* tree : state_.trees)
      for (const TreeLink& link : tree->links)
        if (link.joint != kNoJoint && link.gain_unit > 0)
          look(state_.core.joints[link.joint].drive.damping / link.gain_unit, link.body);
  if (state_.accuracy.scheme == articulated::Scheme::ImplicitMidpoint ||
      state_.accuracy.scheme == articulated::Scheme::ImplicitEuler)
    return worst;
  // A Spring's damper is explicit wherever the whole scheme is.
  for (const Clustered& one : state_.clusters)
    for (const SpringIndex spring : one.entry->springs) {
      const SpringDescription& is = state_.core.springs[spring].is;
      double yields = 0;
      for (const BodyIndex body : {is.a, is.b})
        if (state_.core.bodies->dynamic(body)) yields += 1 / state_.core.bodies->mass(body);
      look(is.damping * yields, state_.core.bodies->dynamic(is.a) ? is.a : is.b);
    }
  return worst;
}

}  // namespace breve::island
