// From text to tree in two calls, so that a file's includes can be loaded before the file itself is parsed.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "steve/syntax/ast.hpp"
#include "steve/syntax/diagnostic.hpp"
#include "steve/syntax/lexer.hpp"

namespace breve::steve {

/// Constants from @define, shared by all files of a program in load order. Those of the class library are visible to
/// every file, but a program may define such a name for itself: the library then keeps its own value.
class Defines {
 public:
  using Table = std::map<std::string, ast::Constant, std::less<>>;

  /// What a name stands for in a file of the program, or in one of the library; null: it is not a constant there.
  const ast::Constant* find(std::string_view name, bool in_library) const {
    const Table& table = in_library ? library_ : seen_;
    const auto found = table.find(name);
    return found == table.end() ? nullptr : &found->second;
  }

  void add(const std::string& name, const ast::Constant& value, bool in_library) {
    if (in_library) {
      library_.insert_or_assign(name, value);
      seen_.try_emplace(name, value);
    } else {
      seen_.insert_or_assign(name, value);
    }
  }

  /// Those that files of the program see, sorted by name.
  const Table& seen() const { return seen_; }

 private:
  Table seen_, library_;
};

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
