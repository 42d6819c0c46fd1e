// Expressions to bytecode: literals, names, indexing, operators. Types that are known choose the instruction.
#include <cmath>

#include "steve/compile/builder.hpp"
#include "steve/compile/function_compiler.hpp"

namespace breve::steve {

namespace {

template <class... F> struct Overloaded : F... { using F::operator()...; };
template <class... F> Overloaded(F...) -> Overloaded<F...>;

bool is_number(StaticType t) { return t == StaticType::Int || t == StaticType::Double; }

/// The value of a number written out, with its sign.
std::optional<double> written_number(const ast::Expr& e) {
  if (const auto* n = std::get_if<ast::IntLit>(&e.node)) return n->value;
  if (const auto* d = std::get_if<ast::DoubleLit>(&e.node)) return d->value;
  if (const auto* u = std::get_if<ast::Unary>(&e.node); u && u->op == ast::UnaryOp::Negate) {
    if (const auto inner = written_number(*u->operand)) return -*inner;
  }
  return std::nullopt;
}

bool is_written_int(const ast::Expr& e) {
  if (const auto* u = std::get_if<ast::Unary>(&e.node)) return u->op == ast::UnaryOp::Negate && is_written_int(*u->operand);
  return std::holds_alternative<ast::IntLit>(e.node);
}

}  // namespace

// --- registers ---------------------------------------------------------------------------------------------------------

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

// --- dispatch ----------------------------------------------------------------------------------------------------------

Operand FunctionCompiler::expr(const ast::Expr& e, const Operand* into) {
  const Span outer = emit_.span();
  emit_.at(e.span);
  const auto value = std::visit(
      Overloaded{
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

// --- literals ------------------------------------------------------------------------------------------------------------

Operand FunctionCompiler::literal(const ast::IntLit& n, const Operand* into) {
  if (into && into->type == StaticType::Double) {
    emit_.emit_imm(Op::LoadDouble, into->slot, static_cast<std::int32_t>(emit_.number(n.value)));
    return {StaticType::Double, into->slot, false};
  }
  const auto target = result(StaticType::Int, into);
  emit_.emit_imm(Op::LoadInt, target.slot, n.value);
  return target;
}

Operand FunctionCompiler::literal(const ast::DoubleLit& n, const Operand* into) {
  const auto target = result(StaticType::Double, into);
  emit_.emit_imm(Op::LoadDouble, target.slot, static_cast<std::int32_t>(emit_.number(n.value)));
  return target;
}

Operand FunctionCompiler::string_constant(std::string_view text, const Operand* into) {
  const auto target = result(StaticType::String, into);
  if (text.empty()) emit_.emit(Op::ZeroRef, target.slot);
  else emit_.emit_imm(Op::LoadString, target.slot, static_cast<std::int32_t>(builder_.string_number(text)));
  return target;
}

Operand FunctionCompiler::constant(const ast::Constant& c, const Operand* into) {
  return std::visit(Overloaded{
                        [&](std::int32_t n) { return literal(ast::IntLit{n}, into); },
                        [&](double d) { return literal(ast::DoubleLit{d}, into); },
                        [&](const std::string& s) { return string_constant(s, into); },
                        [&](const std::array<double, 3>& v) {
                          const auto target = result(StaticType::Vector, into);
                          emit_.emit_imm(Op::LoadVector, target.slot, static_cast<std::int32_t>(emit_.numbers(v.data(), 3)));
                          return target;
                        },
                        [&](const std::array<double, 9>& m) {
                          const auto target = result(StaticType::Matrix, into);
                          emit_.emit_imm(Op::LoadMatrix, target.slot, static_cast<std::int32_t>(emit_.numbers(m.data(), 9)));
                          return target;
                        },
                    },
                    c.value);
}

Operand FunctionCompiler::string(const ast::StringLit& s, const ast::Expr& e, const Operand* into) {
  if (s.parts.empty()) {
    builder_.class_named(s.texts[0]);  // a class of the library may be meant by its name
    return string_constant(s.texts[0], into);
  }
  const std::vector<StaticType> types(s.parts.size(), StaticType::Any);
  const auto values = emit_.block(types);
  for (std::size_t i = 0; i < s.parts.size(); ++i) {
    const auto& part = s.parts[i];
    Operand value;
    if (part.expr) {
      value = expr(*part.expr);
    } else if (part.name == "self" || part.name == "super") {
      value = emit_.temporary(StaticType::Object);
      emit_.emit(Op::LoadSelf, value.slot);
    } else if (const auto variable = need(part.name, part.span.line != 0 ? part.span : e.span)) {
      ast::Expr key;
      key.node = ast::IntLit{part.index.value_or(0)};
      key.span = part.span.line != 0 ? part.span : e.span;
      if (part.index && (part.array || variable->array_size() >= 0)) {
        const auto slot = array_slot(*variable, key, part.name);
        value = read_array(*variable, slot);
        emit_.release(slot);
      } else {
        value = read(*variable);
        if (part.index) {
          const auto base = boxed(value);
          const auto position = any(key);
          value = emit_.temporary(StaticType::Any);
          emit_.emit(Op::IndexGuarded, value.slot, base.slot, position.slot);
          emit_.release(base);
          emit_.release(position);
        }
      }
    }
    const auto box = boxed(value);
    move(values[i], box);
    emit_.release(box);
  }
  const auto target = result(StaticType::String, into);
  builder_.code().interpolations.push_back(s.texts);
  emit_.emit(Op::Interpolate, target.slot, values[0].slot, static_cast<std::uint16_t>(values.size()));
  emit_.ext(0, static_cast<std::int32_t>(builder_.code().interpolations.size() - 1));
  emit_.release_block(values);
  return target;
}

Operand FunctionCompiler::vector(const ast::VectorLit& v) {
  const auto target = emit_.temporary(StaticType::Vector);
  const ast::Expr* parts[] = {v.x.get(), v.y.get(), v.z.get()};
  const auto what = text("component of a vector");
  for (int i = 0; i < 3; ++i) {
    const Operand component{StaticType::Double, static_cast<std::uint16_t>(target.slot + i), false};
    const auto value = convert(expr(*parts[i], &component), StaticType::Double, what, &component);
    move(component, value);
    emit_.release(value);
  }
  return target;
}

Operand FunctionCompiler::matrix(const ast::MatrixLit& m) {
  const auto target = emit_.temporary(StaticType::Matrix);
  const auto what = text("element of a matrix");
  for (int i = 0; i < 9; ++i) {
    const Operand element{StaticType::Double, static_cast<std::uint16_t>(target.slot + i), false};
    const auto value = convert(expr(*m.elements[i], &element), StaticType::Double, what, &element);
    move(element, value);
    emit_.release(value);
  }
  return target;
}

Operand FunctionCompiler::list(const ast::ListLit& l) {
  const auto target = emit_.temporary(StaticType::List);
  emit_.emit_imm(Op::NewList, target.slot, static_cast<std::int32_t>(std::min<std::size_t>(l.elements.size(), 1 << 20)));
  for (const auto& element : l.elements) {
    const auto value = any(*element);
    emit_.emit(Op::Append, target.slot, value.slot);
    emit_.release(value);
  }
  return target;
}

// --- names, indices, members ---------------------------------------------------------------------------------------------------

Operand FunctionCompiler::name(const ast::Name& n, const ast::Expr& e) {
  const auto variable = need(n.name, e.span);
  if (!variable) {
    const auto target = emit_.temporary(StaticType::Any);
    zero(target);
    return target;
  }
  if (variable->array_size() >= 0) {
    builder_.diagnostics().error(e.span, "whole-array", "'" + n.name + "' is an array and can only be used element by element",
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
    builder_.diagnostics().error(emit_.span(), "not-an-array", "'" + std::string(name) + "' is not an array",
                                 "use " + std::string(name) + "{i} for an element of a list, hash or vector");
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
  const Op op = type == StaticType::List ? Op::ArrayGetList : type == StaticType::Hash ? Op::ArrayGetHash : Op::ArrayGet;
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
    if (position.type == StaticType::Int) {
      const auto target = emit_.temporary(StaticType::Any);
      emit_.emit(Op::IndexList, target.slot, base.slot, position.slot);
      emit_.release(position);
      emit_.release(base);
      return target;
    }
    const auto container = boxed(base);
    const auto box = boxed(position);
    const auto target = emit_.temporary(StaticType::Any);
    emit_.emit(Op::Index, target.slot, container.slot, box.slot);
    emit_.release(box);
    emit_.release(container);
    return target;
  }
  const auto container = boxed(base);
  const auto position = any(key);
  const auto target = emit_.temporary(StaticType::Any);
  emit_.emit(Op::Index, target.slot, container.slot, position.slot);
  emit_.release(position);
  emit_.release(container);
  return target;
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

// --- operators -----------------------------------------------------------------------------------------------------------------

Operand FunctionCompiler::unary(const ast::Unary& u, const ast::Expr& e, const Operand* into) {
  if (u.op == ast::UnaryOp::Negate) {
    if (const auto number = written_number(e)) {
      if (is_written_int(e)) return literal(ast::IntLit{static_cast<std::int32_t>(*number)}, into);
      return literal(ast::DoubleLit{*number}, into);
    }
    const auto value = expr(*u.operand);
    emit_.at(e.span);
    const auto unary_op = [&](Op op, StaticType type) {
      const auto target = result(type, into);
      emit_.emit(op, target.slot, value.slot);
      emit_.release(value);
      return target;
    };
    if (value.type == StaticType::Int) return unary_op(Op::NegInt, StaticType::Int);
    if (value.type == StaticType::Double) return unary_op(Op::NegDouble, StaticType::Double);
    if (value.type == StaticType::Vector) return unary_op(Op::NegVector, StaticType::Vector);
    const auto box = boxed(value);
    const auto target = emit_.temporary(StaticType::Any);
    emit_.emit(Op::Negate, target.slot, box.slot);
    emit_.release(box);
    return target;
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
    if (op == Div) builder_.lint(emit_.span(), "lint-scalar-by-vector", "a number divided by a vector means the vector divided by the number",
                                 "write vector / number");
    a = convert(a, StaticType::Double, 0);
    return emit3(op == Mul ? Op::ScaleVector : Op::DivVector, StaticType::Vector, b, a);
  }
  return std::nullopt;
}

Operand FunctionCompiler::generic_binary(ast::BinaryOp op, const Operand& a, const Operand& b) {
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
  const auto value = expr(*m.operand);
  const auto emit2 = [&](Op op, StaticType type) {
    const auto target = result(type, into);
    emit_.emit(op, target.slot, value.slot);
    emit_.release(value);
    return target;
  };
  if (value.type == StaticType::Int) return emit2(Op::AbsInt, StaticType::Int);
  if (value.type == StaticType::Double) return emit2(Op::AbsDouble, StaticType::Double);
  if (value.type == StaticType::Vector) return emit2(Op::Length, StaticType::Double);
  const auto box = boxed(value);
  const auto target = emit_.temporary(StaticType::Any);
  emit_.emit(Op::Magnitude, target.slot, box.slot);
  emit_.release(box);
  return target;
}

// --- conditions ------------------------------------------------------------------------------------------------------------------

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
