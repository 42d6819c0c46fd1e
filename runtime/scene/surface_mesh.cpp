// Meshes of triangle surfaces and height fields, with normals that make them look round where they are meant to be.
#include <cmath>
#include <vector>

#include "runtime/scene/mesh.hpp"
#include "runtime/solid/height_grid.hpp"
#include "runtime/solid/triangle_mesh.hpp"

namespace breve {

namespace {

constexpr float kFlatEnough = 0.766F;  // cosine of 40 degrees

struct Around {
  std::vector<std::uint32_t> first, triangle;  // of each corner: where its triangles begin, and these
};

Around triangles_around(std::size_t corners, const std::pmr::vector<Triangle>& triangles) {
  Around around;
  around.first.assign(corners + 1, 0);
  for (const Triangle& t : triangles)
    for (const std::int32_t corner : t) ++around.first[static_cast<std::size_t>(corner) + 1];
  for (std::size_t i = 0; i < corners; ++i) around.first[i + 1] += around.first[i];
  around.triangle.resize(triangles.size() * 3);
  std::vector<std::uint32_t> next(around.first.begin(), around.first.end() - 1);
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    for (const std::int32_t corner : triangles[i]) around.triangle[next[static_cast<std::size_t>(corner)]++] = i;
  return around;
}

}  // namespace

SceneMesh make_surface_mesh(const Shape& shape, const Poll& poll) {
  EveryFew often(poll);
  const TriangleMesh& surface = *shape.triangles();
  const auto& corners = surface.corners();
  const auto& triangles = surface.triangles();
  SceneMesh mesh;
  mesh.two_sided = !surface.solid();
  std::vector<Vector3f> flat(triangles.size());  // twice the area long
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Vector3& a = corners[static_cast<std::size_t>(triangles[i][0])];
    const Vector3& b = corners[static_cast<std::size_t>(triangles[i][1])];
    const Vector3& c = corners[static_cast<std::size_t>(triangles[i][2])];
    flat[i] = (b - a).cross(c - a).cast<float>();
  }
  const Around around = triangles_around(corners.size(), triangles);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const std::int32_t corner : triangles[i]) {
      often.count();
      const auto at = static_cast<std::size_t>(corner);
      Vector3f normal = Vector3f::Zero();
      for (std::uint32_t k = around.first[at]; k < around.first[at + 1]; ++k) {
        const Vector3f& other = flat[around.triangle[k]];
        if (other.dot(flat[i]) >= kFlatEnough * other.norm() * flat[i].norm()) normal += other;
      }
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(corners[at].cast<float>());
      mesh.normals.push_back(normal.norm() > 0 ? Vector3f(normal.normalized()) : Vector3f(0, 1, 0));
      mesh.uvs.emplace_back(0.0F, 0.0F);
    }
  return mesh;
}

SceneMesh make_ground_mesh(const Shape& shape, const Poll& poll) {
  EveryFew often(poll);
  const HeightGrid& grid = *shape.heights();
  const int columns = grid.columns(), rows = grid.rows();
  SceneMesh mesh;
  mesh.form = SceneMesh::Form::Ground;
  const auto at = [&](int column, int row) { return Vector3f(grid.corner(column, row).cast<float>()); };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      often.count();
      const Vector3f across = at(std::min(column + 1, columns - 1), row) - at(std::max(column - 1, 0), row);
      const Vector3f along = at(column, std::min(row + 1, rows - 1)) - at(column, std::max(row - 1, 0));
      mesh.positions.push_back(at(column, row));
      mesh.normals.push_back(along.cross(across).normalized());
      mesh.uvs.emplace_back(static_cast<float>(column) / static_cast<float>(columns - 1),
                            static_cast<float>(row) / static_cast<float>(rows - 1));
    }
  for (int row = 0; row + 1 < rows; ++row)
    for (int column = 0; column + 1 < columns; ++column) {
      often.count();
      // As the solid is cut: from the low corner of a cell to its high one.
      const auto low = static_cast<std::uint32_t>(row * columns + column);
      const auto right = low + 1, back = low + static_cast<std::uint32_t>(columns), high = back + 1;
      mesh.indices.insert(mesh.indices.end(), {low, back, high, low, high, right});
    }
  return mesh;
}

}  // namespace breve
