// Reads texts as the tests need it: the tree as a line of text, the diagnostics as "line:column code".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "steve/syntax/parser.hpp"

namespace breve::steve::test {

/// A tree as text: (a + b), (= n 5), (call self move to:x), (if c s else t); blocks in braces.
std::string show(const ast::Expr& expr);
std::string show(const ast::Stmt& stmt);
std::string show(const ast::TypeRef& type);
std::string show(const ast::Constant& constant);

/// A whole file.
struct Reading {
  explicit Reading(std::string text, bool embedded = false);
  /// "line:column code" of each error (or warning), in order, joined by ", ".
  std::string errors() const { return places(Severity::Error); }
  std::string warnings() const { return places(Severity::Warning); }
  std::string places(Severity severity) const;
  const ast::Class& only_class() const { return file.classes.at(0); }
  const ast::Method& method(std::size_t index = 0) const { return only_class().methods.at(index); }

  Sources sources;
  Diagnostics diagnostics;
  Defines defines;
  std::vector<Token> tokens;
  ast::File file;
};

/// The statements of one method body, on line 1 of a file of their own; errors, if any, instead.
std::string statements(std::string_view text);
/// One expression, as the right side of a return.
std::string expression(std::string_view text);
/// Errors of a method body that begins at line 1, column 1.
std::string body_errors(std::string_view text);
std::string body_warnings(std::string_view text);

}  // namespace breve::steve::test
