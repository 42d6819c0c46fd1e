// PNG files (Portable Network Graphics, second edition, W3C 2003), made row by row, and the compression below them.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "runtime/base/poll.hpp"

namespace breve {

enum class PngKind : std::uint8_t { Rgba8, Gray16 };

/// @param width,height  at least 1
/// @param row           writes row `y` into `bytes`, 4 or 2 for each pixel; numbers of 16 bits with the high byte first
std::string make_png(PngKind kind, int width, int height,
                     const std::function<void(std::size_t y, std::span<std::uint8_t> bytes)>& row, const Poll& poll);

/// How many bytes zlib makes of these.
std::size_t deflated_size(std::span<const std::uint8_t> bytes, const Poll& poll);

}  // namespace breve
