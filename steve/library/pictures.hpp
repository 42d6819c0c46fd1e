// Pictures of a world that its own scripts ask for.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "steve/machine/machine.hpp"

namespace breve::steve {

constexpr std::uint64_t kOfDeflation = 64;  // work for each pixel of a picture that is compressed

/// The view as it is now; null with a warning that names `selector` where nothing draws.
/// @param more  work that the caller does for each pixel: a picture that would exceed the budget is not begun
/// @param part  what the caller looks at; the other pixels are undefined
const DrawnView* draw_view(Machine& machine, std::string_view selector, std::uint64_t more = 0,
                           const ViewPart& part = {});

/// Depths as grays from 0, which is near, to 1. If they are not linear, a gray stands for the depth that a depth buffer
/// holds of a view from 0.1 on.
class DepthGrays {
 public:
  /// @throws Error{Argument} that names `selector` if `farthest` is not above 0.1
  DepthGrays(std::string_view selector, bool linear, double farthest);
  double of(float depth) const;

 private:
  const bool linear_;
  const double farthest_;
};

/// Write a file; false with a warning if that fails.
bool write_picture(Machine& machine, std::string_view selector, const std::string& name, std::string_view bytes);

/// Write the view as a PNG file. False with a warning that names `selector` if nothing draws this world, or the file
/// cannot be written.
bool write_view(Machine& machine, const std::string& name, std::string_view selector);

/// The same as "NAME_00012.png" for 12.
bool write_frame(Machine& machine, std::string_view name, std::int64_t number, std::string_view selector);

}  // namespace breve::steve
