// A scene is cleared, filled and tidied.
#include "runtime/scene/scene_builder.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/base/hasher.hpp"

namespace breve {

float drawable(double number) {
  constexpr double kMost = 1e18;  // its square is a float
  if (!(number == number)) return static_cast<float>(kMost);
  return static_cast<float>(std::clamp(number, -kMost, kMost));
}

Vector3f drawable(const Vector3& v) { return {drawable(v.x()), drawable(v.y()), drawable(v.z())}; }

Vector4f color_of(const Vector3& color, double alpha) {
  const auto part = [](double value) { return value > 0 ? static_cast<float>(std::min(value, 1.0)) : 0.0F; };
  return {part(color.x()), part(color.y()), part(color.z()), part(alpha)};
}

void SceneBuilder::begin() {
  scene_.instances.clear();
  scene_.lines.clear();
  scene_.triangles.clear();
  scene_.sprites.clear();
  scene_.sheets.clear();
  scene_.labels.clear();
  scene_.texts.clear();
  scene_.plots.clear();
  scene_.arrows.clear();
  scene_.cameras.clear();
  scene_.lights.clear();
  scene_.backdrop = SceneBackdrop();
  meshes_.begin();
  texture_used_.assign(scene_.textures.size(), false);
}

void SceneBuilder::end() {
  meshes_.end();
  for (std::size_t i = 0; i < scene_.textures.size(); ++i) {
    if (texture_used_[i] || scene_.textures[i].rgba.empty()) continue;
    texture_of_.erase(scene_.textures[i].image.index);
    scene_.textures[i] = SceneTexture();
  }
}

std::uint64_t SceneBuilder::revision_of(std::span<const std::uint8_t> bytes) const {
  Hasher hasher;
  hasher.add(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  return hasher.value();
}

std::uint32_t SceneBuilder::texture(ObjectId image, int width, int height, std::span<const std::uint8_t> rgba) {
  if (rgba.empty()) return kNoTexture;
  const auto known = texture_of_.find(image.index);
  std::uint32_t number = 0;
  if (known != texture_of_.end()) {
    number = known->second;
    if (texture_used_[number]) return number;
  } else {
    while (number < scene_.textures.size() && (texture_used_[number] || !scene_.textures[number].rgba.empty()))
      ++number;
    if (number == scene_.textures.size()) {
      scene_.textures.emplace_back();
      texture_used_.push_back(false);
    }
    texture_of_[image.index] = number;
  }
  texture_used_[number] = true;
  SceneTexture& texture = scene_.textures[number];
  const std::uint64_t revision = texture_revision(width, rgba);
  if (texture.revision != revision || texture.width != width || texture.height != height) {
    texture.rgba.assign(rgba.begin(), rgba.end());
    texture.width = width;
    texture.height = height;
    texture.revision = revision;
    texture.clear = is_clear(rgba);
  }
  texture.image = image;
  return number;
}

std::uint64_t SceneBuilder::texture_revision(int width, std::span<const std::uint8_t> rgba) const {
  return revision_of(rgba) ^ (static_cast<std::uint64_t>(width) << 40);
}

bool SceneBuilder::is_clear(std::span<const std::uint8_t> rgba) {
  for (std::size_t i = 3; i < rgba.size(); i += 4)
    if (rgba[i] != 255) return true;
  return false;
}

void SceneBuilder::add_box(const Vector3f& low, const Vector3f& high, const Vector4f& color) {
  const auto corner = [&](int bits) {
    return Vector3f((bits & 1) != 0 ? high.x() : low.x(), (bits & 2) != 0 ? high.y() : low.y(),
                    (bits & 4) != 0 ? high.z() : low.z());
  };
  for (int from = 0; from < 8; ++from)
    for (const int bit : {1, 2, 4})
      if ((from & bit) == 0) scene_.lines.push_back({corner(from), corner(from | bit), color});
}

}  // namespace breve
