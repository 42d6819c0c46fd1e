// From an island to the world's arrays and books.
#include "runtime/dynamics/island_arrays.hpp"

#include "runtime/dynamics/island_energy.hpp"
#include "runtime/dynamics/network_motion.hpp"

namespace breve::island {

void Arrays::write() {
  for (const Free& one : state_.loose_bodies()) {
    write_free(*state_.core.bodies, one.body, one.now);
    if (BodyEntry* known = state_.core.find(one.body)) known->step = one.next;
  }
  write_networks();
  state_.place_links();
  for (const Clustered& one : state_.clusters)
    for (const std::uint32_t index : one.entry->trees) {
      state_.core.trees[index]->step = one.entry->system->next_step();
      state_.core.write_back(*state_.core.trees[index]);
    }
  book();
}

/// To the trees that they are outside of the step; the arrays have them.
void Arrays::write_networks() {
  for (const NetworkCluster& one : state_.networks) {
    const std::span<Tree* const> trees = one.entry->points->trees();
    for (std::size_t i = 0; i < trees.size(); ++i) {
      const FreeBody& body = state_.free_bodies[one.first + i].now;
      articulated::State& state = trees[i]->state;
      const Quaternion& orientation = body.orientation;
      state.q.head<3>() = body.center;
      state.q.tail<4>() << orientation.w(), orientation.x(), orientation.y(), orientation.z();
      state.v.head<3>() = body.velocity;
      state.v.tail<3>() = orientation.conjugate() * body.spin;
      state_.core.note_written(trees[i]->links.front().body);
    }
  }
}

/// Enters the state of the arrays into the energy ledger: scripts have made whatever differs from it later.
void Arrays::book() {
  const std::size_t first = state_.networks_begin(), end = state_.networks_end();
  const std::span<const Free> loose = state_.loose_bodies();
  for (std::size_t i = 0; i < loose.size(); ++i) {
    if (i >= first && i < end) continue;
    const Free& one = loose[i];
    // Read back as it will be when a script sets something: a centre of mass off the origin is rounded on the way.
    const bool central = one.now.solid->center_of_mass == Vector3::Zero();
    state_.core.booked[one.body] =
        central ? one.now.kinetic() - one.now.solid->mass * state_.core.settings.gravity.dot(one.now.center)
                : state_.core.free_energy(one.body).total();
  }
  book_networks();
  for (Tree* tree : state_.trees) {
    if (!state_.booked) tree->booked = state_.core.energy_of(*tree).total();
    tree->changed = false;
  }
  for (const Clustered& one : state_.clusters)
    for (const SpringIndex spring : one.entry->springs)
      state_.core.springs[spring].booked = state_.core.spring_energy(state_.core.springs[spring].is);
}

void Arrays::book_networks() {
  if (state_.networks.empty()) return;
  if (!state_.booked) network_energy(state_);
  for (const NetworkCluster& one : state_.networks) {
    const std::span<Tree* const> trees = one.entry->points->trees();
    for (std::size_t i = 0; i < trees.size(); ++i) {
      const FreeBody& body = state_.free_bodies[one.first + i].now;
      trees[i]->booked = body.kinetic() - body.solid->mass * state_.core.settings.gravity.dot(body.center);
      trees[i]->changed = false;
    }
    one.entry->points->write(state_.core);
  }
}

}  // namespace breve::island
