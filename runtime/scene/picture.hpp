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

/// A rectangle of a picture, in pixels from its upper left corner. It may reach beyond the picture.
struct PicturePart {
  int left = 0, top = 0, width = 0, height = 0;
};

}  // namespace breve
