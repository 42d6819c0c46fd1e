// Shapes in snapshot images and hashes.
#include <cmath>

#include "runtime/base/error.hpp"
#include "runtime/solid/height_grid.hpp"
#include "runtime/solid/polyhedron_image.hpp"
#include "runtime/solid/shape_geometry.hpp"

namespace breve {

void save_polyhedron(const Polyhedron& solid, ByteWriter& out) {
  out.put(static_cast<std::uint64_t>(solid.vertices.size()));
  for (const Vector3& v : solid.vertices) out.put(v);
  out.put(static_cast<std::uint64_t>(solid.faces.size()));
  for (const auto& face : solid.faces) {
    out.put(static_cast<std::uint64_t>(face.size()));
    for (const int v : face) out.put(static_cast<std::int32_t>(v));
  }
}

Polyhedron load_polyhedron(ByteReader& in) {
  Polyhedron solid;
  solid.vertices.resize(in.get_count(3 * sizeof(double)));
  for (Vector3& v : solid.vertices) {
    v = in.get_vector();
    if (!v.allFinite()) ByteReader::fail();
  }
  solid.faces.resize(in.get_count(sizeof(std::uint64_t)));
  for (auto& face : solid.faces) {
    face.resize(in.get_count(sizeof(std::int32_t)));
    if (face.size() < 3) ByteReader::fail();
    for (int& v : face) {
      v = in.get<std::int32_t>();
      if (v < 0 || static_cast<std::size_t>(v) >= solid.vertices.size()) ByteReader::fail();
    }
  }
  connect(solid);
  return solid;
}

void Shape::save(ByteWriter& out) const {
  const Geometry& g = *geometry_;
  out.put(g.kind);
  out.put(g.original_radius);
  if (g.original_round.is_round()) {
    out.put(static_cast<std::int32_t>(g.original_round.axis));
    out.put(g.original_round.radius);
    out.put(g.original_round.half);
  }
  // The polygons that show a round solid are made again.
  const bool polygons = !g.original_round.is_round();
  out.put(static_cast<std::uint64_t>(g.original_vertices.size()));
  for (const Vector3& v : g.original_vertices) out.put(v);
  out.put(static_cast<std::uint64_t>(polygons ? g.solid.faces.size() : 0));
  for (std::size_t f = 0; polygons && f < g.solid.faces.size(); ++f) {
    out.put(static_cast<std::uint64_t>(g.solid.faces[f].size()));
    for (const int v : g.solid.faces[f]) out.put(static_cast<std::int32_t>(v));
  }
  if (g.kind == ShapeKind::Mesh) {
    static_cast<const TriangleMesh&>(*g.surface).save(out);
    out.put(g.original_pieces != nullptr);
    if (g.original_pieces) g.original_pieces->save(out);
  }
  if (g.kind == ShapeKind::HeightField) static_cast<const HeightGrid&>(*g.surface).save(out);
  out.put(g.original.second);
  out.put(g.inertia);  // a given one does not come back from `second` to the last bit
  out.put(g.scale);
  out.put(g.last_scale);
  out.put(g.density);
}

namespace {

bool positive(double value) { return std::isfinite(value) && value > 0; }

Round load_round(ByteReader& in, ShapeKind kind) {
  Round round;
  if (kind != ShapeKind::Cylinder && kind != ShapeKind::Capsule) return round;
  round.kind = kind == ShapeKind::Cylinder ? RoundKind::Cylinder : RoundKind::Capsule;
  round.axis = in.get<std::int32_t>();
  round.radius = in.get<double>();
  round.half = in.get<double>();
  if (round.axis < 1 || round.axis > 2 || !positive(round.radius) || !positive(round.half)) ByteReader::fail();
  return round;
}

/// The polyhedron that an image may hold beside a kind of shape.
bool fits(ShapeKind kind, const Polyhedron& solid) {
  const bool bare = kind == ShapeKind::Sphere || kind == ShapeKind::HeightField || kind == ShapeKind::Cylinder ||
                    kind == ShapeKind::Capsule;
  if (bare) return solid.faces.empty() && solid.vertices.empty();
  if (kind == ShapeKind::Mesh && solid.faces.empty()) return solid.vertices.empty();
  return solid.faces.size() >= 4 && (kind != ShapeKind::Box || solid.vertices.size() == 8);
}

}  // namespace

std::shared_ptr<Shape> Shape::load(ByteReader& in) {
  const auto kind = in.get<ShapeKind>();
  const double radius = in.get<double>();
  if (kind > ShapeKind::Capsule) ByteReader::fail();
  try {
    const Round round = load_round(in, kind);
    Polyhedron solid = load_polyhedron(in);
    if (!fits(kind, solid)) ByteReader::fail();
    std::shared_ptr<Shape> shape;
    switch (kind) {
      case ShapeKind::Sphere: shape = sphere(radius, in.memory()); break;
      case ShapeKind::Box:
      case ShapeKind::Convex: shape = of(kind, solid, 1, in.memory()); break;
      case ShapeKind::Mesh:
        shape = mesh(TriangleMesh::load(in), &solid, in.memory());
        if (in.get_bool()) shape->geometry_->original_pieces = ConvexPieces::load(in, shape->surface()->bounds());
        break;
      case ShapeKind::HeightField: shape = height_field(HeightGrid::load(in), in.memory()); break;
      case ShapeKind::Cylinder:
      case ShapeKind::Capsule: shape = of(round, in.memory()); break;
    }
    Geometry& g = *shape->geometry_;
    g.original.second = in.get_matrix();
    const Matrix3 inertia = in.get_matrix();
    g.scale = in.get_vector();
    g.last_scale = in.get_vector();
    g.density = in.get<double>();
    if (!positive(g.scale.minCoeff()) || !positive(g.scale.maxCoeff()) || !positive(g.density)) ByteReader::fail();
    g.scale_surface();
    g.derive_size();
    g.derive_mass();
    if (!inertia.isApprox(g.inertia, 1e-9)) ByteReader::fail();
    g.inertia = inertia;
    return shape;
  } catch (const Error&) {
    ByteReader::fail();
  }
}

void Shape::hash(Hasher& hasher) const {
  const Geometry& g = *geometry_;
  hasher.add(static_cast<std::uint64_t>(g.kind));
  hasher.add(g.radius);
  if (g.round.is_round()) hasher.add(g.round.half);
  for (const Vector3& v : g.solid.vertices) hasher.add(v);
  for (const auto& face : g.solid.faces) {
    for (const int v : face) hasher.add(static_cast<std::uint64_t>(v));
  }
  if (g.surface) g.surface->hash(hasher);
  if (g.pieces) g.pieces->hash(hasher);
  hasher.add(g.inertia);
  hasher.add(g.scale);
  hasher.add(g.last_scale);
  hasher.add(g.density);
}

}  // namespace breve
