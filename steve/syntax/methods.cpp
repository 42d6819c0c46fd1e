// Methods: header, parameters, locals, body; and the types and literal constants that declarations are made of.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "steve/syntax/parser_nodes.hpp"

namespace breve::steve {

namespace {

using ast::TypeKind;

std::optional<TypeKind> type_of(Word word) {
  switch (word) {
    case Word::Int: return TypeKind::Int;
    case Word::Double:
    case Word::Float: return TypeKind::Double;
    case Word::Vector: return TypeKind::Vector;
    case Word::Matrix: return TypeKind::Matrix;
    case Word::Object: return TypeKind::Object;
    case Word::Pointer: return TypeKind::Pointer;
    case Word::List: return TypeKind::List;
    case Word::String: return TypeKind::String;
    case Word::Data: return TypeKind::Data;
    case Word::Hash: return TypeKind::Hash;
    default: return std::nullopt;
  }
}

std::optional<TypeKind> element_type_of(Word plural) {
  switch (plural) {
    case Word::Ints: return TypeKind::Int;
    case Word::Doubles:
    case Word::Floats: return TypeKind::Double;
    case Word::Vectors: return TypeKind::Vector;
    case Word::Matrices: return TypeKind::Matrix;
    case Word::Objects: return TypeKind::Object;
    case Word::Pointers: return TypeKind::Pointer;
    case Word::Lists: return TypeKind::List;
    case Word::Strings: return TypeKind::String;
    case Word::Hashes: return TypeKind::Hash;
    default: return std::nullopt;
  }
}

const std::vector<std::string_view> kTypeNames{"int",     "double", "float",  "vector", "matrix", "object",
                                               "pointer", "list",   "string", "data",   "hash"};

}  // namespace

void Parser::method(ast::Class& owner) {
  const std::size_t start = pos_;
  ast::Method& result = owner.methods.emplace_back();
  result.is_public = at("+");
  late_locals_.clear();
  method_header(result);
  try {
    body(result);
  } catch (const SyntaxError& problem) {
    // Too deep: nothing in this method is worth reading on.
    report(problem.diagnostic);
    while (!at_end() && pos_ != class_close_ && !(token().starts_line && (at_member_header() || at_class_header()))) {
      advance();
    }
  }
  for (ast::Variable& late : late_locals_) result.locals.push_back(std::move(late));
  result.span = span_from(start);
}

void Parser::method_header(ast::Method& result) {
  bool foreign = false;
  if (at_member_header()) {
    advance();
    advance();
  } else {
    report_broken_header();
    foreign = at_name() && !at_text("to");
    advance();
  }
  result.name_span = token().span;
  header_colon_ = method_brace_ = false;
  try {
    result.name = expect_name("a method", result.name_span);
    header_parentheses(result.name, foreign);
    while (!at(":") && !header_colon_ && !method_brace_ && !at("{")) {
      // A local or a statement on the next line: the colon was forgotten.
      const bool parameter_follows = at_kind(TokenKind::Name) && at_kind(TokenKind::Name, 1) && !at_statement_word(0);
      if (token().starts_line && !parameter_follows) break;
      parameter(result);
    }
    if (at("{") && item().block_like) {
      error(token().span, "method-header", "the header of a method is not followed by '{'",
            "write ':'; a method ends where the next one begins");
      method_brace_ = true;
      advance();
    } else if (!header_colon_ && !method_brace_ && !accept(":")) {
      missing(":", "the header of this method");
    }
  } catch (const SyntaxError& problem) {
    report(problem.diagnostic);
    // On to the colon, unless it stands before the type of a parameter, or a statement comes first.
    const auto body_begins = [&] {
      return token().starts_line &&
             (at_member_header() || at_statement_word(0) || at_word(Word::Self) || at_word(Word::Super));
    };
    while (!at_end() && !at(".") && !at("}") && !body_begins() && (!at(":") || at_type(1))) advance();
    if (!accept(":")) accept(".");
  }
}

// keyword variable [= literal] (type)
void Parser::parameter(ast::Method& result) {
  ast::Parameter parameter;
  const Span location = token().span;
  parameter.keyword = expect_name("a keyword", parameter.keyword_span);
  if (at("(") || at("=")) {
    error(location, "syntax", fmt::format("the parameter '{}' needs a variable after its keyword", parameter.keyword),
          fmt::format("callers write the keyword, the body uses the variable; they may be the same: {0} {0} (type)",
                      parameter.keyword));
    parameter.variable = parameter.keyword;
    parameter.variable_span = parameter.keyword_span;
  } else {
    parameter.variable = expect_name("a parameter", parameter.variable_span);
  }
  if (accept("=")) parameter.default_value = constant();
  if (at(":") && at_type(1)) {
    error(token().span, "method-header", "the ':' of a method header comes after the types of its parameters",
          fmt::format("write: {} {} (type):", parameter.keyword, parameter.variable));
    advance();
    header_colon_ = true;
  }
  if (at(":") || (at_name() && at_name(1))) {
    error(after_previous(), "missing-type", fmt::format("the parameter '{}' needs a type", parameter.variable),
          fmt::format("for example: {} {} (float)", parameter.keyword, parameter.variable));
    parameter.type.broken = true;
  } else {
    parameter.type = type();
  }
  result.parameters.push_back(std::move(parameter));
}

void Parser::body(ast::Method& result) {
  if (at("@") && at_text("native", 1)) return native_body(result);
  const std::size_t errors = errors_;
  while (at_declaration() || at_foreign_declaration()) {
    const std::size_t start = pos_;
    try {
      declaration(result.locals, "a variable");
    } catch (const SyntaxError& problem) {
      report(problem.diagnostic);
      skip_statement(start);
      if (pos_ == start) advance();
    }
  }
  read_statements(result.body);
  if (method_brace_) accept("}");
  while (stray_brace() && (pos_ != class_close_ || more_braces_close())) {
    error(token().span, "stray-brace", "unmatched '}'", "remove it, or look for a missing '{' above");
    advance();
    read_statements(result.body);
  }
  result.broken = errors_ > errors;
}

// @native "name" (type).  @native "name" (?).  @native "name".
void Parser::native_body(ast::Method& result) {
  if (!embedded_) error(token().span, "syntax", "'@native' is possible only in the class library");
  advance();
  advance();
  if (!at_kind(TokenKind::String)) fail_expected("the quoted name of a native function");
  result.native = std::string(token().text);
  advance();
  if (at("(") && at("?", 1)) {
    advance();
    advance();
    expect(")", "after '?'");
    result.native_dynamic = true;
  } else if (at("(")) {
    result.native_result = type();
  }
  expect_period(pos_);
}

// A type in parentheses, rather than the arguments of a function?
bool Parser::at_type(std::size_t ahead) const {
  if (!at("(", ahead)) return false;
  const Word first = item(ahead + 1).word;
  const Word second = item(ahead + 2).word;
  if (type_of(first) || element_type_of(first)) return at(")", ahead + 2);
  if (at_kind(TokenKind::Name, ahead + 1)) return type_of(second) || element_type_of(second);
  if (!at_kind(TokenKind::Int, ahead + 1)) return false;
  if (type_of(second) || element_type_of(second)) return true;
  return at_name(ahead + 2) && (at_word(Word::Objects, ahead + 3) || at_word(Word::Object, ahead + 3));
}

// name {, name} (type)
bool Parser::at_declaration() const {
  if (!at_kind(TokenKind::Name) || at_statement_word(0)) return false;
  std::size_t ahead = 1;
  while (at(",", ahead) && at_kind(TokenKind::Name, ahead + 1)) ahead += 2;
  return at_type(ahead) || (ahead > 1 && at("(", ahead));
}

void Parser::declaration(std::vector<ast::Variable>& into, std::string_view what) {
  const std::size_t first = into.size();
  do {
    ast::Variable variable;
    variable.name = expect_name(what, variable.span);
    into.push_back(std::move(variable));
  } while (accept(","));
  ast::TypeRef declared;
  declared.broken = true;
  for (std::size_t i = first; i < into.size(); ++i) into[i].type = declared;
  if (at("=")) {
    fail(token().span, "initial-value", "variables have no initial values",
         "assign the value in a method, for instance variables in 'init'");
  }
  if (at(".") || at(";")) {
    error(after_previous(), "missing-type", fmt::format("the variable '{}' needs a type", into.back().name),
          fmt::format("for example: {} (float).", into.back().name));
    advance();
    return;
  }
  declared = type();
  if (at("=")) {
    for (std::size_t i = first; i < into.size(); ++i) into[i].type = declared;
    fail(token().span, "initial-value", "variables have no initial values",
         "assign the value in a method, for instance variables in 'init'");
  }
  for (std::size_t i = first; i < into.size(); ++i) into[i].type = declared;
  if (accept(".")) return;
  if (at(";")) return semicolon();
  if (!(token().starts_line || at("}") || at_end())) fail_expected("'.' after this declaration");
  missing(".", "this declaration");
}

// (int), (object), (Name object), (5 ints), (5 Name objects)
ast::TypeRef Parser::type() {
  const std::size_t start = pos_;
  if (at("["))
    fail(token().span, "unknown-type", "the size of an array stands in its type, not behind its name",
         "write: name (10 ints), or name (list) for an array that grows");
  if (!at("(")) fail_expected("a type in parentheses", "for example (int), (vector) or (Name object)");
  advance();
  ast::TypeRef result;
  if (embedded_ && accept("?")) {
    result.dynamic = true;
  } else if (at_kind(TokenKind::Int)) {
    result = array_type();
  } else if (const std::optional<TypeKind> simple = type_of(item().word)) {
    result.kind = *simple;
    advance();
  } else if (at_name() && at_word(Word::Object, 1)) {
    result.kind = TypeKind::Object;
    result.class_name = token().text;
    advance();
    advance();
  } else {
    broken_type(result);
  }
  expect(")", "after the type");
  result.span = span_from(start);
  return result;
}

ast::TypeRef Parser::array_type() {
  ast::TypeRef result;
  result.array_size = token().int_value;
  advance();
  if (at_name()) {
    result.class_name = token().text;
    advance();
    if (!at_word(Word::Objects)) fail_expected("'objects' after the name of the class", "for example (3 Name objects)");
  }
  const std::optional<TypeKind> element = element_type_of(item().word);
  if (!element) {
    if (at_word(Word::Data)) fail(token().span, "unknown-type", "there are no arrays of data", "use a list");
    fail_expected("the plural of a type", "for example (3 ints), (3 vectors) or (3 objects)");
  }
  result.kind = *element;
  advance();
  return result;
}

// Something in the parentheses of a type that is not a type: reported, and read as far as the ')'.
void Parser::broken_type(ast::TypeRef& result) {
  result.broken = true;
  const Span location = token().span;
  if (!at_kind(TokenKind::Name)) fail_expected("a type", "for example (int), (vector) or (Name object)");
  if (element_type_of(item().word) || (at_word(Word::Objects, 1) && constant_named(token().text) == nullptr)) {
    error(location, "unknown-type", "an array needs a number of elements", "for example (5 ints) or (5 Name objects)");
  } else if (at_name() && element_type_of(item(1).word)) {
    error(location, "unknown-type", fmt::format("the size of an array is an integer literal, got '{}'", token().text),
          "constants from @define cannot be used here");
  } else {
    const std::string_view text = token().text;
    const std::string near = nearest(text, kTypeNames);
    const std::string_view foreign = foreign_type(text);
    error(location, "unknown-type", fmt::format("unknown type {}", describe()),
          !foreign.empty() ? std::string(foreign)
          : near.empty()   ? fmt::format("for an object of a class write ({} object)", token().text)
                           : fmt::format("did you mean '{}'?", near));
  }
  while (!at(")") && !at_end() && !at(".") && token().span.line == location.line) advance();
}

// A literal: number with an optional sign, string, vector or matrix of numbers.
ast::Constant Parser::constant() {
  const std::size_t start = pos_;
  ast::Constant result;
  if (at_kind(TokenKind::String)) {
    result.value = std::string(token().text);
    advance();
  } else if (at("(")) {
    result.value = number_row("in a constant vector");
  } else if (accept("[")) {
    std::array<double, 9> elements{};
    for (std::size_t row = 0; row < 3; ++row) {
      if (row > 0) expect(",", "between the rows of a matrix");
      const std::array<double, 3> values = number_row("in a constant matrix");
      for (std::size_t i = 0; i < 3; ++i) elements[3 * row + i] = values[i];
    }
    expect("]", "after the third row of the matrix");
    result.value = elements;
  } else {
    const bool integer = at_kind(TokenKind::Int, at("-") ? 1 : 0);
    const double value = number("as a constant");
    if (integer) {
      result.value = static_cast<std::int32_t>(value);
    } else {
      result.value = value;
    }
  }
  result.span = span_from(start);
  return result;
}

double Parser::number(std::string_view where) {
  const bool negative = accept("-");
  if (at_name() && constant_named(token().text) != nullptr) {
    fail_expected(fmt::format("a literal {}", where), "constants from @define cannot be used here");
  }
  const bool integer = at_kind(TokenKind::Int);
  if (!integer && !at_kind(TokenKind::Double)) {
    fail_expected(fmt::format("a literal {}", where), "a number, a string, a vector or a matrix of numbers");
  }
  // 2147483648 is scanned as the least integer, and is valid with a sign only.
  const double magnitude = integer ? std::abs(static_cast<double>(token().int_value)) : token().double_value;
  advance();
  if (integer && at_fraction_point()) advance();
  return negative ? -magnitude : magnitude;
}

std::array<double, 3> Parser::number_row(std::string_view where) {
  std::array<double, 3> row{};
  expect("(", "before three numbers");
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0) expect(",", "between numbers");
    row[i] = number(where);
  }
  expect(")", "after three numbers");
  return row;
}

}  // namespace breve::steve
