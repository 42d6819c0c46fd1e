// Bodies with physics from C: shapes, forces, surfaces, assemblies.
#include <fmt/format.h>

#include "physical.hpp"

#include <array>
#include <cmath>

#include "steve/library/resources.hpp"

namespace breve::host {

Quaternion rotation_of(const double* numbers, const char* what) {
  need_finite(numbers, 4, what);
  // Scaled by its largest part first, so that the length of no finite quaternion overflows or vanishes.
  Eigen::Vector4d q(numbers[1], numbers[2], numbers[3], numbers[0]);
  const double largest = q.cwiseAbs().maxCoeff();
  if (largest == 0) fail(BREVE_ERROR_ARGUMENT, std::string(what) + " has length 0: it is not a rotation");
  return Quaternion(Eigen::Vector4d((q / largest).normalized()));
}

steve::Instance& object_of_kind(const breve_world& world, breve_object object, std::string_view library_class) {
  steve::Instance& instance = live_instance(world, object);
  if (!steve::is_library_kind(instance, library_class))
    fail(BREVE_ERROR_TYPE, "the object is of class " + instance.cls->name + ", not a " + std::string(library_class));
  return instance;
}

steve::Instance& make_object(breve_world& world, const char* library_class) {
  const steve::ClassInfo* cls = world.program->find_class(library_class);
  if (!cls)
    fail(BREVE_ERROR_NOT_FOUND, "the program has no class '" + std::string(library_class) + "' (add `@use " +
                                    library_class + ".` to it, or use breve_program_create_library)");
  return *world.machine->create(*cls);
}

namespace {

std::vector<std::vector<Vector3>> faces_of(const breve_geometry& geometry) {
  if (geometry.vertex_count != 0) need(geometry.vertices, "breve_geometry.vertices");
  if (geometry.face_count != 0) need(geometry.face_sizes, "breve_geometry.face_sizes");
  if (geometry.index_count != 0) need(geometry.indices, "breve_geometry.indices");
  std::vector<std::vector<Vector3>> faces;
  std::size_t next = 0;
  for (std::size_t f = 0; f < geometry.face_count; ++f) {
    const std::size_t size = geometry.face_sizes[f];
    if (size < 3 || size > geometry.index_count - next)
      fail(BREVE_ERROR_ARGUMENT, "breve_geometry: face " + std::to_string(f) + " has " + std::to_string(size) +
                                     " corners (it must have 3 or more, and as many indices)");
    std::vector<Vector3> corners;
    for (std::size_t k = 0; k < size; ++k) {
      const std::uint32_t index = geometry.indices[next++];
      if (index >= geometry.vertex_count)
        fail(BREVE_ERROR_ARGUMENT, "breve_geometry: there is no vertex " + std::to_string(index));
      corners.push_back(vector_of(geometry.vertices + 3 * std::size_t{index}, "breve_geometry.vertices"));
    }
    faces.push_back(std::move(corners));
  }
  return faces;
}

/// Faces of more than three corners as fans.
std::shared_ptr<Shape> mesh_of(const breve_geometry& geometry, std::pmr::memory_resource* memory) {
  faces_of(geometry);  // for its checks
  std::vector<Vector3> corners;
  for (std::size_t i = 0; i < geometry.vertex_count; ++i)
    corners.push_back(vector_of(geometry.vertices + 3 * i, "breve_geometry.vertices"));
  std::vector<std::array<std::int32_t, 3>> triangles;
  const std::uint32_t* face = geometry.indices;
  const auto number = [](std::uint32_t index) { return static_cast<std::int32_t>(index); };
  for (std::size_t f = 0; f < geometry.face_count; face += geometry.face_sizes[f++])
    for (std::size_t k = 2; k < geometry.face_sizes[f]; ++k)
      triangles.push_back({number(face[0]), number(face[k - 1]), number(face[k])});
  return Shape::mesh(corners, triangles, memory);
}

std::shared_ptr<Shape> heights_of(const breve_geometry& geometry, std::pmr::memory_resource* memory) {
  need(geometry.heights, "breve_geometry.heights");
  constexpr std::uint32_t kMost = 4097;
  if (geometry.columns > kMost || geometry.rows > kMost)
    fail(BREVE_ERROR_ARGUMENT, "breve_geometry.columns and rows must be 2 to 4097");
  const std::span heights(geometry.heights, std::size_t{geometry.columns} * geometry.rows);
  return Shape::height_field(static_cast<int>(geometry.columns), static_cast<int>(geometry.rows), geometry.tile,
                             heights, memory);
}

double within(double value, double low, double high, const char* what) {
  if (value >= low && value <= high) return value;
  fail(BREVE_ERROR_ARGUMENT, std::string(what) + " is " + fmt::to_string(value) + ", not between " +
                                 fmt::to_string(low) + " and " + fmt::to_string(high));
}

}  // namespace

std::shared_ptr<Shape> geometry_shape(const breve_geometry& geometry, bool flat, std::pmr::memory_resource* memory) {
  if (!(std::isfinite(geometry.density) && geometry.density > 0))
    fail(BREVE_ERROR_ARGUMENT, "breve_geometry.density must be finite and > 0");
  if (geometry.reserved != 0) fail(BREVE_ERROR_ARGUMENT, "a reserved field is not 0");
  std::shared_ptr<Shape> shape;
  switch (geometry.kind) {
    case BREVE_SHAPE_SPHERE: shape = Shape::sphere(geometry.radius, memory); break;
    case BREVE_SHAPE_BOX: shape = Shape::box(vector_of(geometry.size, "breve_geometry.size"), memory); break;
    case BREVE_SHAPE_CYLINDER: shape = Shape::cylinder(geometry.height, geometry.radius, flat ? 2 : 1, memory); break;
    case BREVE_SHAPE_CAPSULE: shape = Shape::capsule(geometry.height, geometry.radius, 1, memory); break;
    case BREVE_SHAPE_MESH: shape = mesh_of(geometry, memory); break;
    case BREVE_SHAPE_HEIGHT_FIELD: shape = heights_of(geometry, memory); break;
    case BREVE_SHAPE_CONVEX: return Shape::convex(faces_of(geometry), geometry.density, memory);
    default: fail(BREVE_ERROR_ARGUMENT, "breve_geometry.kind is not a kind of shape that can be created");
  }
  shape->set_density(geometry.density);
  return shape;
}

}  // namespace breve::host

using namespace breve::host;
using breve::BodyIndex;

breve_status breve_shape_create(breve_world* world, const breve_geometry* geometry, breve_object* shape) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(geometry, "geometry");
    need(shape, "shape");
    const auto wanted = read_config(geometry, breve_geometry_default(), "breve_geometry");
    auto made = geometry_shape(wanted, world->world->dimension() == 2, &world->meter);
    *shape = make_with(*world, "Shape", [&](breve::steve::Instance& object) {
      auto& resource = breve::steve::resource_made<breve::steve::ShapeResource>(*world->machine, object);
      resource.shape = std::move(made);
      resource.density = wanted.density;
    });
  });
}

breve_status breve_object_set_shape(breve_world* world, breve_object object, breve_object shape) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    live_body(*world, object);
    auto& body = live_instance(*world, object);
    const auto argument = breve::steve::Value::of(breve::steve::Tag::Object, &live_instance(*world, shape));
    const ScriptScope script(*world);
    world->machine->call(body, "set-shape", std::span(&argument, 1));
  });
}

breve_status breve_object_physics(const breve_world* world, breve_object object, bool* enabled) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(enabled, "enabled");
    *enabled = world->world->bodies().physics(live_body(*world, object));
  });
}

breve_status breve_object_set_physics(breve_world* world, breve_object object, bool enabled) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] { world->world->bodies().set_physics(live_body(*world, object), enabled); });
}

breve_status breve_object_mass(const breve_world* world, breve_object object, double* mass) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(mass, "mass");
    *mass = world->world->bodies().mass(live_body(*world, object));
  });
}

breve_status breve_object_set_force(breve_world* world, breve_object object, const double force[3],
                                    const double torque[3]) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const BodyIndex body = live_body(*world, object);
    breve::Bodies& bodies = world->world->bodies();
    // All or nothing: both vectors are checked before either is written.
    const breve::Vector3 newtons = force ? bodies.allowed_force(vector_of(force, "force")) : bodies.force(body);
    const breve::Vector3 newton_metres =
        torque ? bodies.allowed_torque(vector_of(torque, "torque")) : bodies.torque(body);
    if (force) bodies.set_force(body, newtons);
    if (torque) bodies.set_torque(body, newton_metres);
  });
}

breve_status breve_object_set_material(breve_world* world, breve_object object, const breve_material* material) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(material, "material");
    const BodyIndex body = live_body(*world, object);
    constexpr double kMost = 1e6;
    const breve_material& m = *material;
    breve::Material set = std::as_const(*world->world).bodies().material(body);
    set.static_friction = within(m.static_friction, 0, kMost, "material.static_friction");
    set.dynamic_friction = within(m.dynamic_friction, 0, kMost, "material.dynamic_friction");
    set.normal_restitution = within(m.restitution, 0, 1, "material.restitution");
    set.tangential_restitution = within(m.tangential_restitution, -1, 1, "material.tangential_restitution");
    set.restitution_threshold = within(m.threshold, 0, kMost, "material.threshold");
    world->world->bodies().material(body) = set;
  });
}

breve_status breve_object_asleep(const breve_world* world, breve_object object, bool* asleep) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(asleep, "asleep");
    *asleep = std::as_const(*world->world).mechanics().asleep(live_body(*world, object));
  });
}

// --- assemblies -----------------------------------------------------------------------------------------------------

breve_status breve_object_links(const breve_world* world, breve_object object, breve_object* links, size_t capacity,
                                size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const BodyIndex body = live_body(*world, object);
    const auto all = std::as_const(*world->world).mechanics().links_of(body);
    copy_list(all, links, capacity, count, "links",
              [&](BodyIndex link) { return handle_of(*world, world->world->bodies().owner(link)); });
  });
}

breve_status breve_object_joints(const breve_world* world, breve_object object, breve_object* joints, size_t capacity,
                                 size_t* count) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const BodyIndex body = live_body(*world, object);
    const breve::Mechanics& dynamics = std::as_const(*world->world).mechanics();
    copy_list(dynamics.joints_of(body), joints, capacity, count, "joints",
              [&](breve::JointIndex joint) { return handle_of(*world, dynamics.joint_owner(joint)); });
  });
}

breve_status breve_object_set_assembly_pose(breve_world* world, breve_object object, const breve_pose* pose) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(pose, "pose");
    const BodyIndex body = live_body(*world, object);
    const auto location = vector_of(pose->location, "pose.location");
    const auto rotation = rotation_of(pose->rotation, "pose.rotation");
    world->machine->refuse_in_stage("move a body");
    world->world->mechanics().move_assembly(body, location, rotation);  // which may refuse, and then changes nothing
    for (const BodyIndex link : world->world->mechanics().links_of(body)) world->previous.forget(link);
  });
}

breve_status breve_object_set_self_collisions(breve_world* world, breve_object object, bool on) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] { world->world->mechanics().set_self_collisions(live_body(*world, object), on); });
}

// --- what was set ---------------------------------------------------------------------------------------------------

breve_status breve_object_material(const breve_world* world, breve_object object, breve_material* material) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(material, "material");
    const breve::Material& m = std::as_const(*world->world).bodies().material(live_body(*world, object));
    *material = {m.static_friction, m.dynamic_friction, m.normal_restitution, m.tangential_restitution,
                 m.restitution_threshold};
  });
}

breve_status breve_object_force(const breve_world* world, breve_object object, double force[3], double torque[3]) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    const BodyIndex body = live_body(*world, object);
    const breve::Bodies& bodies = std::as_const(*world->world).bodies();
    if (force) copy_to(force, bodies.force(body));
    if (torque) copy_to(torque, bodies.torque(body));
  });
}

breve_status breve_object_self_collisions(const breve_world* world, breve_object object, bool* on) {
  if (!world) return BREVE_ERROR_ARGUMENT;
  return guard(world->error, [&] {
    need(on, "on");
    *on = std::as_const(*world->world).mechanics().self_collisions(live_body(*world, object));
  });
}

bool breve_world_sleeping(const breve_world* world) {
  return world && std::as_const(*world->world).mechanics().sleeping();
}
