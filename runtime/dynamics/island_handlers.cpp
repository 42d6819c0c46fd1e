// A script's handler in the middle of a step.
#include "runtime/dynamics/island_handlers.hpp"

#include "runtime/dynamics/island_energy.hpp"
#include "runtime/dynamics/network_motion.hpp"

namespace breve::island {

void Handlers::clear() {
  dissolved_ = false;
  unfinished_ = 0;
}

/// Books the unexplained energy of the part of a step that was taken; it ends because the island has changed.
/// @param held  J, as that part ended, but for contact springs
void Handlers::end_unfinished(double held) {
  for (const NearPair* pair : state_.pairs) held += pair->stored;
  state_.result.ledger.residual += balance_.unexplained(held);
}

/// Calls the handler of a pair that touches for the first time. False if what it did leaves nothing of the island as it
/// was: the rest of the step is then taken by the islands that are found anew.
bool Handlers::call(MechanicsClient& client, NearPair& pair, double moment, double left) {
  pair.reported = true;
  const Contact contact =
      closest(state_.shape(pair.a), state_.pose_of(pair.a), state_.shape(pair.b), state_.pose_of(pair.b));
  state_.booked = false;
  arrays_.write();
  const double held = held_energy(state_);
  const std::uint64_t before = state_.core.structure();
  client.impact(pair.a, pair.b, contact, moment);
  state_.core.sync_changes();
  state_.core.settle_books(true);
  // Something was made or freed, or a spring was set to what points cannot follow.
  if (state_.core.structure() != before || !state_.begin_networks(left)) {
    end_unfinished(held);
    dissolved_ = true;
    unfinished_ = left;
    return false;
  }
  state_.read_springs();
  balance_.add_handled(held_energy(state_) - held);
  for (Free& one : state_.loose_bodies()) one.now = read_free(*state_.core.bodies, one.body);
  state_.place_links();
  return true;
}

}  // namespace breve::island
