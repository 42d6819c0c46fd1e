// What the C functions on bodies with physics share: numbers in and out, objects of a kind of native data.
#pragma once

#include <algorithm>
#include <cstring>

#include "internal.hpp"
#include "runtime/mechanics/mechanics.hpp"
#include "steve/library/joints.hpp"

namespace breve::host {

/// Three finite numbers. `what` names the argument.
inline Vector3 vector_of(const double* numbers, const char* what) {
  need_finite(numbers, 3, what);
  return {numbers[0], numbers[1], numbers[2]};
}

inline void copy_to(double* out, const Vector3& v) { std::copy_n(v.data(), 3, out); }

/// A quaternion (w, x, y, z) of any length but 0, made unit length without overflow. BREVE_ERROR_ARGUMENT.
Quaternion rotation_of(const double* numbers, const char* what);

/// The live object, which must be of the library's class of that name or derived from it: else BREVE_ERROR_TYPE.
steve::Instance& object_of_kind(const breve_world& world, breve_object object, std::string_view library_class);

/// The shape that a description means. BREVE_ERROR_ARGUMENT, Error{Argument}.
std::shared_ptr<Shape> geometry_shape(const breve_geometry& geometry, bool flat, std::pmr::memory_resource* memory);

/// A new object of a class of the library that the program has: else BREVE_ERROR_NOT_FOUND.
steve::Instance& make_object(breve_world& world, const char* library_class);

/// The same, for `work`: if that fails the object is freed again.
template <class Work>
breve_object make_with(breve_world& world, const char* library_class, Work work) {
  const ScriptScope script(world);
  steve::Instance& object = make_object(world, library_class);
  try {
    work(object);
  } catch (...) {
    world.machine->free_instance(object);
    throw;
  }
  return handle_of(world, object.id);
}

breve_intervention to_host(const breve_world& world, const Intervention& one);

/// A copy of an array, as much as there is room for; the count of all.
template <class Out, class In, class Convert>
void copy_list(const In& all, Out* out, std::size_t capacity, std::size_t* count, const char* what, Convert convert) {
  if (capacity != 0) need(out, what);
  need(count, "count");
  std::size_t written = 0;
  for (const auto& one : all) {
    if (written == capacity) break;
    out[written++] = convert(one);
  }
  *count = all.size();
}

/// Fill a struct of an older or this header's size.
/// @throws StatusError if its struct_size is not one that any header gave
template <class Struct>
void write_struct(Struct* out, Struct filled, const char* name) {
  need(out, name);
  const std::size_t room = out->struct_size;
  read_config(out, Struct{}, name);  // for its check of struct_size
  filled.struct_size = room;
  std::memcpy(out, &filled, room);
}

}  // namespace breve::host
