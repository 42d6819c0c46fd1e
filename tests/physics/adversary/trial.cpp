#include "trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "measure.hpp"

namespace adversary {

namespace {

constexpr const char* kNames[kMeasures] = {"energy", "momentum", "spin",   "center", "books",
                                           "losses", "motors",   "forces", "told",   "far"};

/// What the searcher adds up while a creature moves.
class Books {
 public:
  Books(Creature& creature, const Case& one) : creature_(creature), one_(one) {
    ledger0_ = ledger_ = creature.world().energy().or_throw();  // also takes up what was set
    start_ = now_ = measure(creature);
    for (const Joint& joint : creature.joints()) last_.push_back(positions_of(creature, joint));
    for (const Joint& joint : creature.joints()) rates_.push_back(rates(joint));
    lowest_ = start_.total();
    const double differ = std::abs(start_.kinetic - ledger_.kinetic) + std::abs(start_.springs - ledger_.springs) +
                          std::abs(start_.potential - ledger_.potential);
    books_ = std::max(0.0, differ - start_.round_off());
    look_at_scales();
  }

  /// After each iteration. False: not finite, no use to go on.
  bool look(double step) {
    time_ += step;
    const breve_energy before = ledger_;
    ledger_ = creature_.world().energy().or_throw();
    now_ = measure(creature_);
    if (!now_.finite() || !std::isfinite(ledger_.residual)) return false;
    add_works(step);
    look_at_scales();
    const double balance = now_.total() - motor() - forces_;
    lowest_ = std::min(lowest_, balance);
    rise_ = std::max(rise_, balance - lowest_);
    gained_ = std::max(gained_, balance - start_.total());
    const double differ = std::abs(own_residual() - (ledger_.residual - ledger0_.residual));
    // A creature that cannot move has a scale of nearly nothing, and the heights that it keeps have round-off.
    books_ = std::max(books_, differ - std::max(start_.round_off(), now_.round_off()));
    motors_ = std::max(motors_, motor() - most_motor_);
    work_gap_ = std::max(work_gap_, std::abs(ledger_.script_work - ledger0_.script_work - forces_));
    // Only their sum: rows that are solved together may pass energy from one account to another, and from a motor.
    if (!has_motors(one_.family)) fall_ += std::max(0.0, losses(before) - losses(ledger_));
    told_ = std::max(told_, now_.told);
    momentum_ = std::max(momentum_, (now_.momentum - start_.momentum).norm());
    spin_ = std::max(spin_, (now_.spin - start_.spin).norm());
    const Vector3 straight = start_.center + time_ / start_.mass * start_.momentum;
    center_ = std::max(center_, (now_.center - straight).norm());
    far_ = std::max(far_, (now_.center - straight).norm() + now_.size);
    return true;
  }

  void close(Verdict& verdict) const {
    const double scale = std::max(scale_, 1e-9);
    verdict.scale = scale_;
    verdict.gained = gained_;
    auto& found = verdict.found;
    found[kEnergy] = rise_ / scale;
    found[kBooks] = books_ / scale;
    found[kLosses] = fall_ / scale;
    found[kMotors] = std::max(0.0, motors_) / scale;
    found[kForces] = work_gap_ / scale;
    found[kTold] = told_;
    if (has_gravity(one_.family)) return;
    const double speed = std::sqrt(2 * scale / start_.mass);
    found[kMomentum] = momentum_ / (start_.mass * speed);
    found[kSpin] = spin_ / std::sqrt(2 * scale * roundness_);
    found[kCenter] = center_ / (speed * std::max(time_, 1.0) + start_.size);
    if (one_.family == Family::Overlap) found[kFar] = far_;
  }

  void tell() const {
    std::printf(
        "t %7.4f  kinetic %11.5g potential %11.5g springs %11.5g  motor %11.5g force %11.5g  less works %13.7g  "
        "ledger's residual %11.5g own %11.5g  losses: contact %11.5g friction %11.5g drag %11.5g limits %11.5g  |dP| "
        "%9.3g "
        "|dL| %9.3g\n",
        time_, now_.kinetic, now_.potential, now_.springs, motor(), forces_, now_.total() - motor() - forces_,
        ledger_.residual - ledger0_.residual, own_residual(), ledger_.contact_loss - ledger0_.contact_loss,
        ledger_.friction_loss - ledger0_.friction_loss, ledger_.drag_loss - ledger0_.drag_loss,
        ledger_.limit_loss - ledger0_.limit_loss, (now_.momentum - start_.momentum).norm(),
        (now_.spin - start_.spin).norm());
  }

 private:
  double motor() const { return ledger_.motor_work - ledger0_.motor_work; }

  Vector3 rates(const Joint& joint) const { return Vector3(creature_.world().joint(joint.object).or_throw().velocity); }

  static double losses(const breve_energy& e) { return e.contact_loss + e.friction_loss + e.drag_loss + e.limit_loss; }

  double own_residual() const {
    const double works = motor() + ledger_.script_work - ledger0_.script_work;
    return now_.total() - start_.total() - works + losses(ledger_) - losses(ledger0_);
  }

  /// Of forces that stand still during an iteration the work is force times way; a motor's is at most that.
  void add_works(double step) {
    for (std::size_t i = 0; i < last_.size(); ++i) {
      const Joint& joint = creature_.joints()[i];
      if (joint.axes == 0) continue;
      const Positions at = positions_of(creature_, joint);
      const Vector3 rate = rates(joint);
      for (int k = 0; k < joint.axes; ++k) {
        const double way = at.q[k] - last_[i].q[k];
        if (joint.torque != 0) forces_ += joint.drive.force[k] * way;
        // The way there and back within an iteration is bounded by the rates at its ends.
        most_motor_ += joint.drive.strength_limit *
                       std::max(std::abs(way), 2 * step * std::max(std::abs(rate[k]), std::abs(rates_[i][k])));
      }
      last_[i] = at;
      rates_[i] = rate;
    }
  }

  void look_at_scales() {
    scale_ = std::max(scale_, now_.kinetic + std::abs(motor()) + std::abs(forces_));
    roundness_ = std::max(roundness_, now_.roundness);
  }

  Creature& creature_;
  const Case& one_;
  State start_, now_;
  breve_energy ledger0_{}, ledger_{};
  std::vector<Positions> last_;
  std::vector<Vector3> rates_;
  double time_ = 0, lowest_ = 0, rise_ = 0, gained_ = 0, books_ = 0, fall_ = 0, motors_ = 0, work_gap_ = 0, told_ = 0;
  double momentum_ = 0, spin_ = 0, center_ = 0, far_ = 0, forces_ = 0, most_motor_ = 0, scale_ = 0, roundness_ = 0;
};

/// A creature that takes thousands of times what others take is not run to its end. Its work is counted; what the
/// library tries and throws away it does not count, hence also a limit of time.
constexpr double kMostTime = 30;  // s of CPU

/// The work of the last iteration.
double work_of(const breve::World& world) {
  breve_physics_counters counted = breve_physics_counters_default();
  if (breve_world_physics_counters(world.get(), &counted) != BREVE_OK) return 0;
  return static_cast<double>(counted.evaluations + counted.pairs + counted.searches +
                             counted.solver_iterations *
                                 (1 + counted.contacts / std::max<std::uint64_t>(counted.sub_steps, 1)));
}

double seconds_since(std::clock_t begin) { return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC; }

void run_steps(Creature& creature, const Case& one, const Setting& setting, Verdict& verdict) {
  const std::clock_t begin = std::clock();
  Books books(creature, one);
  const auto steps = std::llround(setting.seconds / setting.step);
  if (setting.tell) books.tell();
  for (long long i = 0; i < steps; ++i) {
    creature.drive();
    creature.world().step().or_throw();
    for (const breve_intervention& act : creature.world().interventions().or_throw()) {
      ++verdict.interventions;
      if (setting.tell) std::printf("  guard: %s: %s (%g)\n", act.reason, act.action, act.value);
    }
    if (!books.look(setting.step)) {
      verdict.found.fill(1e30);
      return;
    }
    if (setting.tell) books.tell();
    verdict.work += work_of(creature.world());
    if (verdict.work < setting.work && seconds_since(begin) < kMostTime) continue;
    verdict.cut = setting.seconds - static_cast<double>(i + 1) * setting.step;
    break;
  }
  books.close(verdict);
}

}  // namespace

const char* name_of(Measure measure) { return kNames[measure]; }

bool measure_named(const std::string& name, Measure& measure) {
  for (int i = 0; i < kMeasures; ++i) {
    if (name != kNames[i]) continue;
    measure = static_cast<Measure>(i);
    return true;
  }
  return false;
}

double bound_of(Measure measure, breve_rung rung) {
  const bool coarse = rung == BREVE_RUNG_FAST || rung == BREVE_RUNG_BALANCED;
  switch (measure) {
    case kEnergy:
    case kLosses:
    case kForces: return coarse ? 1e-2 : 1e-4;
    case kMomentum:
    case kSpin: return 1e-9;
    case kMotors: return 1e-2;  // the way within an iteration is an estimate
    case kCenter:
    case kBooks:
    case kTold: return 1e-6;
    case kFar: return 100;
    case kMeasures: break;
  }
  return 0;
}

Measure Verdict::worst(breve_rung rung) const {
  Measure out = kEnergy;
  for (int i = 1; i < kMeasures; ++i)
    if (excess(static_cast<Measure>(i), rung) > excess(out, rung)) out = static_cast<Measure>(i);
  return out;
}

Verdict run_case(const Case& one, const Setting& setting) {
  Verdict verdict;
  const std::clock_t begin = std::clock();
  try {
    Creature creature(one, setting.rung, setting.step);
    run_steps(creature, one, setting, verdict);
  } catch (const breve::Failure& failure) {
    verdict.refused = failure.what();
  }
  verdict.cpu = seconds_since(begin);
  return verdict;
}

}  // namespace adversary
