// One integration step: sub-steps of Box2D, cut at first touches that somebody wants to know about.
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/planar/core.hpp"
#include "runtime/planar/doors.hpp"

namespace breve {

namespace {

constexpr double kMostSteps = 1e6;  // sub-steps of an integration step that a setting may ask for

/// How a rung is spent on Box2D. KEEP IN STEP: docs/physics.md.
struct Effort {
  int sub_steps, velocity, position;
};
Effort effort_of(Rung rung) {
  switch (rung) {
    case Rung::Fast: return {1, 8, 3};
    case Rung::Balanced: return {4, 8, 3};
    case Rung::Precise: return {16, 30, 10};
    case Rung::Reference: return {64, 30, 10};
    case Rung::Conserving: return {16, 8, 3};
  }
  return {4, 8, 3};
}

}  // namespace

int Planar::Core::sub_steps() const {
  int most = effort_of(settings.accuracy.rung).sub_steps;
  for (const auto& [body, one] : own)
    if (one.has_accuracy) most = std::max(most, effort_of(one.accuracy.rung).sub_steps);
  return most;
}

/// s, of a sub-step, if it was set alone; 0: as long as the rung's are. All of the world steps as what has contacts
/// does.
double Planar::Core::longest_step() const {
  const Accuracy &set = settings.accuracy, rung = accuracy_of(set.rung);
  if (!set.custom) return 0;
  double longest = 0;
  for (const auto& [own, usual] : {std::pair{set.step, rung.step}, std::pair{set.contact_step, rung.contact_step}})
    if (own > 0 && own != usual) longest = longest > 0 ? std::min(longest, own) : own;
  return longest;
}

int Planar::Core::velocity_iterations() const {
  if (settings.fast_contacts > 0) return settings.fast_contacts;
  return settings.accuracy.custom ? settings.accuracy.iterations : effort_of(settings.accuracy.rung).velocity;
}

int Planar::Core::position_iterations() const { return effort_of(settings.accuracy.rung).position; }

/// No more of the sub-step is to be begun than has to be.
bool Planar::Core::worn() const { return finishing || counters.work >= work_most || over(); }

/// Box2D sweeps at least so often, and no more often than what is left of the work allows.
int Planar::Core::iterations_now() const {
  constexpr int kFew = 8;
  const int wanted = velocity_iterations();
  if (finishing) return std::min(wanted, kFew);
  if (work_most == Meter::kNoBound) return wanted;
  // It finds contacts only as it begins.
  const auto each = static_cast<std::uint64_t>(4 * awake + b2->GetContactCount() + b2->GetJointCount() + 1);
  const std::uint64_t left = work_most > counters.work ? (work_most - counters.work) / each : 0;
  return static_cast<int>(std::clamp<std::uint64_t>(left, kFew, static_cast<std::uint64_t>(std::max(wanted, kFew))));
}

/// The work of a step of Box2D.
void Planar::Core::count_work(int iterations) {
  const int rows = b2->GetContactCount() + b2->GetJointCount();
  counters.work += static_cast<std::uint64_t>(10 * (awake + rows) + rows * (iterations + position_iterations()));
}

int Planar::Core::count_awake() const {
  return static_cast<int>(std::count_if(slots.begin(), slots.end(), [](const FlatBody& flat) {
    return flat.body != kNoBody && !flat.fixed && flat.b2->IsAwake();
  }));
}

/// The rest of a sub-step whose work budget is used up, by one step of Box2D without impacts at their moments; left out
/// if somebody wants the end at once.
void Planar::Core::finish(double left) {
  finishing = true;
  awake = count_awake();
  step_length = left;
  const FlatBody* shows = liveliest();
  intervene(shows ? shows->body : kNoBody, GuardReason::Work, static_cast<double>(counters.work), now,
            GuardAction::Finished);
  if (bound.ended && bound.ended->load(std::memory_order_relaxed)) return;
  step(left, false);
  now += left;
}

void Planar::Core::advance(MechanicsClient& asked, double start, double h, double share) {
  const double work_left = bound.most > counters.work ? static_cast<double>(bound.most - counters.work) : 0;
  work_most = bound.most == 0 ? Meter::kNoBound : counters.work + static_cast<std::uint64_t>(share * work_left);
  finishing = spoiled = false;
  struct Asking {
    Core& core;
    Asking(Core& c, MechanicsClient& who) : core(c) { core.client = &who; }
    ~Asking() {
      core.client = nullptr;
      core.end_cut_short();
    }
  } asking(*this, asked);
  now = start;
  sync();
  if (!b2) return;
  for (auto& one : met) one.second = false;  // an error may have ended the step before
  for (FlatBody& flat : slots) flat.driver_strikes = 0;
  b2->SetAllowSleeping(settings.sleeping);
  b2->SetGravity(to_b2(settings.gravity));
  place_drivers(h);
  expect_pairs(bound);
  make_missed_contacts();
  make_contacts();
  // Springs that scripts connected, changed or stretched meanwhile.
  const double stretched = springs_energy();
  ledger.script_work += stretched - springs_known;
  int count = sub_steps() << refined;
  if (const double longest = longest_step(); longest > 0)
    count = std::max(count, static_cast<int>(std::min(std::ceil(h / longest - 1e-9), kMostSteps)));
  const Balance before = balance(stretched);
  pushed = 0;
  const std::size_t impacts_before = impacts.size();
  for (int i = 0; i < count && b2; ++i) {
    const double dt = h / count;
    if (finishing || spoiled) break;
    if (worn()) {
      now = start + i * dt;
      finish((count - i) * dt);
      break;
    }
    now = start + i * dt;
    take_sub_step(dt, count, (count - i) * dt);
    if (!spoiled || settings.guard == GuardMode::Off) continue;
    rest_spoiled(now);
    spoiled = false;
  }
  if (!b2) return;  // a handler set another length unit
  // Each group of bodies has reported its own in turn.
  std::stable_sort(impacts.begin() + static_cast<std::ptrdiff_t>(std::min(impacts_before, impacts.size())),
                   impacts.end(), [](const Impact& p, const Impact& q) { return p.time < q.time; });
  write_back_all();
  springs_known = springs_energy();
  const bool wrong = watch_energy(before, start + h);
  report_lasting(start + h);
  if (!b2) return;
  watch(start + h, wrong);
  counters.sleeping = 0;
  for (const FlatBody& flat : slots) counters.sleeping += flat.body != kNoBody && !flat.fixed && !flat.b2->IsAwake();
  counters.interventions = interventions.size();
}

/// Takes the rest of a sub-step at once, without impacts at their moments; does nothing if somebody wants the end now.
void Planar::Core::rush(double left) {
  if (bound.ended && bound.ended->load(std::memory_order_relaxed)) return;
  step(left, false);
}

/// @param left  s, to the end of the step, from the start of this sub-step
void Planar::Core::take_sub_step(double dt, int count, double left) {
  // Box2D moves nothing further than two units or a right angle in one step: what is faster needs more of them.
  const double pieces = plan_pieces(dt, count), start = now;
  located = 0;
  looks = 0;
  if (Hit hit; handlers() && find_hit(dt, {true, false}, hit)) {
    for (int k = 0; k < pieces && b2 && !spoiled; ++k) {
      now = start + k * (dt / pieces);
      if (worn()) return finish(left - k * (dt / pieces));
      run(dt / pieces, true);
    }
    return;
  }
  if (pieces > 1)
    step_pieces(dt);
  else
    step_meeting(dt);
  make_missed_contacts();
}

namespace {

/// Up to eight as they are, more of them rounded up by a quarter at most: what needs as many is stepped together.
int rounded_up(int pieces) {
  int unit = 1;
  while (pieces > 8 * unit) unit *= 2;
  return (pieces + unit - 1) / unit * unit;
}

}  // namespace

/// How many pieces each body needs of a sub-step. Returns the most, if all were stepped at once.
/// @param count  of such sub-steps in the step: what is beyond all numbers is not to be cut into as many on the dearest
///               rung as there may be
double Planar::Core::plan_pieces(double dt, int count) {
  constexpr double kTravel = 0.9 * b2_maxTranslation, kRotation = 0.9 * b2_maxRotation;
  const double most = std::clamp(std::floor(4096.0 / count), 64.0, 1024.0);
  const double fall = b2->GetGravity().Length();
  // Ten times the speed at which Box2D lets a body sleep.
  constexpr float kDrowsy = 10 * b2_linearSleepTolerance, kDrowsySpin = 10 * b2_angularSleepTolerance;
  double pieces = 1;
  awake = count_awake();
  for (FlatBody& flat : slots) {
    flat.driver_strikes = 0;
    flat.pieces = 1;
    flat.drowsy = false;
    if (flat.body == kNoBody || flat.fixed || !flat.b2->IsAwake()) continue;
    const double pull = flat.has_force ? flat.force.norm() / (flat.mass.mass * settings.unit) : 0;
    const double way = (flat.b2->GetLinearVelocity().Length() + (fall + pull) * dt) * dt;
    const double rotation = std::abs(flat.b2->GetAngularVelocity()) * dt;
    // Beyond single precision no number of sub-steps helps: the guard sees what becomes of it.
    if (!std::isfinite(static_cast<float>(way + rotation))) continue;
    const double needed = std::max({1.0, std::ceil(way / kTravel), std::ceil(rotation / kRotation)});
    flat.pieces = rounded_up(static_cast<int>(std::min(needed, most)));
    pieces = std::max(pieces, needed);
    if (settings.sleeping)
      flat.drowsy = flat.touching > 0 && !flat.jointed && flat.b2->GetLinearVelocity().Length() < kDrowsy &&
                    std::abs(flat.b2->GetAngularVelocity()) < kDrowsySpin;
    // A body that moves more than half its width must also meet moving bodies.
    flat.b2->SetBullet(way > flat.thickness);
  }
  if (pieces <= most) return pieces;
  for (const FlatBody& flat : slots)
    if (flat.body != kNoBody && !flat.fixed && !(flat.b2->GetLinearVelocity().Length() * dt <= most * kTravel))
      intervene(flat.body, GuardReason::FastRotation, flat.b2->GetLinearVelocity().Length() * settings.unit, now,
                GuardAction::Reported);
  return most;
}

/// A sub-step of what steps, cut at each impact.
void Planar::Core::run(double dt, bool handled) {
  located = 0;
  step_length = dt;
  double left = dt;
  int waited = 0;  // met for handlers and stops
  bool bounce = true;
  while (left > 0 && b2 && !worn() && !spoiled) {
    Hit hit;
    bool found = find_hit(left, {handled && handlers(), few()}, hit);
    found = find_stop(left, found, hit);
    if (!found) break;
    const bool stop = hit.stop != kNoJoint;
    if ((hit.handled || stop) && ++waited > settings.accuracy.impacts) {
      intervene(stop ? joints[hit.stop].is.child : of(hit.a->GetBody()).body, GuardReason::Impacts, waited, now,
                GuardAction::Reported);
      bounce = false;
      break;
    }
    if (!hit.handled && (!stop || !settings.accuracy.locate_impacts)) ++located;
    const double t = std::min(hit.t, left);
    if (t > 0) step(t);
    left -= t;
    now += t;
    if (stop)
      rebound(hit.stop);
    else
      deliver(hit, now);
  }
  if (left > 0 && b2 && !spoiled) step(left, bounce);
  now += left;
  end_cuts(dt);
}

/// Notes the velocities at the start of a sub-step, and takes off half of the acceleration where it is known.
void Planar::Core::kick(double dt) {
  friction = driven_work = 0;
  landed_hard = false;
  lightest = std::numeric_limits<double>::infinity();
  heaviest = 0;
  for (FlatJoint& joint : joints)
    if (joint.used && (joint.drive.strength_limit > 0 || joint.drive.limit_restitution > 0) && steps(joint))
      joint.rate = joint_rate(joint);
  const b2Vec2 gravity = b2->GetGravity();
  for (FlatBody& flat : slots) {
    if (flat.body == kNoBody || flat.fixed || flat.set_apart) continue;
    flat.kicked = false;
    flat.at = flat.b2->GetWorldCenter();
    flat.before = flat.b2->GetLinearVelocity();
    flat.before_spin = flat.b2->GetAngularVelocity();
    flat.before_angle = flat.b2->GetAngle();
    flat.solved = false;
    flat.given.SetZero();
    flat.given_spin = 0;
    lightest = std::min(lightest, flat.mass.mass);
    heaviest = std::max(heaviest, flat.mass.mass);
    if (!(flat.free_flight() || flat.flies) || !flat.b2->IsAwake()) continue;
    // Half of the acceleration now and half at the end: Box2D's own step then lies on the parabola.
    if (!flat.flies) {
      b2Vec2 pull = gravity;
      if (flat.has_force) {
        const double scale = 1 / (flat.mass.mass * settings.unit);
        pull += b2Vec2(static_cast<float>(flat.force.x() * scale), static_cast<float>(flat.force.y() * scale));
      }
      flat.kick = static_cast<float>(dt / 2) * pull;
      flat.spin_kick = 0;
    }
    flat.b2->SetLinearVelocity(flat.b2->GetLinearVelocity() - flat.kick);
    if (flat.flies) flat.b2->SetAngularVelocity(flat.b2->GetAngularVelocity() - flat.spin_kick);
    flat.kicked_velocity = flat.b2->GetLinearVelocity();
    flat.kicked = true;
  }
}

/// Where bodies may sleep, a heap of discs would roll on in itself for ever, as nothing resists rolling. So two bodies
/// that both move, slowly, and touch with friction turn against each other ever less. Nothing that rolls or slides on
/// what does not move feels it, momentum stays, and what is lost is written down as friction.
void Planar::Core::resist_rolling(double dt) {
  if (!settings.sleeping) return;
  constexpr double kRate = 2;  // 1/s
  const double part = -std::expm1(-kRate * dt), u = settings.unit;
  for (FlatBody& a : slots) {
    if (a.body == kNoBody || a.fixed || !a.drowsy || !a.b2->IsAwake()) continue;
    for (b2ContactEdge* edge = a.b2->GetContactList(); edge; edge = edge->next) {
      FlatBody& b = of(edge->other);
      if (!edge->contact->IsTouching() || !(edge->contact->GetFriction() > 0)) continue;
      if (b.fixed || b.body < a.body || !b.drowsy || !b.b2->IsAwake()) continue;
      const double ia = a.mass.inertia(2, 2), ib = b.mass.inertia(2, 2);
      const double spin = double{b.b2->GetAngularVelocity()} - a.b2->GetAngularVelocity();
      const double impulse = part * spin / (1 / ia + 1 / ib);
      a.b2->ApplyAngularImpulse(static_cast<float>(impulse / (u * u)), false);
      b.b2->ApplyAngularImpulse(static_cast<float>(-impulse / (u * u)), false);
      ledger.friction_loss += impulse * spin * (1 - part / 2);
    }
  }
}

namespace {

constexpr double kWhole = 0.75;  // of a sub-step: what is shorter was cut

}  // namespace

/// Box2D starts from the impulses of the last step, times the ratio of their lengths. What stops an approach in a short
/// step would be multiplied by much in the next: while a sub-step is cut, each of its steps starts from the last that
/// was not.
void Planar::Core::start_warm(double dt) {
  const bool whole = dt >= kWhole * step_length;
  if (!kept && !whole && last_step > 0) kept.emplace(warm());
  if (!kept) return;
  set_impulses(*kept, double{last_step});
  if (whole) kept.reset();
}

/// An error may have ended a step within a sub-step that was cut: nothing is left of that but what an image would hold.
void Planar::Core::end_cut_short() {
  if (!b2) return;
  b2->ClearForces();
  if (!kept) return;
  set_impulses(*kept, double{last_step});
  kept.reset();
}

/// What a sub-step leaves for the next is that of one which was not cut.
void Planar::Core::end_cuts(double dt) {
  const auto whole = static_cast<float>(dt);
  if (!b2 || (!kept && last_step == whole)) return;
  if (!kept) {
    kept.emplace(warm());
    if (last_step < kWhole * dt) kept->contacts.clear();
  }
  set_impulses(*kept, dt);
  kept.reset();
  last_step = whole;
}

/// Rotation comes at the end like velocity, which the ledger gives back.
void Planar::Core::return_spins() {
  for (FlatBody& flat : slots)
    if (flat.kicked && flat.flies && flat.body != kNoBody && !flat.set_apart && flat.b2->IsAwake())
      flat.b2->SetAngularVelocity(flat.b2->GetAngularVelocity() + flat.spin_kick);
}

/// A step of Box2D. What came near in it, it would solve in the order in which its tree gave it, at impacts that it
/// moves bodies back to: so these are taken one by one, and new contacts are put where they belong before each.
void Planar::Core::step_box2d(float dt, int iterations) {
  stepping = true;
  b2->Step(dt, iterations, position_iterations());
  const auto order_fresh = [this] {
    if (fresh_contacts > 0) order_contacts();
  };
  try {
    do order_fresh();
    while (!solve_impacts(*b2, dt, iterations));
    return_spins();
  } catch (...) {
    b2->SetSubStepping(false);  // it would go on with this step's impacts in the next
    solve_impacts(*b2, dt, iterations);
    b2->SetSubStepping(true);
    stepping = false;
    throw;
  }
  stepping = false;
}

void Planar::Core::step(double dt, bool bounce) {
  start_warm(dt);
  set_stops(bounce);
  apply_forces(dt);
  resist_rolling(dt);
  kick(dt);
  make_contacts();
  const int iterations = iterations_now();
  set_length_of_last_step(*b2, last_step);
  step_box2d(static_cast<float>(dt), iterations);
  move_assemblies(dt);
  settle_landings(dt);
  close_joints(dt);
  take_back_gains(dt);
  end_ledger(dt);
  constexpr double kTooShort = 0.1;  // of a sub-step: single precision tells nothing of what changed in it
  for (FlatJoint& joint : joints)
    if (joint.used && joint.drive.limit_restitution > 0 && dt >= kTooShort * step_length && steps(joint)) {
      const double bend = (joint_rate(joint) - joint.rate) / dt;
      joint.bend = std::isfinite(bend) ? bend : 0;  // the guard is about to stop what has no numbers
    }
  last_step = static_cast<float>(dt);
  ++sub_step;
  ++counters.sub_steps;
  ++counters.evaluations;
  counters.solver_iterations += static_cast<std::uint64_t>(iterations);
  count_work(iterations);
  counters.pairs += static_cast<std::uint64_t>(b2->GetContactCount());
  rethrow();
}

void Planar::Core::report_lasting(double moment) {
  if (!client->any_handled()) {
    met.clear();
    return;
  }
  struct Lasting {
    BodyIndex a, b;
    Contact contact;
  };
  std::pmr::vector<Lasting> lasting(memory);
  for (b2Contact* contact = b2->GetContactList(); contact; contact = contact->GetNext()) {
    if (!contact->IsTouching()) continue;
    refresh(contact);
    if (!(contact->GetRestitution() >= 2)) continue;
    const BodyIndex x = of(contact->GetFixtureA()->GetBody()).body, y = of(contact->GetFixtureB()->GetBody()).body;
    const BodyPair pair = std::minmax(x, y);
    const auto [entry, fresh] = met.try_emplace(pair, false);
    if (entry->second || !client->handled(x, y)) continue;
    entry->second = true;
    const bool flipped = client->serial(x) > client->serial(y);
    lasting.push_back({flipped ? y : x, flipped ? x : y,
                       contact_between(contact->GetFixtureA(), contact->GetChildIndexA(), contact->GetFixtureB(),
                                       contact->GetChildIndexB(), flipped)});
  }
  for (auto entry = met.begin(); entry != met.end();) {
    const bool told = entry->second;
    entry->second = false;
    entry = told || near_enough(entry->first) ? std::next(entry) : met.erase(entry);
  }
  // A handler may free, move and make bodies.
  std::sort(lasting.begin(), lasting.end(), [this](const Lasting& p, const Lasting& q) {
    return std::pair(client->serial(p.a), client->serial(p.b)) < std::pair(client->serial(q.a), client->serial(q.b));
  });
  for (const Lasting& one : lasting)
    if (bodies->used(one.a) && bodies->used(one.b)) client->impact(one.a, one.b, one.contact, moment);
}

}  // namespace breve
