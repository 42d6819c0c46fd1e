// Assignment to every kind of place: the parts of the target are evaluated once, in =, op=, ++ and --.
#include "steve/compile/builder.hpp"
#include "steve/compile/function_compiler.hpp"

namespace breve::steve {

Operand FunctionCompiler::assign(const ast::Assign& a, const ast::Expr& e) {
  if (const auto* n = std::get_if<ast::Name>(&a.target->node)) {
    const auto variable = need(n->name, a.target->span);
    if (!variable) return expr(*a.value);
    if (variable->array_size() >= 0) {
      builder_.diagnostics().error(a.target->span, "whole-array",
                                   "'" + n->name + "' is an array and can only be assigned element by element",
                                   "write " + n->name + "[i] = ...");
      return expr(*a.value);
    }
    if (!a.op) return assign_to_variable(*variable, n->name, *a.value);
    const auto current = stable(read(*variable), *a.value);
    const auto value = operand(*a.value);
    emit_.at(e.span);
    const Operand local{variable->type(), variable->local ? variable->local->slot : std::uint16_t{0}, false};
    const bool direct = variable->local && variable->class_name() == kNoSymbol;
    return store_variable(*variable, n->name, changed(*a.op, current, value, direct ? &local : nullptr));
  }
  auto target = target_of(*a.target);
  if (!a.op) {
    const auto value = expr(*a.value);
    emit_.at(e.span);
    const auto stored = store(target, value);
    release(target);
    return stored;
  }
  const auto current = stable(load(target), *a.value);
  const auto value = operand(*a.value);
  emit_.at(e.span);
  const auto stored = store(target, changed(*a.op, current, value, nullptr));
  release(target);
  return stored;
}

/// current op value, for op=, ++ and --: what counts starts at 0 where a hash has no such key yet.
Operand FunctionCompiler::changed(ast::BinaryOp op, const Operand& current, const Operand& value, const Operand* into) {
  const bool counts = value.type == StaticType::Int || value.type == StaticType::Any;
  if (current.type != StaticType::Any || !counts) return binary(op, current, value, into);
  const auto left = boxed(current);
  const auto right = boxed(value);
  const auto target = emit_.temporary(StaticType::Any);
  emit_.emit(Op::Binary, target.slot, left.slot, right.slot);
  emit_.ext(static_cast<std::uint16_t>(op), kAbsentIsZero);
  emit_.release(left);
  emit_.release(right);
  return target;
}

Operand FunctionCompiler::step(const ast::Step& s, const ast::Expr& e) {
  if (const auto* n = std::get_if<ast::Name>(&s.target->node)) {
    const auto variable = need(n->name, s.target->span);
    if (!variable) return literal(ast::IntLit{0}, nullptr);
    if (variable->type() == StaticType::Int && variable->array_size() < 0 && variable->local) {
      variable->local->used = true;
      const auto slot = variable->local->slot;
      emit_.emit(Op::AddIntImm, slot, slot, static_cast<std::uint16_t>(static_cast<std::int16_t>(s.delta)));
      return {StaticType::Int, slot, false};
    }
  }
  auto target = target_of(*s.target);
  const auto current = load(target);
  emit_.at(e.span);
  const auto one =
      current.type == StaticType::Double ? literal(ast::DoubleLit{1.0}, nullptr) : literal(ast::IntLit{1}, nullptr);
  const auto stored =
      store(target, changed(s.delta > 0 ? ast::BinaryOp::Add : ast::BinaryOp::Sub, current, one, nullptr));
  release(target);
  return stored;
}

Operand FunctionCompiler::assign_to_variable(const Variable& variable, std::string_view name, const ast::Expr& value) {
  const bool direct = variable.local && variable.class_name() == kNoSymbol;
  const Operand local{variable.type(), variable.local ? variable.local->slot : std::uint16_t{0}, false};
  const Span span = emit_.span();
  if (const auto* c = std::get_if<ast::Call>(&value.node)) {
    call(*c, value);
    emit_.at(span);
    return store_variable(variable, name, {StaticType::Any, kResult, false});
  }
  const auto right = expr(value, direct ? &local : nullptr);
  emit_.at(span);
  return store_variable(variable, name, right);
}

Operand FunctionCompiler::store_variable(const Variable& variable, std::string_view name, const Operand& value) {
  const auto type = variable.type();
  const auto what = text_for(variable, name);
  if (variable.local) {
    const Operand local{type, variable.local->slot, false};
    const bool checked = variable.class_name() != kNoSymbol;
    const auto converted = convert(value, type, what, checked ? nullptr : &local);
    if (checked) check_class(converted, variable.class_name(), what);
    move(local, converted);
    emit_.release(converted);
    return local;
  }
  const auto converted = convert(value, type, what);
  check_class(converted, variable.class_name(), what);
  write_member(*variable.member, converted);
  return converted;
}

void FunctionCompiler::write_member(const VariableInfo& member, const Operand& value) {
  const int n = slot_count(member.type);
  const bool counted = member.type >= StaticType::String && member.type <= StaticType::Data;
  const Op op = counted ? Op::SetVarRef : n == 1 ? Op::SetVar1 : n == 3 ? Op::SetVar3 : Op::SetVar9;
  emit_.emit_imm(op, value.slot, static_cast<std::int32_t>(member.slot));
}

void FunctionCompiler::check_class(const Operand& object, Symbol class_name, std::int32_t what) {
  if (class_name == kNoSymbol) return;
  const auto* cls = builder_.class_named(builder_.symbol_name(class_name));
  if (!cls) return;  // reported where the variable is declared
  emit_.emit_imm(Op::CheckClass, object.slot, static_cast<std::int32_t>(cls->id));
  emit_.ext(0, what);
}

FunctionCompiler::Target FunctionCompiler::target_of(const ast::Expr& target) {
  Target p;
  p.expr = &target;
  emit_.at(target.span);
  if (const auto* n = std::get_if<ast::Name>(&target.node))
    target_variable(p, *n);
  else if (const auto* a = std::get_if<ast::ArrayItem>(&target.node))
    target_array_item(p, *a);
  else if (const auto* m = std::get_if<ast::Member>(&target.node))
    target_member(p, *m);
  else if (const auto* i = std::get_if<ast::IndexExpr>(&target.node))
    target_index(p, *i);
  else
    p.value = boxed(expr(target));  // a value, not a place: changing a vector or string in it is an error when it runs
  return p;
}

void FunctionCompiler::target_variable(Target& p, const ast::Name& n) {
  const auto variable = need(n.name, p.expr->span);
  if (!variable || variable->array_size() >= 0) {
    if (variable)
      builder_.diagnostics().error(p.expr->span, "whole-array",
                                   "'" + n.name + "' is an array and can only be used element by element");
    p.value = emit_.temporary(StaticType::Any);
    return;
  }
  p.kind = Target::Kind::Variable;
  p.variable = *variable;
  p.name = n.name;
}

void FunctionCompiler::target_array_item(Target& p, const ast::ArrayItem& a) {
  const auto variable = need(a.name, p.expr->span);
  if (!variable || variable->array_size() < 0) {
    if (variable) emit_.release(array_slot(*variable, *a.index, a.name));
    p.value = emit_.temporary(StaticType::Any);
    return;
  }
  p.kind = Target::Kind::ArrayItem;
  p.variable = *variable;
  p.name = a.name;
  p.key = array_slot(*variable, *a.index, a.name);
}

void FunctionCompiler::target_member(Target& p, const ast::Member& m) {
  const int axis = m.name == "x" ? 0 : m.name == "y" ? 1 : m.name == "z" ? 2 : -1;
  if (const auto* n = std::get_if<ast::Name>(&m.base->node); n && axis >= 0) {
    const auto variable = find(n->name);
    if (variable && variable->type() == StaticType::Vector && variable->array_size() < 0) {
      p.kind = Target::Kind::Component;
      p.variable = *variable;
      p.name = n->name;
      p.axis = axis;
      return;
    }
  }
  p.base = std::make_unique<Target>(target_of(*m.base));
  p.kind = Target::Kind::Member;
  p.site = member_site(m.name);
  p.value = boxed(load(*p.base));
}

void FunctionCompiler::target_index(Target& p, const ast::IndexExpr& i) {
  p.base = std::make_unique<Target>(target_of(*i.base));
  p.kind = Target::Kind::Index;
  p.value = load(*p.base);
  if (p.value.type == StaticType::List) {
    p.value = stable(p.value, *i.index);
    p.key = expr(*i.index);
    if (p.key.type == StaticType::Int) {
      if (!p.key.temporary) p.key = copy(p.key);
      return;
    }
    p.key = boxed(p.key);
    p.value = boxed(p.value);
    return;
  }
  p.value = boxed(p.value);
  if (!p.value.temporary) p.value = copy(p.value);
  p.key = any(*i.index);
}

Operand FunctionCompiler::load(Target& p) {
  emit_.at(p.expr->span);
  switch (p.kind) {
    case Target::Kind::Variable: return read(p.variable);
    case Target::Kind::Component: {
      if (p.variable.local) {
        p.variable.local->used = true;
        return {StaticType::Double, static_cast<std::uint16_t>(p.variable.local->slot + p.axis), false};
      }
      const auto target = emit_.temporary(StaticType::Double);
      emit_.emit_imm(Op::GetVar1, target.slot, static_cast<std::int32_t>(p.variable.member->slot) + p.axis);
      return target;
    }
    case Target::Kind::ArrayItem: return read_array(p.variable, p.key);
    case Target::Kind::Index: {
      const auto target = emit_.temporary(StaticType::Any);
      emit_.emit(p.value.type == StaticType::List ? Op::IndexList : Op::Index, target.slot, p.value.slot, p.key.slot);
      return target;
    }
    case Target::Kind::Member: {
      const auto target = emit_.temporary(StaticType::Any);
      emit_.emit(Op::Member, target.slot, p.value.slot);
      emit_.ext(0, static_cast<std::int32_t>(p.site));
      return target;
    }
    case Target::Kind::Value: break;
  }
  auto value = p.value;
  value.temporary = false;
  return value;
}

Operand FunctionCompiler::store(Target& p, const Operand& value) {
  switch (p.kind) {
    case Target::Kind::Variable: return store_variable(p.variable, p.name, value);
    case Target::Kind::Component: {
      const auto what = text("component of '" + p.name + "'");
      if (p.variable.local) {
        const Operand component{StaticType::Double, static_cast<std::uint16_t>(p.variable.local->slot + p.axis), false};
        const auto converted = convert(value, StaticType::Double, what, &component);
        move(component, converted);
        emit_.release(converted);
        return component;
      }
      const auto converted = convert(value, StaticType::Double, what);
      emit_.emit_imm(Op::SetVar1, converted.slot, static_cast<std::int32_t>(p.variable.member->slot) + p.axis);
      return converted;
    }
    case Target::Kind::ArrayItem: return store_array(p, value);
    case Target::Kind::Value:
      emit_.emit_imm(Op::Fail, static_cast<std::uint16_t>(RunErrorKind::Type),
                     text("an element of a temporary value cannot be assigned; store the value in a variable first"));
      return value;
    default: break;
  }
  const auto box = boxed(value);
  if (p.value.type == StaticType::List) {
    emit_.emit(Op::SetIndexList, p.value.slot, p.key.slot, box.slot);
    return box;
  }
  // Lists, hashes and objects change in place; a changed vector, matrix or string goes back to where it came from.
  Label container, end;
  if (p.kind == Target::Kind::Member) {
    emit_.emit(Op::SetMember, p.value.slot, box.slot);
    emit_.ext(0, static_cast<std::int32_t>(p.site));
    emit_.jump_ext(container);
  } else {
    emit_.emit(Op::SetIndex, p.value.slot, p.key.slot, box.slot);
    emit_.jump_ext(container);
  }
  const auto result = emit_.temporary(StaticType::Any);
  auto changed = p.value;
  changed.temporary = false;
  const auto stored = store(*p.base, changed);
  if (p.kind == Target::Kind::Index) {
    emit_.emit(Op::MovAny, result.slot, p.value.slot);
  } else {
    emit_.emit(Op::MovAny, result.slot, box.slot);
  }
  if (stored.slot != changed.slot) emit_.release(stored);
  emit_.jump(Op::Jump, 0, end);
  emit_.place(container);
  emit_.emit(Op::MovAny, result.slot, box.slot);
  emit_.place(end);
  emit_.release(box);
  return result;
}

Operand FunctionCompiler::store_array(const Target& p, const Operand& value) {
  const auto type = p.variable.type();
  const auto what = text("element of array '" + p.name + "'");
  const auto converted = convert(value, type, what);
  check_class(converted, p.variable.class_name(), what);
  const auto flags = static_cast<std::uint16_t>(slot_count(type) | (p.variable.local ? kFrameArray : 0));
  const bool counted = !p.variable.local && type >= StaticType::String && type <= StaticType::Data;
  emit_.emit(counted ? Op::ArraySetRef : Op::ArraySet, converted.slot, p.key.slot, flags);
  return converted;
}

void FunctionCompiler::release(Target& p) {
  emit_.release(p.key);
  if (p.kind == Target::Kind::Index || p.kind == Target::Kind::Member || p.kind == Target::Kind::Value)
    emit_.release(p.value);
  p.key.temporary = p.value.temporary = false;
  if (p.base) release(*p.base);
}

}  // namespace breve::steve
