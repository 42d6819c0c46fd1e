// A picture of a scene, with the distance of each of its pixels.
#pragma once

#include <cstdint>
#include <vector>

namespace breve {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // rows from the top, 4 bytes a pixel
  std::vector<float> depth;        // of each pixel, length units along the line of sight; infinite where nothing is
};

}  // namespace breve
