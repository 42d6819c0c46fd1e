// Checks of the whole program after loading: calls that no class answers, controllers that forget their world. All
// are warnings: old programs that run must go on running. A call is complained of only where no receiver that it can
// have would answer it.
#include <algorithm>
#include <unordered_map>

#include "steve/code/wording.hpp"
#include "steve/compile/builder.hpp"
#include "steve/compile/function_compiler.hpp"
#include "steve/syntax/words.hpp"

namespace breve::steve {

namespace {

constexpr std::size_t kMostHeaders = 3;
constexpr std::size_t kMostUnknownMethods = 500;  // reported: looking for near names takes time

bool accepts(const MethodInfo& method, const CallSite& site) {
  if (method.parameters.size() < site.arguments.size()) return false;
  const auto given = [&](Symbol keyword) {
    return std::count_if(site.arguments.begin(), site.arguments.end(),
                         [&](const auto& a) { return a.keyword == keyword; });
  };
  std::ptrdiff_t taken = 0;
  for (const auto& p : method.parameters) {
    if (given(p.keyword) > 1 || (given(p.keyword) == 0 && !p.has_default)) return false;
    taken += given(p.keyword);
  }
  return taken == static_cast<std::ptrdiff_t>(site.arguments.size());
}

/// The classes that may answer a call: those above and below the one that the receiver is known to be of.
struct Receiver {
  const ClassInfo* cls = nullptr;  // null: any class
  bool above_only = false;         // super
  bool reaches(const ClassInfo& owner) const {
    return cls == nullptr || cls->derives_from(owner) || (!above_only && owner.derives_from(*cls));
  }
};

/// The class that an expression is known to give an object of; null if it is not known.
const ClassInfo* class_of(const ast::Expr& e, const ast::Method& method, const ClassInfo& cls, const Program& program) {
  if (std::holds_alternative<ast::Self>(e.node)) return &cls;
  if (const auto* made = std::get_if<ast::NewExpr>(&e.node); made && !made->count)
    return program.find_class(made->class_name);
  const auto* name = std::get_if<ast::Name>(&e.node);
  if (!name) return nullptr;
  const ast::TypeRef* type = nullptr;
  for (const auto& p : method.parameters)
    if (p.variable == name->name) type = &p.type;
  for (const auto& v : method.locals)
    if (v.name == name->name) type = &v.type;
  if (type) return type->class_name.empty() ? nullptr : program.find_class(type->class_name);
  const Symbol symbol = program.symbols().find(name->name);
  const auto* variable = symbol == kNoSymbol ? nullptr : cls.find_variable(symbol);
  if (!variable || variable->class_name == kNoSymbol) return nullptr;
  return program.find_class(program.symbols().name(variable->class_name));
}

}  // namespace

void ProgramBuilder::check_calls() {
  std::unordered_map<Symbol, std::vector<const MethodInfo*>> methods;
  for (const auto& cls : program_->classes_)
    for (const auto& method : cls->methods) methods[method->name].push_back(method.get());
  for (const auto& [tree, info] : declared_) {
    if (embedded(info->span)) continue;
    for (const auto& method : tree.methods) {
      const auto visit = [&, &owner = *info](const ast::Expr& e) {
        if (const auto* call = std::get_if<ast::Call>(&e.node))
          check_call(*call, e, method, owner, methods[symbol(call->selector)]);
      };
      for (const auto& statement : method.body) walk(*statement, visit);
    }
  }
}

void ProgramBuilder::check_call(const ast::Call& call, const ast::Expr& e, const ast::Method& method,
                                const ClassInfo& cls, const std::vector<const MethodInfo*>& named) {
  const bool super = std::holds_alternative<ast::Super>(call.receiver->node);
  if (super && call.selector == "init")
    lint(call.selector_span, "lint-super-init", "'super init' runs the parent's init a second time",
         "init methods are called automatically, the root's first: remove this call");
  if (call.selector == "iterate" && call.keywords.empty()) return;
  if (super && !cls.parent) return;
  const Receiver receiver{super ? cls.parent : class_of(*call.receiver, method, cls, *program_), super};
  check_method_named(call, super ? &cls : receiver.cls);
  CallSite site;
  site.selector = symbol(call.selector);
  site.span = call.selector_span;
  if (super) site.super_of = &cls;
  for (const auto& keyword : call.keywords)
    site.arguments.push_back({symbol(keyword.name), StaticType::Any, 0, -1, keyword.span});
  std::vector<const MethodInfo*> candidates;
  for (const auto* candidate : named) {
    if (!receiver.reaches(*candidate->owner)) continue;
    if (accepts(*candidate, site)) return;
    candidates.push_back(candidate);
  }
  if (candidates.empty()) return report_unknown_method(call, receiver.cls);
  if (candidates.size() == 1) {
    const auto fault = call_fault(site, *candidates.front(), program_->symbols(), program_->sources(), e.span);
    lint(fault.span.line != 0 ? fault.span : call.selector_span, "lint-keywords", fault.message, fault.help);
    return;
  }
  std::string help;
  for (std::size_t i = 0; i < std::min(candidates.size(), kMostHeaders); ++i)
    help += (i == 0 ? "it takes " : ", or ") + keyword_words(*candidates[i], program_->symbols()) + " (class " +
            candidates[i]->owner->name + ")";
  lint(call.selector_span, "lint-keywords",
       "no method '" + call.selector + "' takes " +
           (call.keywords.empty() ? std::string("a call without keywords") : "these keywords"),
       help);
}

// Calls that name a method in a string, which the world calls later: a wrong name is best reported before.
void ProgramBuilder::check_method_named(const ast::Call& call, const ClassInfo* receiver) {
  struct Naming {
    std::string_view selector, keyword;
    std::size_t most;  // parameters that the method may have
    const char* what;
  };
  static constexpr Naming kNamings[] = {
      {"schedule", "method-call", 0, "a scheduled call"},
      {"schedule-repeating", "method-call", 0, "a scheduled call"},
      {"handle-collisions", "with-method", 5, "a handler of collisions"},
      {"observe", "with-method", 2, "an observer"},
      {"add-menu", "for-method", 0, "an entry of a menu"},
  };
  for (const Naming& naming : kNamings) {
    if (call.selector != naming.selector) continue;
    for (const auto& keyword : call.keywords) {
      const auto* text = std::get_if<ast::StringLit>(&keyword.value->node);
      if (keyword.name != naming.keyword || !text || !text->parts.empty()) continue;
      const std::string& name = text->texts.front();
      const Symbol wanted = program_->symbols_.find(name);
      bool named = false;
      std::vector<std::string_view> near;
      for (const auto& cls : program_->classes_) {
        if (!Receiver{receiver, false}.reaches(*cls)) continue;
        for (const auto& method : cls->methods) {
          if (method->parameters.size() <= naming.most && method->name == wanted) return;
          named = named || method->name == wanted;
          if (method->parameters.size() <= naming.most && !embedded(method->span))
            near.push_back(symbol_name(method->name));
        }
      }
      const std::string likely = nearest(name, near);
      const std::string count =
          naming.most == 0 ? "without keywords" : "with at most " + std::to_string(naming.most) + " keywords";
      lint(keyword.value->span, "lint-unknown-method",
           receiver ? "class " + receiver->name + " has no method '" + name + "' " + count + ", which " + naming.what +
                          " needs"
                    : "no class has a method '" + name + "' " + count + ", which " + naming.what + " needs",
           !likely.empty() ? "did you mean '" + likely + "'?"
           : named         ? "remove the keywords, or name another method"
                           : "define it with: + to " + name + ":");
    }
  }
}

// A method that no class has: a variable, or a word of another language. "" if neither.
std::string ProgramBuilder::meant_by_method(const std::string& name) const {
  if (names_a_size(name)) return "the size of a list or of a text is written with bars: |list|";
  if (names_a_push(name)) return "to put a value into a list write: push value onto list";
  const Symbol wanted = program_->symbols_.find(name);
  for (const auto& cls : program_->classes_)
    for (const auto& v : cls->variables)
      if (v.name == wanted) return "'" + name + "' is a variable of class " + cls->name + ": write object::" + name;
  return {};
}

void ProgramBuilder::report_unknown_method(const ast::Call& call, const ClassInfo* cls) {
  if (++unknown_methods_ > kMostUnknownMethods) return;
  if (cls) {
    lint(call.selector_span, "lint-unknown-method",
         "neither class " + cls->name + " nor its parents and children have a method '" + call.selector + "'",
         unknown_method_help(call.selector, cls, *program_));
    return;
  }
  if (const std::string help = meant_by_method(call.selector); !help.empty()) {
    lint(call.selector_span, "lint-unknown-method", "no class has a method '" + call.selector + "'", help);
    return;
  }
  std::vector<std::string_view> selectors;
  for (const auto& known : program_->classes_)
    for (const auto& method : known->methods) selectors.push_back(symbol_name(method->name));
  std::sort(selectors.begin(), selectors.end());
  const auto near = nearest(call.selector, selectors);
  lint(call.selector_span, "lint-unknown-method", "no class has a method '" + call.selector + "'",
       near.empty() ? "define it with: + to " + call.selector + ":" : "did you mean '" + near + "'?");
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
      lint(method->span, "lint-special-parameters", "'" + name + "' with parameters is never called automatically",
           "remove the parameters, or give the method another name");
    }
}

// A call looks for the fewest parameters first: a parent's shorter method wins over one that only adds optional ones.
void ProgramBuilder::check_overrides() {
  for (const auto& cls : program_->classes_) {
    if (embedded(cls->span)) continue;
    for (const auto& method : cls->methods) {
      const MethodInfo* winner = nullptr;
      for (const ClassInfo* c = cls->parent; c && !winner; c = c->parent)
        for (const auto& other : c->methods) {
          if (other->name != method->name || other->parameters.size() >= method->parameters.size()) continue;
          const bool extends = std::all_of(method->parameters.begin(), method->parameters.end(), [&](const auto& p) {
            const bool shared = std::any_of(other->parameters.begin(), other->parameters.end(),
                                            [&](const auto& q) { return q.keyword == p.keyword; });
            return shared || p.has_default;
          });
          const bool own = cls->find_method(method->name, other->parameters.size()) != other.get();
          if (extends && !own) winner = other.get();
        }
      if (winner)
        lint(method->span, "lint-bypassed-override",
             "calls without the optional keywords reach '" + symbol_name(method->name) + "' of class " +
                 winner->owner->name + ", not this one",
             "also define it here with the parent's parameters, and call this one from there");
    }
  }
}

}  // namespace breve::steve
