// Statements, and how parsing goes on after a broken one.
#include <fmt/format.h>

#include <algorithm>

#include "steve/syntax/parser_nodes.hpp"

namespace breve::steve {

ast::StmtPtr Parser::statement() {
  const std::size_t start = pos_;
  statement_errors_ = errors_;
  try {
    const Nest nest(*this);
    deepest_ = depth_;
    return statement_proper();
  } catch (const SyntaxError& problem) {
    if (problem.too_deep) throw;
    recover(start, problem);
    return make_statement(start, ast::Block{});
  }
}

ast::StmtPtr Parser::statement_proper() {
  const std::size_t start = pos_;
  if (at("{") && brace_opens_block()) return block(start);
  if (foreign_statement()) return make_statement(start, ast::Block{});
  switch (item().word) {
    case Word::If: return if_statement(start);
    case Word::While: return while_statement(start);
    case Word::Foreach: return foreach_statement(start);
    case Word::For:
      if (at_text("each", 1) && at_name(2) && at_text("in", 3)) return foreach_statement(start);
      return for_statement(start);
    case Word::Print:
    case Word::Printf: return print_statement(start);
    case Word::Return: {
      advance();
      ast::ExprPtr result = at(".") || at(";") || at("}") || at_end() ? nullptr : value();
      expect_period(start);
      return make_statement(start, ast::Return{std::move(result)});
    }
    case Word::Free: {
      advance();
      ast::ExprPtr what = value();
      expect_period(start);
      return make_statement(start, ast::Free{std::move(what)});
    }
    case Word::Die: {
      advance();
      if (at(".")) fail(token().span, "syntax", "'die' needs a message", "write: die \"what went wrong\".");
      ast::ExprPtr what = value();
      expect_period(start);
      return make_statement(start, ast::Die{std::move(what)});
    }
    case Word::Else:
      fail(token().span, "stray-else", "'else' without an 'if' before it",
           "only one statement is allowed between 'if' and 'else': write { } around several");
    default: return simple_statement(start);
  }
}

// A brace at a statement's beginning opens a block, unless a list literal stands there: one with commas, or one that
// more of an expression follows.
bool Parser::brace_opens_block() const {
  if (item().block_like || at("}", 1) || at_statement_word(1)) return true;
  if (item().has_comma) return false;
  if (item().match == 0) return true;
  const Item& after = items_[item().match + 1U];
  if (after.token->starts_line || after.token->kind == TokenKind::End) return true;
  if (after.token->kind == TokenKind::Name) return after.word != Word::None && after.word != Word::New;
  return after.sign == 0 || after.sign == sign("}");
}

ast::StmtPtr Parser::block(std::size_t start) {
  ast::Block node;
  advance();
  if (at("}")) {
    advance();
    accept(".");  // the empty statement may be written as the empty list it once was
    return make_statement(start, std::move(node));
  }
  read_statements(node.body);
  if (!at("}")) {
    open_brace_reported_ = true;
    const std::string reached =
        at_end() ? "the file ends" : fmt::format("line {} begins something new", token().span.line);
    error(items_[start].token->span, "missing-brace", "this '{' has no '}'",
          fmt::format("{} while its block is open: write '}}' where the block ends", reached));
    return make_statement(start, std::move(node));
  }
  advance();
  if (at(".")) {
    error(token().span, "stray-period", "the '}' of a block is not followed by '.'", "remove it");
    advance();
  }
  return make_statement(start, std::move(node));
}

// Statements up to a '}', or to what shows that it is missing.
void Parser::read_statements(std::vector<ast::StmtPtr>& into) {
  const ast::Chain* comparison = nullptr;
  while (!at("}") && !at_end() && !at_member_header() && !at_variables_header() && broken_header() == 0 &&
         !(token().starts_line && at_class_header())) {
    if (comparison != nullptr) {
      lint(comparison->operators.back(), "lint-unused-comparison", "the result of this comparison is not used",
           "to assign, write '='");
    }
    comparison = nullptr;
    if (at_declaration()) {
      misplaced_declaration();
      continue;
    }
    const std::size_t before = pos_;
    into.push_back(statement());
    if (pos_ == before) advance();
    const auto* alone = std::get_if<ast::ExprStmt>(&into.back()->node);
    if (alone == nullptr || alone->expr->parenthesised) continue;
    const auto* chain = std::get_if<ast::Chain>(&alone->expr->node);
    if (chain != nullptr && chain->rest.back().first >= ast::BinaryOp::Lt &&
        chain->rest.back().first <= ast::BinaryOp::Ne)
      comparison = chain;
  }
}

void Parser::misplaced_declaration() {
  error(token().span, "late-declaration", "variables are declared before the first statement of a method",
        "move this line to the method's beginning");
  try {
    declaration(late_locals_, "a variable");
  } catch (const SyntaxError&) {
    skip_statement(pos_);
  }
}

ast::StmtPtr Parser::if_statement(std::size_t start) {
  ast::If node;
  advance();
  for (;;) {
    ast::ExprPtr test = condition();
    expect_colon("the condition of 'if'");
    ast::StmtPtr then = statement();
    node.branches.emplace_back(std::move(test), std::move(then));
    if (at_elif()) {
      if (!elif_reported_)
        error(token().span, "foreign-statement", fmt::format("there is no '{}'", token().text),
              "write, here and wherever it occurs: else if");
      elif_reported_ = true;
      advance();
      continue;
    }
    if (!at_word(Word::Else)) break;
    advance();
    accept(":");
    if (!at_word(Word::If)) {
      node.otherwise = statement();
      break;
    }
    advance();
  }
  return make_statement(start, std::move(node));
}

ast::StmtPtr Parser::while_statement(std::size_t start) {
  advance();
  ast::ExprPtr test = condition();
  expect_colon("the condition of 'while'");
  ast::StmtPtr body = statement();
  return make_statement(start, ast::While{std::move(test), std::move(body)});
}

ast::StmtPtr Parser::for_statement(std::size_t start) {
  advance();
  if (at_c_for()) return c_for_statement(start);
  ast::For node;
  const std::string variable(at_name() ? token().text : "n");
  if (at_name() && at_text("in", 1))
    fail(items_[start].token->span, "loop", "'for' is a counting loop; use 'foreach' to iterate over a list",
         fmt::format("write: foreach {} in list: ...", variable));
  node.start = expression();
  if (at_name() && !at(","))
    fail(token().span, "loop", fmt::format("'for' has three parts with commas between them, not '{}'", token().text),
         loop_pattern(variable));
  if (at(";")) fail(token().span, "loop", "the parts of 'for' are separated by commas", loop_pattern(variable));
  expect(",", "after the start of 'for', which has three parts: start, condition, step");
  node.condition = value();
  lint_condition(*node.condition);
  expect(",", "after the condition of 'for', which has three parts: start, condition, step");
  node.step = value();
  expect_colon("the step of 'for'");
  node.body = statement();
  return make_statement(start, std::move(node));
}

ast::StmtPtr Parser::c_for_statement(std::size_t start) {
  error(token().span, "loop", "the parts of 'for' are written without parentheses, with commas between them",
        loop_pattern(at_name(1) ? token(1).text : "n"));
  pos_ += behind_parentheses(0);
  accept(":");
  ast::For node;
  node.start = make(start, ast::IntLit{0});
  node.condition = make(start, ast::IntLit{0});
  node.step = make(start, ast::IntLit{0});
  node.body = statement();
  return make_statement(start, std::move(node));
}

ast::StmtPtr Parser::foreach_statement(std::size_t start) {
  advance();
  if (items_[start].word == Word::For) advance();
  ast::Foreach node;
  if (at("("))
    fail(token().span, "loop", "'foreach' is not followed by parentheses", "write: foreach item in list: ...");
  node.variable = expect_name("the loop's variable", node.variable_span);
  if (!at_text("in")) fail_expected("'in' and a list", "write: foreach item in list: statement");
  advance();
  node.list = header_part();
  if (at(".") && at_name(1) && adjacent(0) && adjacent(1)) {
    const std::string list = text_of(*node.list), name(token(1).text);
    std::string help = fmt::format("a method is called with a space: ({} {})", list, name);
    if (name == "keys") help = fmt::format("write: keys({})", list);
    if (name == "values" || name == "items")
      help = fmt::format("write: foreach key in keys({0}): ... {0}{{key}} ...", list);
    error(token(1).span, "syntax", "nothing is called with a '.'", help);
    pos_ += std::max<std::size_t>(2, at("(", 2) ? behind_parentheses(2) : 0);
  }
  expect_colon("the list of 'foreach'");
  node.body = statement();
  return make_statement(start, std::move(node));
}

ast::StmtPtr Parser::print_statement(std::size_t start) {
  const bool newline = at_word(Word::Print);
  advance();
  if (at("."))
    fail(token().span, "syntax", fmt::format("'{}' needs at least one item", previous().text),
         "an empty line: print \"\".");
  ast::Print node{{}, newline};
  do node.items.push_back(value());
  while (accept(","));
  expect_period(start);
  return make_statement(start, std::move(node));
}

ast::StmtPtr Parser::simple_statement(std::size_t start) {
  ast::ExprPtr expr = assignment(true);
  if (at_call(start) && !run_on_call()) expr = call(start, std::move(expr));
  expect_period(start);
  return make_statement(start, ast::ExprStmt{std::move(expr)});
}

ast::ExprPtr Parser::condition() {
  ast::ExprPtr result = header_part();
  lint_condition(*result);
  return result;
}

// An assignment as a condition is allowed, and seldom meant.
void Parser::lint_condition(const ast::Expr& condition) {
  const auto* assign = std::get_if<ast::Assign>(&condition.node);
  if (assign != nullptr && !assign->op && !condition.parenthesised) {
    lint(condition.span, "lint-assignment-condition", "this condition is an assignment",
         "to compare, write '=='; if it is meant, put it in parentheses");
  }
}

// An expression of a control statement's head. If it is broken and the colon is in sight, the body can still be read.
ast::ExprPtr Parser::header_part() {
  const std::size_t start = pos_;
  try {
    in_header_ = true;
    ast::ExprPtr result = value();
    in_header_ = false;
    if (errors_ > statement_errors_ && !at(":"))  // what follows a mistake that was read over
      while (!at(":") && !at(".") && !at("{") && !at_end() && token().span.line == items_[start].token->span.line)
        advance();
    return result;
  } catch (const SyntaxError& problem) {
    in_header_ = false;
    if (problem.too_deep) throw;
    std::size_t ahead = 0;
    const std::uint32_t line = token().span.line;
    while (!at(":", ahead) && !at(".", ahead) && !at_kind(TokenKind::End, ahead) && token(ahead).span.line == line)
      ++ahead;
    const bool said = errors_ > statement_errors_;
    if (!at(":", ahead)) throw;
    if (!said) report(problem.diagnostic);
    pos_ += ahead;
    return make(start, ast::IntLit{0});
  }
}

void Parser::expect_colon(std::string_view what) {
  if (accept(":")) return;
  if (at_text("then") || at_text("do")) {
    error(token().span, "missing-colon", fmt::format("there is no '{}'", token().text), "write ':' in its place");
    advance();
    return;
  }
  if (at("|")) fail(token().span, "foreign-operator", "a single '|' is not an operator", "logical or is written ||");
  if (!(token().starts_line || at("{") || starts_statement(0)))
    fail_expected(fmt::format("':' after {}", what), at(".") && items_[pos_ + 1].token->kind == TokenKind::Double
                                                         ? "a loop that counts is written: for i = 0, i < n, i++: ..."
                                                         : "");
  missing(":", what);
}

void Parser::expect_period(std::size_t start) {
  if (at(".")) return lint_dot();
  if (at(";")) return semicolon();
  if (interactive_ && at_end()) return;
  if (!token().starts_line)
    if (auto meant = meant_by_list_word(start)) throw SyntaxError{std::move(*meant)};
  if (at_word(Word::If) && !token().starts_line) {
    std::size_t ahead = 1;
    while (!at(":", ahead) && item(ahead).word != Word::Else && !at(".", ahead) && !at_kind(TokenKind::End, ahead))
      ++ahead;
    if (item(ahead).word == Word::Else)
      fail(token().span, "foreign-operator", "an 'if' has no value",
           "write: if condition: variable = value. else variable = other.");
  }
  const bool next_begins = token().starts_line || at("}") || at_end() || (starts_statement(0) && !at_name());
  if (next_begins) return missing(".", "this statement");
  if (at("{")) open_brace_reported_ = true;
  throw SyntaxError{after_statement(start)};
}

// `leader.size` reads as a statement that ends, and another one that does nothing.
void Parser::lint_dot() {
  const bool glued = previous().kind == TokenKind::Name && !token().space_before && !token().space_after;
  if (glued && at_name(1) && at(".", 2) && token(1).span.line == token().span.line && !token(2).space_before) {
    lint(token().span, "lint-dot", "this '.' ends the statement; the rest of the line has no effect",
         names_a_size(token(1).text) && is_sized(previous().text)
             ? fmt::format("the size of a list or of a text is |{}|", previous().text)
             : fmt::format("a variable of an object is read as {}::{}", previous().text, token(1).text));
  }
  advance();
}

// A word that stands nowhere but at the beginning of a statement.
bool Parser::at_statement_word(std::size_t ahead) const {
  switch (item(ahead).word) {
    case Word::If:
    case Word::Else:
    case Word::While:
    case Word::For:
    case Word::Foreach:
    case Word::Print:
    case Word::Printf:
    case Word::Return:
    case Word::Free:
    case Word::Die: return true;
    default: return false;
  }
}

// Can this item begin a statement?
bool Parser::starts_statement(std::size_t ahead) const {
  switch (item(ahead).word) {
    case Word::Self:
    case Word::Super:
    case Word::Push:
    case Word::Prepend:
    case Word::Insert:
    case Word::Sort: return true;
    default: return at_name(ahead) || at_statement_word(ahead);
  }
}

// The item on a new line, no further right than the statement at `start`, that a missing period made part of it; 0 if
// none.
std::size_t Parser::run_on_line(std::size_t start) const {
  int depth = 0;
  for (std::size_t i = start + 1; i <= pos_ && i < items_.size(); ++i) {
    const Token& before = *items_[i - 1].token;
    const std::uint16_t text = items_[i - 1].sign;
    if (text == sign("(") || text == sign("[") || text == sign("{")) ++depth;
    if (text == sign(")") || text == sign("]") || text == sign("}")) --depth;
    const Token& here = *items_[i].token;
    const bool left = here.starts_line && here.span.column <= items_[start].token->span.column;
    if (!left || depth > 0 || here.kind != TokenKind::Name) continue;
    const bool complete = before.kind != TokenKind::Punctuation || text == sign(")") || text == sign("]") ||
                          text == sign("}") || text == sign("|") || text == sign("++") || text == sign("--");
    if (complete) return i;
  }
  return 0;
}

void Parser::recover(std::size_t start, const SyntaxError& problem) {
  if (const std::size_t next = run_on_line(start); next > 0) {
    pos_ = next;
    missing(".", "this statement");
    return;
  }
  if (errors_ == statement_errors_) report(problem.diagnostic);
  skip_statement(start);
}

// Behind the lists and indices that are open between `start` and here.
void Parser::leave_braces(std::size_t start) {
  const std::size_t here = pos_;
  for (std::size_t i = start; i < here; ++i) {
    if (items_[i].sign != sign("{") || items_[i].block_like || items_[i].match < here) continue;
    pos_ = items_[i].match;
    advance();
    return;
  }
}

// To the end of the statement that began at `start`, or to what surely begins another construct.
void Parser::skip_statement(std::size_t start) {
  leave_braces(start);
  const std::uint32_t column = items_[start].token->span.column;
  for (std::size_t first = pos_; !at_end(); advance()) {
    if (accept(".")) return;
    if (at("}")) return;
    const bool fresh = pos_ > first || pos_ > start;
    if (token().starts_line && fresh) {
      if (at_member_header() || at_variables_header() || at_class_header()) return;
      if (starts_statement(0) && (!at_name() || token().span.column <= column)) return;
    }
    if (at("{") && item().match != 0) {
      const bool block = item().block_like;
      pos_ = item().match;
      if (!block) continue;
      advance();
      accept(".");
      return;
    }
  }
}

}  // namespace breve::steve
