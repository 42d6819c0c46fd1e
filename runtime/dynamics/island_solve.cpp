// The solution of an island's rows, and how it moves what it changed.
#include "runtime/dynamics/island_solve.hpp"

#include <algorithm>

#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/island_energy.hpp"

namespace breve::island {

void Solver::solve_after(double h) {
  rows_.make(Rows::Motors::Drive);
  rows_.recall_rates();
  begin(h);
  if (rows_.empty()) return;
  const bool rebounds = contacts_.spent() && rebounds_.find(h);
  if (rebounds) rebounds_.note_free();
  rebounds ? solve_rebounding(h) : solve_rows();
  if (!shorten_couples(h)) return;
  state_.reset_velocities();
  rows_.set_biases(h);
  rebounds ? solve_rebounding(h) : solve_rows();
}

/// Velocities as they were without what was predicted, and the impulses at which the solution begins.
void Solver::begin(double h) {
  state_.load_velocities();
  // It acted along the rows as they lay when the sub-step began: what is taken away is what it gave, so that nothing is
  // left that no row pushes along.
  for (Tree* tree : state_.trees) {
    if (tree->loads.reacts || tree->braced) tree->free_v -= h * tree->reacted;
  }
  rows_.set_length(h);
  double given = 0;
  if (prediction_.strained())
    rows_.begin_cold();
  else
    given = follow_arms(h);
  rows_.note_starts(h, given);
  for (Tree* tree : state_.trees) tree->state.v = tree->free_v;
  rows_.set_biases(h);
  bound_motors(h);
}

/// Rows push free bodies along the arms that end the sub-step. A force that lasts works along the mean of those at its
/// start and at its end: the couple that is the difference is given here. Without it a body that rotates about an edge
/// on the floor would gain energy in proportion to the sub-step.
/// @return  J, that the couples gave
double Solver::follow_arms(double h) {
  double given = 0;
  for (std::size_t i = 0; i < rows_.contacts(); ++i) {
    const auto& [touch, pair, row, law] = rows_.contact(i);
    if (touch.predicted == Vector3::Zero()) continue;
    for (const bool first : {true, false}) {
      const int index = first ? row.a : row.b;
      if (index < 0 || (first ? row.ja : row.jb) || state_.is_driver(index)) continue;
      Free& one = state_.free_bodies[static_cast<std::size_t>(index)];
      const Vector3 couple = (first ? -0.5 : 0.5) * rows_.arm_change(touch, first, one, h).cross(touch.predicted);
      const Vector3 spin = h * (rows_.movers()[static_cast<std::size_t>(index)].inverse_inertia * couple);
      const Vector3 before(one.v[3], one.v[4], one.v[5]);
      given += h * couple.dot(before + 0.5 * spin);
      for (int k = 0; k < 3; ++k) one.v[3 + k] = one.free_v[3 + k] += spin[k];
    }
  }
  return given;
}

/// Without rebound, then with it.
void Solver::solve_rebounding(double h) {
  solve_rows();
  rebounds_.ask();
  solve_rows();
  rebounds_.settle(h);
}

void Solver::solve_rows() {
  const double stopped = state_.drivers > 0 ? rows_.fastest() : 0;
  solve_once();
  if (rows_.squeezed(stopped)) solve_once();
}

void Solver::solve_once() {
  contact::SolveSettings settings = state_.solve_settings();
  const int fast = state_.core.settings.fast_contacts;
  if (fast > 0) settings.iterations = fast;
  constexpr double kSwept = 0.1;  // of the speed that is rest
  // Operations of a direct solution. Bodies that begin at rest take all of them in one step: more on `fast`, where each
  // other step is cheap, would make the first one of a pyramid more than ten times as long as those after it.
  constexpr double kBurdened = 2e6, kStanding = 5e7, kStandingOnFast = 1.8e7;
  settings.direct = fast == 0;
  // How loops close that are left to the rows depends on their last digits.
  settings.lean = !state_.accuracy.direct && !state_.has_loops();
  settings.direct_share = direct_share();
  if (burdened()) settings.direct_most = kBurdened;
  if (stands()) settings.direct_most = state_.accuracy.direct ? kStanding : kStandingOnFast;
  // Where `fast` solves directly, no digit that cannot be seen in a step is worth a linear solve.
  constexpr double kUnseen = 1e-3;  // of the speed that is rest
  if (!state_.accuracy.direct) settings.tolerance = std::max(settings.tolerance, kUnseen * contacts_.resting());
  // Sweeps that no exact solution follows end when they change less than could be seen, or a hundredth of that.
  settings.swept = (state_.accuracy.direct ? 0.01 * kSwept : kSwept) * contacts_.resting();
  const contact::SolveReport report =
      contact::solve_island(rows_.movers(), rows_.rows(), rows_.scalars(), settings, rows_.workspace());
  state_.result.counters.solver_iterations += static_cast<std::uint64_t>(report.iterations + report.newton);
  state_.result.counters.direct += report.direct;
  state_.result.counters.residual = std::max(state_.result.counters.residual, report.residual);
}

/// Bodies without joints that are hardly faster than what falls for two sub-steps. Sweeps leave each body of a stack a
/// little of its fall, and it leans more and more; what stands is solved once, and then begins at its solution.
bool Solver::stands() const {
  constexpr double kFall = 2;
  if (!state_.trees.empty() || state_.drivers > 0) return false;
  const double most = kFall * state_.core.settings.gravity.norm() * rows_.length();
  return std::all_of(state_.free_bodies.begin(), state_.free_bodies.end(), [&](const Free& one) {
    const double radius = state_.shape(one.body).bounding_radius();
    return one.before.velocity.squaredNorm() <= most * most &&
           radius * radius * one.before.spin.squaredNorm() <= most * most;
  });
}

/// A body presses on links that are far lighter. The sweeps that find what carries it are as many as the ratio of the
/// masses: with fewer, it sinks in.
bool Solver::burdened() const {
  constexpr double kHeavy = 10;  // times
  if (state_.trees.empty() || state_.accuracy.direct) return false;
  for (std::size_t i = 0; i < rows_.contacts(); ++i) {
    const auto& [touch, pair, row, law] = rows_.contact(i);
    if (row.ja && (row.b < 0 || row.jb)) continue;  // links alone
    const double a = state_.natural_response(pair.a), b = state_.natural_response(pair.b);
    if (std::min(a, b) > 0 && std::max(a, b) > kHeavy * std::min(a, b)) return true;
  }
  return false;
}

/// How many times the operations of the sweeps a direct solution may take: those that a stack would need to come as
/// near to the solution are many more than are allowed. Only `reference` has no bound.
double Solver::direct_share() const {
  constexpr double kSwept = 3, kSolved = 10, kExact = 100;
  // Sweeps hardly close a loop that something presses on.
  if (!state_.accuracy.direct) return state_.has_loops() ? kSolved : kSwept;
  switch (state_.accuracy.rung) {
    case Rung::Reference: return JointDrive::kNoLimit;
    case Rung::Precise: return kExact;
    default: return kSolved;
  }
}

/// After smooth motion of h seconds: what is left of each motor's strength, and the speed that it is to reach.
void Solver::bound_motors(double h) {
  if (rows_.motors() == 0) return;
  for (Tree* tree : state_.trees)
    if (tree->aimed) state_.core.aim(*tree);
  for (std::size_t i = 0; i < rows_.motors(); ++i) {
    const auto& [motor, row] = rows_.motor(i);
    const double given = motor.tree->motor_impulse[motor.velocity], most = motor.strength * h;
    row.bias = motor.tree->loads.motor_speed[motor.velocity];
    row.lo = std::min(0.0, -most - given);
    row.hi = std::max(0.0, most - given);
  }
}

/// The couple of a ball joint's motor is bounded as a whole: where its three numbers are more than that together, each
/// is bounded by its share.
/// @return  whether some were: the rows are to be solved again
bool Solver::shorten_couples(double h) {
  constexpr double kRoundOff = 1e-9;
  bool any = false;
  for (std::size_t i = 0; i < rows_.motors(); ++i) {
    const MotorRow& motor = rows_.motor(i).motor;
    if (motor.shared < 3) continue;
    const auto row = [this, i](std::size_t k) -> contact::ScalarRow& { return rows_.motor(i + k).row; };
    const Vector3 given = motor.tree->motor_impulse.segment<3>(motor.velocity);
    const Vector3 whole = given + Vector3(row(0).impulse, row(1).impulse, row(2).impulse);
    const double most = motor.strength * h;
    if (!(whole.norm() > (1 + kRoundOff) * most)) continue;
    const Vector3 left = whole * (most / whole.norm()) - given;
    for (std::size_t k = 0; k < 3; ++k) {
      row(k).lo = std::min(0.0, left[static_cast<int>(k)]);
      row(k).hi = std::max(0.0, left[static_cast<int>(k)]);
    }
    any = true;
  }
  return any;
}

/// An impulse changes velocities where the sub-step ends, and by half of that the way to there, as if it had acted all
/// along. Links that a blow throws would rotate far by that, with rates that belong to where they were, and gain
/// energy: it acts the later the more they would gain. Or, where impacts are located or rows hold loops, and something
/// outside holds or touches the tree, links keep their momenta all the way. Motors alone push all along.
void Solver::limit_moves(double moved_h) {
  const bool struck = rows_.contacts() > 0, touched = momentum_.touched_from_outside();
  for (const Clustered& one : state_.clusters)
    for (Tree* tree : one.entry->system->trees()) {
      tree->way = (one.semi ? 2 : 1) * moved_h * (tree->state.v - tree->smooth_v);
      const bool by_loops = rows_.loops() > 0 && !tree->loops.empty();
      tree->carried = (touched || !tree->loose) && (by_loops || (struck && state_.accuracy.locate_impacts));
      tree->row_share = struck && !tree->carried ? share_without_gain(*tree, tree->way) : 1;
    }
}

/// Bodies that are pushed by a contact whose force did not act before.
void Solver::find_struck() {
  for (Free& one : state_.free_bodies) one.struck = false;
  for (std::size_t i = 0; i < rows_.contacts(); ++i) {
    const auto& [touch, pair, row, law] = rows_.contact(i);
    if (row.impulse == Vector3::Zero() || touch.predicted != Vector3::Zero()) continue;
    for (const int mover : {row.a, row.b})
      if (mover >= 0 && static_cast<std::size_t>(mover) < state_.free_bodies.size())
        state_.free_bodies[static_cast<std::size_t>(mover)].struck = true;
  }
}

namespace {

/// Of bodies without joints and their springs, J.
double energy_of_free(State& state) {
  double sum = network_energy(state);
  for (const Free& one : state.loose_bodies())
    sum += one.now.kinetic() - one.now.solid->mass * state.core.settings.gravity.dot(one.now.center);
  return sum;
}

/// Likewise where smooth motion has led to: what the rows took of motion, J.
double taken_by_rows(const State& state) {
  double sum = 0;
  for (const Free& one : state.loose_bodies()) {
    FreeBody smooth = one.now;
    smooth.velocity = Vector3(one.free_v[0], one.free_v[1], one.free_v[2]);
    smooth.spin = Vector3(one.free_v[3], one.free_v[4], one.free_v[5]);
    sum += smooth.kinetic() - one.now.kinetic();
  }
  return sum;
}

}  // namespace

/// The part of the way that moved_h seconds of what rows changed give, after which all that they pushed is apart.
double Solver::share_to_part(double moved_h) const {
  double share = 0;
  for (std::size_t i = 0; i < rows_.contacts(); ++i) {
    const auto& [touch, pair, row, law] = rows_.contact(i);
    if (!(row.impulse[0] > 0)) continue;
    const double way = moved_h * rows_.normal_change(i);
    const double left = rows_.gap_now(touch) - std::min(0.0, touch.gap);
    if (way > 0) share = std::max(share, 1 - left / way);
  }
  return std::clamp(share, 0.0, 1.0);
}

/// After the rows moved positions: a force that is constant over a sub-step moves bodies on stiff springs as far as if
/// nothing pulled them back meanwhile, and winds the springs up. Where that gives more than the rows took, these bodies
/// go only as far as they have to be apart.
void Solver::move_networks_back(double moved_h) {
  const double share = share_to_part(moved_h);
  for (std::size_t i = state_.networks_begin(); i < state_.networks_end(); ++i) {
    Free& one = state_.free_bodies[i];
    const Vector3 change(one.v[0] - one.free_v[0], one.v[1] - one.free_v[1], one.v[2] - one.free_v[2]);
    one.now.center -= (1 - share) * moved_h * change;
  }
}

void Solver::move_by_impulses(double moved_h, std::optional<double> smooth) {
  const bool springs = !state_.networks.empty() && rows_.contacts() > 0 && state_.trees.empty() && state_.drivers == 0;
  const double taken = springs ? taken_by_rows(state_) : 0;
  const double before = !springs ? 0 : smooth ? *smooth : energy_of_free(state_) + taken;
  find_struck();
  double gained = 0;
  for (Free& one : state_.free_bodies) {
    const Vector3 change(one.v[0] - one.free_v[0], one.v[1] - one.free_v[1], one.v[2] - one.free_v[2]);
    const Vector3 rotation(one.v[3] - one.free_v[3], one.v[4] - one.free_v[4], one.v[5] - one.free_v[5]);
    one.now.center += moved_h * change;
    gained += one.now.rotate(moved_h * rotation, contacts_.unseen_spin(one));
  }
  rows_.note_given(gained);
  if (springs && energy_of_free(state_) - before > kFew * (state_.swung + std::abs(taken))) move_networks_back(moved_h);
  momentum_.note(&Tree::smooth_v, false);
  // Semi-implicit Euler moves with the velocity after.
  for (const Clustered& one : state_.clusters)
    for (Tree* tree : one.entry->system->trees()) {
      tree->way = (one.semi ? 2 : 1) * tree->row_share * moved_h * (tree->state.v - tree->smooth_v);
      if (tree->carried)
        move_without_gain(state_, *tree, tree->way);
      else
        articulated::move(tree->model, tree->state.q, tree->way, tree->state.q);
    }
  momentum_.give_impulses(moved_h);
}

}  // namespace breve::island
