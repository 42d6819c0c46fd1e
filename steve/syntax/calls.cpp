// Method calls: receiver selector {keyword value}. A call stands without parentheses only as a statement and at the
// right of a plain `variable =`.
#include <fmt/format.h>

#include "steve/syntax/parser_nodes.hpp"

namespace breve::steve {

// Is what began at `start` a primary and nothing more, with the name of a method behind it?
bool Parser::at_call(std::size_t start) const { return primary_start_ == start && primary_end_ == pos_ && at_name(); }

// A name on a new line is not a selector, but begins a statement, if what follows it cannot follow a selector.
bool Parser::run_on_call() const {
  if (!token().starts_line) return false;
  const Token& receiver = previous();
  if (receiver.kind == TokenKind::Int || receiver.kind == TokenKind::Double || receiver.kind == TokenKind::String)
    return true;
  return at_assignment(1);
}

// Signs that follow a variable at the beginning of a statement, and never a selector.
bool Parser::at_assignment(std::size_t ahead) const {
  switch (item(ahead).sign) {
    case sign("="):
    case sign("+="):
    case sign("-="):
    case sign("*="):
    case sign("/="):
    case sign("%="):
    case sign("^="):
    case sign("++"):
    case sign("--"):
    case sign("::"):
    case sign("{"):
    case sign("["):
    case sign("("): return true;
    default: return false;
  }
}

// A primary with a selector behind it, where only a value can stand?
bool Parser::at_stray_call() const {
  return primary_end_ == pos_ && at_name() && !token().starts_line && !at_assignment(1);
}

ast::ExprPtr Parser::call(std::size_t start, ast::ExprPtr receiver) {
  const Nest nest(*this);
  deepen();
  ast::Call node;
  node.receiver = std::move(receiver);
  const std::size_t selector = pos_;
  if (auto number = meant_by_number()) throw SyntaxError{std::move(*number)};
  std::size_t made = 0;
  node.selector = expect_name("a method", node.selector_span);
  if (at_text("to") && items_[start].token->kind == TokenKind::Name && at_name(1)) {  // `tell leader to eat`
    call_start_ = start;
    call_method_ = selector;
    const std::string_view word = items_[start].token->text;
    if ((word == "tell" || word == "ask") && lacks_self()) throw SyntaxError{without_self()};
  }
  while (at_name()) {
    ast::Keyword keyword;
    const std::size_t keyword_start = pos_;
    keyword.name = expect_name("a keyword", keyword.span);
    if (at_closing() || at(";")) {
      call_start_ = start;
      call_method_ = selector;
      fail_keyword(node, start, keyword_start);
    }
    const std::size_t value_start = pos_;
    if (node.keywords.empty() && at_binary_operator()) {
      call_start_ = start;
      call_method_ = selector;
      if (lacks_self()) throw SyntaxError{without_self()};
    }
    keyword.value = expression();
    if (at_name() && std::holds_alternative<ast::NewExpr>(keyword.value->node) && !keyword.value->parenthesised)
      made = value_start;
    node.keywords.push_back(std::move(keyword));
  }
  call_end_ = pos_;
  call_name_ = node.selector;
  call_start_ = start;
  call_method_ = selector;
  call_new_ = made;
  return make(start, std::move(node));
}

// A keyword without a value: often it is the method of a call that lacks its parentheses.
void Parser::fail_keyword(const ast::Call& call, std::size_t start, std::size_t keyword) {
  const Token& name = *items_[keyword].token;
  if (call.selector == "in" && call.keywords.empty())
    fail(call.selector_span, "foreign-operator", "'in' belongs to 'foreach'",
         "to look for an element: foreach item in list: if item == wanted: ...");
  if (at(":"))
    fail(token().span, "call-arguments", fmt::format("the keyword '{}' is not followed by ':'", name.text),
         fmt::format("write its value directly: {} {} value", call.selector, name.text));
  if (call.keywords.empty() && lacks_self()) throw SyntaxError{without_self()};
  const auto* last = call.keywords.empty() ? nullptr : call.keywords.back().value.get();
  const bool object = last != nullptr && !last->parenthesised &&
                      (std::holds_alternative<ast::Name>(last->node) || std::holds_alternative<ast::Self>(last->node) ||
                       std::holds_alternative<ast::Super>(last->node));
  const Token& before = *items_[keyword - 1].token;
  if (object) {
    if (auto meant = meant_by_access(keyword - 1, keyword)) throw SyntaxError{std::move(*meant)};
    throw SyntaxError{needs_parentheses(keyword - 1, keyword, keyword + 1)};
  }
  if (call.keywords.empty() && at(")") && items_[start].token != &before)
    fail(name.span, "call-arguments", fmt::format("keyword '{}' of '{}' has no value", name.text, call.selector),
         fmt::format("write the value after it; or, to call '{0}' on the result, use parentheses: (({1} {2}) {0})",
                     name.text, items_[start].token->text, call.selector));
  fail(name.span, "call-arguments", fmt::format("keyword '{}' of '{}' has no value", name.text, call.selector),
       fmt::format("write the value behind it: {} {} value", call.selector, name.text));
}

// The error in a primary that is followed by a selector, where only a value can stand.
Diagnostic Parser::call_mistake() {
  const Token& last = previous();
  const Token& selector = token();
  if (auto number = meant_by_number()) return std::move(*number);
  if (at_text("mod") || at_text("div"))
    return {Severity::Error, "foreign-operator", fmt::format("'{}' is not an operator", selector.text),
            at_text("mod") ? "the remainder is written a % b" : "a quotient without fraction is written floor(a / b)",
            selector.span};
  if (at_text("in") || (at_text("not") && at_text("in", 1))) {
    return {Severity::Error, "foreign-operator", "'in' belongs to 'foreach'",
            "to look for an element: foreach item in list: if item == wanted: ...",
            at_text("in") ? selector.span : token(1).span};
  }
  if (at_text("and") || at_text("or")) {
    return {Severity::Error, "syntax", fmt::format("unexpected {}", describe()),
            at_text("and") ? "logical and is written '&&'" : "logical or is written '||'", selector.span};
  }
  if (at_text("is") && (at_text("a", 1) || at_text("an", 1)))
    return {Severity::Error, "syntax", "a question about a class needs parentheses", "write: (object is a \"Name\")",
            selector.span};
  if (at_text("is") || at_text("equals") || at_text("isnt")) {
    return {Severity::Error, "syntax", fmt::format("unexpected {}", describe()),
            at_text("isnt") ? "to compare, write '!='" : "to compare, write '=='", selector.span};
  }
  if (last.text == "not" && last.kind == TokenKind::Name) {
    Span where = last.span;
    where.length = selector.span.offset + selector.span.length - where.offset;
    return {Severity::Error, "syntax", "there is no 'not'", fmt::format("logical not is written !{}", selector.text),
            where};
  }
  if (last.kind == TokenKind::String || last.kind == TokenKind::Int || last.kind == TokenKind::Double) {
    return {Severity::Error, "syntax", fmt::format("unexpected {} after this value", describe()),
            "a ',' or an operator may be missing between the two", selector.span};
  }
  if (auto meant = meant_by_access(primary_start_, pos_)) return std::move(*meant);
  return needs_parentheses(primary_start_, pos_, pos_ + 1);
}

// @param end  the item behind the call
Diagnostic Parser::needs_parentheses(std::size_t receiver, std::size_t selector, std::size_t end) const {
  const Token& name = *items_[selector].token;
  Span where = items_[receiver].token->span;
  where.length = name.span.offset + name.span.length - where.offset;
  return {Severity::Error, "call-needs-parentheses",
          fmt::format("the call of method '{}' is used as a value and needs parentheses", name.text),
          fmt::format("write it as ({})", source_of(receiver, end)), where};
}

// Report such a call, and read over it.
void Parser::unparenthesised_call() {
  Diagnostic mistake = call_mistake();
  if (mistake.code == "syntax") throw SyntaxError{std::move(mistake)};
  const std::size_t start = primary_start_, selector = pos_;
  call(start, make(start, ast::Self{}));
  if (mistake.code == "call-needs-parentheses") {
    if (lacks_self()) {
      mistake = without_self();
    } else {
      mistake = needs_parentheses(start, selector, pos_);
    }
  }
  report(std::move(mistake));
}

}  // namespace breve::steve
