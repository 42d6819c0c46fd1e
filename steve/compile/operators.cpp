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
  const auto target = [&](std::size_t i) { return i + 1 == c.rest.size() ? into : nullptr; };
  std::size_t i = 0;
  Operand left;
  if (written_number(*c.first) && !written_number(*c.rest.front().second)) {
    left = number_first(*c.first, c.rest.front().first, *c.rest.front().second, e.span, target(0));
    i = 1;
  } else {
    const auto& next = *c.rest.front().second;  // what does not touch the result register
    const bool plain = std::holds_alternative<ast::Name>(next.node) || written_number(next);
    left = plain ? operand(*c.first) : expr(*c.first);
  }
  for (; i < c.rest.size(); ++i) left = link(left, c.rest[i].first, *c.rest[i].second, e.span, target(i));
  return left;
}

/// left op right, where `left` is in its register already.
Operand FunctionCompiler::link(Operand left, ast::BinaryOp op, const ast::Expr& right_tree, const Span& span,
                               const Operand* into) {
  using enum ast::BinaryOp;
  left = stable(left, right_tree);
  if (const auto number = written_number(right_tree)) {
    emit_.at(span);
    if (const auto value = with_number(op, left, *number, is_written_int(right_tree), into)) return *value;
  }
  // A product waits for what is added to it, so that both are one instruction, if nothing can change its factors.
  std::optional<Instruction> product;
  if ((op == Add || op == Sub) && !assigns(right_tree)) product = emit_.take_product(left);
  auto right = operand(right_tree);
  emit_.at(span);
  if (!product) return binary(op, left, right, into);
  if (left.type == StaticType::Double && right.type == StaticType::Int) right = convert(right, StaticType::Double, 0);
  if (right.type == left.type) return product_and(*product, op, true, left, right, into);
  emit_.emit(product->op, product->a, product->b, product->c);
  return binary(op, left, right, into);
}

/// The right side of an operator: what a call gives may stay in the result register.
Operand FunctionCompiler::operand(const ast::Expr& e) {
  const auto* c = std::get_if<ast::Call>(&e.node);
  if (!c) return expr(e);
  const Span outer = emit_.span();
  emit_.at(e.span);
  call(*c, e);
  emit_.at(outer);
  return {StaticType::Any, kResult, false};
}

/// A number written first waits for the other side, so that it is loaded with the right type.
Operand FunctionCompiler::number_first(const ast::Expr& first, ast::BinaryOp op, const ast::Expr& right_tree,
                                       const Span& span, const Operand* into) {
  using enum ast::BinaryOp;
  const double number = *written_number(first);
  const bool integer = is_written_int(first);
  auto right = expr(right_tree);
  emit_.at(span);
  const bool commutes = op == Add || op == Mul;
  if (!integer && right.type == StaticType::Int && !commutes) right = convert(right, StaticType::Double, 0);
  if (commutes && (right.type == StaticType::Double || right.type == StaticType::Int))
    if (const auto value = with_number(op, right, number, integer, into)) return *value;
  if (right.type == StaticType::Double && (op == Sub || op == Div))
    if (const auto value = with_constant(op == Sub ? Op::ConstantSub : Op::ConstantDiv, right, number, into))
      return *value;
  const bool loaded_as_double = !integer || right.type == StaticType::Double || right.type == StaticType::Vector;
  const auto left = loaded_as_double ? literal(ast::DoubleLit{number}, nullptr)
                                     : literal(ast::IntLit{static_cast<std::int32_t>(number)}, nullptr);
  return binary(op, left, right, into);
}

/// left op number, where there is an instruction for it.
std::optional<Operand> FunctionCompiler::with_number(ast::BinaryOp op, Operand left, double number, bool integer,
                                                     const Operand* into) {
  using enum ast::BinaryOp;
  if (left.type == StaticType::Vector && (op == Mul || op == Div))
    return binary(op, left, literal(ast::DoubleLit{number}, nullptr), into);
  if (left.type == StaticType::Int && integer) {
    if (std::abs(number) >= 32768 || op > Mod) return std::nullopt;
    const bool divides = op == Div || op == Mod;
    if (divides && (number == 0 || number == -1)) return std::nullopt;  // these fail, or may not fit
    static constexpr Op kOps[] = {Op::AddIntImm, Op::AddIntImm, Op::MulIntImm, Op::DivIntImm, Op::ModIntImm};
    const auto value = result(StaticType::Int, into);
    const auto imm = static_cast<std::int16_t>(op == Sub ? -number : number);
    emit_.emit(kOps[static_cast<int>(op)], value.slot, left.slot, static_cast<std::uint16_t>(imm));
    emit_.release(left);
    return value;
  }
  if (left.type == StaticType::Int && op == Mul) return with_constant(Op::IntMulConstant, left, number, into);
  if (left.type == StaticType::Int) left = convert(left, StaticType::Double, 0);
  if (left.type != StaticType::Double) return std::nullopt;
  static constexpr Op kOps[] = {Op::AddConstant, Op::AddConstant, Op::MulConstant, Op::DivConstant};
  const double constant = op == Sub ? -number : number;  // x - k is x + -k, to the last bit
  if (op <= Div && !(op == Div && number == 0))
    if (const auto value = with_constant(kOps[static_cast<int>(op)], left, constant, into)) return value;
  return binary(op, left, literal(ast::DoubleLit{number}, nullptr), into);
}

std::optional<Operand> FunctionCompiler::with_constant(Op code, const Operand& left, double number,
                                                       const Operand* into) {
  const auto index = emit_.number(number);
  if (index > 0xffff) return std::nullopt;
  const auto constant = static_cast<std::uint16_t>(index);
  const Instruction* sum = code == Op::AddConstant ? emit_.just_made(left) : nullptr;
  if (sum && (sum->op == Op::AddDouble || sum->op == Op::SubDouble)) {
    const Instruction made = *sum;
    emit_.drop_last();
    const auto value = result(StaticType::Double, into);
    emit_.emit(made.op == Op::AddDouble ? Op::AddAddConstant : Op::SubAddConstant, value.slot, made.b, made.c);
    emit_.ext(constant);
    emit_.release(left);
    return value;
  }
  const auto value = result(StaticType::Double, into);
  emit_.emit(code, value.slot, left.slot, constant);
  emit_.release(left);
  return value;
}

Operand FunctionCompiler::emit_binary(Op code, StaticType type, const Operand& x, const Operand& y,
                                      const Operand* into) {
  const auto target = result(type, into);
  emit_.emit(code, target.slot, x.slot, y.slot);
  emit_.release(x);
  emit_.release(y);
  return target;
}

/// product + other, product - other, other - product.
Operand FunctionCompiler::product_and(const Instruction& product, ast::BinaryOp op, bool product_first,
                                      const Operand& made, const Operand& other, const Operand* into) {
  const bool adds = op == ast::BinaryOp::Add;
  Op code = adds ? Op::MulAdd : product_first ? Op::MulSub : Op::SubMul;
  if (product.op == Op::MulConstant)
    code = adds ? Op::MulConstantAdd : product_first ? Op::MulConstantSub : Op::SubMulConstant;
  if (product.op == Op::ScaleVector)
    code = adds ? Op::MulAddVector : product_first ? Op::MulSubVector : Op::SubMulVector;
  const auto target = result(made.type, into);
  emit_.emit(code, target.slot, product.b, product.c);
  emit_.ext(other.slot);
  emit_.release(made);
  emit_.release(other);
  return target;
}

/// a op b where one of them is a product that was made just now.
std::optional<Operand> FunctionCompiler::multiply_add(ast::BinaryOp op, const Operand& a, const Operand& b,
                                                      const Operand* into) {
  if ((op != ast::BinaryOp::Add && op != ast::BinaryOp::Sub) || a.type != b.type || a.slot == b.slot)
    return std::nullopt;
  for (const bool first : {false, true}) {
    const auto* made = emit_.just_made(first ? a : b);
    if (!made || !Emitter::is_product(made->op)) continue;
    const Instruction product = *made;
    emit_.drop_last();
    return product_and(product, op, first, first ? a : b, first ? b : a, into);
  }
  return std::nullopt;
}

Operand FunctionCompiler::binary(ast::BinaryOp op, Operand a, Operand b, const Operand* into) {
  using enum ast::BinaryOp;
  if (const auto sum = multiply_add(op, a, b, into)) return *sum;
  if (const auto vector = vector_binary(op, a, b, into)) return *vector;
  if (a.type == StaticType::Object && b.type == StaticType::Object && (op == Eq || op == Ne))
    return emit_binary(op == Eq ? Op::EqObject : Op::NeObject, StaticType::Int, a, b, into);
  if (!is_number(a.type) || !is_number(b.type)) return generic_binary(op, a, b, into);
  const bool integer = a.type == StaticType::Int && b.type == StaticType::Int;
  if (!integer) {
    a = convert(a, StaticType::Double, 0);
    b = convert(b, StaticType::Double, 0);
  }
  static constexpr Op kInt[] = {Op::AddInt, Op::SubInt, Op::MulInt, Op::DivInt, Op::ModInt, Op::PowInt};
  static constexpr Op kDouble[] = {Op::AddDouble, Op::SubDouble, Op::MulDouble,
                                   Op::DivDouble, Op::ModDouble, Op::PowDouble};
  const auto compare = [&](Op of_ints, Op of_doubles, const Operand& x, const Operand& y) {
    return emit_binary(integer ? of_ints : of_doubles, StaticType::Int, x, y, into);
  };
  switch (op) {
    case Lt: return compare(Op::LtInt, Op::LtDouble, a, b);
    case Le: return compare(Op::LeInt, Op::LeDouble, a, b);
    case Gt: return compare(Op::LtInt, Op::LtDouble, b, a);
    case Ge: return compare(Op::LeInt, Op::LeDouble, b, a);
    case Eq: return compare(Op::EqInt, Op::EqDouble, a, b);
    case Ne: return compare(Op::NeInt, Op::NeDouble, a, b);
    case And:
    case Or: return generic_binary(op, a, b, into);
    default: break;
  }
  return emit_binary((integer ? kInt : kDouble)[static_cast<int>(op)], integer ? StaticType::Int : StaticType::Double,
                     a, b, into);
}

std::optional<Operand> FunctionCompiler::vector_binary(ast::BinaryOp op, Operand a, Operand b, const Operand* into) {
  using enum ast::BinaryOp;
  const bool va = a.type == StaticType::Vector;
  const bool vb = b.type == StaticType::Vector;
  if (va && vb) {
    if (op == Add) return emit_binary(Op::AddVector, StaticType::Vector, a, b, into);
    if (op == Sub) return emit_binary(Op::SubVector, StaticType::Vector, a, b, into);
    if (op == Eq) return emit_binary(Op::EqVector, StaticType::Int, a, b, into);
    if (op == Ne) return emit_binary(Op::NeVector, StaticType::Int, a, b, into);
    return std::nullopt;
  }
  if (va && is_number(b.type) && (op == Mul || op == Div)) {
    b = convert(b, StaticType::Double, 0);
    return emit_binary(op == Mul ? Op::ScaleVector : Op::DivVector, StaticType::Vector, a, b, into);
  }
  if (vb && is_number(a.type) && (op == Mul || op == Div)) {
    if (op == Div)
      builder_.lint(emit_.span(), "lint-scalar-by-vector",
                    "a number divided by a vector means the vector divided by the number", "write vector / number");
    if (op == Div)
      emit_.emit_imm(Op::FailIfStrict, static_cast<std::uint16_t>(RunErrorKind::Type),
                     text("a number cannot be divided by a vector; write vector / number"));
    a = convert(a, StaticType::Double, 0);
    return emit_binary(op == Mul ? Op::ScaleVector : Op::DivVector, StaticType::Vector, b, a, into);
  }
  return std::nullopt;
}

Operand FunctionCompiler::generic_binary(ast::BinaryOp op, const Operand& a, const Operand& b, const Operand* into) {
  using enum ast::BinaryOp;
  lint_operands(op, a.type, b.type);
  // A number and something dynamic add to a number or are an error; a vector likewise.
  const bool a_dynamic = a.type == StaticType::Any;
  const auto known = a_dynamic ? b.type : a.type;
  if ((op == Add || op == Sub) && a_dynamic != (b.type == StaticType::Any) &&
      (known == StaticType::Double || known == StaticType::Vector)) {
    static constexpr Op kSums[2][2][2] = {{{Op::AddDoubleAny, Op::AddAnyDouble}, {Op::SubDoubleAny, Op::SubAnyDouble}},
                                          {{Op::AddVectorAny, Op::AddAnyVector}, {Op::SubVectorAny, Op::SubAnyVector}}};
    const Op code = kSums[known == StaticType::Vector][op == Sub][a_dynamic];
    return emit_binary(code, known, a_dynamic ? b : a, a_dynamic ? a : b, into);
  }
  const auto left = boxed(a);
  if (op <= Mul) {
    const auto right = b.slot == kResult ? b : boxed(b);
    return emit_binary(op == Add   ? Op::AddAny
                       : op == Sub ? Op::SubAny
                                   : Op::MulAny,
                       StaticType::Any, left, right, nullptr);
  }
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
