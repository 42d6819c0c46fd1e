// Which instances are drawn in one call: those of one mesh with one texture. Transparent instances, and those whose
// texture has holes, are drawn from back to front; neighbours in that order share a call if they have the same mesh and
// texture.
#pragma once

#include <vector>

#include "runtime/render/buffers.hpp"
#include "runtime/scene/camera_math.hpp"

namespace breve::render {

/// Spheres are drawn by a mesh that is as fine as their size in the picture asks for.
inline constexpr std::uint32_t kSphereLevels = 4;
inline constexpr std::uint32_t kSphereMesh = 0xfffffff0U;  // of level i: kSphereMesh + i
/// Small spheres without a texture are a square that the shader shades as one.
inline constexpr std::uint32_t kDiscMesh = 0xffffffefU;

/// A less opaque body lets through what is behind it.
inline constexpr float kOpaque = 0.999F;

/// How far back something is. A sheet that is between two things decides, wherever their middles are: sheets lie in
/// planes of z, and what is on the eye's side of such a plane is never behind what is on the other side.
struct Place {
  std::uint32_t planes = 0;  // twice the number of clear sheets between it and the eye, and one more for a sheet
  float away = 0;            // of its middle from the eye, along the line of sight
};
inline bool is_behind(const Place& a, const Place& b) {
  return a.planes != b.planes ? a.planes > b.planes : a.away > b.away;
}

struct Batch {
  std::uint32_t mesh = 0, texture = kNoTexture;
  bool solid = true;  // of opaque colour: transparent by its texture alone, if at all
  Place place;        // of its first instance
  std::size_t first = 0, count = 0;
  double pixels = 0;  // that its instances cover together at most
};

struct Batches {
  std::vector<GpuInstance> instances;  // as they are uploaded
  std::vector<Batch> opaque, transparent;
};

struct BatchView {
  const Lens* lens = nullptr;
  float height = 0;                       // of the picture, pixels
  bool discs = true;                      // small spheres may be squares
  bool by_distance = true;                // transparent ones from back to front; of a flat world in order of creation
  const SceneInstance* ground = nullptr;  // null: none
  const std::vector<float>* sheets = nullptr;  // z of the clear sheets, in order
  const std::vector<Place>* others = nullptr;  // from back to front: transparent ones on both sides share no batch
};

/// @param sheets  z of the clear ones, in order
Place place_of(const Lens& lens, const std::vector<float>& sheets, const Vector3f& middle);

/// @param wanted  which instances; null: all
/// @param without  one that is left out; null: none
using Wanted = bool (*)(const SceneInstance& instance);
Batches batch(const Scene& scene, const BatchView& view, Wanted wanted = nullptr,
              const SceneInstance* without = nullptr);

}  // namespace breve::render
