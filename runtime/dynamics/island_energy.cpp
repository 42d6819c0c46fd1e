// Energies of what an island holds.
#include "runtime/dynamics/island_energy.hpp"

#include "runtime/dynamics/network_motion.hpp"
#include "runtime/dynamics/spring_network.hpp"

namespace breve::island {

void take_points(State& state, const NetworkCluster& one) {
  NetworkMotion& points = *one.entry->points;
  for (std::size_t i = 0; i < points.trees().size(); ++i) {
    const FreeBody& body = state.free_bodies[one.first + i].now;
    points.point(i).center = body.center;
    points.point(i).velocity = body.velocity;
  }
}

double network_energy(State& state) {
  double sum = 0;
  for (const NetworkCluster& one : state.networks) {
    take_points(state, one);
    sum += one.entry->points->energy();
  }
  return sum;
}

double spring_energy(const State& state, const Clustered& one) {
  if (one.entry->network) return one.entry->network->spring_energy(state.core);
  double sum = 0;
  for (const SpringIndex spring : one.entry->springs) sum += state.core.spring_energy_in(state.core.springs[spring].is);
  return sum;
}

double stored_energy(State& state, const Clustered& one, double& kinetic) {
  double sum = 0;
  kinetic = 0;
  for (const std::uint32_t index : one.entry->trees) {
    const Energy energy = state.core.energy_of(*state.core.trees[index]);
    kinetic += energy.kinetic;
    sum += energy.kinetic + energy.potential + energy.springs;
  }
  return sum + spring_energy(state, one);
}

double stored_energy(State& state) {
  double sum = 0, kinetic = 0;
  for (const Free& one : state.loose_bodies())
    sum += one.now.kinetic() - one.now.solid->mass * state.core.settings.gravity.dot(one.now.center);
  sum += network_energy(state);
  for (const Clustered& one : state.clusters) sum += stored_energy(state, one, kinetic);
  return sum;
}

double weight(const State& state) {
  double sum = 0;
  for (const Tree* tree : state.trees)
    for (const TreeLink& link : tree->links) sum += link.solid.mass * state.shape(link.body).bounding_radius();
  return sum * state.core.settings.gravity.norm();
}

double free_weight(const State& state) {
  double sum = 0;
  for (const Free& one : state.loose_bodies()) sum += one.now.solid->mass * state.shape(one.body).bounding_radius();
  return sum * state.core.settings.gravity.norm();
}

double energy_of_stillness(const State& state) {
  double mass = 0;
  for (const Tree* tree : state.trees)
    for (const TreeLink& link : tree->links) mass += link.solid.mass;
  const double slow = kSlow * state.unit();
  return 0.5 * slow * slow * mass;
}

namespace {

/// Springs of networks, whose bodies stand where the arrays have them.
double held_network_energy(const State& state) {
  double sum = 0;
  for (const NetworkCluster& one : state.networks)
    for (const SpringIndex spring : one.entry->springs) sum += state.core.spring_energy(state.core.springs[spring].is);
  return sum;
}

}  // namespace

double held_energy(const State& state) {
  double sum = 0;
  for (const Free& one : state.loose_bodies()) sum += state.core.free_energy(one.body).total();
  sum += held_network_energy(state);
  for (Tree* tree : state.trees) sum += state.core.energy_of(*tree).total();
  for (const Clustered& one : state.clusters)
    for (const SpringIndex spring : one.entry->springs) sum += state.core.spring_energy(state.core.springs[spring].is);
  return sum;
}

}  // namespace breve::island
