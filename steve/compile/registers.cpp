// Values in registers: moving, boxing and converting them.
#include "steve/compile/builder.hpp"
#include "steve/compile/function_compiler.hpp"

namespace breve::steve {

Operand FunctionCompiler::result(StaticType type, const Operand* into) {
  if (into && into->type == type) return {type, into->slot, false};
  return emit_.temporary(type);
}

void FunctionCompiler::move(const Operand& to, const Operand& from) {
  if (to.slot == from.slot) return;
  static constexpr Op kMoves[] = {Op::Mov1, Op::Mov3, Op::MovAny, Op::Mov9};
  const int n = slot_count(to.type);
  emit_.emit(kMoves[n == 1 ? 0 : n == 3 ? 1 : n == 4 ? 2 : 3], to.slot, from.slot);
}

Operand FunctionCompiler::copy(const Operand& value) {
  const auto target = emit_.temporary(value.type);
  move(target, value);
  return target;
}

Operand FunctionCompiler::stable(const Operand& value, const ast::Expr& later) {
  return !value.temporary && assigns(later) ? copy(value) : value;
}

void FunctionCompiler::zero(const Operand& target) {
  switch (target.type) {
    case StaticType::Any: emit_.emit(Op::ZeroAny, target.slot); break;
    case StaticType::Int: emit_.emit_imm(Op::LoadInt, target.slot, 0); break;
    default: emit_.emit(Op::ZeroRef, target.slot); break;
  }
}

Operand FunctionCompiler::boxed(const Operand& value) {
  if (value.type == StaticType::Any) {
    if (value.slot != kResult) return value;
    return dynamic_result();
  }
  const auto target = emit_.temporary(StaticType::Any);
  switch (value.type) {
    case StaticType::Int: emit_.emit(Op::BoxInt, target.slot, value.slot); break;
    case StaticType::Double: emit_.emit(Op::BoxDouble, target.slot, value.slot); break;
    case StaticType::Vector: emit_.emit(Op::BoxVector, target.slot, value.slot); break;
    case StaticType::Matrix: emit_.emit(Op::BoxMatrix, target.slot, value.slot); break;
    case StaticType::Null: emit_.emit(Op::ZeroAny, target.slot); break;
    default: emit_.emit(Op::BoxRef, target.slot, value.slot, static_cast<std::uint16_t>(value.type)); break;
  }
  emit_.release(value);
  return target;
}

Operand FunctionCompiler::any(const ast::Expr& e) { return boxed(expr(e)); }

Operand FunctionCompiler::dynamic_result() {
  const auto target = emit_.temporary(StaticType::Any);
  emit_.emit(Op::ToAny, target.slot, kResult);
  return target;
}

Operand FunctionCompiler::result_register(StaticType type, const Operand* into) {
  if (type == StaticType::Any || type == StaticType::Null) return dynamic_result();
  const auto target = result(type, into);
  const Op op = type == StaticType::Int      ? Op::ResultInt
                : type == StaticType::Double ? Op::ResultDouble
                : type == StaticType::Vector ? Op::ResultVector
                : type == StaticType::Matrix ? Op::ResultMatrix
                                             : Op::ResultRef;
  emit_.emit(op, target.slot);
  return target;
}

Operand FunctionCompiler::convert(const Operand& value, StaticType type, std::int32_t what, const Operand* into) {
  if (value.type == type && value.slot != kResult) return value;
  if (type == StaticType::Any) return boxed(value);
  if (value.type == StaticType::Int && type == StaticType::Double) {
    const auto target = result(type, into);
    emit_.emit(Op::IntToDouble, target.slot, value.slot);
    emit_.release(value);
    return target;
  }
  if (value.type == StaticType::Double && type == StaticType::Int) {
    const auto target = result(type, into);
    emit_.emit(Op::DoubleToInt, target.slot, value.slot);
    emit_.release(value);
    return target;
  }
  const auto source = value.type == StaticType::Any ? value : boxed(value);
  const auto target = result(type, into);
  const auto number = static_cast<std::uint16_t>(what);
  switch (type) {
    case StaticType::Int: emit_.emit(Op::ToInt, target.slot, source.slot, number); break;
    case StaticType::Double: emit_.emit(Op::ToDouble, target.slot, source.slot, number); break;
    case StaticType::Vector: emit_.emit(Op::ToVector, target.slot, source.slot, number); break;
    case StaticType::Matrix: emit_.emit(Op::ToMatrix, target.slot, source.slot, number); break;
    default:
      emit_.emit(Op::ToRef, target.slot, source.slot, number);
      emit_.ext(static_cast<std::uint16_t>(type));
      break;
  }
  emit_.release(source);
  return target;
}

}  // namespace breve::steve
