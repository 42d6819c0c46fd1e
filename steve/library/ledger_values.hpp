// The energy ledger, interventions and counters as values of a script: hashes with one entry for each number.
#pragma once

#include "runtime/mechanics/ledger.hpp"
#include "steve/machine/machine.hpp"

namespace breve::steve {

HashCell* ledger_value(Machine& machine, const Energy& energy);
HashCell* counters_value(Machine& machine, const DynamicsCounters& counters);
ListCell* interventions_value(Machine& machine, std::span<const Intervention> interventions);

/// What contacts took, J: along the normal and along the surface.
inline double contact_loss_of(const Energy& energy) { return energy.contact_loss + energy.friction_loss; }

}  // namespace breve::steve
