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
    if (at_closing()) {
      fail(items_[keyword_start].token->span, "syntax", fmt::format("keyword '{}' has no value", keyword.name),
           "a method call used as a value needs parentheses: (object method)");
    }
    keyword.value = expression();
    node.keywords.push_back(std::move(keyword));
  }
  return make(start, std::move(node));
}

// What is wrong with a primary that has a selector behind it, where only a value can stand.
Diagnostic Parser::call_mistake() const {
  const Token& last = previous();
  const Token& selector = token();
  if (at_text("and") || at_text("or")) {
    return {Severity::Error, "syntax", fmt::format("unexpected {}", describe()),
            at_text("and") ? "logical and is written '&&'" : "logical or is written '||'", selector.span};
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
