// Joints that close loops.
#include "runtime/dynamics/island_loops.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/island_energy.hpp"

namespace breve::island {

bool Loops::in_stages() const {
  using articulated::Scheme;
  const Scheme scheme = state_.accuracy.scheme;
  if (scheme == Scheme::RungeKutta4 || scheme == Scheme::Fehlberg4 || scheme == Scheme::Fehlberg5 ||
      scheme == Scheme::FehlbergAdaptive)
    return true;
  return std::all_of(state_.clusters.begin(), state_.clusters.end(),
                     [](const Clustered& one) { return one.entry->system->can_be_finer(); });
}

/// Loops alone: an impulse at the start that leaves them closed at the end of the smooth motion, found by repeating
/// that; the impulse at the end, which stops what still opens them, is found by close(). The rule is the same
/// forward and backward in time and moves nothing by hand, so that it neither gains nor loses energy in the long run.
/// Source: Andersen 1983 (RATTLE).
bool Loops::hold(double time, double h) {
  constexpr int kMost = 8;           // each makes the gap smaller by the square of the angle by which a link rotates
  constexpr double kClosed = 1e-13;  // rad or length units
  constexpr double kFound = 1e-9;    // what is left of so little is put right by hand
  for (Tree* tree : state_.trees) tree->kick.setZero();
  contact::SolveSettings settings = state_.solve_settings();
  settings.direct = true;
  settings.tolerance = kClosed * state_.unit();
  double last = JointDrive::kNoLimit;
  for (int i = 0; i < kMost; ++i) {
    state_.restore();
    for (Tree* tree : state_.trees) tree->state.v += tree->kick;
    smooth_.move(time, h);
    state_.place_links();
    const double worst = read_errors();
    if (worst < kClosed) return true;
    if (!(worst < last)) return last < kFound;
    last = worst;
    for (std::size_t k = 0; k < rows_.loops(); ++k) {
      rows_.loop(k).bias = -rows_.loop_error(k).open / h;
      rows_.loop(k).impulse = 0;
    }
    for (Free& one : state_.free_bodies) std::fill(one.v, one.v + 6, 0.0);
    for (Tree* tree : state_.trees) {
      tree->way = tree->state.v;
      tree->state.v.setZero();
    }
    contact::solve_island(rows_.movers(), {}, rows_.scalars(), settings, rows_.workspace());
    for (Tree* tree : state_.trees) {
      tree->kick += tree->state.v;
      tree->state.v = tree->way;
    }
  }
  return last < kFound;
}

/// How far a loop of the tree stands open at most, rad or length units; 0 if no more than an integrator errs.
double Loops::gap_of(const Tree& tree) const {
  constexpr double kOpen = 1e-6;  // of the smaller body's size, or rad
  const auto size_of = [this](BodyIndex body) {
    return body != kNoBody && state_.core.bodies->dynamic(body) ? state_.shape(body).bounding_radius()
                                                                : JointDrive::kNoLimit;
  };
  double worst = 0;
  for (const JointIndex index : tree.loops) {
    const JointDescription& is = state_.core.joints[index].is;
    const LoopRows loop = state_.core.loop_rows(tree, is);
    const double most = kOpen * std::min(size_of(is.child), size_of(is.parent));
    for (int i = 0; i < loop.count; ++i) {
      const LoopRow& row = loop.rows[static_cast<std::size_t>(i)];
      const double open = std::abs(row.error);
      if (open > (row.angular ? kOpen : most)) worst = std::max(worst, open);
    }
  }
  return worst;
}

bool Loops::stand_open() const {
  return std::any_of(state_.trees.begin(), state_.trees.end(), [this](const Tree* tree) { return gap_of(*tree) > 0; });
}

void Loops::see_whose_gaps() {
  constexpr double kCloser = 0.5;  // of the gap, that a step is to leave
  for (Tree* tree : state_.trees) {
    if (tree->loops.empty() || tree->set_open == 0) continue;
    articulated::forward_kinematics(tree->model, tree->data, tree->state);
    const double gap = gap_of(*tree);
    tree->set_open = gap <= kCloser * tree->set_open ? gap : 0;
  }
}

bool Loops::left_to_rows() const {
  return std::any_of(state_.trees.begin(), state_.trees.end(), [](const Tree* tree) { return tree->unheld > 0; }) ||
         stand_open();
}

void Loops::leave_to_rows() {
  for (Tree* tree : state_.trees)
    if (!tree->loops.empty()) tree->unheld = kMostUnheld;
}

void Loops::note_left() {
  for (Tree* tree : state_.trees) tree->unheld = std::max(tree->unheld - 1, 0);
}

/// Positions first, then velocities along the loops.
void Loops::close(bool by_rows) {
  if (!state_.has_loops()) return;
  contacts_.clear();
  constexpr int kMost = 4;  // Newton's method from a small error: two are enough but far from the solution
  constexpr double kClosed = 1e-13;
  Closing closing;
  for (int i = 0;; ++i) {
    state_.place();
    rows_.make(Rows::Motors::Leave);
    state_.load_velocities();
    double worst = 0;
    for (std::size_t k = 0; k < rows_.loops(); ++k) worst = std::max(worst, std::abs(rows_.loop_error(k).units()));
    if (worst < kClosed || i == kMost) break;
    if (i == 0) closing = begin_closing(by_rows);
    if (!approach(closing)) break;
  }
  close_velocities();
}

Loops::Closing Loops::begin_closing(bool by_rows) {
  constexpr double kUnseen = 1e-9;  // of weight(): the round-off of links that lie still
  Closing closing;
  closing.open = stand_open();
  // What stages gain that tear a loop open is left to the guard: finer ones do not tear it.
  const bool torn = closing.open && !by_rows;
  closing.theirs = torn || std::any_of(state_.trees.begin(), state_.trees.end(),
                                       [](const Tree* tree) { return !tree->loops.empty() && tree->set_open > 0; });
  if (closing.theirs) return closing;
  closing.rows = books_.payable(by_rows);
  closing.rows.all += kUnseen * weight(state_);
  closing.rows.springs += kUnseen * weight(state_);
  if (carries()) return closing;
  constexpr double kErred = 1e-7;  // of the motion: an integrator errs by as much, to both sides
  const double moving = momentum_.moving(Payers::Looped);
  closing.motion = by_rows ? moving : kFew * moving;  // after rows all of it pays for the gain of the whole sub-step
  closing.free = kErred * moving;
  return closing;
}

/// One step of Newton's method towards closed loops, for rows that were made where the trees stand. It is shortened
/// until the sum of the squares of their errors falls: near a pose in which links may fold, round-off divided by next
/// to nothing would take them anywhere. Rows of loops that stand open may contradict one another: they yield a little,
/// so that there is a step at all. It is no longer than can be paid for.
///
/// Source: Nocedal and Wright 2006, 10.3 (Levenberg-Marquardt).
/// @return  false if nothing was gained: the trees stand where they stood
bool Loops::approach(Closing& closing) {
  constexpr double kYield = 1e-6;    // of a row's own response
  constexpr double kShorter = 0.25;  // of a step that leads away
  constexpr double kShortest = 0.01;
  contact::SolveSettings exact = state_.solve_settings();
  exact.direct = true;
  exact.tolerance = 1e-14 * state_.unit();  // a length here: loops are closed to round-off
  const double before = errors_squared();
  const Stored held = read_stored();
  for (std::size_t k = 0; k < rows_.loops(); ++k) {
    contact::ScalarRow& row = rows_.loop(k);
    row.bias = -rows_.loop_error(k).open;
    if (closing.open) row.softness = kYield * rows_.response(row);
  }
  positions_.begin_moves();
  contact::solve_island(rows_.movers(), {}, rows_.scalars(), exact, rows_.workspace());
  positions_.end_moves(1);
  double length = 1;
  for (;;) {
    state_.place_links();
    if (errors_squared() < before && pay_for_closing(held, closing)) return true;
    if (length < kShortest) break;
    positions_.move_back((1 - kShorter) * length);
    length *= kShorter;
  }
  positions_.move_back(length);
  state_.place();
  rows_.make(Rows::Motors::Leave);
  return false;
}

/// Loops are drawn together for no more than rows took in the sub-step, and than motion of the links pays for: planks
/// of a straight bridge may all move across it, as far as velocities tell, and would be lifted for nothing in each
/// sub-step. A gap stays where nothing pays.
/// @param held  before they were drawn together
/// @return      whether it is paid for
bool Loops::pay_for_closing(const Stored& held, Closing& closing) {
  const Stored now = read_stored();
  if (closing.theirs) return pay_for_theirs(held, now);
  const double given = now.all - held.all - (now.script - held.script);
  const double to_springs = now.springs - held.springs;
  if (given > closing.rows.all + closing.motion || to_springs > closing.rows.springs + closing.motion) return false;
  const double by_motion = std::max(0.0, given - closing.rows.all);
  // Contacts gave nothing that motion pays for.
  if (touches()) state_.result.ledger.contact_loss -= now.all - held.all - by_motion;
  closing.rows.all = std::max(0.0, closing.rows.all - given);
  closing.rows.springs = std::max(0.0, closing.rows.springs - to_springs);
  closing.motion -= by_motion;
  if (by_motion > closing.free) positions_.pay_for_moves(by_motion, false, Payers::Looped);
  return true;
}

/// A body that spins or has springs is drawn together no more than its motion pays for. Contacts part what loops draw
/// together and take the energy that it gains, so that it is booked with theirs; in a body that touches nothing it is
/// unexplained energy, which the guard tells.
bool Loops::pay_for_theirs(const Stored& held, const Stored& now) {
  const double given = now.inner - held.inner - (now.script - held.script);
  if (given > positions_.payable_by_motion()) return false;
  const bool by_contacts = touches();
  if (by_contacts) state_.result.ledger.contact_loss -= now.all - held.all;
  positions_.pay_for_moves(given, by_contacts, Payers::Trees);
  return true;
}

/// Velocities along the loops where they stand now.
void Loops::close_velocities() {
  contact::SolveSettings settings = state_.solve_settings();
  settings.direct = true;
  // Their remainder is divided by the distance from a pose in which a loop may fold either way: `reference`, which
  // steps up to it, leaves round-off only.
  constexpr double kExact = 1e-14;
  if (state_.accuracy.rung == Rung::Reference) settings.tolerance = kExact * state_.unit();
  for (contact::ScalarRow& row : rows_.scalars()) row.bias = 0, row.impulse = 0;
  state_.load_velocities();
  contact::solve_island(rows_.movers(), {}, rows_.scalars(), settings, rows_.workspace());
  state_.store_velocities();
}

/// How far the loops are open where the trees stand; returns the largest, in rad or length units.
double Loops::read_errors() {
  std::size_t k = 0;
  double worst = 0;
  for (Tree* tree : state_.trees)
    for (const JointIndex index : tree->loops) {
      const LoopRows loop = state_.core.loop_rows(*tree, state_.core.joints[index].is);
      for (int i = 0; i < loop.count; ++i, ++k) {
        rows_.loop_error(k).open = loop.rows[static_cast<std::size_t>(i)].error;
        worst = std::max(worst, std::abs(rows_.loop_error(k).units()));
      }
    }
  return worst;
}

/// Other bodies touch trees with loops: the motion with which they press a loop open is not to close it.
bool Loops::carries() const {
  const auto looped = [](const BodySlot& slot) { return slot.tree && !slot.tree->loops.empty(); };
  return std::any_of(state_.pairs.begin(), state_.pairs.end(), [&](const NearPair* pair) {
    const BodySlot a = state_.slot_of(pair->a), b = state_.slot_of(pair->b);
    return pair->touching && (looped(a) ? b.mover >= 0 && !looped(b) : a.mover >= 0 && looped(b));
  });
}

bool Loops::touches() const {
  return std::any_of(state_.pairs.begin(), state_.pairs.end(), [](const NearPair* pair) { return pair->touching; });
}

Loops::Stored Loops::read_stored() {
  Stored sum;
  sum.script = state_.result.ledger.script_work;
  for (const Clustered& one : state_.clusters) {
    sum.springs += spring_energy(state_, one);
    for (const std::uint32_t index : one.entry->trees) {
      const Energy energy = state_.core.energy_of(*state_.core.trees[index]);
      sum.springs += energy.springs;
      sum.inner += energy.kinetic;
      sum.all += energy.potential;
    }
  }
  sum.inner += sum.springs;
  sum.all += sum.inner;
  return sum;
}

/// The sum of the squares of what read_errors() finds.
double Loops::errors_squared() {
  read_errors();
  double sum = 0;
  for (std::size_t k = 0; k < rows_.loops(); ++k) sum += rows_.loop_error(k).units() * rows_.loop_error(k).units();
  return sum;
}

}  // namespace breve::island
