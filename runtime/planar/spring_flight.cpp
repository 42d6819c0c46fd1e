// Which bodies fly while springs pull at them, by which rule each spring acts, and what else pulls.
#include <algorithm>

#include "runtime/planar/spring_rows.hpp"

namespace breve {

int SpringRows::root_of(int i) {
  while (node(i).root != i) i = node(i).root = node(node(i).root).root;
  return i;
}

void SpringRows::connect(int a, int b) {
  if (a < 0 || b < 0) return;
  a = root_of(a);
  b = root_of(b);
  node(std::max(a, b)).root = std::min(a, b);
}

/// How fast all that acts at a body makes it answer. With these sums at both ends of each spring a step is stable
/// whatever is connected: they bound the greatest eigenvalue of M^-1 K.
void SpringRows::sum_paces() {
  for (Row& row : rows_) {
    if (row.spring) evaluate_spring(row, 0);
    for (const End& end : row.ends) {
      if (end.node < 0) continue;
      const double moves = mobility(end);
      node(end.node).damped += dt_ * row.damping * moves;
      node(end.node).pace += dt_ * (row.damping + dt_ * row.strength) * moves;
    }
  }
}

/// Nothing touches these, and no motor or limit acts in their joints. Half of their acceleration may then come after
/// they were moved.
bool SpringRows::may_fly(std::span<const BodyIndex> all) const {
  constexpr std::size_t kMostJoints = 32;  // how they answer takes time that grows as the cube of it
  std::size_t count = 0;
  for (const BodyIndex body : all) {
    const FlatBody* flat = core_.find(body);
    if (!flat || flat->fixed || flat->touching > 0) return false;
    const auto found = core_.joints_at.find(body);
    if (found == core_.joints_at.end()) continue;
    for (const JointIndex index : found->second) {
      const FlatJoint& joint = core_.joints[index];
      const JointDrive& drive = joint.drive;
      if (!joint.b2 || drive.strength_limit > 0 || ++count > 2 * kMostJoints) return false;
      // One that is to bounce ahead has no limit until it is there.
      if (joint.is.kind == JointKind::Fixed || !has_limits(drive, joint.is.kind) || joint.loose) continue;
      if (!core_.keeps_within_limits(joint, 2 * dt_)) return false;
    }
  }
  return true;
}

void SpringRows::find_assembly(FlatBody& flat) {
  std::pmr::vector<BodyIndex> all(core_.memory);
  core_.collect(flat.body, all);
  const int first = node_of(&flat);
  if (!may_fly(all)) return;
  constexpr double kDamped = 1;
  for (const BodyIndex body : all)
    if (node(node_of(core_.find(body))).damped > kDamped) return;
  Assembly& made =
      assemblies_.emplace_back(Assembly{Response(core_, nullptr, &flat), std::pmr::vector<int>(core_.memory)});
  for (FlatBody* one : made.response.bodies()) {
    const int i = node_of(one);
    made.nodes.push_back(i);
    node(i).flies = true;
    node(i).held = &made.response;
    connect(first, i);
  }
}

/// The mean of a strong damper over a sub-step would reverse what it stops.
void SpringRows::choose_rules() {
  constexpr double kDamped = 1, kFollows = 0.5;
  for (std::size_t i = 0, count = nodes_.size(); i < count; ++i) {
    FlatBody& flat = *nodes_[i].flat;
    if (!flat.jointed)
      nodes_[i].flies = flat.touching == 0 && nodes_[i].damped <= kDamped;
    else if (!nodes_[i].held)
      find_assembly(flat);
  }
  for (Row& row : rows_) {
    bool flies = true;
    double pace = 0;
    for (const End& end : row.ends) {
      if (end.node < 0) continue;
      flies = flies && node(end.node).flies;
      pace += node(end.node).pace;
    }
    row.rule = flies ? Rule::Mean : pace < kFollows ? Rule::Now : Rule::End;
  }
}

/// What bodies rest on holds their weight, and joints may: springs at these are as if nothing else pulled.
void SpringRows::set_loads() {
  for (Node& one : nodes_) {
    const FlatBody& flat = *one.flat;
    if (!one.flies && (flat.jointed || flat.touching > 0)) continue;
    one.load << flat.mass.mass * core_.settings.gravity.head<2>() + flat.force + flat.asked, flat.torque;
  }
  for (Row& row : rows_) {
    if (row.rule == Rule::Now) evaluate_now(row);
    const double set = row.joint ? row.joint->drive.force[0] : 0, force = row.rule == Rule::Now ? row.force : 0;
    for (const End& end : row.ends)
      if (end.node >= 0) node(end.node).load += (set - force) * end.along;
  }
}

}  // namespace breve
