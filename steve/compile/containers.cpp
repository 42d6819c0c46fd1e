// List operations, functions, creation of objects, calls of methods: to bytecode.
#include "steve/compile/builder.hpp"
#include "steve/compile/function_compiler.hpp"

namespace breve::steve {

namespace {

StaticType type_of_letter(char letter) {
  switch (letter) {
    case 'i': return StaticType::Int;
    case 'd': return StaticType::Double;
    case 'v': return StaticType::Vector;
    case 'm': return StaticType::Matrix;
    case 's': return StaticType::String;
    case 'o': return StaticType::Object;
    case 'l': return StaticType::List;
    case 'h': return StaticType::Hash;
    case 'p': return StaticType::Pointer;
    case 'b': return StaticType::Data;
    default: return StaticType::Any;
  }
}

}  // namespace

// --- functions -------------------------------------------------------------------------------------------------------

Operand FunctionCompiler::function_call(const ast::FunctionCall& f, const ast::Expr& e, const Operand* into) {
  const auto entry = builder_.find_function(f.name, f.arguments.size());
  if (!entry) {
    if (builder_.function_exists(f.name)) {
      std::string counts;
      for (std::size_t n = 0; n <= 8; ++n)
        if (builder_.find_function(f.name, n)) counts += (counts.empty() ? "" : " or ") + std::to_string(n);
      builder_.diagnostics().error(e.span, "argument-count",
                                   "function '" + f.name + "' takes " + counts +
                                       (counts == "1" ? " argument, not " : " arguments, not ") +
                                       std::to_string(f.arguments.size()),
                                   argument_count_help(f, e.span));
    } else {
      builder_.diagnostics().error(e.span, "unknown-function", "unknown function '" + f.name + "'",
                                   unknown_function_help(f, e.span));
    }
    for (const auto& argument : f.arguments) emit_.release(expr(*argument));
    const auto target = emit_.temporary(StaticType::Any);
    zero(target);
    return target;
  }
  if (f.name == "dot" || f.name == "cross") return product(f, e, into);
  if (f.name == "atan2" && f.arguments.size() == 1)
    builder_.lint(e.span, "lint-one-argument-atan2", "atan2 with one argument is atan",
                  "for an angle in all four quadrants write atan2(y, x)");
  const auto signature = entry->signature;
  std::vector<StaticType> types;
  for (std::size_t i = 0; i < f.arguments.size(); ++i) types.push_back(type_of_letter(signature[i]));
  const auto registers = emit_.block(types);
  for (std::size_t i = 0; i < f.arguments.size(); ++i) {
    const auto what = text("argument " + std::to_string(i + 1) + " of " + f.name);
    const auto value = convert(expr(*f.arguments[i], &registers[i]), types[i], what, &registers[i]);
    move(registers[i], value);
    emit_.release(value);
  }
  emit_.at(e.span);
  const auto type = signature.back() == 'n' ? StaticType::Null : type_of_letter(signature.back());
  emit_.emit_imm(entry->foreign ? Op::Foreign : Op::Function, registers.empty() ? std::uint16_t{0} : registers[0].slot,
                 static_cast<std::int32_t>(entry->number));
  emit_.release_block(registers);
  return result_register(type, into);
}

/// dot(a, b) and cross(a, b) are instructions, not calls.
Operand FunctionCompiler::product(const ast::FunctionCall& f, const ast::Expr& e, const Operand* into) {
  const auto argument = [&](std::size_t i) {
    const auto what = text("argument " + std::to_string(i + 1) + " of " + f.name);
    return convert(expr(*f.arguments[i]), StaticType::Vector, what);
  };
  const auto a = stable(argument(0), *f.arguments[1]);
  const auto b = argument(1);
  emit_.at(e.span);
  return f.name == "dot" ? emit_binary(Op::Dot, StaticType::Double, a, b, into)
                         : emit_binary(Op::Cross, StaticType::Vector, a, b, into);
}

Operand FunctionCompiler::random(const ast::RandomExpr& r) {
  const auto bound = expr(*r.bound);
  const auto emit2 = [&](Op op, StaticType type) {
    const auto target = emit_.temporary(type);
    emit_.emit(op, target.slot, bound.slot);
    emit_.release(bound);
    return target;
  };
  if (bound.type == StaticType::Int) return emit2(Op::RandomInt, StaticType::Int);
  if (bound.type == StaticType::Double) return emit2(Op::RandomDouble, StaticType::Double);
  if (bound.type == StaticType::Vector) return emit2(Op::RandomVector, StaticType::Vector);
  const auto box = boxed(bound);
  const auto target = emit_.temporary(StaticType::Any);
  emit_.emit(Op::RandomAny, target.slot, box.slot);
  emit_.release(box);
  return target;
}

Operand FunctionCompiler::unknown_class(const std::string& name, const Span& span) {
  builder_.report_unknown_class(name, span);
  const auto target = emit_.temporary(StaticType::Any);
  emit_.emit_imm(Op::NewNamed, target.slot, static_cast<std::int32_t>(builder_.string_number(name)));
  return target;
}

Operand FunctionCompiler::make_new(const ast::NewExpr& n) {
  const auto* cls = builder_.class_named(n.class_name);
  if (!cls) return unknown_class(n.class_name, n.class_span);
  if (n.count) {
    const auto count = any(*n.count);
    const auto target = emit_.temporary(StaticType::Any);
    emit_.emit(Op::NewCount, target.slot, count.slot);
    emit_.ext(0, static_cast<std::int32_t>(cls->id));
    emit_.release(count);
    return target;
  }
  const auto target = emit_.temporary(StaticType::Object);
  emit_.emit_imm(Op::New, target.slot, static_cast<std::int32_t>(cls->id));
  return target;
}

Operand FunctionCompiler::all(const ast::AllExpr& a) {
  const auto* cls = builder_.class_named(a.class_name);
  if (!cls) return unknown_class(a.class_name, a.class_span);
  const auto target = emit_.temporary(StaticType::List);
  emit_.emit_imm(Op::All, target.slot, static_cast<std::int32_t>(cls->id));
  return target;
}

// --- lists -----------------------------------------------------------------------------------------------------------

Operand FunctionCompiler::list_operand(const ast::Expr& e, std::string_view what) {
  const auto value = expr(e);
  if (value.type == StaticType::List) return value;
  const auto box = boxed(value);
  const auto target = emit_.temporary(StaticType::List);
  emit_.emit(Op::ToRef, target.slot, box.slot, static_cast<std::uint16_t>(text(std::string(what))));
  emit_.ext(static_cast<std::uint16_t>(StaticType::List), 1);
  emit_.release(box);
  return target;
}

Operand FunctionCompiler::push(const ast::Push& p) {
  const auto list = stable(list_operand(*p.list, p.front ? "the list of 'prepend'" : "the list of 'push'"), *p.value);
  auto value = expr(*p.value);
  const bool reference = value.type >= StaticType::String && value.type <= StaticType::Data;
  if (!p.front && value.type == StaticType::Int) {
    emit_.emit(Op::PushInt, list.slot, value.slot);
  } else if (!p.front && value.type == StaticType::Double) {
    emit_.emit(Op::PushDouble, list.slot, value.slot);
  } else if (!p.front && reference) {
    emit_.emit(Op::PushRef, list.slot, value.slot, static_cast<std::uint16_t>(value.type));
  } else {
    value = boxed(value);
    emit_.emit(p.front ? Op::Prepend : Op::Push, list.slot, value.slot);
  }
  emit_.release(value);
  return list;
}

Operand FunctionCompiler::pop(const ast::Pop& p) {
  const auto list = list_operand(*p.list, p.front ? "the operand of 'unprepend'" : "the operand of 'pop'");
  const auto target = emit_.temporary(StaticType::Any);
  emit_.emit(p.front ? Op::Unprepend : Op::Pop, target.slot, list.slot);
  emit_.release(list);
  return target;
}

Operand FunctionCompiler::insert(const ast::Insert& i) {
  auto list = stable(list_operand(*i.list, "the list of 'insert'"), *i.value);
  list = stable(list, *i.index);
  const auto value = any(*i.value);
  const auto position = any(*i.index);
  emit_.emit(Op::Insert, list.slot, value.slot, position.slot);
  emit_.release(position);
  emit_.release(value);
  return list;
}

Operand FunctionCompiler::remove(const ast::Remove& r) {
  const auto base = any(*r.base);
  const auto key = any(*r.index);
  const auto target = emit_.temporary(StaticType::Any);
  emit_.emit(Op::Remove, target.slot, base.slot, key.slot);
  emit_.release(key);
  emit_.release(base);
  return target;
}

Operand FunctionCompiler::copy_list(const ast::CopyList& c) {
  const auto list = list_operand(*c.list, "the operand of 'copylist'");
  const auto target = emit_.temporary(StaticType::List);
  emit_.emit(Op::CopyList, target.slot, list.slot);
  emit_.release(list);
  return target;
}

void FunctionCompiler::sort(const ast::Sort& s) {
  const auto list = list_operand(*s.list, "the operand of 'sort'");
  emit_.emit_imm(Op::Sort, list.slot, static_cast<std::int32_t>(builder_.symbol(s.selector)));
  emit_.release(list);
}

// --- calls -----------------------------------------------------------------------------------------------------------

void FunctionCompiler::call(const ast::Call& c, const ast::Expr& e) {
  const Span outer = emit_.span();
  emit_.at(c.selector_span.line != 0 ? c.selector_span : e.span);
  const auto number = static_cast<std::int32_t>(builder_.code().sites.size());
  CallSite site;
  site.selector = builder_.symbol(c.selector);
  site.span = emit_.span();
  site.in_class = &class_;
  for (const auto& keyword : c.keywords)
    site.arguments.push_back({builder_.symbol(keyword.name), StaticType::Any, 0, -1, keyword.span});
  const bool to_self = std::holds_alternative<ast::Self>(c.receiver->node);
  const bool to_super = std::holds_alternative<ast::Super>(c.receiver->node);
  if (to_super) site.super_of = &class_;
  builder_.code().sites.push_back(std::move(site));
  if (to_self || to_super) {
    arguments_and_call(c, to_self ? Op::CallSelf : Op::CallSuper, {}, number);
    emit_.at(outer);
    return;
  }
  auto receiver = expr(*c.receiver);
  for (const auto& keyword : c.keywords) receiver = stable(receiver, *keyword.value);
  emit_.at(e.span);
  if (receiver.type == StaticType::Object) {
    arguments_and_call(c, Op::Call, receiver, number);
    emit_.release(receiver);
    emit_.at(outer);
    return;
  }
  if (receiver.type != StaticType::List && receiver.type != StaticType::Any && receiver.type != StaticType::Null)
    builder_.lint(c.receiver->span, "lint-call-on-value",
                  "a method is called on a value without methods: only objects and lists of objects have methods",
                  "declare a variable for objects as (object)");
  // A dynamic receiver may be a list: the call then runs once for each element, arguments evaluated afresh.
  const auto box = boxed(receiver);
  const auto object = emit_.temporary(StaticType::Object);
  const auto list = emit_.temporary(StaticType::List);
  const auto counter = emit_.temporary(StaticType::Int);
  Label again, end;
  emit_.emit(Op::Broadcast, box.slot, object.slot, list.slot);
  emit_.jump_ext(end, counter.slot);
  emit_.place(again);
  arguments_and_call(c, Op::Call, object, number);
  emit_.emit(Op::BroadcastNext, 0, object.slot, list.slot);
  emit_.jump_ext(again, counter.slot);
  emit_.place(end);
  emit_.release(counter);
  emit_.release(list);
  emit_.release(object);
  emit_.release(box);
  emit_.at(outer);
}

void FunctionCompiler::arguments_and_call(const ast::Call& c, Op op, const Operand& receiver, std::int32_t number) {
  // Arguments are evaluated in the order of the parameters, which the receiver decides: it matters only if there are
  // several and one of them does more than look.
  bool ordered = false;
  if (c.keywords.size() > 1)
    for (const auto& keyword : c.keywords) ordered = ordered || has_effects(*keyword.value);
  const auto site = [&]() -> CallSite& { return builder_.code().sites[static_cast<std::size_t>(number)]; };
  const Span span = emit_.span();
  std::vector<Operand> values;
  std::vector<Emitter::FreeRegisters> aside;  // so that no argument is kept where an earlier one was worked out
  Operand counter;
  if (ordered) {
    counter = emit_.temporary(StaticType::Vector);
    const auto who = op == Op::Call ? receiver.slot : kResult;
    emit_.emit(Op::ResolveCall, who, counter.slot);
    emit_.ext(0, number);
  }
  for (std::size_t i = 0; i < c.keywords.size(); ++i) {
    if (ordered) site().arguments[i].block = emit_.here();
    auto value = expr(*c.keywords[i].value);
    if (ordered && !value.temporary) value = copy(value);
    site().arguments[i].type = value.type;
    site().arguments[i].slot = value.slot;
    values.push_back(value);
    if (!ordered) continue;
    emit_.emit_imm(Op::NextArgument, counter.slot, number);
    aside.push_back(emit_.set_aside());
  }
  emit_.at(span);
  site().call = emit_.here();
  if (op == Op::Call)
    emit_.emit_imm(op, receiver.slot, number);
  else
    emit_.emit_imm(op, 0, number);
  for (const auto& registers : aside) emit_.give_back(registers);
  if (ordered) emit_.release(counter);
  for (const auto& value : values) emit_.release(value);
}

}  // namespace breve::steve
