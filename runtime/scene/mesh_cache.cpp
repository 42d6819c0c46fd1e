// Meshes by what they are made of.
#include "runtime/scene/mesh_cache.hpp"

#include <algorithm>

#include "runtime/base/hasher.hpp"
#include "runtime/scene/mesh.hpp"
#include "runtime/solid/height_grid.hpp"
#include "runtime/solid/triangle_mesh.hpp"

namespace breve {

namespace {

constexpr int kSphereLevel = 4;
// The digest of a large surface reads only some of its corners; its shape also counts its changes.
constexpr std::size_t kSample = 256;

void measure(SceneMesh& mesh, std::uint64_t revision) {
  for (const Vector3f& p : mesh.positions) mesh.reach = mesh.reach.cwiseMax(p.cwiseAbs());
  mesh.revision = revision;
}

}  // namespace

MeshCache::MeshCache(std::deque<SceneMesh>& meshes) : meshes_(meshes) {
  meshes_.push_back(make_sphere_mesh(kSphereLevel));
  meshes_.push_back(make_box_mesh());
  for (SceneMesh& mesh : meshes_) measure(mesh, ++revisions_);
  entries_.resize(meshes_.size());
}

void MeshCache::begin() {
  seen_.clear();
  for (Entry& entry : entries_) entry.used = false;
}

void MeshCache::end() {
  for (std::size_t i = kBox + 1; i < entries_.size(); ++i) {
    if (entries_[i].used || meshes_[i].indices.empty()) continue;
    by_key_.erase(entries_[i].key);
    meshes_[i] = SceneMesh();
  }
}

template <class Make>
std::uint32_t MeshCache::kept(std::uint64_t key, Make make) {
  const auto found = by_key_.find(key);
  if (found != by_key_.end()) {
    entries_[found->second].used = true;
    return found->second;
  }
  std::size_t free = kBox + 1;
  while (free < meshes_.size() && !meshes_[free].indices.empty()) ++free;
  if (free == meshes_.size()) {
    meshes_.emplace_back();
    entries_.emplace_back();
  }
  meshes_[free] = make();
  measure(meshes_[free], ++revisions_);
  entries_[free] = {key, true};
  by_key_[key] = static_cast<std::uint32_t>(free);
  return static_cast<std::uint32_t>(free);
}

std::uint32_t MeshCache::of_polygons(const Shape& shape) {
  Hasher hasher;
  for (const Vector3& v : shape.vertices()) hasher.add(v);
  for (const auto& face : shape.faces()) hasher.add(static_cast<std::uint64_t>(face.size()));
  return kept(hasher.value(), [&] { return make_facet_mesh(shape); });
}

std::uint32_t MeshCache::of_surface(const Shape& shape, const Poll& poll) {
  Hasher hasher;
  hasher.add(static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(&shape)));
  hasher.add(shape.changes());
  hasher.add(shape.surface()->bounds().min());
  hasher.add(shape.surface()->bounds().max());
  if (const HeightGrid* grid = shape.heights()) {
    const auto count = static_cast<std::size_t>(grid->columns()) * static_cast<std::size_t>(grid->rows());
    hasher.add(static_cast<std::uint64_t>(count));
    for (std::size_t i = 0; i < count; i += std::max<std::size_t>(1, count / kSample))
      hasher.add(grid->height(static_cast<int>(i % static_cast<std::size_t>(grid->columns())),
                              static_cast<int>(i / static_cast<std::size_t>(grid->columns()))));
    return kept(hasher.value(), [&] { return make_ground_mesh(shape, poll); });
  }
  const auto& corners = shape.triangles()->corners();
  hasher.add(static_cast<std::uint64_t>(corners.size()));
  for (std::size_t i = 0; i < corners.size(); i += std::max<std::size_t>(1, corners.size() / kSample))
    hasher.add(corners[i]);
  return kept(hasher.value(), [&] { return make_surface_mesh(shape, poll); });
}

MeshUse MeshCache::find(const Shape& shape, const Poll& poll) {
  if (shape.kind() == ShapeKind::Sphere) return {kSphere, Vector3f::Constant(static_cast<float>(shape.radius()))};
  if (shape.kind() == ShapeKind::Box) return {kBox, shape.size().cast<float>()};
  const auto known = seen_.find(&shape);
  if (known != seen_.end()) return known->second;
  MeshUse use;
  if (shape.kind() == ShapeKind::Cylinder || shape.kind() == ShapeKind::Capsule) {
    const Round& round = shape.round();
    const auto radius = static_cast<float>(round.radius);
    use.scale = Vector3f::Constant(radius);
    Hasher hasher;
    hasher.add(static_cast<std::uint64_t>(round.axis) * 2 + static_cast<std::uint64_t>(round.is_capsule()));
    if (round.is_capsule()) {
      hasher.add(round.half / round.radius);
      use.mesh = kept(hasher.value(), [&] { return make_capsule_mesh(round.axis, round.half / round.radius); });
    } else {
      use.scale[round.axis] = static_cast<float>(round.half);
      use.mesh = kept(hasher.value(), [&] { return make_cylinder_mesh(round.axis); });
    }
  } else {
    use.mesh = shape.surface() ? of_surface(shape, poll) : of_polygons(shape);
  }
  seen_[&shape] = use;
  return use;
}

}  // namespace breve
