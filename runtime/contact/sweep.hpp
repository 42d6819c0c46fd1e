// Block projected Gauss-Seidel: each contact in turn takes the exact impulse of its cone, given all others.
#pragma once

#include <cstddef>

#include "runtime/contact/workspace.hpp"

namespace breve::contact {

/// Push every row by the impulse it starts with.
void push_all(Workspace& work);

/// One sweep: scalar rows, then contacts, each in the order given; or contacts in the opposite order. Taken by turns a
/// load goes up a stack as fast as down, and no side is always the last.
/// @return the largest change of velocity that a row made at itself, m/s
double sweep(Workspace& work, bool backward = false);

/// One contact of a sweep.
double visit_point(Workspace& work, std::size_t point);

/// What the impulses do to the kinetic energy, less what the biases demand, J: with p the impulses, u the velocities,
/// half of p.(u without + u with) - p.bias + softness p^2 / 2. Not positive for every exact solution.
double gain(const Workspace& work);

/// If `gain` is positive, shorten all impulses by the one factor that makes it least; cones and bounds contain what is
/// shorter. So even a solve that was stopped early adds no energy.
void hold_energy(Workspace& work);

}  // namespace breve::contact
