// An island, put together of its parts.
#include "runtime/dynamics/island.hpp"

namespace breve {

Island::Island(Dynamics::Core& core, std::pmr::memory_resource* memory)
    : state_(core, memory),
      arrays_(state_),
      balance_(state_),
      credit_(state_),
      handlers_(state_, arrays_, balance_),
      contacts_(state_),
      springs_(state_, contacts_),
      smooth_(state_, contacts_, springs_),
      rows_(state_, contacts_),
      momentum_(state_, rows_),
      books_(state_, contacts_, springs_, rows_, momentum_),
      prediction_(state_, contacts_, rows_, books_),
      solver_(state_, contacts_, rows_, momentum_, prediction_),
      positions_(state_, contacts_, rows_, momentum_, credit_),
      loops_(state_, contacts_, rows_, positions_, smooth_, momentum_, books_),
      overlaps_(state_, rows_),
      sub_step_(state_, contacts_, springs_, smooth_, rows_, books_, prediction_, solver_, positions_, loops_,
                overlaps_),
      impacts_(state_, contacts_, springs_, rows_, solver_, momentum_, sub_step_, handlers_),
      step_(state_, contacts_, smooth_, rows_, sub_step_, impacts_, handlers_, balance_),
      guard_(state_, balance_, books_, momentum_, credit_, overlaps_, handlers_, loops_, step_) {}

Island::~Island() = default;

void Island::clear() {
  state_.clear();
  springs_.clear();
  handlers_.clear();
  error = nullptr;
}

std::size_t Island::items() const {
  std::size_t count = state_.free_bodies.size() + state_.pairs.size();
  for (const Tree* tree : state_.trees) count += tree->links.size();
  return count;
}

void Island::append_bodies(std::pmr::vector<BodyIndex>& out) const {
  for (const island::Free& one : state_.loose_bodies()) out.push_back(one.body);
  for (Tree* tree : state_.trees)
    for (const TreeLink& link : tree->links) out.push_back(link.body);
}

void Island::step(MechanicsClient* client, double start, double h) {
  ++state_.result.counters.islands;
  state_.finished = false;
  const Accuracy asked = state_.accuracy;
  const std::uint64_t structure = state_.core.structure();
  state_.put_drivers(h);
  balance_.keep_start();
  try {
    guard_.step(client, start, h);
  } catch (...) {
    // A failed step leaves a state from which nothing can continue.
    if (state_.core.structure() == structure) {
      state_.end_use(asked);
      balance_.back_to_start();
      state_.place_links();
      if (state_.calls_out()) arrays_.write();  // a handler has seen more of the step
    }
    throw;
  }
}

}  // namespace breve
