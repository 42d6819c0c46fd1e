// What one step of an island counted, booked and met.
#pragma once

#include <memory_resource>
#include <vector>

#include "runtime/mechanics/mechanics.hpp"

namespace breve {

/// What an island was found to have, and what its step took; added to the world's in the order of islands.
struct IslandResult {
  DynamicsCounters counters;
  Energy ledger;
  std::pmr::vector<Impact> impacts;
  std::pmr::vector<Intervention> interventions;
  explicit IslandResult(std::pmr::memory_resource* memory) : impacts(memory), interventions(memory) {}
};

}  // namespace breve
