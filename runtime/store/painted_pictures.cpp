// Patterns from a hash of the place, not from the world's random numbers. Only operations that are exact everywhere are
// used, so that pixels, which a world's hash covers, are the same on every machine.
#include "runtime/store/painted_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace breve {

namespace {

constexpr int kSmallSide = 64, kSide = 128;  // pixels

void set_grey(Image& picture, int x, int y, std::uint8_t level) {
  for (const Channel channel : {Channel::Red, Channel::Green, Channel::Blue}) picture.set_byte(x, y, channel, level);
}

Image checker(std::pmr::memory_resource* memory) {
  constexpr int kField = kSmallSide / 8;
  constexpr std::uint8_t kLight = 255, kDark = 192;
  Image picture(kSmallSide, kSmallSide, memory);
  for (int y = 0; y < kSmallSide; ++y)
    for (int x = 0; x < kSmallSide; ++x) set_grey(picture, x, y, (x / kField + y / kField) % 2 == 0 ? kLight : kDark);
  return picture;
}

/// A coarse grain.
Image ground(std::pmr::memory_resource* memory) {
  constexpr std::uint8_t kDarkest = 176;
  constexpr std::uint32_t kGrains = 80;
  Image picture(kSmallSide, kSmallSide, memory);
  for (int y = 0; y < kSmallSide; ++y)
    for (int x = 0; x < kSmallSide; ++x) {
      std::uint32_t mixed = static_cast<std::uint32_t>(x) * 0x9e3779b1U + static_cast<std::uint32_t>(y) * 0x85ebca77U;
      mixed = (mixed ^ (mixed >> 15)) * 0x2c1b3c6dU;
      set_grey(picture, x, y, static_cast<std::uint8_t>(kDarkest + (mixed >> 16) % kGrains));
    }
  return picture;
}

/// 0 to 1.
double chance(std::uint32_t x, std::uint32_t y, std::uint32_t layer) {
  std::uint32_t mixed = x * 0x9e3779b1U + y * 0x85ebca77U + layer * 0xc2b2ae3dU;
  mixed = (mixed ^ (mixed >> 15)) * 0x2c1b3c6dU;
  mixed = (mixed ^ (mixed >> 12)) * 0x297a2d39U;
  return static_cast<double>((mixed ^ (mixed >> 15)) & 0xffffU) / 0xffffU;
}

double smooth(double t) { return t * t * (3 - 2 * t); }

/// Value noise with `cells` cells along a side, which repeats after the whole picture.
double noise(int x, int y, int cells, std::uint32_t layer) {
  const double fx = static_cast<double>(x) * cells / kSide, fy = static_cast<double>(y) * cells / kSide;
  const auto ix = static_cast<std::uint32_t>(fx), iy = static_cast<std::uint32_t>(fy);
  const auto count = static_cast<std::uint32_t>(cells);
  const std::uint32_t nx = (ix + 1) % count, ny = (iy + 1) % count;
  const double tx = smooth(fx - ix), ty = smooth(fy - iy);
  const double low = chance(ix, iy, layer) + tx * (chance(nx, iy, layer) - chance(ix, iy, layer));
  const double high = chance(ix, ny, layer) + tx * (chance(nx, ny, layer) - chance(ix, ny, layer));
  return low + ty * (high - low);
}

/// Noise of several sizes, 0 to 1. Each size has half the height of the one before.
double layers(int x, int y, int cells, int count) {
  double sum = 0, part = 1, all = 0;
  for (int i = 0; i < count; ++i, part /= 2, cells *= 2) {
    sum += part * noise(x, y, cells, static_cast<std::uint32_t>(i));
    all += part;
  }
  return sum / all;
}

struct Color {
  double red, green, blue, alpha;
};

Color grey(double level) { return {level, level, level, 1}; }

Color mix(const Color& a, const Color& b, double part) {
  const double t = std::clamp(part, 0.0, 1.0);
  return {a.red + t * (b.red - a.red), a.green + t * (b.green - a.green), a.blue + t * (b.blue - a.blue), 1};
}

Color clouds(int x, int y, const Color& blue, double least, double most) {
  return mix(blue, {1, 1, 1, 1}, smooth(std::clamp((layers(x, y, 4, 5) - least) / (most - least), 0.0, 1.0)));
}

/// A round core and four rays that fade towards the border.
Color star(int x, int y) {
  const double u = (2 * x + 1.0) / kSide - 1, v = (2 * y + 1.0) / kSide - 1;
  const double away = std::sqrt(u * u + v * v), left = std::max(0.0, 1 - away);
  const double core = left * left * left * left;
  const double across = std::max(0.0, 1 - 14 * std::min(std::abs(u), std::abs(v)));
  return {1, 1, 1, std::min(1.0, 1.15 * core + 0.8 * across * left * left)};
}

Color color_of(std::string_view name, int x, int y) {
  if (name == "noise") return grey(layers(x, y, 8, 5));
  if (name == "clouds") return clouds(x, y, {0.33, 0.55, 0.86, 1}, 0.40, 0.72);
  if (name == "sky") return clouds(x, y, {0.52, 0.72, 0.95, 1}, 0.52, 0.85);
  return star(x, y);
}

}  // namespace

std::uint64_t pattern_work(std::string_view name) {
  constexpr std::uint64_t kOfPixel = 5, kPlainPixelsOfUnit = 4;  // measured
  constexpr auto kPlain = static_cast<std::uint64_t>(kSmallSide * kSmallSide) / kPlainPixelsOfUnit;
  constexpr auto kOther = static_cast<std::uint64_t>(kSide * kSide) * kOfPixel;
  return name == "checker" || name == "ground" ? kPlain : kOther;
}

Image paint_pattern(std::string_view name, std::pmr::memory_resource* memory) {
  if (std::find(kPatterns.begin(), kPatterns.end(), name) == kPatterns.end()) return Image(memory);
  if (name == "checker") return checker(memory);
  if (name == "ground") return ground(memory);
  Image picture(kSide, kSide, memory);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const Color color = color_of(name, x, y);
      picture.set(x, y, Channel::Red, color.red);
      picture.set(x, y, Channel::Green, color.green);
      picture.set(x, y, Channel::Blue, color.blue);
      picture.set(x, y, Channel::Alpha, color.alpha);
    }
  return picture;
}

std::optional<std::string_view> pattern_of_file(std::string_view file) {
  const std::size_t slash = file.rfind('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const std::string_view folder = file.substr(0, slash);
  if (folder != "images" && !folder.ends_with("/images")) return std::nullopt;
  const std::string_view name = file.substr(slash + 1);
  const std::string_view stem = name.substr(0, name.rfind('.'));
  for (const std::string_view one : kPatterns)
    // Old programs write some in the singular and some in the plural.
    if (stem == one || (one.ends_with('s') && stem == one.substr(0, one.size() - 1)) ||
        (stem.ends_with('s') && stem.substr(0, stem.size() - 1) == one))
      return one;
  return std::nullopt;
}

}  // namespace breve
