// Pictures from the bytes of files, by stb, and to those of PNG files.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "runtime/base/error.hpp"
#include "runtime/store/image.hpp"

// stb is compiled here and nowhere else, private to this file; it does not keep our warnings. It keeps the reason of
// the last failure by thread and read at once; the settings are never changed.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wextra"
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_TGA
#define STBI_MAX_DIMENSIONS 32768
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace breve {

namespace {

[[noreturn]] void refuse_picture(const std::string& name, const std::string& why) {
  throw Error(ErrorCode::File, fmt::format("cannot read image file '{}': {}", name, why));
}

/// The decoder's own reason is that of the last format it tried. The first bytes tell which format the file has.
std::string why_not(std::string_view bytes) {
  if (std::string_view(stbi_failure_reason()) == "too large") return "it is too large";
  if (bytes.empty()) return "it is empty";
  struct Format {
    std::string_view begin, name;
    bool read;
  };
  constexpr Format kFormats[] = {{"\x89PNG", "PNG", true},      {"\xff\xd8\xff", "JPEG", true},
                                 {"GIF8", "GIF", false},        {"BM", "BMP", false},
                                 {"RIFF", "WebP", false},       {{"II*\0", 4}, "TIFF", false},
                                 {{"MM\0*", 4}, "TIFF", false}, {"8BPS", "Photoshop", false}};
  for (const Format& format : kFormats) {
    if (!bytes.starts_with(format.begin)) continue;
    if (format.read)
      return fmt::format("it is a {} file that is damaged, cut off, or of a rare kind; save it anew", format.name);
    return fmt::format("it is a {} file; save it as PNG, JPEG or TGA", format.name);
  }
  return "it is not a PNG, JPEG or TGA file, or it is damaged";
}

}  // namespace

// The pixels are made before the file is decoded: an image that is too large for its world is refused early.
Image Image::parse(std::string_view bytes, const std::string& name, std::pmr::memory_resource* memory,
                   const std::function<void(int width, int height)>& before) {
  const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
  if (bytes.size() > kMostFileBytes) refuse_picture(name, "it is too large");
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0) refuse_picture(name, why_not(bytes));
  if (before) before(width, height);
  Image image(width, height, memory);
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(data, size, &width, &height, &channels, 4), &stbi_image_free);
  if (!pixels) refuse_picture(name, why_not(bytes));
  image.set_bytes({pixels.get(), image.pixels_.size()});
  return image;
}

std::string Image::png(const Poll& poll) const {
  if (empty()) throw Error(ErrorCode::Argument, "the image is empty");
  const std::size_t row_bytes = static_cast<std::size_t>(width_) * 4;
  return make_png(
      PngKind::Rgba8, width_, height_,
      [&](std::size_t y, std::span<std::uint8_t> row) {
        std::copy_n(pixels_.begin() + static_cast<std::ptrdiff_t>(y * row_bytes), row_bytes, row.begin());
      },
      poll);
}

std::string gray16_png(int width, int height, std::span<const double> values, const Poll& poll) {
  const Image sizes(width, height);  // checks them
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  if (values.size() != columns * rows) {
    throw Error(ErrorCode::Argument, fmt::format("{} values for a picture of {} x {}", values.size(), width, height));
  }
  return make_png(
      PngKind::Gray16, width, height,
      [&](std::size_t y, std::span<std::uint8_t> row) {
        for (std::size_t x = 0; x < columns; ++x) {
          const double value = values[y * columns + x];
          const auto level = value > 0 ? static_cast<std::uint16_t>(std::lround(std::min(value, 1.0) * 65535)) : 0;
          row[2 * x] = static_cast<std::uint8_t>(level >> 8);
          row[2 * x + 1] = static_cast<std::uint8_t>(level & 255);
        }
      },
      poll);
}

}  // namespace breve
