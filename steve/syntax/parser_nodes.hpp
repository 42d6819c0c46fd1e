// How the parser's parts make nodes. Private to this folder.
#pragma once

#include <memory>
#include <utility>

#include "steve/syntax/parser_core.hpp"

namespace breve::steve {

/// An expression that began at item `start` and ends with the item before the current one.
template <typename Node>
ast::ExprPtr Parser::make(std::size_t start, Node node) {
  auto made = std::make_unique<ast::Expr>();
  made->node = std::move(node);
  made->span = span_from(start);
  return made;
}

template <typename Node>
ast::StmtPtr Parser::make_statement(std::size_t start, Node node) {
  auto made = std::make_unique<ast::Stmt>();
  made->node = std::move(node);
  made->span = span_from(start);
  return made;
}

}  // namespace breve::steve
