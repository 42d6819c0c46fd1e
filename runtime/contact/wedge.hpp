// Where friction wedges bodies: the impulses that press them may grow without an end, and no solution is found.
#pragma once

#include "runtime/contact/workspace.hpp"

namespace breve::contact {

/// Whether impulses of contacts and friction work against one another a hundred times as much as they change in all; a
/// thousand times, if they are a solution.
bool thrown(const Workspace& work, bool converged);

/// No impulses, and the velocities without them.
void forget_impulses(Workspace& work);

/// Sweeps in turns over what presses, with friction as it is, and over friction, as far as what presses allows. Each
/// turn is a convex problem, so that nothing is thrown; what presses has the last word.
///
/// Source: Kaufman, Sueda, James and Pai 2008, "Staggered projections for frictional contact in multibody systems".
/// @return  sweeps
int solve_staggered(Workspace& work, double tolerance);

}  // namespace breve::contact
