// Sorting of instances.
#include "runtime/render/batches.hpp"

#include <algorithm>
#include <numbers>

namespace breve::render {

namespace {

constexpr float kOpaque = 0.999F;

struct Item {
  std::uint32_t mesh, texture;
  std::uint32_t number;  // of the instance
  float away;
  float pixels;
};

std::uint32_t mesh_for(const SceneInstance& instance, const SceneMesh& mesh, const BatchView& view) {
  if (mesh.form != SceneMesh::Form::Sphere || !view.lens) return instance.mesh;
  const Vector3f center = instance.transform.col(3);
  const float pixels = radius_of(instance, mesh) * view.lens->scale_at(center, view.height);
  constexpr float kSmall = 14;
  if (view.discs && pixels < kSmall && instance.texture == kNoTexture && instance.color.w() >= kOpaque)
    return kDiscMesh;
  const std::uint32_t level = pixels < 7 ? 0 : pixels < 28 ? 1 : pixels < 110 ? 2 : 3;
  return kSphereMesh + level;
}

GpuInstance packed(const SceneInstance& instance, std::size_t layer) {
  const Transform& p = instance.transform;
  return {p.row(0),
          p.row(1),
          p.row(2),
          instance.color,
          {instance.texture_scale.x(), instance.texture_scale.y(), instance.lit ? (instance.fixed ? 2.0F : 1.0F) : 0.0F,
           static_cast<float>(layer)}};
}

/// The area that an instance covers at most; where that is not a number, a picture's.
float pixels_of(const SceneInstance& instance, const SceneMesh& mesh, const BatchView& view) {
  if (!view.lens) return 0;
  constexpr float kWidest = 2;  // pictures are hardly more than twice as wide as high
  const float radius = radius_of(instance, mesh) * view.lens->scale_at(instance.transform.col(3), view.height);
  const float area = std::numbers::pi_v<float> * radius * radius, most = kWidest * view.height * view.height;
  return area < most ? area : most;
}

/// One that stands exactly where another is drawn after it shows nothing, unless a texture lets it through.
bool is_hidden(const SceneInstance& instance, const SceneInstance& after) {
  return instance.mesh == after.mesh && instance.transform == after.transform && after.texture == kNoTexture;
}

/// @param solid  they hide each other
void collect(const Scene& scene, const std::vector<Item>& items, bool solid, std::vector<GpuInstance>& instances,
             std::vector<Batch>& batches) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Item& item = items[i];
    if (solid && i + 1 < items.size() && is_hidden(scene.instances[item.number], scene.instances[items[i + 1].number]))
      continue;
    if (batches.empty() || batches.back().mesh != item.mesh || batches.back().texture != item.texture)
      batches.push_back({item.mesh, item.texture, instances.size(), 0});
    ++batches.back().count;
    batches.back().pixels += static_cast<double>(item.pixels);
    instances.push_back(packed(scene.instances[item.number], item.number));
  }
}

}  // namespace

Batches batch(const Scene& scene, const BatchView& view, Wanted wanted, const SceneInstance* without) {
  std::vector<Item> opaque, transparent;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const SceneInstance& instance = scene.instances[i];
    if (instance.color.w() <= 0 || &instance == without || (wanted && !wanted(instance))) continue;
    const SceneMesh& mesh = scene.meshes[instance.mesh];
    if (mesh.indices.empty()) continue;
    const Vector3f center = instance.transform.col(3);
    const float away = view.lens ? (view.lens->eye - center).dot(view.lens->back) : 0;
    const Item item{mesh_for(instance, mesh, view), instance.texture, i, away, pixels_of(instance, mesh, view)};
    (instance.color.w() < kOpaque ? transparent : opaque).push_back(item);
  }
  // The nearest first: what is behind them need not be shaded.
  std::stable_sort(opaque.begin(), opaque.end(), [&](const Item& a, const Item& b) {
    if (a.mesh != b.mesh) return a.mesh < b.mesh;
    if (a.texture != b.texture) return a.texture < b.texture;
    return view.by_distance && a.away < b.away;
  });
  if (view.by_distance)
    std::stable_sort(transparent.begin(), transparent.end(),
                     [](const Item& a, const Item& b) { return a.away > b.away; });
  Batches batches;
  batches.instances.reserve(opaque.size() + transparent.size());
  collect(scene, opaque, view.by_distance, batches.instances, batches.opaque);
  collect(scene, transparent, false, batches.instances, batches.transparent);
  return batches;
}

}  // namespace breve::render
