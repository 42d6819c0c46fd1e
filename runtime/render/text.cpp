// FreeType.
#include "runtime/render/text.hpp"

#include <freetype/freetype.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "runtime/base/error.hpp"

namespace breve::render {

namespace {

constexpr const char* kDefaultFonts[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                         "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                                         "/usr/share/fonts/TTF/DejaVuSans.ttf"};

}  // namespace

struct Font::Library {
  FT_Library library = nullptr;
  FT_Face face = nullptr;

  explicit Library(const std::string& file) {
    if (FT_Init_FreeType(&library) != 0) throw Error(ErrorCode::Memory, "FreeType does not start");
    if (FT_New_Face(library, file.c_str(), 0, &face) != 0) {
      FT_Done_FreeType(library);
      throw Error(ErrorCode::File, "'" + file + "' is not a font that can be used");
    }
  }
  ~Library() {
    FT_Done_Face(face);
    FT_Done_FreeType(library);
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
};

Font::Font(const std::string& file) : image_(static_cast<std::size_t>(kSide) * kSide, 0) {
  if (!file.empty()) {
    library_ = std::make_unique<Library>(file);
    return;
  }
  std::error_code nothing;
  for (const char* name : kDefaultFonts)
    if (!library_ && std::filesystem::exists(name, nothing)) library_ = std::make_unique<Library>(name);
}

Font::~Font() = default;

std::uint32_t next_code(std::string_view& utf8) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(utf8[i]); };
  const unsigned char first = byte(0);
  const std::size_t size = first < 0x80   ? 1
                           : first < 0xc2 ? 0
                           : first < 0xe0 ? 2
                           : first < 0xf0 ? 3
                           : first < 0xf5 ? 4
                                          : 0;
  bool good = size != 0 && utf8.size() >= size;
  std::uint32_t code = size == 1 ? first : first & (0x7fU >> size);
  for (std::size_t i = 1; good && i < size; ++i) {
    good = (byte(i) & 0xc0) == 0x80;
    code = code << 6 | (byte(i) & 0x3fU);
  }
  utf8.remove_prefix(good ? size : 1);
  return good ? code : first;
}

void Font::start_again() {
  glyphs_.clear();
  std::fill(image_.begin(), image_.end(), std::uint8_t{0});
  pen_x_ = pen_y_ = 1;
  row_height_ = 0;
}

const Font::Glyph& Font::glyph(std::uint32_t code, int size) {
  const auto known = glyphs_.find({size, code});
  if (known != glyphs_.end()) return known->second;
  FT_Set_Pixel_Sizes(library_->face, 0, static_cast<FT_UInt>(size));
  Glyph& made = glyphs_[{size, code}];
  if (FT_Load_Char(library_->face, code, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0) return made;
  const FT_GlyphSlot slot = library_->face->glyph;
  const auto width = static_cast<int>(slot->bitmap.width), height = static_cast<int>(slot->bitmap.rows);
  made.advance = static_cast<float>(slot->advance.x) / 64;
  made.left = slot->bitmap_left;
  made.top = slot->bitmap_top;
  if (pen_x_ + width + 1 > kSide) {
    pen_x_ = 1;
    pen_y_ += row_height_ + 1;
    row_height_ = 0;
  }
  if (width > kSide - 2 || pen_y_ + height + 1 > kSide) return made;  // no room: it leaves a gap
  made.x = pen_x_;
  made.y = pen_y_;
  made.width = width;
  made.height = height;
  for (int y = 0; y < height; ++y)
    std::memcpy(&image_[static_cast<std::size_t>(made.y + y) * kSide + static_cast<std::size_t>(made.x)],
                slot->bitmap.buffer + y * slot->bitmap.pitch, static_cast<std::size_t>(width));
  pen_x_ += width + 1;
  row_height_ = std::max(row_height_, height);
  ++revision_;
  return made;
}

float Font::lay(std::string_view utf8, int size, float x, float y, std::vector<Letter>& letters) {
  if (!library_) return 0;
  constexpr std::size_t kMostGlyphs = 2000;
  if (glyphs_.size() > kMostGlyphs && letters.empty()) start_again();
  size = std::clamp(size, 4, 200);
  const float begin = x;
  while (!utf8.empty()) {
    const Glyph& one = glyph(next_code(utf8), size);
    if (one.width > 0)
      letters.push_back({std::round(x) + static_cast<float>(one.left), std::round(y) - static_cast<float>(one.top),
                         static_cast<float>(one.width), static_cast<float>(one.height),
                         static_cast<float>(one.x) / kSide, static_cast<float>(one.y) / kSide,
                         static_cast<float>(one.width) / kSide, static_cast<float>(one.height) / kSide});
    x += one.advance;
  }
  return x - begin;
}

}  // namespace breve::render
