// Sweeps without friction: one number for each contact and each scalar row, and W says how each answers each. Where
// joints pass on what one contact does to all others, most rows have nothing to do in most sweeps, and cost nothing.
#pragma once

#include "runtime/contact/plain.hpp"
#include "runtime/contact/workspace.hpp"

namespace breve::contact {

/// From the points and scalar rows, all of them without friction and the movers at rest, to `work.normals`, and back.
/// condense_normals() comes before; the movers are not pushed.
void enter_normals(Workspace& work);
void leave_normals(Workspace& work);

/// The scalar rows, then the points in the order given or backward.
Moved sweep_normals(Workspace& work, bool backward);
/// All impulses go on along their last change.
void go_on_normals(Workspace& work, double share);

}  // namespace breve::contact
