// Heights between the points of a raster.
#include "runtime/store/height_raster.hpp"

#include <algorithm>
#include <cmath>

namespace breve {

double HeightRaster::at(double column, double row) const {
  const auto value = [&](int x, int y) {
    const auto inside_x = static_cast<std::size_t>(std::clamp(x, 0, columns - 1));
    const auto inside_y = static_cast<std::size_t>(std::clamp(y, 0, rows - 1));
    return static_cast<double>(values[inside_y * static_cast<std::size_t>(columns) + inside_x]);
  };
  const int left = static_cast<int>(std::floor(column)), top = static_cast<int>(std::floor(row));
  const double across = column - left, down = row - top;
  return (1 - down) * ((1 - across) * value(left, top) + across * value(left + 1, top)) +
         down * ((1 - across) * value(left, top + 1) + across * value(left + 1, top + 1));
}

}  // namespace breve
