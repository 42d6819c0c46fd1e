// Literals to bytecode: numbers, strings with interpolation, vectors, matrices, lists.
#include "steve/compile/builder.hpp"
#include "steve/compile/function_compiler.hpp"
#include "steve/compile/overloaded.hpp"

namespace breve::steve {

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
  if (text.empty())
    emit_.emit(Op::ZeroRef, target.slot);
  else
    emit_.emit_imm(Op::LoadString, target.slot, static_cast<std::int32_t>(builder_.string_number(text)));
  return target;
}

Operand FunctionCompiler::constant(const ast::Constant& c, const Operand* into) {
  return std::visit(
      Overloaded{
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
  emit_.emit_imm(Op::NewList, target.slot,
                 static_cast<std::int32_t>(std::min<std::size_t>(l.elements.size(), 1 << 20)));
  for (const auto& element : l.elements) {
    const auto value = any(*element);
    emit_.emit(Op::Append, target.slot, value.slot);
    emit_.release(value);
  }
  return target;
}

}  // namespace breve::steve
