// Where energy is and where it went. What is in motion, height and springs is summed when somebody asks; works and
// losses are written down by those who do them. What is left is the residual. Nothing repairs it.
#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/motion.hpp"

namespace breve {

Energy Dynamics::Core::energy_of(Tree& tree) const {
  Energy now = tree.account;
  articulated::forward_kinematics(tree.model, tree.data, tree.state);
  now.kinetic = articulated::kinetic_energy(tree.model, tree.data);
  now.potential = articulated::potential_energy(tree.model, tree.data, settings.gravity);
  now.springs = joint_springs(tree);
  return now;
}

double Dynamics::Core::joint_springs(Tree& tree) const {
  // From the joints' own numbers: what the loads hold is of the last step.
  double energy = 0;
  for (const TreeLink& link : tree.links) {
    if (link.joint == kNoJoint) continue;
    const JointEntry& joint = joints[link.joint];
    if (!(joint.drive.stiffness > 0)) continue;
    energy += 0.5 * joint.drive.stiffness * (read_position(joint) - joint.drive.rest).squaredNorm();
  }
  return energy;
}

double Dynamics::Core::tie_energy(const SpringDescription& is) const {
  const Pose a = pose(is.a), b = pose(is.b);
  const Vector3 way = b.location + b.orientation * is.point_b - a.location - a.orientation * is.point_a;
  return pull_of(is, way, Vector3::Zero()).energy;
}

double Dynamics::Core::tie_energy_in(const SpringDescription& is) const {
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
  for (const SpringEntry& tie : springs)
    if (tie.used) sum.springs += tie_energy(tie.is);
  near.each([&sum](const PairKey&, const NearPair& pair) { sum.springs += pair.stored; });
}

Energy Dynamics::energy() const {
  if (!core_) return {};
  core_->take_changes();
  Energy sum = core_->account;
  core_->add_stored(sum);
  return sum;
}

Energy Dynamics::energy(BodyIndex body) const {
  if (!core_) return {};
  core_->take_changes();
  const BodyEntry* known = core_->find(body);
  if (known && known->tree != kNone) return core_->energy_of(*core_->trees[known->tree]);
  return core_->bodies->dynamic(body) ? core_->free_energy(body) : Energy{};
}

bool Dynamics::asleep(BodyIndex body) const {
  const NearPairs::Rest* rest = core_ ? core_->near.find_rest(body) : nullptr;
  return rest && rest->asleep;
}

}  // namespace breve
