// The meshes and textures in the graphics processor's memory. They are uploaded when they are new or have changed.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "runtime/base/poll.hpp"
#include "runtime/render/gl.hpp"
#include "runtime/scene/scene.hpp"

namespace breve::render {

/// A name that OpenGL gave, given back at the end.
class Buffer {
 public:
  explicit Buffer(const Gl& gl) : gl_(gl) { gl_.GenBuffers(1, &name_); }
  ~Buffer() { gl_.DeleteBuffers(1, &name_); }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  unsigned name() const { return name_; }
  /// Bound to `target`, with these bytes; null: with so much room.
  void fill(unsigned target, const void* bytes, std::size_t size, unsigned usage) const;
  /// Bytes of what is bound to `target`, from `begin` on.
  void put(unsigned target, std::size_t begin, const void* bytes, std::size_t size) const;

 private:
  const Gl& gl_;
  unsigned name_ = 0;
};

class VertexArray {
 public:
  explicit VertexArray(const Gl& gl) : gl_(gl) { gl_.GenVertexArrays(1, &name_); }
  ~VertexArray() { gl_.DeleteVertexArrays(1, &name_); }
  VertexArray(const VertexArray&) = delete;
  VertexArray& operator=(const VertexArray&) = delete;
  void bind() const { gl_.BindVertexArray(name_); }

 private:
  const Gl& gl_;
  unsigned name_ = 0;
};

/// One instance as the shaders read it.
struct GpuInstance {
  Vector4f row0, row1, row2, color, extra;  // extra: texture scale x and y, lit (2: a fixed body), layer
};

/// A mesh with its own vertices; instances come from a buffer that all meshes share.
class MeshBuffer {
 public:
  MeshBuffer(const Gl& gl, const SceneMesh& mesh, const Poll& poll = {});
  /// Draws `count` instances, from the one that stands at `first` in `instances`.
  void draw(const Buffer& instances, std::size_t first, std::size_t count) const {
    draw_part(instances, first, count, 0, triangles());
  }
  /// So many triangles of them, from number `from` on.
  void draw_part(const Buffer& instances, std::size_t first, std::size_t count, std::size_t from,
                 std::size_t triangles) const;
  std::uint64_t revision() const { return revision_; }
  std::size_t triangles() const { return static_cast<std::size_t>(indices_) / 3; }
  bool tinted() const { return tinted_; }
  bool two_sided() const { return two_sided_; }

 private:
  const Gl& gl_;
  VertexArray array_;
  Buffer vertices_, order_;
  int indices_ = 0;
  std::uint64_t revision_ = 0;
  bool tinted_ = false, two_sided_ = false;
};

/// The attributes of instances, from 4 on, as they stand in the bound buffer from `offset` on. @param count  of them
void point_at_instances(const Gl& gl, std::size_t offset, int count, std::size_t stride);

class TextureBuffer {
 public:
  enum class Kind { Tiles, Cells, Letters };
  TextureBuffer(const Gl& gl, Kind kind, int width, int height, const std::uint8_t* pixels, std::uint64_t revision);
  ~TextureBuffer() { gl_.DeleteTextures(1, &name_); }
  TextureBuffer(const TextureBuffer&) = delete;
  TextureBuffer& operator=(const TextureBuffer&) = delete;
  void bind(unsigned unit) const;
  std::uint64_t revision() const { return revision_; }

 private:
  const Gl& gl_;
  unsigned name_ = 0;
  std::uint64_t revision_;
};

}  // namespace breve::render
