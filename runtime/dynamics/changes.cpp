// What scripts and hosts set in the arrays between two steps, brought into the trees: a link that was moved takes its
// assembly along, a link whose velocity was set is struck.
#include <Eigen/QR>
#include <algorithm>

#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/stale.hpp"

namespace breve {

bool is_stale(const Dynamics::Core& core, const TreeLink& link) {
  const Bodies& bodies = *core.bodies;
  return !bodies.dynamic(link.body) || bodies.physics_switches(link.body) != link.switches ||
         !(bodies.mass_properties(link.body) == link.solid);
}

bool has_changed_holder(const Dynamics::Core& core, const Tree& tree) {
  const Bodies& bodies = *core.bodies;
  const auto changed = [&bodies](const TreeAnchor& anchor) {
    return !bodies.used(anchor.body) || bodies.dynamic(anchor.body) ||
           bodies.location(anchor.body) != anchor.pose.location ||
           bodies.orientation(anchor.body).coeffs() != anchor.pose.orientation.coeffs();
  };
  const auto freed = [&bodies](BodyIndex body) { return bodies.dynamic(body); };
  return std::any_of(tree.anchors.begin(), tree.anchors.end(), changed) ||
         std::any_of(tree.loop_holders.begin(), tree.loop_holders.end(), freed);
}

bool is_stale(const Dynamics::Core& core, const Tree& tree) {
  return has_changed_holder(core, tree) || std::any_of(tree.links.begin(), tree.links.end(),
                                                       [&core](const TreeLink& link) { return is_stale(core, link); });
}

void Dynamics::Core::note_written(BodyIndex body) {
  BodyEntry& known = *find(body);
  known.known = true;
  known.location = bodies->location(body);
  known.orientation = bodies->orientation(body);
  known.velocity = bodies->velocity(body);
  known.spin = bodies->rotational_velocity(body);
}

bool Dynamics::Core::note_change(BodyIndex body, std::pmr::vector<Change>& out) const {
  const BodyEntry& known = *find(body);
  Change change;
  change.body = body;
  change.pose = pose(body);
  change.velocity = bodies->velocity(body);
  change.spin = bodies->rotational_velocity(body);
  change.pushed = change.velocity != known.velocity;
  change.spun = change.spin != known.spin;
  change.moved =
      change.pose.location != known.location || change.pose.orientation.coeffs() != known.orientation.coeffs();
  if (!change.moved && !change.pushed && !change.spun) return false;
  out.push_back(change);
  return true;
}

void Dynamics::Core::sync_changes() {
  changed.clear();
  bodies->take_touched(changed);
  try {
    follow_changes();
  } catch (...) {
    bodies->touch(changed);  // there is no more memory: the next step finds them again
    throw;
  }
}

void Dynamics::Core::follow_changes() {
  // By index: the order in which a script set them must not matter to which trees are built first.
  std::sort(changed.begin(), changed.end());
  changes.clear();
  // Trees that are to be built anew go first: an image holds none of them, and what follows must not know the
  // difference.
  for (const BodyIndex body : changed) near.wake(body);
  drop_stale_trees();
  for (const BodyIndex body : changed) {
    const BodyEntry* known = find(body);
    if (known && known->tree != kNone) continue;
    unsettled.push_back(body);
    if (!bodies->dynamic(body) && body < booked.size()) booked[body] = kNoBook;
  }
  bool late = false;  // a link whose tree is not built yet was moved
  for (const BodyIndex body : changed) {
    const BodyEntry* known = find(body);
    if (!known || (known->tree == kNone && !needs_tree(body))) continue;
    if (known->tree != kNone) {
      note_change(body, changes);
      continue;
    }
    graph_changed = true;
    late = late || (known->known && note_change(body, changes));
  }
  if (late) build_trees();
  apply_changes(changes);
}

/// In their order, in which an image adds up what becomes of their books.
void Dynamics::Core::drop_stale_trees() {
  std::pmr::vector<std::uint32_t> stale(memory);
  for (const BodyIndex body : changed) {
    const BodyEntry* known = find(body);
    if (known && known->tree != kNone &&
        is_stale(*this, trees[known->tree]->links[static_cast<std::size_t>(known->link)]))
      stale.push_back(known->tree);
  }
  for (const std::uint32_t index : tree_order)
    if (has_changed_holder(*this, *trees[index])) stale.push_back(index);
  if (stale.empty()) return;
  std::sort(stale.begin(), stale.end());
  const std::pmr::vector<std::uint32_t> all(tree_order, memory);
  for (const std::uint32_t index : all)
    if (std::binary_search(stale.begin(), stale.end(), index)) drop_tree(index);
}

void Dynamics::Core::apply_changes(std::span<const Change> all) {
  for (const Change& change : all) {
    const BodyEntry& known = *find(change.body);
    // A tree that was built meanwhile has its links elsewhere by round-off: nothing has moved them.
    if (known.tree == kNone || !change.moved) continue;
    // Another link's move brought this one here: it was not moved itself.
    if (known.location != change.pose.location || known.orientation.coeffs() != change.pose.orientation.coeffs())
      move_tree(*trees[known.tree], {known.location, known.orientation}, change.pose);
  }
  std::pmr::vector<std::uint32_t> done(memory);
  for (const Change& change : all) {
    const std::uint32_t index = find(change.body)->tree;
    if (index == kNone || std::find(done.begin(), done.end(), index) != done.end()) continue;
    done.push_back(index);
    strike(*trees[index], all);
  }
}

void Dynamics::Core::move_tree(Tree& tree, const Pose& from, const Pose& to) {
  const Quaternion rotation = (to.orientation * from.orientation.conjugate()).normalized();
  const articulated::Body& root = tree.model.body(0);
  if (!tree.anchored) {
    double* q = tree.state.q.data() + root.q;
    Eigen::Map<Vector3> position{q};
    position = Vector3(to.location + rotation * (Vector3(position) - from.location));
    const Quaternion rotated = (rotation * Quaternion(q[3], q[4], q[5], q[6])).normalized();
    q[3] = rotated.w(), q[4] = rotated.x(), q[5] = rotated.y(), q[6] = rotated.z();
    // The velocity of a free joint is in the world's axes, and is not rotated: as when a single body is rotated.
    place_links(tree);
    return;
  }
  // The anchors of its joints to the world move along; a tree that a body holds cannot go anywhere.
  if (tree.anchors.empty()) {
    for (const TreeLink& link : tree.links) {
      for (const JointIndex index : find(link.body)->joints) {
        JointDescription& is = joints[index].is;
        if (is.parent != kNoBody) continue;
        is.parent_point = to.location + rotation * (is.parent_point - from.location);
        is.relative_rotation = (rotation * is.relative_rotation).normalized();
        is.normal = rotation * is.normal;
        is.other_axis = rotation * is.other_axis;
      }
    }
    // All links stand where they are to be before it is built anew.
    const std::pmr::vector<TreeLink> links(tree.links, memory);
    for (const TreeLink& link : links) {
      const BodyEntry& known = *find(link.body);
      const Vector3 location = to.location + rotation * (known.location - from.location);
      bodies->set_motion(link.body, location, (rotation * known.orientation).normalized(), bodies->velocity(link.body),
                         bodies->rotational_velocity(link.body));
      note_written(link.body);
    }
    drop_tree(find(links.front().body)->tree);
    return;
  }
  place_links(tree);
}

void Dynamics::Core::strike(Tree& tree, std::span<const Change> all) {
  std::pmr::vector<const Change*> struck(memory);
  for (const Change& change : all) {
    const BodyEntry& known = *find(change.body);
    if (known.tree != kNone && trees[known.tree].get() == &tree && (change.pushed || change.spun))
      struck.push_back(&change);
  }
  if (struck.empty()) return;
  constexpr std::size_t kMostSolved = 8;
  if (struck.size() > kMostSolved) {
    // As if all had got these velocities before the joints were closed.
    for (const Change* change : struck) {
      const Pose at = pose(change->body);
      bodies->set_motion(change->body, at.location, at.orientation, change->velocity, change->spin);
    }
    project_velocities(tree);
  } else {
    solve_strike(tree, struck);
  }
  place_links(tree);
}

void Dynamics::Core::solve_strike(Tree& tree, std::span<const Change* const> struck) {
  articulated::Loads none;
  articulated::factorize(tree.model, tree.data, tree.state, none);
  articulated::forward_kinematics(tree.model, tree.data, tree.state);
  // A number for each component that was set: the velocity of a body's origin, its spin. Impulses act at centres of
  // mass; what was not set is free, and nothing pushes along it.
  struct Axis {
    int link, axis;
    bool angular;
    Vector3 center, origin;
  };
  std::pmr::vector<Axis> axes(memory);
  std::pmr::vector<double> wanted(memory);
  for (const Change* change : struck) {
    const int link = find(change->body)->link;
    const Vector3 center = articulated::com_position(tree.model, tree.data, link), origin = tree.pose(link).location;
    const Vector3 linear = change->velocity - tree.velocity(link), angular = change->spin - tree.data.of(link).spin;
    for (int i = 0; i < 6; ++i) {
      if (!(i < 3 ? change->pushed : change->spun)) continue;
      axes.push_back({link, i % 3, i >= 3, center, origin});
      wanted.push_back(i < 3 ? linear[i] : angular[i - 3]);
    }
  }
  const auto size = static_cast<Eigen::Index>(axes.size());
  Eigen::MatrixXd response(size, size), answers(tree.model.velocities(), size);
  articulated::Vector change(tree.model.velocities());
  for (Eigen::Index i = 0; i < size; ++i) {
    const Axis& axis = axes[static_cast<std::size_t>(i)];
    articulated::Impulse unit{axis.link, axis.center, Vector3::Zero()};
    (axis.angular ? unit.angular : unit.linear) = Vector3::Unit(axis.axis);
    articulated::impulse_response(tree.model, tree.data, {&unit, 1}, change);
    answers.col(i) = change;
    articulated::forward_kinematics(tree.model, tree.data, {tree.state.q, change});
    for (Eigen::Index j = 0; j < size; ++j) {
      const Axis& seen = axes[static_cast<std::size_t>(j)];
      const Vector3 motion = seen.angular ? Vector3(tree.data.of(seen.link).spin)
                                          : articulated::point_velocity(tree.data, seen.link, seen.origin);
      response(j, i) = motion[seen.axis];
    }
    articulated::forward_kinematics(tree.model, tree.data, tree.state);
  }
  // The joints may allow less than was asked: then as near as it can be.
  const Eigen::VectorXd impulses =
      response.completeOrthogonalDecomposition().solve(Eigen::Map<const Eigen::VectorXd>(wanted.data(), size));
  tree.state.v += answers * impulses;
}

}  // namespace breve
