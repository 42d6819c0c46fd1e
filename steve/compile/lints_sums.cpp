// Checks of the whole program: sums whose operands are of types that give no error, and never what was meant.
#include "steve/compile/builder.hpp"
#include "steve/compile/function_compiler.hpp"
#include "steve/compile/value_types.hpp"

namespace breve::steve {

namespace {

bool is_text(StaticType t) { return t == StaticType::String; }
bool is_list(StaticType t) { return t == StaticType::List; }
bool counts(StaticType t) { return t == StaticType::Int || t == StaticType::Double || is_list(t); }

enum class Sum { Fine, OfText, OfLists };

Sum sum_of(StaticType left, StaticType right) {
  if ((is_text(left) && counts(right)) || (counts(left) && is_text(right))) return Sum::OfText;
  return is_list(left) && is_list(right) ? Sum::OfLists : Sum::Fine;
}

/// Only for the sum in an expression itself, not in its parts.
Sum sum_in(const ast::Expr& e, ValueTypes& types, const ast::Method& method, const ClassInfo& cls) {
  if (const auto* assign = std::get_if<ast::Assign>(&e.node); assign && assign->op == ast::BinaryOp::Add)
    return sum_of(types.of(*assign->target, method, cls), types.of(*assign->value, method, cls));
  const auto* chain = std::get_if<ast::Chain>(&e.node);
  if (!chain) return Sum::Fine;
  StaticType left = types.of(*chain->first, method, cls);
  for (const auto& [op, operand] : chain->rest) {
    const StaticType right = types.of(*operand, method, cls);
    if (op == ast::BinaryOp::Add)
      if (const Sum sum = sum_of(left, right); sum != Sum::Fine) return sum;
    left = ValueTypes::combined(op, left, right);
  }
  return Sum::Fine;
}

}  // namespace

void ProgramBuilder::check_sums() {
  ValueTypes types(*program_, *this);
  for (const auto& [tree, info] : declared_)
    for (const auto& method : tree.methods)
      if (const MethodInfo* made = info->own_method(symbol(method.name), method.parameters.size()))
        types.add(*info, method, *made);
  for (const auto& [tree, info] : declared_) {
    if (embedded(info->span)) continue;
    for (const auto& method : tree.methods)
      for (const auto& statement : method.body)
        walk(*statement, [&, &cls = *info, &in = method](const ast::Expr& e) {
          const Sum sum = sum_in(e, types, in, cls);
          if (sum == Sum::OfText) lint_text_sum(e.span);
          if (sum == Sum::OfLists) lint_list_sum(e.span);
        });
  }
}

}  // namespace breve::steve
