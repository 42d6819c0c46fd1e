// The tables of the functions that scripts may call, by topic; `functions()` joins them.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "steve/machine/native.hpp"

namespace breve::steve {

std::span<const Native> math_functions();
std::span<const Native> object_functions();
std::span<const Native> world_functions();
std::span<const Native> file_functions();
std::span<const Native> sensor_functions();

/// Throws RunError{World}: the host does not let scripts do this.
/// @param what   "sleep"; "read the clock on the wall"
/// @param right  of breve_right
[[noreturn]] void refuse_right(std::string_view function, std::string_view what, std::string_view right);

/// Colours are red, green, blue in 0 to 1; hue in degrees 0 to 360, saturation and value in 0 to 1. A grey has hue -1.
Vector3 rgb_to_hsv(const Vector3& rgb);
Vector3 hsv_to_rgb(const Vector3& hsv);
/// Colour number n of a sequence of clearly different ones: 0 black, 1 white; negative numbers count as 0.
Vector3 unique_color(std::int32_t n);

}  // namespace breve::steve
