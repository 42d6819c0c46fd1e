// Calls of what reads back what was set.
#include "call_functions.hpp"

namespace breve::fuzz {

namespace call_settings {

/// A function that fills in a struct with struct_size about one object.
template <class Struct, auto kGet>
breve_status get_struct(Caller& c, breve_object object, const breve_world* world) {
  Out<Struct> result(c);
  result.set_size(c.struct_size(sizeof(Struct)));
  return result.after(kGet(world, object, result.to()));
}
template <class T, auto kGet>
breve_status get_frozen(Caller& c, breve_object object, const breve_world* world) {
  Out<T> result(c);
  return result.after(kGet(world, object, result.to()));
}

breve_status material(Caller& c) {
  const breve_world* world = c.world();
  return get_frozen<breve_material, breve_object_material>(c, c.object(world, "Real"), world);
}
breve_status force(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  Out<double[3]> newtons(c, true), about(c, true);
  const breve_status status =
      breve_object_force(world, object, newtons.to() ? *newtons.to() : nullptr, about.to() ? *about.to() : nullptr);
  newtons.after(status), about.after(status);
  return status;
}
breve_status sleeping(Caller& c) {
  const breve_world* world = c.world();
  require(world || !breve_world_sleeping(nullptr), "no world lets bodies sleep");
  (void)breve_world_sleeping(world);
  c.accept_null();
  return BREVE_OK;
}
breve_status workers(Caller& c) {
  const breve_world* world = c.world();
  require((breve_world_workers(world) != 0) == (world != nullptr), "a world has no workers");
  c.accept_null();
  return BREVE_OK;
}
breve_status accuracy(Caller& c) {
  const breve_world* world = c.world();
  return get_struct<breve_accuracy, breve_object_accuracy>(c, c.object(world, "Real"), world);
}
breve_status self_collisions(Caller& c) {
  const breve_world* world = c.world();
  return get_frozen<bool, breve_object_self_collisions>(c, c.object(world, "Real"), world);
}
breve_status spring(Caller& c) {
  const breve_world* world = c.world();
  return get_struct<breve_spring, breve_spring_description>(c, c.object(world, "Spring"), world);
}
breve_status click_ray(Caller& c) {
  breve_world* world = c.world();
  double start[3], way[3];
  const double *from = c.numbers(start), *along = c.numbers(way);
  return breve_world_queue_click_ray(world, from, along);
}

constexpr Function kFunctions[] = {
    {"breve_object_material", material, kBody},
    {"breve_object_force", force, kBody},
    {"breve_world_sleeping", sleeping, kPlain},
    {"breve_world_workers", workers, kPlain},
    {"breve_object_accuracy", accuracy, kBody},
    {"breve_object_self_collisions", self_collisions, kBody},
    {"breve_spring_description", spring, kStale | kType, 2},
    {"breve_world_queue_click_ray", click_ray},
};

}  // namespace call_settings

std::span<const Function> setting_functions() { return call_settings::kFunctions; }

}  // namespace breve::fuzz
