// What the guard looks for in an island: numbers that are not finite, unexplained energy, overlaps that grow, and
// bodies that rotate or are damped too fast for their sub-steps.
#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/island.hpp"

namespace breve {

namespace {

// The unexplained gain that a step may have, as a part of the energy in motion. `fast` is not meant to keep energy.
constexpr double kResidual = 0.1, kResidualFast = 10;

// The unexplained gain that resting bodies may have, as a part of the energy that lifts each by its own size.
constexpr double kLying = 1e-5;

constexpr double kMostDamping = 1.0;  // c h / I

/// Parts of the smaller body's radius: an overlap that is deeper than the first and grew by more than the second in one
/// step grows. What solvers that stop early leave is less.
struct Depths {
  double deep, grown;
};
constexpr Depths kDepths{0.05, 0.01}, kDepthsFast{0.25, 0.05};

const Depths& depths_for(Rung rung) { return rung == Rung::Fast ? kDepthsFast : kDepths; }

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

BodyIndex Island::not_finite() const {
  for (const Free& one : free_)
    if (!one.now.center.allFinite() || !one.now.velocity.allFinite() || !one.now.spin.allFinite() ||
        !one.now.orientation.coeffs().allFinite())
      return one.body;
  for (const Tree* tree : trees_)
    if (!tree->state.q.allFinite() || !tree->state.v.allFinite()) return tree->links.front().body;
  return kNoBody;
}

Island::Trouble Island::judge_residual(double residual, double turnover, double before) const {
  const double most = accuracy_.rung == Rung::Fast ? kResidualFast : kResidual;
  // What lies still is put right by round-off of its solution, and nothing else is turned over.
  double still = weight();
  for (const Free& one : loose_bodies())
    still += one.now.solid->mass * core_.bodies->collision_shape(one.body)->bounding_radius() *
             core_.settings.gravity.norm();
  if (!(residual > most * turnover + kTiny * std::abs(before) + kLying * still)) return {};
  return {true, GuardReason::Residual, residual, any_body()};
}

/// What would go wrong in a step of h seconds with the settings as they are, from the state now.
Island::Trouble Island::foresee(double h) {
  const double part = accuracy_.step > 0 ? std::min(accuracy_.step, h) : h;
  Trouble worst = fastest_rotation(part);
  if (worst.value > kMostRotation) return worst;
  worst = strongest_damper(part);
  return worst.value > kMostDamping ? worst : Trouble{};
}

/// Shortens the sub-steps of a step of h seconds in which a body rotates farther than the integrator can follow, so
/// that a fast spin needs no guard. Explicit Euler is there to be studied: its step is the one that was set.
void Island::follow_rotations(double h) {
  if (accuracy_.scheme == articulated::Scheme::ExplicitEuler) return;
  constexpr double kMostParts = 16;  // of a sub-step
  const double part = accuracy_.step > 0 ? std::min(accuracy_.step, h) : h;
  const double rotation = fastest_rotation(part).value;
  if (!(rotation > kMostRotation)) return;
  Accuracy shorter = accuracy_;
  shorter.step = part / std::min(std::ceil(rotation / kMostRotation), kMostParts);
  use_accuracy(shorter);
}

Island::Trouble Island::fastest_rotation(double h) const {
  Trouble worst{true, GuardReason::FastRotation, 0, kNoBody};
  const auto look = [&worst, h](double spin, BodyIndex body) {
    if (spin * h > worst.value) worst.value = spin * h, worst.body = body;
  };
  // A round body turns exactly, and a scheme with step control takes what steps it needs.
  for (const Free& one : free_)
    if (!one.now.solid->round && (accuracy_.implicit_spin || !controlled(accuracy_.scheme)))
      look(one.now.spin.norm(), one.body);
  if (controlled(accuracy_.scheme)) return worst;
  for (const Clustered& one : clusters_) {
    if (one.entry->system->can_be_finer() && !stiff(one)) continue;  // likewise
    for (Tree* tree : one.entry->system->trees()) {
      articulated::forward_kinematics(tree->model, tree->data, tree->state);
      for (std::size_t i = 0; i < tree->links.size(); ++i)
        look(articulated::spin(tree->data, static_cast<int>(i)).norm(), tree->links[i].body);
    }
  }
  return worst;
}

Island::Trouble Island::strongest_damper(double h) const {
  Trouble worst{true, GuardReason::FastDamping, 0, kNoBody};
  if (controlled(accuracy_.scheme)) return worst;
  const auto look = [&worst, h](double rate, BodyIndex body) {
    if (rate * h > worst.value) worst.value = rate * h, worst.body = body;
  };
  if (!damps_without_limit(accuracy_))
    for (const Tree* tree : trees_)
      for (const TreeLink& link : tree->links)
        if (link.joint != kNoJoint && link.gain_unit > 0)
          look(core_.joints[link.joint].drive.damping / link.gain_unit, link.body);
  if (accuracy_.scheme == articulated::Scheme::ImplicitMidpoint ||
      accuracy_.scheme == articulated::Scheme::ImplicitEuler)
    return worst;
  // A Spring's damper is explicit wherever the whole scheme is.
  for (const Clustered& one : clusters_)
    for (const SpringIndex spring : one.entry->springs) {
      const SpringDescription& is = core_.springs[spring].is;
      double yields = 0;
      for (const BodyIndex body : {is.a, is.b})
        if (core_.bodies->dynamic(body)) yields += 1 / core_.bodies->mass(body);
      look(is.damping * yields, core_.bodies->dynamic(is.a) ? is.a : is.b);
    }
  return worst;
}

/// No two bodies come nearer by more than that, m/s; links may by any speed.
double Island::fastest_approach() const {
  if (!trees_.empty()) return JointDrive::kNoLimit;
  double fastest = 0;
  for (const Free& one : free_) {
    const Vector3 velocity(one.v[0], one.v[1], one.v[2]), spin(one.v[3], one.v[4], one.v[5]);
    const Shape& shape = *core_.bodies->collision_shape(one.body);
    const double arm = 2 * shape.bounding_radius();  // of a point of it from its centre of mass, at most
    fastest = std::max(fastest, velocity.norm() + arm * spin.norm());
  }
  return 2 * fastest;
}

/// After the rows of a sub-step of h seconds were solved: notes pairs that are deep, or will be if they move on as they
/// do, to be looked at when the step is over.
void Island::note_overlaps(double h) {
  if (core_.settings.guard == GuardMode::Off) return;
  const double reach = h * fastest_approach();
  overlapped_.resize(pairs_.size(), 0);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Touch& touch = touches_[i];
    const double deep = depths_for(accuracy_.rung).deep * size_of_pair(*pairs_[touch.pair]);
    if (touch.gap - reach > -deep) continue;
    if (touch.gap > 0 && rows_[i].impulse[0] > 0) continue;  // it is stopped before it overlaps
    const double rate = rate_of(rows_[i], true)[0] - rate_of(rows_[i], false)[0];
    if (touch.gap + h * std::min(rate, 0.0) > -deep) continue;
    if (std::exchange(overlapped_[touch.pair], std::uint8_t{1}) != 0) continue;
    overlaps_.push_back({touch.pair, std::max(-touch.gap, 0.0)});
  }
}

Island::Trouble Island::measure_overlaps() {
  Trouble worst;
  if (overlaps_.empty()) return worst;
  place_links();
  NarrowCounters narrow;
  narrow.stop = meter_.end();
  double most = 0;
  for (const Overlap& one : overlaps_) {
    const NearPair& pair = *pairs_[one.pair];
    Contact deepest;
    if (!closest_within(*core_.bodies->collision_shape(pair.a), pose_of(pair.a), *core_.bodies->collision_shape(pair.b),
                        pose_of(pair.b), 0, deepest, &narrow))
      continue;
    const double depth = -deepest.distance;
    const double size = size_of_pair(pair);
    const Depths& limits = depths_for(accuracy_.rung);
    if (depth < limits.deep * size || depth - one.before < limits.grown * size) continue;
    if (depth <= most) continue;
    most = depth;
    worst = {true, GuardReason::Penetration, depth, core_.bodies->dynamic(pair.a) ? pair.a : pair.b};
  }
  meter_.add(narrow.facets + narrow.boxes);
  return narrow.stopped() ? Trouble() : worst;
}

}  // namespace breve
