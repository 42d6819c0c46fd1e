// How declarations are shown to readers, and what is said of the language's own functions. Private to this folder.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "steve/syntax/ast.hpp"
#include "steve/syntax/source.hpp"

namespace breve::steve {

/// The bytes of a span as they stand in its file, with every run of blanks and line ends as one blank.
std::string text_of(const Sources& sources, const Span& span);

/// A type as written, without its parentheses: "float", "Bird object", "5 ints".
std::string type_text(const Sources& sources, const ast::TypeRef& type);

/// "set-velocity to v (vector)"; a default stands as ` = 0` before the type.
std::string signature_of(const Sources& sources, const ast::Method& method);
std::string signature_of(const Sources& sources, const ast::Parameter& parameter);

/// "Mobile : Bird (aka Birds)"
std::string signature_of(const ast::Class& cls);

/// The `#` comment that stands on the same line behind the period after `offset`; "" if there is none.
std::string comment_behind(const Sources& sources, std::uint32_t file, std::size_t offset);

/// What a function of the language does, for documentation.
struct FunctionNote {
  std::string_view name;
  std::string_view parameters;  // names, each with a blank behind it but the last; as many as the function takes
  std::string_view note;
};

/// Null if there is none for a function of that name with that many parameters.
const FunctionNote* function_note(std::string_view name, std::size_t parameters);

/// "float" for 'd' and so on: the letters of a native's signature; "" for 'n', no value.
std::string_view type_of_letter(char letter);

/// "angle(a (vector), b (vector))"
std::string function_signature(std::string_view name, std::string_view letters, const FunctionNote* note);

}  // namespace breve::steve
