// Motion of positions alone that leaves links their momenta: rates of joints would mean another motion there.
#pragma once

#include <memory_resource>
#include <vector>

#include "runtime/articulated/impulse.hpp"

namespace breve::articulated {

/// Moves a tree along `way` (nv, as a motion of its joints). If its kinetic energy grows by more than the share `most`
/// with the rates that the joints have, links keep their momenta p instead, as far as the joints let them: the rates
/// become M^-1 J^T p, the motion nearest to that of the links in the metric of the mass matrix, and never have more
/// energy than before. Cost O(links).
/// @param momenta  room, kept from call to call
/// @return         whether rates changed
bool move_carried(const Model& model, Data& data, State& state, const Vector& way, double most,
                  std::pmr::vector<Impulse>& momenta);

}  // namespace breve::articulated
