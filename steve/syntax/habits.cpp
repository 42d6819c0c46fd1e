// Mistakes that have a reason: habits of other languages, and what beginners write. Each is recognised where the
// grammar fails (never before: what is valid stays valid), gets a text of its own, and is read as what was meant, so
// that one mistake is one error.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "steve/syntax/parser_nodes.hpp"

namespace breve::steve {

namespace {

bool one_of(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

constexpr std::size_t kFarthest = 200;  // items that are looked ahead: reading stays linear

bool is_type_word(Word word) { return word >= Word::Int && word <= Word::Hash; }  // KEEP IN STEP: words.hpp

std::string_view singular_type(std::string_view text) { return one_of(text, {"double"}) ? "float" : text; }

}  // namespace

bool Parser::adjacent(std::size_t ahead) const { return !token(ahead).space_before; }

// The item behind the ')' that closes the '(' at the current item, on the same line; 0 if there is none.
std::size_t Parser::behind_parentheses(std::size_t ahead) const {
  int depth = 0;
  const std::uint32_t line = token(ahead).span.line;
  for (std::size_t i = ahead; i < ahead + kFarthest && !at_kind(TokenKind::End, i) && token(i).span.line == line; ++i) {
    if (at("(", i)) ++depth;
    if (at(")", i) && --depth == 0) return i + 1;
  }
  return 0;
}

// `+ fly:` without `to`, `to fly:` without a sign, `function fly()`: how many items stand before the name; 0 if none.
std::size_t Parser::broken_header() const {
  if (!token().starts_line || at_member_header() || at_variables_header()) return 0;
  const auto named = [&](std::size_t ahead) {  // NAME and ':' at once, or a parameter
    if (!at_kind(TokenKind::Name, ahead) || token(ahead).span.line != token().span.line) return false;
    return at(":", ahead + 1) || (at_name(ahead + 1) && at_name(ahead + 2) && at_type(ahead + 3));
  };
  if ((at("+") || at("-")) && named(1)) return 1;
  if (at_text("to") && named(1)) return 1;
  if (!at_kind(TokenKind::Name) || !at_kind(TokenKind::Name, 1)) return 0;
  if (!one_of(token().text, {"function", "def", "func", "fn", "method", "sub", "void", "proc"})) return 0;
  return at("(", 2) || at(":", 2) || at("{", 2) ? 1 : 0;
}

void Parser::report_broken_header() {
  const Token& name = token(1);
  const std::string help = fmt::format("write: + to {}:", name.text);
  if (at("+") || at("-")) {
    error(token().span, "method-header", "the word 'to' is missing in this method header", help);
  } else if (at_text("to")) {
    error(token().span, "method-header", "the '+' is missing in front of this method header", help);
  } else {
    error(token().span, "method-header", fmt::format("'{}' does not begin a method", token().text), help);
  }
}

// Behind the name of a method: `fly()` or `fly(self)`.
void Parser::header_parentheses(std::string_view name, bool reported) {
  if (!at("(")) return;
  const std::size_t behind = behind_parentheses(0);
  const std::string help = behind == 2 ? fmt::format("write: + to {}:", name)
                                       : fmt::format(
                                             "a parameter is a keyword, a variable and a type: + to {} keyword "
                                             "variable (type):",
                                             name);
  if (!reported) error(token().span, "method-header", "the name of a method is not followed by parentheses", help);
  if (behind == 0) return;
  pos_ += behind;
  if (!at("{")) return;
  method_brace_ = true;
  advance();
}

// `int x;` and similar text at the beginning of a statement: read as the declarations that were meant.
bool Parser::foreign_declaration() {
  const bool typed = is_type_word(item().word) && at_name(1);
  const bool untyped = one_of(token().text, {"var", "let", "const", "local", "auto"}) && at_name() && at_name(1) &&
                       (at("=", 2) || at(";", 2));
  if (!typed && !untyped) return false;
  const std::string type(typed ? singular_type(token().text) : "float");
  Span location = token().span;
  location.length = token(1).span.offset + token(1).span.length - location.offset;
  const std::string name(token(1).text);
  error(location, "foreign-declaration",
        typed ? "a variable is declared with its type after it"
              : fmt::format("'{}' does not declare a variable", token().text),
        fmt::format("write at the beginning of the method: {} ({}).", name, type));
  advance();
  const std::size_t start = pos_;
  do {
    ast::Variable variable;
    if (!at_name()) break;
    variable.name = token().text;
    variable.span = token().span;
    variable.type.broken = true;
    late_locals_.push_back(std::move(variable));
    advance();
  } while (accept(","));
  skip_statement(start);
  return true;
}

// At the beginning of a statement: something that is not a statement, and is skipped once it is reported.
bool Parser::foreign_statement() {
  if (at("%")) {
    error(token().span, "comment", "a comment after a statement begins with '#'",
          "'%' begins a comment only as the first character of its line");
    const std::uint32_t line = token().span.line;
    while (!at_end() && token().span.line == line) advance();
    return true;
  }
  if (foreign_declaration()) return true;
  if (!at_name()) return false;
  if ((at_text("try") || at_text("catch")) && at(":", 1)) {
    error(token().span, "foreign-statement", fmt::format("there is no '{}'", token().text),
          "errors cannot be caught: test with 'if' what could go wrong");
    advance();
    advance();
    return true;
  }
  const bool block = (at("(", 1) && behind_parentheses(1) != 0 && at("{", behind_parentheses(1))) || at("{", 1);
  if (!block || !one_of(token().text, {"switch", "do", "repeat", "until", "unless", "loop", "try", "match", "forever"}))
    return false;
  const bool repeats = one_of(token().text, {"do", "repeat", "until", "loop", "forever"});
  error(token().span, "foreign-statement", fmt::format("there is no '{}'", token().text),
        repeats                 ? "repeat statements with: while condition: { ... }"
        : token().text == "try" ? "errors cannot be caught: test with 'if' what could go wrong"
                                : "write: if condition: { ... } else if condition: { ... }");
  const std::size_t start = pos_;
  while (!at_end() && !at("{")) advance();
  skip_statement(start);
  if (repeats && (at_word(Word::While) || at_text("until"))) {  // do { ... } while (condition);
    while (!at_end() && !at(".") && !at(";") && !at("}")) advance();
    if (!accept(".")) accept(";");
  }
  return true;
}

// `elif`, `elseif` and `elsif` where an else can stand.
bool Parser::at_elif() const {
  return at_name() && one_of(token().text, {"elif", "elseif", "elsif"}) && !at_assignment(1) && !at(".", 1);
}

// The error for a sign or word at the place where a statement should end.
Diagnostic Parser::after_statement(std::size_t start) {
  const auto made = [&](std::string code, std::string message, std::string help) {
    return Diagnostic{Severity::Error, std::move(code), std::move(message), std::move(help), token().span};
  };
  for (auto meant : {meant_by_first_word(start), meant_by_list_word(start), meant_by_value(start),
                     meant_by_assignment(), meant_by_operator(start)})
    if (meant) return std::move(*meant);
  const bool behind_call = call_end_ == pos_ && pos_ > 0;
  const std::string_view method = behind_call ? std::string_view(call_name_) : std::string_view();
  if (at(",") && items_[start].word == Word::Return)
    return made("syntax", "'return' returns one value", "put several in a list: return { 1, 2 }.");
  if (at(",") && behind_call)
    return made("syntax", "keyword arguments are not separated by ','",
                fmt::format("write: {} keyword value keyword value", method));
  if (at("(") && behind_call)
    return made("call-arguments", fmt::format("the arguments of '{}' need keywords, not parentheses", method),
                fmt::format("write: {} keyword value", method));
  if (behind_call && (method == "mod" || method == "div"))
    return made(
        "foreign-operator", fmt::format("'{}' is not an operator", method),
        method == "mod" ? "the remainder is written a % b" : "a quotient without fraction is written floor(a / b)");
  const bool value = at_kind(TokenKind::Int) || at_kind(TokenKind::Double) || at_kind(TokenKind::String);
  if (behind_call && value && !(at_kind(TokenKind::Double) && token().text.front() == '.'))
    return made("call-arguments", fmt::format("this argument of '{}' has no keyword in front", method),
                fmt::format("write: {} keyword {}", method, at_kind(TokenKind::String) ? "\"...\"" : token().text));
  if (at("(") && pos_ >= 2 && items_[pos_ - 2].word == Word::New)
    return made("syntax", fmt::format("'new {}' is not followed by parentheses", previous().text),
                "pass arguments by calling a method of the new object");
  const bool numbers = previous().kind == TokenKind::Int && at_kind(TokenKind::Int, 1);
  if (at(",") && numbers && adjacent(0) && adjacent(1))
    return made("foreign-number", "a number has no comma",
                fmt::format("a fraction is written {0}.{1}, and digits are not grouped: {0}{1}", previous().text,
                            token(1).text));
  if (at(":") && previous().kind == TokenKind::Name && items_[pos_ - 2].token->text == "lambda")
    return made("foreign-statement", "there is no 'lambda'",
                "methods are not values: give the name of a method as a string");
  if (at(",") && pos_ == start + 1 && at_name(1))
    return made("syntax", "one variable is assigned at a time", fmt::format("write: {} = value.", previous().text));
  if (at(":") && at("=", 1) && adjacent(1))
    return made("foreign-operator", "':=' is not an operator", "a value is assigned with =");
  if (at_kind(TokenKind::String) && adjacent(0) && previous().kind == TokenKind::Name)
    return made("foreign-string", fmt::format("a string has no '{}' in front", previous().text),
                "a value is put into a text with its name and a '$': \"$n\"");
  if (at("=")) return made("syntax", "unexpected '='", "a '.' may be missing before this, or '==' may be meant");
  if (at(":"))
    return made("syntax", "unexpected ':' in a statement", "only if, while, for, foreach and else take a ':'");
  if (at("["))
    return made("syntax", "unexpected '['", "only a variable of an array type takes [index]; lists take {index}");
  if (at("{") && adjacent(0) && previous().kind == TokenKind::Name)
    return made("missing-brace", "the index that begins here has no '}'", "write: list{index}");
  if (at(")")) return made("syntax", "unmatched ')'", "remove it, or look for a missing '(' before it");
  if (at("&&") || at("||") || at("?"))
    return made("syntax", fmt::format("unexpected {}", describe()),
                at("?") ? "there is no operator '?': write if condition: ... else ..." : "");
  const bool swallowed = at_kind(TokenKind::Double) && token().text.front() == '.';
  return made("syntax", fmt::format("expected '.' or an operator, got {}", describe()),
              swallowed ? "write a space after the '.' that ends a statement"
                        : "a statement ends with a period; two values need an operator between them");
}

// `<>`, `===`, `**`, `->`: what was meant, reported, its extra sign skipped.
std::optional<ast::BinaryOp> Parser::foreign_operator(ast::BinaryOp op) {
  const auto wrong = [&](std::string_view written, std::string message, std::string help) {
    Span location = previous().span;
    location.length = token().span.offset + token().span.length - location.offset;
    error(location, "foreign-operator", std::move(message), std::move(help));
    (void)written;
    advance();
  };
  if (!adjacent(0)) return std::nullopt;
  if (op == ast::BinaryOp::Lt && at(">")) {
    wrong("<>", "'<>' is not an operator", "not equal is written !=");
    return ast::BinaryOp::Ne;
  }
  if ((op == ast::BinaryOp::Eq || op == ast::BinaryOp::Ne) && at("=")) {
    wrong("===", "one '=' too many", op == ast::BinaryOp::Eq ? "equal is written ==" : "not equal is written !=");
    return op;
  }
  if (op == ast::BinaryOp::Mul && at("*")) {
    wrong("**", "'**' is not an operator", "a power is written ^; note that it has the precedence of *");
    return ast::BinaryOp::Pow;
  }
  if (op == ast::BinaryOp::Sub && at(">"))
    fail(previous().span, "foreign-operator", "'->' is not an operator",
         "a method is called as (object method), a variable of an object read as object::variable");
  return std::nullopt;
}

// `for (n = 0; n < 10; n++)`: reported, its parts read, the parentheses skipped.
bool Parser::at_c_for() const {
  if (!at("(")) return false;
  const std::size_t behind = behind_parentheses(0);
  for (std::size_t i = 0; i < behind; ++i)
    if (at(";", i)) return true;
  return false;
}

std::string Parser::loop_pattern(std::string_view variable) const {
  return fmt::format("write: for {0} = 0, {0} < 10, {0}++: ...", variable);
}

// A ';' where a period belongs is reported once a file: who writes one writes many.
void Parser::semicolon() {
  if (!semicolon_reported_) {
    const auto count = static_cast<std::size_t>(
        std::count_if(items_.begin(), items_.end(), [](const Item& i) { return i.sign == sign(";"); }));
    error(token().span, "semicolon", "a statement ends with a period, not with a semicolon",
          count == 1 ? "write '.'"
                     : fmt::format("write '.', here and in the other places: the file has {} semicolons", count));
  }
  semicolon_reported_ = true;
  advance();
}

}  // namespace breve::steve
