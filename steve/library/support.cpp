// Variables of library classes, names and numbers of objects, for native methods.
#include "steve/library/support.hpp"

#include <fmt/format.h>

#include "steve/library/library.hpp"

namespace breve::steve {

Slot* library_slot(Machine& machine, Instance& self, std::string_view owner, std::string_view name) {
  const SymbolTable& symbols = machine.program().symbols();
  for (const ClassInfo* cls = self.cls; cls; cls = cls->parent) {
    if (cls->name != owner) continue;
    for (const VariableInfo& variable : cls->variables)
      if (symbols.name(variable.name) == name) return &self.slots[variable.slot];
    return nullptr;
  }
  return nullptr;
}

Instance* library_object(Machine& machine, Instance& self, std::string_view owner, std::string_view name) {
  const Slot* slot = library_slot(machine, self, owner, name);
  if (!slot || !slot->ref) return nullptr;
  auto* object = static_cast<Instance*>(slot->ref);
  return object->live() ? object : nullptr;
}

void set_library_object(Machine& machine, Instance& self, std::string_view owner, std::string_view name,
                        Instance* object) {
  if (Slot* slot = library_slot(machine, self, owner, name)) machine.heap().store(*slot, object);
}

const ClassInfo* class_named(Machine& machine, const StringCell* name, std::string_view selector) {
  if (const ClassInfo* cls = machine.program().find_class(view(name))) return cls;
  if (library_source().find_file(view(name))) return nullptr;
  Machine::fail(RunErrorKind::UnknownClass,
                std::string(selector) + ": there is no class '" + std::string(view(name)) + "'");
}

std::string name_of(const Instance& object) { return fmt::format("{} (0x{:x})", object.cls->name, object.serial); }

void fail_kind(const Instance& object, std::string_view kind, std::string_view needed) {
  Machine::fail(RunErrorKind::Type,
                fmt::format("{} has native data of kind '{}' where '{}' is needed: it is an object of "
                            "another kind, or comes from a damaged archive",
                            name_of(object), kind, needed));
}

ObjectId object_with_index(Machine& machine, std::int32_t index) {
  if (index <= 0) return {};
  machine.charge_for(machine.world().object_count());
  for (ObjectId id : machine.world().objects())
    if (id.index == static_cast<std::uint32_t>(index)) return id;
  return {};
}

}  // namespace breve::steve
