// Types of expressions, from what is written, declared and returned.
#include "steve/compile/value_types.hpp"

#include "steve/compile/function_compiler.hpp"
#include "steve/compile/overloaded.hpp"

namespace breve::steve {

namespace {

bool is_a_number(StaticType t) { return t == StaticType::Int || t == StaticType::Double; }

StaticType number_of(StaticType t) { return t == StaticType::Int ? StaticType::Int : StaticType::Double; }

StaticType of_constant(const ast::Constant& constant) {
  return std::visit(Overloaded{
                        [](std::int32_t) { return StaticType::Int; },
                        [](double) { return StaticType::Double; },
                        [](const std::string&) { return StaticType::String; },
                        [](const auto&) { return StaticType::Any; },
                    },
                    constant.value);
}

StaticType of_letter(char letter) {
  switch (letter) {
    case 'i': return StaticType::Int;
    case 'd': return StaticType::Double;
    case 's': return StaticType::String;
    case 'l': return StaticType::List;
    case 'v': return StaticType::Vector;
    default: return StaticType::Any;
  }
}

}  // namespace

void ValueTypes::add(const ClassInfo& cls, const ast::Method& method, const MethodInfo& info) {
  methods_[info.name].push_back({&cls, &method, &info});
}

StaticType ValueTypes::combined(ast::BinaryOp op, StaticType left, StaticType right) {
  using enum ast::BinaryOp;
  if (op >= Lt) return StaticType::Int;
  if (left == StaticType::Int && right == StaticType::Int) return StaticType::Int;
  const auto text = [](StaticType t) { return t == StaticType::String; };
  if (text(left) && text(right)) return op == Add ? StaticType::String : StaticType::Double;
  const auto counts = [&](StaticType t) { return is_a_number(t) || text(t) || t == StaticType::List; };
  return counts(left) && counts(right) ? StaticType::Double : StaticType::Any;
}

StaticType ValueTypes::of(const ast::Expr& e, const ast::Method& method, const ClassInfo& cls) {
  const auto inner = [&](const ast::ExprPtr& p) { return of(*p, method, cls); };
  return std::visit(Overloaded{
                        [](const ast::IntLit&) { return StaticType::Int; },
                        [](const ast::DoubleLit&) { return StaticType::Double; },
                        [](const ast::StringLit&) { return StaticType::String; },
                        [](const ast::VectorLit&) { return StaticType::Vector; },
                        [](const ast::ListLit&) { return StaticType::List; },
                        [](const ast::CopyList&) { return StaticType::List; },
                        [](const ast::AllExpr&) { return StaticType::List; },
                        [](const ast::Step&) { return StaticType::Double; },
                        [](const ast::ConstantExpr& c) { return of_constant(c.constant); },
                        [&](const ast::Name& n) { return of_name(n.name, method, cls); },
                        [&](const ast::ArrayItem& a) { return of_name(a.name, method, cls); },
                        [&](const ast::Member& m) {
                          return m.letter != 0 && inner(m.base) == StaticType::Vector ? StaticType::Double
                                                                                      : StaticType::Any;
                        },
                        [&](const ast::RandomExpr& r) { return inner(r.bound); },
                        [&](const ast::Magnitude& m) {
                          const StaticType t = inner(m.operand);
                          return t == StaticType::List || t == StaticType::String ? StaticType::Int : number_of(t);
                        },
                        [&](const ast::Unary& u) {
                          if (u.op == ast::UnaryOp::Not) return StaticType::Int;
                          const StaticType t = inner(u.operand);
                          return t == StaticType::String ? StaticType::Double : t;
                        },
                        [&](const ast::Chain& c) {
                          StaticType t = inner(c.first);
                          for (const auto& [op, right] : c.rest) t = combined(op, t, inner(right));
                          return t;
                        },
                        [&](const ast::FunctionCall& f) {
                          const auto entry = scope_.find_function(f.name, f.arguments.size());
                          return entry ? of_letter(entry->signature.back()) : StaticType::Any;
                        },
                        [&](const ast::Call& c) { return of_call(c, cls); },
                        [](const auto&) { return StaticType::Any; },
                    },
                    e.node);
}

StaticType ValueTypes::of_name(std::string_view name, const ast::Method& method, const ClassInfo& cls) const {
  for (const auto& p : method.parameters)
    if (p.variable == name) return p.type.broken ? StaticType::Any : static_type(p.type.kind);
  for (const auto& v : method.locals)
    if (v.name == name) return v.type.broken ? StaticType::Any : static_type(v.type.kind);
  const Symbol symbol = program_.symbols().find(name);
  const VariableInfo* variable = symbol == kNoSymbol ? nullptr : cls.find_variable(symbol);
  return variable && variable->array_size != kBrokenType ? variable->type : StaticType::Any;
}

// All methods that may answer give the same type, or it is not known.
StaticType ValueTypes::of_call(const ast::Call& call, const ClassInfo& cls) {
  const Symbol symbol = program_.symbols().find(call.selector);
  const auto found = symbol == kNoSymbol ? methods_.end() : methods_.find(symbol);
  if (found == methods_.end()) return StaticType::Any;
  const bool to_self = std::holds_alternative<ast::Self>(call.receiver->node);
  std::optional<StaticType> type;
  for (Known& method : found->second) {
    if (method.info->parameters.size() < call.keywords.size()) continue;
    if (to_self && !cls.derives_from(*method.cls) && !method.cls->derives_from(cls)) continue;
    const StaticType t = of_method(method);
    if (type && *type != t && !(is_a_number(*type) && is_a_number(t))) return StaticType::Any;
    type = t;
  }
  return type.value_or(StaticType::Any);
}

StaticType ValueTypes::of_method(Known& method) {
  if (method.state == Known::State::Done) return method.type;
  if (method.state == Known::State::Busy) return StaticType::Any;
  method.state = Known::State::Busy;
  std::optional<StaticType> type;
  if (method.tree->native) {
    type = method.info->native_result;
  } else {
    for (const auto& statement : method.tree->body)
      walk_statements(*statement, [&](const ast::Stmt& inner) {
        const auto* result = std::get_if<ast::Return>(&inner.node);
        if (!result) return;
        const StaticType t = result->value ? of(*result->value, *method.tree, *method.cls) : StaticType::Any;
        type = !type || *type == t ? t : is_a_number(*type) && is_a_number(t) ? StaticType::Double : StaticType::Any;
      });
  }
  method.type = type.value_or(StaticType::Any);
  method.state = Known::State::Done;
  return method.type;
}

}  // namespace breve::steve
