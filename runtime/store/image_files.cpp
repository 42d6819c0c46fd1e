// Pictures from and to the bytes of files by stb; 16-bit PNG, which stb does not write, is put together here.
#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "runtime/base/error.hpp"
#include "runtime/store/image.hpp"

// stb is compiled here and nowhere else, private to this file; it does not keep our warnings. Of its state, the reason
// of the last failure is kept by thread and read at once; the settings are never changed.
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
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace breve {

namespace {

[[noreturn]] void refuse_picture(const std::string& name, const char* why) {
  throw Error(ErrorCode::File, fmt::format("cannot read image file '{}': {}", name, why));
}

void put_big_endian(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// A chunk of a PNG file: length, type, data, CRC of type and data (PNG specification, 5.3).
void put_chunk(std::vector<std::uint8_t>& out, const char* type, std::span<const std::uint8_t> data) {
  put_big_endian(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = out.size();
  out.insert(out.end(), type, type + 4);
  out.insert(out.end(), data.begin(), data.end());
  put_big_endian(out, static_cast<std::uint32_t>(crc32(0, out.data() + start, static_cast<uInt>(out.size() - start))));
}

std::vector<std::uint8_t> deflated(const std::vector<std::uint8_t>& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::uint8_t> out(size);
  if (compress2(out.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), Z_DEFAULT_COMPRESSION) != Z_OK) {
    throw Error(ErrorCode::Memory, "no memory to deflate an image");
  }
  out.resize(size);
  return out;
}

}  // namespace

// The pixels are made before the file is decoded: an image that is too large for its world is refused early.
Image Image::parse(std::string_view bytes, const std::string& name, std::pmr::memory_resource* memory) {
  const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
  if (bytes.size() > kMostFileBytes) refuse_picture(name, "it is too large");
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0) refuse_picture(name, stbi_failure_reason());
  Image image(width, height, memory);
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(data, size, &width, &height, &channels, 4), &stbi_image_free);
  if (!pixels) refuse_picture(name, stbi_failure_reason());
  image.set_bytes({pixels.get(), image.pixels_.size()});
  return image;
}

std::string Image::png() const {
  if (empty()) throw Error(ErrorCode::Argument, "the image is empty");
  int size = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> png(
      stbi_write_png_to_mem(pixels_.data(), width_ * 4, width_, height_, 4, &size), &std::free);
  if (!png) throw Error(ErrorCode::Memory, "no memory to deflate an image");
  return {reinterpret_cast<const char*>(png.get()), static_cast<std::size_t>(size)};
}

std::string gray16_png(int width, int height, std::span<const double> values) {
  const Image sizes(width, height);  // checks them
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  if (values.size() != columns * rows) {
    throw Error(ErrorCode::Argument, fmt::format("{} values for a picture of {} x {}", values.size(), width, height));
  }
  std::vector<std::uint8_t> scanlines;
  scanlines.reserve(rows * (columns * 2 + 1));
  for (std::size_t y = 0; y < rows; ++y) {
    scanlines.push_back(0);  // no filter
    for (std::size_t x = 0; x < columns; ++x) {
      const double value = values[y * columns + x];
      const auto level = value > 0 ? static_cast<std::uint16_t>(std::lround(std::min(value, 1.0) * 65535)) : 0;
      scanlines.push_back(static_cast<std::uint8_t>(level >> 8));
      scanlines.push_back(static_cast<std::uint8_t>(level & 255));
    }
  }
  std::vector<std::uint8_t> png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  std::vector<std::uint8_t> header;
  put_big_endian(header, static_cast<std::uint32_t>(width));
  put_big_endian(header, static_cast<std::uint32_t>(height));
  header.insert(header.end(), {16, 0, 0, 0, 0});  // depth, gray, deflate, filters, no interlace
  put_chunk(png, "IHDR", header);
  put_chunk(png, "IDAT", deflated(scanlines));
  put_chunk(png, "IEND", {});
  return {png.begin(), png.end()};
}

}  // namespace breve
