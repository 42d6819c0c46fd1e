// Calls of what says how a world is to be seen, and what was set.
#include <cmath>

#include "call_functions.hpp"

namespace breve::fuzz {

namespace call_views {

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

breve_status look(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  Out<breve_look> result(c);
  const std::size_t size = c.struct_size(sizeof(breve_look));
  result.set_size(size);
  const breve_status status = result.after(breve_object_look(world, object, result.to()));
  if (result && size == sizeof(breve_look)) read_text(result->label);
  return status;
}
breve_status camera(Caller& c) {
  const breve_world* world = c.world();
  return get_struct<breve_camera, breve_camera_state>(c, c.object_or_null(world, "Camera"), world);
}
breve_status view(Caller& c) {
  const breve_world* world = c.world();
  Out<breve_view> result(c);
  result.set_size(c.struct_size(sizeof(breve_view)));
  return result.after(breve_world_view(world, result.to()));
}
breve_status light(Caller& c) {
  const breve_world* world = c.world();
  Out<breve_light> result(c);
  return result.after(breve_world_light(world, c.word() % 10, result.to()));
}
breve_status text(Caller& c) {
  const breve_world* world = c.world();
  Out<breve_text> result(c);
  const breve_status status = result.after(breve_world_text(world, c.word() % 10, result.to()));
  if (result) read_text(result->text);
  return status;
}
breve_status drawing(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Drawing");
  Room<breve_draw> commands(c, c.capacity());
  Out<std::size_t> count(c);
  const breve_status status =
      count.after(breve_drawing_commands(world, object, commands.to(), commands.capacity(), count.to()));
  return commands.after(status, count ? *count : 0);
}
breve_status line(Caller& c) {
  const breve_world* world = c.world();
  return get_frozen<breve_line, breve_line_state>(c, c.object(world, "Line"), world);
}
breve_status pixels(Caller& c) {
  const breve_world* world = c.world();
  const breve_object image = c.object(world, "Image");
  Room<unsigned char> room(c, c.chance(50) ? c.capacity() : 4096);
  Out<std::uint32_t> width(c), height(c);
  const breve_status status = width.after(
      height.after(breve_image_pixels(world, image, room.to(), room.capacity(), width.to(), height.to())));
  const std::size_t size = width && height ? std::size_t{4} * *width * *height : 0;
  return room.after(status, size <= room.capacity() ? size : 0);
}

breve_status material(Caller& c) {
  const breve_world* world = c.world();
  return get_frozen<breve_material, breve_object_material>(c, c.object(world, "Real"), world);
}
breve_status force(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  Out<double[3]> newtons(c, true), about(c, true);
  const breve_status status = breve_object_force(world, object, newtons.to() ? *newtons.to() : nullptr,
                                                 about.to() ? *about.to() : nullptr);
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
    {"breve_object_look", look, kBody},
    {"breve_camera_state", camera, kStale | kType},
    {"breve_world_view", view},
    {"breve_world_light", light, kNotFound},
    {"breve_world_text", text, kNotFound},
    {"breve_drawing_commands", drawing, kStale | kType, 2},
    {"breve_line_state", line, kStale | kType, 2},
    {"breve_image_pixels", pixels, kStale | kType, 2},
    {"breve_object_material", material, kBody},
    {"breve_object_force", force, kBody},
    {"breve_world_sleeping", sleeping, kPlain},
    {"breve_world_workers", workers, kPlain},
    {"breve_object_accuracy", accuracy, kBody},
    {"breve_object_self_collisions", self_collisions, kBody},
    {"breve_spring_description", spring, kStale | kType, 2},
    {"breve_world_queue_click_ray", click_ray},
};

}  // namespace call_views

std::span<const Function> view_functions() { return call_views::kFunctions; }

}  // namespace breve::fuzz
