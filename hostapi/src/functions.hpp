// Functions of the host, as scripts call them.
#pragma once

#include <span>

#include "internal.hpp"
#include "modules.hpp"
#include "steve/code/foreign.hpp"

namespace breve::host {

/// In signatures of the machine. BREVE_TYPE_NULL stands for any value. BREVE_ERROR_ARGUMENT for none; `what` names it.
char letter_of(std::uint32_t type, const std::string& what);

/// @param function  one that breve_runtime_add_function made
/// @throws  RunError with the host's reason; std::bad_alloc
steve::Value call_function(breve_world& world, const steve::ForeignFunction& function, steve::Instance& self,
                           std::span<const steve::Value> arguments);

/// Where the method of the host stands that is active at this depth of calls, or has just failed there.
std::vector<steve::ForeignPlace> places_of(const breve_world& world, std::size_t depth);

/// An object is being forgotten: so is the data that the host keeps with it.
void end_data(breve_world& world, ObjectId id);

}  // namespace breve::host
