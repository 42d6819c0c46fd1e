// What an island consists of, and how it is set up before a step.
#include "runtime/dynamics/island_state.hpp"

#include <algorithm>

#include "runtime/base/rotation_vector.hpp"
#include "runtime/dynamics/network_motion.hpp"
#include "runtime/dynamics/spring_network.hpp"

namespace breve::island {

State::State(Dynamics::Core& world, std::pmr::memory_resource* resource)
    : core(world),
      memory(resource),
      result(resource),
      free_bodies(resource),
      trees(resource),
      networks(resource),
      clusters(resource),
      pairs(resource),
      pair_drivers(resource),
      momenta(resource) {}

void State::clear() {
  free_bodies.clear();
  drivers = 0;
  pair_drivers.clear();
  networks.clear();
  clusters.clear();
  trees.clear();
  pairs.clear();
  accuracy_set_ = false;
  result.counters = {};
  result.ledger = {};
  result.impacts.clear();
  result.interventions.clear();
}

/// The island takes the finest of the accuracies of its bodies.
void State::take_accuracy(const Accuracy& other) {
  if (!accuracy_set_ || finer(other.rung, accuracy.rung)) accuracy = other;
  accuracy_set_ = true;
}

void State::add_free(BodyIndex body) {
  core.slot_of[body].mover = static_cast<int>(free_bodies.size());
  Free one{};
  one.body = body;
  one.now = read_free(*core.bodies, body);
  if (const BodyEntry* known = core.find(body)) one.next = known->step;
  free_bodies.push_back(one);
  take_accuracy(core.accuracy_of(body));
}

namespace {

// The inverse of the mass of a body that a script moves: an impulse does not change its velocity visibly.
constexpr double kUnmoved = 1e-100;  // 1/kg
const MassProperties kDriver{1 / kUnmoved, Matrix3::Identity() / kUnmoved, Vector3::Zero(), true};

}  // namespace

/// One for each pair: what stands on it would else be connected through it, and dear to solve.
void State::add_drivers(const NearPair& pair) {
  pair_drivers.push_back(-1);
  for (const BodyIndex body : {pair.a, pair.b}) {
    if (core.bodies->dynamic(body) || !core.bodies->moving(body)) continue;
    pair_drivers.back() = static_cast<int>(free_bodies.size());
    Free one{};
    one.body = body;
    one.driver = true;
    one.now.solid = &kDriver;
    free_bodies.push_back(one);
    ++drivers;
  }
}

/// To where it was h seconds ago: the arrays have it at the end of its motion.
void State::put_driver(Free& one, double h) const {
  FreeBody& now = one.now;
  now.velocity = core.bodies->velocity(one.body);
  now.spin = core.bodies->spin(one.body);
  now.center = core.bodies->location(one.body) - h * now.velocity;
  now.orientation = (rotation_by(-h * now.spin) * core.bodies->orientation(one.body)).normalized();
}

double State::mass() const {
  double sum = 0;
  for (const Free& one : loose_bodies()) sum += one.now.solid->mass;
  for (const Tree* tree : trees)
    for (const TreeLink& link : tree->links) sum += link.solid.mass;
  return sum;
}

std::size_t State::bodies() const {
  std::size_t links = 0;
  for (const Tree* tree : trees) links += tree->links.size();
  return links + free_bodies.size();
}

void State::put_drivers(double h) {
  for (std::size_t i = free_bodies.size() - drivers; i < free_bodies.size(); ++i) put_driver(free_bodies[i], h);
}

void State::add_network(ClusterEntry& cluster, double h) {
  const Accuracy& own = cluster.system->accuracy();
  const bool coarse = own.rung == Rung::Fast || own.rung == Rung::Balanced;
  if (!cluster.points || !coarse || own.custom || own.contact_springs || !cluster.points->begin(core, own.rung, h))
    return;
  networks.push_back({&cluster, free_bodies.size()});
  for (const Tree* tree : cluster.points->trees()) add_free(tree->links.front().body);
  take_accuracy(own);
}

bool State::is_network(const ClusterEntry& cluster) const {
  return std::any_of(networks.begin(), networks.end(),
                     [&cluster](const NetworkCluster& one) { return one.entry == &cluster; });
}

std::size_t State::networks_begin() const { return networks.empty() ? free_bodies.size() : networks.front().first; }

std::size_t State::networks_end() const {
  return networks.empty() ? 0 : networks.back().first + networks.back().entry->points->trees().size();
}

/// Springs as scripts have set them. False if they are more than points can follow for h seconds.
bool State::begin_networks(double h) {
  return std::all_of(networks.begin(), networks.end(),
                     [&](const NetworkCluster& one) { return one.entry->points->begin(core, accuracy.rung, h); });
}

/// Those of clusters, as scripts have set them: their energy is asked before they move.
void State::read_springs() {
  for (const Clustered& one : clusters)
    if (one.entry->network) one.entry->network->begin(core);
}

/// What joints are set to, where it decides how long a sub-step may be before a step of h seconds begins.
void State::read_drives(double h) {
  for (const Clustered& one : clusters)
    if (one.entry->system->can_be_finer())
      for (const std::uint32_t index : one.entry->trees) core.set_loads(*core.trees[index], accuracy, h);
}

void State::add_cluster(ClusterEntry& cluster) {
  if (is_network(cluster)) return;
  clusters.push_back({&cluster, cluster.system->accuracy(), false, std::nullopt, 0, false, false, {}, 0, {}});
  for (const std::uint32_t index : cluster.trees) {
    Tree* tree = core.trees[index].get();
    tree->slot = static_cast<int>(trees.size());
    trees.push_back(tree);
    // What joints hold without a degree of freedom is like what does not move.
    const int mover = tree->model.velocities() > 0 ? static_cast<int>(free_bodies.size()) + tree->slot : -1;
    for (std::size_t i = 0; i < tree->links.size(); ++i)
      core.slot_of[tree->links[i].body] = {tree, mover, static_cast<int>(i)};
  }
  take_accuracy(cluster.system->accuracy());
}

/// Nothing but contacts and gravity acts on it from outside.
bool State::loose(const Clustered& one) const {
  if (one.entry->asked) return false;
  for (const std::uint32_t index : one.entry->trees) {
    const Tree& tree = *core.trees[index];
    if (!tree.loose || tree.pushed) return false;
  }
  for (const SpringIndex spring : one.entry->springs) {
    const SpringDescription& is = core.springs[spring].is;
    for (const BodyIndex body : {is.a, is.b}) {
      const BodyEntry* known = core.find(body);
      if (!known || known->tree == kNone) return false;
    }
  }
  return true;
}

/// What contacts gave in the last step does not act in this one: a script may have moved links away from them. Contact
/// springs may press on links of whatever is near: they act inside the stages.
void State::begin(MechanicsClient* client, double h) {
  const bool pressed = has_contact_springs() && !pairs.empty();
  for (Clustered& one : clusters) {
    for (const std::uint32_t index : one.entry->trees) {
      Tree& tree = *core.trees[index];
      core.set_loads(tree, one.accuracy_in(accuracy), h);
      for (TreeLink& link : tree.links) link.contact = {};
      tree.outer_force = tree.outer_couple = Vector3::Zero();
      tree.limit_force.setZero();
      tree.held.clear();
    }
    one.loose = loose(one);
    one.stage.emplace(core, *one.entry, client);
    one.entry->system->begin(one.stage->needed() || pressed ? &*one.stage : nullptr, meter);
  }
}

contact::SolveSettings State::solve_settings() {
  contact::SolveSettings settings;
  settings.iterations = accuracy.iterations;
  settings.tolerance *= unit();
  settings.meter = &meter;
  return settings;
}

void State::use_accuracy(const Accuracy& other) {
  accuracy = other;
  for (Clustered& one : clusters) one.entry->system->set_accuracy(one.accuracy_in(other));
}

void State::end_use(const Accuracy& asked) {
  accuracy = asked;
  for (Clustered& one : clusters) one.entry->system->set_accuracy(one.own);
}

Accuracy Clustered::accuracy_in(const Accuracy& island) const {
  if (!fast_springs) return island;
  Accuracy implicit = island;
  implicit.scheme = articulated::Scheme::SemiImplicitEuler;
  implicit.implicit_joints = true;
  return implicit;
}

void Clustered::forget_parts() {
  pending = {};
  held_work = 0;
  for (Tree* tree : entry->system->trees()) tree->motor_impulse.setZero();
}

}  // namespace breve::island
