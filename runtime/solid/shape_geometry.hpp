// What a shape is made of, behind shape.hpp: the original, the scale, and what follows from both.
#pragma once

#include <string>

#include "runtime/solid/pieces.hpp"
#include "runtime/solid/shape.hpp"
#include "runtime/solid/triangle_mesh.hpp"

namespace breve {

std::string show(const Vector3& v);  // "(x, y, z)", for errors

struct Shape::Geometry : InMemory {
  explicit Geometry(Memory memory) : original_vertices(memory), solid(memory) {}
  Geometry(const Geometry& other) = delete;
  Geometry(Geometry&&) = delete;
  Geometry& operator=(const Geometry&) = default;  // the arrays stay in the memory that they have
  Memory memory() const { return original_vertices.get_allocator().resource(); }

  ShapeKind kind{};
  double original_radius = 0;                           // Sphere
  Round original_round;                                 // Cylinder, Capsule
  std::pmr::vector<Vector3> original_vertices;          // Box, Convex; Mesh: of its hull
  std::shared_ptr<Surface> surface;                     // Mesh, HeightField; at the scale, and of this geometry alone
  std::shared_ptr<const ConvexPieces> original_pieces;  // Mesh that was split; of the original size
  Moments original{};                                   // at scale 1 and density 1; set_inertia changes `second`
  Vector3 scale = Vector3::Ones();
  Vector3 last_scale = Vector3::Ones();
  double density = 1;

  // What follows from the above.
  double radius = 0;
  Round round;
  Polyhedron solid;
  std::shared_ptr<const ConvexPieces> pieces;  // original_pieces at the scale
  double bounding_radius = 0;
  double volume = 0;
  Matrix3 inertia = Matrix3::Zero();

  Vector3 factors() const {
    if (kind != ShapeKind::Sphere && !original_round.is_round()) return scale;
    Vector3 factors = Vector3::Constant(scale.x());
    if (kind == ShapeKind::Cylinder) factors[original_round.axis] = scale[original_round.axis];
    return factors;
  }
  /// Radius, vertices and planes from the original and the scale.
  void derive_size();
  /// Volume and inertia. Error{Argument} if a mass or moment is too large or too small for a number.
  void derive_mass();
  /// The same for the surface; it is replaced, not changed.
  void scale_surface() {
    if (surface) surface = surface->scaled(scale);
  }
};

}  // namespace breve
