// Natives of Data, Genome and File: variables of an object as one thing to check, copy and cross.
#include <algorithm>
#include <vector>

#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

bool is_reference(StaticType type) {
  return type == StaticType::String || type == StaticType::Object || type == StaticType::List ||
         type == StaticType::Hash || type == StaticType::Pointer || type == StaticType::Data;
}

/// The variables that the classes below Data declare, ancestors first.
std::vector<const VariableInfo*> contents_of(const Instance& self) {
  std::vector<const ClassInfo*> classes;
  for (const ClassInfo* cls = self.cls; cls && cls->name != "Data"; cls = cls->parent) classes.push_back(cls);
  std::vector<const VariableInfo*> variables;
  for (auto cls = classes.rbegin(); cls != classes.rend(); ++cls)
    for (const VariableInfo& variable : (*cls)->variables) variables.push_back(&variable);
  return variables;
}

void data_init(Machine& machine, Instance& self) {
  for (const VariableInfo* variable : contents_of(self)) {
    if (variable->type != StaticType::Object && variable->type != StaticType::Pointer) continue;
    Machine::fail(RunErrorKind::Type, "class " + self.cls->name + " is Data: its variable '" +
                                          machine.program().symbols().name(variable->name) +
                                          "' must not be an object or a pointer");
  }
}

/// Lists are copied, with the lists inside them; hashes and data are shared.
void copy_slot(Machine& machine, const Slot& from, Slot& to, StaticType type) {
  if (!is_reference(type)) {
    to = from;
    return;
  }
  Cell* cell = from.ref;
  if (type == StaticType::List && cell) cell = machine.heap().copy(*static_cast<ListCell*>(cell));
  machine.heap().store(to, cell);
}

void copy_variable(Machine& machine, const Instance& from, Instance& to, const VariableInfo& variable) {
  const int elements = variable.array_size >= 0 ? variable.array_size : 1;
  const int slots = elements * slot_count(variable.type);
  for (int i = 0; i < slots; ++i)
    copy_slot(machine, from.slots[variable.slot + static_cast<std::uint32_t>(i)],
              to.slots[variable.slot + static_cast<std::uint32_t>(i)], variable.type);
}

/// @throws RunError{Type} unless both are of one class
Instance& same_class(Instance& self, Instance* other, std::string_view what) {
  Instance& live = must_live(other, what);
  if (live.cls != self.cls)
    Machine::fail(RunErrorKind::Type, std::string(what) + " is of class " + live.cls->name + ", not " + self.cls->name);
  return live;
}

void data_copy_contents(Machine& machine, Instance& self, Instance* other) {
  Instance& target = same_class(self, other, "copy-contents: the object");
  if (&target == &self) return;
  for (const VariableInfo* variable : contents_of(self)) copy_variable(machine, self, target, *variable);
}

void genome_crossover(Machine& machine, Instance& self, Instance* first, Instance* second) {
  const Instance* parents[] = {&same_class(self, first, "crossover: the first parent"),
                               &same_class(self, second, "crossover: the second parent")};
  // The genes: variables of the concrete class, in the order of their names.
  std::vector<const VariableInfo*> genes;
  for (const VariableInfo& variable : self.cls->variables) genes.push_back(&variable);
  const SymbolTable& symbols = machine.program().symbols();
  std::sort(genes.begin(), genes.end(),
            [&](const auto* a, const auto* b) { return symbols.name(a->name) < symbols.name(b->name); });

  Random& random = machine.world().random();
  if (random.below_or_equal(1) == 1) std::swap(parents[0], parents[1]);
  const auto cut = static_cast<std::size_t>(random.below_or_equal(static_cast<std::int32_t>(genes.size())));
  for (std::size_t i = 0; i < genes.size(); ++i) {
    const Instance& parent = *parents[i < cut ? 0 : 1];
    if (&parent != &self) copy_variable(machine, parent, self, *genes[i]);
  }
}

DataCell* file_as_data(Machine& machine, Instance&, Text bytes) { return machine.heap().data(view(bytes)); }

constexpr Native kDataNatives[] = {
    native<data_init>("data.init"),
    native<data_copy_contents>("data.copy-contents"),
    native<genome_crossover>("genome.crossover"),
    native<file_as_data>("file.as-data"),
};

}  // namespace

std::span<const Native> data_natives() { return kDataNatives; }

}  // namespace breve::steve
