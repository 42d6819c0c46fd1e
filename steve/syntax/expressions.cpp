// Expressions from assignment down to the prefix operators. Precedence is the language's own: '*', '/', '%' and '^' are
// equal and left-associative, and a sign binds tighter than any of them.
#include <fmt/format.h>

#include <array>

#include "steve/syntax/parser_nodes.hpp"

namespace breve::steve {

namespace {

struct Operator {
  std::uint16_t sign;
  ast::BinaryOp op;
};

using ast::BinaryOp;

// Tightest last.
constexpr int kProduct = 4, kSum = 3, kComparison = 2, kLevels = 5;

bool orders(BinaryOp op) {
  return op == BinaryOp::Lt || op == BinaryOp::Le || op == BinaryOp::Gt || op == BinaryOp::Ge;
}

std::optional<BinaryOp> operator_at(int level, std::uint16_t text) {
  switch (level) {
    case 0: return text == sign("||") ? std::optional(BinaryOp::Or) : std::nullopt;
    case 1: return text == sign("&&") ? std::optional(BinaryOp::And) : std::nullopt;
    case 2:
      switch (text) {
        case sign("=="): return BinaryOp::Eq;
        case sign("!="): return BinaryOp::Ne;
        case sign("<"): return BinaryOp::Lt;
        case sign("<="): return BinaryOp::Le;
        case sign(">"): return BinaryOp::Gt;
        case sign(">="): return BinaryOp::Ge;
        default: return std::nullopt;
      }
    case kSum:
      return text == sign("+")   ? std::optional(BinaryOp::Add)
             : text == sign("-") ? std::optional(BinaryOp::Sub)
                                 : std::nullopt;
    default:
      switch (text) {
        case sign("*"): return BinaryOp::Mul;
        case sign("/"): return BinaryOp::Div;
        case sign("%"): return BinaryOp::Mod;
        case sign("^"): return BinaryOp::Pow;
        default: return std::nullopt;
      }
  }
}

std::optional<BinaryOp> assignment_operator(std::uint16_t text) {
  switch (text) {
    case sign("+="): return BinaryOp::Add;
    case sign("-="): return BinaryOp::Sub;
    case sign("*="): return BinaryOp::Mul;
    case sign("/="): return BinaryOp::Div;
    case sign("%="): return BinaryOp::Mod;
    case sign("^="): return BinaryOp::Pow;
    default: return std::nullopt;
  }
}

}  // namespace

ast::ExprPtr Parser::expression() { return assignment(false); }

ast::ExprPtr Parser::value() {
  ast::ExprPtr result = expression();
  const bool header_word = in_header_ && (at_text("then") || at_text("do"));
  if (at_stray_call() && !header_word) unparenthesised_call();
  return result;
}

// @param statement_level  the right side of a plain `variable =` may be a method call without parentheses
ast::ExprPtr Parser::assignment(bool statement_level) {
  const Nest nest(*this);
  const std::size_t start = pos_;
  ast::ExprPtr target = chain(0);
  if (at("++") || at("--")) {
    check_target(*target);
    const int delta = at("++") ? 1 : -1;
    advance();
    return make(start, ast::Step{std::move(target), delta});
  }
  const std::optional<BinaryOp> op = assignment_operator(item().sign);
  if (!op && (!at("=") || at_run_on_header())) return target;
  check_target(*target);
  advance();
  const std::size_t value_start = pos_;
  ast::ExprPtr right = assignment(false);
  const bool takes_call = statement_level && !op && std::holds_alternative<ast::Name>(target->node);
  const bool bare_call = takes_call && at_call(value_start) && !run_on_call();
  if (bare_call) {
    right = call(value_start, std::move(right));
  } else if (statement_level && at_stray_call()) {
    unparenthesised_call();
  }
  return make(start, ast::Assign{std::move(target), op, std::move(right), bare_call});
}

void Parser::check_target(const ast::Expr& target) {
  const bool assignable =
      std::holds_alternative<ast::Name>(target.node) || std::holds_alternative<ast::ArrayItem>(target.node) ||
      std::holds_alternative<ast::IndexExpr>(target.node) || std::holds_alternative<ast::Member>(target.node);
  if (assignable && !target.parenthesised) return;
  if (const auto* constant = std::get_if<ast::ConstantExpr>(&target.node)) {
    fail(target.span, "bad-target",
         fmt::format("'{}' is a constant (from @define) and cannot be changed", constant->name),
         "assign to a variable in its place");
  }
  if (at("++") || at("--")) {
    fail(token().span, "bad-target",
         fmt::format("'{}' must come directly after a variable, an element or a member", token().text));
  }
  if (at("=") && item(1).sign == sign(">") && adjacent(1))
    fail(token().span, "foreign-operator", "'=>' is not an operator",
         "methods are not values: give the name of a method as a string");
  std::string help = "to compare, write '=='";
  if (std::holds_alternative<ast::Chain>(target.node))
    help += "; to assign inside an expression, put the assignment in parentheses";
  fail(token().span, "bad-target", fmt::format("the expression before '{}' cannot be assigned to", token().text), help);
}

// One level of binary operators, as one node however long it is.
ast::ExprPtr Parser::chain(int level) {
  if (level == kLevels) return prefix();
  const std::size_t start = pos_;
  ast::ExprPtr first = chain(level + 1);
  if (!operator_at(level, item().sign)) return first;
  const std::size_t first_end = pos_;
  ast::Chain result{std::move(first), {}, {}};
  while (std::optional<BinaryOp> op = operator_at(level, item().sign)) {
    if (level == kSum && at_run_on_header()) break;
    const Token& sign_token = token();
    result.operators.push_back(sign_token.span);
    advance();
    if (const auto meant = foreign_operator(*op)) op = meant;
    if (*op == BinaryOp::Or && at_closing()) {
      fail(sign_token.span, "syntax", "'||' means logical or and does not close bars",
           "write a space between nested bars: | |a| - |b| |");
    }
    const bool number = at_kind(TokenKind::Int) || at_kind(TokenKind::Double);
    if (*op == BinaryOp::Sub && sign_token.space_before && !sign_token.space_after && number) {
      lint(sign_token.span, "lint-minus-spacing", fmt::format("'-{}' is read as a subtraction here", token().text),
           "write a space on both sides of the minus, or a comma before it if two values are meant");
    }
    ast::ExprPtr operand = chain(level + 1);
    result.rest.emplace_back(*op, std::move(operand));
  }
  if (result.rest.empty()) return std::move(result.first);
  if (level == kProduct) lint_chain(result, first_end);
  if (level == kComparison) lint_comparisons(result);
  return make(start, std::move(result));
}

// `1 < n < 3` compares the result of `1 < n`, which is 0 or 1, with 3.
void Parser::lint_comparisons(const ast::Chain& chain) {
  for (std::size_t i = 1; i < chain.rest.size(); ++i) {
    if (!orders(chain.rest[i - 1].first) || !orders(chain.rest[i].first)) continue;
    const auto sign_of = [&](std::size_t k) {
      const Span& at = chain.operators[k];
      return sources_.file(at.file).text.substr(at.offset, at.length);
    };
    const std::string first = text_of(i == 1 ? *chain.first : *chain.rest[i - 2].second);
    const std::string middle = text_of(*chain.rest[i - 1].second), last = text_of(*chain.rest[i].second);
    lint(chain.operators[i], "lint-chained-comparison",
         "this compares the result of the comparison before it, which is 0 or 1",
         fmt::format("write: {} {} {} && {} {} {}", first, sign_of(i - 1), middle, middle, sign_of(i), last));
    return;
  }
}

// '^' takes all that stands to its left.
void Parser::lint_chain(const ast::Chain& chain, std::size_t first_end) {
  const auto* sign_before = std::get_if<ast::Unary>(&chain.first->node);
  const bool signed_number = items_[first_end - 1].token != nullptr &&
                             (std::holds_alternative<ast::IntLit>(chain.first->node) ||
                              std::holds_alternative<ast::DoubleLit>(chain.first->node)) &&
                             chain.first->span.offset != items_[first_end - 1].token->span.offset;
  const bool negated = (signed_number || (sign_before != nullptr && sign_before->op == ast::UnaryOp::Negate)) &&
                       !chain.first->parenthesised;
  for (std::size_t i = 0; i < chain.rest.size(); ++i) {
    if (chain.rest[i].first != BinaryOp::Pow || (i == 0 && !negated)) continue;
    lint(chain.operators[i], "lint-precedence",
         "'^' has the precedence of '*' and takes everything to its left: 2*x^2 means (2*x)^2",
         "write parentheses to show what is meant");
    return;
  }
}

ast::ExprPtr Parser::prefix() {
  if (at("!")) {
    const Nest nest(*this);
    const std::size_t start = pos_;
    advance();
    ast::ExprPtr operand = prefix();
    return make(start, ast::Unary{ast::UnaryOp::Not, std::move(operand)});
  }
  if (at("-")) return negation();
  if (at("+"))
    fail(token().span, "syntax", "there is no unary '+'",
         previous_is("=") && adjacent(0) ? "to add to a variable write +=" : "leave it out");
  if (at("--") || at("++")) {
    const std::string variable(at_name(1) ? token(1).text : "n");
    fail(token().span, "syntax", fmt::format("'{}' comes after a variable, never before it", token().text),
         fmt::format("write: {}{}", variable, token().text) + (at("--") ? "; for two signs write '- -'" : ""));
  }
  switch (item().word) {
    case Word::Pop:
    case Word::Unprepend:
    case Word::Copylist:
    case Word::Push:
    case Word::Prepend:
    case Word::Remove: return list_operation();
    case Word::Insert: return insert_operation();
    case Word::Sort: return sort_operation();
    default: return postfix();
  }
}

// A sign before a number gives a number.
ast::ExprPtr Parser::negation() {
  const Nest nest(*this);
  const std::size_t start = pos_;
  advance();
  sign_at_ = pos_;
  ast::ExprPtr operand = prefix();
  if (auto* integer = std::get_if<ast::IntLit>(&operand->node)) {
    const auto bits = 0U - static_cast<std::uint32_t>(integer->value);
    return make(start, ast::IntLit{static_cast<std::int32_t>(bits)});
  }
  if (auto* number = std::get_if<ast::DoubleLit>(&operand->node)) return make(start, ast::DoubleLit{-number->value});
  return make(start, ast::Unary{ast::UnaryOp::Negate, std::move(operand)});
}

ast::ExprPtr Parser::list_operation() {
  const Nest nest(*this);
  const std::size_t start = pos_;
  const Word word = item().word;
  advance();
  refuse_dotted(start);
  if (word == Word::Push || word == Word::Prepend) {
    ast::ExprPtr value = expression();
    if (at_name() && (at_text("into") || at_text("to") || at_text("on") || at_text("in")))
      fail(token().span, "syntax", fmt::format("'{}' takes 'onto', not '{}'", items_[start].token->text, token().text),
           fmt::format("write: {} value onto list", items_[start].token->text));
    if (!at_text("onto")) {
      if (at_stray_call()) {
        const Diagnostic mistake = call_mistake();
        std::size_t end = pos_ + 1;
        while (end < statement_end() && items_[end].token->text != "onto") ++end;
        if (mistake.code != "call-needs-parentheses") throw SyntaxError{mistake};
        throw SyntaxError{needs_parentheses(primary_start_, pos_, end)};
      }
      if (const std::string_view list = before_dot(start); !list.empty())
        fail(items_[start].token->span, "list-word",
             fmt::format("'{}' comes before the value and the list, without a dot", items_[start].token->text),
             fmt::format("write: {} {} onto {}", items_[start].token->text,
                         pos_ > start + 1 ? source_of(start + 1, pos_) : "value", list));
      fail_expected("'onto' and a list", "write: push value onto list");
    }
    advance();
    ast::ExprPtr list = postfix();
    return make(start, ast::Push{std::move(value), std::move(list), word == Word::Prepend});
  }
  ast::ExprPtr operand = postfix();
  if (word == Word::Copylist) return make(start, ast::CopyList{std::move(operand)});
  if (word != Word::Remove) return make(start, ast::Pop{std::move(operand), word == Word::Unprepend});
  auto* element = std::get_if<ast::IndexExpr>(&operand->node);
  if (element == nullptr || operand->parenthesised) {
    fail(operand->span, "syntax", "'remove' needs an element in braces", "write: remove list{position}");
  }
  ast::Remove node{std::move(element->base), std::move(element->index)};
  return make(start, std::move(node));
}

ast::ExprPtr Parser::insert_operation() {
  const Nest nest(*this);
  const std::size_t start = pos_;
  advance();
  refuse_dotted(start);
  ast::ExprPtr value = expression();
  if (!at_text("at")) {
    if (at_stray_call()) throw SyntaxError{call_mistake()};
    fail_expected("'at' and a place in a list", "write: insert value at list{position}");
  }
  advance();
  ast::ExprPtr target = postfix();
  auto* element = std::get_if<ast::IndexExpr>(&target->node);
  if (element == nullptr || target->parenthesised) {
    fail(target->span, "syntax", "'insert' needs a position in braces", "write: insert value at list{position}");
  }
  ast::Insert node{std::move(value), std::move(element->base), std::move(element->index)};
  return make(start, std::move(node));
}

ast::ExprPtr Parser::sort_operation() {
  const Nest nest(*this);
  const std::size_t start = pos_;
  advance();
  refuse_dotted(start);
  ast::ExprPtr list = postfix();
  if (!at_text("with")) {
    fail(token().span, "sort-with", fmt::format("expected 'with' and the name of a method, got {}", describe()),
         "write: sort list with method-name");
  }
  advance();
  Span selector_span;
  std::string selector = expect_name("the method that compares", selector_span);
  return make(start, ast::Sort{std::move(list), std::move(selector), selector_span});
}

}  // namespace breve::steve
