// From joints to articulated models: a spanning tree in the order of creation, the rest are constraints; and states
// from poses and velocities when a tree is built, poses and velocities from states ever after.
#include <algorithm>
#include <numeric>

#include "runtime/articulated/energy.hpp"
#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/impulse.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/core.hpp"
#include "runtime/dynamics/joint_frames.hpp"

namespace breve {

namespace {

/// One link to be: which body, through which joint, from which other link.
struct Planned {
  BodyIndex body;
  JointIndex joint;  // kNoJoint: a free root
  int parent;        // -1: the world
  bool flipped;      // the tree comes from the joint's child
};

/// Chooses the joints of the tree by joining sets in the order of creation (Kruskal), then walks them breadth first.
class Plan {
 public:
  Plan(const Dynamics::Core& core, std::span<const BodyIndex> bodies, std::pmr::memory_resource* memory)
      : core_(core),
        bodies_(bodies),
        indices_(memory),
        set_(bodies.size() + 1, memory),
        joints_(memory),
        links_(memory),
        loops_(memory) {
    std::iota(set_.begin(), set_.end(), std::size_t{0});
    gather();
    choose();
    walk();
  }

  std::span<const Planned> links() const { return links_; }
  std::span<const JointIndex> loops() const { return loops_; }

 private:
  struct Candidate {
    JointIndex joint;
    std::size_t parent, child;  // places in bodies_; its size: the world
    bool in_tree = false, walked = false;
  };

  std::size_t world() const { return bodies_.size(); }

  std::size_t index_of(BodyIndex body) const {
    if (body == kNoBody || !core_.bodies->dynamic(body)) return world();
    return std::lower_bound(indices_.begin(), indices_.end(), std::pair{body, std::size_t{0}})->second;
  }

  void gather() {
    for (std::size_t i = 0; i < bodies_.size(); ++i) indices_.emplace_back(bodies_[i], i);
    std::sort(indices_.begin(), indices_.end());
    for (const BodyIndex body : bodies_) {
      for (const JointIndex index : core_.find(body)->joints) {
        const JointDescription& is = core_.joints[index].is;
        const Candidate found{index, index_of(is.parent), index_of(is.child)};
        // Each is met at both its ends; the child's counts, or the parent's if the child does not move by itself.
        if (is.child == body || found.child == world()) joints_.push_back(found);
      }
    }
    std::sort(joints_.begin(), joints_.end(), [this](const Candidate& x, const Candidate& y) {
      return core_.joints[x.joint].serial < core_.joints[y.joint].serial;
    });
  }

  std::size_t set_of(std::size_t i) {
    while (set_[i] != i) i = set_[i] = set_[set_[i]];
    return i;
  }

  void choose() {
    for (Candidate& one : joints_) {
      const std::size_t a = set_of(one.parent), b = set_of(one.child);
      if (a == b) {
        loops_.push_back(one.joint);
      } else {
        set_[a] = b;
        one.in_tree = true;
      }
    }
  }

  /// Where a tree that the world does not hold begins: with the first that is nobody's child.
  std::size_t free_root() const {
    if (joints_.empty()) return 0;
    for (const Candidate& one : joints_) {
      const bool is_child = std::any_of(joints_.begin(), joints_.end(), [&](const Candidate& other) {
        return other.in_tree && other.child == one.parent;
      });
      if (one.in_tree && !is_child) return one.parent;
    }
    return joints_.front().parent;
  }

  void walk() {
    // The joints of each place, in the order of creation.
    std::pmr::vector<std::pmr::vector<std::size_t>> at(bodies_.size() + 1, set_.get_allocator());
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      if (!joints_[i].in_tree) continue;
      at[joints_[i].parent].push_back(i);
      at[joints_[i].child].push_back(i);
    }
    const auto go = [&](std::size_t from, int link) {
      for (const std::size_t i : at[from]) {
        Candidate& one = joints_[i];
        if (one.walked) continue;
        one.walked = true;
        const bool flipped = one.child == from;
        const std::size_t to = flipped ? one.parent : one.child;
        links_.push_back({bodies_[to], one.joint, link, flipped});
      }
    };
    go(world(), -1);
    if (links_.empty()) links_.push_back({bodies_[free_root()], kNoJoint, -1, false});
    for (std::size_t i = 0; i < links_.size(); ++i) {
      go(index_of(links_[i].body), static_cast<int>(i));
    }
  }

  const Dynamics::Core& core_;
  std::span<const BodyIndex> bodies_;
  std::pmr::vector<std::pair<BodyIndex, std::size_t>> indices_;  // sorted
  std::pmr::vector<std::size_t> set_;
  std::pmr::vector<Candidate> joints_;
  std::pmr::vector<Planned> links_;
  std::pmr::vector<JointIndex> loops_;
};

}  // namespace

bool Dynamics::Core::needs_tree(BodyIndex body) const {
  const BodyEntry* known = find(body);
  return known && bodies->dynamic(body) && (!known->joints.empty() || known->springs > 0 || known->force_method);
}

void Dynamics::Core::build_trees() {
  graph_changed = false;
  try {
    for (BodyIndex body = 0; body < entry_of.size(); ++body) build_tree_of(body);
    order_trees();
  } catch (...) {
    graph_changed = true;  // what memory cut short is made anew
    throw;
  }
}

/// The tree that the body belongs to, if it is one of those that are to be built.
void Dynamics::Core::build_tree_of(BodyIndex body) {
  if (!needs_tree(body) || find(body)->tree != kNone) return;
  std::pmr::vector<BodyIndex> component(memory);
  collect(body, component);
  build_tree(component);
}

void Dynamics::Core::order_trees() {
  clusters_changed = true;
  ++rules;
  tree_order.clear();
  for (std::uint32_t i = 0; i < trees.size(); ++i)
    if (trees[i]) tree_order.push_back(i);
  // By the lowest index of a body: the same whether trees were built now or long ago.
  std::sort(tree_order.begin(), tree_order.end(),
            [this](std::uint32_t x, std::uint32_t y) { return trees[x]->first_body() < trees[y]->first_body(); });
}

void Dynamics::Core::drop_tree(std::uint32_t index) {
  Tree& tree = *trees[index];
  if (!loading) ledger.script_work += unbook(tree, booked);
  for (const TreeLink& link : tree.links) {
    if (link.joint != kNoJoint && joints[link.joint].used) {
      JointEntry& joint = joints[link.joint];
      if (!loading) joint.position = read_position(joint);
      joint.tree = kNone;
      joint.link = -1;
    }
    if (BodyEntry* known = find(link.body)) known->tree = kNone;
  }
  for (const JointIndex loop : tree.loops) joints[loop].tree = kNone;
  trees[index].reset();
  std::erase(tree_order, index);
  clusters.clear();
  graph_changed = clusters_changed = true;
  ++rules;
}

/// Its bodies have by the books what they have alone; what their joints' springs held is gone, by whoever freed them.
/// @return the work of that, J
double Dynamics::Core::unbook(Tree& tree, std::span<double> books) const {
  if (!in_books(tree.booked)) return 0;
  articulated::forward_kinematics(tree.model, tree.data, tree.state);
  double sum = 0;
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const BodyIndex body = tree.links[i].body;
    if (bodies->dynamic(body)) {
      sum += books[body] = free_energy(body).total();
      continue;
    }
    // A body that does not move by forces any more leaves with what it had in the tree, whatever it was given since.
    const auto link = static_cast<int>(i);
    books[body] = kNoBook;
    sum += articulated::kinetic_energy_of_link(tree.model, tree.data, link) -
           tree.model.body(link).mass * settings.gravity.dot(articulated::com_position(tree.model, tree.data, link));
  }
  return sum - tree.booked;
}

/// What bodies that joints are about to connect have by the books; kNoBook if the books know none of them. Those that
/// they do not know come with what they have.
double Dynamics::Core::book_together(std::span<const BodyIndex> component) {
  // Room for all: unbook() takes none.
  if (booked.size() < bodies->index_end()) booked.resize(bodies->index_end(), kNoBook);
  double sum = 0;
  bool known = false;
  for (const BodyIndex body : component) {
    const bool has = in_books(book_of(body));
    known = known || has;
    sum += has ? booked[body] : free_energy(body).total();
    if (has) booked[body] = kNoBook;
  }
  return known ? sum : kNoBook;
}

namespace {

/// The links of a plan: for the solver of trees into `description`, for dynamics into `links`; `anchors` are the bodies
/// without a tree that joints of the world's side hold on to.
void describe_links(const Dynamics::Core& core, std::span<const Planned> plan,
                    std::vector<articulated::Link>& description, std::pmr::vector<TreeLink>& links,
                    std::pmr::vector<TreeAnchor>& anchors) {
  for (const Planned& planned : plan) {
    TreeLink link;
    link.body = planned.body;
    link.joint = planned.joint;
    link.solid = core.bodies->mass_properties(planned.body);
    link.switches = core.bodies->physics_switches(planned.body);
    articulated::Link made;
    made.parent = planned.parent;
    made.mass = link.solid.mass;
    made.inertia = link.solid.inertia;
    if (planned.joint == kNoJoint) {
      made.type = articulated::JointType::Free;
      link.origin = link.solid.center_of_mass;
    } else {
      const JointDescription& is = core.joints[planned.joint].is;
      const BodyIndex from = planned.flipped ? is.child : is.parent;
      const Vector3& point = planned.flipped ? is.child_point : is.parent_point;
      link.origin = planned.flipped ? is.parent_point : is.child_point;
      Quaternion outer = Quaternion::Identity();
      if (planned.parent >= 0) {
        made.position = point - links[static_cast<std::size_t>(planned.parent)].origin;
      } else {
        const Pose held = from == kNoBody ? Pose{} : core.pose(from);
        if (from != kNoBody) anchors.push_back({from, held});
        made.position = held.location + held.orientation * point;
        outer = held.orientation;
      }
      describe_joint(is, planned.flipped, outer, made);
    }
    made.com = link.solid.center_of_mass - link.origin;
    description.push_back(made);
    links.push_back(link);
  }
}

void find_light(std::span<const Planned> plan, std::span<TreeLink> links, std::pmr::memory_resource* memory) {
  constexpr double kFar = 10;                 // times as heavy
  std::pmr::vector<double> lightest(memory);  // kg, between the root and the link
  for (std::size_t i = 0; i < links.size(); ++i) {
    const double mass = links[i].solid.mass;
    lightest.push_back(mass);
    if (plan[i].parent < 0) continue;
    const auto parent = static_cast<std::size_t>(plan[i].parent);
    links[i].behind_light = links[parent].behind_light || mass > kFar * lightest[parent];
    lightest[i] = std::min(mass, lightest[parent]);
  }
}

/// The tree of a plan, in no table yet.
std::unique_ptr<Tree> make_tree(const Dynamics::Core& core, const Plan& plan) {
  std::pmr::memory_resource* memory = core.memory;
  std::vector<articulated::Link> description;
  std::pmr::vector<TreeLink> links(memory);
  std::pmr::vector<TreeAnchor> anchors(memory);
  describe_links(core, plan.links(), description, links, anchors);
  find_light(plan.links(), links, memory);
  std::unique_ptr<Tree> tree = make_in<Tree>(memory, memory, description);
  tree->links = links;
  tree->anchors = anchors;
  tree->anchored = plan.links().front().joint != kNoJoint;
  tree->loops.assign(plan.loops().begin(), plan.loops().end());
  for (const JointIndex loop : tree->loops)
    for (const BodyIndex end : {core.joints[loop].is.parent, core.joints[loop].is.child})
      if (end != kNoBody && !core.bodies->dynamic(end)) tree->loop_holders.push_back(end);
  tree->reserve_rows();
  const auto within = [&links](BodyIndex body) {
    return std::any_of(links.begin(), links.end(), [body](const TreeLink& link) { return link.body == body; });
  };
  tree->loose = !tree->anchored && std::all_of(tree->loops.begin(), tree->loops.end(), [&](JointIndex loop) {
    return within(core.joints[loop].is.parent) && within(core.joints[loop].is.child);
  });
  return tree;
}

/// A place among the trees, which bodies and joints of `tree` then name.
std::uint32_t enter_tree(Dynamics::Core& core, const Tree& tree, std::span<const Planned> plan) {
  std::uint32_t index = 0;
  while (index < core.trees.size() && core.trees[index]) ++index;
  if (index == core.trees.size()) core.trees.emplace_back();
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    BodyEntry& known = *core.find(tree.links[i].body);
    known.tree = index;
    known.link = static_cast<int>(i);
    if (tree.links[i].joint == kNoJoint) continue;
    JointEntry& joint = core.joints[tree.links[i].joint];
    joint.tree = index;
    joint.link = static_cast<int>(i);
    joint.flipped = plan[i].flipped;
    joint.loop = false;
  }
  for (const JointIndex loop : tree.loops) {
    core.joints[loop].tree = index;
    core.joints[loop].link = -1;
    core.joints[loop].loop = true;
  }
  return index;
}

}  // namespace

void Dynamics::Core::build_tree(std::span<const BodyIndex> component) {
  const double by_the_books = loading ? kNoBook : book_together(component);
  // A link that was moved or pushed since it was joined takes the assembly along, which therefore is built as it was.
  std::pmr::vector<Change> since(memory);
  if (!loading)
    for (const BodyIndex body : component) {
      const BodyEntry& known = *find(body);
      if (known.known && note_change(body, since))
        bodies->set_motion(body, known.location, known.orientation, known.velocity, known.spin);
    }
  const Plan plan(*this, component, memory);
  std::unique_ptr<Tree> tree = make_tree(*this, plan);
  const std::uint32_t index = enter_tree(*this, *tree, plan.links());
  read_state(*tree);
  tree->booked = by_the_books;
  trees[index] = std::move(tree);
  if (loading) return;
  try {
    project_velocities(*trees[index]);
    place_links(*trees[index]);
    apply_changes(since);
  } catch (...) {
    drop_tree(index);  // half made, it would be taken for whole
    throw;
  }
  ++counters.rebuilt;
}

void Dynamics::Core::read_state(Tree& tree) const {
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const TreeLink& link = tree.links[i];
    double* q = tree.state.q.data() + tree.model.body(static_cast<int>(i)).q;
    if (link.joint == kNoJoint) {
      const Pose at = pose(link.body);
      Eigen::Map<Vector3>{q} = at.location + at.orientation * link.origin;
      q[3] = at.orientation.w(), q[4] = at.orientation.x(), q[5] = at.orientation.y(), q[6] = at.orientation.z();
      continue;
    }
    const JointEntry& joint = joints[link.joint];
    const auto [rotation, shift] = between(joint.is);
    read_joint(joint.is, joint.flipped, rotation, shift, joint.position, q);
    // A position that was kept exactly is used again exactly, if only poses were written since.
    constexpr double kSame = 1e-11;  // rad or m
    if (joint.is.kind != JointKind::Ball &&
        (joint_position(joint.is, joint.flipped, q) - joint.position).norm() < kSame)
      put_joint_position(joint.is, joint.flipped, joint.position, q);
  }
}

std::pair<Quaternion, Vector3> Dynamics::Core::between(const JointDescription& is) const {
  const Pose parent = is.parent == kNoBody ? Pose{} : pose(is.parent);
  const Pose child = pose(is.child);
  const Quaternion back = parent.orientation.conjugate();
  const Vector3 shift =
      back * (child.location + child.orientation * is.child_point - parent.location) - is.parent_point;
  return {back * child.orientation, shift};
}

void Dynamics::Core::project_velocities(Tree& tree) {
  // The velocities that the joints allow and that have the links' momenta: as if the joints had been closed by a
  // plastic impact. Velocities that fit the joints come out as they were.
  tree.state.v.setZero();
  articulated::Loads none;
  articulated::factorize(tree.model, tree.data, tree.state, none);
  articulated::forward_kinematics(tree.model, tree.data, tree.state);
  std::pmr::vector<articulated::Impulse> impulses(memory);
  for (int i = 0; i < tree.model.size(); ++i) {
    const TreeLink& link = tree.links[static_cast<std::size_t>(i)];
    const Pose at = pose(link.body);
    const Vector3 spin = bodies->rotational_velocity(link.body);
    const Vector3 center = bodies->velocity(link.body) + spin.cross(at.orientation * link.solid.center_of_mass);
    articulated::Impulse impulse{i, articulated::com_position(tree.model, tree.data, i), link.solid.mass * center};
    impulse.angular = at.orientation * (link.solid.inertia * (at.orientation.conjugate() * spin));
    impulses.push_back(impulse);
  }
  articulated::impulse_response(tree.model, tree.data, impulses, tree.state.v);
  measure_motors(tree);
}

void Dynamics::Core::place_links(Tree& tree) {
  articulated::forward_kinematics(tree.model, tree.data, tree.state);
  write_back(tree);
  tree.changed = tree.set_apart = true;
  tree.set_open = JointDrive::kNoLimit;
}

void Dynamics::Core::write_back(Tree& tree) {
  for (int i = 0; i < tree.model.size(); ++i) {
    const BodyIndex body = tree.links[static_cast<std::size_t>(i)].body;
    const Pose at = tree.pose(i);
    bodies->set_motion(body, at.location, at.orientation, tree.velocity(i), tree.data.of(i).spin);
    note_written(body);
  }
}

JointVector Dynamics::Core::read_position(const JointEntry& joint) const {
  if (joint.tree == kNone || joint.link < 0) {
    const auto [rotation, shift] = between(joint.is);
    return joint_position_between(joint.is, rotation, shift, joint.position);
  }
  const Tree& tree = *trees[joint.tree];
  return joint_position(joint.is, joint.flipped, tree.state.q.data() + tree.model.body(joint.link).q);
}

JointVector Dynamics::Core::read_velocity(const JointEntry& joint) const {
  if (joint.tree != kNone && joint.link >= 0) {
    const Tree& tree = *trees[joint.tree];
    const articulated::Body& body = tree.model.body(joint.link);
    return joint_velocity(joint.is, joint.flipped, tree.state.q.data() + body.q, tree.state.v.data() + body.v);
  }
  // From the bodies: the relative spin or velocity along the axes.
  const JointDescription& is = joint.is;
  const auto spin_of = [&](BodyIndex body) {
    return body == kNoBody ? Vector3(Vector3::Zero()) : bodies->rotational_velocity(body);
  };
  const auto point_velocity = [&](BodyIndex body, const Vector3& point) -> Vector3 {
    if (body == kNoBody) return Vector3::Zero();
    return bodies->velocity(body) + spin_of(body).cross(bodies->orientation(body) * point);
  };
  const Quaternion frame = is.parent == kNoBody ? Quaternion::Identity() : bodies->orientation(is.parent);
  const Vector3 spin = frame.conjugate() * (spin_of(is.child) - spin_of(is.parent));
  if (is.kind == JointKind::Fixed) return JointVector::Zero();
  const JointAxes axes = axes_of(is);
  if (is.kind == JointKind::Prismatic) {
    const Vector3 rate =
        frame.conjugate() * (point_velocity(is.child, is.child_point) - point_velocity(is.parent, is.parent_point));
    return {-axes.first.dot(rate), 0, 0};
  }
  JointVector rate = JointVector::Zero();
  const Vector3* all[] = {&axes.first, &axes.second, &axes.third};
  for (int i = 0; i < axis_count(is.kind); ++i) rate[i] = -all[i]->dot(spin);
  return rate;
}

}  // namespace breve
