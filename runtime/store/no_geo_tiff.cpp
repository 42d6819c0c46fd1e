// In place of geo_tiff.cpp where breve is built without GDAL.
#include <fmt/format.h>

#include "runtime/base/error.hpp"
#include "runtime/store/height_raster.hpp"

namespace breve {

HeightRaster HeightRaster::parse_geo_tiff(std::string_view, const std::string& name, const Poll&) {
  throw Error(
      ErrorCode::Unsupported,
      fmt::format("cannot read GeoTIFF file '{}': GeoTIFF files are not a part of this breve: it was built with "
                  "BREVE_WITH_GDAL=OFF (set-heights takes heights from an image)",
                  name));
}

}  // namespace breve
