// Fills a scene anew for each moment, and keeps what stays: meshes, textures, room.
#pragma once

#include <map>
#include <optional>
#include <span>

#include "runtime/base/poll.hpp"
#include "runtime/scene/mesh_cache.hpp"

namespace breve {

/// Numbers that are too large to be drawn, or not finite, become a large one: nothing that is drawn feeds the world.
float drawable(double number);
Vector3f drawable(const Vector3& v);
Vector4f color_of(const Vector3& color, double alpha);

class SceneBuilder {
 public:
  SceneBuilder() : meshes_(scene_.meshes) {}
  SceneBuilder(const SceneBuilder&) = delete;
  SceneBuilder& operator=(const SceneBuilder&) = delete;

  /// Called by what fills the scene. If it throws, the builder can only be destroyed.
  Poll poll{};

  const Scene& scene() const { return scene_; }
  Scene& scene() { return scene_; }

  void begin();
  void end();
  MeshUse mesh(const Shape& shape) { return meshes_.find(shape, poll); }
  SceneMesh& mesh_data(std::uint32_t mesh) { return scene_.meshes[mesh]; }
  /// A picture's number; its pixels are copied if they are others than before.
  std::uint32_t texture(ObjectId image, int width, int height, std::span<const std::uint8_t> rgba);
  /// The revision that a texture of these pixels has.
  std::uint64_t texture_revision(int width, std::span<const std::uint8_t> rgba) const;
  /// That of the pattern which floors have, once whoever fills the scene has needed it.
  std::optional<std::uint64_t> ground_pattern;
  /// Pixels of cells likewise get another revision when they are others.
  std::uint64_t revision_of(std::span<const std::uint8_t> bytes) const;
  /// Is one of these pixels not opaque?
  static bool is_clear(std::span<const std::uint8_t> rgba);
  /// The edges of a box.
  void add_box(const Vector3f& low, const Vector3f& high, const Vector4f& color);

 private:
  Scene scene_;
  MeshCache meshes_;
  std::map<std::uint32_t, std::uint32_t> texture_of_;  // by the index of the image's object
  std::vector<bool> texture_used_;
};

}  // namespace breve
