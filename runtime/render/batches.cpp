// Sorting of instances.
#include "runtime/render/batches.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

namespace breve::render {

namespace {

struct Item {
  std::uint32_t mesh, texture;
  std::uint32_t number;  // of the instance
  bool solid;
  Place place;
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

GpuInstance packed(const SceneInstance& instance, std::size_t layer, const SceneInstance* ground) {
  const Transform& p = instance.transform;
  float lit = instance.lit ? 1 : 0;
  if (instance.lit && &instance == ground) lit += static_cast<float>(instance.unchosen);
  return {p.row(0),
          p.row(1),
          p.row(2),
          instance.color,
          {instance.texture_scale.x(), instance.texture_scale.y(), lit, static_cast<float>(layer)}};
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

/// @param opaque  they hide each other
void collect(const Scene& scene, const std::vector<Item>& items, bool opaque, const BatchView& view,
             std::vector<GpuInstance>& instances, std::vector<Batch>& batches) {
  const std::size_t others = view.others && !opaque ? view.others->size() : 0;
  std::size_t done = 0;  // of the others
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Item& item = items[i];
    if (opaque && view.by_distance && i + 1 < items.size() &&
        is_hidden(scene.instances[item.number], scene.instances[items[i + 1].number]))
      continue;
    const std::size_t before = done;
    while (done < others && is_behind((*view.others)[done], item.place)) ++done;
    if (batches.empty() || batches.back().mesh != item.mesh || batches.back().texture != item.texture ||
        batches.back().solid != item.solid || done != before)
      batches.push_back({item.mesh, item.texture, item.solid, item.place, instances.size(), 0});
    ++batches.back().count;
    batches.back().pixels += static_cast<double>(item.pixels);
    instances.push_back(packed(scene.instances[item.number], item.number, view.ground));
  }
}

}  // namespace

Place place_of(const Lens& lens, const std::vector<float>& sheets, const Vector3f& middle) {
  Place place{0, (lens.eye - middle).dot(lens.back)};
  if (sheets.empty()) return place;
  constexpr float kFar = std::numeric_limits<float>::infinity();
  const float eye = lens.orthographic ? (lens.back.z() < 0 ? -kFar : kFar) : lens.eye.z();
  const auto first = std::upper_bound(sheets.begin(), sheets.end(), std::min(eye, middle.z()));
  const auto end = std::lower_bound(sheets.begin(), sheets.end(), std::max(eye, middle.z()));
  if (first < end) place.planes = 2 * static_cast<std::uint32_t>(end - first);
  return place;
}

Batches batch(const Scene& scene, const BatchView& view, Wanted wanted, const SceneInstance* without) {
  const std::vector<float> none;
  std::vector<Item> opaque, transparent;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const SceneInstance& instance = scene.instances[i];
    if (instance.color.w() <= 0 || &instance == without || (wanted && !wanted(instance))) continue;
    const SceneMesh& mesh = scene.meshes[instance.mesh];
    if (mesh.indices.empty()) continue;
    const Vector3f center = instance.transform.col(3);
    const Place place = view.lens ? place_of(*view.lens, view.sheets ? *view.sheets : none, center) : Place();
    const bool solid = instance.color.w() >= kOpaque;
    const bool holes = instance.texture != kNoTexture && scene.textures[instance.texture].clear;
    const Item item{mesh_for(instance, mesh, view), instance.texture, i, solid, place, pixels_of(instance, mesh, view)};
    (solid && !holes ? opaque : transparent).push_back(item);
  }
  // The nearest first: what is behind them need not be shaded.
  std::stable_sort(opaque.begin(), opaque.end(), [&](const Item& a, const Item& b) {
    if (a.mesh != b.mesh) return a.mesh < b.mesh;
    if (a.texture != b.texture) return a.texture < b.texture;
    return view.by_distance && a.place.away < b.place.away;
  });
  if (view.by_distance)
    std::stable_sort(transparent.begin(), transparent.end(),
                     [](const Item& a, const Item& b) { return is_behind(a.place, b.place); });
  Batches batches;
  batches.instances.reserve(opaque.size() + transparent.size());
  collect(scene, opaque, true, view, batches.instances, batches.opaque);
  collect(scene, transparent, false, view, batches.instances, batches.transparent);
  return batches;
}

}  // namespace breve::render
