// Checks of the whole program after loading: calls that no class answers, variables that nobody uses, controllers
// that forget their world. All are warnings: old programs that run must go on running.
#include <algorithm>
#include <set>

#include "steve/compile/builder.hpp"
#include "steve/compile/function_compiler.hpp"

namespace breve::steve {

void ProgramBuilder::check_calls() {
  std::set<std::string_view> names;
  for (const auto& cls : program_->classes_)
    for (const auto& method : cls->methods) names.insert(symbol_name(method->name));
  const std::vector<std::string_view> selectors(names.begin(), names.end());
  for (const auto& site : code().sites)
    if (!embedded(site.span)) check_site(site, selectors);
}

void ProgramBuilder::check_site(const CallSite& site, const std::vector<std::string_view>& selectors) {
  const auto& name = symbol_name(site.selector);
  if (site.super_of && name == "init")
    lint(site.span, "lint-super-init", "'super init' runs the parent's init a second time",
         "init methods are called by themselves, the root's first: remove this call");
  bool known = name == "iterate", fits = known;
  for (const auto& cls : program_->classes_) {
    for (const auto& method : cls->methods) {
      if (method->name != site.selector) continue;
      known = true;
      bool all = method->parameters.size() >= site.arguments.size();
      for (const auto& argument : site.arguments) {
        all = all && std::any_of(method->parameters.begin(), method->parameters.end(),
                                 [&](const auto& p) { return p.keyword == argument.keyword; });
      }
      fits = fits || all;
    }
  }
  if (!known) {
    const auto near = nearest(name, selectors);
    lint(site.span, "lint-unknown-method", "no class has a method '" + name + "'",
         near.empty() ? "" : "did you mean '" + near + "'?");
  } else if (!fits) {
    std::string keywords;
    for (const auto& argument : site.arguments)
      keywords += (keywords.empty() ? "" : " ") + symbol_name(argument.keyword);
    lint(site.span, "lint-keywords", "no method '" + name + "' takes the keywords: " + keywords);
  }
}

void ProgramBuilder::check_unused_variables() {
  std::set<std::string> used;
  for (const auto& [tree, info] : declared_) {
    for (const auto& method : tree.methods) {
      for (const auto& statement : method.body) {
        walk_statements(*statement, [&](const ast::Stmt& inner) {
          if (const auto* loop = std::get_if<ast::Foreach>(&inner.node)) used.insert(loop->variable);
        });
        walk(*statement, [&](const ast::Expr& e) {
          if (const auto* n = std::get_if<ast::Name>(&e.node)) used.insert(n->name);
          if (const auto* a = std::get_if<ast::ArrayItem>(&e.node)) used.insert(a->name);
          if (const auto* m = std::get_if<ast::Member>(&e.node)) used.insert(m->name);
          if (const auto* s = std::get_if<ast::StringLit>(&e.node)) {
            for (const auto& part : s->parts) used.insert(part.name);
            used.insert(s->texts.begin(), s->texts.end());
          }
        });
      }
    }
  }
  for (const auto& [tree, info] : declared_)
    for (const auto& v : tree.variables)
      if (!used.contains(v.name))
        lint(v.span, "lint-unused-variable", "instance variable '" + v.name + "' is never used");
}

void ProgramBuilder::check_iterate() {
  const auto* cls = program_->controller_;
  if (!cls || !cls->iterate || !cls->iterate->function || embedded(cls->iterate->span)) return;
  const auto iterate = symbol("iterate");
  for (const auto& site : code().sites)
    if (site.super_of && site.selector == iterate && site.in_class == cls->iterate->owner) return;
  lint(cls->iterate->span, "lint-no-super-iterate",
       "the controller's iterate does not call 'super iterate': the world stands still", "add: super iterate.");
}

void ProgramBuilder::check_special_methods() {
  for (const auto& cls : program_->classes_)
    for (const auto& method : cls->methods) {
      const auto& name = symbol_name(method->name);
      if (method->parameters.empty() ||
          (name != "init" && name != "iterate" && name != "post-iterate" && name != "destroy"))
        continue;
      lint(method->span, "lint-special-parameters", "'" + name + "' with parameters is never called by itself",
           "take the parameters away, or give the method another name");
    }
}

}  // namespace breve::steve
