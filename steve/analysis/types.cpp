// Types from the text alone. Variables of type (object) and (list) say little: what is assigned to them or pushed onto
// them where that can be seen says more, and is good enough to suggest by, though nothing that the compiler may trust.
#include "steve/analysis/types.hpp"

#include <algorithm>
#include <functional>

#include "steve/compile/function_compiler.hpp"
#include "steve/compile/overloaded.hpp"
#include "steve/machine/native.hpp"

namespace breve::steve {

namespace {

using ast::TypeKind;

/// Methods that yield what other methods yield are followed this deep.
constexpr int kMaxDepth = 4;
/// Rounds of guessing: each may learn from what the one before found.
constexpr int kRounds = 3;

KnownType of(TypeKind kind, std::size_t cls = kNoIndex) { return {kind, cls}; }

class TypeFinder {
 public:
  TypeFinder(const Model& model, const Scope& scope, int depth) : model_(model), scope_(scope), depth_(depth) {}

  KnownType type(const ast::Expr& e) const {
    return std::visit(
        Overloaded{
            [](const ast::IntLit&) { return of(TypeKind::Int); },
            [](const ast::DoubleLit&) { return of(TypeKind::Double); },
            [](const ast::StringLit&) { return of(TypeKind::String); },
            [](const ast::ConstantExpr& c) { return constant(c); },
            [](const ast::VectorLit&) { return of(TypeKind::Vector); },
            [](const ast::MatrixLit&) { return of(TypeKind::Matrix); },
            [&](const ast::ListLit& l) { return list(l); },
            [&](const ast::Name& n) { return variable(n.name); },
            [&](const ast::ArrayItem& a) { return variable(a.name); },
            [&](const ast::IndexExpr& i) { return element(type(*i.base)); },
            [&](const ast::Member& m) { return member(m); },
            [&](const ast::Self&) { return of(TypeKind::Object, scope_.cls); },
            [&](const ast::Super&) {
              return of(TypeKind::Object, scope_.cls == kNoIndex ? kNoIndex : model_.classes[scope_.cls].parent);
            },
            [&](const ast::Call& c) { return call(c); },
            [&](const ast::FunctionCall& f) { return function(f); },
            [&](const ast::RandomExpr& r) { return type(*r.bound); },
            [&](const ast::NewExpr& n) {
              const auto* one = n.count ? std::get_if<ast::IntLit>(&n.count->node) : nullptr;
              const bool single = !n.count || (one != nullptr && one->value == 1);
              return of(single ? TypeKind::Object : TypeKind::List, model_.class_named(n.class_name));
            },
            [&](const ast::AllExpr& a) { return of(TypeKind::List, model_.class_named(a.class_name)); },
            [&](const ast::Unary& u) { return u.op == ast::UnaryOp::Not ? of(TypeKind::Int) : type(*u.operand); },
            [&](const ast::Chain& c) { return chain(c); },
            [](const ast::Magnitude&) { return of(TypeKind::Double); },
            [&](const ast::Assign& a) { return type(*a.value); },
            [&](const ast::Step& s) { return type(*s.target); },
            [&](const ast::Pop& p) { return element(type(*p.list)); },
            [&](const ast::CopyList& c) { return type(*c.list); },
            [](const auto&) { return KnownType(); },
        },
        e.node);
  }

 private:
  static KnownType constant(const ast::ConstantExpr& c) {
    constexpr TypeKind kKinds[] = {TypeKind::Int, TypeKind::Double, TypeKind::String, TypeKind::Vector,
                                   TypeKind::Matrix};
    return of(kKinds[c.constant.value.index()]);
  }

  KnownType list(const ast::ListLit& l) const {
    KnownType result = of(TypeKind::List);
    for (const ast::ExprPtr& item : l.elements) {
      const KnownType one = type(*item);
      if (one.kind != TypeKind::Object) return of(TypeKind::List);
      if (result.cls != kNoIndex && result.cls != one.cls) return of(TypeKind::List);
      result.cls = one.cls;
    }
    return result;
  }

  // The object's variable `controller` is known by the program's choice.
  KnownType variable(std::string_view name) const {
    const std::size_t symbol = model_.find_variable(scope_.cls, scope_.method, name);
    return symbol == kNoIndex ? KnownType() : known(symbol);
  }

  KnownType known(std::size_t symbol) const {
    KnownType result = model_.types[symbol];
    const SymbolInfo& info = model_.symbols[symbol];
    if (result.cls == kNoIndex && info.library && info.name == "controller") result.cls = model_.controller;
    return result;
  }

  static KnownType element(const KnownType& base) {
    if (base.kind == TypeKind::List && base.cls != kNoIndex) return of(TypeKind::Object, base.cls);
    if (base.kind == TypeKind::Vector || base.kind == TypeKind::Matrix) return of(TypeKind::Double);
    if (base.kind == TypeKind::String) return of(TypeKind::String);
    return {};
  }

  KnownType member(const ast::Member& m) const {
    const KnownType base = type(*m.base);
    if (base.kind == TypeKind::Vector && m.letter != 0) return of(TypeKind::Double);
    if (base.kind != TypeKind::Object) return {};
    const std::size_t symbol = model_.find_member(base.cls, m.name);
    return symbol == kNoIndex ? KnownType() : known(symbol);
  }

  // A native says what it yields; a method in steve yields what all its returns agree on.
  KnownType call(const ast::Call& c) const {
    const KnownType receiver = type(*c.receiver);
    if (c.selector == "get-controller" && c.keywords.empty()) return of(TypeKind::Object, model_.controller);
    if (receiver.kind != TypeKind::Object || receiver.cls == kNoIndex) return {};
    const std::vector<MethodIndex> found = methods_of_call(model_, receiver, c.selector, keywords_of(c));
    if (found.empty()) return {};
    const MethodModel& method = model_.method(found.front());
    if (method.tree->native_result)
      return of(method.tree->native_result->kind, model_.class_named(method.tree->native_result->class_name));
    if (method.tree->native || depth_ >= kMaxDepth) return {};
    // What `self` is there, the receiver is.
    const Scope inside{std::holds_alternative<ast::Super>(c.receiver->node) ? scope_.cls : receiver.cls, &method};
    return result_of(inside);
  }

  KnownType result_of(const Scope& inside) const {
    const TypeFinder finder(model_, inside, depth_ + 1);
    std::optional<KnownType> result;
    bool agreed = true;
    for (const ast::StmtPtr& statement : inside.method->tree->body) {
      walk_statements(*statement, [&](const ast::Stmt& s) {
        const auto* yields = std::get_if<ast::Return>(&s.node);
        if (yields == nullptr || yields->value == nullptr || !agreed) return;
        const KnownType one = finder.type(*yields->value);
        if (result && (result->kind != one.kind || result->cls != one.cls)) agreed = false;
        result = one;
      });
    }
    return result && agreed ? *result : KnownType();
  }

  KnownType function(const ast::FunctionCall& f) const {
    if (f.name == "getController") return of(TypeKind::Object, model_.controller);
    for (const Native& native : functions())
      if (native.name == f.name) return of_letter(native.signature.back());
    for (const auto& foreign : model_.foreign)
      if (foreign->name() == f.name) return of_letter(foreign->signature().back());
    return {};
  }

  static KnownType of_letter(char letter) {
    switch (letter) {
      case 'i': return of(TypeKind::Int);
      case 'd': return of(TypeKind::Double);
      case 'v': return of(TypeKind::Vector);
      case 'm': return of(TypeKind::Matrix);
      case 's': return of(TypeKind::String);
      case 'o': return of(TypeKind::Object);
      case 'l': return of(TypeKind::List);
      case 'h': return of(TypeKind::Hash);
      case 'p': return of(TypeKind::Pointer);
      default: return {};
    }
  }

  KnownType chain(const ast::Chain& c) const {
    const ast::BinaryOp op = c.rest.front().first;
    if (op >= ast::BinaryOp::Lt) return of(TypeKind::Int);
    KnownType result = type(*c.first);
    for (const auto& [next, operand] : c.rest) {
      const KnownType right = type(*operand);
      const bool wider = right.kind == TypeKind::Vector || right.kind == TypeKind::Matrix;
      if (!result.kind || !right.kind) return {};
      if (wider || (result.kind == TypeKind::Int && right.kind == TypeKind::Double)) result = right;
    }
    return result;
  }

  const Model& model_;
  const Scope& scope_;
  int depth_;
};

/// Guesses the classes behind plain objects and lists.
class Guesser {
 public:
  explicit Guesser(Model& model) : model_(model), open_(model.types.size(), false) {}

  void run() {
    declare();
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t c = 0; c < model_.classes.size(); ++c) {
        if (!model_.classes[c].loaded) continue;
        for (const MethodModel& method : model_.classes[c].methods) {
          const Scope scope{c, &method};
          for (const ast::StmtPtr& statement : method.tree->body) learn(scope, *statement);
        }
      }
    }
  }

 private:
  void declare_one(std::size_t symbol, const ast::TypeRef& type) {
    KnownType& known = model_.types[symbol];
    known.cls = type.class_name.empty() ? kNoIndex : model_.class_named(type.class_name);
    open_[symbol] = type.class_name.empty() && (known.kind == TypeKind::Object || known.kind == TypeKind::List);
  }

  void declare() {
    for (const ClassModel& cls : model_.classes) {
      for (std::size_t i = 0; i < cls.tree->variables.size(); ++i)
        declare_one(cls.variables + i, cls.tree->variables[i].type);
      for (const MethodModel& method : cls.methods) {
        for (std::size_t i = 0; i < method.tree->parameters.size(); ++i) {
          declare_one(method.parameters + 2 * i, method.tree->parameters[i].type);
          declare_one(method.parameters + 2 * i + 1, method.tree->parameters[i].type);
        }
        for (std::size_t i = 0; i < method.tree->locals.size(); ++i)
          declare_one(method.locals + i, method.tree->locals[i].type);
      }
    }
  }

  void learn(const Scope& scope, const ast::Stmt& statement) {
    walk_statements(statement, [&](const ast::Stmt& s) {
      const auto* loop = std::get_if<ast::Foreach>(&s.node);
      if (loop == nullptr) return;
      const KnownType list = type_of(model_, scope, *loop->list);
      if (list.kind == TypeKind::List) meet(scope, loop->variable, TypeKind::Object, list.cls);
    });
    walk(statement, [&](const ast::Expr& e) {
      if (const auto* assign = std::get_if<ast::Assign>(&e.node)) {
        const auto* target = std::get_if<ast::Name>(&assign->target->node);
        if (target == nullptr || assign->op) return;
        const KnownType value = type_of(model_, scope, *assign->value);
        if (value.kind) meet(scope, target->name, *value.kind, value.cls);
      }
      if (const auto* push = std::get_if<ast::Push>(&e.node)) {
        const auto* target = std::get_if<ast::Name>(&push->list->node);
        if (target == nullptr) return;
        const KnownType value = type_of(model_, scope, *push->value);
        if (value.kind == TypeKind::Object) meet(scope, target->name, TypeKind::List, value.cls);
      }
    });
  }

  // A variable holds one more class: the nearest ancestor of all that it holds is what is known of it.
  void meet(const Scope& scope, std::string_view name, TypeKind kind, std::size_t cls) {
    const std::size_t symbol = model_.find_variable(scope.cls, scope.method, name);
    if (symbol == kNoIndex || cls == kNoIndex || !open_[symbol] || model_.types[symbol].kind != kind) return;
    std::size_t& known = model_.types[symbol].cls;
    if (known == kNoIndex) {
      known = cls;
      return;
    }
    for (const std::size_t ancestor : model_.line(known)) {
      if (!model_.derives_from(cls, ancestor)) continue;
      known = ancestor;
      return;
    }
  }

  Model& model_;
  std::vector<bool> open_;  // declared without a class
};

}  // namespace

KnownType type_of(const Model& model, const Scope& scope, const ast::Expr& expr) {
  return TypeFinder(model, scope, 0).type(expr);
}

void guess_types(Model& model) { Guesser(model).run(); }

std::vector<std::string_view> keywords_of(const ast::Call& call) {
  std::vector<std::string_view> keywords;
  for (const ast::Keyword& keyword : call.keywords) keywords.emplace_back(keyword.name);
  return keywords;
}

std::vector<MethodIndex> methods_of_call(const Model& model, const KnownType& receiver, std::string_view selector,
                                         const std::vector<std::string_view>& keywords) {
  const auto takes_all = [&](const MethodIndex& index) {
    const std::vector<ast::Parameter>& parameters = model.method(index).tree->parameters;
    return std::all_of(keywords.begin(), keywords.end(), [&](std::string_view keyword) {
      return std::any_of(parameters.begin(), parameters.end(), [&](const auto& p) { return p.keyword == keyword; });
    });
  };
  const auto count = [&](const MethodIndex& index) { return model.method(index).tree->parameters.size(); };
  const auto [first, last] = model.selectors.equal_range(selector);
  const bool known = receiver.cls != kNoIndex;
  const std::vector<std::size_t> line = known ? model.line(receiver.cls) : std::vector<std::size_t>();
  struct Candidate {
    MethodIndex index;
    std::size_t rank;
  };
  // Fit before unfit, the program's before the rest, the receiver's own before inherited, few keywords before many.
  std::vector<Candidate> found;
  for (auto at = first; at != last; ++at) {
    const MethodIndex index = at->second;
    const auto step = std::find(line.begin(), line.end(), index.cls);
    if (known && step == line.end()) continue;
    const std::size_t far = known ? static_cast<std::size_t>(step - line.begin()) : 0;
    const std::size_t unloaded = model.classes[index.cls].loaded ? 0 : 1;
    found.push_back(
        {index, (((takes_all(index) ? 0U : 1U) * 2 + unloaded) * 1000 + std::min<std::size_t>(far, 999)) * 1000 +
                    std::min<std::size_t>(count(index), 999)});
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.rank < b.rank; });
  std::vector<MethodIndex> result;
  const bool any_fits = !found.empty() && takes_all(found.front().index);
  for (const Candidate& candidate : found)
    if (!any_fits || takes_all(candidate.index)) result.push_back(candidate.index);
  return result;
}

std::string type_name(const Model& model, const KnownType& type) {
  if (!type.kind) return {};
  const std::string cls = type.cls == kNoIndex ? std::string() : model.classes[type.cls].tree->name;
  switch (*type.kind) {
    case TypeKind::Int: return "int";
    case TypeKind::Double: return "float";
    case TypeKind::Vector: return "vector";
    case TypeKind::Matrix: return "matrix";
    case TypeKind::String: return "string";
    case TypeKind::Object: return cls.empty() ? "object" : cls + " object";
    case TypeKind::List: return "list";
    case TypeKind::Hash: return "hash";
    case TypeKind::Pointer: return "pointer";
    case TypeKind::Data: return "data";
  }
  return {};
}

}  // namespace breve::steve
