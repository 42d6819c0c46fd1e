// Bodies that joints connect, as a whole: who belongs, where it stands, what holds for it.
#include <fmt/format.h>

#include <algorithm>

#include "runtime/base/error.hpp"
#include "runtime/dynamics/core.hpp"
#include "runtime/dynamics/joint_frames.hpp"

namespace breve {

bool Dynamics::jointed(BodyIndex a, BodyIndex b) const { return core_ && core_->jointed(a, b); }

bool Dynamics::Core::jointed(BodyIndex a, BodyIndex b) const {
  const BodyEntry* known = find(a);
  if (!known) return false;
  return std::any_of(known->joints.begin(), known->joints.end(), [&](JointIndex index) {
    const JointDescription& is = joints[index].is;
    return (is.parent == a && is.child == b) || (is.parent == b && is.child == a);
  });
}

bool Dynamics::same_assembly(BodyIndex a, BodyIndex b) const {
  if (a == b) return true;
  if (!core_) return false;
  const BodyEntry* first = core_->find(a);
  const BodyEntry* second = core_->find(b);
  if (!first || !second) return false;
  if (first->tree != kNone && second->tree != kNone) return first->tree == second->tree;
  core_->collect(a, core_->scratch);
  return std::find(core_->scratch.begin(), core_->scratch.end(), b) != core_->scratch.end();
}

std::pmr::vector<BodyIndex> Dynamics::links_of(BodyIndex body) const {
  std::pmr::vector<BodyIndex> all(memory_);
  if (core_)
    core_->collect(body, all);
  else
    all.push_back(body);
  std::sort(all.begin(), all.end());
  return all;
}

std::pmr::vector<JointIndex> Dynamics::joints_of(BodyIndex body) const {
  std::pmr::vector<JointIndex> all(memory_);
  if (!core_) return all;
  for (const BodyIndex link : links_of(body)) {
    if (const BodyEntry* known = core_->find(link)) all.insert(all.end(), known->joints.begin(), known->joints.end());
  }
  sort_joints(core_->joints, all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void Dynamics::move_assembly(BodyIndex body, const Vector3& location, const Quaternion& orientation) {
  const double norm = orientation.norm();
  if (!location.allFinite()) throw Error(ErrorCode::Argument, "location must be finite");
  if (!std::isfinite(norm) || !(norm > 0))
    throw Error(ErrorCode::Argument, "orientation must be a finite quaternion of non-zero length");
  if (!core_ || !core_->find(body)) {
    bodies_->set_location(body, location);
    bodies_->set_orientation(body, orientation);
    return;
  }
  Core& c = *core_;
  c.take_changes();
  const BodyEntry& known = *c.find(body);
  if (known.tree == kNone) {
    bodies_->set_location(body, location);
    bodies_->set_orientation(body, orientation);
    return;
  }
  c.move_tree(*c.trees[known.tree], {known.location, known.orientation}, {location, orientation.normalized()});
  c.take_changes();
}

void Dynamics::set_assembly_velocity(BodyIndex body, const Vector3& velocity, const Vector3& spin) {
  check_motion(velocity, spin);
  if (core_) core_->take_changes();
  const BodyEntry* known = core_ ? core_->find(body) : nullptr;
  if (!known || known->tree == kNone) {
    bodies_->set_velocity(body, velocity);
    bodies_->set_rotational_velocity(body, spin);
    return;
  }
  Core& c = *core_;
  Tree& tree = *c.trees[known->tree];
  const Vector3 center = bodies_->location(body);
  for (const TreeLink& link : tree.links) {
    const Pose at = c.pose(link.body);
    bodies_->set_motion(link.body, at.location, at.orientation, velocity + spin.cross(at.location - center), spin);
  }
  c.project_velocities(tree);
  c.place_links(tree);
}

void Dynamics::moved(BodyIndex body) {
  const BodyEntry* known = core_ ? core_->find(body) : nullptr;
  if (known && !known->joints.empty()) core_->take_changes();
}

std::size_t Dynamics::self_penetrations(BodyIndex body) const {
  if (!self_collisions(body)) return 0;
  core_->take_changes();
  const std::pmr::vector<BodyIndex> links = links_of(body);
  std::size_t count = 0;
  for (std::size_t i = 0; i < links.size(); ++i)
    for (std::size_t k = i + 1; k < links.size(); ++k) {
      const BodyIndex a = links[i], b = links[k];
      const Shape &x = *bodies_->collision_shape(a), &y = *bodies_->collision_shape(b);
      const double reach = x.bounding_radius() + y.bounding_radius();
      if ((bodies_->location(a) - bodies_->location(b)).norm() > reach || jointed(a, b)) continue;
      const Pose pa = core_->pose(a), pb = core_->pose(b);
      // Feet that stand on one another touch, and do not intersect.
      const double tolerance = touch_tolerance(x, pa, y, pb);
      Contact contact;
      count += closest_within(x, pa, y, pb, -tolerance, contact) && contact.distance < -tolerance;
    }
  return count;
}

// --- settings of an assembly ----------------------------------------------------------------------------------------

const AssemblySettings* Dynamics::Core::settings_of(BodyIndex body, bool (*wanted)(const AssemblySettings&)) {
  if (own.empty()) return nullptr;
  const auto mine = [&](BodyIndex one) -> const AssemblySettings* {
    const auto found = own.find(one);
    return found != own.end() && wanted(found->second) ? &found->second : nullptr;
  };
  const BodyEntry* known = find(body);
  if (!known) return mine(body);
  if (known->tree != kNone) {
    const AssemblySettings* best = nullptr;
    BodyIndex lowest = kNoBody;
    for (const TreeLink& link : trees[known->tree]->links) {
      if (link.body > lowest) continue;
      if (const AssemblySettings* found = mine(link.body)) {
        best = found;
        lowest = link.body;
      }
    }
    return best;
  }
  std::pmr::vector<BodyIndex> all(memory);
  collect(body, all);
  std::sort(all.begin(), all.end());
  for (const BodyIndex one : all)
    if (const AssemblySettings* found = mine(one)) return found;
  return nullptr;
}

const AssemblySettings* Dynamics::settings_of(BodyIndex body, bool (*wanted)(const AssemblySettings&)) const {
  return core_ ? core_->settings_of(body, wanted) : nullptr;
}

void Dynamics::settings_begin(BodyIndex body) { core_->entry(body); }

void Dynamics::set_self_collision_parameters(BodyIndex body, double erp, double cfm) {
  check_softness_within(erp, cfm);
  Core& c = core();
  c.entry(body);
  c.own[body].self_erp = erp;
  c.own[body].self_cfm = cfm;
}

const Accuracy& Dynamics::Core::accuracy_of(BodyIndex body) {
  const AssemblySettings* found = settings_of(body, [](const AssemblySettings& s) { return s.has_accuracy; });
  return found ? found->accuracy : settings.accuracy;
}

}  // namespace breve
