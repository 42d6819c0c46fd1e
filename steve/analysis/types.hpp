// Static types of expressions, as far as the text tells. Private to this folder.
#pragma once

#include <string>
#include <vector>

#include "steve/analysis/model.hpp"

namespace breve::steve {

/// The type that an expression has in a method of a class. `super` is of the parent's class.
KnownType type_of(const Model& model, const Scope& scope, const ast::Expr& expr);

/// The methods that a call may reach, best first: what the receiver's class or an ancestor answers with the fewest
/// keywords that hold all those given; of an unknown receiver every method of that name, the program's before others,
/// those that take the keywords before others. Symbols of methods.
/// @param keywords  those that are written, each once
std::vector<MethodIndex> methods_of_call(const Model& model, const KnownType& receiver, std::string_view selector,
                                         const std::vector<std::string_view>& keywords);

std::vector<std::string_view> keywords_of(const ast::Call& call);

/// "Bird object", "list", "float"; "" if nothing is known.
std::string type_name(const Model& model, const KnownType& type);

}  // namespace breve::steve
