// A convex polyhedron as vertices, faces, planes and edges, and its exact moments: the geometry behind every shape
// that is not a sphere. Faces run counter-clockwise seen from outside.
#pragma once

#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/math.hpp"
#include "runtime/solid/face_tree.hpp"
#include "runtime/solid/gauss_map.hpp"

namespace breve {

/// The outer side of a face: points p with normal . p > offset are outside. `normal` has unit length.
struct Plane {
  Vector3 normal;
  double offset;
};

/// An edge between two faces: it runs from vertex a to vertex b in `left` and from b to a in `right`.
struct Edge {
  int a, b;
  int left, right;
};

/// Corners and faces are numbered by int, arrays are not.
inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

struct Polyhedron {
  std::pmr::vector<Vector3> vertices;
  std::pmr::vector<std::pmr::vector<int>> faces;
  std::pmr::vector<Plane> planes;  // one a face
  std::pmr::vector<Edge> edges;    // in the order in which the faces first name them
  // The vertices at the other ends of each vertex' edges, and where each one's begin: of solids with many vertices that
  // are convex to round-off, else empty.
  std::pmr::vector<int> neighbors, first_neighbor;
  GaussMap arcs;   // of the edges of such a solid, if they are many
  FaceTree looks;  // of its faces, likewise

  explicit Polyhedron(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : vertices(memory),
        faces(memory),
        planes(memory),
        edges(memory),
        neighbors(memory),
        first_neighbor(memory),
        arcs(memory),
        looks(memory) {}
  /// A copy in `memory`.
  Polyhedron(const Polyhedron& other, std::pmr::memory_resource* memory)
      : vertices(other.vertices, memory),
        faces(other.faces, memory),
        planes(other.planes, memory),
        edges(other.edges, memory),
        neighbors(other.neighbors, memory),
        first_neighbor(other.first_neighbor, memory),
        arcs(other.arcs, memory),
        looks(other.looks, memory) {}

  /// The vertex farthest along `direction`; of equals the first, as far as edges lead there. With neighbors the search
  /// goes up from vertex `from`: a few steps where that is near.
  int farthest(const Vector3& direction, int from) const;
};

/// Integrals of 1, x and x x^T over the solid at density 1.
struct Moments {
  double volume;
  Vector3 first;
  Matrix3 second;
};

/// The builders give the origin as centre. Error{Argument} names the value that is not finite and > 0.
Polyhedron make_box(const Vector3& size, std::pmr::memory_resource* memory = std::pmr::get_default_resource());
Polyhedron make_prism(int sides, double height, double radius);
Polyhedron make_cone(int sides, double height, double radius);

/// The convex solid that `faces` enclose; each face is a planar convex polygon given in either sense.
/// Error{Argument} says which face or vertex keeps it from being closed, convex, or around the origin.
Polyhedron make_convex(const std::vector<std::vector<Vector3>>& faces);

/// The smallest convex solid that holds all points. Faces are flat to round-off of the extent. Error{Argument}: fewer
/// than four points, a point that is not finite, points in one plane or nearly, more than 1,000,000 points or 4,000
/// faces. By quickhull in double precision (Barber, Dobkin and Huhdanpaa 1996).
Polyhedron make_hull(std::span<const Vector3> points);

/// Find the edges from the faces. Error{Argument} if some edge is not shared by exactly two faces, once in each sense.
void connect(Polyhedron& solid);
/// Recompute the planes, and who is whose neighbor, after the vertices moved.
void update_planes(Polyhedron& solid);

/// Exact moments of a closed polyhedron about the origin.
/// Source: the divergence theorem turns each volume integral into a sum over triangles (Mirtich 1996, "Fast and
/// accurate computation of polyhedral mass properties"; Eberly 2002, "Polyhedral mass properties"); here as signed
/// tetrahedra from the origin. Cost O(corners).
Moments moments(const Polyhedron& solid);
/// Add what the tetrahedron from the origin to a triangle contributes; negative if the origin is outside its plane.
void add_tetrahedron(const Vector3& a, const Vector3& b, const Vector3& c, Moments& sum);

}  // namespace breve
