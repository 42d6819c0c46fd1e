// Walls of space, and what a constant acceleration drives against them.
#pragma once

#include "runtime/space/extent.hpp"

namespace breve {

/// Extent::bring_inside for something that a constant acceleration (m/s^2) drives: it is put where it would be if
/// it had been reflected when it met the wall, with the energy that it came with. What could not have come there
/// by itself lies on the wall, at rest along that axis.
void throw_back(const Extent& space, Vector3& location, Vector3& velocity, const Vector3& acceleration);

}  // namespace breve
