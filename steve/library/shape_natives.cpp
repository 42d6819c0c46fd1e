// Natives of Shape and its solids.
#include <algorithm>

#include "runtime/solid/pieces.hpp"
#include "steve/library/resources.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

ShapeResource& resource(Machine& machine, Instance& self) { return resource_made<ShapeResource>(machine, self); }

/// The geometry of a shape that must have some.
Shape& built(Machine& machine, Instance& self, std::string_view selector) {
  const ShapeResource& own = resource(machine, self);
  if (!own.shape) Machine::fail(RunErrorKind::NullObject, std::string(selector) + ": this shape has no geometry");
  return *own.shape;
}

/// Give the object new geometry with the density it has.
Instance* build(Machine& machine, Instance& self, std::shared_ptr<Shape> shape) {
  ShapeResource& own = resource(machine, self);
  shape->set_density(own.density);
  own.shape = std::move(shape);
  return &self;
}

void shape_init(Machine& machine, Instance& self) { resource(machine, self); }

// --- mass ------------------------------------------------------------------------------------------------------------

double shape_get_mass(Machine& machine, Instance& self) {
  const ShapeResource& own = resource(machine, self);
  return own.shape ? own.shape->mass() : 0;
}

void shape_set_mass(Machine& machine, Instance& self, double mass) {
  Shape& shape = built(machine, self, "set-mass");
  shape.set_mass(mass);
  resource(machine, self).density = shape.density();
}

double shape_get_density(Machine& machine, Instance& self) {
  const ShapeResource& own = resource(machine, self);
  return own.shape ? own.shape->density() : own.density;
}

void shape_set_density(Machine& machine, Instance& self, double density) {
  ShapeResource& own = resource(machine, self);
  if (!(density > 0)) throw Error(ErrorCode::Argument, "a shape's density must be more than 0");
  finite(density, "a shape's density");
  if (own.shape) own.shape->set_density(density);
  own.density = density;
}

void shape_set_inertia_matrix(Machine& machine, Instance& self, Matrix3 inertia) {
  built(machine, self, "set-inertia-matrix").set_inertia(inertia);
}

// --- size ------------------------------------------------------------------------------------------------------------

void shape_set_scale(Machine& machine, Instance& self, Vector3 factors) {
  Shape& shape = built(machine, self, "set-scale");
  // Its corners move, and questions about space look at all bodies anew.
  constexpr std::uint64_t kObjectsPerIteration = 4;
  machine.charge(3 * shape.polyhedron().vertices.size() + machine.world().object_count() / kObjectsPerIteration);
  shape.set_scale(factors);
}

Vector3 shape_get_scale(Machine& machine, Instance& self) {
  const ShapeResource& own = resource(machine, self);
  return own.shape ? own.shape->scale() : Vector3(1, 1, 1);
}

Vector3 shape_get_last_scale(Machine& machine, Instance& self) {
  const ShapeResource& own = resource(machine, self);
  return own.shape ? own.shape->last_scale() : Vector3(1, 1, 1);
}

// --- builders --------------------------------------------------------------------------------------------------------

constexpr std::uint64_t kOfSolid = 12;  // iterations: to make any shape, and to free the one before

Instance* build_sphere(Machine& machine, Instance& self, double radius) {
  machine.charge(kOfSolid);
  return build(machine, self, Shape::sphere(radius, machine.heap().memory()));
}

Instance* build_cube(Machine& machine, Instance& self, Vector3 size) {
  machine.charge(kOfSolid);
  return build(machine, self, Shape::box(size, machine.heap().memory()));
}

/// In a flat world a disk lies in the plane: rotated so that its axis is z.
std::shared_ptr<Shape> lying(const Shape& prism, std::pmr::memory_resource* memory) {
  std::vector<std::vector<Vector3>> faces;
  for (const auto& face : prism.faces()) {
    std::vector<Vector3>& corners = faces.emplace_back();
    for (const int corner : face) {
      const Vector3& v = prism.vertices()[static_cast<std::size_t>(corner)];
      corners.emplace_back(v.x(), -v.z(), v.y());
    }
  }
  return Shape::convex(faces, 1, memory);
}

constexpr std::int32_t kRoundSides = 64;  // as many as a round shape is worth

void charge_for_sides(Machine& machine, std::int32_t sides) {
  constexpr std::uint64_t kOfSide = 64;                                      // iterations
  machine.charge(kOfSide * static_cast<std::uint64_t>(std::max(sides, 1)));  // also for a shape that is refused
}

Instance* build_disk(Machine& machine, Instance& self, std::int32_t sides, double height, double radius) {
  charge_for_sides(machine, sides);
  std::shared_ptr<Shape> prism = Shape::prism(sides, height, radius, machine.heap().memory());
  if (machine.world().dimension() == 2) prism = lying(*prism, machine.heap().memory());
  return build(machine, self, prism);
}

Instance* build_cone(Machine& machine, Instance& self, std::int32_t sides, double height, double radius) {
  charge_for_sides(machine, sides);
  return build(machine, self, Shape::cone(sides, height, radius, machine.heap().memory()));
}

Instance* build_cylinder(Machine& machine, Instance& self, double height, double radius) {
  charge_for_sides(machine, kRoundSides);
  // As a disk: in a flat world its axis is z.
  const int axis = machine.world().dimension() == 2 ? 2 : 1;
  return build(machine, self, Shape::cylinder(height, radius, axis, machine.heap().memory()));
}

Instance* build_capsule(Machine& machine, Instance& self, double length, double radius) {
  charge_for_sides(machine, kRoundSides);
  return build(machine, self, Shape::capsule(length, radius, 1, machine.heap().memory()));
}

/// The builders of Shape itself leave the shape without geometry where those of its subclasses fail.
template <Instance* (*Build)(Machine&, Instance&, std::int32_t, double, double)>
Instance* build_or_leave(Machine& machine, Instance& self, std::int32_t sides, double height, double radius) {
  try {
    return Build(machine, self, sides, height, radius);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Argument) throw;
    resource(machine, self).shape.reset();
    machine.warn(std::string(error.what()) + "; the shape has no geometry");
    return &self;
  }
}

// --- CustomShape -----------------------------------------------------------------------------------------------------

std::vector<Vector3> corners_of(Machine& machine, const Value& face) {
  constexpr std::uint32_t kFewest = 3;
  constexpr std::uint64_t kOfCorner = 160;
  const ListCell* list = face.tag == Tag::List ? face.list() : nullptr;
  if (!list || list->size < kFewest)
    Machine::fail(RunErrorKind::Type, "add-face: a face is a list of three or more vectors");
  machine.charge_for(kOfCorner * list->size);
  std::vector<Vector3> corners;
  for (const Value& corner : *list) {
    if (corner.tag != Tag::Vector)
      Machine::fail(RunErrorKind::Type, "add-face: every corner of a face must be a vector");
    corners.push_back(finite(corner.vector(), "add-face: a corner"));
  }
  return corners;
}

void custom_shape_check_face(Machine& machine, Instance&, ListCell* vertices) {
  corners_of(machine, Value::of(Tag::List, vertices));
}

Instance* custom_shape_build(Machine& machine, Instance& self, ListCell* faces, double density) {
  std::vector<std::vector<Vector3>> solid;
  machine.charge(2 * kOfSolid);
  if (faces)
    for (const Value& face : *faces) solid.push_back(corners_of(machine, face));
  resource(machine, self).shape = Shape::convex(solid, density, machine.heap().memory());
  resource(machine, self).density = density;
  return &self;
}

// --- geometry --------------------------------------------------------------------------------------------------------

Vector3 shape_get_point(Machine& machine, Instance& self, Vector3 direction) {
  finite(direction, "get-point-on-shape: the vector");
  const ShapeResource& own = resource(machine, self);
  if (!own.shape) return {0, 0, 0};
  if (own.shape->kind() == ShapeKind::Sphere) return direction * own.shape->radius();
  return own.shape->point_on(direction);
}

std::int32_t shape_split(Machine& machine, Instance& self, std::int32_t most, double excess) {
  Shape& shape = built(machine, self, "split-into-pieces");
  shape.split({most, excess}, [&](std::uint64_t units) { machine.charge(units); });
  return static_cast<std::int32_t>(shape.pieces()->all().size());
}

std::int32_t shape_get_piece_count(Machine& machine, Instance& self) {
  const ShapeResource& own = resource(machine, self);
  return own.shape && own.shape->pieces() ? static_cast<std::int32_t>(own.shape->pieces()->all().size()) : 0;
}

double shape_get_piece_excess(Machine& machine, Instance& self) {
  const ShapeResource& own = resource(machine, self);
  return own.shape && own.shape->pieces() ? own.shape->pieces()->excess() : 0;
}

constexpr Native kShapeNatives[] = {
    native<shape_init>("shape.init"),
    native<shape_get_mass>("shape.get-mass"),
    native<shape_set_mass>("shape.set-mass"),
    native<shape_get_density>("shape.get-density"),
    native<shape_set_density>("shape.set-density"),
    native<shape_set_inertia_matrix>("shape.set-inertia-matrix"),
    native<shape_set_scale>("shape.set-scale"),
    native<shape_get_scale>("shape.get-scale"),
    native<shape_get_last_scale>("shape.get-last-scale"),
    native<build_sphere>("shape.init-with-sphere"),
    native<build_cube>("shape.init-with-cube"),
    native<build_or_leave<build_disk>>("shape.init-with-polygon-disk"),
    native<build_or_leave<build_cone>>("shape.init-with-polygon-cone"),
    native<shape_get_point>("shape.get-point-on-shape"),
    native<shape_split>("shape.split-into-pieces"),
    native<shape_get_piece_count>("shape.get-piece-count"),
    native<shape_get_piece_excess>("shape.get-piece-excess"),
    native<build_sphere>("sphere.init-with"),
    native<build_cube>("cube.init-with"),
    native<build_disk>("polygon-disk.init-with"),
    native<build_cone>("polygon-cone.init-with"),
    native<build_cylinder>("cylinder.init-with"),
    native<build_capsule>("capsule.init-with"),
    native<custom_shape_check_face>("custom-shape.check-face"),
    native<custom_shape_build>("custom-shape.build"),
};

}  // namespace

std::span<const Native> shape_natives() { return kShapeNatives; }

}  // namespace breve::steve
