// Which names may stand at a place. Private to this folder.
#pragma once

#include "steve/analysis/model.hpp"

namespace breve::steve {

Completions complete(const Model& model, std::uint32_t file, std::uint32_t offset);

/// @param cls  the class in a method of which the statement stands; kNoIndex: none
Completions complete_statement(const Model& model, std::size_t cls, std::string_view text, std::uint32_t offset);

/// The call whose keywords or values are at a place; nothing if there is none.
std::optional<CallContext> find_call(const Model& model, std::uint32_t file, std::uint32_t offset);

}  // namespace breve::steve
