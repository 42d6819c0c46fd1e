// Operators and conditions to bytecode: types that are known choose the instruction.
#include <cmath>

#include "steve/compile/builder.hpp"
#include "steve/compile/function_compiler.hpp"

namespace breve::steve {

namespace {

bool is_number(StaticType t) { return t == StaticType::Int || t == StaticType::Double; }

}  // namespace

Operand FunctionCompiler::one_operand(const Operand& value, Op of_int, Op of_double, Op of_vector,
                                      StaticType vector_gives, Op of_any, const Operand* into) {
  const bool known = value.type >= StaticType::Int && value.type <= StaticType::Vector;
  const auto operand = known ? value : boxed(value);
  const auto type = value.type == StaticType::Vector ? vector_gives : known ? value.type : StaticType::Any;
  const auto target = known ? result(type, into) : emit_.temporary(type);
  emit_.emit(value.type == StaticType::Int      ? of_int
             : value.type == StaticType::Double ? of_double
             : value.type == StaticType::Vector ? of_vector
                                                : of_any,
             target.slot, operand.slot);
  emit_.release(operand);
  return target;
}

Operand FunctionCompiler::unary(const ast::Unary& u, const ast::Expr& e, const Operand* into) {
  if (u.op == ast::UnaryOp::Negate) {
    if (const auto number = written_number(e)) {
      if (is_written_int(e)) return literal(ast::IntLit{static_cast<std::int32_t>(*number)}, into);
      return literal(ast::DoubleLit{*number}, into);
    }
    const auto value = expr(*u.operand);
    emit_.at(e.span);
    return one_operand(value, Op::NegInt, Op::NegDouble, Op::NegVector, StaticType::Vector, Op::Negate, into);
  }
  const auto value = expr(*u.operand);
  emit_.at(e.span);
  if (value.type == StaticType::Int) {
    const auto target = result(StaticType::Int, into);
    emit_.emit(Op::NotInt, target.slot, value.slot);
    emit_.release(value);
    return target;
  }
  const auto box = boxed(value);
  const auto target = result(StaticType::Int, into);
  emit_.emit(Op::Truth, target.slot, box.slot);
  emit_.emit(Op::NotInt, target.slot, target.slot);
  emit_.release(box);
  return target;
}

Operand FunctionCompiler::chain(const ast::Chain& c, const ast::Expr& e, const Operand* into) {
  if (c.rest.front().first == ast::BinaryOp::And || c.rest.front().first == ast::BinaryOp::Or) return logical(e, into);
  // A number written first waits for the other side, so that it is loaded with the right type.
  const auto first_number = written_number(*c.first);
  const bool first_int = first_number && is_written_int(*c.first);
  Operand left;
  if (!first_int) left = expr(*c.first);
  for (std::size_t i = 0; i < c.rest.size(); ++i) {
    const auto& [op, operand] = c.rest[i];
    const Operand* target = i + 1 == c.rest.size() ? into : nullptr;
    const auto number = written_number(*operand);
    const bool pending = i == 0 && first_int;
    if (pending && number && is_written_int(*operand)) left = expr(*c.first);
    if (!pending || left.type != StaticType::Null) {
      left = stable(left, *operand);
      if (number && is_written_int(*operand) && left.type == StaticType::Int && std::abs(*number) < 32768 &&
          (op == ast::BinaryOp::Add || op == ast::BinaryOp::Sub)) {
        const auto sum = result(StaticType::Int, target);
        const auto step = static_cast<std::int16_t>(op == ast::BinaryOp::Add ? *number : -*number);
        emit_.at(e.span);
        emit_.emit(Op::AddIntImm, sum.slot, left.slot, static_cast<std::uint16_t>(step));
        emit_.release(left);
        left = sum;
        continue;
      }
      if (number && left.type == StaticType::Double && op <= ast::BinaryOp::Div && *number != 0) {
        if (const auto value = with_constant(op, left, *number, target)) {
          left = *value;
          continue;
        }
      }
      if (number && left.type == StaticType::Double) {
        const auto right = literal(ast::DoubleLit{*number}, nullptr);
        emit_.at(e.span);
        left = binary(op, left, right, target);
        continue;
      }
      const auto right = expr(*operand);
      emit_.at(e.span);
      left = binary(op, left, right, target);
      continue;
    }
    const auto right = expr(*operand);
    emit_.at(e.span);
    left = right.type == StaticType::Double || right.type == StaticType::Vector
               ? literal(ast::DoubleLit{*first_number}, nullptr)
               : literal(ast::IntLit{static_cast<std::int32_t>(*first_number)}, nullptr);
    left = binary(op, left, right, target);
  }
  return left;
}

std::optional<Operand> FunctionCompiler::with_constant(ast::BinaryOp op, const Operand& left, double number,
                                                       const Operand* into) {
  static constexpr Op kOps[] = {Op::AddConstant, Op::SubConstant, Op::MulConstant, Op::DivConstant};
  const auto index = emit_.number(number);
  if (index > 0xffff) return std::nullopt;
  const auto value = result(StaticType::Double, into);
  emit_.emit(kOps[static_cast<int>(op)], value.slot, left.slot, static_cast<std::uint16_t>(index));
  emit_.release(left);
  return value;
}

Operand FunctionCompiler::binary(ast::BinaryOp op, Operand a, Operand b, const Operand* into) {
  using enum ast::BinaryOp;
  const auto emit3 = [&](Op code, StaticType type, const Operand& x, const Operand& y) {
    const auto target = result(type, into);
    emit_.emit(code, target.slot, x.slot, y.slot);
    emit_.release(a);
    emit_.release(b);
    return target;
  };
  if (const auto vector = vector_binary(op, a, b, into)) return *vector;
  if (a.type == StaticType::Object && b.type == StaticType::Object && (op == Eq || op == Ne))
    return emit3(op == Eq ? Op::EqObject : Op::NeObject, StaticType::Int, a, b);
  if (!is_number(a.type) || !is_number(b.type)) return generic_binary(op, a, b);
  const bool integer = a.type == StaticType::Int && b.type == StaticType::Int;
  if (!integer) {
    a = convert(a, StaticType::Double, 0);
    b = convert(b, StaticType::Double, 0);
  }
  const auto type = integer ? StaticType::Int : StaticType::Double;
  switch (op) {
    case Add: return emit3(integer ? Op::AddInt : Op::AddDouble, type, a, b);
    case Sub: return emit3(integer ? Op::SubInt : Op::SubDouble, type, a, b);
    case Mul: return emit3(integer ? Op::MulInt : Op::MulDouble, type, a, b);
    case Div: return emit3(integer ? Op::DivInt : Op::DivDouble, type, a, b);
    case Mod: return emit3(integer ? Op::ModInt : Op::ModDouble, type, a, b);
    case Pow: return emit3(integer ? Op::PowInt : Op::PowDouble, type, a, b);
    case Lt: return emit3(integer ? Op::LtInt : Op::LtDouble, StaticType::Int, a, b);
    case Le: return emit3(integer ? Op::LeInt : Op::LeDouble, StaticType::Int, a, b);
    case Gt: return emit3(integer ? Op::LtInt : Op::LtDouble, StaticType::Int, b, a);
    case Ge: return emit3(integer ? Op::LeInt : Op::LeDouble, StaticType::Int, b, a);
    case Eq: return emit3(integer ? Op::EqInt : Op::EqDouble, StaticType::Int, a, b);
    case Ne: return emit3(integer ? Op::NeInt : Op::NeDouble, StaticType::Int, a, b);
    default: return generic_binary(op, a, b);
  }
}

std::optional<Operand> FunctionCompiler::vector_binary(ast::BinaryOp op, Operand a, Operand b, const Operand* into) {
  using enum ast::BinaryOp;
  const auto emit3 = [&](Op code, StaticType type, const Operand& x, const Operand& y) {
    const auto target = result(type, into);
    emit_.emit(code, target.slot, x.slot, y.slot);
    emit_.release(a);
    emit_.release(b);
    return target;
  };
  const bool va = a.type == StaticType::Vector;
  const bool vb = b.type == StaticType::Vector;
  if (va && vb) {
    if (op == Add) return emit3(Op::AddVector, StaticType::Vector, a, b);
    if (op == Sub) return emit3(Op::SubVector, StaticType::Vector, a, b);
    if (op == Eq) return emit3(Op::EqVector, StaticType::Int, a, b);
    if (op == Ne) return emit3(Op::NeVector, StaticType::Int, a, b);
    return std::nullopt;
  }
  if (va && is_number(b.type) && (op == Mul || op == Div)) {
    b = convert(b, StaticType::Double, 0);
    return emit3(op == Mul ? Op::ScaleVector : Op::DivVector, StaticType::Vector, a, b);
  }
  if (vb && is_number(a.type) && (op == Mul || op == Div)) {
    if (op == Div)
      builder_.lint(emit_.span(), "lint-scalar-by-vector",
                    "a number divided by a vector means the vector divided by the number", "write vector / number");
    if (op == Div)
      emit_.emit_imm(Op::FailIfStrict, static_cast<std::uint16_t>(RunErrorKind::Type),
                     text("a number cannot be divided by a vector; write vector / number"));
    a = convert(a, StaticType::Double, 0);
    return emit3(op == Mul ? Op::ScaleVector : Op::DivVector, StaticType::Vector, b, a);
  }
  return std::nullopt;
}

Operand FunctionCompiler::generic_binary(ast::BinaryOp op, const Operand& a, const Operand& b) {
  lint_operands(op, a.type, b.type);
  const auto left = boxed(a);
  const auto right = boxed(b);
  const auto target = emit_.temporary(StaticType::Any);
  emit_.emit(Op::Binary, target.slot, left.slot, right.slot);
  emit_.ext(static_cast<std::uint16_t>(op));
  emit_.release(left);
  emit_.release(right);
  return target;
}

Operand FunctionCompiler::logical(const ast::Expr& e, const Operand* into) {
  Label no, end;
  condition(e, false, no);
  const auto target = result(StaticType::Int, into);
  emit_.emit_imm(Op::LoadInt, target.slot, 1);
  emit_.jump(Op::Jump, 0, end);
  emit_.place(no);
  emit_.emit_imm(Op::LoadInt, target.slot, 0);
  emit_.place(end);
  return target;
}

Operand FunctionCompiler::magnitude(const ast::Magnitude& m, const Operand* into) {
  return one_operand(expr(*m.operand), Op::AbsInt, Op::AbsDouble, Op::Length, StaticType::Double, Op::Magnitude, into);
}

void FunctionCompiler::condition(const ast::Expr& e, bool when, Label& target) {
  const Span outer = emit_.span();
  emit_.at(e.span);
  if (const auto* u = std::get_if<ast::Unary>(&e.node); u && u->op == ast::UnaryOp::Not) {
    condition(*u->operand, !when, target);
    emit_.at(outer);
    return;
  }
  if (const auto* c = std::get_if<ast::Chain>(&e.node)) {
    const auto op = c->rest.front().first;
    if (op == ast::BinaryOp::And || op == ast::BinaryOp::Or) {
      // All of `and` must hold; one of `or` suffices. `decided`: the value that ends the evaluation early.
      const bool decided = op == ast::BinaryOp::Or;
      Label past;
      Label& early = decided == when ? target : past;
      condition(*c->first, decided, early);
      for (std::size_t i = 0; i + 1 < c->rest.size(); ++i) condition(*c->rest[i].second, decided, early);
      condition(*c->rest.back().second, when, target);
      emit_.place(past);
      emit_.at(outer);
      return;
    }
    if (c->rest.size() == 1 && comparison_jump(*c, when, target)) {
      emit_.at(outer);
      return;
    }
  }
  if (const auto* c = std::get_if<ast::Call>(&e.node)) {
    call(*c, e);
    jump_on({StaticType::Any, kResult, false}, when, target);
  } else {
    const auto value = expr(e);
    jump_on(value, when, target);
    emit_.release(value);
  }
  emit_.at(outer);
}

void FunctionCompiler::jump_on(const Operand& value, bool when, Label& target) {
  switch (value.type) {
    case StaticType::Int: emit_.jump(when ? Op::JumpIfInt : Op::JumpIfNotInt, value.slot, target); return;
    case StaticType::Double: emit_.jump(when ? Op::JumpIfDouble : Op::JumpIfNotDouble, value.slot, target); return;
    case StaticType::Object: emit_.jump(when ? Op::JumpIfObject : Op::JumpIfNotObject, value.slot, target); return;
    default: break;
  }
  auto box = value;
  box.temporary = false;
  if (value.type != StaticType::Any) box = boxed(box);
  emit_.jump(when ? Op::JumpIfAny : Op::JumpIfNotAny, box.slot, target);
  if (value.type != StaticType::Any) emit_.release(box);
}

bool FunctionCompiler::comparison_jump(const ast::Chain& c, bool when, Label& target) {
  using enum ast::BinaryOp;
  const auto op = c.rest.front().first;
  if (op < Lt || op > Ne) return false;
  const auto& right_tree = *c.rest.front().second;
  auto a = stable(expr(*c.first), right_tree);
  const auto number = written_number(right_tree);
  if (number && a.type == StaticType::Int && is_written_int(right_tree) && std::abs(*number) < 32768) {
    static constexpr Op kSmall[2][6] = {{Op::JumpIfGeSmall, Op::JumpIfGtSmall, Op::JumpIfLeSmall, Op::JumpIfLtSmall,
                                         Op::JumpIfNeSmall, Op::JumpIfEqSmall},
                                        {Op::JumpIfLtSmall, Op::JumpIfLeSmall, Op::JumpIfGtSmall, Op::JumpIfGeSmall,
                                         Op::JumpIfEqSmall, Op::JumpIfNeSmall}};
    const auto code = kSmall[when][static_cast<int>(op) - static_cast<int>(Lt)];
    emit_.compare_jump(code, a.slot, static_cast<std::uint16_t>(static_cast<std::int16_t>(*number)), target);
    emit_.release(a);
    return true;
  }
  auto b = number && a.type == StaticType::Double ? literal(ast::DoubleLit{*number}, nullptr) : expr(right_tree);
  if (!is_number(a.type) || !is_number(b.type)) {
    const auto value = binary(op, a, b, nullptr);
    jump_on(value, when, target);
    emit_.release(value);
    return true;
  }
  const bool integer = a.type == StaticType::Int && b.type == StaticType::Int;
  if (!integer) {
    a = convert(a, StaticType::Double, 0);
    b = convert(b, StaticType::Double, 0);
  }
  const bool swap = op == Gt || op == Ge;
  const int kind = op == Lt || op == Gt ? 0 : op == Le || op == Ge ? 1 : op == Eq ? 2 : 3;
  static constexpr Op kJumps[2][2][4] = {
      {{Op::JumpUnlessLtInt, Op::JumpUnlessLeInt, Op::JumpUnlessEqInt, Op::JumpUnlessNeInt},
       {Op::JumpUnlessLtDouble, Op::JumpUnlessLeDouble, Op::JumpUnlessEqDouble, Op::JumpUnlessNeDouble}},
      {{Op::JumpIfLtInt, Op::JumpIfLeInt, Op::JumpIfEqInt, Op::JumpIfNeInt},
       {Op::JumpIfLtDouble, Op::JumpIfLeDouble, Op::JumpIfEqDouble, Op::JumpIfNeDouble}}};
  emit_.compare_jump(kJumps[when][!integer][kind], swap ? b.slot : a.slot, swap ? a.slot : b.slot, target);
  emit_.release(a);
  emit_.release(b);
  return true;
}

}  // namespace breve::steve
