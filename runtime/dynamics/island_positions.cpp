// Overlap and open rings: positions alone are put right, nothing gets velocity.
#include <algorithm>
#include <cmath>

#include "runtime/articulated/kinematics.hpp"
#include "runtime/base/rotation_vector.hpp"
#include "runtime/dynamics/island.hpp"

namespace breve {

void Island::push_apart(double h) {
  // Of the overlap, in one sub-step. What sweeps leave of it is uneven: pushed apart faster, stacks begin to sway.
  const double share = accuracy_.direct ? 0.2 : 0.1;
  constexpr double kFastestPush = 3;  // m/s, along which nothing is moved faster
  bool any = false;
  double fastest = 0;
  const auto want = [&fastest](std::pmr::vector<double>& of, double rate) {
    of.push_back(rate);
    fastest = std::max(fastest, rate);
  };
  apart_.clear();
  apart_scalars_.clear();
  for (const Touch& touch : touches_) {
    const double deep = -touch.gap - 0.1 * kSkin * size_of_pair(*pairs_[touch.pair]);
    // What is not too deep may come nearer by what room there is.
    want(apart_, deep > 0 ? std::min(share * deep / h, kFastestPush) : std::min(0.0, -touch.gap / h));
    any = any || deep > 0;
  }
  for (const Bound& bound : bounds_) {
    if (!bound.rests) continue;
    want(apart_scalars_, -share * std::min(bound.gap, 0.0) / h);
    any = any || bound.gap < -kLimitSkin;
  }
  apart_scalars_.resize(scalars_.size(), 0.0);
  if (any) {
    const double before = height();
    contact::SolveSettings settings;
    // Only a part of an overlap is put right: how exactly does not matter, least where velocities are not exact either.
    settings.iterations = accuracy_.direct ? accuracy_.iterations : std::max(4, accuracy_.iterations / 4);
    settings.direct = rows_.empty();
    settings.tolerance = std::max(settings.tolerance, 1e-3 * fastest);
    if (settings.direct) settings.tolerance = 1e-14;
    begin_moves();
    contact::solve_again(apart_, apart_scalars_, settings, workspace_);
    end_moves(h);
    pushed_ += height() - before;
  }
  close_rings();
}

/// The rows' solution is taken as a velocity that lasts h and then is gone. Between these two the movers have none.
void Island::begin_moves() {
  for (Free& one : free_) std::fill(one.v, one.v + 6, 0.0);
  for (Tree* tree : trees_) {
    tree->free_v = tree->state.v;
    tree->state.v.setZero();
  }
}

void Island::end_moves(double h) {
  for (Free& one : free_) {
    one.now.center += h * Vector3(one.v[0], one.v[1], one.v[2]);
    const Vector3 turn = h * Vector3(one.v[3], one.v[4], one.v[5]);
    if (turn != Vector3::Zero()) one.now.orientation = (rotation_by(turn) * one.now.orientation).normalized();
  }
  for (Tree* tree : trees_) {
    tree->way = h * tree->state.v;
    tree->state.v = tree->free_v;
    articulated::move(tree->model, tree->state.q, tree->way, tree->state.q);
  }
}

void Island::close_rings() {
  bool any = false;
  for (Tree* tree : trees_) any = any || !tree->rings.empty();
  if (!any) return;
  touches_.clear();
  bounds_.clear();
  constexpr int kMost = 4;  // Newton's method from a small error: two are enough but far from the solution
  constexpr double kClosed = 1e-13;
  contact::SolveSettings settings;
  settings.direct = true;
  settings.iterations = accuracy_.iterations;
  contact::SolveSettings exact = settings;
  exact.tolerance = 1e-14;  // a length here: rings are closed to round-off
  for (int i = 0; i < kMost; ++i) {
    place();
    make_rows(1, false);
    double worst = 0;
    for (std::size_t k = 0; k < scalars_.size(); ++k) {
      scalars_[k].bias = -ring_errors_[k];
      worst = std::max(worst, std::abs(ring_errors_[k]));
    }
    if (worst < kClosed) break;
    begin_moves();
    contact::solve_island(movers_, {}, scalars_, exact, workspace_);
    end_moves(1);
  }
  // Velocities along the rings where they stand now.
  for (contact::ScalarRow& row : scalars_) row.bias = 0, row.impulse = 0;
  load_velocities();
  contact::solve_island(movers_, {}, scalars_, settings, workspace_);
  store_velocities(0);
}

/// Rings alone: an impulse at the start that leaves them closed at the end of the smooth motion, found by repeating
/// that; the impulse at the end, which stops what still opens them, is found by close_rings. The rule is the same
/// forward and backward in time and moves nothing by hand, so that it neither gains nor loses energy in the long run.
/// Source: Andersen 1983 (RATTLE).
/// @return  false if no such impulse is found: near a position in which a ring may fold either way
bool Island::hold_rings(double time, double h) {
  constexpr int kMost = 8;  // each makes the gap smaller by the square of the angle that a link turns
  constexpr double kClosed = 1e-13;
  constexpr double kFound = 1e-9;  // what is left of so little is put right by hand
  for (Tree* tree : trees_) tree->kick.setZero();
  contact::SolveSettings settings;
  settings.direct = true;
  settings.iterations = accuracy_.iterations;
  settings.tolerance = kClosed;
  double last = JointDrive::kNoLimit;
  for (int i = 0; i < kMost; ++i) {
    restore();
    for (Tree* tree : trees_) tree->state.v += tree->kick;
    smooth(time, h);
    place_links();
    const double worst = read_ring_errors();
    if (worst < kClosed) return true;
    if (!(worst < last)) return last < kFound;
    last = worst;
    for (std::size_t k = 0; k < scalars_.size(); ++k) {
      scalars_[k].bias = -ring_errors_[k] / h;
      scalars_[k].impulse = 0;
    }
    for (Free& one : free_) std::fill(one.v, one.v + 6, 0.0);
    for (Tree* tree : trees_) {
      tree->way = tree->state.v;
      tree->state.v.setZero();
    }
    contact::solve_island(movers_, {}, scalars_, settings, workspace_);
    for (Tree* tree : trees_) {
      tree->kick += tree->state.v;
      tree->state.v = tree->way;
    }
  }
  return last < kFound;
}

/// How far the rings are open where the trees stand, m or rad; returns the largest.
double Island::read_ring_errors() {
  std::size_t k = 0;
  double worst = 0;
  for (Tree* tree : trees_)
    for (const JointIndex index : tree->rings) {
      const RingRows ring = core_.ring_rows(*tree, core_.joints[index].is);
      for (int i = 0; i < ring.count; ++i, ++k) {
        ring_errors_[k] = ring.rows[static_cast<std::size_t>(i)].error;
        worst = std::max(worst, std::abs(ring_errors_[k]));
      }
    }
  return worst;
}

}  // namespace breve
