// Meshes and textures are uploaded once, and again when their revision is another.
#include <string_view>

#include "runtime/render/work.hpp"
#include "runtime/scene/mesh.hpp"

namespace breve::render {

const MeshBuffer& Renderer::Work::mesh(const Scene& scene, std::uint32_t number) {
  std::unique_ptr<MeshBuffer>& kept = meshes[number];
  if (number == kDiscMesh) {
    if (!kept) {
      SceneMesh square;
      square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
      square.normals.assign(4, Vector3f(0, 0, 1));
      square.uvs.assign(4, Eigen::Vector2f(0, 0));
      square.indices = {0, 1, 2, 0, 2, 3};
      square.two_sided = true;
      kept = std::make_unique<MeshBuffer>(context.gl(), square);
      ++counters.uploads;
    }
    return *kept;
  }
  if (number >= kSphereMesh) {
    if (!kept) {
      kept = std::make_unique<MeshBuffer>(context.gl(), make_sphere_mesh(static_cast<int>(number - kSphereMesh) + 1));
      ++counters.uploads;
    }
    return *kept;
  }
  if (!kept || kept->revision() != scene.meshes[number].revision) {
    kept = std::make_unique<MeshBuffer>(context.gl(), scene.meshes[number], poll());
    ++counters.uploads;
  }
  return *kept;
}

void Renderer::Work::bind_texture(const Scene& scene, std::uint32_t number, unsigned unit) {
  if (number == kNoTexture) return;
  const SceneTexture& texture = scene.textures[number];
  if (texture.rgba.empty()) return;
  std::unique_ptr<TextureBuffer>& kept = textures[number];
  if (!kept || kept->revision() != texture.revision) {
    kept = std::make_unique<TextureBuffer>(context.gl(), TextureBuffer::Kind::Tiles, texture.width, texture.height,
                                           texture.rgba.data(), texture.revision);
    ++counters.uploads;
  }
  kept->bind(unit);
}

}  // namespace breve::render
