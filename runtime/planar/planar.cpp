// The face: settings, springs, questions, and the world's side. The work is done in the files that README.md
// lists.
#include "runtime/planar/planar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/planar/core.hpp"

namespace breve {

Planar::Planar(std::pmr::memory_resource* memory, Bodies& bodies)
    : memory_(memory), core_(make_in<Core>(memory, memory, bodies)) {
  share(*core_);
}
Planar::~Planar() = default;

MechanicsCore& Planar::inside() { return *core_; }

void Planar::rebind(Bodies& bodies) { core_->bodies = &bodies; }

void Planar::take_settings(const Mechanics& other) {
  WorldSettings& s = core_->settings;
  s.gravity = other.gravity();
  s.gravity.z() = 0;
  s.accuracy = other.accuracy();
  s.guard = other.guard();
  s.sleeping = other.sleeping();
  s.erp = other.erp();
  s.cfm = other.cfm();
  s.unit = other.length_unit();
  set_workers(other.workers());
}

// --- positions of joints --------------------------------------------------------------------------------------------

JointVector Planar::position(JointIndex joint) const { return {core_->read_position(core_->at(joint)), 0, 0}; }
JointVector Planar::velocity(JointIndex joint) const { return {core_->read_velocity(core_->at(joint)), 0, 0}; }

void Planar::set_position(JointIndex joint, const JointVector& position) {
  if (!std::isfinite(position[0])) fail_not_finite("the position");
  Core& c = *core_;
  FlatJoint& entry = c.at(joint);
  if (entry.loop) fail_loop_joint(entry.is.kind);
  if (entry.is.kind == JointKind::Fixed) return;
  take_changes();
  const JointDescription& is = entry.is;
  const Pose parent = is.parent == kNoBody ? Pose{} : c.pose(is.parent), from = c.pose(is.child);
  Pose to;
  const double rotation = is.kind == JointKind::Revolute ? -position[0] * is.normal.z() : 0;
  to.orientation = (parent.orientation * rotation_about_z(rotation) * is.relative_rotation).normalized();
  to.location = parent.location + parent.orientation * is.parent_point - to.orientation * is.child_point;
  if (is.kind == JointKind::Prismatic) to.location -= position[0] * (parent.orientation * is.normal);
  std::pmr::vector<BodyIndex> all(memory_);
  c.collect_beyond(joint, all);
  c.place_beyond(all, is.parent, from, to);
  entry.position = position[0];
  // Box2D counts turns by the bodies' angles.
  if (entry.b2) {
    c.drop_b2(entry);
    c.make_b2(entry);
  }
}

void Planar::set_velocity(JointIndex joint, const JointVector& velocity) {
  if (!std::isfinite(velocity[0])) fail_not_finite("the velocity");
  Core& c = *core_;
  const FlatJoint& entry = c.at(joint);
  if (entry.is.kind == JointKind::Fixed) return;
  take_changes();
  const JointDescription& is = entry.is;
  const double more = velocity[0] - c.read_velocity(entry);
  const Pose parent = is.parent == kNoBody ? Pose{} : c.pose(is.parent), child = c.pose(is.child);
  // The bodies on the child's side move as one with it; where the joint closes a loop, only the child is struck.
  std::pmr::vector<BodyIndex> all({is.child}, memory_);
  if (!entry.loop) c.collect_beyond(joint, all);
  const bool rotates = is.kind == JointKind::Revolute;
  const Vector3 spin = rotates ? Vector3(0, 0, -more * is.normal.z()) : Vector3(0, 0, 0);
  const Vector3 way = rotates ? Vector3(0, 0, 0) : Vector3(-more * (parent.orientation * is.normal));
  const Vector3 point = child.location + child.orientation * is.child_point;
  for (const BodyIndex body : all) {
    c.bodies->set_rotational_velocity(body, c.bodies->rotational_velocity(body) + spin);
    c.bodies->set_velocity(body, c.bodies->velocity(body) + way + spin.cross(c.bodies->location(body) - point));
  }
  if (c.b2 && !entry.loop) return c.give_velocities(all);
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

// --- settings -------------------------------------------------------------------------------------------------------

void Planar::length_unit_changed() {
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
  if (c.b2 || c.frozen) c.ledger.script_work += c.stored().total() - before;  // else no body has been counted yet
  c.wake_all();
}
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

void Planar::set_force_method(BodyIndex body, bool on) {
  auto& list = core_->force_methods;
  const auto position = std::lower_bound(list.begin(), list.end(), body);
  const bool there = position != list.end() && *position == body;
  if (on && !there) list.insert(position, body);
  if (on || !there) return;
  list.erase(position);
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
  if (const FrozenBody* one = core_->find_frozen(body)) return !one->awake && core_->bodies->dynamic(body);
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

std::size_t Planar::bytes() const { return core_->b2 ? core_->held.bytes() : 0; }

Mechanics::Census Planar::census() const {
  Census census;
  const Core& c = *core_;
  census.bodies = c.bodies->rigid();
  const auto count = [](std::size_t& number, ObjectId& first, ObjectId owner) {
    if (number++ == 0) first = owner;
  };
  count_connections(c.joints, c.springs, census);
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

void Planar::advance(MechanicsClient& client, double start, double h, double share) {
  core_->advance(client, start, h, share);
}
void Planar::abandon() { core_->client = nullptr; }

void Planar::take_changes() {
  core_->ensure_world();
  if (core_->b2) core_->push_changes();
}

bool Planar::pushes(BodyIndex a, BodyIndex b, const MechanicsClient& client) const {
  return core_->pushes(a, b, client);
}
void Planar::forget(BodyIndex body) { core_->forget(body); }
void Planar::save(ByteWriter& out) const {
  core_->prepare_image();
  core_->save(out);
}
void Planar::load(ByteReader& in) {
  core_->load(in);
  if (!core_->frozen || core_->bodies->rigid() == 0) return;
  // At once: what a script sets before the next step is then seen as a change, as in the world that was saved.
  try {
    core_->thaw_world();
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Memory) throw;  // any other is reported by the next step
  }
}
void Planar::hash(Hasher& hasher) const {
  core_->take_shapes();
  core_->hash(hasher);
}

}  // namespace breve
