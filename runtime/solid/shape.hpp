// A solid or surface with mass properties, shared between bodies. The origin is its centre.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/math.hpp"
#include "runtime/base/memory.hpp"
#include "runtime/base/poll.hpp"
#include "runtime/solid/polyhedron.hpp"
#include "runtime/solid/round.hpp"

namespace breve {

class Surface;
class TriangleMesh;
class HeightGrid;
class ConvexPieces;
struct PieceSettings;

enum class ShapeKind : std::uint8_t { Sphere, Box, Convex, Mesh, HeightField, Cylinder, Capsule };

class Shape : public InMemory {
 public:
  // Builders, density 1; what is built stands in `memory`. Error{Argument} names what is wrong: a size or density that
  // is not finite and > 0, or so large or small that mass or inertia overflow; fewer than 3 sides (or more than 1000);
  // faces that enclose no convex solid.
  using Memory = std::pmr::memory_resource*;
  static std::shared_ptr<Shape> sphere(double radius, Memory memory = std::pmr::get_default_resource());
  /// Full edge lengths.
  static std::shared_ptr<Shape> box(const Vector3& size, Memory memory = std::pmr::get_default_resource());
  /// PolygonDisk.
  static std::shared_ptr<Shape> prism(int sides, double height, double radius,
                                      Memory memory = std::pmr::get_default_resource());
  /// PolygonCone, apex at +height/2.
  static std::shared_ptr<Shape> cone(int sides, double height, double radius,
                                     Memory memory = std::pmr::get_default_resource());
  /// Exact, about `axis`: 1 (y) or 2 (z, for flat worlds). Polygons only show it.
  static std::shared_ptr<Shape> cylinder(double height, double radius, int axis = 1,
                                         Memory memory = std::pmr::get_default_resource());
  /// All points within `radius` of a piece of the axis that is `length` long.
  static std::shared_ptr<Shape> capsule(double length, double radius, int axis = 1,
                                        Memory memory = std::pmr::get_default_resource());
  /// CustomShape.
  static std::shared_ptr<Shape> convex(const std::vector<std::vector<Vector3>>& faces, double density,
                                       Memory memory = std::pmr::get_default_resource());

  /// The convex hull of a cloud of points; a Convex shape like any other. The points keep their places: see make_hull.
  static std::shared_ptr<Shape> hull(std::span<const Vector3> points, double density,
                                     Memory memory = std::pmr::get_default_resource());
  /// Triangles, counter-clockwise seen from outside. If they close a solid, that is the shape and gives the mass; else
  /// they are a surface of two sides with the mass of its hull (a flat one: a thousandth of its extent thick).
  /// Error{Argument}: see TriangleMesh and make_hull.
  static std::shared_ptr<Shape> mesh(std::span<const Vector3> corners,
                                     std::span<const std::array<std::int32_t, 3>> triangles,
                                     Memory memory = std::pmr::get_default_resource());
  /// Heights over a grid in x and z, see HeightGrid. Ground: what is below is inside. Its mass, which nothing should
  /// need, is that of its bounds, at least a tile thick, when it was built.
  static std::shared_ptr<Shape> height_field(int columns, int rows, double tile, std::span<const double> heights,
                                             Memory memory = std::pmr::get_default_resource(), const Poll& poll = {});

  ~Shape();
  ShapeKind kind() const;
  double radius() const;                              // Sphere, Cylinder, Capsule
  const Round& round() const;                         // Cylinder, Capsule; after scaling
  Vector3 size() const;                               // Box: full edge lengths after scaling
  const std::pmr::vector<Vector3>& vertices() const;  // Box, Convex: after scaling, own frame; Mesh: of its hull;
                                                      // Cylinder, Capsule: of the polygons that show it
  /// Indices into vertices, counter-clockwise from outside.
  const std::pmr::vector<std::pmr::vector<int>>& faces() const;
  const Polyhedron& polyhedron() const;   // the same with planes and edges; empty for Sphere, HeightField
  const Surface* surface() const;         // Mesh, HeightField: its triangles after scaling; null for others
  const TriangleMesh* triangles() const;  // Mesh
  const HeightGrid* heights() const;      // HeightField
  /// Splits a closed mesh into convex pieces, which stand for it where it meets other meshes and height fields. In
  /// contact with anything else its triangles count, and mass and rays are those of the triangles. Error{Argument} for
  /// other shapes, or as split_into_convex. `charge` counts the work and may throw, which leaves the shape as it was.
  void split(const PieceSettings& settings, const std::function<void(std::uint64_t)>& charge);
  const ConvexPieces* pieces() const;  // null unless it was split; after scaling
  /// HeightField: Error{Argument} for other shapes, or as HeightGrid::set_height. Bounds follow, the mass does not.
  void set_height(int column, int row, double height);
  double bounding_radius() const;                             // of the sphere about the origin that holds it
  Eigen::AlignedBox3d bounds(const Matrix3& rotation) const;  // about the origin

  double volume() const;
  double mass() const;               // kg
  double density() const;            // kg per cubic length unit
  void set_mass(double mass);        // density = mass / volume; the inertia follows
  void set_density(double density);  // mass and inertia follow
  Vector3 center_of_mass() const;    // own frame; the origin, but for a cone and some convex shapes
  const Matrix3& inertia() const;    // about the origin, own frame
  /// Replace the inertia; later changes of mass and scale carry it along. Error{Argument} unless it is finite,
  /// symmetric, positive definite, and no principal moment exceeds the sum of the other two (no solid has such).
  void set_inertia(const Matrix3& inertia);

  /// Absolute factors of the original size per axis, finite and > 0; a sphere and a capsule use x only, a cylinder x
  /// for its radius and the factor of its axis for its height. The density stays.
  void set_scale(const Vector3& factors);
  const Vector3& scale() const;
  const Vector3& last_scale() const;                  // the scale before the last change
  std::uint64_t changes() const { return changes_; }  // how often it was given a scale or a height
  /// Counts the same of many shapes: who compares it need not look at each.
  using ChangeCount = std::shared_ptr<std::uint64_t>;
  void report_changes_to(const ChangeCount& count);  // from now on, also; nothing if it does already

  /// Where a ray from the centre along `direction` leaves the surface; (0,0,0) for a zero direction.
  Vector3 point_on(const Vector3& direction) const;
  /// First point of the solid on a ray, both in the shape's own frame. False on a miss. `fraction` is in lengths of
  /// `direction`, and 0 if the ray starts inside.
  bool raycast(const Vector3& origin, const Vector3& direction, double& fraction) const;

  /// The image keeps every bit; sharing between owners is the affair of whoever saves them.
  void save(ByteWriter& out) const;
  /// Error{Image} if the image is damaged.
  static std::shared_ptr<Shape> load(ByteReader& in);
  void hash(Hasher& hasher) const;

 private:
  struct Geometry;
  explicit Shape(std::unique_ptr<Geometry> geometry);
  static std::shared_ptr<Shape> of(const Round& round, Memory memory);
  static std::shared_ptr<Shape> of(ShapeKind kind, Polyhedron solid, double density, Memory memory);
  static std::shared_ptr<Shape> mesh(std::shared_ptr<TriangleMesh> surface, const Polyhedron* hull, Memory memory);
  static std::shared_ptr<Shape> height_field(std::shared_ptr<HeightGrid> grid, Memory memory);
  static std::shared_ptr<Shape> shared(std::unique_ptr<Geometry> geometry);
  void note_change();
  std::unique_ptr<Geometry> geometry_;
  std::uint64_t changes_ = 0;
  std::pmr::vector<ChangeCount> counts_;  // of each world that has bodies of this shape: hardly ever more than one
};

}  // namespace breve
