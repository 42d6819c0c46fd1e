// Questions about a tree that the compiler asks before it emits code for it.
#include "steve/compile/function_compiler.hpp"
#include "steve/compile/overloaded.hpp"

namespace breve::steve {

namespace {

using Visit = std::function<void(const ast::Expr&)>;

void children(const ast::Expr& e, const Visit& visit) {
  const auto go = [&](const ast::ExprPtr& p) {
    if (p) walk(*p, visit);
  };
  std::visit(Overloaded{
                 [&](const ast::StringLit& s) {
                   for (const auto& part : s.parts) go(part.expr);
                 },
                 [&](const ast::VectorLit& v) { go(v.x), go(v.y), go(v.z); },
                 [&](const ast::MatrixLit& m) {
                   for (const auto& element : m.elements) go(element);
                 },
                 [&](const ast::ListLit& l) {
                   for (const auto& element : l.elements) go(element);
                 },
                 [&](const ast::ArrayItem& a) { go(a.index); },
                 [&](const ast::IndexExpr& i) { go(i.base), go(i.index); },
                 [&](const ast::Member& m) { go(m.base); },
                 [&](const ast::Call& c) {
                   go(c.receiver);
                   for (const auto& keyword : c.keywords) go(keyword.value);
                 },
                 [&](const ast::FunctionCall& f) {
                   for (const auto& argument : f.arguments) go(argument);
                 },
                 [&](const ast::RandomExpr& r) { go(r.bound); },
                 [&](const ast::NewExpr& n) { go(n.count); },
                 [&](const ast::Unary& u) { go(u.operand); },
                 [&](const ast::Chain& c) {
                   go(c.first);
                   for (const auto& [op, operand] : c.rest) go(operand);
                 },
                 [&](const ast::Magnitude& m) { go(m.operand); },
                 [&](const ast::Assign& a) { go(a.target), go(a.value); },
                 [&](const ast::Step& s) { go(s.target); },
                 [&](const ast::Push& p) { go(p.value), go(p.list); },
                 [&](const ast::Pop& p) { go(p.list); },
                 [&](const ast::Insert& i) { go(i.value), go(i.list), go(i.index); },
                 [&](const ast::Remove& r) { go(r.base), go(r.index); },
                 [&](const ast::CopyList& c) { go(c.list); },
                 [&](const ast::Sort& s) { go(s.list); },
                 [](const auto&) {},
             },
             e.node);
}

}  // namespace

void walk(const ast::Expr& e, const Visit& visit) {
  visit(e);
  children(e, visit);
}

void walk(const ast::Stmt& s, const Visit& visit) {
  const auto expr = [&](const ast::ExprPtr& p) {
    if (p) walk(*p, visit);
  };
  const auto stmt = [&](const ast::StmtPtr& p) {
    if (p) walk(*p, visit);
  };
  std::visit(Overloaded{
                 [&](const ast::Block& b) {
                   for (const auto& inner : b.body) stmt(inner);
                 },
                 [&](const ast::If& i) {
                   for (const auto& [condition, body] : i.branches) expr(condition), stmt(body);
                   stmt(i.otherwise);
                 },
                 [&](const ast::While& w) { expr(w.condition), stmt(w.body); },
                 [&](const ast::For& f) { expr(f.start), expr(f.condition), expr(f.step), stmt(f.body); },
                 [&](const ast::Foreach& f) { expr(f.list), stmt(f.body); },
                 [&](const ast::Print& p) {
                   for (const auto& item : p.items) expr(item);
                 },
                 [&](const ast::ExprStmt& x) { expr(x.expr); },
                 [&](const ast::Return& r) { expr(r.value); },
                 [&](const ast::Free& f) { expr(f.value); },
                 [&](const ast::Die& d) { expr(d.value); },
             },
             s.node);
}

void walk_statements(const ast::Stmt& s, const std::function<void(const ast::Stmt&)>& visit) {
  visit(s);
  const auto go = [&](const ast::StmtPtr& p) {
    if (p) walk_statements(*p, visit);
  };
  std::visit(Overloaded{
                 [&](const ast::Block& b) {
                   for (const auto& inner : b.body) go(inner);
                 },
                 [&](const ast::If& i) {
                   for (const auto& branch : i.branches) go(branch.second);
                   go(i.otherwise);
                 },
                 [&](const ast::While& w) { go(w.body); },
                 [&](const ast::For& f) { go(f.body); },
                 [&](const ast::Foreach& f) { go(f.body); },
                 [](const auto&) {},
             },
             s.node);
}

bool has_effects(const ast::Expr& e) {
  bool found = false;
  walk(e, [&](const ast::Expr& x) {
    found = found || std::visit(Overloaded{
                                    [](const ast::Assign&) { return true; },
                                    [](const ast::Step&) { return true; },
                                    [](const ast::Push&) { return true; },
                                    [](const ast::Pop&) { return true; },
                                    [](const ast::Insert&) { return true; },
                                    [](const ast::Remove&) { return true; },
                                    [](const ast::Sort&) { return true; },
                                    [](const ast::NewExpr&) { return true; },
                                    [](const ast::Call&) { return true; },
                                    [](const ast::FunctionCall&) { return true; },
                                    [](const ast::RandomExpr&) { return true; },
                                    [](const auto&) { return false; },
                                },
                                x.node);
  });
  return found;
}

bool assigns(const ast::Expr& e) {
  bool found = false;
  walk(e, [&](const ast::Expr& x) {
    found = found || std::holds_alternative<ast::Assign>(x.node) || std::holds_alternative<ast::Step>(x.node);
  });
  return found;
}

std::optional<double> written_number(const ast::Expr& e) {
  if (const auto* n = std::get_if<ast::IntLit>(&e.node)) return n->value;
  if (const auto* d = std::get_if<ast::DoubleLit>(&e.node)) return d->value;
  if (const auto* u = std::get_if<ast::Unary>(&e.node); u && u->op == ast::UnaryOp::Negate) {
    if (const auto inner = written_number(*u->operand)) return -*inner;
  }
  return std::nullopt;
}

bool is_written_int(const ast::Expr& e) {
  if (const auto* u = std::get_if<ast::Unary>(&e.node))
    return u->op == ast::UnaryOp::Negate && is_written_int(*u->operand);
  return std::holds_alternative<ast::IntLit>(e.node);
}

bool always_has_value(const ast::Stmt& s) {
  return std::visit(Overloaded{
                        [](const ast::Block& b) {
                          for (const auto& inner : b.body)
                            if (always_has_value(*inner)) return true;
                          return false;
                        },
                        [](const ast::If& i) {
                          for (const auto& branch : i.branches)
                            if (!always_has_value(*branch.second)) return false;
                          return i.otherwise && always_has_value(*i.otherwise);
                        },
                        [](const ast::ExprStmt& x) { return !std::holds_alternative<ast::Sort>(x.expr->node); },
                        [](const ast::Return&) { return true; },
                        [](const ast::Die&) { return true; },
                        [](const auto&) { return false; },
                    },
                    s.node);
}

bool contains_return(const ast::Stmt& s) {
  return std::visit(Overloaded{
                        [](const ast::Block& b) {
                          for (const auto& inner : b.body)
                            if (contains_return(*inner)) return true;
                          return false;
                        },
                        [](const ast::If& i) {
                          for (const auto& branch : i.branches)
                            if (contains_return(*branch.second)) return true;
                          return i.otherwise && contains_return(*i.otherwise);
                        },
                        [](const ast::While& w) { return contains_return(*w.body); },
                        [](const ast::For& f) { return contains_return(*f.body); },
                        [](const ast::Foreach& f) { return contains_return(*f.body); },
                        [](const ast::Return& r) { return r.value == nullptr; },
                        [](const auto&) { return false; },
                    },
                    s.node);
}

}  // namespace breve::steve
