// The step of an island.
#include "runtime/dynamics/island_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/base/error.hpp"
#include "runtime/dynamics/network_motion.hpp"

namespace breve::island {

namespace {

/// rad, by which a body may rotate between two looks at what it may touch.
constexpr double kBetweenLooks = 1;

/// Into how many equal parts of at most `step` seconds `left` goes; rounding is not to make one more.
double parts_of(double left, double step) {
  constexpr double kTolerance = 1e-9, kMost = 1e9;
  return std::clamp(std::ceil(left / step - kTolerance), 1.0, kMost);
}

}  // namespace

void Step::once(MechanicsClient* client, double start, double h) {
  state_.begin(client, h);
  rows_.begin();
  rows_.clear();
  contacts_.begin(client && client->locates());
  const bool alone = state_.pairs.empty() && !bounded();
  const auto finish_there = [&](const Trouble& why) {
    if (alone) {
      balance_.back_to_start();
      gone_ = 0;
    } else {
      state_.restore();
    }
    finish(why, start + gone_, h - gone_);
  };
  try {
    if (alone)
      undisturbed(start, h);
    else if (state_.accuracy.locate_impacts)
      located(client, start, h);
    else
      fast(start, h);
  } catch (const articulated::TooFast&) {
    if (state_.finished || state_.core.settings.guard == GuardMode::Off) throw;
    finish_there(fastest_motion());
  } catch (const Error& error) {
    // Step control gave up since the work is used up.
    if (error.code() != ErrorCode::Numeric || !state_.meter.over() || state_.finished) throw;
    finish_there(used_up());
  }
}

/// Some tree has loops, motors or limits: there will be rows whatever is near.
bool Step::bounded() const {
  const auto by = [this](const TreeLink& link) {
    return link.motor || (link.joint != kNoJoint && Dynamics::Core::has_limits(state_.core.joints[link.joint]));
  };
  return std::any_of(state_.trees.begin(), state_.trees.end(), [&by](const Tree* tree) {
    return !tree->loops.empty() || std::any_of(tree->links.begin(), tree->links.end(), by);
  });
}

/// @param lies  nothing moves that contacts would have to be followed for
double Step::longest(double left, bool lies) const {
  double step = state_.accuracy.step > 0 ? state_.accuracy.step : left;
  const bool touching = !lies && (contacts_.any() || state_.has_loops());
  if (touching && state_.accuracy.contact_step > 0) step = std::min(step, state_.accuracy.contact_step);
  return left / parts_of(left, step);
}

/// rad/s, of a body's spin as far as it moves the surface.
double Step::rotation_seen(BodyIndex body) const {
  if (state_.slot_of(body).mover < 0) return 0;
  const Shape& shape = state_.shape(body);
  const Vector3 spin = state_.spin_of(body);
  switch (shape.kind()) {
    case ShapeKind::Sphere: return 0;
    case ShapeKind::Cylinder:
    case ShapeKind::Capsule: {
      const Vector3 axis = state_.pose_of(body).orientation * Vector3::Unit(shape.round().axis);
      return (spin - spin.dot(axis) * axis).norm();
    }
    default: return spin.norm();
  }
}

/// Such a part of a sub-step that bodies which may meet within it rotate by no more than their paths show: an impact is
/// sought between where they are at its start and at its end, and half a revolution looks like one the other way. A
/// step that begins with a fast spin has short sub-steps anyway (Watch); an impact may give one in its middle.
double Step::followed(double part) const {
  constexpr double kMostParts = 64;
  double fastest = 0;
  for (std::size_t i = 0; i < state_.pairs.size(); ++i) {
    if (contacts_.role(i) != Role::Far && contacts_.role(i) != Role::Leaves) continue;
    const NearPair& pair = *state_.pairs[i];
    fastest = std::max({fastest, rotation_seen(pair.a), rotation_seen(pair.b)});
  }
  return part / std::clamp(std::ceil(fastest * part / kBetweenLooks), 1.0, kMostParts);
}

/// Nothing is near and nothing holds: smooth motion is all.
void Step::undisturbed(double start, double h) {
  const double part = longest(h, false);
  const auto parts = static_cast<int>(std::llround(h / part));
  for (int i = 0; i < parts; ++i) {
    gone_ = i * part;
    if (state_.unaffordable()) return finish(used_up(), start + gone_, h - gone_);
    smooth_.move(start + gone_, part);
    smooth_.commit();
  }
}

/// The link whose rotation, spring or damper in its joint is the fastest, 1/s.
Trouble Step::fastest_motion() const {
  Trouble worst{true, GuardReason::FastMotion, 0, state_.any_body()};
  const auto look = [&worst](double rate, BodyIndex body) {
    if (rate > worst.value) worst.value = rate, worst.body = body;
  };
  for (const Free& one : state_.loose_bodies()) look(one.now.spin.norm(), one.body);
  for (const Clustered& one : state_.clusters)
    for (Tree* tree : one.entry->system->trees()) {
      articulated::forward_kinematics(tree->model, tree->data, tree->state);
      const articulated::Vector yields = articulated::inverse_mass_diagonal(tree->model, tree->data);
      for (std::size_t i = 0; i < tree->links.size(); ++i) {
        const TreeLink& link = tree->links[i];
        look(articulated::spin(tree->data, static_cast<int>(i)).norm(), link.body);
        if (link.joint == kNoJoint) continue;
        const JointDrive& drive = state_.core.joints[link.joint].drive;
        const articulated::Body& body = tree->model.body(static_cast<int>(i));
        for (int k = body.v; k < body.v + articulated::velocity_count(body.type); ++k)
          look(std::max(std::sqrt(drive.stiffness * yields[k]), drive.damping * yields[k]), link.body);
      }
    }
  return worst;
}

Trouble Step::used_up() const {
  return {true, GuardReason::Work, static_cast<double>(state_.meter.done()), state_.any_body()};
}

/// The rest of a step that is too much work, in one sub-step as coarse as there is. If the host interrupts the step,
/// the rest is left out: the bodies stay where they are.
void Step::finish(const Trouble& why, double time, double left) {
  constexpr int kFew = 8;
  state_.finished = true;
  state_.intervene(why, GuardAction::Finished, time);
  if (state_.meter.ended()) return;
  Accuracy coarse = breve::accuracy_of(Rung::Fast);
  coarse.iterations = std::min(coarse.iterations, kFew);
  state_.use_accuracy(coarse);
  state_.meter.open();
  take_fast(time, left);
}

/// One look at what is near in a sub-step, velocities first: no impact is located.
void Step::fast(double start, double h) {
  const double step = state_.accuracy.step > 0 ? state_.accuracy.step : h;
  const int parts = static_cast<int>(parts_of(h, step));
  const double part = h / parts;
  for (int i = 0; i < parts; ++i) {
    gone_ = i * part;
    if (state_.unaffordable()) return finish(used_up(), start + gone_, h - gone_);
    take_fast(start + gone_, part);
  }
}

void Step::take_fast(double time, double h) {
  sub_step_.look(h, true);
  if (state_.meter.ended()) return;  // what touches was not looked for to the end
  const int springs = spring_parts(h), parts = std::max(springs, rotation_parts(h));
  state_.followed = springs > 1;
  if (parts > 1)
    take_parts(time, h, parts);
  else
    take_looked(time, h);
}

/// A sub-step of h seconds, of which nothing has been taken yet.
void Step::take_parts(double time, double h, int parts) {
  const double part = h / parts, gone = gone_;
  for (int i = 0; i < parts; ++i) {
    gone_ = gone + i * part;
    if (state_.unaffordable()) return finish(used_up(), time + i * part, h - i * part);
    sub_step_.look(part, true);
    if (state_.meter.ended()) return;
    take_looked(time + i * part, part);
  }
}

/// Whether a contact that was found may push bodies of the network.
bool Step::meets(const NetworkCluster& network) const {
  const int first = static_cast<int>(network.first);
  const int end = first + static_cast<int>(network.entry->points->trees().size());
  const auto in = [&](BodyIndex body) {
    const int mover = state_.slot_of(body).mover;
    return mover >= first && mover < end;
  };
  return std::any_of(contacts_.touches().begin(), contacts_.touches().end(), [&](const Touch& touch) {
    const NearPair& pair = contacts_.pair_of(touch);
    return in(pair.a) || in(pair.b);
  });
}

/// Into how many parts a sub-step of h seconds goes in which contacts push bodies on springs: the rows at its end push
/// as if no spring pulled back meanwhile. Few bodies may take more parts.
int Step::spring_parts(double h) const {
  constexpr double kFollowed = 2, kPartPhase = 0.5;  // rad, by a bound of the fastest oscillation
  constexpr double kMost = 16, kMostOfFew = 64;      // parts
  constexpr double kLooks = 512;                     // at a body or a pair, for parts of one sub-step
  if (state_.networks.empty() || state_.finished) return 1;
  double fastest = 0;
  for (const NetworkCluster& one : state_.networks)
    if (meets(one)) fastest = std::max(fastest, one.entry->points->fastest());
  if (!(fastest * h > kFollowed)) return 1;
  const double items = static_cast<double>(state_.free_bodies.size() + state_.pairs.size());
  return static_cast<int>(std::min(std::ceil(fastest * h / kPartPhase), std::clamp(kLooks / items, kMost, kMostOfFew)));
}

/// Into how many parts a sub-step of h seconds goes in which a link rotates near what it may touch, or a joint would go
/// far beyond a limit: the rows know the points that are nearest as it begins, and what brings a joint back from far
/// gives links in flight energy. Bodies without joints that spin have shorter sub-steps anyway (Watch).
int Step::rotation_parts(double h) const {
  constexpr double kMost = 8;
  constexpr double kBeyond = 0.5;  // rad, or length units
  // Loops that are left to rows are closed by the whole sub-step.
  if (state_.trees.empty() || state_.has_loops() || state_.finished) return 1;
  double fastest = 0;
  for (const Touch& touch : contacts_.touches()) {
    const NearPair& pair = contacts_.pair_of(touch);
    for (const BodyIndex body : {pair.a, pair.b})
      if (state_.slot_of(body).tree) fastest = std::max(fastest, rotation_seen(body));
  }
  double farthest = 0;
  for (const Bound& bound : contacts_.bounds())
    if (!bound.rests && !bound.held && bound.gap + h * bound.rate < -kBeyond * bound.unit)
      farthest = std::max(farthest, -h * bound.rate / bound.unit);
  const double parts = std::max(std::ceil(fastest * h / kBetweenLooks), std::ceil(farthest / kBeyond));
  return static_cast<int>(std::clamp(parts, 1.0, kMost));
}

/// After a look.
void Step::take_looked(double time, double h) {
  for (Bound& bound : contacts_.bounds())
    bound.rests = bound.gap + h * std::min(0.0, 2 * bound.rate) <= kLimitSkin * bound.unit;
  sub_step_.open(h);
  sub_step_.advance(time, h);
  sub_step_.keep(h, h);
  rows_.keep_warm(h);
  sub_step_.put_right(h);
}

double Step::contact_part(double left, bool lies) const {
  const double step = state_.accuracy.step > 0 ? std::min(state_.accuracy.step, left) : left;
  return state_.accuracy.contact_step > 0 && !lies ? std::min(step, state_.accuracy.contact_step) : step;
}

/// Free bodies that are at rest, as far as that can be seen in a step of h seconds: slower than a small part of what
/// gravity would make of it. The forces that hold them do not depend on how long a sub-step is.
bool Step::lies(double h) const {
  constexpr double kRest = 1e-3;
  if (state_.accuracy.rung != Rung::Balanced || !state_.trees.empty()) return false;
  if (state_.drivers > 0 || state_.has_contact_springs()) return false;
  const double most = kRest * state_.core.settings.gravity.norm() * h;
  return std::all_of(state_.free_bodies.begin(), state_.free_bodies.end(), [&](const Free& one) {
    const double radius = state_.shape(one.body).bounding_radius();
    return one.now.velocity.squaredNorm() <= most * most && radius * radius * one.now.spin.squaredNorm() <= most * most;
  });
}

/// Finds what is near for a sub-step, and lets collide what strikes at once.
/// @return  false if the host ended the step: what touches was not looked for to the end
bool Step::look(double time, double sub) {
  sub_step_.look(sub, spent_);
  if (state_.meter.ended()) return false;
  if (spent_) return true;
  const bool struck = contacts_.strikes(sub);
  if (struck) {
    ++met_;
    impacts_.collide(time);
    sub_step_.look(sub, spent_);
  }
  contacts_.find_roles(sub, struck);
  return true;
}

/// Impacts at their moments: a sub-step ends at the first of them.
void Step::located(MechanicsClient* client, double start, double h) {
  constexpr double kTelling = 0.1;   // of a sub-step: a shorter one does not say which forces there are
  constexpr double kSliver = 1e-12;  // of the step
  constexpr int kMostStalls = 8;     // impacts without progress in time
  const int most = located_impacts();
  const std::uint64_t dear = state_.meter.done() + located_work();
  int stalls = 0;
  met_ = 0;
  // Bodies that lie still take the step as one, and as any other if they move by that.
  bool whole = lies(h);
  for (double now = 0; now < h * (1 - kSliver);) {
    gone_ = now;
    if (state_.unaffordable()) return finish(used_up(), start + now, h - now);
    spent_ = met_ >= most || stalls > kMostStalls || state_.squeezed || state_.meter.done() > dear;
    if (!look(start + now, contact_part(h - now, whole))) continue;
    const double part = spent_ ? longest(h - now, whole) : followed(longest(h - now, whole));
    impacts_.note_start();
    sub_step_.open(part);
    sub_step_.advance(start + now, part);
    Event event = spent_ ? Event() : impacts_.seek(start + now, part);
    if (whole && (event.found() || !lies(part))) {
      state_.restore();
      whole = false;
      continue;
    }
    if (!event.found()) {
      sub_step_.keep(part, part);
      rows_.keep_warm(part);
      sub_step_.put_right(part);
      now += part;
      continue;
    }
    ++met_;
    impacts_.locate(start + now, event, part);
    stalls = event.time > kSliver * h ? 0 : stalls + 1;
    sub_step_.keep(part, std::max(event.time, kSliver * h));
    rows_.keep_warm(event.time > kTelling * part ? event.time : 0);
    now += event.time;
    state_.place();
    impacts_.meet(client, event, start + now, h - now);
    if (handlers_.dissolved()) return;
  }
  report_impacts(start + h);
}

/// How many impacts of this step are located in time. Each costs a look at all pairs, and some solutions of all rows:
/// so that a crowd's step stays as long as its bodies and pairs are many, it has fewer. Later impacts are met at the
/// end of a sub-step, all at once.
int Step::located_impacts() const {
  if (state_.accuracy.rung == Rung::Reference) return state_.accuracy.impacts;
  // At a body or a pair, for impacts of one step.
  constexpr double kFewLooks = 1000, kLooks = 4000, kPreciseLooks = 20000;
  const bool coarse = state_.accuracy.rung == Rung::Balanced;
  const double looks = coarse ? kFewLooks : state_.accuracy.rung == Rung::Precise ? kPreciseLooks : kLooks;
  const double items = static_cast<double>(state_.free_bodies.size() + state_.trees.size() + state_.pairs.size());
  const int least = coarse ? 0 : 1;
  return std::clamp(static_cast<int>(looks / std::max(items, 1.0)), least, std::max(least, state_.accuracy.impacts));
}

/// Units of work of a step after which no impact is located any more: where bodies jam, each try of a moment may cost a
/// hundred times as much as elsewhere.
std::uint64_t Step::located_work() const {
  constexpr std::uint64_t kCoarse = 200'000, kExact = 5'000'000;
  switch (state_.accuracy.rung) {
    case Rung::Reference: return std::numeric_limits<std::uint64_t>::max() / 2;
    case Rung::Precise: return kExact;
    default: return kCoarse;
  }
}

void Step::report_impacts(double time) {
  if (met_ < state_.accuracy.impacts || state_.core.settings.guard == GuardMode::Off) return;
  const Trouble many{true, GuardReason::Impacts, static_cast<double>(met_), state_.any_body()};
  state_.intervene(many, GuardAction::Reported, time);
}

}  // namespace breve::island
