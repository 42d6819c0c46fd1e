// A small island seen from its rows alone: where they are fewer than the numbers of its velocities, what each row's
// impulse does at each other row is all that a solve needs to know.
#pragma once

#include "runtime/contact/workspace.hpp"

namespace breve::contact {

/// Call after pack(). If it pays, velocity() and push() then work on `work.rates` by the matrix W = J R, and the movers
/// keep the velocities they had.
void condense(Workspace& work);
/// W of the contacts' normals and the scalar rows, in `work.normal_answers`, for sweeps without friction: once after
/// each pack(). @return false if it does not pay
bool condense_normals(Workspace& work);
/// Gives the movers what all impulses do to them. To be called before unpack().
void expand(Workspace& work);

}  // namespace breve::contact
