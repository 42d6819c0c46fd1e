// Every name of a program with its place. Private to this folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "steve/analysis/model.hpp"

namespace breve::steve {

struct Use {
  NameKind kind = NameKind::Word;
  Span span;
  std::string_view name;
  std::size_t symbol = kNoIndex;  // where there is only one that it can be
  bool declaration = false;
  KnownType receiver;                      // of methods and keywords
  std::string_view selector;               // of keywords: the method's name
  std::vector<std::string_view> keywords;  // of methods and keywords: those that the call gives
  std::string type;                        // as Reference::type
};

/// All of them, in order of files and places.
std::vector<Use> find_uses(const Model& model);

/// A name that the trees do not have, because its statement is broken: what it may be. Kind Word if nothing is known.
Use guess_use(const Model& model, const Token& token);

/// The class and method whose text a place is in, or behind whose last word it is.
Scope scope_at(const Model& model, std::uint32_t file, std::uint32_t offset);

}  // namespace breve::steve
