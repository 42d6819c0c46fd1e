// Energies of what an island holds, where its bodies stand, J.
#pragma once

#include "runtime/dynamics/island_state.hpp"

namespace breve::island {

/// Positions and velocities of a network's points from its bodies.
void take_points(State& state, const NetworkCluster& one);
/// Springs of networks.
double network_energy(State& state);
/// Springs between the trees of a cluster, whose links are placed.
double spring_energy(const State& state, const Clustered& one);
/// All that a cluster has; `kinetic` is set to what is in motion.
double stored_energy(State& state, const Clustered& one, double& kinetic);
/// Kinetic, potential and in springs, of all.
double stored_energy(State& state);
/// Kinetic, of all trees.
double motion_of_trees(State& state);
/// What it takes to lift all links by their own size: of that, what lies still may err by round-off of its solution.
double weight(const State& state);
/// The same of bodies without joints.
double free_weight(const State& state);
/// What it takes to move them so far against the forces that scripts apply to them.
double script_weight(const State& state);
/// What links and bodies that touch them have at most that are still; nothing without links.
double energy_of_stillness(const State& state);
/// The state in the world's arrays, while a handler may change it.
double held_energy(const State& state);

/// The energy with which a cluster's links move relative to one another: each of its wholes has a motion in common.
/// @param held  something outside may hold them: it is the energy of all motion
double inner_energy(const Clustered& one, bool held = false);
/// Shortens the velocities of that motion to `scale` times what they are. Returns the energy that it had.
double shorten_inner_motion(const Clustered& one, double scale, bool held = false);

/// Notes where the links stand that scripts push, and what their forces have worked since, of one cluster.
void note_pushed(Clustered& one);
double work_on_pushed(Clustered& one);

/// The part of a way along which a tree may be moved without changing its velocities: all of it, unless its motion
/// would gain more than a little by standing elsewhere, as that of light links that an impulse throws does.
double share_without_gain(Tree& tree, const articulated::Vector& way);

/// Moves a tree along the whole of a way. Where its motion would gain more than a little by that, links keep their
/// momenta instead of the rates of their joints. For trees that something outside touches: others keep what they have.
void move_without_gain(State& state, Tree& tree, const articulated::Vector& way);

}  // namespace breve::island
