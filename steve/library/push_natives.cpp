// Natives of PushInterpreter.
#include <algorithm>
#include <limits>

#include "runtime/learn/push/text.hpp"
#include "steve/library/push_access.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using push::Interpreter;

Interpreter& own_interpreter(Machine& machine, Instance& self) { return interpreter_of(machine, self); }

// --- instructions of scripts -----------------------------------------------------------------------------------------

/// A list variable of the class; null if it is empty.
ListCell* list_variable(Machine& machine, Instance& self, std::string_view name) {
  const Slot* slot = library_slot(machine, self, "PushInterpreter", name);
  return slot ? static_cast<ListCell*>(slot->ref) : nullptr;
}

/// The number of the callback of this name: where its object and its method stand in the lists of the class.
std::int32_t interpreter_add_callback(Machine& machine, Instance& self, StringCell* name, Instance* object,
                                      StringCell* method, std::int32_t next) {
  Instance& receiver = must_live(object, "add-instruction: the instance");
  if (!machine.find_method(*receiver.cls, view(method), 0))
    Machine::fail(RunErrorKind::UnknownMethod, "add-instruction: " + name_of(receiver) + " has no method '" +
                                                   std::string(view(method)) + "' without keywords");
  Interpreter& interpreter = own_interpreter(machine, self);
  const push::Word* known = interpreter.find_word(view(name));
  const bool is_callback = known && known->kind == push::Word::Kind::Callback;
  const auto number = is_callback ? known->callback : static_cast<std::uint32_t>(std::max(next, 0));
  interpreter.add_callback(view(name), number);
  return static_cast<std::int32_t>(number);
}

void interpreter_add_macro(Machine& machine, Instance& self, StringCell* name, Instance* program) {
  const push::Code& code = code_of(machine, program, "add-macro: the program");
  own_interpreter(machine, self).add_macro(view(name), code);
}

/// Call the method behind an instruction. Scripts may do anything there, also free the interpreter.
void call_back(Machine& machine, Instance& self, std::uint32_t number) {
  ListCell* objects = list_variable(machine, self, "callbackObjects");
  ListCell* methods = list_variable(machine, self, "callbackMethods");
  if (!objects || !methods || number >= objects->size || number >= methods->size ||
      (*objects)[number].tag != Tag::Object || (*methods)[number].tag != Tag::String)
    Machine::fail(RunErrorKind::NullObject, name_of(self) + " has lost the object of an instruction");
  const Value object = (*objects)[number];
  const std::string method((view((*methods)[number].string())));
  Instance& receiver = must_live(object.object(), "the object of the Push instruction for '" + method + "'");
  const Pin pin(machine, object);
  machine.call(receiver, method);
}

// --- running ---------------------------------------------------------------------------------------------------------

/// Marks an interpreter as running, and keeps its object in memory.
class Running {
 public:
  Running(Machine& machine, Instance& self)
      : machine_(machine), self_(self), pin_(machine, Value::of(Tag::Object, &self)) {
    PushInterpreterResource& resource = resource_made<PushInterpreterResource>(machine, self);
    if (resource.running)
      Machine::fail(
          RunErrorKind::World,
          name_of(self) + " is already running: a method that its program calls cannot run it; use another one");
    resource.running = true;
  }
  ~Running() {
    if (auto* resource = resource_of<PushInterpreterResource>(machine_, &self_)) resource->running = false;
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  Interpreter& interpreter() {
    auto* resource = resource_of<PushInterpreterResource>(machine_, &self_);
    if (!resource)
      Machine::fail(RunErrorKind::FreedObject, "a method that a Push program calls has freed the interpreter");
    return resource->interpreter;
  }

 private:
  Machine& machine_;
  Instance& self_;
  Pin pin_;
};

constexpr std::uint64_t kUnitsPerIteration = 2;  // a step of Push takes half as long as an iteration of a script's loop

/// Do at most `steps`. 1 if that was not all there was to do.
std::int32_t advance(Machine& machine, Instance& self, Running& running, std::uint64_t steps) {
  for (;;) {
    Interpreter& interpreter = running.interpreter();
    const push::Outcome outcome = interpreter.advance(steps, machine.world().random());
    const std::uint32_t called = interpreter.called();
    machine.charge(1 + interpreter.take_work() / kUnitsPerIteration);
    if (outcome == push::Outcome::Finished) return 0;
    if (outcome == push::Outcome::CutOff) return 1;
    if (outcome == push::Outcome::Called) call_back(machine, self, called);
  }
}

void print_code(Machine& machine, std::string_view title, const push::Stack<push::Code>& stack) {
  std::pmr::string text(title, machine.heap().memory());
  for (std::size_t i = stack.size(); i-- > 0;) {
    machine.charge_for(stack[i].points());
    text += ' ';
    push::print(stack[i], text);
  }
  text += '\n';
  machine.print(text);
}

std::uint64_t steps_of(const Interpreter& interpreter, std::int32_t steps) {
  return static_cast<std::uint64_t>(steps < 0 ? interpreter.settings.evaluation_limit : steps);
}

std::int32_t interpreter_run(Machine& machine, Instance& self, Instance* program, std::int32_t for_steps) {
  const push::Code code = code_of(machine, program, "run: the program");
  Running running(machine, self);
  running.interpreter().begin(code);
  const std::int32_t cut = advance(machine, self, running, steps_of(running.interpreter(), for_steps));
  if (cut == 0) running.interpreter().end();
  return cut;
}

std::int32_t interpreter_run_dumping(Machine& machine, Instance& self, Instance* program, std::int32_t for_steps) {
  const push::Code code = code_of(machine, program, "run-with-exec-stack-dump: the program");
  Running running(machine, self);
  running.interpreter().begin(code);
  std::int32_t cut = running.interpreter().execs.empty() ? 0 : 1;
  for (std::uint64_t left = steps_of(running.interpreter(), for_steps); cut != 0 && left > 0; --left) {
    print_code(machine, "EXEC:", running.interpreter().execs);
    cut = advance(machine, self, running, 1);
  }
  if (cut == 0) running.interpreter().end();
  return cut;
}

std::int32_t interpreter_step(Machine& machine, Instance& self, std::int32_t for_steps) {
  Running running(machine, self);
  return advance(machine, self, running, static_cast<std::uint64_t>(std::max(for_steps, 0)));
}

std::int32_t interpreter_get_effort(Machine& machine, Instance& self) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(std::min(own_interpreter(machine, self).effort, kMost));
}

void interpreter_reset_effort(Machine& machine, Instance& self) { own_interpreter(machine, self).effort = 0; }

// --- settings --------------------------------------------------------------------------------------------------------

void interpreter_configure(Machine& machine, Instance& self, StringCell* text) {
  constexpr std::uint64_t kOfSettings = 32;  // loop iterations
  machine.charge(kOfSettings);
  machine.charge_for(view(text).size());
  std::pmr::string unknown(machine.heap().memory());
  push::Interpreter& interpreter = own_interpreter(machine, self);
  interpreter.settings.read(view(text), unknown, machine.poller(), [&](std::string_view name) {
    const push::Word* word = interpreter.find_word(name);
    return word && word->kind != push::Word::Kind::Defined;
  });
  if (!unknown.empty()) {
    unknown.pop_back();
    machine.warn("read-config: " + std::string(unknown));
  }
}

void interpreter_set_list_limit(Machine& machine, Instance& self, std::int32_t limit) {
  constexpr auto kMost = static_cast<std::int32_t>(push::kMaxPoints);
  if (limit < 1 || limit > kMost)
    throw Error(ErrorCode::Argument,
                "set-list-limit: " + std::to_string(limit) + " points (must be 1 to " + std::to_string(kMost) + ")");
  own_interpreter(machine, self).settings.list_limit = limit;
}

std::int32_t interpreter_get_list_limit(Machine& machine, Instance& self) {
  return own_interpreter(machine, self).settings.list_limit;
}

void interpreter_set_evaluation_limit(Machine& machine, Instance& self, std::int32_t limit) {
  if (limit < 0)
    throw Error(ErrorCode::Argument, "set-evaluation-limit: " + std::to_string(limit) + " steps (must be >= 0)");
  own_interpreter(machine, self).settings.evaluation_limit = limit;
}

std::int32_t interpreter_get_evaluation_limit(Machine& machine, Instance& self) {
  return own_interpreter(machine, self).settings.evaluation_limit;
}

void interpreter_print_config(Machine& machine, Instance& self) {
  std::pmr::string text(machine.heap().memory());
  const Interpreter& interpreter = own_interpreter(machine, self);
  interpreter.settings.print(text);
  for (const auto& [name, word] : interpreter.words())
    if (word.kind != push::Word::Kind::Defined) text.append("instruction ").append(name).append("\n");
  machine.charge_for(text.size());
  machine.print(text);
}

// --- stacks ----------------------------------------------------------------------------------------------------------

template <class Stack>
void print_plain(Machine& machine, std::string_view title, const Stack& stack,
                 push::Node (*node)(typename Stack::value_type)) {
  std::pmr::string text(title, machine.heap().memory());
  machine.charge_for(stack.size());
  for (std::size_t i = stack.size(); i-- > 0;) {
    text += ' ';
    push::print(node(stack[i]), text);
  }
  text += '\n';
  machine.print(text);
}

void interpreter_print_exec_stack(Machine& machine, Instance& self) {
  print_code(machine, "EXEC:", own_interpreter(machine, self).execs);
}

void interpreter_print_stacks(Machine& machine, Instance& self) {
  const Interpreter& m = own_interpreter(machine, self);
  print_plain(
      machine, "INTEGER:", m.integers, +[](std::int32_t x) { return push::Node::of_integer(x); });
  print_plain(
      machine, "FLOAT:", m.floats, +[](double x) { return push::Node::of_float(x); });
  print_plain(
      machine, "BOOLEAN:", m.booleans, +[](std::uint8_t x) { return push::Node::of_boolean(x != 0); });
  print_plain(
      machine, "VECTOR:", m.vectors, +[](Vector3 x) { return push::Node::of_vector(x); });
  print_code(machine, "NAME:", m.names);
  print_code(machine, "CODE:", m.codes);
  print_code(machine, "EXEC:", m.execs);
}

void interpreter_clear_stacks(Machine& machine, Instance& self) { own_interpreter(machine, self).clear(); }

/// A push from outside meets a full stack with an error.
template <class T, class U>
void push_on(Machine& machine, Instance& self, push::Stack<T> Interpreter::*stack, U&& value) {
  Interpreter& interpreter = own_interpreter(machine, self);
  if ((interpreter.*stack).size() >= Interpreter::kMaxDepth)
    Machine::fail(RunErrorKind::Bounds, "a Push stack holds at most " + std::to_string(Interpreter::kMaxDepth) +
                                            " items; clear-stacks empties all");
  (interpreter.*stack).push_back(std::forward<U>(value));
}

template <push::Stack<push::Code> Interpreter::*S>
void interpreter_push_code(Machine& machine, Instance& self, Instance* program) {
  push_on(machine, self, S, code_of(machine, program, "push-code: the program"));
}
void interpreter_push_float(Machine& machine, Instance& self, double value) {
  push_on(machine, self, &Interpreter::floats, finite(value, "push-float: the value"));
}
void interpreter_push_integer(Machine& machine, Instance& self, std::int32_t value) {
  push_on(machine, self, &Interpreter::integers, value);
}
void interpreter_push_boolean(Machine& machine, Instance& self, std::int32_t value) {
  push_on(machine, self, &Interpreter::booleans, static_cast<std::uint8_t>(value != 0));
}
void interpreter_push_vector(Machine& machine, Instance& self, Vector3 value) {
  push_on(machine, self, &Interpreter::vectors, finite(value, "push-vector: the value"));
}

template <auto S>
std::int32_t stack_size(Machine& machine, Instance& self) {
  return static_cast<std::int32_t>((own_interpreter(machine, self).*S).size());
}

/// The top, or the zero of its type.
template <auto S, class R>
R stack_top(Machine& machine, Instance& self) {
  const auto& stack = own_interpreter(machine, self).*S;
  return stack.empty() ? R{} : static_cast<R>(stack.back());
}
Vector3 vector_top(Machine& machine, Instance& self) {
  const auto& stack = own_interpreter(machine, self).vectors;
  return stack.empty() ? Vector3(Vector3::Zero()) : stack.back();
}

template <auto S>
void pop_stack(Machine& machine, Instance& self) {
  auto& stack = own_interpreter(machine, self).*S;
  if (!stack.empty()) stack.pop_back();
}

template <push::Stack<push::Code> Interpreter::*S>
void copy_top(Machine& machine, Instance& self, Instance* program) {
  const auto& stack = own_interpreter(machine, self).*S;
  const push::Code top = stack.empty() ? push::empty_list(machine.heap().memory()) : stack.back();
  code_of(machine, program, "copy-stack-top: the program");
  set_code(machine, *program, top);
}

constexpr Native kPushNatives[] = {
    native<interpreter_add_callback>("push-interpreter.add-callback"),
    native<interpreter_add_macro>("push-interpreter.add-macro"),
    native<interpreter_configure>("push-interpreter.configure"),
    native<interpreter_set_list_limit>("push-interpreter.set-list-limit"),
    native<interpreter_get_list_limit>("push-interpreter.get-list-limit"),
    native<interpreter_set_evaluation_limit>("push-interpreter.set-evaluation-limit"),
    native<interpreter_get_evaluation_limit>("push-interpreter.get-evaluation-limit"),
    native<interpreter_run>("push-interpreter.run"),
    native<interpreter_run_dumping>("push-interpreter.run-with-exec-stack-dump"),
    native<interpreter_step>("push-interpreter.step"),
    native<interpreter_get_effort>("push-interpreter.get-effort"),
    native<interpreter_reset_effort>("push-interpreter.reset-effort"),
    native<interpreter_print_config>("push-interpreter.print-config"),
    native<interpreter_print_stacks>("push-interpreter.print-stacks"),
    native<interpreter_print_exec_stack>("push-interpreter.print-exec-stack"),
    native<interpreter_push_code<&Interpreter::codes>>("push-interpreter.push-code"),
    native<interpreter_push_code<&Interpreter::execs>>("push-interpreter.push-exec"),
    native<interpreter_push_float>("push-interpreter.push-float"),
    native<interpreter_push_integer>("push-interpreter.push-integer"),
    native<interpreter_push_boolean>("push-interpreter.push-boolean"),
    native<interpreter_push_vector>("push-interpreter.push-vector"),
    native<stack_size<&Interpreter::floats>>("push-interpreter.get-float-stack-size"),
    native<stack_size<&Interpreter::integers>>("push-interpreter.get-integer-stack-size"),
    native<stack_size<&Interpreter::booleans>>("push-interpreter.get-boolean-stack-size"),
    native<stack_size<&Interpreter::codes>>("push-interpreter.get-code-stack-size"),
    native<stack_size<&Interpreter::execs>>("push-interpreter.get-exec-stack-size"),
    native<stack_size<&Interpreter::vectors>>("push-interpreter.get-vector-stack-size"),
    native<stack_top<&Interpreter::floats, double>>("push-interpreter.get-float-stack-top"),
    native<stack_top<&Interpreter::booleans, std::int32_t>>("push-interpreter.get-boolean-stack-top"),
    native<stack_top<&Interpreter::integers, std::int32_t>>("push-interpreter.get-integer-stack-top"),
    native<vector_top>("push-interpreter.get-vector-stack-top"),
    native<copy_top<&Interpreter::codes>>("push-interpreter.copy-code-stack-top"),
    native<copy_top<&Interpreter::execs>>("push-interpreter.copy-exec-stack-top"),
    native<interpreter_clear_stacks>("push-interpreter.clear-stacks"),
    native<pop_stack<&Interpreter::floats>>("push-interpreter.pop-float-stack"),
    native<pop_stack<&Interpreter::booleans>>("push-interpreter.pop-boolean-stack"),
    native<pop_stack<&Interpreter::integers>>("push-interpreter.pop-integer-stack"),
    native<pop_stack<&Interpreter::vectors>>("push-interpreter.pop-vector-stack"),
    native<pop_stack<&Interpreter::codes>>("push-interpreter.pop-code-stack"),
    native<pop_stack<&Interpreter::execs>>("push-interpreter.pop-exec-stack"),
};

}  // namespace

std::span<const Native> push_natives() { return kPushNatives; }

}  // namespace breve::steve
