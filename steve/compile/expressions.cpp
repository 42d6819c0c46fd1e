// Expressions to bytecode: which function compiles which, names, indices, members.
#include "steve/compile/builder.hpp"
#include "steve/compile/function_compiler.hpp"
#include "steve/compile/overloaded.hpp"

namespace breve::steve {

Operand FunctionCompiler::expr(const ast::Expr& e, const Operand* into) {
  const Span outer = emit_.span();
  emit_.at(e.span);
  const auto value = std::visit(Overloaded{
                                    [&](const ast::IntLit& x) { return literal(x, into); },
                                    [&](const ast::DoubleLit& x) { return literal(x, into); },
                                    [&](const ast::StringLit& x) { return string(x, e, into); },
                                    [&](const ast::ConstantExpr& x) { return constant(x.constant, into); },
                                    [&](const ast::VectorLit& x) { return vector(x); },
                                    [&](const ast::MatrixLit& x) { return matrix(x); },
                                    [&](const ast::ListLit& x) { return list(x); },
                                    [&](const ast::Name& x) { return name(x, e); },
                                    [&](const ast::ArrayItem& x) { return array_item(x, e); },
                                    [&](const ast::IndexExpr& x) { return index(x, e); },
                                    [&](const ast::Member& x) { return member(x, e); },
                                    [&](const ast::Self&) {
                                      const auto target = result(StaticType::Object, into);
                                      emit_.emit(Op::LoadSelf, target.slot);
                                      return target;
                                    },
                                    [&](const ast::Super&) {
                                      const auto target = result(StaticType::Object, into);
                                      emit_.emit(class_.parent ? Op::LoadSelf : Op::ZeroRef, target.slot);
                                      return target;
                                    },
                                    [&](const ast::Call& x) {
                                      call(x, e);
                                      return dynamic_result();
                                    },
                                    [&](const ast::FunctionCall& x) { return function_call(x, e, into); },
                                    [&](const ast::RandomExpr& x) { return random(x); },
                                    [&](const ast::NewExpr& x) { return make_new(x); },
                                    [&](const ast::AllExpr& x) { return all(x); },
                                    [&](const ast::Unary& x) { return unary(x, e, into); },
                                    [&](const ast::Chain& x) { return chain(x, e, into); },
                                    [&](const ast::Magnitude& x) { return magnitude(x, into); },
                                    [&](const ast::Assign& x) { return assign(x, e); },
                                    [&](const ast::Step& x) { return step(x, e); },
                                    [&](const ast::Push& x) { return push(x); },
                                    [&](const ast::Pop& x) { return pop(x); },
                                    [&](const ast::Insert& x) { return insert(x); },
                                    [&](const ast::Remove& x) { return remove(x); },
                                    [&](const ast::CopyList& x) { return copy_list(x); },
                                    [&](const ast::Sort& x) {
                                      sort(x);
                                      const auto target = emit_.temporary(StaticType::Any);
                                      zero(target);
                                      return target;
                                    },
                                },
                                e.node);
  emit_.at(outer);
  return value;
}

Operand FunctionCompiler::name(const ast::Name& n, const ast::Expr& e) {
  const auto variable = need(n.name, e.span);
  if (!variable) {
    const auto target = emit_.temporary(StaticType::Any);
    zero(target);
    return target;
  }
  if (variable->array_size() >= 0) {
    builder_.diagnostics().error(e.span, "whole-array",
                                 "'" + n.name + "' is an array and can only be used element by element",
                                 "write " + n.name + "[i]");
  }
  return read(*variable);
}

Operand FunctionCompiler::read(const Variable& variable) {
  const auto type = variable.type();
  if (variable.local) {
    variable.local->used = true;
    if (type == StaticType::List) emit_.emit(Op::EnsureList, variable.local->slot);
    if (type == StaticType::Hash) emit_.emit(Op::EnsureHash, variable.local->slot);
    return {type, variable.local->slot, false};
  }
  const auto target = emit_.temporary(type);
  const int n = slot_count(type);
  const Op op = type == StaticType::List   ? Op::GetVarList
                : type == StaticType::Hash ? Op::GetVarHash
                : n == 1                   ? Op::GetVar1
                : n == 3                   ? Op::GetVar3
                                           : Op::GetVar9;
  emit_.emit_imm(op, target.slot, static_cast<std::int32_t>(variable.member->slot));
  return target;
}

Operand FunctionCompiler::array_item(const ast::ArrayItem& a, const ast::Expr& e) {
  const auto variable = need(a.name, e.span);
  if (!variable) return expr(*a.index);
  const auto slot = array_slot(*variable, *a.index, a.name);
  const auto value = read_array(*variable, slot);
  emit_.release(slot);
  return value;
}

Operand FunctionCompiler::array_slot(const Variable& variable, const ast::Expr& index, std::string_view name) {
  if (variable.array_size() < 0) {
    if (variable.local) variable.local->used = true;
    if (variable.array_size() != kBrokenType)
      builder_.diagnostics().error(
          emit_.span(), "not-an-array", "'" + std::string(name) + "' is not an array",
          "elements of lists, hashes and vectors are taken with braces: " + std::string(name) + "{i}");
    return emit_.temporary(StaticType::Int);
  }
  if (variable.local) variable.local->used = true;
  const auto position = convert(expr(index), StaticType::Int, text("index of array '" + std::string(name) + "'"));
  const auto slot = emit_.temporary(StaticType::Int);
  emit_.emit(Op::ArraySlot, slot.slot, position.slot, static_cast<std::uint16_t>(slot_count(variable.type())));
  emit_.ext(0, variable.array_size());
  emit_.ext(0, static_cast<std::int32_t>(variable.local ? variable.local->slot : variable.member->slot));
  emit_.release(position);
  return slot;
}

Operand FunctionCompiler::read_array(const Variable& variable, const Operand& slot) {
  const auto type = variable.type();
  const auto target = emit_.temporary(type);
  const auto flags = static_cast<std::uint16_t>(slot_count(type) | (variable.local ? kFrameArray : 0));
  const Op op = type == StaticType::List   ? Op::ArrayGetList
                : type == StaticType::Hash ? Op::ArrayGetHash
                                           : Op::ArrayGet;
  emit_.emit(op, target.slot, slot.slot, flags);
  return target;
}

Operand FunctionCompiler::index(const ast::IndexExpr& i, const ast::Expr& e) {
  const auto base = stable(expr(*i.base), *i.index);
  emit_.at(e.span);
  return index_of(base, *i.index);
}

Operand FunctionCompiler::index_of(const Operand& base, const ast::Expr& key) {
  if (base.type == StaticType::List) {
    const auto position = expr(key);
    if (position.type == StaticType::Int) return emit_binary(Op::IndexList, StaticType::Any, base, position, nullptr);
    const auto container = boxed(base);
    return emit_binary(Op::Index, StaticType::Any, container, boxed(position), nullptr);
  }
  const auto container = boxed(base);
  return emit_binary(Op::Index, StaticType::Any, container, any(key), nullptr);
}

std::uint32_t FunctionCompiler::member_site(std::string_view name) {
  auto& members = builder_.code().members;
  const std::int32_t axis = name == "x" ? 0 : name == "y" ? 1 : name == "z" ? 2 : -1;
  members.push_back({builder_.symbol(name), builder_.string_number(name), axis});
  return static_cast<std::uint32_t>(members.size() - 1);
}

Operand FunctionCompiler::member(const ast::Member& m, const ast::Expr& e) {
  const int axis = m.name == "x" ? 0 : m.name == "y" ? 1 : m.name == "z" ? 2 : -1;
  if (const auto* n = std::get_if<ast::Name>(&m.base->node); n && axis >= 0) {
    const auto variable = find(n->name);
    if (variable && variable->type() == StaticType::Vector && variable->array_size() < 0) {
      if (variable->local) {
        variable->local->used = true;
        return {StaticType::Double, static_cast<std::uint16_t>(variable->local->slot + axis), false};
      }
      const auto target = emit_.temporary(StaticType::Double);
      emit_.emit_imm(Op::GetVar1, target.slot, static_cast<std::int32_t>(variable->member->slot) + axis);
      return target;
    }
  }
  const auto base = expr(*m.base);
  emit_.at(e.span);
  if (base.type == StaticType::Vector && axis >= 0) {
    const auto target = emit_.temporary(StaticType::Double);
    emit_.emit(Op::Mov1, target.slot, static_cast<std::uint16_t>(base.slot + axis));
    emit_.release(base);
    return target;
  }
  return member_of(base, member_site(m.name));
}

Operand FunctionCompiler::member_of(const Operand& base, std::uint32_t site) {
  const auto container = boxed(base);
  const auto target = emit_.temporary(StaticType::Any);
  emit_.emit(Op::Member, target.slot, container.slot);
  emit_.ext(0, static_cast<std::int32_t>(site));
  emit_.release(container);
  return target;
}

}  // namespace breve::steve
