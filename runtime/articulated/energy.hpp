// What a tree of bodies keeps or loses: energy and momentum.
#pragma once

#include "runtime/articulated/data.hpp"

namespace breve::articulated {

/// All after forward_kinematics on `data`. Cost O(links). No allocation.

/// J, of one link's centre of mass and spin.
double kinetic_energy_of_link(const Model& model, const Data& data, int link);
/// J, of all links' centres of mass and spins.
double kinetic_energy(const Model& model, const Data& data);
/// J: -sum m g.x, zero at the world's origin.
double potential_energy(const Model& model, const Data& data, const Vector3& gravity);
/// kg*m/s, world axes.
Vector3 linear_momentum(const Model& model, const Data& data);
/// kg*m^2/s, world axes, of one link about its own centre of mass.
Vector3 own_momentum(const Model& model, const Data& data, int link);
/// kg*m^2/s, world axes, about a point that does not move.
Vector3 angular_momentum(const Model& model, const Data& data, const Vector3& about);
/// m, of the whole.
Vector3 centre_of_mass(const Model& model, const Data& data);

}  // namespace breve::articulated
