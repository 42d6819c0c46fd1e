// Rebounds of what is not located in time: all at the end of a sub-step, with no more energy than there was.
#include <algorithm>
#include <cmath>

#include "runtime/dynamics/island.hpp"

namespace breve {

/// Speeds at which rows are to part that were approached as the sub-step began, by Newton's law of restitution.
/// @return  whether there are some
bool Island::find_rebounds(double h) {
  bool any = false;
  // A speed that gravity alone adds in two steps is not an impact: resting stacks would hop.
  const double fall = 2 * core_.settings.gravity.norm() * h;
  rebounding_.assign(rows_.size() + scalars_.size(), 0.0);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const contact::Law& law = laws_[i];
    const double rate = before_[2 * i][0] - before_[2 * i + 1][0];
    const bool hits = touches_[i].gap + h * rate < 0;
    if (hits && rate < -std::max(law.restitution_threshold, fall)) rebounding_[i] = -law.restitution * rate;
    any = any || rebounding_[i] > 0;
  }
  std::size_t k = 0;
  for (const Bound& bound : bounds_) {
    if (!bound.rests) continue;
    const double e = core_.joints[bound.joint].drive.limit_restitution, rate = bound.rate;
    if (e > 0 && rate < -std::max(resting_, fall) && bound.gap + h * rate < 0)
      rebounding_[rows_.size() + k] = -e * rate;
    any = any || rebounding_[rows_.size() + k] > 0;
    ++k;
  }
  return any;
}

/// Velocities at all rows but those of motors, one after the other.
void Island::read_row_rates(std::pmr::vector<double>& rates) const {
  rates.clear();
  for (const contact::Row& row : rows_) {
    const Vector3 rate = rate_of(row, true) - rate_of(row, false);
    rates.insert(rates.end(), rate.data(), rate.data() + 3);
  }
  for (std::size_t i = 0; i < scalars_.size(); ++i)
    if (!is_motor(i)) rates.push_back(rate_of(scalars_[i]));
}

void Island::read_impulses(std::pmr::vector<double>& impulses) const {
  impulses.clear();
  for (const contact::Row& row : rows_) impulses.insert(impulses.end(), row.impulse.data(), row.impulse.data() + 3);
  for (std::size_t i = 0; i < scalars_.size(); ++i)
    if (!is_motor(i)) impulses.push_back(scalars_[i].impulse);
}

/// Solves the rows without rebound, then with it, and goes from the first solution toward the second as far as
/// contacts, limits and loops together give no energy: with several at once, Newton's law may.
void Island::solve_rebounding() {
  solve_rows();
  read_row_rates(plain_rates_);
  read_impulses(plain_impulses_);
  plain_scalars_.clear();
  for (const contact::ScalarRow& row : scalars_) plain_scalars_.push_back(row.impulse);
  for (Free& one : free_) std::copy_n(one.v, 6, one.plain_v);
  for (Tree* tree : trees_) tree->way = tree->state.v;
  for (std::size_t i = 0; i < rows_.size(); ++i)
    if (rebounding_[i] > 0) rows_[i].bias = rebounding_[i];
  for (std::size_t i = 0; i < scalars_.size(); ++i)
    if (rebounding_[rows_.size() + i] > 0) scalars_[i].bias = rebounding_[rows_.size() + i];
  reset_velocities();
  solve_rows();
  read_row_rates(rates_);
  read_impulses(impulses_);
  const auto gained = [&](double share) {
    double sum = 0;
    for (std::size_t i = 0; i < rates_.size(); ++i) {
      const double impulse = plain_impulses_[i] + share * (impulses_[i] - plain_impulses_[i]);
      const double rate = plain_rates_[i] + share * (rates_[i] - plain_rates_[i]);
      sum += 0.5 * impulse * (free_rates_[i] + rate);
    }
    return sum;
  };
  const double least = gained(0), full = gained(1);
  if (!(full > std::max(least, 0.0))) return;
  // A parabola through three points, which crosses zero between the ends.
  const double a = 2 * (full + least) - 4 * gained(0.5), b = full - least - a;
  const double root = std::abs(a) > 0 ? (-b + std::sqrt(std::max(0.0, b * b - 4 * a * least))) / (2 * a) : -least / b;
  mix(std::isfinite(root) ? std::clamp(root, 0.0, 1.0) : 0.0);
}

/// Impulses and velocities between the two solutions.
void Island::mix(double share) {
  std::size_t at = 0;
  const auto between = [share](double& value, double plain) { value = plain + share * (value - plain); };
  for (contact::Row& row : rows_)
    for (int k = 0; k < 3; ++k) between(row.impulse[k], plain_impulses_[at++]);
  for (std::size_t i = 0; i < scalars_.size(); ++i) between(scalars_[i].impulse, plain_scalars_[i]);
  for (Free& one : free_)
    for (int k = 0; k < 6; ++k) between(one.v[k], one.plain_v[k]);
  for (Tree* tree : trees_) tree->state.v = tree->way + share * (tree->state.v - tree->way);
}

void Island::reset_velocities() {
  for (Free& one : free_) std::copy_n(one.free_v, 6, one.v);
  for (Tree* tree : trees_) tree->state.v = tree->free_v;
}

}  // namespace breve
