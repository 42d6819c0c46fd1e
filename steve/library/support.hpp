// What the native methods of the class library share: how they reach a body, a resource, a variable of a library class.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>

#include "runtime/world/world.hpp"
#include "steve/machine/machine.hpp"

namespace breve::steve {

inline Bodies& bodies_of(Machine& machine) { return machine.world().bodies(); }
inline Mechanics& dynamics_of(Machine& machine) { return machine.world().mechanics(); }

/// The body of an object. Error{Argument} if it has none, Error{Stale} if it is freed.
inline BodyIndex body_of(Machine& machine, const Instance& self) { return machine.world().body(self.id); }

/// An object argument that must be there. `what` names it: "set-shape: the shape".
/// @throws RunError{NullObject, FreedObject}
inline Instance& must_live(Instance* object, std::string_view what) {
  if (!object) Machine::fail(RunErrorKind::NullObject, std::string(what) + " is null (an uninitialised object)");
  if (!object->live()) Machine::fail(RunErrorKind::FreedObject, std::string(what) + " has been freed");
  return *object;
}

/// Once for each setting: in a flat world it means nothing, and `text` says what does.
inline void warn_if_flat(Machine& machine, std::string_view setting, std::string_view text) {
  if (machine.world().dimension() == 2) machine.warn_once("flat:" + std::string(setting), text);
}

/// Is this object of a class of the library, or of one that descends from it?
inline bool is_of_class(const Instance& object, std::string_view name) {
  const ClassInfo* cls = object.cls;
  while (cls && cls->name != name) cls = cls->parent;
  return cls != nullptr;
}

/// The value itself. @throws Error{Argument} "`what` must be finite"
inline double finite(double value, std::string_view what) {
  if (!std::isfinite(value)) throw Error(ErrorCode::Argument, std::string(what) + " must be finite");
  return value;
}
inline const Vector3& finite(const Vector3& value, std::string_view what) {
  if (!value.allFinite()) throw Error(ErrorCode::Argument, std::string(what) + " must be finite");
  return value;
}

/// RunError{Type}: the object has native data of one kind where that of another is needed.
[[noreturn]] void fail_kind(const Instance& object, std::string_view kind, std::string_view needed);

/// The native data of an object if it is exactly an R, else null. A null or freed object: null.
template <class R>
R* resource_of(Machine& machine, const Instance* object) {
  if (!object || !object->live()) return nullptr;
  Resource* resource = machine.world().resource(object->id);
  if (!resource || typeid(*resource) != typeid(R)) return nullptr;
  return static_cast<R*>(resource);
}

/// The native data of an object, made and attached on first use.
/// @throws RunError{Type} if it has native data of another kind: others may hold references into it
template <class R>
R& resource_made(Machine& machine, const Instance& self) {
  if (R* found = resource_of<R>(machine, &self)) return *found;
  if (const Resource* other = self.live() ? machine.world().resource(self.id) : nullptr)
    fail_kind(self, other->kind(), R::kKind);
  std::pmr::memory_resource* memory = machine.heap().memory();
  std::unique_ptr<R> made;
  if constexpr (std::is_constructible_v<R, std::pmr::memory_resource*>)
    made = make_in<R>(memory, memory);
  else
    made = make_in<R>(memory);
  R& resource = *made;
  machine.world().attach(self.id, std::move(made));
  return resource;
}

/// The slot of the variable `name` that the library class `owner` declares, in an instance of it or of a descendant; a
/// variable of the same name in a descendant is another one. Null if `self` is no such instance.
Slot* library_slot(Machine& machine, Instance& self, std::string_view owner, std::string_view name);

/// An object variable of a library class as library_slot finds it; null if there is none or its object is not live.
Instance* library_object(Machine& machine, Instance& self, std::string_view owner, std::string_view name);

/// Store an object in a variable of a library class, with counting. Does nothing if there is no such variable.
void set_library_object(Machine& machine, Instance& self, std::string_view owner, std::string_view name,
                        Instance* object);

/// Give an object a body at the origin with the controller's generic shape, a sphere of radius 1 (a box for a link).
void embody(Machine& machine, Instance& self, BodyKind kind);

/// The class of that name. Null if the program does not use it but this library, or a later one, has it: then there are
/// no objects of that class.
/// @throws RunError{UnknownClass} for any other name
const ClassInfo* class_named(Machine& machine, const StringCell* name, std::string_view selector);

/// `class (0xaddress)`, as messages name an object.
std::string name_of(const Instance& object);

/// The texture number of an image is the index of its object: 0 means no object. Null if no live object has it.
ObjectId object_with_index(Machine& machine, std::int32_t index);

}  // namespace breve::steve
