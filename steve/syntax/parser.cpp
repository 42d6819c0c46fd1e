// The parser's ground: tokens, errors and the entry points.
#include "steve/syntax/parser.hpp"

#include <fmt/format.h>

#include <utility>

#include "steve/syntax/parser_core.hpp"
#include "steve/syntax/scanner.hpp"

namespace breve::steve {

std::vector<ast::Directive> scan_directives(const std::vector<Token>& tokens) {
  std::vector<const Token*> real;
  for (const Token& token : tokens) {
    if (token.kind != TokenKind::Doc) real.push_back(&token);
  }
  std::vector<ast::Directive> found;
  for (std::size_t i = 0; i + 2 < real.size(); ++i) {
    if (real[i]->kind != TokenKind::Punctuation || real[i]->text != "@") continue;
    if (real[i + 1]->kind != TokenKind::Name) continue;
    const Word word = word_of(real[i + 1]->text);
    const bool names_file = word == Word::Include || word == Word::Path || word == Word::Plugin;
    if (!(names_file || word == Word::Use)) continue;
    if (real[i + 2]->kind != (names_file ? TokenKind::String : TokenKind::Name)) continue;
    ast::Directive directive;
    directive.kind = word == Word::Include  ? ast::Directive::Kind::Include
                     : word == Word::Use    ? ast::Directive::Kind::Use
                     : word == Word::Plugin ? ast::Directive::Kind::Plugin
                                            : ast::Directive::Kind::Path;
    if (word == Word::Plugin) {  // its entry stands in parentheses; without one the parser complains
      if (i + 5 >= real.size() || real[i + 4]->kind != TokenKind::Name) continue;
      directive.entry = real[i + 4]->text;
    }
    directive.text = real[i + 2]->text;
    directive.span = real[i]->span;
    const Span& last = real[word == Word::Plugin ? i + 5 : i + 2]->span;
    directive.span.length = last.offset + last.length - real[i]->span.offset;
    found.push_back(std::move(directive));
  }
  return found;
}

ast::File parse(const std::vector<Token>& tokens, Defines& defines, Diagnostics& diagnostics, const Sources& sources,
                bool embedded) {
  return Parser(tokens, defines, &defines, diagnostics, sources, embedded).file();
}

ast::Method parse_statement(const std::vector<Token>& tokens, const Defines& defines, Diagnostics& diagnostics,
                            const Sources& sources) {
  return Parser(tokens, defines, nullptr, diagnostics, sources, false).interactive();
}

Parser::Parser(const std::vector<Token>& tokens, const Defines& defines, Defines* new_defines, Diagnostics& diagnostics,
               const Sources& sources, bool embedded)
    : defines_(defines), new_defines_(new_defines), diagnostics_(diagnostics), sources_(sources), embedded_(embedded) {
  static const Token kNothing{};
  items_.reserve(tokens.size() + 1);
  for (const Token& token : tokens) {
    if (token.kind == TokenKind::Doc) {
      docs_.push_back({items_.size(), token.text});
      continue;
    }
    Item item{&token};
    if (token.kind == TokenKind::Punctuation) item.sign = sign(token.text);
    if (token.kind == TokenKind::Name) item.word = word_of(token.text);
    items_.push_back(item);
  }
  if (items_.empty() || items_.back().token->kind != TokenKind::End) items_.push_back(Item{&kNothing});
  find_braces();
  const std::uint32_t file = items_.front().token->span.file;
  for (const Diagnostic& diagnostic : diagnostics.all()) {
    if (diagnostic.severity != Severity::Error || diagnostic.span.file != file) continue;
    garbled_lines_.insert(diagnostic.span.line);
    if (diagnostic.code == "file-too-large") cut_off_ = true;
  }
}

Parser::Nest::Nest(Parser& parser) : parser_(parser) {
  if (parser.depth_ >= ast::kMaxNesting) {
    throw SyntaxError{
        {Severity::Error, "nesting", "nested too deeply",
         fmt::format("at most {} levels are possible: split this into several statements or methods", ast::kMaxNesting),
         parser.token().span},
        true};
  }
  ++parser.depth_;
  if (parser.depth_ > parser.deepest_) parser.deepest_ = parser.depth_;
}

// Pair the braces, and note of each '{' whether statements or list items stand in it: only statements have a period, or
// the colon of an if. A brace pair directly inside tells the same about the pair around it.
void Parser::find_braces() {
  struct Open {
    std::size_t index;
    int parentheses;
  };
  std::vector<Open> open;
  int parentheses = 0;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    Item* const around = open.empty() ? nullptr : &items_[open.back().index];
    switch (items_[i].sign) {
      case sign("("):
      case sign("["): ++parentheses; break;
      case sign(")"):
      case sign("]"): --parentheses; break;
      case sign("{"): open.push_back({i, parentheses}); break;
      case sign("}"):
        if (around == nullptr) break;
        around->match = static_cast<std::uint32_t>(i);
        parentheses = open.back().parentheses;
        if (open.size() > 1 && around->block_like) items_[open[open.size() - 2].index].block_like = true;
        open.pop_back();
        break;
      case sign("."):
        if (around != nullptr && !inside_list(i, open.back().index)) around->block_like = true;
        break;
      case sign(":"):
        if (around != nullptr) around->block_like = true;
        break;
      case sign(","):
        if (around != nullptr && parentheses == open.back().parentheses) around->has_comma = true;
        break;
      default: break;
    }
  }
}

// Is the period at `i`, in the braces that open at `open`, part of a number of a list: `{1., (2., 0, 0), 3.}`? Of the
// statements without a colon only those that print also have commas.
bool Parser::inside_list(std::size_t i, std::size_t open) const {
  if (items_[i - 1].token->kind != TokenKind::Int || items_[i].token->space_before || i + 1 >= items_.size())
    return false;
  const std::uint16_t next = items_[i + 1].sign;
  const Word first = items_[open + 1].word;
  if (first == Word::Print || first == Word::Printf) return false;
  if (next == sign("}")) {
    // A brace on a line of its own closes a list that is written over several lines, no list of the line before.
    const Token& close = *items_[i + 1].token;
    const bool apart = close.starts_line && items_[open].token->span.line == items_[i].token->span.line;
    return !apart && items_[open].has_comma && !items_[open].block_like;
  }
  return next == sign(",") || next == sign(")") || next == sign("]");
}

const Parser::Item& Parser::item(std::size_t ahead) const {
  return pos_ + ahead < items_.size() ? items_[pos_ + ahead] : items_.back();
}

bool Parser::at_text(std::string_view name, std::size_t ahead) const {
  return at_kind(TokenKind::Name, ahead) && token(ahead).text == name;
}

bool Parser::at_name(std::size_t ahead) const { return at_kind(TokenKind::Name, ahead) && at_word(Word::None, ahead); }

// A sign that ends an expression, and never begins one.
bool Parser::at_closing() const { return at(".") || at(")") || at(",") || at("}") || at("]") || at(":") || at_end(); }

void Parser::advance() {
  if (!at_end()) ++pos_;
}

bool Parser::accept(std::string_view text) {
  if (!at(text)) return false;
  advance();
  return true;
}

void Parser::expect(std::string_view text, std::string_view where) {
  if (!accept(text)) fail_expected(fmt::format("'{}' {}", text, where));
}

// A reserved word or constant in a name's place is reported and taken as the name, so that the rest can be read.
std::string Parser::expect_name(std::string_view what, Span& span) {
  if (!at_kind(TokenKind::Name)) fail_expected(fmt::format("the name of {}", what));
  const std::string name(token().text);
  span = token().span;
  if (item().word != Word::None) {
    error(span, "reserved-word", fmt::format("'{}' is a reserved word and cannot name {}", name, what),
          "choose another name");
    misused_.insert(item().word);
  } else if (constant_named(name) != nullptr) {
    error(span, "constant-as-name", fmt::format("'{}' is a constant (from @define) and cannot name {}", name, what),
          "choose another name");
  }
  advance();
  return name;
}

bool Parser::at_member_header(std::size_t ahead) const {
  if (!(at("+", ahead) || at("-", ahead) || at("=", ahead))) return false;
  return at_text("to", ahead + 1) && at_kind(TokenKind::Name, ahead + 2);
}

// In the middle of a statement: a header on a line of its own ends the statement, whose period is missing.
bool Parser::at_run_on_header() const {
  return token().starts_line && at_member_header() && (at(":", 3) || at_name(3));
}

bool Parser::at_variables_header(std::size_t ahead) const {
  return (at("+", ahead) || at("-", ahead) || at("=", ahead)) && at_text("variables", ahead + 1) &&
         (at(":", ahead + 2) || (token(ahead).starts_line && token(ahead + 2).starts_line));
}

bool Parser::at_class_header(std::size_t ahead) const {
  if (!at_name(ahead) || !at(":", ahead + 1) || !at_kind(TokenKind::Name, ahead + 2)) return false;
  return at("{", ahead + 3) || (at("(", ahead + 3) && at_word(Word::Aka, ahead + 4)) ||
         (at("[", ahead + 3) && at_word(Word::Version, ahead + 4));
}

// Constants of the program's files are invisible in the class library's files.
const ast::Constant* Parser::constant_named(std::string_view name) const { return defines_.find(name, embedded_); }

std::string Parser::describe(std::size_t ahead) const {
  const Token& what = token(ahead);
  const std::string text(what.text.size() > 60 ? what.text.substr(0, 60) : what.text);
  switch (what.kind) {
    case TokenKind::End: return "the end of the text";
    case TokenKind::Int:
    case TokenKind::Double: return fmt::format("the number {}", text);
    case TokenKind::String: return "a string";
    case TokenKind::Name:
      return item(ahead).word == Word::None ? fmt::format("'{}'", text) : fmt::format("the reserved word '{}'", text);
    default: return fmt::format("'{}'", text);
  }
}

Span Parser::span_from(std::size_t start) const {
  Span span = items_[start].token->span;
  const Span& last = previous().span;
  if (pos_ > start) span.length = last.offset + last.length - span.offset;
  return span;
}

Span Parser::after_previous() const {
  if (pos_ == 0) return token().span;
  const Span& last = previous().span;
  return sources_.span_at(last.file, last.offset + last.length, 0);
}

// One error a place: what follows from an error says nothing new.
void Parser::report(Diagnostic diagnostic) {
  const bool again = errors_ > 0 && diagnostic.span.offset == last_error_offset_;
  if (again || cut_off_ || garbled_lines_.contains(diagnostic.span.line)) return;
  last_error_offset_ = diagnostic.span.offset;
  ++errors_;
  if (errors_ > kMaxErrorsPerFile) return;
  if (errors_ == kMaxErrorsPerFile) {
    diagnostic.code = "too-many-errors";
    diagnostic.message = "too many errors; the rest is not shown";
    diagnostic.help.clear();
  }
  diagnostics_.add(std::move(diagnostic));
}

void Parser::error(const Span& span, std::string code, std::string message, std::string help) {
  report({Severity::Error, std::move(code), std::move(message), std::move(help), span});
}

void Parser::lint(const Span& span, std::string code, std::string message, std::string help) {
  if (++lints_ > kMaxErrorsPerFile) return;
  diagnostics_.warning(span, std::move(code), std::move(message), std::move(help));
}

void Parser::fail(const Span& span, std::string code, std::string message, std::string help) const {
  throw SyntaxError{{Severity::Error, std::move(code), std::move(message), std::move(help), span}};
}

void Parser::fail_expected(std::string_view what, std::string help) const {
  fail(token().span, "syntax", fmt::format("expected {}, got {}", what, describe()), std::move(help));
}

// Something that was left out: the place is the end of what stands before it.
// @param what  the construct that lacks it: "this statement"
void Parser::missing(std::string_view text, std::string_view what, std::string help) {
  const bool period = text == ".";
  if (help.empty()) {
    const std::string_view kind = what.substr(what.find(' ') + 1);
    help = period ? fmt::format("a {} ends with a period: write '.' here", kind) : fmt::format("write '{}' here", text);
  }
  error(after_previous(), period ? "missing-period" : "missing-colon",
        period ? fmt::format("the period at the end of {} is missing", what)
               : fmt::format("the ':' after {} is missing", what),
        std::move(help));
}

}  // namespace breve::steve
