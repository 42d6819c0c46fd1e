// A picture of 8-bit RGBA pixels, row 0 on top; scripts see the channels as 0 ... 1.
#pragma once

#include <cstdint>
#include <functional>
#include <memory_resource>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/bytes.hpp"
#include "runtime/base/hasher.hpp"
#include "runtime/store/png.hpp"

namespace breve {

enum class Channel : std::uint8_t { Red, Green, Blue, Alpha };

class Image {
 public:
  static constexpr int kMaxSide = 32768;

  /// Empty. Its pixels will stand in `memory`, and so will those of an image assigned to it.
  explicit Image(std::pmr::memory_resource* memory = std::pmr::get_default_resource()) : pixels_(memory) {}
  /// Black and opaque. Error{Argument} unless both sides are from 1 to kMaxSide.
  Image(int width, int height, std::pmr::memory_resource* memory = std::pmr::get_default_resource());

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return pixels_.empty(); }
  bool holds(int x, int y) const { return x >= 0 && x < width_ && y >= 0 && y < height_; }

  /// Error{Argument} naming the place if it is outside. A written value is clamped to 0 ... 1 and rounded; NaN gives 0.
  double get(int x, int y, Channel channel) const { return byte(x, y, channel) / 255.0; }
  void set(int x, int y, Channel channel, double value);
  std::uint8_t byte(int x, int y, Channel channel) const { return pixels_[at(x, y, channel)]; }
  void set_byte(int x, int y, Channel channel, std::uint8_t value);

  /// Four bytes for each pixel of a row, to be written. Error{Argument} if there is no such row.
  std::span<std::uint8_t> row(int y);

  /// Pixels changed since the flag was last cleared; whoever draws clears it.
  bool changed() const { return changed_; }
  void clear_changed() { changed_ = false; }

  /// Rows from the top, 4 bytes a pixel.
  const std::pmr::vector<std::uint8_t>& bytes() const { return pixels_; }
  /// Replace all pixels; Error{Argument} unless there are 4 * width * height bytes.
  void set_bytes(std::span<const std::uint8_t> bytes);

  static constexpr std::size_t kMostFileBytes = std::size_t{256} << 20;
  /// The picture in the bytes of a PNG, JPEG or TGA file. Error{File} names the file, which is only a name here, and
  /// says why there is none.
  /// @param before  gets the size before the pixels are decoded, and may throw
  static Image parse(std::string_view bytes, const std::string& name,
                     std::pmr::memory_resource* memory = std::pmr::get_default_resource(),
                     const std::function<void(int width, int height)>& before = {});
  /// The bytes of a PNG file. Error{Argument} if the image is empty.
  std::string png(const Poll& poll = {}) const;
  /// Bytes of the pixels after deflation: a measure of how regular the picture is.
  std::size_t deflated_size(const Poll& poll = {}) const { return breve::deflated_size(pixels_, poll); }

  void save(ByteWriter& out) const;
  static Image load(ByteReader& in);  // Error{Image}
  void hash(Hasher& hasher) const;

 private:
  std::size_t at(int x, int y, Channel channel) const;

  std::pmr::vector<std::uint8_t> pixels_;  // first: an assignment that finds no memory for them changes nothing
  int width_ = 0, height_ = 0;
  bool changed_ = false;
};

/// The bytes of a 16-bit grayscale PNG, rows from the top: 0 is black, 1 white; values are clamped, NaN is black.
/// Error{Argument} unless there are width * height values (sides as for Image).
std::string gray16_png(int width, int height, std::span<const double> values, const Poll& poll = {});

}  // namespace breve
