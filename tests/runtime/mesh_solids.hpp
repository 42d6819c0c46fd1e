// Closed concave meshes with known volumes: a ring, an L, a cup, a bowl.
#pragma once

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "runtime/solid/pieces.hpp"
#include "runtime/solid/shape.hpp"

namespace breve::mesh_solids {

struct Mesh {
  std::vector<Vector3> corners;
  std::vector<Triangle> triangles;

  std::shared_ptr<Shape> shape() const { return Shape::mesh(corners, triangles); }
  void add(const Mesh& other, const Vector3& offset, bool inside_out = false) {
    const auto first = static_cast<std::int32_t>(corners.size());
    for (const Vector3& p : other.corners) corners.emplace_back(p + offset);
    for (Triangle t : other.triangles) {
      if (inside_out) std::swap(t[1], t[2]);
      triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  /// About its own centre of mass, as bodies have it.
  Mesh centered() const {
    Mesh out = *this;
    const Vector3 center = shape()->center_of_mass();
    for (Vector3& p : out.corners) p -= center;
    return out;
  }
};

/// Radius and height of a corner of the outline that is rotated about the y axis.
using Outline = std::vector<std::pair<double, double>>;

/// `outline` runs with the solid on its left, seen with the radius to the right; a radius of 0 is on the axis.
inline Mesh revolved(const Outline& outline, int sides, bool closed) {
  Mesh mesh;
  std::vector<std::vector<std::int32_t>> ring;
  for (const auto& [radius, height] : outline) {
    auto& here = ring.emplace_back();
    for (int j = 0; j < sides; ++j) {
      const double angle = 2 * std::numbers::pi * j / sides;
      if (radius > 0 || j == 0) {
        mesh.corners.emplace_back(radius * std::cos(angle), height, radius * std::sin(angle));
      }
      here.push_back(static_cast<std::int32_t>(mesh.corners.size()) - 1);
    }
  }
  const std::size_t steps = outline.size() - (closed ? 0 : 1);
  for (std::size_t i = 0; i < steps; ++i) {
    const auto &low = ring[i], &high = ring[(i + 1) % ring.size()];
    for (std::size_t j = 0; j < low.size(); ++j) {
      const std::size_t next = (j + 1) % low.size();
      if (low[j] != low[next]) mesh.triangles.push_back({low[j], high[next], low[next]});
      if (high[j] != high[next]) mesh.triangles.push_back({low[j], high[j], high[next]});
    }
  }
  return mesh;
}

inline Mesh torus(double radius, double tube, int sides, int around) {
  Outline outline;
  for (int i = 0; i < around; ++i) {
    const double angle = 2 * std::numbers::pi * i / around;
    outline.emplace_back(radius + tube * std::cos(angle), tube * std::sin(angle));
  }
  return revolved(outline, sides, true);
}

/// Open above; its foot is at height 0.
inline Mesh cup(double radius, double height, double wall, int sides) {
  return revolved({{0, 0}, {radius, 0}, {radius, height}, {radius - wall, height}, {radius - wall, wall}, {0, wall}},
                  sides, false);
}

/// Half a hollow ball, open above.
inline Mesh bowl(double radius, double wall, int sides, int rows) {
  Outline outline;
  for (int i = 0; i <= 2 * rows + 1; ++i) {
    const int row = i <= rows ? i : 2 * rows + 1 - i;
    const double angle = std::numbers::pi / 2 * (row - rows) / rows, r = i <= rows ? radius : radius - wall;
    outline.emplace_back(row == 0 ? 0 : r * std::cos(angle), r * std::sin(angle));
  }
  return revolved(outline, sides, false);
}

inline Mesh block(const Vector3& size) {
  const Polyhedron box = make_box(size);
  Mesh mesh;
  mesh.corners.assign(box.vertices.begin(), box.vertices.end());
  for (const auto& face : box.faces) {
    mesh.triangles.push_back({face[0], face[1], face[2]});
    mesh.triangles.push_back({face[0], face[2], face[3]});
  }
  return mesh;
}

/// Two by three with a square cut out, one thick: volume 4.
inline Mesh ell() {
  const double outline[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  Mesh mesh;
  for (int z = 0; z < 2; ++z) {
    for (const auto& p : outline) mesh.corners.emplace_back(p[0], p[1], z);
  }
  for (int i = 1; i < 5; ++i) {
    const int a = 0, b = i, c = i + 1;
    mesh.triangles.push_back({a + 6, b + 6, c + 6});
    mesh.triangles.push_back({a, c, b});
  }
  for (int i = 0; i < 6; ++i) {
    const int j = (i + 1) % 6;
    mesh.triangles.push_back({i, j, j + 6});
    mesh.triangles.push_back({i, j + 6, i + 6});
  }
  return mesh;
}

}  // namespace breve::mesh_solids
