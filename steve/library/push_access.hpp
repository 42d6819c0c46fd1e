// How natives reach the Push data of objects.
#pragma once

#include "steve/library/push_resources.hpp"
#include "steve/library/support.hpp"

namespace breve::steve {

inline push::Interpreter& interpreter_of(Machine& machine, Instance& self) {
  return resource_made<PushInterpreterResource>(machine, self).interpreter;
}

/// The interpreter of an object argument. @throws RunError{NullObject, FreedObject, Type}
inline push::Interpreter& interpreter_of(Machine& machine, Instance* object, std::string_view what) {
  Instance& live = must_live(object, what);
  if (!is_of_class(live, "PushInterpreter"))
    Machine::fail(RunErrorKind::Type, std::string(what) + ": " + name_of(live) + " is not a PushInterpreter");
  return interpreter_of(machine, live);
}

inline push::Code& code_of(Machine& machine, Instance& self) {
  return resource_made<PushProgramResource>(machine, self).code;
}

/// The code of an object argument. @throws RunError{NullObject, FreedObject, Type}
inline push::Code& code_of(Machine& machine, Instance* object, std::string_view what) {
  Instance& live = must_live(object, what);
  if (!is_of_class(live, "PushProgram"))
    Machine::fail(RunErrorKind::Type, std::string(what) + ": " + name_of(live) + " is not a PushProgram");
  return code_of(machine, live);
}

/// Give a program code that may be a part of another: the program keeps nothing else of it.
inline void set_code(Machine& machine, Instance& program, const push::Code& code) {
  machine.charge_for(code.points());
  code_of(machine, program) = push::compact(code, machine.heap().memory());
}

}  // namespace breve::steve
