// Rebounds of what is not located in time.
#include "runtime/dynamics/island_rebound.hpp"

#include <algorithm>
#include <cmath>

namespace breve::island {

Rebounds::Rebounds(State& state, Contacts& contacts, Rows& rows)
    : state_(state),
      contacts_(contacts),
      rows_(rows),
      speeds_(state.memory),
      free_rates_(state.memory),
      plain_rates_(state.memory),
      rates_(state.memory),
      plain_impulses_(state.memory),
      impulses_(state.memory),
      plain_scalars_(state.memory) {}

/// Speeds at which rows are to part that were approached as the sub-step began, by Newton's law of restitution.
/// @return  whether there are some
bool Rebounds::find(double h) {
  bool any = false;
  // A speed that gravity alone adds in two steps is not an impact: resting stacks would hop.
  const double fall = 2 * state_.core.settings.gravity.norm() * h;
  speeds_.assign(rows_.contacts() + rows_.scalars().size(), 0.0);
  for (std::size_t i = 0; i < rows_.contacts(); ++i) {
    const auto& [touch, pair, row, law] = rows_.contact(i);
    const double rate = rows_.before(i, true)[0] - rows_.before(i, false)[0];
    const bool hits = !touch.turned && touch.gap + h * rate < 0;
    if (hits && rate < -std::max(law.restitution_threshold, fall)) speeds_[i] = -law.restitution * rate;
    any = any || speeds_[i] > 0;
  }
  for (std::size_t i = 0; i < rows_.limits(); ++i) {
    const Bound& bound = rows_.limit(i).bound;
    const double e = state_.core.joints[bound.joint].drive.limit_restitution, rate = bound.rate;
    double& speed = speeds_[rows_.contacts() + i];  // limits are the first of the scalar rows
    if (e > 0 && rate < -std::max(contacts_.resting(), fall) && bound.gap + h * rate < 0) speed = -e * rate;
    any = any || speed > 0;
  }
  return any;
}

/// Velocities at all rows but those of motors, one after the other.
void Rebounds::read_rates(std::pmr::vector<double>& rates) const {
  rates.clear();
  for (const contact::Row& row : rows_.rows()) {
    const Vector3 rate = rows_.rate_of(row, true) - rows_.rate_of(row, false);
    rates.insert(rates.end(), rate.data(), rate.data() + 3);
  }
  for (std::size_t i = 0; i < rows_.scalars().size(); ++i)
    if (!rows_.is_motor(i)) rates.push_back(rows_.rate_of(rows_.scalars()[i]));
}

void Rebounds::read_impulses(std::pmr::vector<double>& impulses) const {
  impulses.clear();
  for (const contact::Row& row : rows_.rows())
    impulses.insert(impulses.end(), row.impulse.data(), row.impulse.data() + 3);
  for (std::size_t i = 0; i < rows_.scalars().size(); ++i)
    if (!rows_.is_motor(i)) impulses.push_back(rows_.scalars()[i].impulse);
}

void Rebounds::ask() {
  read_rates(plain_rates_);
  read_impulses(plain_impulses_);
  plain_scalars_.clear();
  for (const contact::ScalarRow& row : rows_.scalars()) plain_scalars_.push_back(row.impulse);
  for (Free& one : state_.free_bodies) std::copy_n(one.v, 6, one.plain_v);
  for (Tree* tree : state_.trees) tree->way = tree->state.v;
  for (std::size_t i = 0; i < rows_.contacts(); ++i)
    if (speeds_[i] > 0) rows_.rows()[i].bias = speeds_[i];
  for (std::size_t i = 0; i < rows_.scalars().size(); ++i)
    if (speeds_[rows_.contacts() + i] > 0) rows_.scalars()[i].bias = speeds_[rows_.contacts() + i];
  state_.reset_velocities();
}

/// The height that impulses between the two solutions give free bodies, J: as a constant force over h seconds does.
/// What links and drivers push, they may lift.
double Rebounds::lifted(double share, double h) const {
  Vector3 momentum = Vector3::Zero();
  if (!state_.trees.empty() || state_.drivers > 0) return 0;
  for (const Free& one : state_.free_bodies) {
    for (int k = 0; k < 3; ++k)
      momentum[k] += one.now.solid->mass * (one.plain_v[k] + share * (one.v[k] - one.plain_v[k]) - one.free_v[k]);
  }
  return -0.5 * h * state_.core.settings.gravity.dot(momentum);
}

/// Goes from the solution without rebound toward the one with it as far as contacts, limits and loops together give no
/// energy: with several at once, Newton's law may, and what rotates comes to the row at another speed than the one that
/// it had as the sub-step began.
void Rebounds::settle(double h) {
  read_rates(rates_);
  read_impulses(impulses_);
  const auto gained = [&](double share) {
    double sum = 0;
    for (std::size_t i = 0; i < rates_.size(); ++i) {
      const double impulse = plain_impulses_[i] + share * (impulses_[i] - plain_impulses_[i]);
      const double rate = plain_rates_[i] + share * (rates_[i] - plain_rates_[i]);
      sum += 0.5 * impulse * (free_rates_[i] + rate);
    }
    return sum + lifted(share, h);
  };
  const double least = gained(0), full = gained(1);
  if (!(full > std::max(least, 0.0))) return;
  // A parabola through three points, which crosses zero between the ends.
  const double a = 2 * (full + least) - 4 * gained(0.5), b = full - least - a;
  const double root = std::abs(a) > 0 ? (-b + std::sqrt(std::max(0.0, b * b - 4 * a * least))) / (2 * a) : -least / b;
  mix(std::isfinite(root) ? std::clamp(root, 0.0, 1.0) : 0.0);
}

/// Impulses and velocities between the two solutions.
void Rebounds::mix(double share) {
  std::size_t at = 0;
  const auto between = [share](double& value, double plain) { value = plain + share * (value - plain); };
  for (contact::Row& row : rows_.rows())
    for (int k = 0; k < 3; ++k) between(row.impulse[k], plain_impulses_[at++]);
  for (std::size_t i = 0; i < rows_.scalars().size(); ++i) between(rows_.scalars()[i].impulse, plain_scalars_[i]);
  for (Free& one : state_.free_bodies)
    for (int k = 0; k < 6; ++k) between(one.v[k], one.plain_v[k]);
  for (Tree* tree : state_.trees) tree->state.v = tree->way + share * (tree->state.v - tree->way);
}

}  // namespace breve::island
