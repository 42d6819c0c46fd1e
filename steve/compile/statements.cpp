// Statements to bytecode, and the value that a method without `return` ends with.
#include <algorithm>

#include "steve/compile/builder.hpp"
#include "steve/compile/function_compiler.hpp"
#include "steve/compile/overloaded.hpp"

namespace breve::steve {

FunctionCompiler::FunctionCompiler(CompileScope& builder, const ClassInfo& cls, const ast::Method& method,
                                   MethodInfo& info, std::vector<std::string> dynamic)
    : builder_(builder),
      class_(cls),
      method_(method),
      info_(info),
      emit_(*info.function, builder.diagnostics()),
      dynamic_(std::move(dynamic)) {}

void FunctionCompiler::compile() {
  emit_.at(method_.span);
  declare_locals();
  for (const auto& name : dynamic_)
    locals_[name] = {StaticType::Any, emit_.reserve(StaticType::Any), -1, kNoSymbol, method_.span, false, true};
  const auto& body = method_.body;
  if (!body.empty() && std::holds_alternative<ast::ExprStmt>(body.back()->node)) {
    // The last statement's value is the method's: earlier ones matter only to a bare `return` in front of it.
    bool keep = false;
    for (const auto& s : body) keep = keep || contains_return(*s);
    for (std::size_t i = 0; i + 1 < body.size(); ++i) statement(*body[i], keep);
    emit_.at(body.back()->span);
    tail(*std::get<ast::ExprStmt>(body.back()->node).expr);
  } else {
    statements(body, true);
    if (has_last_) emit_.emit(Op::ReturnAny, last_.slot);
  }
  emit_.finish();
  if (method_.broken) return;  // what could not be read may use any of them
  for (const auto& local : method_.locals) {
    const auto found = locals_.find(local.name);
    if (found != locals_.end() && !found->second.used)
      builder_.lint(local.span, "lint-unused-local", "the local variable '" + local.name + "' is never read",
                    "remove it, or use it");
  }
}

void FunctionCompiler::declare_locals() {
  for (std::size_t i = 0; i < method_.parameters.size(); ++i) {
    const auto& p = method_.parameters[i];
    auto& info = info_.parameters[i];
    info.slot = emit_.reserve(info.type);
    locals_[p.variable] = {info.type, static_cast<std::uint16_t>(info.slot), -1, info.class_name, p.variable_span,
                           true};
  }
  info_.function->parameter_slots = info_.function->frame_slots;
  for (const auto& v : method_.locals) {
    const auto type = static_type(v.type.kind);
    if (const auto found = locals_.find(v.name); found != locals_.end()) {
      builder_.diagnostics().error(v.span, "redefinition",
                                   found->second.parameter
                                       ? "local variable '" + v.name + "' has the name of a parameter"
                                       : "local variable '" + v.name + "' is declared twice",
                                   "rename one of them");
      continue;
    }
    const auto name = builder_.symbol(v.name);
    if (class_.find_variable(name))
      builder_.lint(v.span, "lint-shadow",
                    "the local variable '" + v.name + "' hides the instance variable of the same name",
                    "rename one of the two");
    const auto count = v.type.array_size >= 0 ? static_cast<std::uint32_t>(v.type.array_size) : 1;
    emit_.at(v.span);
    Symbol class_name = kNoSymbol;
    if (!v.type.class_name.empty()) {
      class_name = builder_.symbol(v.type.class_name);
      if (!builder_.class_named(v.type.class_name))
        builder_.report_unknown_class(v.type.class_name, v.type.span, Severity::Error);
    }
    locals_[v.name] = {type,
                       emit_.reserve(type, count),
                       v.type.broken ? kBrokenType : v.type.array_size,
                       class_name,
                       v.span,
                       false,
                       v.type.broken};
  }
}

std::optional<FunctionCompiler::Variable> FunctionCompiler::find(std::string_view name) {
  if (const auto found = locals_.find(std::string(name)); found != locals_.end())
    return Variable{&found->second, nullptr};
  if (const auto* member = class_.find_variable(builder_.symbol(name))) return Variable{nullptr, member};
  return std::nullopt;
}

std::optional<FunctionCompiler::Variable> FunctionCompiler::need(std::string_view name, const Span& span) {
  if (const auto variable = find(name)) return variable;
  const std::string help = unknown_name_help(name, span);
  builder_.diagnostics().error(span, "unknown-variable", "unknown variable '" + std::string(name) + "'", help);
  // Declared here, so that each unknown name is reported once in a method.
  locals_[std::string(name)] = {StaticType::Any, emit_.reserve(StaticType::Any), -1, kNoSymbol, span, false, true};
  return std::nullopt;
}

std::int32_t FunctionCompiler::text(std::string what) { return static_cast<std::int32_t>(builder_.text_number(what)); }

std::int32_t FunctionCompiler::text_for(const Variable& variable, std::string_view name) {
  return text((variable.local && variable.local->parameter ? "parameter '" : "variable '") + std::string(name) + "'");
}

// --- statements ------------------------------------------------------------------------------------------------------

void FunctionCompiler::statements(const std::vector<ast::StmtPtr>& list, bool keep) {
  std::vector<bool> keeps(list.size());
  for (std::size_t i = list.size(); i-- > 0;) {
    keeps[i] = keep;
    if (always_has_value(*list[i])) keep = false;
    if (contains_return(*list[i])) keep = true;
  }
  for (std::size_t i = 0; i < list.size(); ++i) statement(*list[i], keeps[i]);
}

void FunctionCompiler::statement(const ast::Stmt& s, bool keep) {
  const Span outer = emit_.span();
  emit_.at(s.span);
  std::visit(Overloaded{
                 [&](const ast::Block& b) { statements(b.body, keep); },
                 [&](const ast::If& i) { if_statement(i, keep); },
                 [&](const ast::While& w) { while_statement(w, keep || contains_return(*w.body)); },
                 [&](const ast::For& f) { for_statement(f, keep || contains_return(*f.body)); },
                 [&](const ast::Foreach& f) { foreach_statement(f, s.span, keep || contains_return(*f.body)); },
                 [&](const ast::ExprStmt& x) { expression_statement(*x.expr, keep); },
                 [&](const ast::Print& p) { print(p); },
                 [&](const ast::Return& r) { return_statement(r); },
                 [&](const ast::Free& f) {
                   const auto value = any(*f.value);
                   emit_.at(s.span);
                   emit_.emit(Op::Free, value.slot);
                   emit_.release(value);
                 },
                 [&](const ast::Die& d) {
                   const auto value = any(*d.value);
                   emit_.at(s.span);
                   emit_.emit(Op::Die, value.slot);
                   emit_.release(value);
                 },
             },
             s.node);
  emit_.at(outer);
}

void FunctionCompiler::expression_statement(const ast::Expr& e, bool keep) {
  if (const auto* s = std::get_if<ast::Sort>(&e.node)) {
    emit_.at(e.span);
    sort(*s);
    return;
  }
  if (const auto* c = std::get_if<ast::Call>(&e.node)) {
    call(*c, e);
    if (keep) keep_result();
    return;
  }
  const auto value = expr(e);
  if (keep)
    keep_value(value);
  else
    emit_.release(value);
}

void FunctionCompiler::keep_value(const Operand& value) {
  if (!has_last_) {
    last_ = {StaticType::Any, emit_.reserve(StaticType::Any), false};
    has_last_ = true;
  }
  const auto box = boxed(value);
  move(last_, box);
  emit_.release(box);
}

void FunctionCompiler::keep_result() {
  if (!has_last_) {
    last_ = {StaticType::Any, emit_.reserve(StaticType::Any), false};
    has_last_ = true;
  }
  emit_.emit(Op::ToAny, last_.slot, kResult);
}

void FunctionCompiler::tail(const ast::Expr& e) {
  if (const auto* s = std::get_if<ast::Sort>(&e.node)) {
    emit_.at(e.span);
    sort(*s);
    if (has_last_) emit_.emit(Op::ReturnAny, last_.slot);
    return;
  }
  if (const auto* c = std::get_if<ast::Call>(&e.node)) {
    call(*c, e);
    emit_.emit(Op::ReturnResult);
    return;
  }
  const auto value = expr(e);
  emit_return(value);
  emit_.release(value);
}

void FunctionCompiler::if_statement(const ast::If& s, bool keep) {
  Label end;
  for (std::size_t i = 0; i < s.branches.size(); ++i) {
    Label next;
    condition(*s.branches[i].first, false, next);
    statement(*s.branches[i].second, keep);
    if (s.otherwise || i + 1 < s.branches.size()) emit_.jump(Op::Jump, 0, end);
    emit_.place(next);
  }
  if (s.otherwise) statement(*s.otherwise, keep);
  emit_.place(end);
}

void FunctionCompiler::while_statement(const ast::While& s, bool keep) {
  Label body, test;
  emit_.jump(Op::Jump, 0, test);
  emit_.place(body);
  statement(*s.body, keep);
  emit_.place(test);
  condition(*s.condition, true, body);
}

void FunctionCompiler::for_statement(const ast::For& s, bool keep) {
  Label body, test, end;
  emit_.release(expr(*s.start));
  emit_.jump(Op::Jump, 0, test);
  emit_.place(body);
  statement(*s.body, keep);
  // The first test stands apart if step and test are one: either way each iteration is one jump back.
  if (counting_for(s, body))
    emit_.jump(Op::Jump, 0, end);
  else
    emit_.release(expr(*s.step));
  emit_.place(test);
  condition(*s.condition, true, body);
  emit_.place(end);
}

/// Step and test of `i++` and `i < n` or `i <= n` as one instruction: i and n are local ints, or n is written out.
bool FunctionCompiler::counting_for(const ast::For& s, Label& body) {
  const auto local_int = [this](const ast::Expr& e) -> const Local* {
    const auto* n = std::get_if<ast::Name>(&e.node);
    const auto found = n ? locals_.find(n->name) : locals_.end();
    if (found == locals_.end()) return nullptr;
    return found->second.type == StaticType::Int && found->second.array_size < 0 ? &found->second : nullptr;
  };
  const auto* step = std::get_if<ast::Step>(&s.step->node);
  const auto* test = std::get_if<ast::Chain>(&s.condition->node);
  if (!step || !test || test->rest.size() != 1) return false;
  const auto* counter = local_int(*step->target);
  const auto& [op, limit] = test->rest.front();
  if (!counter || local_int(*test->first) != counter || (op != ast::BinaryOp::Lt && op != ast::BinaryOp::Le))
    return false;
  const auto number = written_number(*limit);
  const bool constant = number && is_written_int(*limit);
  // i <= n is i < n + 1 where that is an int.
  if (constant && op == ast::BinaryOp::Le && *number >= INT32_MAX) return false;
  const auto* variable = local_int(*limit);
  if (!constant && !variable) return false;
  emit_.at(s.step->span);
  const Op code = constant ? Op::StepJumpIfLtImm : op == ast::BinaryOp::Lt ? Op::StepJumpIfLt : Op::StepJumpIfLe;
  emit_.compare_jump(code, counter->slot, variable ? variable->slot : std::uint16_t{0}, body);
  const double bound = constant ? *number + (op == ast::BinaryOp::Le ? 1 : 0) : 0;
  emit_.ext(static_cast<std::uint16_t>(static_cast<std::int16_t>(step->delta)), static_cast<std::int32_t>(bound));
  return true;
}

void FunctionCompiler::foreach_statement(const ast::Foreach& s, const Span& span, bool keep) {
  const auto variable = need(s.variable, s.variable_span.line != 0 ? s.variable_span : span);
  if (!variable) return;
  if (variable->array_size() >= 0) {
    builder_.diagnostics().error(s.variable_span, "whole-array",
                                 "'" + s.variable + "' is an array and cannot be a loop variable");
    return;
  }
  if (variable->local) variable->local->used = true;
  auto list = list_operand(*s.list, "the operand of 'foreach'");
  if (!list.temporary) list = copy(list);
  const auto counter = emit_.temporary(StaticType::Int);
  zero(counter);
  Label body, next;
  emit_.at(span);
  emit_.jump(Op::Jump, 0, next);
  emit_.place(body);
  if (variable->local && variable->type() == StaticType::Object && variable->class_name() == kNoSymbol) {
    statement(*s.body, keep);
    emit_.place(next);
    emit_.at(span);
    emit_.emit(Op::ForeachObject, list.slot, counter.slot, variable->local->slot);
    emit_.jump_ext(body);
    emit_.ext(0, text_for(*variable, s.variable));
  } else {
    const auto element = emit_.temporary(StaticType::Any);
    auto stored = element;
    stored.temporary = false;
    emit_.release(store_variable(*variable, s.variable, stored));
    statement(*s.body, keep);
    emit_.place(next);
    emit_.at(span);
    emit_.emit(Op::Foreach, list.slot, counter.slot, element.slot);
    emit_.jump_ext(body);
    emit_.release(element);
  }
  emit_.release(counter);
  emit_.release(list);
}

void FunctionCompiler::print(const ast::Print& p) {
  for (std::size_t i = 0; i < p.items.size(); ++i) {
    const auto value = any(*p.items[i]);
    const bool last = i + 1 == p.items.size();
    emit_.at(p.items[i]->span);
    emit_.emit(Op::Print, value.slot, last ? (p.newline ? 2 : 0) : 1);
    emit_.release(value);
  }
}

void FunctionCompiler::return_statement(const ast::Return& r) {
  if (!r.value) {
    if (!has_last_) {
      last_ = {StaticType::Any, emit_.reserve(StaticType::Any), false};
      has_last_ = true;
    }
    emit_.emit(Op::ReturnAny, last_.slot);
    return;
  }
  if (const auto* c = std::get_if<ast::Call>(&r.value->node)) {
    call(*c, *r.value);
    emit_.emit(Op::ReturnResult);
    return;
  }
  const auto value = expr(*r.value);
  emit_return(value);
  emit_.release(value);
}

void FunctionCompiler::emit_return(const Operand& value) {
  switch (value.type) {
    case StaticType::Int: emit_.emit(Op::ReturnInt, value.slot); break;
    case StaticType::Double: emit_.emit(Op::ReturnDouble, value.slot); break;
    case StaticType::Vector: emit_.emit(Op::ReturnVector, value.slot); break;
    case StaticType::Matrix: emit_.emit(Op::ReturnMatrix, value.slot); break;
    case StaticType::Any: emit_.emit(Op::ReturnAny, value.slot); break;
    case StaticType::Null: emit_.emit(Op::ReturnNull); break;
    default: emit_.emit(Op::ReturnRef, value.slot, static_cast<std::uint16_t>(value.type)); break;
  }
}

}  // namespace breve::steve
