// Pixels in memory, their snapshot, and how well they deflate.
#include "runtime/store/image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/base/error.hpp"

namespace breve {

Image::Image(int width, int height, std::pmr::memory_resource* memory) : pixels_(memory) {
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) {
    throw Error(ErrorCode::Argument,
                fmt::format("an image has the size {} x {} (each side must be from 1 to {})", width, height, kMaxSide));
  }
  pixels_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4, 0);
  for (std::size_t i = 3; i < pixels_.size(); i += 4) pixels_[i] = 255;
  width_ = width;
  height_ = height;
  changed_ = true;
}

std::size_t Image::at(int x, int y, Channel channel) const {
  if (!holds(x, y)) {
    throw Error(ErrorCode::Argument, fmt::format("pixel ({}, {}) is outside an image of {} x {} (indices start at 0)",
                                                 x, y, width_, height_));
  }
  const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  return pixel * 4 + static_cast<std::size_t>(channel);
}

void Image::set(int x, int y, Channel channel, double value) {
  const double level = value > 0 ? std::min(value, 1.0) : 0;
  set_byte(x, y, channel, static_cast<std::uint8_t>(std::lround(level * 255)));
}

void Image::set_byte(int x, int y, Channel channel, std::uint8_t value) {
  pixels_[at(x, y, channel)] = value;
  changed_ = true;
}

std::span<std::uint8_t> Image::row(int y) {
  const std::size_t begin = at(0, y, Channel::Red);
  changed_ = true;
  return std::span(pixels_).subspan(begin, 4 * static_cast<std::size_t>(width_));
}

void Image::set_bytes(std::span<const std::uint8_t> bytes) {
  if (bytes.size() != pixels_.size()) {
    throw Error(ErrorCode::Argument, fmt::format("{} bytes for an image of {} x {} (must be {})", bytes.size(), width_,
                                                 height_, pixels_.size()));
  }
  std::copy(bytes.begin(), bytes.end(), pixels_.begin());
  changed_ = true;
}

void Image::save(ByteWriter& out) const {
  out.put(static_cast<std::int32_t>(width_));
  out.put(static_cast<std::int32_t>(height_));
  out.put(changed_);
  out.raw(pixels_.data(), pixels_.size());
}

Image Image::load(ByteReader& in) {
  const auto width = in.get<std::int32_t>(), height = in.get<std::int32_t>();
  const bool changed = in.get_bool();
  Image image(in.memory());
  if (width != 0 || height != 0) {
    if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) ByteReader::fail();
    // Asked first: a damaged size must not make us allocate more than the image holds.
    if (static_cast<std::size_t>(width) * static_cast<std::size_t>(height) > in.left() / 4) ByteReader::fail();
    image = Image(width, height, in.memory());
    in.raw(image.pixels_.data(), image.pixels_.size());
  }
  image.changed_ = changed;
  return image;
}

void Image::hash(Hasher& hasher) const {
  hasher.add(static_cast<std::uint64_t>(width_));
  hasher.add(static_cast<std::uint64_t>(height_));
  hasher.add(static_cast<std::uint64_t>(changed_));
  hasher.add(std::string_view(reinterpret_cast<const char*>(pixels_.data()), pixels_.size()));
}

}  // namespace breve
