// The polygons that show a shape of any kind: what hosts and renderers draw.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "runtime/solid/height_grid.hpp"
#include "runtime/solid/shape.hpp"
#include "runtime/solid/triangle_mesh.hpp"

namespace breve {

struct PolygonCounts {
  std::size_t vertices = 0, faces = 0, indices = 0;
};

/// Call `vertex(point)` for each vertex in order, own frame; a sphere has none.
template <class Visit>
void for_each_vertex(const Shape& shape, Visit&& vertex) {
  if (const HeightGrid* grid = shape.heights()) {
    for (int r = 0; r < grid->rows(); ++r) {
      for (int c = 0; c < grid->columns(); ++c) vertex(grid->corner(c, r));
    }
    return;
  }
  for (const Vector3& p : shape.triangles() ? shape.triangles()->corners() : shape.vertices()) vertex(p);
}

/// Call `face(indices, count)` for each face, counter-clockwise from outside; a sphere has none.
template <class Visit>
void for_each_face(const Shape& shape, Visit&& face) {
  if (const HeightGrid* grid = shape.heights()) {
    const int columns = grid->columns();
    for (int i = 0; i < columns * (grid->rows() - 1); ++i) {
      if ((i + 1) % columns == 0) continue;
      const std::array<int, 6> halves{i, i + columns, i + columns + 1, i + columns + 1, i + 1, i};
      face(halves.data(), std::size_t{3});
      face(halves.data() + 3, std::size_t{3});
    }
  } else if (shape.triangles() != nullptr) {
    for (const Triangle& t : shape.triangles()->triangles()) face(t.data(), t.size());
  } else {
    for (const auto& f : shape.faces()) face(f.data(), f.size());
  }
}

inline PolygonCounts count_polygons(const Shape& shape) {
  PolygonCounts counts;
  for_each_vertex(shape, [&](const Vector3&) { ++counts.vertices; });
  for_each_face(shape, [&](const int*, std::size_t size) {
    ++counts.faces;
    counts.indices += size;
  });
  return counts;
}

}  // namespace breve
