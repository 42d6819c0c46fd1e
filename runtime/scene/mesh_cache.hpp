// Which mesh shows a shape. Shapes that look alike share one, so that a renderer draws them in one call.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "runtime/base/poll.hpp"
#include "runtime/scene/scene.hpp"
#include "runtime/solid/shape.hpp"

namespace breve {

struct MeshUse {
  std::uint32_t mesh = 0;
  Vector3f scale = Vector3f::Ones();  // of the mesh, to be the shape
};

class MeshCache {
 public:
  static constexpr std::uint32_t kSphere = 0, kBox = 1;  // these two are always there

  explicit MeshCache(std::deque<SceneMesh>& meshes);

  /// A new moment begins. What it does not use until `end` is dropped then.
  void begin();
  MeshUse find(const Shape& shape, const Poll& poll);
  void end();

 private:
  struct Entry {
    std::uint64_t key = 0;
    bool used = false;
  };
  template <class Make>
  std::uint32_t kept(std::uint64_t key, Make make);
  std::uint32_t of_polygons(const Shape& shape);
  std::uint32_t of_surface(const Shape& shape, const Poll& poll);

  std::deque<SceneMesh>& meshes_;
  std::vector<Entry> entries_;                     // of each mesh
  std::map<std::uint64_t, std::uint32_t> by_key_;  // a digest of what a mesh is made of
  std::map<const Shape*, MeshUse> seen_;           // in this moment: many bodies share a shape
  std::uint64_t revisions_ = 0;
};

}  // namespace breve
