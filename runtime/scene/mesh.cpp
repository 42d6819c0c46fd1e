// Meshes of round and flat solids.
#include "runtime/scene/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace breve {

namespace {

constexpr float kCircle = 2 * std::numbers::pi_v<float>;

std::uint32_t add(SceneMesh& mesh, const Vector3f& position, const Vector3f& normal) {
  mesh.positions.push_back(position);
  mesh.normals.push_back(normal);
  mesh.uvs.emplace_back(0.0F, 0.0F);
  return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

void add_triangle(SceneMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

/// (across, along, about) of a solid about `axis`, as (x, y, z): a cyclic order keeps triangles turned outward.
Vector3f about(int axis, float first, float along, float second) {
  Vector3f v;
  v[axis] = along;
  v[(axis + 1) % 3] = first;
  v[(axis + 2) % 3] = second;
  return v;
}

/// Rings of vertices, `segments` + 1 each, joined by triangles: a surface of revolution.
/// @param profile  radius, height along the axis; and the normal's part outward and along. From the top down
void revolve(SceneMesh& mesh, int axis, int segments, const std::vector<std::array<float, 4>>& profile) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  const auto ring = static_cast<std::uint32_t>(segments + 1);
  for (const auto& [radius, height, out, up] : profile)
    for (int i = 0; i <= segments; ++i) {
      const float angle = kCircle * static_cast<float>(i) / static_cast<float>(segments);
      const float c = std::cos(angle), s = std::sin(angle);
      add(mesh, about(axis, radius * c, height, radius * s), about(axis, out * c, up, out * s));
    }
  for (std::uint32_t level = 0; level + 1 < profile.size(); ++level)
    for (std::uint32_t i = 0; i + 1 < ring; ++i) {
      const std::uint32_t a = base + level * ring + i;
      add_triangle(mesh, a, a + ring, a + 1);
      add_triangle(mesh, a + 1, a + ring, a + ring + 1);
    }
}

std::uint32_t middle(SceneMesh& mesh, std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>& known,
                     std::uint32_t a, std::uint32_t b) {
  const auto key = std::minmax(a, b);
  const auto found = known.find(key);
  if (found != known.end()) return found->second;
  const Vector3f p = (mesh.positions[a] + mesh.positions[b]).normalized();
  return known[key] = add(mesh, p, p);
}

/// Adds a flat polygon, counter-clockwise, as a fan.
void add_polygon(SceneMesh& mesh, const std::vector<Vector3f>& corners) {
  if (corners.size() < 3) return;
  Vector3f normal = Vector3f::Zero();  // Newell's method: right for any polygon
  for (std::size_t i = 0; i < corners.size(); ++i) normal += corners[i].cross(corners[(i + 1) % corners.size()]);
  if (normal.norm() == 0) return;
  normal.normalize();
  const std::uint32_t first = add(mesh, corners[0], normal);
  for (std::size_t i = 1; i < corners.size(); ++i) add(mesh, corners[i], normal);
  for (std::uint32_t i = 1; i + 1 < corners.size(); ++i) add_triangle(mesh, first, first + i, first + i + 1);
}

}  // namespace

SceneMesh make_sphere_mesh(int level) {
  SceneMesh mesh;
  mesh.form = SceneMesh::Form::Sphere;
  const float t = (1 + std::sqrt(5.0F)) / 2;
  for (const Vector3f& v : {Vector3f(-1, t, 0), Vector3f(1, t, 0), Vector3f(-1, -t, 0), Vector3f(1, -t, 0),
                            Vector3f(0, -1, t), Vector3f(0, 1, t), Vector3f(0, -1, -t), Vector3f(0, 1, -t),
                            Vector3f(t, 0, -1), Vector3f(t, 0, 1), Vector3f(-t, 0, -1), Vector3f(-t, 0, 1)})
    add(mesh, v.normalized(), v.normalized());
  mesh.indices = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
                  3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
  for (int i = 0; i < level; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    std::vector<std::uint32_t> old;
    old.swap(mesh.indices);
    for (std::size_t k = 0; k < old.size(); k += 3) {
      const std::uint32_t a = old[k], b = old[k + 1], c = old[k + 2];
      const std::uint32_t ab = middle(mesh, known, a, b), bc = middle(mesh, known, b, c),
                          ca = middle(mesh, known, c, a);
      add_triangle(mesh, a, ab, ca);
      add_triangle(mesh, b, bc, ab);
      add_triangle(mesh, c, ca, bc);
      add_triangle(mesh, ab, bc, ca);
    }
  }
  return mesh;
}

SceneMesh make_box_mesh() {
  SceneMesh mesh;
  mesh.form = SceneMesh::Form::Box;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-0.5F, 0.5F}) {
      const float winding = side > 0 ? 1.0F : -1.0F;
      add_polygon(mesh, {about(axis, -0.5F, side, -0.5F * winding), about(axis, 0.5F, side, -0.5F * winding),
                         about(axis, 0.5F, side, 0.5F * winding), about(axis, -0.5F, side, 0.5F * winding)});
    }
  return mesh;
}

SceneMesh make_cylinder_mesh(int axis, int segments) {
  SceneMesh mesh;
  mesh.form = SceneMesh::Form::Round;
  revolve(mesh, axis, segments, {{0, 1, 0, 1}, {1, 1, 0, 1}});
  revolve(mesh, axis, segments, {{1, 1, 1, 0}, {1, -1, 1, 0}});
  revolve(mesh, axis, segments, {{1, -1, 0, -1}, {0, -1, 0, -1}});
  return mesh;
}

SceneMesh make_capsule_mesh(int axis, double half, int segments) {
  SceneMesh mesh;
  mesh.form = SceneMesh::Form::Round;
  std::vector<std::array<float, 4>> profile;
  const int rings = segments / 4;
  for (const float side : {1.0F, -1.0F})
    for (int i = 0; i <= rings; ++i) {
      const int step = side > 0 ? i : rings - i;
      const float angle = kCircle / 4 * static_cast<float>(step) / static_cast<float>(rings);
      profile.push_back({std::sin(angle), side * (static_cast<float>(half) + std::cos(angle)), std::sin(angle),
                         side * std::cos(angle)});
    }
  revolve(mesh, axis, segments, profile);
  return mesh;
}

SceneMesh make_facet_mesh(const Shape& shape) {
  SceneMesh mesh;
  std::vector<Vector3f> corners;
  for (const auto& face : shape.faces()) {
    corners.clear();
    for (const int corner : face) corners.push_back(shape.vertices()[static_cast<std::size_t>(corner)].cast<float>());
    add_polygon(mesh, corners);
  }
  return mesh;
}

void color_by_height(SceneMesh& mesh, const Vector3f& valley, const Vector3f& peak) {
  float low = 0, high = 0;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const float y = mesh.positions[i].y();
    low = i == 0 ? y : std::min(low, y);
    high = i == 0 ? y : std::max(high, y);
  }
  mesh.colors.resize(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const float part = high > low ? (mesh.positions[i].y() - low) / (high - low) : 0;
    mesh.colors[i] = valley + part * (peak - valley);
  }
}

}  // namespace breve
