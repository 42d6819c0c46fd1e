// Overlaps that grow.
#include "runtime/dynamics/island_overlaps.hpp"

#include <algorithm>
#include <utility>

namespace breve::island {

namespace {

/// Parts of the smaller body's radius: an overlap that is deeper than the first and grew by more than the second in one
/// step grows. What solvers that stop early leave is less.
struct Depths {
  double deep, grown;
};
constexpr Depths kDepths{0.05, 0.01}, kDepthsFast{0.25, 0.05};

const Depths& depths_for(Rung rung) { return rung == Rung::Fast ? kDepthsFast : kDepths; }

}  // namespace

Overlaps::Overlaps(State& state, Rows& rows)
    : state_(state), rows_(rows), overlaps_(state.memory), noted_(state.memory) {}

void Overlaps::begin_try() {
  overlaps_.clear();
  noted_.clear();
}

/// No two bodies come nearer by more than that, m/s; links may by any speed.
double Overlaps::fastest_approach() const {
  if (!state_.trees.empty()) return JointDrive::kNoLimit;
  double fastest = 0;
  for (const Free& one : state_.free_bodies) {
    const Vector3 velocity(one.v[0], one.v[1], one.v[2]), spin(one.v[3], one.v[4], one.v[5]);
    const double arm =
        2 * state_.shape(one.body).bounding_radius();  // of a point of it from its centre of mass, at most
    fastest = std::max(fastest, velocity.norm() + arm * spin.norm());
  }
  return 2 * fastest;
}

/// After the rows of a sub-step of h seconds were solved: notes pairs that are deep, or will be if they move on as they
/// do, to be looked at when the step is over.
void Overlaps::note(double h) {
  if (state_.core.settings.guard == GuardMode::Off) return;
  const double reach = h * fastest_approach();
  noted_.resize(state_.pairs.size(), 0);
  for (std::size_t i = 0; i < rows_.contacts(); ++i) {
    const auto& [touch, pair, row, law] = rows_.contact(i);
    const double deep = depths_for(state_.accuracy.rung).deep * state_.size_of_pair(pair);
    if (touch.gap - reach > -deep) continue;
    if (touch.gap > 0 && row.impulse[0] > 0) continue;  // it is stopped before it overlaps
    const double rate = rows_.rate_of(row, true)[0] - rows_.rate_of(row, false)[0];
    if (touch.gap + h * std::min(rate, 0.0) > -deep) continue;
    if (std::exchange(noted_[touch.pair], std::uint8_t{1}) != 0) continue;
    overlaps_.push_back({touch.pair, std::max(-touch.gap, 0.0)});
  }
}

Trouble Overlaps::measure() {
  Trouble worst;
  if (overlaps_.empty()) return worst;
  state_.place_links();
  NarrowCounters narrow;
  narrow.stop = state_.meter.end();
  double most = 0;
  for (const Overlap& one : overlaps_) {
    const NearPair& pair = *state_.pairs[one.pair];
    Contact deepest;
    if (!closest_within(state_.shape(pair.a), state_.pose_of(pair.a), state_.shape(pair.b), state_.pose_of(pair.b), 0,
                        deepest, &narrow))
      continue;
    const double depth = -deepest.distance;
    const double size = state_.size_of_pair(pair);
    const Depths& limits = depths_for(state_.accuracy.rung);
    if (depth < limits.deep * size || depth - one.before < limits.grown * size) continue;
    if (depth <= most) continue;
    most = depth;
    worst = {true, GuardReason::Penetration, depth, state_.core.bodies->dynamic(pair.a) ? pair.a : pair.b};
  }
  state_.meter.add(narrow.facets + narrow.boxes);
  return narrow.stopped() ? Trouble() : worst;
}

}  // namespace breve::island
