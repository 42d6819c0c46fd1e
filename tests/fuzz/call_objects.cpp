// Calls of objects, their places, and how they look.
#include "call_functions.hpp"

namespace breve::fuzz {

namespace call_objects {

breve_status world_controller(Caller& c) {
  const breve_world* world = c.world();
  const breve_object controller = breve_world_controller(world);
  if (!world) require(controller.index == 0 && controller.generation == 0, "a controller of no world");
  return BREVE_OK;
}
breve_status world_objects(Caller& c) {
  const breve_world* world = c.world();
  const char* name = c.chance(40) ? nullptr : c.class_name();
  Room<breve_object> found(c, c.capacity());
  Out<std::size_t> count(c);
  const breve_status status = count.after(breve_world_objects(world, name, found.to(), found.capacity(), count.to()));
  found.after(status, count ? *count : 0);
  for (const breve_object object : found.written()) {
    require(breve_object_alive(world, object), "an object of a world is not alive");
    c.keep(object);
  }
  return status;
}
breve_status object_alive(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.any_object(world);
  const bool alive = breve_object_alive(world, object);
  require(!alive || (world && object.generation != 0), "the null object is alive");
  return BREVE_OK;
}
breve_status object_class(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.any_object(world);
  const char* name = breve_object_class(world, object);
  require((name != nullptr) == breve_object_alive(world, object), "objects have a class as long as they live");
  if (name) read_text(name);
  return BREVE_OK;
}
breve_status object_is_a(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world);
  const char* name = c.class_name();
  if (!name) c.expect_refusal();
  Out<bool> result(c);
  return result.after(breve_object_is_a(world, object, name, result.to()));
}

/// Worlds stay small: what is more than a dozen bodies takes time and shows nothing new.
breve_status object_create(Caller& c) {
  breve_world* world = c.world();
  std::size_t count = 0;
  breve_world_objects(world, "Real", nullptr, 0, &count);
  const char* name = count > 12 ? "Object" : c.class_name();
  if (!name) c.expect_refusal();
  Out<breve_object> made(c);
  const breve_status status = made.after(breve_object_create(world, name, made.to()));
  if (made) c.keep(*made);
  return status;
}
breve_status object_free(Caller& c) {
  breve_world* world = c.world();
  return breve_object_free(world, c.object(world));
}

// --- places ----------------------------------------------------------------------------------------------------------

breve_status object_pose(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world);
  Out<breve_pose> pose(c);
  return pose.after(breve_object_pose(world, object, pose.to()));
}

/// A function that puts an object at a pose: one that cannot be is refused.
template <auto kSet>
breve_status set_pose(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  const breve_pose pose = c.pose();
  const bool null = c.chance(3);
  double length = 0;
  for (const double x : pose.rotation) length += std::abs(x);
  for (const double x : pose.location) length += 0 * x;  // not a number if it is not finite
  if (null || !(length > 0) || length * 0 != 0) c.expect_refusal();
  return kSet(world, object, null ? nullptr : &pose);
}

/// A function that gives N numbers of an object.
template <auto kGet, std::size_t N>
breve_status get_numbers(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  Room<double> numbers(c, N);
  return numbers.after(kGet(world, object, numbers.to()), N);
}
template <auto kSet, std::size_t N>
breve_status set_numbers(Caller& c) {
  breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  double numbers[N];
  const double* given = c.numbers(numbers);
  for (const double x : numbers)
    if (x * 0 != 0) c.expect_refusal();
  return kSet(world, object, given);
}

// --- looks -----------------------------------------------------------------------------------------------------------

breve_status object_shape(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  Out<breve_shape> shape(c);
  return shape.after(breve_object_shape(world, object, shape.to()));
}
/// The sizes of an object's shape; all 0 if it has none.
breve_shape shape_of(const breve_world* world, breve_object object) {
  breve_shape shape{};
  breve_object_shape(world, object, &shape);
  return shape;
}
breve_status object_shape_vertices(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  Room<double> vertices(c, c.capacity(), 3);
  const std::size_t count = shape_of(world, object).vertex_count;
  return vertices.after(breve_object_shape_vertices(world, object, vertices.to(), vertices.capacity()), 3 * count);
}
breve_status object_shape_faces(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  Room<std::uint32_t> sizes(c, c.capacity());
  Room<std::uint32_t> indices(c, c.capacity());
  const breve_shape shape = shape_of(world, object);
  const breve_status status =
      breve_object_shape_faces(world, object, sizes.to(), sizes.capacity(), indices.to(), indices.capacity());
  sizes.after(status, shape.face_count);
  return indices.after(status, shape.index_count);
}

breve_status object_target(Caller& c) {
  const breve_world* world = c.world();
  const breve_object object = c.object(world, "Real");
  Out<bool> moves(c);
  Out<breve_pose> pose(c, true);
  const breve_status status = moves.after(breve_object_target(world, object, moves.to(), pose.to()));
  pose.after(moves && *moves ? status : BREVE_ERROR_ARGUMENT);
  return status;
}

constexpr Function kFunctions[] = {
    {"breve_world_controller", world_controller, kPlain},
    {"breve_world_objects", world_objects, kNotFound},
    {"breve_object_alive", object_alive, kPlain},
    {"breve_object_class", object_class, kPlain},
    {"breve_object_is_a", object_is_a, kNotFound | kStale},
    {"breve_object_create", object_create, kScript | kNotFound, 4},
    {"breve_object_free", object_free, kScript | kStale, 2},
    {"breve_object_pose", object_pose, kBody},
    {"breve_object_set_pose", set_pose<breve_object_set_pose>, kBody | kScriptError, 2},
    {"breve_object_set_target", set_pose<breve_object_set_target>, kBody},
    {"breve_object_target", object_target, kBody},
    {"breve_object_set_assembly_pose", set_pose<breve_object_set_assembly_pose>, kBody | kScriptError},
    {"breve_object_velocity", get_numbers<breve_object_velocity, 3>, kBody},
    {"breve_object_set_velocity", set_numbers<breve_object_set_velocity, 3>, kBody},
    {"breve_object_rotational_velocity", get_numbers<breve_object_rotational_velocity, 3>, kBody},
    {"breve_object_set_rotational_velocity", set_numbers<breve_object_set_rotational_velocity, 3>, kBody},
    {"breve_object_color", get_numbers<breve_object_color, 4>, kBody},
    {"breve_object_set_color", set_numbers<breve_object_set_color, 4>, kBody},
    {"breve_object_shape", object_shape, kBody},
    {"breve_object_shape_vertices", object_shape_vertices, kBody},
    {"breve_object_shape_faces", object_shape_faces, kBody},
};

}  // namespace call_objects

std::span<const Function> object_functions() { return call_objects::kFunctions; }

}  // namespace breve::fuzz
