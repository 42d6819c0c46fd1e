// Positions that are put right by hand.
#include "runtime/dynamics/island_positions.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/island_energy.hpp"
#include "runtime/dynamics/joint_reader.hpp"

namespace breve::island {

namespace {

// The softness of a push, as a part of that of the two bodies if they were free. Where joints let a body
// hardly move along the normal, it would have to move far: no motion is forced that is longer than some fifty times the
// overlap.
constexpr double kYield = 1e-4;

constexpr double kLift = 0.04;  // 1/s, of their size, that bodies may be lifted where nothing moves to pay for it

}  // namespace

Positions::Positions(State& state, Contacts& contacts, Rows& rows, Momentum& momentum, Credit& credit)
    : state_(state),
      contacts_(contacts),
      rows_(rows),
      momentum_(momentum),
      credit_(credit),
      pushes_(state.memory),
      scalar_pushes_(state.memory),
      struck_(state.memory),
      shares_(state.memory) {}

double Positions::softness(const NearPair& pair) const {
  return kYield * (state_.natural_response(pair.a) + state_.natural_response(pair.b));
}

/// Pushes apart what still overlaps after h seconds, by a part of the overlap.
void Positions::push_apart(double h) {
  // The part of the overlap for one sub-step. Sweeps leave an uneven rest: pushed apart faster, stacks begin to sway.
  const double share = state_.accuracy.direct ? 0.2 : 0.1;
  constexpr double kFastestPush = 3;  // rad/s or length units/s, along which nothing is moved faster
  const double quickest = kFastestPush * state_.unit();
  bool any = false;
  double fastest = 0;
  see_whether_apart();
  pushes_.clear();
  scalar_pushes_.clear();
  for (const Touch& touch : contacts_.touches()) {
    const NearPair& pair = contacts_.pair_of(touch);
    const double deep = -touch.gap - 0.1 * kSkin * state_.size_of_pair(pair);
    // A contact that is not too deep may come nearer by the room that there is.
    const double rate = deep > 0 ? std::min(share * deep / h, quickest) : std::min(0.0, -touch.gap / h);
    pushes_.push_back({rate, softness(pair), 0});
    fastest = std::max(fastest, rate);
    any = any || deep > 0;
  }
  for (std::size_t i = 0; i < rows_.limits(); ++i) {
    const Bound& bound = rows_.limit(i).bound;
    scalar_pushes_.push_back(std::min(-share * std::min(bound.gap, 0.0) / h, kFastestPush * bound.unit));
    fastest = std::max(fastest, scalar_pushes_.back());
    any = any || bound.gap < -kLimitSkin * bound.unit;
  }
  scalar_pushes_.resize(rows_.scalars().size(), 0.0);
  if (!any) return;
  const Given before = given(), most = payable(h);
  const double stored = state_.networks.empty() ? 0 : network_energy(state_);
  move_by_pushes(fastest, h, Rates::Stay);
  if (!state_.networks.empty()) shorten_winding(network_energy(state_) - stored, h);
  shorten_pushes(before, most, h);
  pay_for_moves(-before.all - state_.result.ledger.contact_loss, true, Payers::Trees);
}

/// Moves everything for h seconds by the velocities that pushes_ and scalar_pushes_ ask for. The solver solves the rows
/// again that it solved last: those that the island has now.
/// @param fastest  of these velocities, m/s or rad/s
void Positions::move_by_pushes(double fastest, double h, Rates rates) {
  contact::SolveSettings settings = state_.solve_settings();
  // Only a part of an overlap is put right: how exactly does not matter, least where velocities are not exact either.
  // But joints pass on what pushes one link apart, and a few sweeps would press another in.
  constexpr int kFree = 4, kJointed = 40;
  const int least = state_.trees.empty() ? kFree : kJointed;
  if (!state_.accuracy.direct) settings.iterations = std::max(least, settings.iterations / 4);
  settings.direct = rows_.contacts() == 0;
  settings.tolerance = std::max(settings.tolerance, 1e-3 * fastest);
  if (settings.direct) settings.tolerance = 1e-14 * state_.unit();
  book_moves(-1);
  begin_moves();
  contact::solve_again(pushes_, scalar_pushes_, settings, rows_.workspace());
  end_moves(h, rates);
  book_moves(1);
}

/// Scripts may place links in overlaps, until none is left for the first time. Later overlaps are the solver's.
void Positions::see_whether_apart() {
  const auto overlaps = [this](const Touch& touch) {
    return -touch.gap > kSkin * state_.size_of_pair(contacts_.pair_of(touch));
  };
  constexpr double kBeyond = 1e-3;  // rad, or the world's length unit
  const auto beyond = [](const Bound& bound) { return -bound.gap > kBeyond * bound.unit; };
  if (std::any_of(contacts_.touches().begin(), contacts_.touches().end(), overlaps) ||
      std::any_of(contacts_.bounds().begin(), contacts_.bounds().end(), beyond))
    return;
  for (Tree* tree : state_.trees) tree->set_apart = false;
}

/// What pushing trees apart may give in a sub-step of h seconds: a little of what moves, which pays for it, and, where
/// something outside holds them, what lifts them by a little of their size each second, however many sub-steps that
/// has, as far as contacts took as much before, or scripts made the overlap. What falls freely need not be lifted: its
/// centre of mass goes on as it did. Springs that press bodies into one another, or beyond limits, are not to be wound
/// up for nothing, nor is a body that spins to be drawn out.
Given Positions::payable(double h) {
  if (state_.trees.empty()) return {JointDrive::kNoLimit, JointDrive::kNoLimit};
  const bool falls = !momentum_.touched_from_outside() && std::all_of(state_.clusters.begin(), state_.clusters.end(),
                                                                      [](const Clustered& one) { return one.loose; });
  const double by_motion = payable_by_motion();
  if (falls) return {by_motion, by_motion};
  const bool by_scripts = state_.drivers > 0 || std::any_of(state_.trees.begin(), state_.trees.end(),
                                                            [](const Tree* tree) { return tree->set_apart; });
  const double lift = kLift * h * weight(state_);
  if (by_scripts) return {by_motion + lift, by_motion + lift};
  return {by_motion + std::min(lift, credit_.left()), by_motion};
}

/// What contacts gave so far, and what springs have.
Given Positions::given() const {
  Given now{-state_.result.ledger.contact_loss, 0};
  for (Tree* tree : state_.trees) now.springs += state_.core.joint_springs(*tree);
  for (const Clustered& one : state_.clusters) {
    if (one.entry->springs.empty()) continue;
    for (Tree* tree : one.entry->system->trees()) articulated::forward_kinematics(tree->model, tree->data, tree->state);
    now.springs += spring_energy(state_, one);
  }
  return now;
}

/// Takes back what winds up springs between bodies without joints by more than is payable.
/// @param wound  J
void Positions::shorten_winding(double wound, double h) {
  const double most = kFew * state_.swung + kLift * h * free_weight(state_);
  if (wound > most) take_back_pushes(1 - most / wound, h);
}

double Positions::payable_by_motion() const { return kFew * momentum_.moving(Payers::Trees); }

/// Takes back of what move_by_pushes() has just moved what gives more than it may: energy is not linear in the
/// distance, so that this takes some tries, and the last one takes back all.
/// @param before  given() before it moved
/// @param most    what it may give
void Positions::shorten_pushes(const Given& before, const Given& most, double h) {
  constexpr int kTries = 4;
  double left = 1;  // of the motion
  for (int i = 1; i <= kTries && left > 0; ++i) {
    const Given now = given();
    const double all = now.all - before.all, springs = now.springs - before.springs;
    double share = all > most.all ? most.all / all : 1;
    if (springs > most.springs) share = std::min(share, most.springs / springs);
    if (!(share < 1)) return;
    const double kept = i < kTries ? left * share : 0;
    take_back_pushes(left - kept, h);
    left = kept;
  }
}

/// Takes back a part of the motion that move_by_pushes() made in h seconds.
void Positions::take_back_pushes(double part, double h) {
  book_moves(-1);
  move_back(part * h);
  book_moves(1);
}

void Positions::move_back(double h) {
  for (Free& one : state_.free_bodies) std::copy_n(one.push, 6, one.v);
  for (Tree* tree : state_.trees) {
    tree->free_v = tree->state.v;
    tree->state.v = tree->push;
  }
  momentum_.note(&Tree::free_v, false);
  end_moves(-h);
}

/// The motion of a sub-step is that of a constant force along its rows. Where it is another, a joint that was stopped
/// would stand beyond its limit (what presses on a limit may swing there and back meanwhile), and a body that contacts
/// struck, nearer than it may be (it rotates): both are put where they began, or to the limit, at once.
/// @param struck  contacts struck something in these h seconds
void Positions::put_back(double h, bool struck) {
  constexpr int kTries = 2;
  constexpr double kFar = 0.02;  // rad, or the world's length unit: put back so far, links do not move along their rows
  for (int i = 0; i < kTries && put_back_once(h, struck || i > 0, Rates::Carried) > kFar; ++i) continue;
}

/// @return  how far a joint was put back, rad or of the world's length unit
double Positions::put_back_once(double h, bool struck, Rates rates) {
  scalar_pushes_.clear();
  double fastest = 0, farthest = 0;
  JointReader joints(state_.core);
  for (std::size_t i = 0; i < rows_.limits(); ++i) {
    const Bound& bound = rows_.limit(i).bound;
    const double gap = bound.sign * (joints.position(bound.joint)[bound.axis] - bound.limit);
    scalar_pushes_.push_back((std::min(bound.gap, 0.0) - gap) / h);
    fastest = std::max(fastest, scalar_pushes_.back());
    farthest = std::max(farthest, scalar_pushes_.back() * h / bound.unit);
  }
  bool any = fastest * h > kLimitSkin;
  if (struck) state_.place_links();
  if (!struck && !any) return 0;
  pushes_.clear();
  for (const Touch& touch : contacts_.touches()) {
    const NearPair& pair = contacts_.pair_of(touch);
    double rate = std::min(0.0, -touch.gap / h);
    if (struck) {
      const double far = deeper(touch);
      any = any || far > kTouchSkin * state_.size_of_pair(pair);
      rate = far / h;
      fastest = std::max(fastest, rate);
    }
    pushes_.push_back({rate, softness(pair), 0});
  }
  if (!any) return 0;
  scalar_pushes_.resize(rows_.scalars().size(), 0.0);
  move_by_pushes(fastest, h, rates);
  return farthest;
}

void Positions::begin_moves() {
  for (Free& one : state_.free_bodies) std::fill(one.v, one.v + 6, 0.0);
  for (Tree* tree : state_.trees) {
    tree->free_v = tree->state.v;
    tree->state.v.setZero();
  }
  momentum_.note(&Tree::free_v, false);
}

void Positions::end_moves(double h, Rates rates) {
  for (Clustered& one : state_.clusters) note_pushed(one);
  for (Free& one : state_.free_bodies) {
    std::copy_n(one.v, 6, one.push);
    one.load_velocity();  // books are made by it
    const Vector3 way = h * Vector3(one.push[0], one.push[1], one.push[2]);
    one.now.center += way;
    book_way(one.now.force.dot(way), nullptr);
    one.now.rotate(h * Vector3(one.push[3], one.push[4], one.push[5]), contacts_.unseen_spin(one));
  }
  const bool touched = momentum_.touched_from_outside();
  for (Tree* tree : state_.trees) {
    tree->push = tree->state.v;
    tree->way = h * tree->push;
    tree->state.v = tree->free_v;
    if (rates == Rates::Carried && (touched || !tree->loose))
      move_without_gain(state_, *tree, tree->way);
    else
      articulated::move(tree->model, tree->state.q, tree->way, tree->state.q);
    if (tree->driven) book_way(tree->set_tau.dot(tree->way), tree);
  }
  momentum_.give_pushes(h, pushes_);
  book_pushed();
}

/// Whether a mover is a body without joints that springs pull at.
bool Positions::on_spring(int mover) const {
  return mover >= static_cast<int>(state_.networks_begin()) && mover < static_cast<int>(state_.networks_end());
}

/// Notes what contacts and limits struck so that it is nearer, having moved for h seconds with the mean of the
/// velocities before and after, than it may be. What rests, rolls or slides is not.
/// @return  whether there is something
bool Positions::find_struck(double h) {
  struck_.assign(rows_.movers().size(), 0);
  shares_.assign(state_.free_bodies.size(), 0.0);
  bool any = false;
  // Where impacts are located, only what rotates toward a row from afar comes too near; `balanced` does not see that.
  const bool all = contacts_.spent() || state_.trees.empty();
  if (!all && state_.accuracy.rung == Rung::Balanced) return false;
  for (std::size_t i = 0; i < rows_.contacts(); ++i) {
    const auto& [touch, pair, row, law] = rows_.contact(i);
    if (row.impulse == Vector3::Zero() || !(all || touch.far)) continue;
    const double gap = touch.gap, before = rows_.before(i, true)[0] - rows_.before(i, false)[0];
    const double after = rows_.rate_of(row, true)[0] - rows_.rate_of(row, false)[0];
    // The mean says nothing of the way of what a spring turns meanwhile.
    const bool turned = (on_spring(row.a) || on_spring(row.b)) && rows_.unsteady(i, h);
    const double reached = turned ? rows_.gap_now(touch) : gap + 0.5 * h * (before + after);
    if (reached >= std::min(gap, 0.0) - kTouchSkin * state_.size_of_pair(pair)) continue;
    any = true;
    const double way = turned && state_.trees.empty() ? 0.5 * h * rows_.normal_change(i) : 0;
    const double share = way > 0 ? std::min(1.0, (std::min(gap, 0.0) - reached) / way) : 1;
    for (const int mover : {row.a, row.b}) {
      if (mover < 0) continue;
      const auto at = static_cast<std::size_t>(mover);
      struck_[at] = 1;
      if (at < shares_.size()) shares_[at] = std::max(shares_[at], on_spring(mover) ? share : 1);
    }
  }
  for (std::size_t i = 0; i < rows_.limits(); ++i) {
    const auto& [bound, row] = rows_.limit(i);
    if (row.impulse == 0 || !all) continue;
    const double reached = bound.gap + 0.5 * h * (bound.rate + rows_.rate_of(row));
    if (reached >= std::min(bound.gap, 0.0) - kLimitSkin * bound.unit) continue;
    any = true;
    struck_[static_cast<std::size_t>(row.a)] = 1;
  }
  return any;
}

/// Contacts that are solved only at the end of a sub-step of h seconds must not come nearer than they are: a body that
/// contacts struck has moved, in the end, with the velocity that they left it, not with the mean. One that springs turn
/// meanwhile moves no farther than it has to: farther, it would wind them up.
/// @return  whether there was one
bool Positions::hold_off(double h) {
  if (!find_struck(h)) return false;
  book_moves(-1);
  for (Clustered& one : state_.clusters) note_pushed(one);
  momentum_.note(&Tree::smooth_v, true);
  // Semi-implicit Euler has moved them with the velocity after, but for the rows' part.
  const bool semi = semi_implicit(state_.accuracy);
  for (std::size_t i = 0; i < state_.free_bodies.size(); ++i) {
    if (!struck_[i]) continue;
    const Free& one = state_.free_bodies[i];
    FreeBody& body = state_.free_bodies[i].now;
    const Vector3 smooth(one.free_v[0], one.free_v[1], one.free_v[2]);
    const bool turned = on_spring(static_cast<int>(i)) &&
                        (smooth - one.before.velocity).norm() > kStrong * h * state_.core.settings.gravity.norm();
    const Vector3 from = semi || turned ? smooth : one.before.velocity;
    const Vector3 spin = semi ? Vector3(one.free_v[3], one.free_v[4], one.free_v[5]) : one.before.spin;
    const double moved_h = 0.5 * h * shares_[i];
    const Vector3 way = moved_h * (body.velocity - from);
    body.center += way;
    book_way(one.now.force.dot(way), nullptr);
    body.rotate(moved_h * (body.spin - spin), contacts_.unseen_spin(one));
  }
  const bool touched = momentum_.touched_from_outside();
  for (const Clustered& one : state_.clusters)
    for (Tree* tree : one.entry->system->trees()) {
      if (one.semi || !struck_[static_cast<std::size_t>(state_.mover_of(*tree))]) continue;
      tree->way = 0.5 * h * (tree->state.v - tree->sub_state.v);
      if ((touched || !tree->loose) && (state_.accuracy.locate_impacts || !tree->loops.empty())) {
        move_without_gain(state_, *tree, tree->way);
      } else {
        tree->way *= share_without_gain(*tree, tree->way);
        articulated::move(tree->model, tree->state.q, tree->way, tree->state.q);
      }
      if (tree->driven) book_way(tree->set_tau.dot(tree->way), tree);
    }
  momentum_.give_positions(0.5 * h, struck_);
  book_pushed();
  book_moves(1);
  return true;
}

/// After the rows moved positions: whether links that a blow throws, and whose way the rows could not change without a
/// gain, went on into what they struck outside. Half-way through something thin they would come out on its other side.
bool Positions::went_on() {
  if (!contacts_.spent() ||
      std::all_of(state_.trees.begin(), state_.trees.end(), [](const Tree* tree) { return tree->row_share == 1; }))
    return false;
  state_.place_links();
  for (std::size_t i = 0; i < rows_.contacts(); ++i) {
    const auto& [touch, pair, row, law] = rows_.contact(i);
    const bool apart = state_.slot_of(pair.a).tree != state_.slot_of(pair.b).tree;
    if (apart && deeper(touch) > kTouchSkin * state_.size_of_pair(pair)) return true;
  }
  return false;
}

/// m, by which a touch is deeper than it was when the sub-step began; links are placed.
double Positions::deeper(const Touch& touch) const { return std::min(touch.gap, 0.0) - rows_.gap_now(touch); }

/// Springs pull at the cluster's links, or loops hold them together.
bool Positions::yields(const Clustered& one) const {
  const auto pulls = [this](const TreeLink& link) {
    return link.joint != kNoJoint && state_.core.joints[link.joint].drive.stiffness > 0;
  };
  const std::span trees = one.entry->system->trees();
  return !one.entry->springs.empty() || std::any_of(trees.begin(), trees.end(), [&](const Tree* tree) {
    return !tree->loops.empty() || std::any_of(tree->links.begin(), tree->links.end(), pulls);
  });
}

/// After the rows moved positions: whether a contact of links that held is deeper than it may be. A constant force does
/// not hold against a spring that is fast for the sub-step, although the velocities at its ends say that it does. A
/// body that comes down too slowly for an impact also ends deeper, by half of its way in the sub-step; on `conserving`
/// it is raised at once and not lifted later.
bool Positions::sank() {
  constexpr double kSunk = 0.005;  // of the bodies' size
  const bool all = state_.accuracy.rung == Rung::Conserving;
  const auto may = [this, all](const Clustered& one) { return all || yields(one); };
  if (rows_.contacts() == 0 || std::none_of(state_.clusters.begin(), state_.clusters.end(), may)) return false;
  const double most = all ? kTouchSkin : kSunk;
  state_.place_links();
  for (std::size_t i = 0; i < rows_.contacts(); ++i) {
    const auto& [touch, pair, row, law] = rows_.contact(i);
    if (!(row.impulse[0] > 0) || !(row.ja || row.jb)) continue;
    if (deeper(touch) > most * state_.size_of_pair(pair)) return true;
  }
  return false;
}

/// Puts back what sank, as far as that gives no more than the rows of the sub-step took.
/// @param most  J, that they took
void Positions::raise(double h, double most) {
  const Given before = given();
  put_back_once(h, true, Rates::Stay);
  shorten_pushes(before, {most, most}, h);
}

/// What pushing apart gave or took, as height, in motion or in springs, is booked as what contacts did: with a sign
/// before and after it.
void Positions::book_moves(double sign) {
  double sum = 0;
  for (const Free& one : state_.loose_bodies())
    sum += one.now.kinetic() - one.now.solid->mass * state_.core.settings.gravity.dot(one.now.center);
  sum += network_energy(state_);
  for (const Clustered& one : state_.clusters) {
    for (const std::uint32_t index : one.entry->trees) {
      Tree& tree = *state_.core.trees[index];
      const Energy energy = state_.core.energy_of(tree);
      const double stored = energy.kinetic + energy.potential + energy.springs;
      if (one.alone()) tree.ledger.contact_loss -= sign * stored;
      sum += stored;
    }
    sum += spring_energy(state_, one);
  }
  state_.result.ledger.contact_loss -= sign * sum;
}

void Positions::pay_for_moves(double given, bool by_contacts, Payers payers) {
  if (state_.trees.empty() || !(given > 0)) return;
  const double all = momentum_.moving(payers);
  if (!(all > 0)) return;
  const double part = std::min(kFew, given / all);
  if (by_contacts)
    momentum_.take_from_all(part, payers);
  else
    momentum_.undo_gain(part, false, payers);
}

/// The same for links that scripts push, since note_pushed().
void Positions::book_pushed() {
  for (Clustered& one : state_.clusters)
    book_way(work_on_pushed(one), one.alone() ? one.entry->system->trees().front() : nullptr);
}

/// Scripts' forces work, J, where contacts and limits move positions: these provide it.
void Positions::book_way(double work, Tree* tree) {
  state_.result.ledger.script_work += work;
  state_.result.ledger.contact_loss += work;
  if (!tree) return;
  tree->ledger.script_work += work;
  tree->ledger.contact_loss += work;
}

}  // namespace breve::island
