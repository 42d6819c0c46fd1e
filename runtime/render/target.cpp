// Frame buffers.
#include "runtime/render/target.hpp"

#include <algorithm>
#include <string>

#include "runtime/base/error.hpp"

namespace breve::render {

Target::Target(const Gl& gl, int width, int height, int samples) : gl_(gl), width_(width), height_(height) {
  int most = 0, most_samples = 1;
  gl.GetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
  gl.GetIntegerv(GL_MAX_SAMPLES, &most_samples);
  if (width < 1 || height < 1 || width > most || height > most)
    throw Error(ErrorCode::Argument, "a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                                         " pixels cannot be drawn (each side must be from 1 to " +
                                         std::to_string(most) + ")");
  make_many(std::clamp(samples, 1, most_samples));
  make_one();
}

Target::~Target() {
  gl_.DeleteFramebuffers(1, &many_);
  gl_.DeleteFramebuffers(1, &one_);
  for (const unsigned* name : {&many_color_, &many_depth_, &one_depth_}) gl_.DeleteRenderbuffers(1, name);
  gl_.DeleteTextures(1, &one_color_);
}

void Target::check() const {
  if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE || gl_.GetError() != GL_NO_ERROR)
    throw Error(ErrorCode::Memory, "there is no memory for a picture of " + std::to_string(width_) + " x " +
                                       std::to_string(height_) + " pixels");
}

void Target::make_many(int samples) {
  const int kept = samples > 1 ? samples : 0;
  gl_.GenFramebuffers(1, &many_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, many_);
  gl_.GenRenderbuffers(1, &many_color_);
  gl_.BindRenderbuffer(GL_RENDERBUFFER, many_color_);
  gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, kept, GL_SRGB8_ALPHA8, width_, height_);
  gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, many_color_);
  gl_.GenRenderbuffers(1, &many_depth_);
  gl_.BindRenderbuffer(GL_RENDERBUFFER, many_depth_);
  gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, kept, GL_DEPTH_COMPONENT32F, width_, height_);
  gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, many_depth_);
  check();
}

void Target::make_one() {
  gl_.GenFramebuffers(1, &one_);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, one_);
  gl_.ActiveTexture(GL_TEXTURE0 + kScratchUnit);
  gl_.GenTextures(1, &one_color_);
  gl_.BindTexture(GL_TEXTURE_2D, one_color_);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, width_, height_, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, one_color_, 0);
  gl_.GenRenderbuffers(1, &one_depth_);
  gl_.BindRenderbuffer(GL_RENDERBUFFER, one_depth_);
  gl_.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width_, height_);
  gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, one_depth_);
  check();
}

void Target::bind() const { gl_.BindFramebuffer(GL_FRAMEBUFFER, many_); }

void Target::resolve() const {
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, many_);
  gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, one_);
  gl_.BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT,
                      GL_NEAREST);
}

void Target::bind_color(unsigned unit) const {
  gl_.ActiveTexture(GL_TEXTURE0 + unit);
  gl_.BindTexture(GL_TEXTURE_2D, one_color_);
}

namespace {

/// OpenGL's first row is the lowest one.
template <class Number>
void flip_rows(std::vector<Number>& numbers, std::size_t row, std::size_t rows) {
  for (std::size_t y = 0; y < rows / 2; ++y)
    std::swap_ranges(numbers.begin() + static_cast<std::ptrdiff_t>(y * row),
                     numbers.begin() + static_cast<std::ptrdiff_t>((y + 1) * row),
                     numbers.begin() + static_cast<std::ptrdiff_t>((rows - 1 - y) * row));
}

}  // namespace

void Target::read(std::vector<std::uint8_t>& rgba) const {
  const auto row = 4 * static_cast<std::size_t>(width_);
  rgba.resize(row * static_cast<std::size_t>(height_));
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, one_);
  gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_.ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = 255;  // blending has written something else there
  flip_rows(rgba, row, static_cast<std::size_t>(height_));
}

void Target::read_depth(std::vector<float>& depth) const {
  depth.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, one_);
  gl_.ReadPixels(0, 0, width_, height_, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
  flip_rows(depth, static_cast<std::size_t>(width_), static_cast<std::size_t>(height_));
}

ShadowTarget::ShadowTarget(const Gl& gl, int side) : gl_(gl), side_(side) {
  gl.ActiveTexture(GL_TEXTURE0 + kScratchUnit);
  gl.GenTextures(1, &texture_);
  gl.BindTexture(GL_TEXTURE_2D, texture_);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, side, side, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, nullptr);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  gl.GenFramebuffers(1, &frame_);
  gl.BindFramebuffer(GL_FRAMEBUFFER, frame_);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture_, 0);
  gl.DrawBuffer(GL_NONE);
  gl.ReadBuffer(GL_NONE);
}

ShadowTarget::~ShadowTarget() {
  gl_.DeleteFramebuffers(1, &frame_);
  gl_.DeleteTextures(1, &texture_);
}

void ShadowTarget::bind() const { gl_.BindFramebuffer(GL_FRAMEBUFFER, frame_); }

void ShadowTarget::bind_texture(unsigned unit) const {
  gl_.ActiveTexture(GL_TEXTURE0 + unit);
  gl_.BindTexture(GL_TEXTURE_2D, texture_);
}

}  // namespace breve::render
