// From text to tree in two calls, so that a file's includes can be loaded before the file itself is parsed.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "steve/syntax/ast.hpp"
#include "steve/syntax/diagnostic.hpp"
#include "steve/syntax/lexer.hpp"

namespace breve::steve {

/// Names introduced by @define, shared by all files of a program in load order.
using Defines = std::map<std::string, ast::Constant, std::less<>>;

/// The @include, @use and @path directives of a file, wherever they stand at top level, without parsing the rest.
std::vector<ast::Directive> scan_directives(const std::vector<Token>& tokens);

/// Parse a whole file. Recovers after an error and reports every one. Adds the file's @defines to `defines`.
/// @param embedded  the file is part of the class library: `@native` bodies are allowed
ast::File parse(const std::vector<Token>& tokens, Defines& defines, Diagnostics& diagnostics, const Sources& sources,
                bool embedded = false);

/// A single statement submitted interactively: as if in a parameterless method; a missing final period is supplied.
ast::Method parse_statement(const std::vector<Token>& tokens, const Defines& defines, Diagnostics& diagnostics,
                            const Sources& sources);

}  // namespace breve::steve
