// Heights on a grid of any size, as files of elevations hold them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/poll.hpp"

namespace breve {

struct HeightRaster {
  static constexpr int kMostSide = 20'000;

  int columns = 0, rows = 0;
  std::vector<float> values;  // row by row, the northern one first

  /// The first band of a GeoTIFF file, from its bytes. Points without data have the least height that there is.
  /// Error{File} names the file, which is only a name here, and says why there are none; Error{Unsupported} if this
  /// breve was built without GDAL.
  static HeightRaster parse_geo_tiff(std::string_view bytes, const std::string& name, const Poll& poll);

  /// The height at a place in columns and rows, between the points linearly; outside, that of the rim.
  double at(double column, double row) const;
};

}  // namespace breve
