// A closed convex solid with mass properties, shared between bodies. The origin is its centre.
#pragma once

#include <memory>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/base/math.hpp"

namespace breve {

enum class ShapeKind : std::uint8_t { Sphere, Box, Convex };

class Shape {
 public:
  // Builders. Error{Argument} names what is wrong: a size or density that is not finite and > 0, fewer than 3 sides.
  static std::shared_ptr<Shape> sphere(double radius);
  static std::shared_ptr<Shape> box(const Vector3& size);                              // full edge lengths
  static std::shared_ptr<Shape> prism(int sides, double height, double radius);        // PolygonDisk
  static std::shared_ptr<Shape> cone(int sides, double height, double radius);         // PolygonCone, apex at +height/2
  static std::shared_ptr<Shape> convex(const std::vector<std::vector<Vector3>>& faces, double density);  // CustomShape

  ~Shape();
  ShapeKind kind() const;
  double radius() const;                        // Sphere
  Vector3 size() const;                         // Box: full edge lengths after scaling
  const std::vector<Vector3>& vertices() const; // Box, Convex: after scaling, own frame
  const std::vector<std::vector<int>>& faces() const;  // indices into vertices, counter-clockwise from outside
  double bounding_radius() const;               // of the sphere about the origin that holds it
  Eigen::AlignedBox3d bounds(const Matrix3& rotation) const;  // about the origin

  double volume() const;
  double mass() const;     // kg
  double density() const;  // kg per cubic length unit
  void set_mass(double mass);
  void set_density(double density);
  const Matrix3& inertia() const;  // about the centre, own frame
  void set_inertia(const Matrix3& inertia);

  /// Absolute factors of the original size per axis; a sphere uses x only.
  void set_scale(const Vector3& factors);
  const Vector3& scale() const;
  const Vector3& last_scale() const;  // the scale before the last change

  /// Where a ray from the centre along `direction` leaves the surface; (0,0,0) for a zero direction.
  Vector3 point_on(const Vector3& direction) const;
  /// First hit of a ray with the solid at a pose. False on a miss. `fraction` is in lengths of `direction`.
  bool raycast(const Vector3& origin, const Vector3& direction, double& fraction) const;  // own frame

  void save(ByteWriter& out) const;
  static std::shared_ptr<Shape> load(ByteReader& in);
  void hash(Hasher& hasher) const;

 private:
  Shape();
  struct Geometry;
  std::unique_ptr<Geometry> geometry_;
};

}  // namespace breve
