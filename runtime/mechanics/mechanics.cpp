// The functions that are the same in space and in a flat world: settings, questions about joints and springs, events.
#include "runtime/mechanics/mechanics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/base/meter.hpp"
#include "runtime/mechanics/core.hpp"

namespace breve {

namespace {

const WorldSettings kSettings{};
constexpr double kLeastUnit = 1e-9, kMostUnit = 1e9;  // m
const DynamicsCounters kNoCounters{};

void need_range(std::string_view property, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw Error(ErrorCode::Argument, fmt::format("{} must be from {} to {}, but is {}", property, low, high, value));
}

const JointRecord& need(const JointRecord* joint) {
  if (!joint) fail_no_joint();
  return *joint;
}

const SpringRecord& need(const SpringRecord* spring) {
  if (!spring) fail_no_spring();
  return *spring;
}

}  // namespace

// --- joints and springs ---------------------------------------------------------------------------------------------

bool Mechanics::linked(JointIndex joint) const { return joint_record(joint) != nullptr; }
const JointDescription& Mechanics::joint(JointIndex joint) const { return need(joint_record(joint)).is; }
ObjectId Mechanics::joint_owner(JointIndex joint) const { return need(joint_record(joint)).owner; }
bool Mechanics::closes_loop(JointIndex joint) const { return need(joint_record(joint)).loop; }
const JointDrive& Mechanics::drive(JointIndex joint) const { return need(joint_record(joint)).drive; }

double Mechanics::strength_hard_limit(JointIndex joint) const {
  constexpr double kPerMass = 500;  // N*m a kg
  const BodyIndex child = this->joint(joint).child;
  return kPerMass * shared_->bodies->mass(child);
}

bool Mechanics::has_spring(SpringIndex spring) const { return spring_record(spring) != nullptr; }
const SpringDescription& Mechanics::spring(SpringIndex spring) const { return need(spring_record(spring)).is; }
double Mechanics::spring_force(SpringIndex spring) const { return need(spring_record(spring)).force; }

double Mechanics::spring_length(SpringIndex spring) const {
  const SpringDescription& is = this->spring(spring);
  const Bodies& bodies = *shared_->bodies;
  const Vector3 a = bodies.location(is.a) + bodies.orientation(is.a) * is.point_a;
  const Vector3 b = bodies.location(is.b) + bodies.orientation(is.b) * is.point_b;
  return (b - a).norm();
}

void Mechanics::share(MechanicsCore& core) {
  shared_ = &core;
  core.settings.workers = workers_;
}

// --- settings of an assembly ----------------------------------------------------------------------------------------

void Mechanics::set_self_collisions(BodyIndex body, bool on) {
  MechanicsCore& core = inside();
  settings_begin(body);
  core.own[body].has_self = true;
  core.own[body].self_collisions = on;
  ++core.rules;
}

bool Mechanics::self_collisions(BodyIndex body) const {
  const AssemblySettings* found = settings_of(body, [](const AssemblySettings& s) { return s.has_self; });
  return found && found->self_collisions;
}

void Mechanics::set_accuracy(BodyIndex body, const Accuracy& accuracy) {
  check(accuracy);
  MechanicsCore& core = inside();
  settings_begin(body);
  core.own[body].has_accuracy = true;
  core.own[body].accuracy = accuracy;
  accuracy_changed();
}

void Mechanics::clear_accuracy(BodyIndex body) {
  if (!shared_) return;
  const auto found = shared_->own.find(body);
  if (found == shared_->own.end()) return;
  found->second.has_accuracy = false;
  accuracy_changed();
}

const Accuracy& Mechanics::accuracy(BodyIndex body) const {
  const AssemblySettings* found = settings_of(body, [](const AssemblySettings& s) { return s.has_accuracy; });
  return found ? found->accuracy : accuracy();
}

// --- settings of the world ------------------------------------------------------------------------------------------

const WorldSettings& Mechanics::settings() const { return shared_ ? shared_->settings : kSettings; }

double Mechanics::length_unit() const { return settings().unit; }
void Mechanics::set_length_unit(double metres) {
  if (!(metres >= kLeastUnit && metres <= kMostUnit))
    throw Error(ErrorCode::Argument, fmt::format("the length unit must be from 1e-9 to 1e9, but is {}", metres));
  if (metres == length_unit()) return;
  inside().settings.unit = metres;
  length_unit_changed();
}

const Vector3& Mechanics::gravity() const { return settings().gravity; }

void Mechanics::set_accuracy(Rung rung) { set_accuracy(accuracy_of(rung)); }
void Mechanics::set_accuracy(const Accuracy& accuracy) {
  check(accuracy);
  inside().settings.accuracy = accuracy;
  accuracy_changed();
}
const Accuracy& Mechanics::accuracy() const { return settings().accuracy; }

void Mechanics::set_guard(GuardMode mode) { inside().settings.guard = mode; }
GuardMode Mechanics::guard() const { return settings().guard; }

void Mechanics::set_sleeping(bool on) {
  inside().settings.sleeping = on;
  if (!on) sleeping_ended();
}
bool Mechanics::sleeping() const { return settings().sleeping; }

void Mechanics::set_fast_contacts(int iterations) {
  need_range("the number of iterations", iterations, 0, kMostIterations);
  inside().settings.fast_contacts = iterations;
}

void Mechanics::set_softness(double erp, double cfm) {
  need_range("erp", erp, 0, 1);
  if (!std::isfinite(cfm) || cfm < 0)
    throw Error(ErrorCode::Argument, fmt::format("cfm must be finite and >= 0, but is {}", cfm));
  WorldSettings& s = inside().settings;
  s.erp = erp;
  s.cfm = cfm;
}
double Mechanics::erp() const { return settings().erp; }
double Mechanics::cfm() const { return settings().cfm; }

void Mechanics::set_workers(int workers) {
  need_range("the number of workers", workers, 1, 1024);
  workers_ = workers;
  if (shared_) shared_->settings.workers = workers;
}
int Mechanics::workers() const { return workers_; }

// --- what happened --------------------------------------------------------------------------------------------------

void Mechanics::begin_iteration(std::uint64_t iteration, const WorkBound& bound) {
  bound_ = bound;
  if (!shared_) return;
  shared_->iteration = iteration;
  shared_->bound = bound;
  shared_->counters = {};
  shared_->interventions.clear();
  shared_->impacts.clear();
}

void Mechanics::begin_call(const WorkBound& bound) {
  bound_ = bound;
  if (!shared_) return;
  shared_->bound = bound;
  if (bound.most == 0) return;
  const std::uint64_t done = shared_->counters.work;
  shared_->bound.most += std::min(done, Meter::kNoBound - bound.most);
}

const DynamicsCounters& Mechanics::counters() const { return shared_ ? shared_->counters : kNoCounters; }

std::span<const Intervention> Mechanics::interventions() const {
  return shared_ ? std::span<const Intervention>(shared_->interventions) : std::span<const Intervention>();
}

std::span<const Impact> Mechanics::impacts() const {
  return shared_ ? std::span<const Impact>(shared_->impacts) : std::span<const Impact>();
}

bool Mechanics::over() const { return shared_ && shared_->over(); }
std::uint64_t Mechanics::rules() const { return shared_ ? shared_->rules : 0; }

// --- refused in the same words --------------------------------------------------------------------------------------

void fail_no_joint() { throw Error(ErrorCode::Argument, "the joint is not linked"); }
void fail_no_spring() { throw Error(ErrorCode::Argument, "the spring is not connected"); }

void fail_not_finite(std::string_view what) {
  throw Error(ErrorCode::Argument, fmt::format("{} of a joint must be finite", what));
}

void fail_loop_joint(JointKind kind) {
  throw Error(ErrorCode::Argument, fmt::format("the position of a {} joint that closes a loop cannot be set: the other "
                                               "joints of the loop determine it",
                                               name_of(kind)));
}

void check_motion(const Vector3& velocity, const Vector3& spin) {
  if (!velocity.allFinite()) throw Error(ErrorCode::Argument, "velocity must be finite");
  if (!spin.allFinite()) throw Error(ErrorCode::Argument, "rotational velocity must be finite");
}

void check_softness_within(double erp, double cfm) {
  if (!std::isfinite(erp) || erp < 0 || erp > 1)
    throw Error(ErrorCode::Argument, fmt::format("self collision erp must be from 0 to 1, but is {}", erp));
  if (!std::isfinite(cfm) || cfm < 0)
    throw Error(ErrorCode::Argument, fmt::format("self collision cfm must be finite and >= 0, but is {}", cfm));
}

void check_ends(const SpringDescription& is, const Bodies& bodies) {
  for (const BodyIndex end : {is.a, is.b})
    if (!bodies.used(end)) throw Error(ErrorCode::Argument, "spring: an end is not a body in the world");
}

void check_loaded(const WorldSettings& s) {
  check(s.accuracy);
  if (s.fast_contacts < 0 || s.fast_contacts > kMostIterations) ByteReader::fail();
  if (!(s.erp >= 0 && s.erp <= 1) || !(s.cfm >= 0)) ByteReader::fail();
  if (!(s.unit >= kLeastUnit && s.unit <= kMostUnit)) ByteReader::fail();
  if (static_cast<int>(s.guard) > static_cast<int>(GuardMode::Rest) || !s.gravity.allFinite()) ByteReader::fail();
}

}  // namespace breve
