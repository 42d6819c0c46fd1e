// Functions of the host, as scripts call them.
#pragma once

#include <span>

#include "internal.hpp"
#include "modules.hpp"
#include "steve/machine/foreign.hpp"

namespace breve::host {

/// @param function  one that breve_runtime_add_function made
/// @throws  RunError with the host's reason; std::bad_alloc
steve::Value call_function(breve_world& world, const steve::ForeignFunction& function, steve::Instance& self,
                           std::span<const steve::Value> arguments);

}  // namespace breve::host
