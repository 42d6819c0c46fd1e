// Primaries and what can follow them: {index}, ::member, and the count of `n new C`.
#include <fmt/format.h>

#include <algorithm>

#include "steve/syntax/parser_nodes.hpp"

namespace breve::steve {

namespace {

// What to write in place of `vector(1, 2, 3)` or `int(x)`. `type` is "" where nothing is called.
std::string called_type_help(std::string_view type) {
  if (type == "vector") return "a vector is written (x, y, z)";
  if (type == "list" || type == "hash") return "a list is written { a, b, c }, an empty hash or list {}";
  if (type == "string") return "a value is put into a text with its name and a '$': \"$n\"";
  if (type == "int" || type == "float" || type == "double")
    return "a number is converted where it is assigned to a variable; floor(x) and round(x) give whole numbers";
  return "reserved words cannot name variables";
}

}  // namespace

// The node just made wraps what was parsed before it, which is one level deeper now.
void Parser::deepen() {
  if (++deepest_ <= ast::kMaxNesting) return;
  throw SyntaxError{
      {Severity::Error, "nesting", "nested too deeply",
       fmt::format("at most {} levels are possible: split this into several statements", ast::kMaxNesting),
       token().span},
      true};
}

ast::ExprPtr Parser::postfix() {
  const std::size_t start = pos_;
  const int outer_deepest = deepest_;
  deepest_ = depth_;
  ast::ExprPtr result = primary();
  for (;;) {
    if (at("{") && !item().block_like && !at("}", 1)) {
      deepen();
      advance();
      ast::ExprPtr index = value();
      expect("}", "after the index");
      result = make(start, ast::IndexExpr{std::move(result), std::move(index)});
    } else if (at("::")) {
      deepen();
      result = member(start, std::move(result));
    } else if (at_word(Word::New)) {
      deepen();
      result = counted_new(start, std::move(result));
    } else {
      break;
    }
  }
  if (at("{") && at("}", 1) && !token().starts_line) {
    fail(token().span, "syntax", "the index between the braces is missing");
  }
  deepest_ = std::max(deepest_, outer_deepest);
  primary_start_ = start;
  primary_end_ = pos_;
  return result;
}

// The letters x, y and z name components in either case.
ast::ExprPtr Parser::member(std::size_t start, ast::ExprPtr base) {
  const bool blank = token().space_after;
  advance();
  if (!at_kind(TokenKind::Name)) fail_expected("the name of a member after '::'");
  if (blank) error(previous().span, "syntax", "no space is allowed after '::'", "write the name directly after it");
  const std::string_view name = token().text;
  char letter = 0;
  std::string key(name);
  if (name.size() == 1 && std::string_view("xyzXYZ").find(name[0]) != std::string_view::npos) {
    letter = name[0];
    if (letter < 'a') key[0] = static_cast<char>(letter - 'A' + 'a');
  }
  advance();
  return make(start, ast::Member{std::move(base), std::move(key), letter});
}

ast::ExprPtr Parser::counted_new(std::size_t start, ast::ExprPtr count) {
  const auto* constant = std::get_if<ast::ConstantExpr>(&count->node);
  const bool known = std::holds_alternative<ast::IntLit>(count->node) ||
                     (constant != nullptr && std::holds_alternative<std::int32_t>(constant->constant.value));
  if (!known) {
    lint(count->span, "lint-new-count", "the count is not a literal: exactly 1 gives an object, any other count a list",
         "to get a list always, push single objects onto a list");
  }
  advance();
  Span class_span;
  std::string name = class_name(class_span);
  return make(start, ast::NewExpr{std::move(name), class_span, std::move(count)});
}

std::string Parser::class_name(Span& span) { return expect_name("a class", span); }

// Signs of other languages where a value should be: `cout << n`, `<1, 2, 3>`, `"a" .. "b"`.
void Parser::foreign_sign() const {
  if (at("<") && previous_is("<"))
    fail(token().span, "foreign-operator", "'<<' is not an operator",
         "to write a line: print a, b; a power of two is written 2 ^ n");
  if (at("<")) {  // `<1, 2, 3>`
    std::size_t close = pos_ + 1;
    while (items_[close].sign != sign(">") && items_[close].sign != sign(".") &&
           items_[close].token->kind != TokenKind::End && items_[close].token->span.line == token().span.line)
      ++close;
    if (items_[close].sign == sign(">") && close > pos_ + 1) {
      std::string inside = source_of(pos_ + 1, close);
      if (inside.find(',') == std::string::npos) std::replace(inside.begin(), inside.end(), ' ', ',');
      fail(token().span, "foreign-vector", "a vector is written in parentheses", fmt::format("write: ({})", inside));
    }
  }
  if (at(".") && previous_is(".") && adjacent(0))
    fail(previous().span, "foreign-operator", "'..' is not an operator",
         "texts are joined in a string, by names with a '$': \"$first$second\"");
}

ast::ExprPtr Parser::primary() {
  const std::size_t start = pos_;
  switch (token().kind) {
    case TokenKind::Int: {
      const std::int32_t value = token().int_value;
      if (value < 0 && sign_at_ != pos_) {
        error(token().span, "integer-too-large", "2147483648 does not fit in an int of 32 bits (at most 2147483647)",
              "write a float, for example with '.0' after it");
      }
      advance();
      if (at_fraction_point()) {
        advance();
        return make(start, ast::DoubleLit{static_cast<double>(value)});
      }
      return make(start, ast::IntLit{value});
    }
    case TokenKind::Double: {
      const double value = token().double_value;
      advance();
      return make(start, ast::DoubleLit{value});
    }
    case TokenKind::String: return string_literal();
    case TokenKind::Name: return item().word == Word::None ? name_expression(start) : word_expression(start);
    default: break;
  }
  switch (item().sign) {
    case sign("("): return parenthesised(start);
    case sign("|"): return magnitude(start);
    case sign("{"):
      if (in_header_ && item().block_like) fail_expected("an expression");
      return list_literal(start);
    case sign("["): return matrix_literal(start);
    case sign("@@DEBUG@@"):
      advance();
      if (!at("(")) fail_expected("'(' after @@DEBUG@@");
      return parenthesised(pos_);
    case sign("||"):
      fail(token().span, "syntax", "'||' means logical or, here an expression is expected",
           "write a space between nested bars: | |a| - b |");
    case sign("@"):
      fail(token().span, "syntax", fmt::format("'@{}' is a directive, and must be outside of classes", token(1).text));
    default: break;
  }
  foreign_sign();
  const bool behind_sign =
      pos_ > 0 && previous().kind == TokenKind::Punctuation && !previous_is(".") && !previous_is("}");
  fail_expected("an expression", behind_sign
                                     ? fmt::format("a value is missing after '{}'", previous().text)
                                     : "a statement begins with a name or with a word such as if, print, return");
}

// Is this '.' part of the number before it, as in `(1., 2., 3.)` and `1. * n`? Not where it can end a statement, nor
// before '%', which may be meant to begin a comment.
bool Parser::at_fraction_point() const {
  if (!at(".") || token().space_before || at_kind(TokenKind::End, 1)) return false;
  if (at("}", 1)) {
    std::size_t open = pos_;
    while (open > 0 && items_[open].match != pos_ + 1) --open;
    return items_[open].match == pos_ + 1 && !items_[open].block_like;
  }
  if (at(")", 1) || at("]", 1) || at(",", 1)) return true;
  if (token(1).starts_line || at_member_header(1) || at_variables_header(1)) return false;
  switch (item(1).sign) {
    case sign("*"):
    case sign("/"):
    case sign("^"):
    case sign("+"):
    case sign("-"):
    case sign("<"):
    case sign("<="):
    case sign(">"):
    case sign(">="):
    case sign("=="):
    case sign("!="):
    case sign("&&"):
    case sign("||"):
    case sign(":"): return true;
    default: return false;
  }
}

ast::ExprPtr Parser::name_expression(std::size_t start) {
  std::string name(token().text);
  if (const ast::Constant* constant = constant_named(name)) {
    advance();
    return make(start, ast::ConstantExpr{*constant, std::move(name)});
  }
  advance();
  if (accept("(")) {
    std::vector<ast::ExprPtr> arguments = items(")", "after the arguments");
    return make(start, ast::FunctionCall{std::move(name), std::move(arguments)});
  }
  if (accept("[")) {
    ast::ExprPtr index = value();
    if (at(":")) fail_expected("']' after the index", "there are no slices: elements are taken one by one, list{i}");
    expect("]", "after the index");
    return make(start, ast::ArrayItem{std::move(name), std::move(index)});
  }
  return make(start, ast::Name{std::move(name)});
}

ast::ExprPtr Parser::word_expression(std::size_t start) {
  const Word word = item().word;
  if (misused_.contains(word)) return name_expression(start);
  switch (word) {
    case Word::Self: advance(); return make(start, ast::Self{});
    case Word::Super: advance(); return make(start, ast::Super{});
    case Word::Random: {
      advance();
      if (!at("[")) fail_expected("'[' after 'random'", "a random number from 0 to n is written random[n]");
      advance();
      ast::ExprPtr bound = value();
      expect("]", "after the bound of 'random'");
      return make(start, ast::RandomExpr{std::move(bound)});
    }
    case Word::All: {
      advance();
      Span class_span;
      std::string name = class_name(class_span);
      return make(start, ast::AllExpr{std::move(name), class_span});
    }
    case Word::New: {
      advance();
      if (at_kind(TokenKind::String)) {
        const Span class_span = token().span;
        std::string name(token().text);
        advance();
        return make(start, ast::NewExpr{std::move(name), class_span, nullptr});
      }
      Span class_span;
      std::string name = class_name(class_span);
      return make(start, ast::NewExpr{std::move(name), class_span, nullptr});
    }
    default: break;
  }
  const bool called = at("(", 1) || (at(")", 1) && pos_ > 0 && previous_is("("));  // `int(x)`, `(int) x`
  fail(token().span, "syntax", fmt::format("expected an expression, got the reserved word '{}'", token().text),
       starts_statement(0) ? std::string("if a statement is meant, the one before it is unfinished")
                           : called_type_help(called ? token().text : std::string_view()));
}

// (e), (method call), or the vector (e, e, e).
ast::ExprPtr Parser::parenthesised(std::size_t start) {
  advance();
  const std::size_t inner = pos_;
  if (at(")")) fail(token().span, "syntax", "there is nothing between the parentheses");
  ast::ExprPtr result = expression();
  if (at_call(inner)) {
    result = call(inner, std::move(result));
  } else if (at_stray_call()) {
    unparenthesised_call();
  }
  if (at(",")) return vector_rest(start, std::move(result));
  if (!at(")"))
    fail(token().span, "missing-parenthesis", fmt::format("a ')' is missing before {}", describe()),
         fmt::format("the '(' of line {}, column {} is still open", items_[start].token->span.line,
                     items_[start].token->span.column));
  advance();
  result->span = span_from(start);
  result->parenthesised = true;
  return result;
}

ast::ExprPtr Parser::vector_rest(std::size_t start, ast::ExprPtr x) {
  if (std::holds_alternative<ast::Call>(x->node) && !x->parenthesised) {
    error(x->span, "call-needs-parentheses", "a method call used as a component needs parentheses of its own");
  }
  expect(",", "between the components of a vector");
  ast::ExprPtr y = value();
  const bool printed = start > 0 && (items_[start - 1].word == Word::Print || items_[start - 1].word == Word::Printf);
  if (at(")"))
    fail(token().span, "syntax", "a vector has three components, this one has two",
         printed
             ? fmt::format("to print several values leave out the parentheses: {} a, b", items_[start - 1].token->text)
             : "for a flat one write (x, y, 0)");
  expect(",", "and a third component of the vector");
  ast::ExprPtr z = value();
  if (at(","))
    fail(token().span, "syntax", "a vector has three components", "a list is written in braces: {a, b, c, d}");
  expect(")", "after the third component of the vector");
  return make(start, ast::VectorLit{std::move(x), std::move(y), std::move(z)});
}

ast::ExprPtr Parser::magnitude(std::size_t start) {
  advance();
  ast::ExprPtr operand = value();
  if (at("||")) {
    fail(token().span, "syntax", "'||' means logical or and does not close bars",
         "write a space between nested bars: | |a| - |b| |");
  }
  expect("|", "to close the bars");
  return make(start, ast::Magnitude{std::move(operand)});
}

ast::ExprPtr Parser::list_literal(std::size_t start) {
  advance();
  std::size_t second = pos_;  // of a list, or the ':' of a hash as other languages write it
  if (at_kind(TokenKind::String) || at_kind(TokenKind::Int) || at_kind(TokenKind::Name)) ++second;
  if (second > pos_ && items_[second].sign == sign(":") && items_[start].match != 0) {
    error(items_[second].token->span, "foreign-hash", "a hash is not written with its entries",
          fmt::format("set its entries one by one: hash{{{}}} = value.", source_of(pos_, second)));
    pos_ = items_[start].match;
    advance();
    return make(start, ast::ListLit{{}});
  }
  std::vector<ast::ExprPtr> elements = items("}", "after the elements of the list");
  return make(start, ast::ListLit{std::move(elements)});
}

// Values with commas between them, up to the closing sign.
std::vector<ast::ExprPtr> Parser::items(std::string_view close, std::string_view where) {
  std::vector<ast::ExprPtr> result;
  const std::size_t first = pos_;
  if (accept(close)) return result;
  do {
    if (!result.empty() && at(close)) fail_expected("a value after the comma", "leave out the last comma");
    result.push_back(value());
    if (close == "}") lint_element(*result.back());
  } while (accept(","));
  if (!accept(close))
    fail_expected(fmt::format("',' or '{}' {}", close, where),
                  fmt::format("the '{}' of line {} is still open", items_[first - 1].token->text,
                              items_[first - 1].token->span.line));
  return result;
}

// `{ 1, n = 2 }`: allowed, and seldom meant.
void Parser::lint_element(const ast::Expr& element) {
  const auto* assign = std::get_if<ast::Assign>(&element.node);
  if (assign == nullptr || assign->op || element.parenthesised) return;
  lint(element.span, "lint-assignment-element", "this element of the list is an assignment",
       "to compare, write '=='; if it is meant, put it in parentheses; an entry of a hash is set by: hash{key} = "
       "value.");
}

ast::ExprPtr Parser::matrix_literal(std::size_t start) {
  advance();
  if (!at("(")) {
    std::vector<ast::ExprPtr> elements = items("]", "after the elements of the list");
    const std::string inside = elements.empty() ? "" : source_of(start + 1, pos_ - 1);
    const bool three = elements.size() == 3;
    error(items_[start].token->span, "syntax",
          three ? "a vector is written in parentheses and a list in braces, neither in brackets"
                : "a list is written in braces, not in brackets",
          three ? fmt::format("for a vector write ({0}), for a list {{ {0} }}", inside)
                : fmt::format("write: {{ {} }}; a matrix is [ (a, b, c), (d, e, f), (g, h, i) ]", inside));
    return make(start, ast::ListLit{std::move(elements)});
  }
  ast::MatrixLit matrix;
  for (std::size_t row = 0; row < 3; ++row) {
    if (row > 0) expect(",", "between the rows of a matrix");
    if (!at("(")) fail_expected("a row of the matrix", "a matrix is [ (a, b, c), (d, e, f), (g, h, i) ]");
    ast::ExprPtr vector = parenthesised(pos_);
    auto* components = std::get_if<ast::VectorLit>(&vector->node);
    if (components == nullptr || vector->parenthesised) {
      fail(vector->span, "syntax", "a row of a matrix is three numbers in parentheses",
           "a matrix is [ (a, b, c), (d, e, f), (g, h, i) ]");
    }
    matrix.elements[3 * row] = std::move(components->x);
    matrix.elements[3 * row + 1] = std::move(components->y);
    matrix.elements[3 * row + 2] = std::move(components->z);
  }
  expect("]", "after the third row of the matrix");
  return make(start, std::move(matrix));
}

}  // namespace breve::steve
