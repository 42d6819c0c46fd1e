// Descriptions of shapes, of which some are wrong.
#pragma once

#include "caller.hpp"

namespace breve::fuzz {

/// Numbers of any kind of shape: a cube's corners and faces, a field of heights; one of them may be wrong.
struct DrawnGeometry {
  explicit DrawnGeometry(Caller& c) {
    geometry.kind = static_cast<breve_shape_kind>(c.choose().below(7));
    geometry.vertices = vertices.data();
    geometry.vertex_count = vertices.size() / 3;
    geometry.face_sizes = sizes.data();
    geometry.face_count = sizes.size();
    geometry.indices = indices.data();
    geometry.index_count = indices.size();
    for (double& height : heights) height = c.finite();
    geometry.heights = heights.data();
    geometry.columns = geometry.rows = 8;
    if (c.chance(40)) spoil(c);
  }
  void spoil(Caller& c) {
    switch (c.choose().below(14)) {
      case 0: c.choose().one_of(vertices) = c.number(); break;
      case 1: c.choose().one_of(indices) = c.word(); break;
      case 2: c.choose().one_of(sizes) = static_cast<std::uint32_t>(c.choose().below(8)); break;
      case 3: c.choose().one_of(heights) = c.number(); break;
      case 4: geometry.radius = c.number(); break;
      case 5: geometry.size[c.choose().below(3)] = c.number(); break;
      case 6: geometry.density = c.number(); break;
      case 7: geometry.height = c.number(); break;
      case 8: geometry.tile = c.number(); break;
      case 9: geometry.columns = static_cast<std::uint32_t>(c.choose().below(9)); break;
      case 10: geometry.index_count = c.choose().below(25); break;
      case 11: geometry.face_count = c.choose().below(7); break;
      case 12: geometry.vertices = nullptr, geometry.heights = nullptr; break;
      default: geometry.reserved = 1, c.expect_refusal(); break;
    }
  }
  breve_geometry geometry = breve_geometry_default();
  std::vector<double> vertices = {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1};
  std::vector<std::uint32_t> sizes = {4, 4, 4, 4, 4, 4},
                             indices = {0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 2, 3, 7, 6, 1, 2, 6, 5, 0, 4, 7, 3};
  std::array<double, 64> heights{};
};

}  // namespace breve::fuzz
