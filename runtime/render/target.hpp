// The target of drawing: a frame buffer with several samples a pixel, one with the resolved pixels, and the way back
// into main memory.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/render/gl.hpp"

namespace breve::render {

class Target {
 public:
  /// @param samples  of a pixel: 1, 2 or 4; as many as there are, if fewer
  /// @throws Error{Argument} for a size that OpenGL does not have
  Target(const Gl& gl, int width, int height, int samples);
  ~Target();
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  void bind() const;
  /// Reduces the samples of each pixel to one color and one depth. The depth is that of one sample.
  void resolve() const;
  void bind_color(unsigned unit) const;  // as a texture, once it is resolved
  /// Rows from the top.
  void read(std::vector<std::uint8_t>& rgba) const;
  void read_depth(std::vector<float>& depth) const;  // 0 near, 1 far

 private:
  void make_many(int samples);
  void make_one();
  void check() const;
  const Gl& gl_;
  int width_, height_;
  unsigned many_ = 0, many_color_ = 0, many_depth_ = 0;
  unsigned one_ = 0, one_color_ = 0, one_depth_ = 0;
};

/// Depth as a light sees it.
class ShadowTarget {
 public:
  ShadowTarget(const Gl& gl, int side);
  ~ShadowTarget();
  ShadowTarget(const ShadowTarget&) = delete;
  ShadowTarget& operator=(const ShadowTarget&) = delete;
  int side() const { return side_; }
  void bind() const;
  void bind_texture(unsigned unit) const;

 private:
  const Gl& gl_;
  int side_;
  unsigned frame_ = 0, texture_ = 0;
};

}  // namespace breve::render
