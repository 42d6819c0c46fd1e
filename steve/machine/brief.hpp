// Values in a few words, for messages: never runs script, changes nothing, and the length is bounded.
#pragma once

#include <string>
#include <string_view>

#include "steve/machine/cells.hpp"
#include "steve/syntax/diagnostic.hpp"

namespace breve::steve {

/// `7`, `2.5`, `(3, 0, 1)`, `"text"`, `a list of 12`, `Bird 0xc`, `null`. Strings are quoted; what is long ends in `…`.
std::string brief(const Value& value);
/// The same of an object. The number is that which `print` shows.
std::string brief(const Instance* object);
std::string brief(const Vector3& vector);
/// A text in quotes, on one line, of at most about 40 characters.
std::string brief_text(std::string_view text);
/// With the name of its type: `the int 7`, `the string "text"`, `a list of 12`, `the object Bird 0xc`, `a null object`.
std::string typed_brief(const Value& value);

}  // namespace breve::steve
