// Method calls: receiver selector {keyword value}. A call stands without parentheses only as a statement and at the
// right of a plain `variable =`.
#include <fmt/format.h>

#include "steve/syntax/parser_nodes.hpp"

namespace breve::steve {

// Is what began at `start` a primary and nothing more, with the name of a method behind it?
bool Parser::at_call(std::size_t start) const { return primary_start_ == start && primary_end_ == pos_ && at_name(); }

// A name on a new line is no selector, but begins a statement, if what follows it cannot follow a selector.
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
  node.selector = expect_name("a method", node.selector_span);
  while (at_name()) {
    ast::Keyword keyword;
    const std::size_t keyword_start = pos_;
    keyword.name = expect_name("a keyword", keyword.span);
    if (at_closing() || at(";")) fail_keyword(node, start, keyword_start);
    keyword.value = expression();
    node.keywords.push_back(std::move(keyword));
  }
  call_end_ = pos_;
  call_name_ = node.selector;
  return make(start, std::move(node));
}

// A keyword without a value: often it is the method of a call that lacks its parentheses.
void Parser::fail_keyword(const ast::Call& call, std::size_t start, std::size_t keyword) {
  const Token& name = *items_[keyword].token;
  if (at(":"))
    fail(token().span, "call-arguments", fmt::format("no ':' follows the keyword '{}'", name.text),
         fmt::format("write its value directly: {} {} value", call.selector, name.text));
  const auto* last = call.keywords.empty() ? nullptr : call.keywords.back().value.get();
  const bool object = last != nullptr && !last->parenthesised &&
                      (std::holds_alternative<ast::Name>(last->node) || std::holds_alternative<ast::Self>(last->node) ||
                       std::holds_alternative<ast::Super>(last->node));
  const Token& before = *items_[keyword - 1].token;
  if (object) {
    Span place = last->span;
    place.length = name.span.offset + name.span.length - place.offset;
    fail(place, "call-needs-parentheses",
         fmt::format("the call of method '{}' is used as a value and needs parentheses", name.text),
         fmt::format("write it as ({} {})", before.text, name.text));
  }
  if (call.keywords.empty() && at(")") && items_[start].token != &before)
    fail(name.span, "call-arguments", fmt::format("keyword '{}' of '{}' has no value", name.text, call.selector),
         fmt::format("write the value behind it; or, to call '{0}' on the result, parentheses: (({1} {2}) {0})",
                     name.text, items_[start].token->text, call.selector));
  fail(name.span, "call-arguments", fmt::format("keyword '{}' of '{}' has no value", name.text, call.selector),
       fmt::format("write the value behind it: {} {} value", call.selector, name.text));
}

// What is wrong with a primary that has a selector behind it, where only a value can stand.
Diagnostic Parser::call_mistake() const {
  const Token& last = previous();
  const Token& selector = token();
  if (at_text("and") || at_text("or")) {
    return {Severity::Error, "syntax", fmt::format("unexpected {}", describe()),
            at_text("and") ? "logical and is written '&&'" : "logical or is written '||'", selector.span};
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
  const Token& first = *items_[primary_start_].token;
  Span where = first.span;
  where.length = selector.span.offset + selector.span.length - where.offset;
  return {Severity::Error, "call-needs-parentheses",
          fmt::format("the call of method '{}' is used as a value and needs parentheses", selector.text),
          fmt::format("write it as ({} {}{})", pos_ == primary_start_ + 1 ? first.text : "...", selector.text,
                      at_name(1) ? " ..." : ""),
          where};
}

// Report such a call, and read over it.
void Parser::unparenthesised_call() {
  Diagnostic mistake = call_mistake();
  if (mistake.code == "syntax") throw SyntaxError{std::move(mistake)};
  const std::size_t start = primary_start_;
  call(start, make(start, ast::Self{}));
  report(std::move(mistake));
}

}  // namespace breve::steve
