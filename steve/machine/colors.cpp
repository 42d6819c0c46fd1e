// Colours: red, green and blue to hue, saturation and value and back (Smith 1978), and a sequence of different ones.
#include <algorithm>
#include <cmath>

#include "steve/machine/functions.hpp"

namespace breve::steve {

Vector3 rgb_to_hsv(const Vector3& rgb) {
  const double value = rgb.maxCoeff(), chroma = value - rgb.minCoeff();
  if (chroma == 0 || value == 0) return {-1, 0, value};
  double sixth = 0;
  if (rgb[0] == value)
    sixth = (rgb[1] - rgb[2]) / chroma;
  else if (rgb[1] == value)
    sixth = 2 + (rgb[2] - rgb[0]) / chroma;
  else
    sixth = 4 + (rgb[0] - rgb[1]) / chroma;
  const double hue = 60 * sixth;
  return {hue < 0 ? hue + 360 : hue, chroma / value, value};
}

Vector3 hsv_to_rgb(const Vector3& hsv) {
  const double saturation = hsv[1], value = hsv[2];
  if (saturation == 0 || !std::isfinite(hsv[0])) return {value, value, value};
  double hue = std::fmod(hsv[0], 360.0);
  if (hue < 0) hue += 360;
  const double sixth = hue / 60;
  const int sector = std::min(static_cast<int>(sixth), 5);
  const double f = sixth - sector;
  const double low = value * (1 - saturation);
  const double falling = value * (1 - saturation * f);
  const double rising = value * (1 - saturation * (1 - f));
  switch (sector) {
    case 0: return {value, rising, low};
    case 1: return {falling, value, low};
    case 2: return {low, value, rising};
    case 3: return {low, falling, value};
    case 4: return {rising, low, value};
    default: return {value, low, falling};
  }
}

// Eight hues, then darker, then paler, then the hues between.
Vector3 unique_color(std::int32_t n) {
  if (n <= 0) return {0, 0, 0};
  if (n == 1) return {1, 1, 1};
  const std::int32_t k = n - 2, m = k % 96;
  const std::int32_t round = k / 96, shade = m % 32 / 8;
  const double hue = 40.0 * (k % 8) + 20.0 * round;
  const double saturation = m < 32 ? 1.0 : m < 64 ? 0.4 : 0.2;
  const double value = 1 - 0.2 * shade;
  return hsv_to_rgb({hue, saturation, value});
}

}  // namespace breve::steve
