// Variables of a session: names that statements typed in may use without declaring them. They live in a hash, so that
// they are dynamic, and reading and changing them is what the language does with elements of a hash anyway.
#include <algorithm>
#include <set>

#include "steve/compile/evaluate.hpp"
#include "steve/compile/function_compiler.hpp"
#include "steve/compile/overloaded.hpp"

namespace breve::steve {

namespace {

class SessionNames {
 public:
  explicit SessionNames(std::set<std::string, std::less<>> names) : names_(std::move(names)) {}
  bool used() const { return used_; }

  void statement(ast::StmtPtr& s) {
    if (!s) return;
    const auto span = s->span;
    std::visit(Overloaded{
                   [&](ast::Block& b) { each(b.body); },
                   [&](ast::If& i) {
                     for (auto& [condition, body] : i.branches) expr(condition), statement(body);
                     statement(i.otherwise);
                   },
                   [&](ast::While& w) { expr(w.condition), statement(w.body); },
                   [&](ast::For& f) { expr(f.start), expr(f.condition), expr(f.step), statement(f.body); },
                   [&](ast::Foreach& f) { foreach_loop(f, span); },
                   [&](ast::ExprStmt& x) { expr(x.expr); },
                   [&](ast::Print& p) {
                     for (auto& item : p.items) expr(item);
                   },
                   [&](ast::Return& r) { expr(r.value); },
                   [&](ast::Free& f) { expr(f.value); },
                   [&](ast::Die& d) { expr(d.value); },
               },
               s->node);
  }
  void each(std::vector<ast::StmtPtr>& list) {
    for (auto& inner : list) statement(inner);
  }
  const std::vector<std::string>& loop_variables() const { return loops_; }

 private:
  static ast::ExprPtr make(const Span& span, decltype(ast::Expr::node) node) {
    auto e = std::make_unique<ast::Expr>();
    e->node = std::move(node);
    e->span = span;
    return e;
  }

  /// `%session{"name"}`
  ast::ExprPtr element(const std::string& name, const Span& span) {
    used_ = true;
    ast::StringLit key;
    key.texts.push_back(name);
    return make(span, ast::IndexExpr{make(span, ast::Name{kSessionVariable}), make(span, std::move(key))});
  }

  /// The loop's variable must be a variable: a hidden one, which each iteration hands on.
  void foreach_loop(ast::Foreach& f, const Span& span) {
    expr(f.list);
    statement(f.body);
    if (!names_.contains(f.variable)) return;
    loops_.push_back("%each" + std::to_string(loops_.size()));
    auto assignment = std::make_unique<ast::Stmt>();
    assignment->span = span;
    assignment->node =
        ast::ExprStmt{make(f.variable_span, ast::Assign{element(f.variable, f.variable_span), std::nullopt,
                                                        make(f.variable_span, ast::Name{loops_.back()})})};
    ast::Block block;
    block.body.push_back(std::move(assignment));
    block.body.push_back(std::move(f.body));
    f.body = std::make_unique<ast::Stmt>();
    f.body->span = span;
    f.body->node = std::move(block);
    f.variable = loops_.back();
  }

  void part(ast::StringLit::Part& p, const Span& around) {
    expr(p.expr);
    if (p.expr || !names_.contains(p.name)) return;
    const auto span = p.span.line != 0 ? p.span : around;
    p.expr = element(p.name, span);
    if (p.index) p.expr = make(span, ast::IndexExpr{std::move(p.expr), make(span, ast::IntLit{*p.index})});
    p.name.clear();
    p.index.reset();
  }

  void expr(ast::ExprPtr& e) {
    if (!e) return;
    if (const auto* n = std::get_if<ast::Name>(&e->node)) {
      if (names_.contains(n->name)) e = element(std::string(n->name), e->span);
      return;
    }
    const auto span = e->span;
    std::visit(Overloaded{
                   [&](ast::StringLit& s) {
                     for (auto& p : s.parts) part(p, span);
                   },
                   [&](ast::VectorLit& v) { expr(v.x), expr(v.y), expr(v.z); },
                   [&](ast::MatrixLit& m) {
                     for (auto& item : m.elements) expr(item);
                   },
                   [&](ast::ListLit& l) {
                     for (auto& item : l.elements) expr(item);
                   },
                   [&](ast::ArrayItem& a) { expr(a.index); },
                   [&](ast::IndexExpr& i) { expr(i.base), expr(i.index); },
                   [&](ast::Member& m) { expr(m.base); },
                   [&](ast::Call& c) {
                     expr(c.receiver);
                     for (auto& keyword : c.keywords) expr(keyword.value);
                   },
                   [&](ast::FunctionCall& f) {
                     for (auto& argument : f.arguments) expr(argument);
                   },
                   [&](ast::RandomExpr& r) { expr(r.bound); },
                   [&](ast::NewExpr& n) { expr(n.count); },
                   [&](ast::Unary& u) { expr(u.operand); },
                   [&](ast::Chain& c) {
                     expr(c.first);
                     for (auto& [op, operand] : c.rest) expr(operand);
                   },
                   [&](ast::Magnitude& m) { expr(m.operand); },
                   [&](ast::Assign& a) { expr(a.target), expr(a.value); },
                   [&](ast::Step& s) { expr(s.target); },
                   [&](ast::Push& p) { expr(p.value), expr(p.list); },
                   [&](ast::Pop& p) { expr(p.list); },
                   [&](ast::Insert& i) { expr(i.value), expr(i.list), expr(i.index); },
                   [&](ast::Remove& r) { expr(r.base), expr(r.index); },
                   [&](ast::CopyList& c) { expr(c.list); },
                   [&](ast::Sort& s) { expr(s.list); },
                   [](auto&) {},
               },
               e->node);
  }

  std::set<std::string, std::less<>> names_;
  std::vector<std::string> loops_;
  bool used_ = false;
};

void collect_assigned(const ast::Method& method, std::set<std::string, std::less<>>& names) {
  for (const auto& statement : method.body) {
    walk_statements(*statement, [&](const ast::Stmt& s) {
      if (const auto* loop = std::get_if<ast::Foreach>(&s.node)) names.insert(loop->variable);
    });
    walk(*statement, [&](const ast::Expr& e) {
      const auto* assign = std::get_if<ast::Assign>(&e.node);
      if (!assign || assign->op) return;
      if (const auto* n = std::get_if<ast::Name>(&assign->target->node)) names.insert(n->name);
    });
  }
}

}  // namespace

SessionUse use_session(ast::Method& method, const ClassInfo& self, const SymbolTable& symbols,
                       const std::vector<std::string_view>& known) {
  std::set<std::string, std::less<>> names(known.begin(), known.end());
  collect_assigned(method, names);
  std::erase_if(names, [&](const std::string& name) {
    const auto symbol = symbols.find(name);
    return symbol != kNoSymbol && self.find_variable(symbol) != nullptr;
  });
  SessionNames session(std::move(names));
  session.each(method.body);
  return {session.used(), session.loop_variables()};
}

}  // namespace breve::steve
