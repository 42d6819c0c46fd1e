// Objects: which there are, where they are, what they look like.
#include <algorithm>

#include "internal.hpp"
#include "runtime/solid/polygons.hpp"

namespace breve::host {

breve_object handle_of(const breve_world& world, ObjectId id) {
  if (!id) return {};
  const std::uint64_t ordinal = std::uint64_t{world.first_generation} + world.world->ticket(id) - 1;
  return {id.index, static_cast<std::uint32_t>(ordinal % kGenerations + 1)};
}

ObjectId id_of(const breve_world& world, breve_object object) {
  if (is_null(object)) return {};
  return world.world->holder(object.index, ticket_of(world, object));
}

ObjectId live_id(const breve_world& world, breve_object object) {
  if (is_null(object)) fail(BREVE_ERROR_ARGUMENT, "the null object was given where a live one is needed");
  const ObjectId id = id_of(world, object);
  if (!id) fail(BREVE_ERROR_STALE, "the object no longer exists: it was freed, or it belongs to another world");
  return id;
}

steve::Instance& live_instance(const breve_world& world, breve_object object) {
  steve::Instance* instance = world.machine->instance(live_id(world, object));
  if (!instance) fail(BREVE_ERROR_STALE, "the object no longer exists: it was freed");
  return *instance;
}

BodyIndex live_body(const breve_world& world, breve_object object) {
  const ObjectId id = live_id(world, object);
  if (!world.world->has_body(id))
    fail(BREVE_ERROR_NO_BODY,
         "the object has no position in space: class " + world.program->cls(world.world->class_of(id)).name);
  return world.world->body(id);
}

const steve::ClassInfo& class_named(const breve_world& world, const char* name) {
  need(name, "class_name");
  const steve::ClassInfo* cls = world.program->find_class(name);
  if (!cls) fail(BREVE_ERROR_NOT_FOUND, "the program has no class '" + std::string(name) + "'");
  return *cls;
}

breve::Quaternion unit_quaternion(const double numbers[4], const char* what) {
  const Eigen::Vector4d q(numbers[1], numbers[2], numbers[3], numbers[0]);
  const double largest = q.cwiseAbs().maxCoeff();
  if (largest == 0) fail(BREVE_ERROR_ARGUMENT, std::string(what) + " has length 0: it is not a rotation");
  // Scaled by its largest part first where squares would overflow or vanish.
  constexpr double kLow = 1e-100, kHigh = 1e100;
  if (largest < kLow || largest > kHigh) return breve::Quaternion(Eigen::Vector4d((q / largest).normalized()));
  return breve::Quaternion(Eigen::Vector4d(q.normalized()));
}

namespace {

using Getter = const Vector3& (Bodies::*)(BodyIndex) const;
using Setter = void (Bodies::*)(BodyIndex, const Vector3&);

breve_status get_vector(const breve_world* world, breve_object object, double* out, const char* what, Getter getter) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(out, what);
    const BodyIndex body = live_body(*world, object);
    const Vector3 v = (std::as_const(*world->world).bodies().*getter)(body);
    std::copy_n(v.data(), 3, out);
  });
}

breve_status set_vector(breve_world* world, breve_object object, const double* in, const char* what, Setter setter) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const BodyIndex body = live_body(*world, object);
    need_finite(in, 3, what);
    (world->world->bodies().*setter)(body, Vector3(in[0], in[1], in[2]));
  });
}

/// The rotation of a pose, whose numbers are checked here.
breve::Quaternion rotation_of(const breve_pose& pose) {
  need_finite(pose.location, 3, "pose.location");
  need_finite(pose.rotation, 4, "pose.rotation");
  return unit_quaternion(pose.rotation, "pose.rotation");
}

const Shape& display_shape(const breve_world& world, breve_object object) {
  const BodyIndex body = live_body(world, object);
  return *std::as_const(*world.world).bodies().display_shape(body);
}

breve_shape describe(const Shape& shape) {
  breve_shape out{};
  switch (shape.kind()) {
    case ShapeKind::Sphere: out.kind = BREVE_SHAPE_SPHERE; break;
    case ShapeKind::Box: out.kind = BREVE_SHAPE_BOX; break;
    case ShapeKind::Convex: out.kind = BREVE_SHAPE_CONVEX; break;
    case ShapeKind::Mesh: out.kind = BREVE_SHAPE_MESH; break;
    case ShapeKind::HeightField: out.kind = BREVE_SHAPE_HEIGHT_FIELD; break;
    case ShapeKind::Cylinder: out.kind = BREVE_SHAPE_CYLINDER; break;
    case ShapeKind::Capsule: out.kind = BREVE_SHAPE_CAPSULE; break;
  }
  out.radius = shape.bounding_radius();
  if (shape.kind() == ShapeKind::Sphere) {
    std::fill_n(out.size, 3, 2 * shape.radius());
    return out;
  }
  const Eigen::AlignedBox3d box = shape.bounds(Matrix3::Identity());
  for (int i = 0; i < 3; ++i) out.size[i] = 2 * std::max(box.max()[i], -box.min()[i]);
  const breve::PolygonCounts counts = breve::count_polygons(shape);
  out.vertex_count = counts.vertices;
  out.face_count = counts.faces;
  out.index_count = counts.indices;
  return out;
}

}  // namespace
}  // namespace breve::host

using namespace breve::host;
using breve::Bodies;
using breve::BodyIndex;
using breve::ObjectId;
using breve::Vector3;

breve_object breve_world_controller(const breve_world* world) {
  if (!world) return {};
  const breve::steve::Instance* controller = world->machine->controller();
  return controller ? handle_of(*world, world->machine->id_of(controller)) : breve_object{};
}

breve_status breve_world_objects(const breve_world* world, const char* class_name, breve_object* objects,
                                 size_t capacity, size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (capacity != 0) need(objects, "objects");
    need(count, "count");
    const breve::steve::ClassInfo* filter = class_name ? &class_named(*world, class_name) : nullptr;
    std::size_t found = 0;
    for (const ObjectId id : world->world->objects()) {
      if (filter && !world->program->cls(world->world->class_of(id)).derives_from(*filter)) continue;
      if (found < capacity) objects[found] = handle_of(*world, id);
      ++found;
    }
    *count = found;
  });
}

bool breve_object_alive(const breve_world* world, breve_object object) { return world && id_of(*world, object); }

const char* breve_object_class(const breve_world* world, breve_object object) {
  const ObjectId id = world ? id_of(*world, object) : ObjectId{};
  return id ? world->program->cls(world->world->class_of(id)).name.c_str() : nullptr;
}

breve_status breve_object_is_a(const breve_world* world, breve_object object, const char* class_name, bool* result) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(result, "result");
    const ObjectId id = live_id(*world, object);
    const auto& cls = class_named(*world, class_name);
    *result = world->program->cls(world->world->class_of(id)).derives_from(cls);
  });
}

breve_status breve_object_create(breve_world* world, const char* class_name, breve_object* object) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(object, "object");
    const auto& cls = class_named(*world, class_name);
    const ScriptScope script(*world);
    *object = handle_of(*world, world->machine->id_of(world->machine->create(cls)));
  });
}

breve_status breve_object_free(breve_world* world, breve_object object) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    auto& instance = live_instance(*world, object);
    const ScriptScope script(*world);
    world->machine->free_instance(instance);
  });
}

breve_status breve_object_pose(const breve_world* world, breve_object object, breve_pose* pose) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(pose, "pose");
    const BodyIndex body = live_body(*world, object);
    const Bodies& bodies = std::as_const(*world->world).bodies();
    const Vector3 p = bodies.location(body);
    const breve::Quaternion q = bodies.orientation(body);
    *pose = {{p[0], p[1], p[2]}, {q.w(), q.x(), q.y(), q.z()}};
  });
}

breve_status breve_object_set_pose(breve_world* world, breve_object object, const breve_pose* pose) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(pose, "pose");
    const BodyIndex body = live_body(*world, object);
    const breve::Quaternion rotation = rotation_of(*pose);
    Bodies& bodies = world->world->bodies();
    const Vector3 given(pose->location[0], pose->location[1], pose->location[2]);
    // All or nothing: both halves are checked before anything is written.
    const Vector3 location = bodies.allowed_location(world->world->space().inside(given));
    bodies.allowed_orientation(rotation);
    world->world->leave(body);
    bodies.set_location(body, location);
    bodies.set_orientation(body, rotation);
    world->world->mechanics().moved(body);
    world->previous.forget(body);
  });
}

breve_status breve_object_set_target(breve_world* world, breve_object object, const breve_pose* pose) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(pose, "pose");
    const BodyIndex body = live_body(*world, object);
    const breve::Quaternion rotation = rotation_of(*pose);
    const Vector3 location(pose->location[0], pose->location[1], pose->location[2]);
    world->world->set_target(body, &location, &rotation);
  });
}

breve_status breve_object_target(const breve_world* world, breve_object object, bool* moves, breve_pose* pose) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(moves, "moves");
    const auto target = std::as_const(*world->world).target(live_body(*world, object));
    *moves = target.has_value();
    if (!target || !pose) return;
    const breve::Quaternion& q = target->orientation;
    *pose = {{target->location.x(), target->location.y(), target->location.z()}, {q.w(), q.x(), q.y(), q.z()}};
  });
}

breve_status breve_object_velocity(const breve_world* world, breve_object object, double velocity[3]) {
  return get_vector(world, object, velocity, "velocity", &Bodies::velocity);
}

breve_status breve_object_set_velocity(breve_world* world, breve_object object, const double velocity[3]) {
  return set_vector(world, object, velocity, "velocity", &Bodies::set_velocity);
}

breve_status breve_object_rotational_velocity(const breve_world* world, breve_object object, double velocity[3]) {
  return get_vector(world, object, velocity, "velocity", &Bodies::rotational_velocity);
}

breve_status breve_object_set_rotational_velocity(breve_world* world, breve_object object, const double velocity[3]) {
  return set_vector(world, object, velocity, "velocity", &Bodies::set_rotational_velocity);
}

breve_status breve_object_color(const breve_world* world, breve_object object, double rgba[4]) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(rgba, "rgba");
    const auto& appearance = std::as_const(*world->world).bodies().appearance(live_body(*world, object));
    std::copy_n(appearance.color.data(), 3, rgba);
    rgba[3] = appearance.alpha;
  });
}

breve_status breve_object_set_color(breve_world* world, breve_object object, const double rgba[4]) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const BodyIndex body = live_body(*world, object);
    need_finite(rgba, 4, "rgba");
    auto& appearance = world->world->bodies().appearance(body);
    appearance.color = Vector3(rgba[0], rgba[1], rgba[2]);
    appearance.alpha = rgba[3];
  });
}

breve_status breve_object_shape(const breve_world* world, breve_object object, breve_shape* shape) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(shape, "shape");
    *shape = describe(display_shape(*world, object));
  });
}

breve_status breve_object_shape_vertices(const breve_world* world, breve_object object, double* vertices,
                                         size_t capacity) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (capacity != 0) need(vertices, "vertices");
    const auto& shape = display_shape(*world, object);
    std::size_t written = 0;
    breve::for_each_vertex(shape, [&](const Vector3& vertex) {
      if (written < capacity) std::copy_n(vertex.data(), 3, vertices + 3 * written++);
    });
  });
}

breve_status breve_object_shape_faces(const breve_world* world, breve_object object, uint32_t* sizes,
                                      size_t face_capacity, uint32_t* indices, size_t index_capacity) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    if (face_capacity != 0) need(sizes, "sizes");
    if (index_capacity != 0) need(indices, "indices");
    const auto& shape = display_shape(*world, object);
    std::size_t written_faces = 0, written = 0;
    breve::for_each_face(shape, [&](const int* face, std::size_t size) {
      if (written_faces < face_capacity) sizes[written_faces++] = static_cast<std::uint32_t>(size);
      for (std::size_t i = 0; i < size && written < index_capacity; ++i)
        indices[written++] = static_cast<std::uint32_t>(face[i]);
    });
  });
}
