// Shapes that are surfaces of triangles: meshes and height fields, and what they weigh.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "runtime/base/error.hpp"
#include "runtime/solid/height_grid.hpp"
#include "runtime/solid/shape_geometry.hpp"

namespace breve {

namespace {

/// Moments of a box with these bounds.
Moments of_box(const Eigen::AlignedBox3d& box) {
  const Vector3 center = box.center(), size = box.sizes();
  const double volume = size.prod();
  const Vector3 squares = size.cwiseAbs2() / 12;
  return {volume, volume * center, volume * (Matrix3(squares.asDiagonal()) + center * center.transpose())};
}

/// The hull of a surface; a flat one counts as a thousandth of its extent thick.
Polyhedron hull_of(const TriangleMesh& surface) {
  constexpr double kThick = 1e-3, kFlat = 1e-5;
  std::vector<Vector3> points(surface.corners().begin(), surface.corners().end());
  const Triangle& first = surface.triangles().front();
  const auto corner = [&](std::size_t i) { return points[static_cast<std::size_t>(first[i])]; };
  const Vector3 normal = normal_of(corner(0), corner(1), corner(2)), base = corner(0);
  const double extent = surface.bounds().sizes().maxCoeff();
  const bool flat = std::all_of(points.begin(), points.end(),
                                [&](const Vector3& p) { return std::abs(normal.dot(p - base)) <= kFlat * extent; });
  const std::size_t count = flat ? points.size() : 0;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(points[i] + kThick / 2 * extent * normal);
    points[i] -= kThick / 2 * extent * normal;
  }
  return make_hull(points);
}

}  // namespace

std::shared_ptr<Shape> Shape::mesh(std::span<const Vector3> corners,
                                   std::span<const std::array<std::int32_t, 3>> triangles, Memory memory) {
  auto surface =
      std::shared_ptr<TriangleMesh>(new (memory) TriangleMesh(corners, triangles, memory),
                                    std::default_delete<TriangleMesh>(), std::pmr::polymorphic_allocator<>(memory));
  const Polyhedron hull = hull_of(*surface);
  return mesh(std::move(surface), &hull, memory);
}

std::shared_ptr<Shape> Shape::mesh(std::shared_ptr<TriangleMesh> surface, const Polyhedron* hull, Memory memory) {
  auto g = make_in<Geometry>(memory, memory);
  g->kind = ShapeKind::Mesh;
  g->original = surface->solid() ? surface->moments() : moments(*hull);
  g->original_vertices = hull->vertices;
  g->solid = *hull;
  g->surface = std::move(surface);
  return shared(std::move(g));
}

std::shared_ptr<Shape> Shape::hull(std::span<const Vector3> points, double density, Memory memory) {
  const Polyhedron solid = make_hull(points);
  const auto shape = of(ShapeKind::Convex, solid, 1, memory);
  shape->set_density(density);
  return shape;
}

std::shared_ptr<Shape> Shape::height_field(int columns, int rows, double tile, std::span<const double> heights,
                                           Memory memory, const Poll& poll) {
  return height_field(
      std::shared_ptr<HeightGrid>(new (memory) HeightGrid(columns, rows, tile, heights, memory, poll),
                                  std::default_delete<HeightGrid>(), std::pmr::polymorphic_allocator<>(memory)),
      memory);
}

namespace {

Moments block_under(const HeightGrid& grid) {
  Eigen::AlignedBox3d box = grid.bounds();
  box.min().y() = std::min(box.min().y(), box.max().y() - grid.tile());
  return of_box(box);
}

}  // namespace

std::shared_ptr<Shape> Shape::height_field(std::shared_ptr<HeightGrid> grid, Memory memory) {
  auto g = make_in<Geometry>(memory, memory);
  g->kind = ShapeKind::HeightField;
  g->original = block_under(*grid);
  g->surface = std::move(grid);
  return shared(std::move(g));
}

const HeightGrid* Shape::heights() const {
  return kind() == ShapeKind::HeightField ? static_cast<const HeightGrid*>(geometry_->surface.get()) : nullptr;
}

const TriangleMesh* Shape::triangles() const {
  return kind() == ShapeKind::Mesh ? static_cast<const TriangleMesh*>(geometry_->surface.get()) : nullptr;
}

const ConvexPieces* Shape::pieces() const { return geometry_->pieces.get(); }

void Shape::split(const PieceSettings& settings, const std::function<void(std::uint64_t)>& charge) {
  if (kind() != ShapeKind::Mesh) throw Error(ErrorCode::Argument, "only a mesh can be split into convex pieces");
  // The mesh is split at its original size, so that an image holds the pieces as they were before scaling.
  const std::shared_ptr<Surface> original = geometry_->surface->scaled(Vector3::Ones());
  auto pieces = split_into_convex(static_cast<const TriangleMesh&>(*original), settings, geometry_->memory(), charge);
  auto scaled = pieces->scaled(geometry_->scale);
  geometry_->original_pieces = std::move(pieces);
  geometry_->pieces = std::move(scaled);
  note_change();
}

void Shape::set_height(int column, int row, double height) {
  if (kind() != ShapeKind::HeightField) throw Error(ErrorCode::Argument, "only a height field has heights to set");
  HeightGrid& grid = static_cast<HeightGrid&>(*geometry_->surface);
  const auto set = [&](double value) {
    grid.set_height(column, row, value);
    geometry_->original = block_under(grid);
    geometry_->derive_mass();
  };
  const double before = grid.height(column, row);
  try {
    set(height);
  } catch (const Error&) {
    set(before);
    throw;
  }
  geometry_->derive_size();
  note_change();
}

}  // namespace breve
