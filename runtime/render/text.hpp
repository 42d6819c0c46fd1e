// Letters: a font by FreeType, its letters in one image, and where each stands in a line.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace breve::render {

/// A rectangle of the picture and the one of the letters' image that fills it; pixels from the top left.
struct Letter {
  float x, y, width, height;
  float from_x, from_y, from_width, from_height;
};

class Font {
 public:
  /// @param file  of TrueType or OpenType; empty: DejaVu Sans, where Debian has it
  /// @throws Error{File} if the file is not a font; without DejaVu no text is drawn
  explicit Font(const std::string& file);
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  /// The letters of a line whose baseline begins at (x, y).
  /// @param size  pixels of an em, 4 to 200
  /// @return  its width, pixels
  float lay(std::string_view utf8, int size, float x, float y, std::vector<Letter>& letters);

  static constexpr int kSide = 1024;
  const std::vector<std::uint8_t>& image() const { return image_; }  // kSide x kSide, one byte a pixel
  std::uint64_t revision() const { return revision_; }               // of the image

 private:
  struct Library;
  struct Glyph {
    int x = 0, y = 0, width = 0, height = 0;  // in the image
    int left = 0, top = 0;
    float advance = 0;
  };
  const Glyph& glyph(std::uint32_t code, int size);
  void start_again();
  std::unique_ptr<Library> library_;  // null: no font
  std::map<std::pair<int, std::uint32_t>, Glyph> glyphs_;
  std::vector<std::uint8_t> image_;
  int pen_x_ = 1, pen_y_ = 1, row_height_ = 0;
  std::uint64_t revision_ = 0;
};

/// The next code point of a text; a byte that is not valid UTF-8 stands for itself.
std::uint32_t next_code(std::string_view& utf8);

}  // namespace breve::render
