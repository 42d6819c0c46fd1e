// Trees that what was set since makes wrong: they are dropped when changes are taken next, and an image does not hold
// them.
#pragma once

#include "runtime/dynamics/core.hpp"

namespace breve {

/// Does the link's body move by forces no longer, or has it another mass than the tree was built with?
bool is_stale(const Dynamics::Core& core, const TreeLink& link);
/// Was a body that holds the tree moved, or does it move by itself now? One that only closes a loop may be moved.
bool has_changed_holder(const Dynamics::Core& core, const Tree& tree);
/// Either.
bool is_stale(const Dynamics::Core& core, const Tree& tree);

}  // namespace breve
