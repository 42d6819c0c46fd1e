// Overlap and open rings: positions alone are put right, nothing gets velocity.
#include <algorithm>
#include <cmath>

#include "runtime/articulated/kinematics.hpp"
#include "runtime/base/rotation_vector.hpp"
#include "runtime/dynamics/island.hpp"

namespace breve {

namespace {

// The softness of a push, as a part of that of the two bodies if they were free. If joints leave a body hardly any way
// along the normal, that way would be long: none is forced that is longer than some fifty times the overlap.
constexpr double kYield = 1e-4;

}  // namespace

/// What a push moves there, were the body free, 1/kg.
double Island::natural_response(BodyIndex body) const {
  return core_.slot_of[body].mover < 0 ? 0 : 1 / core_.bodies->mass(body);
}

void Island::push_apart(double h) {
  // The part of the overlap for one sub-step. Sweeps leave an uneven rest: pushed apart faster, stacks begin to sway.
  const double share = accuracy_.direct ? 0.2 : 0.1;
  constexpr double kFastestPush = 3;  // m/s or rad/s, along which nothing is moved faster
  bool any = false;
  double fastest = 0;
  pushes_.clear();
  push_scalars_.clear();
  for (const Touch& touch : touches_) {
    const NearPair& pair = *pairs_[touch.pair];
    const double deep = -touch.gap - 0.1 * kSkin * size_of_pair(pair);
    // A contact that is not too deep may come nearer by the room that there is.
    const double rate = deep > 0 ? std::min(share * deep / h, kFastestPush) : std::min(0.0, -touch.gap / h);
    pushes_.push_back({rate, kYield * (natural_response(pair.a) + natural_response(pair.b)), 0});
    fastest = std::max(fastest, rate);
    any = any || deep > 0;
  }
  for (const Bound& bound : bounds_) {
    if (!bound.rests) continue;
    push_scalars_.push_back(std::min(-share * std::min(bound.gap, 0.0) / h, kFastestPush));
    fastest = std::max(fastest, push_scalars_.back());
    any = any || bound.gap < -kLimitSkin;
  }
  push_scalars_.resize(scalars_.size(), 0.0);
  if (any) {
    const double before = result.ledger.contact_loss;
    move_by_pushes(fastest, h);
    shorten_pushes(before, h);
    pay_for_moves(before - result.ledger.contact_loss);
  }
  close_loops();
}

/// Moves everything for h seconds by the velocities that pushes_ and push_scalars_ ask for.
/// @param fastest  of these velocities, m/s or rad/s
void Island::move_by_pushes(double fastest, double h) {
  contact::SolveSettings settings;
  // Only a part of an overlap is put right: how exactly does not matter, least where velocities are not exact either.
  settings.iterations = accuracy_.direct ? accuracy_.iterations : std::max(4, accuracy_.iterations / 4);
  settings.direct = rows_.empty();
  settings.tolerance = std::max(settings.tolerance, 1e-3 * fastest);
  settings.meter = &meter_;
  if (settings.direct) settings.tolerance = 1e-14;
  book_moves(-1);
  begin_moves();
  contact::solve_again(pushes_, push_scalars_, settings, workspace_);
  end_moves(h);
  book_moves(1);
}

/// What pushing trees apart may give in a sub-step of h seconds, J: a little of what moves, which pays for it, and,
/// where something outside holds them, what lifts them by a little of their size each second, however many sub-steps
/// that has. What falls freely need not be lifted: its centre of mass stays on its way. Springs that press bodies into
/// one another, or beyond limits, are not to be wound up for nothing, nor is a body that spins to be drawn out.
double Island::payable(double h) const {
  constexpr double kLift = 0.06;  // of their size, 1/s
  if (trees_.empty()) return JointDrive::kNoLimit;
  const bool falls = !touched_from_outside() &&
                     std::all_of(clusters_.begin(), clusters_.end(), [](const Clustered& one) { return one.loose; });
  return kFew * moving() + (falls ? 0 : kLift * h * weight());
}

/// Takes back of what move_by_pushes() has just moved what gives more than is payable: energy is not linear in the way,
/// so that this takes some tries, and the last one takes back all.
/// @param before  J, that contacts had lost before
void Island::shorten_pushes(double before, double h) {
  constexpr int kTries = 4;
  double left = 1;  // of the way
  for (int i = 1; i <= kTries && left > 0; ++i) {
    const double given = before - result.ledger.contact_loss, most = payable(h);
    if (!(given > most)) return;
    const double kept = i < kTries ? left * most / given : 0;
    take_back_pushes(left - kept, h);
    left = kept;
  }
}

/// Takes back a part of the way that move_by_pushes() made in h seconds.
void Island::take_back_pushes(double part, double h) {
  book_moves(-1);
  for (Tree* tree : trees_) {
    tree->free_v = tree->state.v;
    tree->state.v = tree->push;
  }
  note_wholes(&Tree::free_v, false);
  end_moves(-part * h);
  book_moves(1);
}

/// The way of a sub-step is that of a constant force. Where it is another (what presses on a limit may swing there and
/// back meanwhile) a joint that was stopped would stand beyond its limit: it is put where it began, or to the limit.
void Island::hold_bounds(double h) {
  push_scalars_.clear();
  double fastest = 0;
  for (const Bound& bound : bounds_) {
    if (!bound.rests) continue;
    const double gap = bound.sign * (core_.read_position(core_.joints[bound.joint])[bound.axis] - bound.limit);
    push_scalars_.push_back((std::min(bound.gap, 0.0) - gap) / h);
    fastest = std::max(fastest, push_scalars_.back());
  }
  if (!(fastest * h > kLimitSkin)) return;
  push_scalars_.resize(scalars_.size(), 0.0);
  pushes_.clear();
  for (const Touch& touch : touches_) {
    const NearPair& pair = *pairs_[touch.pair];
    const double yields = natural_response(pair.a) + natural_response(pair.b);
    pushes_.push_back({std::min(0.0, -touch.gap / h), kYield * yields, 0});
  }
  move_by_pushes(fastest, h);
}

/// The rows' solution is taken as a velocity that lasts h and then is gone. Between these two the movers have none.
void Island::begin_moves() {
  for (Free& one : free_) std::fill(one.v, one.v + 6, 0.0);
  for (Tree* tree : trees_) {
    tree->free_v = tree->state.v;
    tree->state.v.setZero();
  }
  note_wholes(&Tree::free_v, false);
}

void Island::end_moves(double h) {
  for (Free& one : free_) {
    const Vector3 way = h * Vector3(one.v[0], one.v[1], one.v[2]);
    one.now.center += way;
    book_way(one.now.force.dot(way), nullptr);
    const Vector3 rotation = h * Vector3(one.v[3], one.v[4], one.v[5]);
    if (rotation != Vector3::Zero()) one.now.orientation = (rotation_by(rotation) * one.now.orientation).normalized();
  }
  for (Tree* tree : trees_) {
    tree->push = tree->state.v;
    tree->way = h * tree->push;
    tree->state.v = tree->free_v;
    articulated::move(tree->model, tree->state.q, tree->way, tree->state.q);
    if (tree->driven) book_way(tree->set_tau.dot(tree->way), tree);
  }
  keep_wholes(h, Given::Pushes);
}

/// Notes what contacts and limits struck so that it is nearer, having moved for h seconds with the mean of the
/// velocities before and after, than it may be. What rests, rolls or slides is not.
/// @return  whether there is something
bool Island::find_struck(double h) {
  struck_.assign(movers_.size(), 0);
  bool any = false;
  // Where impacts are located, only what rotates toward a row from afar comes too near; `balanced` does not see that.
  const bool all = spent_ || trees_.empty();
  if (!all && accuracy_.rung == Rung::Balanced) return false;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const contact::Row& row = rows_[i];
    if (row.impulse == Vector3::Zero() || !(all || touches_[i].far)) continue;
    const double gap = touches_[i].gap, before = before_[2 * i][0] - before_[2 * i + 1][0];
    const double after = rate_of(row, true)[0] - rate_of(row, false)[0];
    if (gap + 0.5 * h * (before + after) >= std::min(gap, 0.0) - kTouchSkin * size_of_pair(*pairs_[touches_[i].pair]))
      continue;
    any = true;
    if (row.a >= 0) struck_[static_cast<std::size_t>(row.a)] = 1;
    if (row.b >= 0) struck_[static_cast<std::size_t>(row.b)] = 1;
  }
  std::size_t k = 0;
  for (const Bound& bound : bounds_) {
    if (!bound.rests) continue;
    const contact::ScalarRow& row = scalars_[k++];
    if (row.impulse == 0 || !all) continue;
    const double reached = bound.gap + 0.5 * h * (bound.rate + rate_of(row));
    if (reached >= std::min(bound.gap, 0.0) - kLimitSkin) continue;
    any = true;
    struck_[static_cast<std::size_t>(row.a)] = 1;
  }
  return any;
}

/// Contacts that are solved only at the end of a sub-step of h seconds must not come nearer than they are: a body that
/// contacts struck has moved, in the end, with the velocity that they left it, not with the mean.
void Island::hold_off(double h) {
  if (!find_struck(h)) return;
  book_moves(-1);
  note_wholes(&Tree::smooth_v, true);
  // Semi-implicit Euler has moved them with the velocity after, but for the rows' part.
  const bool semi = semi_implicit(accuracy_);
  for (std::size_t i = 0; i < free_.size(); ++i) {
    if (!struck_[i]) continue;
    const Free& one = free_[i];
    FreeBody& body = free_[i].now;
    const Vector3 from = semi ? Vector3(one.free_v[0], one.free_v[1], one.free_v[2]) : one.before.velocity;
    const Vector3 spin = semi ? Vector3(one.free_v[3], one.free_v[4], one.free_v[5]) : one.before.spin;
    const Vector3 way = 0.5 * h * (body.velocity - from);
    body.center += way;
    book_way(one.now.force.dot(way), nullptr);
    const Vector3 rotation = 0.5 * h * (body.spin - spin);
    if (rotation != Vector3::Zero()) body.orientation = (rotation_by(rotation) * body.orientation).normalized();
  }
  for (const Clustered& one : clusters_)
    for (Tree* tree : one.entry->system->trees()) {
      if (one.semi || !struck_[free_.size() + static_cast<std::size_t>(tree->slot)]) continue;
      tree->way = 0.5 * h * (tree->state.v - tree->sub_state.v);
      articulated::move(tree->model, tree->state.q, tree->way, tree->state.q);
      if (tree->driven) book_way(tree->set_tau.dot(tree->way), tree);
    }
  keep_wholes(0.5 * h, Given::Places);
  book_moves(1);
}

/// What pushing apart gave or took, as height, in motion or in springs, is booked as what contacts did: with a sign
/// before and after it.
void Island::book_moves(double sign) {
  double sum = 0;
  for (const Free& one : loose_bodies()) sum -= one.now.solid->mass * core_.settings.gravity.dot(one.now.center);
  sum += network_energy();
  for (const Clustered& one : clusters_) {
    for (const std::uint32_t index : one.entry->trees) {
      Tree& tree = *core_.trees[index];
      const Energy energy = core_.energy_of(tree);
      const double stored = energy.kinetic + energy.potential + energy.springs;
      if (one.alone()) tree.ledger.contact_loss -= sign * stored;
      sum += stored;
    }
    sum += spring_energy_in(one);
  }
  result.ledger.contact_loss -= sign * sum;
}

/// What pushing apart gave, J, is taken from what moves, as far as that is little of it.
void Island::pay_for_moves(double given) {
  if (trees_.empty() || !(given > 0)) return;
  const double all = moving();
  if (all > 0) take_from_all(std::min(kFew, given / all));
}

/// Scripts' forces work along the way that contacts and limits move positions, which bear it, J.
void Island::book_way(double work, Tree* tree) {
  result.ledger.script_work += work;
  result.ledger.contact_loss += work;
  if (!tree) return;
  tree->ledger.script_work += work;
  tree->ledger.contact_loss += work;
}

void Island::close_loops() {
  bool any = false;
  for (Tree* tree : trees_) any = any || !tree->loops.empty();
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
  for (int i = 0;; ++i) {
    place();
    make_rows(Motors::Leave);
    load_velocities();
    double worst = 0;
    for (std::size_t k = 0; k < scalars_.size(); ++k) {
      scalars_[k].bias = -loop_errors_[k];
      worst = std::max(worst, std::abs(loop_errors_[k]));
    }
    if (worst < kClosed || i == kMost) break;
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
/// that; the impulse at the end, which stops what still opens them, is found by close_loops. The rule is the same
/// forward and backward in time and moves nothing by hand, so that it neither gains nor loses energy in the long run.
/// Source: Andersen 1983 (RATTLE).
/// @return  false if no such impulse is found: near a position in which a ring may fold either way
bool Island::hold_loops(double time, double h) {
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
    const double worst = read_loop_errors();
    if (worst < kClosed) return true;
    if (!(worst < last)) return last < kFound;
    last = worst;
    for (std::size_t k = 0; k < scalars_.size(); ++k) {
      scalars_[k].bias = -loop_errors_[k] / h;
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
double Island::read_loop_errors() {
  std::size_t k = 0;
  double worst = 0;
  for (Tree* tree : trees_)
    for (const JointIndex index : tree->loops) {
      const LoopRows loop = core_.loop_rows(*tree, core_.joints[index].is);
      for (int i = 0; i < loop.count; ++i, ++k) {
        loop_errors_[k] = loop.rows[static_cast<std::size_t>(i)].error;
        worst = std::max(worst, std::abs(loop_errors_[k]));
      }
    }
  return worst;
}

}  // namespace breve
