// Functions on types, objects, classes, hashes, notifications and lifetimes.
#include <array>
#include <vector>

#include <fmt/format.h>

#include "steve/machine/functions.hpp"
#include "steve/machine/machine.hpp"
#include "steve/machine/operators.hpp"

namespace breve::steve {

namespace {

Instance& needed(Instance* object, std::string_view function) {
  if (object == nullptr) Machine::fail(RunErrorKind::NullObject, fmt::format("{} of a null object", function));
  if (!object->live())
    Machine::fail(RunErrorKind::FreedObject, fmt::format("{} of a freed object ({})", function, object->cls->name));
  return *object;
}

const ClassInfo& class_named(Machine& machine, std::string_view name) {
  const ClassInfo* cls = machine.program().find_class(name);
  if (cls == nullptr) machine.fail_unknown_class(name);
  return *cls;
}

StringCell* type_of(Machine& machine, Instance&, Value v) { return machine.heap().string(type_name(v.tag)); }

std::int32_t is_a(Machine& machine, Instance& self, StringCell* name) {
  const ClassInfo* cls = machine.program().find_class(view(name));
  return cls != nullptr && self.cls->derives_from(*cls) ? 1 : 0;
}

StringCell* object_name(Machine& machine, Instance&, Instance* object) {
  if (object == nullptr) Machine::fail(RunErrorKind::NullObject, "objectName of a null object");
  return machine.heap().string(object->cls->name);
}

std::int32_t responds_to(Machine& machine, Instance&, Instance* object, StringCell* method) {
  return machine.responds(*needed(object, "respondsTo").cls, view(method)) ? 1 : 0;
}

Instance* get_controller(Machine& machine, Instance&) { return machine.controller(); }

Instance* new_instance(Machine& machine, Instance&, StringCell* name) {
  return machine.create(class_named(machine, view(name)));
}

/// By position, to the method with exactly that many parameters. An error inside does not stop the caller, which gets
/// NULL, unless the run is strict.
Value call_method_named(Machine& machine, Instance&, Instance* object, StringCell* name, ListCell* list) {
  Instance& receiver = needed(object, "callMethodNamed");
  std::vector<Value> arguments;
  if (list != nullptr) {
    machine.charge_for(list->size);
    arguments.assign(list->begin(), list->end());
  }
  const MethodInfo* method = machine.find_method(*receiver.cls, view(name), arguments.size());
  Value result;
  if (method == nullptr) {
    const auto message = fmt::format("class {} has no method '{}' with {} parameter{}", receiver.cls->name, view(name),
                                     arguments.size(), arguments.size() == 1 ? "" : "s");
    if (machine.host().strict) Machine::fail(RunErrorKind::UnknownMethod, message);
    machine.warn(message);
  } else if (machine.host().strict) {
    result = machine.call(receiver, *method, arguments);
  } else if (!machine.call_guarded(receiver, *method, arguments, result)) {
    result = Value();
  }
  return result;
}

ListCell* keys_of(Machine& machine, Instance&, HashCell* hash) {
  if (hash == nullptr) return machine.heap().list();
  machine.charge_for(hash->used);
  return machine.heap().keys(*hash);
}

std::int32_t has_key(Machine& machine, Instance&, HashCell* hash, Value key) {
  return hash != nullptr && machine.heap().find(*hash, key) != nullptr ? 1 : 0;
}

// --- notifications and collisions ------------------------------------------------------------------------------------

/// The version with 2, else 1, else 0 parameters must exist; it gets (announcer, message) by position.
std::int32_t add_observer(Machine& machine, Instance& self, Instance* announcer, StringCell* message,
                          StringCell* method) {
  Instance& source = needed(announcer, "addObserver");
  for (const std::size_t count : {2, 1, 0}) {
    if (machine.find_method(*self.cls, view(method), count) == nullptr) continue;
    machine.world().observe(machine.id_of(&self), source.id, view(message), view(method));
    return 0;
  }
  machine.warn(fmt::format("class {} has no method '{}' with at most 2 parameters to observe '{}' with", self.cls->name,
                           view(method), view(message)));
  return -1;
}

void remove_observer(Machine& machine, Instance& self, Instance* announcer, StringCell* message) {
  if (announcer != nullptr && announcer->live())
    machine.world().unobserve(machine.id_of(&self), announcer->id, view(message));
}

void notify(Machine& machine, Instance& self, StringCell* message) {
  if (self.live()) machine.world().announce(self.id, std::string(view(message)));
}

void add_collision_handler(Machine& machine, Instance&, Instance* object, StringCell* name, StringCell* method) {
  Instance& owner = needed(object, "addCollisionHandler");
  const ClassInfo& other = class_named(machine, view(name));
  constexpr std::size_t kMostParameters = 5;
  for (std::size_t count = 0; count <= kMostParameters; ++count) {
    if (machine.find_method(*owner.cls, view(method), count) == nullptr) continue;
    machine.world().handle_collisions(owner.cls->id, other.id, view(method), owner.id);
    return;
  }
  machine.report_unknown_method(Severity::Warning, owner, view(method), "the collision handler is not registered");
}

// --- lifetimes -------------------------------------------------------------------------------------------------------

/// With auto-free, the table of objects gives its reference back: then only scripts keep the instance.
void set_auto_free(Machine& machine, Instance& self, std::int32_t on) {
  if (self.state != Instance::State::Live || self.auto_free == (on != 0)) return;
  self.auto_free = on != 0;
  if (on != 0)
    machine.heap().release(&self);
  else
    machine.heap().retain(&self);
}

std::int32_t retain_count(Machine&, Instance& self) { return static_cast<std::int32_t>(self.count); }

/// Dependencies belong to archives and keep nothing alive; an archive written by this function's caller holds
/// what the `add-dependency` method of the library recorded.
void change_dependency(Machine&, Instance&, Instance*) {}

/// A reference to a freed instance stays what it is in every case: there is nothing to switch off.
void set_freed_protection(Machine&, Instance&, std::int32_t) {}

void report_allocation(Machine& machine, Instance&) {
  machine.warn(fmt::format("{} instances in the world, {} cells in the heap", machine.world().object_count(),
                           machine.heap().live_cells()));
}

constexpr std::array kObjectFunctions = {
    native<type_of>("typeof"),
    native<is_a>("isa"),
    native<object_name>("objectName"),
    native<responds_to>("respondsTo"),
    native<get_controller>("getController"),
    native<new_instance>("newInstanceForClassString"),
    native<call_method_named>("callMethodNamed"),
    native<keys_of>("keys"),
    native<has_key>("hasKey"),
    native<add_observer>("addObserver"),
    native<remove_observer>("removeObserver"),
    native<notify>("notify"),
    native<add_collision_handler>("addCollisionHandler"),
    native<set_auto_free>("setGC"),
    native<retain_count>("getRetainCount"),
    native<change_dependency>("addDependency"),
    native<change_dependency>("removeDependency"),
    native<set_freed_protection>("setFreedInstanceProtection"),
    native<report_allocation>("objectAllocationReport"),
};

}  // namespace

std::span<const Native> object_functions() { return kObjectFunctions; }

}  // namespace breve::steve
