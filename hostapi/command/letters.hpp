// Letters of DejaVu Sans as an image: for the window.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace breve::command {

class Letters {
 public:
  struct Glyph {
    int x = 0, y = 0, width = 0, height = 0;  // in the image
    float left = 0, top = 0, advance = 0;     // pixels from the pen, which is on the baseline
  };

  /// @param size  pixels of an em, at most 24
  /// @throws std::runtime_error if the font is not installed
  explicit Letters(float size);
  static constexpr int kWidth = 512, kHeight = 512;
  const std::vector<std::uint8_t>& cover() const { return cover_; }  // kWidth x kHeight: 0 nothing, 255 ink
  /// '?' for characters beyond Latin-1.
  const Glyph& glyph(std::uint32_t character) const;
  float width_of(std::string_view words) const;

 private:
  static constexpr std::uint32_t kFirst = 32, kCount = 224;  // Latin-1
  std::vector<std::uint8_t> cover_;
  std::array<Glyph, kCount> glyphs_{};
};

/// Takes the next character of UTF-8; malformed bytes are '?'.
std::uint32_t next_character(std::string_view& words);

}  // namespace breve::command
