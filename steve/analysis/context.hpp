// What the words before a place expect there. The text may be half a statement: only tokens are looked at, and only
// those before the place. Private to this folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "steve/syntax/lexer.hpp"

namespace breve::steve {

/// The kinds of names that are possible at a position.
enum class Expected : std::uint8_t {
  Nothing,
  TopLevel,        // a class, a directive, `Controller`
  Directive,       // behind '@'
  Module,          // behind `@use`
  Class,           // behind `new`, `all`, `Controller`
  Type,            // behind the '(' of a declaration
  TypeOrOperand,   // behind a '(' that may be that of a declaration
  ArrayType,       // behind the number of an array's type
  ObjectWord,      // behind the class in a type
  AkaWord,         // behind the '(' of a class's header
  MemberWord,      // behind the '+' before a method
  MethodName,      // behind `+ to`
  StatementStart,  // a statement
  Operand,         // an expression
  Selector,        // a method's name, behind a receiver
  Keyword,         // of the call before
  Member,          // behind '::'
  StringVariable,  // behind '$' in a string
  InWord,          // behind the variable of a foreach
  OntoWord,        // behind what is pushed
  AtWord,          // behind what is inserted
  WithWord,        // behind the list that is sorted
  SortMethod       // behind that `with`
};

/// A call of which the selector is written.
struct WrittenCall {
  std::size_t receiver = 0, selector = 0;  // tokens: the receiver's first, and the selector
  std::vector<std::string_view> keywords;
  std::string_view keyword;  // the last
};

struct Context {
  Expected expected = Expected::Nothing;
  std::uint32_t typed = 0;          // bytes of a name just before the place
  std::size_t count = 0;            // tokens before that name
  std::size_t receiver = 0;         // Selector, Member: the receiver's first token; it ends with `count` less the '::'
  std::optional<WrittenCall> call;  // the innermost call whose keyword or value is at the place
};

/// @param text    the file
/// @param tokens  of the file, without documentation
/// @param body    the text is a statement, rather than a file
Context context_at(std::string_view text, const std::vector<Token>& tokens, std::uint32_t offset, bool body);

}  // namespace breve::steve
