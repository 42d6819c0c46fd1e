// stb_truetype.
#include "runtime/scene/letters.hpp"

#include <fstream>
#include <iterator>
#include <string>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

namespace breve {

namespace {

constexpr const char* kFonts[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                  "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                                  "/usr/share/fonts/TTF/DejaVuSans.ttf"};

}  // namespace

std::uint32_t next_character(std::string_view& words) {
  const auto first = static_cast<unsigned char>(words.front());
  words.remove_prefix(1);
  if (first < 0x80) return first;
  const std::size_t more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : 1;
  std::uint32_t character = first & (0x3fU >> more);
  for (std::size_t i = 0; i < more; ++i) {
    if (words.empty() || (static_cast<unsigned char>(words.front()) & 0xc0U) != 0x80U) return '?';
    character = character << 6 | (static_cast<unsigned char>(words.front()) & 0x3fU);
    words.remove_prefix(1);
  }
  return character;
}

Letters::Letters(float size) : cover_(std::size_t{kWidth} * kHeight) {
  std::string file;
  for (const char* name : kFonts)
    if (std::ifstream in(name, std::ios::binary); file.empty() && in)
      file.assign(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  if (file.empty()) return;
  std::vector<stbtt_bakedchar> baked(kCount);
  stbtt_BakeFontBitmap(reinterpret_cast<const unsigned char*>(file.data()), 0, size, cover_.data(), kWidth, kHeight,
                       kFirst, kCount, baked.data());
  for (std::size_t i = 0; i < kCount; ++i) {
    const stbtt_bakedchar& one = baked[i];
    glyphs_[i] = {one.x0, one.y0, one.x1 - one.x0, one.y1 - one.y0, one.xoff, one.yoff, one.xadvance};
  }
}

const Letters::Glyph& Letters::glyph(std::uint32_t character) const {
  return glyphs_[character >= kFirst && character < kFirst + kCount ? character - kFirst : '?' - kFirst];
}

float Letters::width_of(std::string_view words) const {
  float width = 0;
  while (!words.empty()) width += glyph(next_character(words)).advance;
  return width;
}

}  // namespace breve
