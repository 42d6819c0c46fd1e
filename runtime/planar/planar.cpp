// The face: settings, springs, questions, and the world's side. The work is done in the files that README.md
// lists.
#include "runtime/planar/planar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/planar/core.hpp"

namespace breve {

namespace {

void need_range(std::string_view property, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw Error(ErrorCode::Argument, fmt::format("{} must be from {} to {}, but is {}", property, low, high, value));
}

void need_finite(double value, std::string_view what) {
  if (!std::isfinite(value)) throw Error(ErrorCode::Argument, fmt::format("{} of a joint must be finite", what));
}

}  // namespace

Planar::Planar(std::pmr::memory_resource* memory, Bodies& bodies)
    : memory_(memory), core_(make_in<Core>(memory, memory, bodies)) {}
Planar::~Planar() = default;

void Planar::rebind(Bodies& bodies) { core_->bodies = &bodies; }

void Planar::take_settings(const Mechanics& other) {
  FlatSettings& s = core_->settings;
  s.gravity = other.gravity();
  s.gravity.z() = 0;
  s.accuracy = other.accuracy();
  s.guard = other.guard();
  s.sleeping = other.sleeping();
  s.erp = other.erp();
  s.cfm = other.cfm();
  s.workers = other.workers();
}

// --- positions of joints --------------------------------------------------------------------------------------------

JointVector Planar::position(JointIndex joint) const { return {core_->read_position(core_->at(joint)), 0, 0}; }
JointVector Planar::velocity(JointIndex joint) const { return {core_->read_velocity(core_->at(joint)), 0, 0}; }

void Planar::set_position(JointIndex joint, const JointVector& position) {
  need_finite(position[0], "the position");
  Core& c = *core_;
  FlatJoint& entry = c.at(joint);
  if (entry.ring)
    throw Error(ErrorCode::Argument, fmt::format("the position of a {} joint that closes a loop cannot be set: the "
                                                 "other joints of the loop determine it",
                                                 name_of(entry.is.kind)));
  if (entry.is.kind == JointKind::Fixed) return;
  take_changes();
  const JointDescription& is = entry.is;
  const Pose parent = is.parent == kNoBody ? Pose{} : c.pose(is.parent), from = c.pose(is.child);
  Pose to;
  const double turn = is.kind == JointKind::Revolute ? -position[0] * is.normal.z() : 0;
  to.orientation = (parent.orientation * turned(turn) * is.relative_rotation).normalized();
  to.location = parent.location + parent.orientation * is.parent_point - to.orientation * is.child_point;
  if (is.kind == JointKind::Prismatic) to.location -= position[0] * (parent.orientation * is.normal);
  std::pmr::vector<BodyIndex> all(memory_);
  c.collect_beyond(joint, all);
  c.move_rigidly(all, from, to);
  entry.position = position[0];
  // Box2D counts turns by the bodies' angles.
  if (entry.b2) {
    c.drop_b2(entry);
    c.make_b2(entry);
  }
}

void Planar::set_velocity(JointIndex joint, const JointVector& velocity) {
  need_finite(velocity[0], "the velocity");
  Core& c = *core_;
  const FlatJoint& entry = c.at(joint);
  if (entry.is.kind == JointKind::Fixed) return;
  take_changes();
  const JointDescription& is = entry.is;
  const double more = velocity[0] - c.read_velocity(entry);
  const Pose parent = is.parent == kNoBody ? Pose{} : c.pose(is.parent), child = c.pose(is.child);
  // The bodies on the child's side move as one with it; where the joint closes a loop, only the child is struck.
  std::pmr::vector<BodyIndex> all({is.child}, memory_);
  if (!entry.ring) c.collect_beyond(joint, all);
  const bool turns = is.kind == JointKind::Revolute;
  const Vector3 spin = turns ? Vector3(0, 0, -more * is.normal.z()) : Vector3(0, 0, 0);
  const Vector3 way = turns ? Vector3(0, 0, 0) : Vector3(-more * (parent.orientation * is.normal));
  const Vector3 point = child.location + child.orientation * is.child_point;
  for (const BodyIndex body : all) {
    c.bodies->set_rotational_velocity(body, c.bodies->rotational_velocity(body) + spin);
    c.bodies->set_velocity(body, c.bodies->velocity(body) + way + spin.cross(c.bodies->location(body) - point));
  }
  if (c.b2 && !entry.ring) return c.give_velocities(all);
  take_changes();
}

void Planar::set_ball(JointIndex joint, const Quaternion&, const Vector3&) {
  core_->at(joint);
  throw Error(ErrorCode::Argument, "only a ball joint has an orientation, and a flat world has no ball joints");
}

JointReaction Planar::reaction(JointIndex joint) const {
  const FlatJoint& entry = core_->at(joint);
  if (!entry.b2 || !(core_->last_step > 0)) return {};
  const float rate = 1 / core_->last_step;
  const b2Vec2 force = entry.b2->GetReactionForce(rate);
  const double u = core_->settings.unit;
  return {{force.x * u, force.y * u, 0}, {0, 0, entry.b2->GetReactionTorque(rate) * u * u}};
}

// --- springs between bodies -----------------------------------------------------------------------------------------

namespace {
FlatSpring& at(Planar::Core& core, SpringIndex spring) {
  if (spring >= core.springs.size() || !core.springs[spring].used)
    throw Error(ErrorCode::Argument, "the spring is not connected");
  return core.springs[spring];
}
void need_ends_in_plane(const SpringDescription& is) {
  if (is.point_a.z() != 0 || is.point_b.z() != 0)
    throw Error(ErrorCode::Argument,
                "spring: a point of attachment is outside the plane, but this world is flat: z must be 0");
}
}  // namespace

SpringIndex Planar::tie(const SpringDescription& description, ObjectId owner) {
  check(description);
  need_ends_in_plane(description);
  Core& c = *core_;
  for (const BodyIndex end : {description.a, description.b})
    if (!c.bodies->used(end)) throw Error(ErrorCode::Argument, "spring: an end is not a body in the world");
  if (description.a == description.b) return kNoSpring;
  if (c.free_springs.capacity() <= c.springs.size()) c.free_springs.reserve(2 * c.springs.size() + 16);
  SpringIndex index = static_cast<SpringIndex>(c.springs.size());
  if (c.free_springs.empty()) {
    c.springs.emplace_back();
  } else {
    index = c.free_springs.back();
    c.free_springs.pop_back();
  }
  c.springs[index] = {true, owner, description, 0};
  c.wake_ends(c.springs[index]);
  return index;
}

void Planar::untie(SpringIndex spring) {
  core_->wake_ends(at(*core_, spring));
  at(*core_, spring) = FlatSpring();
  core_->free_springs.push_back(spring);
}

bool Planar::tied(SpringIndex spring) const { return spring < core_->springs.size() && core_->springs[spring].used; }
const SpringDescription& Planar::spring(SpringIndex spring) const { return at(*core_, spring).is; }

void Planar::set_spring(SpringIndex spring, const SpringDescription& description) {
  check(description);
  need_ends_in_plane(description);
  FlatSpring& entry = at(*core_, spring);
  const BodyIndex a = entry.is.a, b = entry.is.b;
  entry.is = description;
  entry.is.a = a;
  entry.is.b = b;
  core_->wake_ends(entry);
}

double Planar::spring_length(SpringIndex spring) const {
  const SpringDescription& is = at(*core_, spring).is;
  const Pose a = core_->pose(is.a), b = core_->pose(is.b);
  return (b.location + b.orientation * is.point_b - a.location - a.orientation * is.point_a).norm();
}

double Planar::spring_force(SpringIndex spring) const { return at(*core_, spring).force; }

// --- settings -------------------------------------------------------------------------------------------------------

double Planar::length_unit() const { return core_->settings.unit; }

void Planar::set_length_unit(double metres) {
  if (!std::isfinite(metres) || !(metres >= 1e-9 && metres <= 1e9))
    throw Error(ErrorCode::Argument, fmt::format("the length unit must be from 1e-9 to 1e9, but is {}", metres));
  if (metres == core_->settings.unit) return;
  core_->settings.unit = metres;
  core_->drop_world();
  core_->frozen.reset();
}

void Planar::set_gravity(const Vector3& gravity) {
  if (!gravity.allFinite()) throw Error(ErrorCode::Argument, "gravity must be finite");
  if (gravity.z() != 0)
    throw Error(ErrorCode::Argument, fmt::format("gravity is ({}, {}, {}), but this world is flat: z must be 0",
                                                 gravity.x(), gravity.y(), gravity.z()));
  Core& c = *core_;
  if (gravity == c.settings.gravity) return;
  const double before = c.stored().total();
  c.settings.gravity = gravity;
  if (c.b2 || c.frozen) c.account.script_work += c.stored().total() - before;  // else no body has been counted yet
  for (FlatBody& flat : c.slots)
    if (flat.body != kNoBody && !flat.fixed) flat.b2->SetAwake(true);
}
const Vector3& Planar::gravity() const { return core_->settings.gravity; }

void Planar::set_accuracy(Rung rung) { set_accuracy(accuracy_of(rung)); }
void Planar::set_accuracy(const Accuracy& accuracy) {
  check(accuracy);
  core_->settings.accuracy = accuracy;
}
const Accuracy& Planar::accuracy() const { return core_->settings.accuracy; }

std::string Planar::describe_accuracy() const {
  const Accuracy& a = accuracy();
  return fmt::format(
      "{}{}, flat: {} sub-steps of Box2D in an integration step{}, with {} iterations for velocities and {} for "
      "positions; {}; single precision at a length unit of {}. Without effect here: integrator, tolerance, implicit "
      "joints and rotation, direct solver, contact springs, erp and cfm, workers.",
      name_of(a.rung), a.custom ? ", with custom settings" : "", core_->sub_steps(),
      core_->longest_step() > 0 ? fmt::format(", of at most {} s each", core_->longest_step()) : "",
      core_->velocity_iterations(), core_->position_iterations(),
      a.locate_impacts ? "impacts with handlers, and rebounds of few bodies, at their time of impact"
                       : "impacts with handlers at their time of impact",
      length_unit());
}

void Planar::set_guard(GuardMode mode) { core_->settings.guard = mode; }
GuardMode Planar::guard() const { return core_->settings.guard; }

void Planar::set_sleeping(bool on) { core_->settings.sleeping = on; }
bool Planar::sleeping() const { return core_->settings.sleeping; }

void Planar::set_fast_contacts(int iterations) {
  need_range("the number of iterations", iterations, 0, kMostIterations);
  core_->settings.fast_contacts = iterations;
}

void Planar::set_softness(double erp, double cfm) {
  need_range("erp", erp, 0, 1);
  if (!std::isfinite(cfm) || cfm < 0)
    throw Error(ErrorCode::Argument, fmt::format("cfm must be finite and >= 0, but is {}", cfm));
  core_->settings.erp = erp;
  core_->settings.cfm = cfm;
}
double Planar::erp() const { return core_->settings.erp; }
double Planar::cfm() const { return core_->settings.cfm; }

void Planar::set_workers(int workers) {
  need_range("the number of workers", workers, 1, 1024);
  core_->settings.workers = workers;
}
int Planar::workers() const { return core_->settings.workers; }

void Planar::set_force_method(BodyIndex body, bool on) {
  auto& list = core_->force_methods;
  const auto place = std::lower_bound(list.begin(), list.end(), body);
  const bool there = place != list.end() && *place == body;
  if (on && !there) list.insert(place, body);
  if (on || !there) return;
  list.erase(place);
  if (FlatBody* flat = core_->find(body)) {
    flat->pulled = false;
    flat->asked = Vector2::Zero();
  }
}
bool Planar::force_method(BodyIndex body) const {
  return std::binary_search(core_->force_methods.begin(), core_->force_methods.end(), body);
}

// --- questions ------------------------------------------------------------------------------------------------------

bool Planar::asleep(BodyIndex body) const {
  const FlatBody* flat = core_->find(body);
  return flat && !flat->fixed && !flat->b2->IsAwake();
}

Energy Planar::energy() const {
  // What scripts set since the last step is theirs.
  core_->ensure_world();
  if (core_->b2) core_->push_changes();
  return core_->energy();
}

Energy Planar::energy(BodyIndex body) const {
  Energy sum;
  for (const BodyIndex link : links_of(body)) {
    if (!core_->bodies->dynamic(link)) continue;
    const double whole = core_->energy_of(link);
    const double height = -core_->bodies->mass_properties(link).mass *
                          core_->settings.gravity.dot(core_->bodies->location(link) +
                                                      core_->bodies->orientation(link) *
                                                          core_->bodies->mass_properties(link).center_of_mass);
    sum.kinetic += whole - height;
    sum.potential += height;
  }
  return sum;
}

const DynamicsCounters& Planar::counters() const { return core_->counters; }
std::span<const Intervention> Planar::interventions() const { return core_->interventions; }
std::span<const Impact> Planar::impacts() const { return core_->impacts; }
std::size_t Planar::bytes() const { return core_->b2 ? core_->held.bytes() : 0; }

Mechanics::Census Planar::census() const {
  Census census;
  const Core& c = *core_;
  census.bodies = c.bodies->rigid();
  const auto count = [](std::size_t& number, ObjectId& first, ObjectId owner) {
    if (number++ == 0) first = owner;
  };
  for (const FlatJoint& joint : c.joints) {
    if (!joint.used) continue;
    const JointDrive& drive = joint.drive;
    count(census.joints, census.first_joint, joint.owner);
    if (axis_count(joint.is.kind) > 0 && (std::isfinite(drive.low[0]) || std::isfinite(drive.high[0])))
      count(census.limits, census.first_limit, joint.owner);
    if (drive.strength_limit > 0) count(census.motors, census.first_motor, joint.owner);
    if (drive.stiffness > 0) count(census.springs, census.first_spring, joint.owner);
  }
  for (const FlatSpring& tie : c.springs)
    if (tie.used) count(census.springs, census.first_spring, tie.owner);
  for (const BodyIndex body : c.force_methods)
    if (c.bodies->used(body)) count(census.force_methods, census.first_force_method, c.bodies->owner(body));
  census.asleep = c.counters.sleeping;
  if (!c.b2) return census;
  for (const b2Contact* contact = c.b2->GetContactList(); contact; contact = contact->GetNext()) {
    const ObjectId owner = c.bodies->owner(core_->of(contact->GetFixtureA()->GetBody()).body);
    count(census.pairs, census.first_pair, owner);
    if (contact->GetRestitution() < 0) continue;  // nothing is known of it yet
    if (contact->GetFriction() > 0) count(census.rough, census.first_rough, owner);
    if (std::fmod(contact->GetRestitution(), 2.0F) > 0) count(census.bouncing, census.first_bouncing, owner);
  }
  return census;
}

// --- the world's side -----------------------------------------------------------------------------------------------

void Planar::begin_iteration(std::uint64_t iteration, const WorkBound& bound) {
  core_->iteration = iteration;
  core_->bound = bound;
  core_->counters = {};
  core_->interventions.clear();
  core_->impacts.clear();
}

void Planar::advance(DynamicsClient& client, double start, double h, double share) {
  core_->advance(client, start, h, share);
}
bool Planar::over() const { return core_->over(); }
void Planar::abandon() { core_->client = nullptr; }

void Planar::take_changes() {
  core_->ensure_world();
  if (core_->b2) core_->push_changes();
}

bool Planar::pushes(BodyIndex a, BodyIndex b, const DynamicsClient& client) const {
  return core_->pushes(a, b, client);
}
std::uint64_t Planar::rules() const { return core_->rules; }
void Planar::forget(BodyIndex body) { core_->forget(body); }
void Planar::save(ByteWriter& out) const { core_->save(out); }
void Planar::load(ByteReader& in) { core_->load(in); }
void Planar::hash(Hasher& hasher) const { core_->hash(hasher); }

}  // namespace breve
