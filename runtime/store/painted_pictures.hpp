// Pictures that the library paints itself, so that a program which names one of them never draws a blank.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "runtime/store/image.hpp"

namespace breve {

/// Their names. All but the star repeat without a seam.
///   checker, ground   greys, to be multiplied with the colour of a body
///   noise             coarse and fine greys
///   clouds, sky       white clouds on blue; the sky is paler and has fewer
///   star              a soft white spark on nothing, for bitmaps and light maps
inline constexpr std::array<std::string_view, 6> kPatterns{"checker", "ground", "noise", "clouds", "sky", "star"};

/// The work of painting it, in units of Meter.
std::uint64_t pattern_work(std::string_view name);
/// The pattern of that name: the same pixels on every machine. Empty if there is none.
Image paint_pattern(std::string_view name, std::pmr::memory_resource* memory = std::pmr::get_default_resource());

/// The pattern that stands in for a picture file which is not there: "images/clouds.png" is `clouds`, whatever the
/// folder that `images` lies in and the ending. Empty if the file is not in a folder `images`, or no pattern has its
/// name.
std::optional<std::string_view> pattern_of_file(std::string_view file);

}  // namespace breve
