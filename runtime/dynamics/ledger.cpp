// Where energy is and where it went. The energy of motion, height and springs is summed when a caller asks; works and
// losses are noted where they arise. The rest is the residual. Nothing repairs it.
#include <algorithm>
#include <span>
#include <utility>

#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/joint_frames.hpp"
#include "runtime/dynamics/motion.hpp"

namespace breve {

Energy Dynamics::Core::energy_of(Tree& tree) const {
  Energy now = tree.ledger;
  now.kinetic = tree.kinetic();
  now.potential = articulated::potential_energy(tree.model, tree.data, settings.gravity);
  now.springs = joint_springs(tree);
  return now;
}

double Dynamics::Core::joint_springs(Tree& tree) const {
  // From the joints' own numbers: what the loads hold is of the last step.
  double energy = 0;
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    if (tree.links[i].joint == kNoJoint) continue;
    const JointEntry& joint = joints[tree.links[i].joint];
    if (!(joint.drive.stiffness > 0)) continue;
    double rest[4] = {};
    put_joint_position(joint.is, joint.flipped, joint.drive.rest, rest);
    const double* q = tree.state.q.data() + tree.model.body(static_cast<int>(i)).q;
    energy += 0.5 * joint.drive.stiffness * joint_deflection(joint.is.kind, rest, q).squaredNorm();
  }
  return energy;
}

double Dynamics::Core::spring_energy(const SpringDescription& is) const {
  const Pose a = pose(is.a), b = pose(is.b);
  const Vector3 way = b.location + b.orientation * is.point_b - a.location - a.orientation * is.point_a;
  return pull_of(is, way, Vector3::Zero()).energy;
}

double Dynamics::Core::spring_energy_in(const SpringDescription& is) const {
  // Of trees as they stand after forward kinematics; the arrays may be behind.
  const auto at = [this](BodyIndex body) {
    const BodyEntry* known = find(body);
    return known && known->tree != kNone ? trees[known->tree]->pose(known->link) : pose(body);
  };
  const Pose a = at(is.a), b = at(is.b);
  const Vector3 way = b.location + b.orientation * is.point_b - a.location - a.orientation * is.point_a;
  return pull_of(is, way, Vector3::Zero()).energy;
}

Energy Dynamics::Core::free_energy(BodyIndex body) const {
  Energy now;
  const FreeBody free = read_free(*bodies, body);
  now.kinetic = free.kinetic();
  now.potential = -free.solid->mass * settings.gravity.dot(free.center);
  return now;
}

// --- what scripts did -----------------------------------------------------------------------------------------------

/// What takes part in a step from now on is in the books, with what it has.
void Dynamics::Core::enter_books() {
  if (booked.size() < bodies->index_end()) booked.resize(bodies->index_end(), kNoBook);
  for (const BodyIndex body : near.movers()) {
    if (in_books(booked[body]) || !bodies->dynamic(body)) continue;
    const BodyEntry* known = find(body);
    if (!known || known->tree == kNone) booked[body] = free_energy(body).total();
  }
  for (const std::uint32_t index : tree_order)
    if (!in_books(trees[index]->booked)) trees[index]->booked = energy_of(*trees[index]).total();
  for (SpringEntry& spring : springs)
    if (spring.used && !in_books(spring.booked)) spring.booked = spring_energy(spring.is);
}

bool Dynamics::Core::known_to_books(BodyIndex body) const {
  const BodyEntry* known = find(body);
  return in_books(known && known->tree != kNone ? trees[known->tree]->booked : book_of(body));
}

/// Energy that came in since the last step by what scripts and hosts set, J.
/// @param write  to the books, once for each change: how often somebody asks makes no difference
double Dynamics::Core::settle_books(bool write) {
  double sum = 0;
  std::sort(unsettled.begin(), unsettled.end());
  unsettled.erase(std::unique(unsettled.begin(), unsettled.end()), unsettled.end());
  for (const BodyIndex body : unsettled) {
    const BodyEntry* known = find(body);
    if (!in_books(book_of(body)) || !bodies->dynamic(body) || (known && known->tree != kNone)) continue;
    const double now = free_energy(body).total();
    sum += now - booked[body];
    if (write) booked[body] = now;
  }
  if (write) unsettled.clear();
  bool changed = false;
  for (const std::uint32_t index : tree_order) {
    changed = changed || trees[index]->changed;
    sum += settle_tree(*trees[index], write);
  }
  for (SpringEntry& spring : springs)
    if (spring.used && (changed || spring.set || !bodies->dynamic(spring.is.a) || !bodies->dynamic(spring.is.b)))
      sum += settle_spring(spring, write);
  if (write) ledger.script_work += sum;
  return sum;
}

double Dynamics::Core::settle_tree(Tree& tree, bool write) {
  if (!tree.changed || !in_books(tree.booked)) return 0;
  const double now = energy_of(tree).total(), work = now - tree.booked;
  if (!write) return work;
  tree.ledger.script_work += work;
  tree.booked = now;
  tree.changed = false;
  return work;
}

double Dynamics::Core::settle_spring(SpringEntry& spring, bool write) {
  if (!in_books(spring.booked)) return 0;
  const double now = spring_energy(spring.is), work = now - spring.booked;
  if (!write) return work;
  spring.booked = now;
  spring.set = false;
  return work;
}

void Dynamics::Core::add_stored(Energy& sum) {
  for (const std::uint32_t index : tree_order) {
    const Energy one = energy_of(*trees[index]);
    sum.kinetic += one.kinetic;
    sum.potential += one.potential;
    sum.springs += one.springs;
  }
  // The list's order depends on the past: by index, so that a sum is the same after a snapshot.
  for (BodyIndex body = 0; body < bodies->index_end(); ++body) {
    if (!bodies->dynamic(body)) continue;
    const BodyEntry* known = find(body);
    if (known && known->tree != kNone) continue;
    const Energy one = free_energy(body);
    sum.kinetic += one.kinetic;
    sum.potential += one.potential;
  }
  for (const SpringEntry& spring : springs)
    if (spring.used) sum.springs += spring_energy(spring.is);
  near.each([&sum](const PairKey&, const NearPair& pair) { sum.springs += pair.stored; });
}

Energy Dynamics::energy() const {
  if (!core_) return {};
  core_->take_changes();
  Energy sum = core_->ledger;
  sum.script_work += core_->settle_books(false);
  core_->add_stored(sum);
  return sum;
}

Energy Dynamics::energy(BodyIndex body) const {
  if (!core_) return {};
  core_->take_changes();
  const BodyEntry* known = core_->find(body);
  if (known && known->tree != kNone) {
    Tree& tree = *core_->trees[known->tree];
    Energy sum = core_->energy_of(tree);
    sum.script_work += core_->settle_tree(tree, false);
    return sum;
  }
  return core_->bodies->dynamic(body) ? core_->free_energy(body) : Energy{};
}

bool Dynamics::asleep(BodyIndex body) const { return core_ && core_->near.asleep(body); }

/// What a pair carried in the last sub-step, on its `a`.
Vector3 Dynamics::Core::carried(const NearPair& pair) const {
  Vector3 force = Vector3::Zero();
  if (!pair.touching || pair.warm_count == 0) return force;
  const std::span warm = std::span(pair.warm).first(static_cast<std::size_t>(pair.warm_count));
  if (!(pair.spring.stiffness > 0)) {
    for (const WarmPoint& point : warm) force += point.force;
    return force;
  }
  const auto pose = [this](BodyIndex body) { return Pose{bodies->location(body), bodies->orientation(body)}; };
  const Vector3 normal =
      closest(*bodies->collision_shape(pair.a), pose(pair.a), *bodies->collision_shape(pair.b), pose(pair.b)).normal;
  for (const WarmPoint& point : warm) {
    force += point.before * normal;
    // The stretch of one that slides is longer than what friction lets its force become.
    Vector3 along = -pair.spring.tangential_stiffness * point.force;
    const double most = (point.slides ? pair.law.dynamic_friction : pair.law.static_friction) * point.before;
    if (along.norm() > most) along *= most / along.norm();
    force += along;
  }
  return force;
}

Vector3 Dynamics::contact_force(BodyIndex body, BodyIndex other) const {
  Vector3 force = Vector3::Zero();
  if (!core_) return force;
  const auto add = [&](const NearPair& pair) { force += core_->carried(pair) * (pair.a == body ? 1 : -1); };
  if (other == kNoBody)
    std::as_const(core_->near).each([&](const PairKey& key, const NearPair& pair) {
      if (key.a == body || key.b == body) add(pair);
    });
  else if (const NearPair* pair = core_->near.find(body, other))
    add(*pair);
  return force;
}

}  // namespace breve
