// Checks of the whole program: variables and parameters that nobody uses, values that nobody gave.
#include <algorithm>
#include <set>
#include <unordered_map>

#include "steve/compile/builder.hpp"
#include "steve/compile/function_compiler.hpp"

namespace breve::steve {

namespace {

/// The names that a statement mentions, also in strings; and the texts of its strings.
void collect(const ast::Stmt& statement, std::set<std::string>& used) {
  walk_statements(statement, [&](const ast::Stmt& inner) {
    if (const auto* loop = std::get_if<ast::Foreach>(&inner.node)) used.insert(loop->variable);
  });
  walk(statement, [&](const ast::Expr& e) {
    if (const auto* n = std::get_if<ast::Name>(&e.node)) used.insert(n->name);
    if (const auto* a = std::get_if<ast::ArrayItem>(&e.node)) used.insert(a->name);
    if (const auto* m = std::get_if<ast::Member>(&e.node)) used.insert(m->name);
    if (const auto* s = std::get_if<ast::StringLit>(&e.node)) {
      for (const auto& part : s->parts) used.insert(part.name);
      used.insert(s->texts.begin(), s->texts.end());
    }
  });
}

bool returns_value(const ast::Method& method) {
  bool found = false;
  for (const auto& statement : method.body)
    walk_statements(*statement, [&](const ast::Stmt& inner) {
      const auto* result = std::get_if<ast::Return>(&inner.node);
      found = found || (result && result->value);
    });
  return found;
}

/// The calls in a statement whose value nobody takes.
std::set<const ast::Expr*> unused_calls(const ast::Stmt& statement) {
  std::set<const ast::Expr*> calls;
  walk_statements(statement, [&](const ast::Stmt& inner) {
    if (const auto* alone = std::get_if<ast::ExprStmt>(&inner.node)) calls.insert(alone->expr.get());
  });
  return calls;
}

}  // namespace

void ProgramBuilder::check_unused_variables() {
  std::set<std::string> used;
  for (const auto& [tree, info] : declared_)
    for (const auto& method : tree.methods)
      for (const auto& statement : method.body) collect(*statement, used);
  for (const auto& [tree, info] : declared_)
    for (const auto& v : tree.variables)
      if (!used.contains(v.name))
        lint(v.span, "lint-unused-variable", "the instance variable '" + v.name + "' is never used",
             "remove it, or use it");
  check_unused_parameters(used);
}

// A method that is named in a string may be a handler, and one that overrides or is overridden shares its parameters
// with others: these keep parameters that they do not need.
void ProgramBuilder::check_unused_parameters(const std::set<std::string>& words) {
  std::unordered_map<Symbol, int> definitions;
  for (const auto& cls : program_->classes_)
    for (const auto& method : cls->methods) ++definitions[method->name];
  for (const auto& [tree, info] : declared_) {
    if (embedded(info->span)) continue;
    for (const auto& method : tree.methods) {
      if (method.body.empty() || words.contains(method.name) || definitions[symbol(method.name)] > 1) continue;
      std::set<std::string> used;
      for (const auto& statement : method.body) collect(*statement, used);
      for (const auto& p : method.parameters)
        if (!used.contains(p.variable))
          lint(p.variable_span, "lint-unused-parameter", "the parameter '" + p.variable + "' is never used",
               "remove it with its keyword, here and in the calls");
    }
  }
}

void ProgramBuilder::check_implicit_returns() {
  std::unordered_map<Symbol, bool> explicit_value;  // of the methods of a name, does any say what it returns?
  for (const auto& [tree, info] : declared_)
    for (const auto& method : tree.methods) {
      bool& known = explicit_value[symbol(method.name)];
      known = known || method.native || returns_value(method);
    }
  for (const auto& [tree, info] : declared_) {
    if (embedded(info->span)) continue;
    for (const auto& method : tree.methods)
      for (const auto& statement : method.body) {
        const auto unused = unused_calls(*statement);
        walk(*statement, [&](const ast::Expr& e) {
          const auto* call = std::get_if<ast::Call>(&e.node);
          if (!call || unused.contains(&e)) return;
          const auto found = explicit_value.find(symbol(call->selector));
          if (found == explicit_value.end() || found->second) return;
          lint(call->selector_span, "lint-implicit-return",
               "no method '" + call->selector + "' has a 'return' with a value",
               "its value is that of its last expression, or none: end it with 'return value.'");
        });
      }
  }
}

}  // namespace breve::steve
