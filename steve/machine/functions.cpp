// Joins the tables of functions. Kept apart so that each table stands in the file of its topic.
#include "steve/machine/functions.hpp"

#include <vector>

#include "steve/machine/machine.hpp"

namespace breve::steve {

void charge_for_argument(Machine& machine, std::size_t bytes) {
  constexpr std::size_t kBytesPerIteration = 64;
  machine.charge(bytes / kBytesPerIteration);
}

std::span<const Native> functions() {
  static const std::vector<Native> kAll = [] {
    std::vector<Native> all;
    for (const auto table :
         {math_functions(), object_functions(), world_functions(), file_functions(), sensor_functions()})
      all.insert(all.end(), table.begin(), table.end());
    return all;
  }();
  return kAll;
}

}  // namespace breve::steve
