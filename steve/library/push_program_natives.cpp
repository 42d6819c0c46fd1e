// Natives of PushProgram and PushDiversityPool.
#include <fmt/format.h>

#include <cmath>

#include "runtime/learn/push/random_code.hpp"
#include "runtime/learn/push/text.hpp"
#include "steve/library/push_access.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

push::Code& own_code(Machine& machine, Instance& self) {
  push::Code& code = code_of(machine, self);
  machine.charge_for(code.points());
  return code;
}

Random& random_of(Machine& machine) { return machine.world().random(); }

// --- text and lists --------------------------------------------------------------------------------------------------

/// What reading text takes by the byte, and an element of a list, in units of charge_for.
constexpr std::uint64_t kOfByte = 4, kOfElement = 64;

Instance* program_parse(Machine& machine, Instance& self, StringCell* text) {
  std::pmr::memory_resource* memory = machine.heap().memory();
  machine.charge_for(kOfByte * view(text).size());
  try {
    code_of(machine, self) = push::parse(view(text), memory, machine.poller());
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Argument) throw;
    code_of(machine, self) = push::empty_list(memory);
    machine.warn(std::string("parse: ") + error.what() + "; the program is empty now");
  }
  return &self;
}

StringCell* program_get_string(Machine& machine, Instance& self) {
  std::pmr::string text(machine.heap().memory());
  push::print(own_code(machine, self), text);
  machine.charge_for(text.size());
  return machine.heap().string(text);
}

Value value_of(Machine& machine, const push::Node& atom) {
  switch (atom.kind) {
    case push::Kind::Integer: return Value::of(atom.integer);
    case push::Kind::Float: return Value::of(atom.real);
    case push::Kind::Vector: return Value::of(atom.as_vector());
    default: break;
  }
  std::pmr::string text(machine.heap().memory());
  push::print(atom, text);
  return Value::of(Tag::String, machine.heap().string(text));
}

ListCell* program_get_list(Machine& machine, Instance& self) {
  struct Open {
    std::uint32_t end;
    ListCell* list;
  };
  const push::Code& code = own_code(machine, self);
  ListCell* all = machine.heap().list();
  std::pmr::vector<Open> open({{code.points(), all}}, machine.heap().memory());
  for (std::uint32_t i = code.is_list() ? 1 : 0; i < code.points(); ++i) {
    while (open.back().end == i) open.pop_back();
    const push::Node& node = code.nodes()[i];
    ListCell& within = *open.back().list;
    if (node.is_list()) {
      ListCell* list = machine.heap().list();
      machine.heap().push(within, Value::of(Tag::List, list));
      open.push_back({i + node.points, list});
    } else {
      machine.heap().push(within, value_of(machine, node));
    }
  }
  return all;
}

/// What one element of a list stands for, but a list.
void add_element(Machine& machine, const Value& value, push::Builder& builder) {
  switch (value.tag) {
    case Tag::Int: return builder.atom(push::Node::of_integer(value.i));
    case Tag::Double: return builder.atom(push::Node::of_float(finite(value.d, "set-from: a number")));
    case Tag::Vector: return builder.atom(push::Node::of_vector(finite(value.vector(), "set-from: a vector")));
    case Tag::String: return push::parse_into(view(value.string()), builder, machine.poller());
    case Tag::Object: return builder.copy(code_of(machine, value.object(), "set-from: an element"));
    default:
      throw Error(ErrorCode::Argument, "set-from: a list of code holds texts, numbers, vectors, programs, lists");
  }
}

void program_set_from(Machine& machine, Instance& self, ListCell* elements) {
  struct Open {
    const ListCell* list;
    std::uint32_t next, point;  // element of the list; point of the builder
  };
  push::Builder builder(machine.heap().memory());
  std::pmr::vector<Open> open({{elements, 0, builder.begin_list()}}, machine.heap().memory());
  while (!open.empty()) {
    Open& last = open.back();
    if (!last.list || last.next == last.list->size) {
      builder.end_list(last.point);
      open.pop_back();
      continue;
    }
    const Value value = (*last.list)[last.next++];
    machine.charge_for(kOfElement + (value.tag == Tag::String ? kOfByte * view(value.string()).size() : 0));
    if (value.tag == Tag::List)
      open.push_back(
          {value.list(), 0, builder.begin_list()});  // a list that holds itself ends at the greatest size of code
    else
      add_element(machine, value, builder);
  }
  code_of(machine, self) = builder.finish();
}

// --- chance ----------------------------------------------------------------------------------------------------------

void program_make_random(Machine& machine, Instance& self, Instance* interpreter, std::int32_t most) {
  push::Interpreter& from = interpreter_of(machine, interpreter, "make-random-code: the interpreter");
  const std::int32_t bound = most < 0 ? from.settings.random_points : most;
  constexpr std::uint64_t kOfPoint = 8;
  machine.charge_for(kOfPoint * static_cast<std::uint64_t>(std::min(bound, from.settings.list_limit)));
  code_of(machine, self) = push::CodeSource(from, random_of(machine)).random_code(static_cast<std::uint32_t>(bound));
}

void program_mutate(Machine& machine, Instance& self, Instance* interpreter, double leaf_bias, double size_scale,
                    std::int32_t) {
  push::Interpreter& from = interpreter_of(machine, interpreter, "mutate: the interpreter");
  const push::Mutation how{finite(leaf_bias, "mutate: the leaf bias"), finite(size_scale, "mutate: the size scale")};
  push::Code& code = own_code(machine, self);
  machine.charge_for(code.points());  // all of it is written anew
  code = push::mutated(code, how, from, random_of(machine));
}

void program_crossover(Machine& machine, Instance& self, Instance* parent1, Instance* parent2, Instance* interpreter) {
  const push::Interpreter& from = interpreter_of(machine, interpreter, "crossover: the interpreter");
  const push::Code first = code_of(machine, parent1, "crossover: the first parent");
  const push::Code second = code_of(machine, parent2, "crossover: the second parent");
  machine.charge_for(std::uint64_t{first.points()} + second.points());
  const auto limit = static_cast<std::uint32_t>(from.settings.list_limit);
  set_code(machine, self, push::crossed(first, second, limit, random_of(machine), machine.heap().memory()));
}

void program_delete_subtree(Machine& machine, Instance& self) {
  push::Code& code = own_code(machine, self);
  if (const auto point = push::random_inner_point(code, random_of(machine)))
    code = push::remove(code, *point, machine.heap().memory());
}

void program_flatten_subtree(Machine& machine, Instance& self) {
  push::Code& code = own_code(machine, self);
  if (const auto point = push::random_inner_list(code, random_of(machine)))
    code = push::flatten(code, *point, machine.heap().memory());
}

// --- the rest --------------------------------------------------------------------------------------------------------

void program_copy_from(Machine& machine, Instance& self, Instance* other) {
  set_code(machine, self, code_of(machine, other, "copy-from: the program"));
}

double program_get_first_float(Machine& machine, Instance& self) {
  const push::Code& code = own_code(machine, self);
  for (std::uint32_t i = 0; i < code.points(); ++i)
    if (code.nodes()[i].kind == push::Kind::Float) return code.nodes()[i].real;
  return 0;
}

std::int32_t program_get_size(Machine& machine, Instance& self) {
  return static_cast<std::int32_t>(code_of(machine, self).points());
}

std::int32_t program_get_top_level_size(Machine& machine, Instance& self) {
  return static_cast<std::int32_t>(own_code(machine, self).length());
}

void program_swap_sublists(Machine& machine, Instance& self, std::int32_t x, std::int32_t y) {
  push::Code& code = own_code(machine, self);
  const auto items = static_cast<std::int32_t>(code.length());
  for (const std::int32_t point : {x, y})
    if (point < 0 || point >= items)
      throw Error(ErrorCode::Argument, "swap-sublists: item " + std::to_string(point) + " of a program of " +
                                           std::to_string(items) + " items (they are counted from 0)");
  if (x != y)
    code = push::swap_items(code, static_cast<std::uint32_t>(std::min(x, y)),
                            static_cast<std::uint32_t>(std::max(x, y)), machine.heap().memory());
}

/// Comparing looks at each point of both several times.
constexpr std::uint64_t kLooks = 16;

std::int32_t program_get_discrepancy(Machine& machine, Instance& self, Instance* other) {
  const push::Code& from = code_of(machine, other, "get-discrepancy: the program");
  const push::Code& code = code_of(machine, self);
  machine.charge_for(kLooks * (std::uint64_t{code.points()} + from.points()));
  return static_cast<std::int32_t>(push::discrepancy(code, from, machine.heap().memory()));
}

std::int32_t program_get_top_level_difference(Machine& machine, Instance& self, Instance* other) {
  const push::Code& from = code_of(machine, other, "get-top-level-difference: the program");
  return static_cast<std::int32_t>(push::top_level_difference(own_code(machine, self), from));
}

// --- PushDiversityPool -----------------------------------------------------------------------------------------------

PushPoolResource& own_pool(Machine& machine, Instance& self) { return resource_made<PushPoolResource>(machine, self); }

void pool_set_tolerance(Machine& machine, Instance& self, std::int32_t tolerance) {
  if (tolerance < 0)
    throw Error(ErrorCode::Argument, "set-tolerance: " + fmt::to_string(tolerance) + " (must be >= 0)");
  own_pool(machine, self).tolerance = tolerance;
}

/// Programs whose sizes differ by more than the tolerance do so themselves, and need no closer look.
std::int32_t pool_add(Machine& machine, Instance& self, Instance* program) {
  const push::Code code = code_of(machine, program, "add: the program");
  PushPoolResource& pool = own_pool(machine, self);
  for (const push::Code& known : pool.programs) {
    const std::int64_t sizes = std::int64_t{known.points()} - code.points();
    machine.charge_for(kLooks);
    if (std::abs(sizes) > pool.tolerance + std::int64_t{1}) continue;
    machine.charge_for(kLooks * (std::uint64_t{known.points()} + code.points()));
    if (push::discrepancy(known, code, machine.heap().memory()) <= static_cast<std::uint32_t>(pool.tolerance)) return 0;
  }
  pool.programs.push_back(code);
  return 1;
}

std::int32_t pool_get_size(Machine& machine, Instance& self) {
  return static_cast<std::int32_t>(own_pool(machine, self).programs.size());
}

void pool_clear(Machine& machine, Instance& self) { own_pool(machine, self).programs.clear(); }

constexpr Native kPushProgramNatives[] = {
    native<program_parse>("push-program.parse"),
    native<program_get_string>("push-program.get-string"),
    native<program_get_list>("push-program.get-list"),
    native<program_set_from>("push-program.set-from"),
    native<program_make_random>("push-program.make-random-code"),
    native<program_mutate>("push-program.mutate"),
    native<program_crossover>("push-program.crossover"),
    native<program_delete_subtree>("push-program.delete-random-subtree"),
    native<program_flatten_subtree>("push-program.flatten-random-subtree"),
    native<program_copy_from>("push-program.copy-from"),
    native<program_get_first_float>("push-program.get-first-float"),
    native<program_get_size>("push-program.get-size"),
    native<program_get_top_level_size>("push-program.get-top-level-size"),
    native<program_swap_sublists>("push-program.swap-sublists"),
    native<program_get_discrepancy>("push-program.get-discrepancy"),
    native<program_get_top_level_difference>("push-program.get-top-level-difference"),
    native<pool_set_tolerance>("push-pool.set-tolerance"),
    native<pool_add>("push-pool.add"),
    native<pool_get_size>("push-pool.get-size"),
    native<pool_clear>("push-pool.clear"),
};

}  // namespace

std::span<const Native> push_program_natives() { return kPushProgramNatives; }

}  // namespace breve::steve
