// Uploads.
#include "runtime/render/buffers.hpp"

#include <cstddef>

#include "runtime/base/in_pieces.hpp"

namespace breve::render {

namespace {

struct GpuVertex {
  Vector3f position, normal;
  Eigen::Vector2f uv;
  Vector3f tint;
};

const void* bytes_from(std::size_t offset) { return reinterpret_cast<const void*>(offset); }

}  // namespace

void Buffer::fill(unsigned target, const void* bytes, std::size_t size, unsigned usage) const {
  gl_.BindBuffer(target, name_);
  gl_.BufferData(target, static_cast<GLsizeiptr>(size), bytes, usage);
}

void Buffer::put(unsigned target, std::size_t begin, const void* bytes, std::size_t size) const {
  gl_.BufferSubData(target, static_cast<GLintptr>(begin), static_cast<GLsizeiptr>(size), bytes);
}

void point_at_instances(const Gl& gl, std::size_t offset, int count, std::size_t stride) {
  constexpr unsigned kFirst = 4;
  for (unsigned i = 0; i < static_cast<unsigned>(count); ++i) {
    gl.EnableVertexAttribArray(kFirst + i);
    gl.VertexAttribPointer(kFirst + i, 4, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                           bytes_from(offset + i * sizeof(Vector4f)));
    gl.VertexAttribDivisor(kFirst + i, 1);
  }
}

MeshBuffer::MeshBuffer(const Gl& gl, const SceneMesh& mesh, const Poll& poll)
    : gl_(gl),
      array_(gl),
      vertices_(gl),
      order_(gl),
      indices_(static_cast<int>(mesh.indices.size())),
      revision_(mesh.revision),
      tinted_(!mesh.colors.empty()),
      two_sided_(mesh.two_sided) {
  array_.bind();
  vertices_.fill(GL_ARRAY_BUFFER, nullptr, mesh.positions.size() * sizeof(GpuVertex), GL_STATIC_DRAW);
  std::vector<GpuVertex> piece;
  in_pieces(mesh.positions.size(), sizeof(GpuVertex), poll, [&](std::size_t begin, std::size_t end) {
    piece.clear();
    for (std::size_t i = begin; i < end; ++i)
      piece.push_back({mesh.positions[i], mesh.normals[i], mesh.uvs[i], tinted_ ? mesh.colors[i] : Vector3f(1, 1, 1)});
    vertices_.put(GL_ARRAY_BUFFER, begin * sizeof(GpuVertex), piece.data(), piece.size() * sizeof(GpuVertex));
  });
  const std::size_t offsets[] = {offsetof(GpuVertex, position), offsetof(GpuVertex, normal), offsetof(GpuVertex, uv),
                                 offsetof(GpuVertex, tint)};
  for (unsigned i = 0; i < 4; ++i) {
    gl.EnableVertexAttribArray(i);
    gl.VertexAttribPointer(i, i == 2 ? 2 : 3, GL_FLOAT, GL_FALSE, sizeof(GpuVertex), bytes_from(offsets[i]));
  }
  constexpr std::size_t kIndexBytes = sizeof(std::uint32_t);
  order_.fill(GL_ELEMENT_ARRAY_BUFFER, nullptr, mesh.indices.size() * kIndexBytes, GL_STATIC_DRAW);
  in_pieces(mesh.indices.size(), kIndexBytes, poll, [&](std::size_t begin, std::size_t end) {
    order_.put(GL_ELEMENT_ARRAY_BUFFER, begin * kIndexBytes, mesh.indices.data() + begin, (end - begin) * kIndexBytes);
  });
}

void MeshBuffer::draw_part(const Buffer& instances, std::size_t first, std::size_t count, std::size_t from,
                           std::size_t triangles) const {
  constexpr int kRows = 5;
  array_.bind();
  gl_.BindBuffer(GL_ARRAY_BUFFER, instances.name());
  point_at_instances(gl_, first * sizeof(GpuInstance), kRows, sizeof(GpuInstance));
  gl_.DrawElementsInstanced(GL_TRIANGLES, static_cast<GLsizei>(3 * triangles), GL_UNSIGNED_INT,
                            bytes_from(3 * from * sizeof(std::uint32_t)), static_cast<GLsizei>(count));
}

TextureBuffer::TextureBuffer(const Gl& gl, Kind kind, int width, int height, const std::uint8_t* pixels,
                             std::uint64_t revision)
    : gl_(gl), revision_(revision) {
  gl.ActiveTexture(GL_TEXTURE0 + kScratchUnit);
  gl.GenTextures(1, &name_);
  gl.BindTexture(GL_TEXTURE_2D, name_);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  if (kind == Kind::Letters)
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, pixels);
  else
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
  const bool mipmaps = kind != Kind::Letters;
  if (mipmaps) gl.GenerateMipmap(GL_TEXTURE_2D);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, kind == Kind::Tiles ? GL_LINEAR : GL_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, mipmaps ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST);
  const int wrap = kind == Kind::Tiles ? GL_REPEAT : GL_CLAMP_TO_EDGE;
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
}

void TextureBuffer::bind(unsigned unit) const {
  gl_.ActiveTexture(GL_TEXTURE0 + unit);
  gl_.BindTexture(GL_TEXTURE_2D, name_);
}

}  // namespace breve::render
