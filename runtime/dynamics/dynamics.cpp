// The functions that others call: settings, questions, and the world's side. The files in README.md do the work.
#include "runtime/dynamics/dynamics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/dynamics/island.hpp"
#include "runtime/dynamics/joint_frames.hpp"

namespace breve {

Dynamics::Dynamics(std::pmr::memory_resource* memory, Bodies& bodies) : memory_(memory), bodies_(&bodies) {}
Dynamics::~Dynamics() = default;

Dynamics::Core& Dynamics::core() {
  if (!core_) {
    core_ = make_in<Core>(memory_, memory_, *bodies_);
    share(*core_);
  }
  return *core_;
}
MechanicsCore& Dynamics::inside() { return core(); }

void Dynamics::rebind(Bodies& bodies) {
  bodies_ = &bodies;
  if (core_) core_->bodies = &bodies;
}

// --- positions of joints --------------------------------------------------------------------------------------------

JointVector Dynamics::position(JointIndex joint) const {
  this->joint(joint);
  core_->take_changes();
  return core_->read_position(core_->at(joint));
}

JointVector Dynamics::velocity(JointIndex joint) const {
  this->joint(joint);
  core_->take_changes();
  return core_->read_velocity(core_->at(joint));
}

namespace {
void need_in_tree(const JointEntry& joint) {
  if (joint.link < 0) fail_loop_joint(joint.is.kind);
}
}  // namespace

void Dynamics::set_position(JointIndex joint, const JointVector& position) {
  if (!position.allFinite()) fail_not_finite("the position");
  this->joint(joint);
  Core& c = *core_;
  c.take_changes();
  const JointEntry& entry = c.at(joint);
  need_in_tree(entry);
  Tree& tree = *c.trees[entry.tree];
  put_joint_position(entry.is, entry.flipped, position, tree.state.q.data() + tree.model.body(entry.link).q);
  c.place_links(tree);
}

void Dynamics::set_velocity(JointIndex joint, const JointVector& velocity) {
  if (!velocity.allFinite()) fail_not_finite("the velocity");
  this->joint(joint);
  Core& c = *core_;
  c.take_changes();
  const JointEntry& entry = c.at(joint);
  need_in_tree(entry);
  Tree& tree = *c.trees[entry.tree];
  const articulated::Body& body = tree.model.body(entry.link);
  put_joint_velocity(entry.is, entry.flipped, tree.state.q.data() + body.q, velocity, tree.state.v.data() + body.v);
  c.place_links(tree);
}

void Dynamics::set_ball(JointIndex joint, const Quaternion& rotation, const Vector3& spin) {
  const double norm = rotation.norm();
  if (!std::isfinite(norm) || !(norm > 0) || !spin.allFinite())
    throw Error(
        ErrorCode::Argument,
        "the orientation and angular velocity of a ball joint must be finite, and the orientation must not be zero");
  this->joint(joint);
  Core& c = *core_;
  c.take_changes();
  const JointEntry& entry = c.at(joint);
  if (entry.is.kind != JointKind::Ball) throw Error(ErrorCode::Argument, "only a ball joint has an orientation");
  need_in_tree(entry);
  Tree& tree = *c.trees[entry.tree];
  const articulated::Body& body = tree.model.body(entry.link);
  put_ball(entry.is, entry.flipped, rotation.normalized(), spin, tree.state.q.data() + body.q,
           tree.state.v.data() + body.v);
  c.place_links(tree);
}

// --- settings -------------------------------------------------------------------------------------------------------

void Dynamics::set_gravity(const Vector3& gravity) {
  if (!gravity.allFinite()) throw Error(ErrorCode::Argument, "gravity must be finite");
  if (gravity == core().settings.gravity) return;
  Core& c = core();
  c.settings.gravity = gravity;
  c.near.wake_all();
  // What it changes of the energy of height is the script's work.
  for (BodyIndex body = 0; body < c.booked.size(); ++body)
    if (in_books(c.booked[body])) c.unsettled.push_back(body);
  for (const std::uint32_t index : c.tree_order) c.trees[index]->changed = true;
}
void Dynamics::accuracy_changed() { core_->integrators_changed = true; }
void Dynamics::sleeping_ended() { core_->near.wake_all(); }
void Dynamics::length_unit_changed() {
  core_->near.wake_all();
  accuracy_changed();
}

void Dynamics::set_force_method(BodyIndex body, bool on) {
  if (!core_ && !on) return;
  Core& c = core();
  BodyEntry& known = c.entry(body);
  if (known.force_method == on) return;
  known.force_method = on;
  c.clusters_changed = true;
  if (known.tree == kNone)
    c.graph_changed = c.graph_changed || on;
  else if (!c.needs_tree(body))
    c.drop_tree(known.tree);
}
bool Dynamics::force_method(BodyIndex body) const {
  const BodyEntry* known = core_ ? core_->find(body) : nullptr;
  return known && known->force_method;
}

// --- questions ------------------------------------------------------------------------------------------------------

Dynamics::Census Dynamics::census() const {
  Census census;
  census.bodies = bodies_->rigid();
  if (!core_) return census;
  const auto count = [](std::size_t& number, ObjectId& first, ObjectId owner) {
    if (number++ == 0) first = owner;
  };
  count_connections(core_->joints, core_->springs, census);
  core_->near.each([&](const PairKey&, const NearPair& pair) {
    const ObjectId owner = bodies_->owner(pair.a);
    count(census.pairs, census.first_pair, owner);
    if (pair.law.static_friction > 0) count(census.rough, census.first_rough, owner);
    if (pair.law.restitution > 0) count(census.bouncing, census.first_bouncing, owner);
  });
  census.asleep = core_->counters.sleeping;
  for (const BodyEntry& entry : core_->entries)
    if (entry.body != kNoBody && entry.force_method)
      count(census.force_methods, census.first_force_method, bodies_->owner(entry.body));
  return census;
}

std::size_t Dynamics::Core::bytes() const {
  std::size_t sum = sizeof(Core) + joints.capacity() * sizeof(JointEntry) + springs.capacity() * sizeof(SpringEntry) +
                    entries.capacity() * sizeof(BodyEntry) + entry_of.capacity() * sizeof(std::uint32_t) +
                    booked.capacity() * sizeof(double) + near.bytes();
  for (const auto& tree : trees)
    if (tree)
      sum += sizeof(Tree) + tree->reserved.bytes() + tree->links.capacity() * sizeof(TreeLink) +
             tree->data.work.capacity() * sizeof(articulated::Work);
  return sum;
}

std::size_t Dynamics::bytes() const { return core_ ? core_->bytes() : 0; }

// --- the world's side -----------------------------------------------------------------------------------------------

void Dynamics::advance(MechanicsClient& client, double start, double h, double share) {
  core().bound = bound();
  core().advance(client, start, h, share);
}

void Dynamics::take_changes() {
  if (core_) core_->take_changes();
}

void Dynamics::forget(BodyIndex body) {
  if (!core_) return;
  core_->near.forget(body);
  if (body < core_->booked.size()) core_->booked[body] = kNoBook;
  if (core_->find(body)) core_->forget(body);
}

}  // namespace breve
