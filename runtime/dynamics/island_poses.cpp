// Where the bodies of an island are and how fast they move.
#include <algorithm>

#include "runtime/articulated/forward_dynamics.hpp"
#include "runtime/articulated/kinematics.hpp"
#include "runtime/dynamics/island_state.hpp"

namespace breve::island {

double State::size_of_pair(const NearPair& pair) const {
  return std::min(shape(pair.a).bounding_radius(), shape(pair.b).bounding_radius());
}

/// What a push moves there, were the body free, 1/kg.
double State::natural_response(BodyIndex body) const {
  return core.slot_of[body].mover < 0 ? 0 : 1 / core.bodies->mass(body);
}

Pose State::pose_of(BodyIndex body) const {
  const BodySlot side = slot_of(body);
  if (side.mover < 0) return core.pose(body);
  if (side.tree) return side.tree->pose(side.link);
  const FreeBody& free = free_bodies[static_cast<std::size_t>(side.mover)].now;
  return {free.center - free.orientation * free.solid->center_of_mass, free.orientation};
}

/// In world axes, rad/s.
Vector3 State::spin_of(BodyIndex body) const {
  const BodySlot side = slot_of(body);
  if (side.mover < 0) return Vector3::Zero();
  return side.tree ? side.tree->data.of(side.link).spin : free_bodies[static_cast<std::size_t>(side.mover)].now.spin;
}

Vector3 State::point_velocity(BodyIndex body, const Vector3& point) const {
  const BodySlot side = slot_of(body);
  if (side.mover < 0) return Vector3::Zero();
  if (side.tree) return articulated::point_velocity(side.tree->data, side.link, point);
  const FreeBody& free = free_bodies[static_cast<std::size_t>(side.mover)].now;
  return free.velocity + free.spin.cross(point - free.center);
}

/// Where a tree has moved by semi-implicit Euler, springs and dampers give way to the rows of its h seconds as they did
/// to the forces in them: by how much they will be stretched, and how fast.
void State::place(double h) {
  const articulated::Loads none;
  for (const Clustered& one : clusters) {
    const bool implicit = h > 0 && one.semi && (accuracy.implicit_joints || one.fast_springs);
    for (Tree* tree : one.entry->system->trees()) {
      if (implicit)
        articulated::factorize(tree->model, tree->data, tree->state, tree->springs, h);
      else
        articulated::factorize(tree->model, tree->data, tree->state, none);
      articulated::forward_kinematics(tree->model, tree->data, tree->state);
    }
  }
}

void State::place_links() {
  for (Tree* tree : trees) articulated::forward_kinematics(tree->model, tree->data, tree->state);
}

void State::remember() {
  for (Free& one : free_bodies) {
    one.before = one.now;
    one.next_before = one.next;
  }
  for (Tree* tree : trees) {
    tree->sub_state = tree->state;
    tree->sub_ledger = tree->ledger;
  }
  for (Clustered& one : clusters) one.next_before = one.entry->system->next_step();
  sub_ledger_ = result.ledger;
}

void State::restore() {
  for (Free& one : free_bodies) {
    one.now = one.before;
    one.next = one.next_before;
  }
  for (Tree* tree : trees) {
    tree->state = tree->sub_state;
    tree->ledger = tree->sub_ledger;
  }
  for (Clustered& one : clusters) one.entry->system->set_next_step(one.next_before);
  result.ledger = sub_ledger_;  // without what the try booked where it put positions right
}

void Free::load_velocity() {
  for (int k = 0; k < 3; ++k) {
    v[k] = now.velocity[k];
    v[3 + k] = now.spin[k];
  }
}

void State::load_velocities() {
  for (Free& one : free_bodies) {
    one.load_velocity();
    std::copy_n(one.v, 6, one.free_v);
  }
  for (Tree* tree : trees) tree->free_v = tree->smooth_v = tree->state.v;
}

void State::store_velocities() {
  for (Free& one : free_bodies) {
    one.now.velocity = Vector3(one.v[0], one.v[1], one.v[2]);
    one.now.spin = Vector3(one.v[3], one.v[4], one.v[5]);
  }
}

void State::reset_velocities() {
  for (Free& one : free_bodies) std::copy_n(one.free_v, 6, one.v);
  for (Tree* tree : trees) tree->state.v = tree->free_v;
}

void State::add_force(BodyIndex body, const Vector3& point, const Vector3& force) {
  const BodySlot side = slot_of(body);
  if (!side.tree) return;
  articulated::Wrench& wrench = side.tree->links[static_cast<std::size_t>(side.link)].contact;
  wrench.force += force;
  wrench.couple += (point - articulated::com_position(side.tree->model, side.tree->data, side.link)).cross(force);
}

bool State::calls_out() const {
  return std::any_of(pairs.begin(), pairs.end(), [](const NearPair* pair) { return pair->handled; }) ||
         std::any_of(clusters.begin(), clusters.end(), [](const Clustered& one) { return one.entry->asked; });
}

namespace {

/// Whether some velocity of the tree is above `slow` rad/s or `slow` length units/s.
bool moves(const Tree& tree, double slow, double unit) {
  for (const articulated::Body& body : tree.model.bodies())
    for (int k = 0; k < articulated::velocity_count(body.type); ++k)
      if (std::abs(tree.state.v[body.v + k]) > slow * (articulated::is_length(body.type, k) ? unit : 1)) return true;
  return false;
}

}  // namespace

bool State::still() const {
  for (const Free& one : loose_bodies())
    if (one.now.velocity.norm() > kSlow * unit() || one.now.spin.norm() > kSlow) return false;
  for (Tree* tree : trees) {
    if (moves(*tree, kSlow, unit())) return false;
    // A motor that is to rotate does not rest, however slowly it does.
    const articulated::Vector& wanted = tree->loads.motor_speed;
    if (wanted.size() > 0 && (wanted.array() != 0).any()) return false;
  }
  return true;
}

bool State::has_loops() const {
  return std::any_of(trees.begin(), trees.end(), [](const Tree* tree) { return !tree->loops.empty(); });
}

std::uint64_t State::loop_units() const {
  std::uint64_t units = 0;
  for (const Tree* tree : trees)
    if (!tree->loops.empty()) units += tree->hold_units();
  return units;
}

/// Some joint has a spring or damper that a step may not follow: semi-implicit Euler holds it whatever its stiffness,
/// and takes energy from it.
bool State::stiff(const Clustered& one) const {
  for (const std::uint32_t index : one.entry->trees)
    for (const articulated::Drive& drive : core.trees[index]->loads.drives)
      if (drive.stiffness > 0 || drive.damping > 0) return true;
  return false;
}

bool State::has_contact_springs() const {
  return accuracy.contact_springs && accuracy.locate_impacts && networks.empty() &&
         (accuracy.link_springs || trees.empty());
}

bool State::springs_for(const contact::Law& law) const {
  return has_contact_springs() && law.restitution > 0 && law.restitution_threshold > 0;
}

BodyIndex State::any_body() const {
  return loose_bodies().empty() ? trees.front()->links.front().body : free_bodies.front().body;
}

void State::intervene(const Trouble& trouble, GuardAction action, double time) {
  result.interventions.push_back(
      {core.iteration, time, core.bodies->owner(trouble.body), trouble.reason, action, trouble.value});
}

}  // namespace breve::island
