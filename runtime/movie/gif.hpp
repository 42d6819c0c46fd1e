// Animated pictures in the format GIF89a (CompuServe 1990): a palette for each frame, and what stays the same left out.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace breve::movie {

class GifEncoder {
 public:
  /// Appends the head of the file. @param delay  of each frame, hundredths of a second
  GifEncoder(std::uint32_t width, std::uint32_t height, std::uint16_t delay, std::vector<std::uint8_t>& out);
  /// Appends one frame. @param rgba  rows from the top; alpha does not count
  void add(std::span<const std::uint8_t> rgba, std::vector<std::uint8_t>& out);
  static void end(std::vector<std::uint8_t>& out) { out.push_back(0x3b); }

 private:
  std::uint32_t width_, height_;
  std::uint16_t delay_;
  std::vector<std::uint8_t> last_;  // the frame before
};

}  // namespace breve::movie
