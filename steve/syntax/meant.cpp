// What a beginner meant by a statement that cannot be read: a call without its object, a variable of another object
// without '::', a size without bars, a word of the language in capitals. Asked where the grammar has failed, so that it
// may look at the whole file.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "steve/syntax/parser_nodes.hpp"

namespace breve::steve {

namespace {

constexpr std::size_t kLongestQuote = 60;  // bytes of the program that a help repeats

bool begins_value(const TokenKind kind) {
  return kind == TokenKind::Int || kind == TokenKind::Double || kind == TokenKind::String;
}

// `0x10` as 16, `0b101` as 5, `0o17` as 15; nothing if `letters` are not digits of that base.
std::optional<std::uint32_t> in_base(std::string_view letters) {
  const int base = letters.front() == 'x' || letters.front() == 'X'   ? 16
                   : letters.front() == 'b' || letters.front() == 'B' ? 2
                   : letters.front() == 'o' || letters.front() == 'O' ? 8
                                                                      : 0;
  std::uint32_t value = 0;
  const char* const last = letters.data() + letters.size();
  if (base == 0 || letters.size() < 2) return std::nullopt;
  const auto [end, problem] = std::from_chars(letters.data() + 1, last, value, base);
  return end == last && problem == std::errc{} ? std::optional(value) : std::nullopt;
}

// What to write in place of a number with letters directly behind it.
std::string number_help(std::string_view digits, std::string_view letters) {
  const std::string_view kinds = "fFdDlLuU";
  if (const auto value = digits == "0" ? in_base(letters) : std::nullopt)
    return fmt::format("numbers are decimal: write {}", *value);
  if (letters.find_first_not_of("_0123456789") == std::string_view::npos) {
    std::string plain(digits);
    for (const char c : letters)
      if (c != '_') plain += c;
    return fmt::format("the digits of a number are not grouped: write {}", plain);
  }
  if (letters.size() == 1 && kinds.find(letters) != std::string_view::npos)
    return fmt::format("a number has no letter for its type: write {}", digits);
  if (letters == "e" || letters == "E")
    return fmt::format("the exponent has no digits: write for example {}e3", digits);
  return "an operator is missing between the number and the name: for a product write *";
}

}  // namespace

// The names that the file declares as variables, parameters or methods, in whatever class.
const Parser::FileNames& Parser::names_of_file() {
  if (file_names_) return *file_names_;
  FileNames& names = file_names_.emplace();
  const std::size_t here = pos_;
  for (pos_ = 0; !at_end(); ++pos_) {
    if (at_member_header()) names.methods.insert(token(2).text);
    if (!at_type(1)) continue;
    const bool sized = item(2).word == Word::List || item(2).word == Word::String;
    std::size_t last = pos_;  // of `a, b (type)` and `p = 2.5 (type)`
    if (!at_name() && last >= 2 && items_[last - 1].sign == sign("=")) last -= 2;
    while (items_[last].token->kind == TokenKind::Name) {
      names.variables.insert(items_[last].token->text);
      (sized ? names.sized : names.unsized).insert(items_[last].token->text);
      if (last < 2 || items_[last - 1].sign != sign(",")) break;
      last -= 2;
    }
  }
  pos_ = here;
  return names;
}

// Any name may be one of a session. Classes of the library give their children one variable. Other languages' names
// for the object itself are reported where names are looked up.
bool Parser::is_variable(const Token& name) {
  return interactive_ || name.text == "controller" || name.text == "this" || name.text == "me" ||
         names_of_file().variables.contains(name.text) || constant_named(name.text) != nullptr;
}

bool Parser::is_variable_only(std::string_view name) {
  const FileNames& names = names_of_file();
  return names.variables.contains(name) && !names.methods.contains(name);
}

bool Parser::is_sized(std::string_view name) {
  const FileNames& names = names_of_file();
  return names.sized.contains(name) && !names.unsized.contains(name);
}

// The text of the program from one item to in front of another.
std::string Parser::source_of(std::size_t first, std::size_t end) const {
  const Span& from = items_[first].token->span;
  const Span& last = items_[end - 1].token->span;
  std::string text = sources_.file(from.file).text.substr(from.offset, last.offset + last.length - from.offset);
  if (text.size() > kLongestQuote || text.find('\n') != std::string::npos)
    text = fmt::format("{} ...", items_[first].token->text);
  return text;
}

// The same of an expression, however it was read.
std::string Parser::text_of(const ast::Expr& expression) const {
  const Span& span = expression.span;
  std::string text = sources_.file(span.file).text.substr(span.offset, span.length);
  if (text.size() > kLongestQuote || text.find('\n') != std::string::npos) text = "...";
  return text;
}

// The name in front of the dot that stands, without spaces, in front of this word; "" if there is none.
std::string_view Parser::before_dot(std::size_t word) const {
  if (word < 2 || items_[word - 1].sign != sign(".") || items_[word].token->space_before) return {};
  const Token& name = *items_[word - 2].token;
  return name.kind == TokenKind::Name && !items_[word - 1].token->space_before ? name.text : std::string_view();
}

// `k.pop()`, `k.sort()`, `k.remove(1)`: what works on a list stands in front of it. The current item is behind the
// word.
void Parser::refuse_dotted(std::size_t word) const {
  const std::string_view list = before_dot(word);
  if (list.empty() || !at("(")) return;
  const std::string_view name = items_[word].token->text;
  std::string help;
  switch (items_[word].word) {
    case Word::Push:
    case Word::Prepend: return;  // their value is known once it is read
    case Word::Insert: help = fmt::format("write: insert value at {}{{position}}", list); break;
    case Word::Remove: help = fmt::format("write: remove {}{{position}}", list); break;
    case Word::Sort: help = fmt::format("write: sort {} with method-name", list); break;
    default: help = fmt::format("write: {} {}", name, list); break;
  }
  fail(items_[word].token->span, "list-word", fmt::format("'{}' comes before the list, without a dot", name), help);
}

// The item that ends the statement around the current one, or its line.
std::size_t Parser::statement_end() const {
  std::size_t i = pos_;
  int open = 0;
  for (; items_[i].token->kind != TokenKind::End && items_[i].token->span.line == token().span.line; ++i) {
    const std::uint16_t s = items_[i].sign;
    if (s == sign("(") || s == sign("{") || s == sign("[")) ++open;
    if ((s == sign(")") || s == sign("}") || s == sign("]")) && --open < 0) break;
    if (open == 0 && (s == sign(".") || s == sign(";") || s == sign(":") || s == sign(","))) break;
  }
  return i;
}

// Is the receiver of the call that was read last a name that nothing in this file declares?
bool Parser::lacks_self() {
  const Item& receiver = items_[call_start_];
  return call_method_ == call_start_ + 1 && receiver.token->kind == TokenKind::Name && receiver.word == Word::None &&
         !is_variable(*receiver.token);
}

Diagnostic Parser::without_self() {
  const Token& name = *items_[call_start_].token;
  const bool tells = name.text == "tell" || name.text == "ask";
  if (tells && items_[call_method_ + 1].token->kind == TokenKind::Name) {
    const std::size_t method = call_method_ + (items_[call_method_ + 1].token->text == "to" ? 2 : 1);
    return {Severity::Error, "foreign-statement", fmt::format("there is no '{}'", name.text),
            fmt::format("a call begins with the object: {} {}", items_[call_method_].token->text,
                        source_of(method, std::max(statement_end(), method + 1))),
            name.span};
  }
  const std::string call = source_of(call_start_, std::max(statement_end(), call_method_ + 1));
  const bool method = names_of_file().methods.contains(name.text);
  return {Severity::Error, "call-without-object",
          method ? fmt::format("'{}' is a method: a call begins with the object that is called", name.text)
                 : fmt::format("a call begins with an object, and '{}' is not a variable here", name.text),
          fmt::format("to call a method of the object itself write: self {}", call), name.span};
}

// `0x10`, `1_000`, `1.5f`: letters directly behind a number.
std::optional<Diagnostic> Parser::meant_by_number() const {
  if (pos_ == 0 || token().space_before || !at_kind(TokenKind::Name)) return std::nullopt;
  const Token& number = previous();
  if (number.kind != TokenKind::Int && number.kind != TokenKind::Double) return std::nullopt;
  Span where = number.span;
  where.length += token().span.length;
  return Diagnostic{Severity::Error, "foreign-number", fmt::format("'{}{}' is not a number", number.text, token().text),
                    number_help(number.text, token().text), where};
}

// What statements of other languages are written as. The first word is not a variable, and what follows it cannot be
// read as a call.
std::optional<Diagnostic> Parser::meant_by_foreign_statement(std::size_t start) {
  struct Habit {
    std::string_view words, help;  // with a blank before and behind each word
  };
  static constexpr Habit kStatements[] = {
      {" assert ", "write: if !(condition): die \"what is wrong\"."},
      {" throw raise error ", "a program is stopped with an error by: die \"what is wrong\"."},
      {" repeat loop times forever ", "a loop that counts is written: for i = 0, i < 10, i++: ..."},
      {" unless ", "write: if !(condition): ..."},
      {" until ", "write: while !(condition): ..."},
      {" wait pause delay ", "to do something later write: self schedule method-call \"name\" at-time time."},
      {" static global extern ", "what several methods use is declared under '+ variables:' of the class"},
      {" try catch except ", "errors cannot be caught: test with 'if' what could go wrong"},
      {" case when ", "write: if value == 1: ... else if value == 2: ..."},
      {" create spawn sprout ",
       "objects are made with 'new': variable = new Class, or several: variable = 10 new Class"},
  };
  const Token& first = *items_[start].token;
  const auto made = [&](std::string help) {
    return Diagnostic{Severity::Error, "foreign-statement", fmt::format("there is no statement '{}'", first.text),
                      std::move(help), first.span};
  };
  for (const Habit& habit : kStatements)
    if (habit.words.find(fmt::format(" {} ", first.text)) != std::string_view::npos)
      return made(std::string(habit.help));
  if (pos_ != start + 1 || !begins_value(token().kind)) return std::nullopt;
  const std::string value = source_of(pos_, std::max(statement_end(), pos_ + 1));
  if (first.text.starts_with("create-")) return made(fmt::format("write: list = {} new Class", value));
  return made(fmt::format("a method of the object itself is called as: self {} keyword {}", first.text, value));
}

// `Print 3`, `If n == 3:`, `println "x"`, `ask Bugs: ...`, `set n 3`.
std::optional<Diagnostic> Parser::meant_by_first_word(std::size_t start) {
  const Token& first = *items_[start].token;
  if (first.kind != TokenKind::Name || items_[start].word != Word::None || is_variable(first)) return std::nullopt;
  const auto made = [&](std::string message, std::string help) {
    return Diagnostic{Severity::Error, "foreign-statement", std::move(message), std::move(help), first.span};
  };
  if (const std::string small = reserved_in_small(first.text); !small.empty())
    return made(fmt::format("the keyword '{}' is written in lower case", small), fmt::format("write: {} ...", small));
  if (names_a_print(first.text) && pos_ == start + 1)
    return made(fmt::format("there is no '{}'", first.text),
                fmt::format("write: print {}", source_of(pos_, std::max(statement_end(), pos_ + 1))));
  if (first.text == "ask" && (at(":") || at("[") || at("{")))
    return made("there is no 'ask': a call of a list of objects reaches all of them",
                fmt::format("write: (all {0}) method.   or: foreach item in (all {0}): {{ ... }}", previous().text));
  if (names_a_push(first.text) && pos_ == start + 1 && begins_value(token().kind))
    return made(fmt::format("a value is put into a list with 'push', not '{}'", first.text),
                "write: push value onto list");
  if (first.text.size() <= 2 && at_kind(TokenKind::String) && adjacent(0) && pos_ == start + 1)
    return made("a string has no letter in front", "a value is put into a text with its name and a '$': \"$n\"");
  if ((first.text == "set" || first.text == "let") && pos_ == start + 2 && begins_value(token().kind))
    return made(fmt::format("there is no '{}'", first.text),
                fmt::format("to give a variable a value write: {} = {}", previous().text,
                            source_of(pos_, std::max(statement_end(), pos_ + 1))));
  return meant_by_foreign_statement(start);
}

// A value where a keyword should be: `k add 2`, `work at 3`, `self take it new Bug with-energy 3.0`.
std::optional<Diagnostic> Parser::meant_by_value(std::size_t) {
  const bool value = begins_value(token().kind) || at("(") || at("|") || at("{");
  if (call_end_ != pos_ || pos_ == 0 || !value) return std::nullopt;
  if (at_kind(TokenKind::Double) && token().text.front() == '.') return std::nullopt;
  if (call_new_ != 0) return needs_parentheses(call_new_, call_new_ + 2, std::max(statement_end(), pos_ + 1));
  if (lacks_self() && previous().kind == TokenKind::Name) return without_self();
  if (call_method_ + 1 != pos_ || !names_a_push(call_name_)) return std::nullopt;
  const Token& method = *items_[call_method_].token;
  return Diagnostic{Severity::Error, "list-word",
                    fmt::format("a value is put into a list with 'push', not '{}'", method.text),
                    fmt::format("write: push {} onto {}", source_of(pos_, std::max(statement_end(), pos_ + 1)),
                                source_of(call_start_, call_method_)),
                    method.span};
}

// `b energy = 3.0`, `Bug b = new Bug`.
std::optional<Diagnostic> Parser::meant_by_assignment() {
  const bool call = call_end_ == pos_ && pos_ > 0 && call_method_ + 1 == pos_;
  if (!call || !(at("=") || (at_assignment(0) && !at("::") && !at("{") && !at("[") && !at("(")))) return std::nullopt;
  const Item& receiver = items_[call_start_];
  const Token& name = previous();
  Span location = receiver.token->span;
  location.length = name.span.offset + name.span.length - location.offset;
  const std::string rest = source_of(pos_, std::max(statement_end(), pos_ + 1));
  if (receiver.word == Word::Self)
    return Diagnostic{Severity::Error, "foreign-member", "a variable of the object itself is written without 'self'",
                      fmt::format("write: {} {}", name.text, rest), location};
  if (lacks_self() && receiver.token->text.front() >= 'A' && receiver.token->text.front() <= 'Z')
    return Diagnostic{
        Severity::Error, "foreign-declaration", "a variable is declared with its type after it",
        fmt::format("write at the beginning of the method: {} ({} object).", name.text, receiver.token->text),
        location};
  const std::string object = source_of(call_start_, call_method_);
  const std::string_view space = rest.starts_with("++") || rest.starts_with("--") ? "" : " ";
  return Diagnostic{Severity::Error, "foreign-member", "a variable of another object is written with '::'",
                    fmt::format("write: {}::{}{}{}", object, name.text, space, rest), location};
}

// An operator that no value begins with?
bool Parser::at_binary_operator() const {
  switch (item().sign) {
    case sign("+"):
    case sign("*"):
    case sign("/"):
    case sign("%"):
    case sign("^"):
    case sign("<"):
    case sign("<="):
    case sign(">"):
    case sign(">="):
    case sign("=="):
    case sign("!="): return true;
    default: return false;
  }
}

// `x = b energy + 1`: a call is the right side of an assignment, and an operator follows it.
std::optional<Diagnostic> Parser::meant_by_operator(std::size_t start) {
  const bool operates = at("-") || at_binary_operator();
  if (call_end_ != pos_ || pos_ == 0 || call_start_ == start || !operates) return std::nullopt;
  if (auto meant = meant_by_access(call_start_, call_method_)) return meant;
  return needs_parentheses(call_start_, call_method_, pos_);
}

// `k push 4`, `k pop`: the words for lists stand in front.
std::optional<Diagnostic> Parser::meant_by_list_word(std::size_t start) {
  if (primary_start_ != start || primary_end_ != pos_ || pos_ == 0) return std::nullopt;
  const std::string list = source_of(start, pos_);
  const std::size_t end = statement_end();
  const std::string value = end > pos_ + 1 ? source_of(pos_ + 1, end) : "value";
  std::string help;
  switch (item().word) {
    case Word::Push:
    case Word::Prepend: help = fmt::format("write: {} {} onto {}", token().text, value, list); break;
    case Word::Insert: help = fmt::format("write: insert value at {}{{position}}", list); break;
    case Word::Remove: help = fmt::format("write: remove {}{{position}}", list); break;
    case Word::Pop:
    case Word::Unprepend: help = fmt::format("write: {} {}", token().text, list); break;
    case Word::Sort: help = fmt::format("write: sort {} with method-name", list); break;
    default: return std::nullopt;
  }
  return Diagnostic{Severity::Error, "list-word", fmt::format("'{}' comes before the list", token().text), help,
                    token().span};
}

// `b energy` and `k length` where a value is meant: no call, but `b::energy` and `|k|`.
std::optional<Diagnostic> Parser::meant_by_access(std::size_t receiver, std::size_t selector) {
  const Token& name = *items_[selector].token;
  Span where = items_[receiver].token->span;
  where.length = name.span.offset + name.span.length - where.offset;
  if (is_variable_only(name.text))
    return Diagnostic{Severity::Error, "foreign-member", "a variable of another object is read with '::'",
                      fmt::format("write: {}::{}", source_of(receiver, selector), name.text), where};
  if (names_a_size(name.text) && !names_of_file().methods.contains(name.text))
    return Diagnostic{Severity::Error, "foreign-size", "the size of a list or of a text is written with bars",
                      fmt::format("write: |{}|", source_of(receiver, selector)), where};
  return std::nullopt;
}

// `n (integer).` at the beginning of a method: no function and no variable can be meant.
bool Parser::at_foreign_declaration() {
  return at_name() && token().starts_line && at("(", 1) && at_name(2) && at(")", 3) && at(".", 4) &&
         !foreign_type(token(2).text).empty() && constant_named(token(2).text) == nullptr &&
         !names_of_file().variables.contains(token(2).text);
}

}  // namespace breve::steve
