// GeoTIFF files are read by GDAL, which is seen here and nowhere else. It reads from memory, may use no other driver,
// and opens no file.
#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "runtime/base/error.hpp"
#include "runtime/store/height_raster.hpp"

namespace breve {

namespace {

[[noreturn]] void refuse_raster(const std::string& name, std::string_view why) {
  throw Error(ErrorCode::File, fmt::format("cannot read GeoTIFF file '{}': {}", name, why));
}

/// What GDAL says is kept for the error, not printed.
struct Quiet {
  Quiet() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~Quiet() { CPLPopErrorHandler(); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
};

/// The bytes as a file in memory, which no other thread has.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes) : path_(fmt::format("/vsimem/breve/{}.tif", fmt::ptr(this))) {
    // GDAL reads through a pointer that is not const, and does not write.
    auto* const data = reinterpret_cast<GByte*>(const_cast<char*>(bytes.data()));
    VSILFILE* const file = VSIFileFromMemBuffer(path_.c_str(), data, bytes.size(), FALSE);
    if (file) VSIFCloseL(file);
  }
  ~MemoryFile() { VSIUnlink(path_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  const char* path() const { return path_.c_str(); }

 private:
  std::string path_;
};

struct Close {
  void operator()(GDALDatasetH data) const { GDALClose(data); }
};

/// Values that are not finite, or that the file marks as missing, become the least of the others.
void fill_missing(std::vector<float>& values, GDALRasterBandH band, const std::string& name) {
  int has_mark = FALSE;
  const auto mark = static_cast<float>(GDALGetRasterNoDataValue(band, &has_mark));
  const auto missing = [&](float value) { return !std::isfinite(value) || (has_mark != FALSE && value == mark); };
  float least = std::numeric_limits<float>::infinity();
  for (const float value : values)
    if (!missing(value)) least = std::min(least, value);
  if (!std::isfinite(least)) refuse_raster(name, "no point of it has a height");
  for (float& value : values)
    if (missing(value)) value = least;
}

}  // namespace

HeightRaster HeightRaster::parse_geo_tiff(std::string_view bytes, const std::string& name, const Poll& poll) {
  const Quiet quiet;
  GDALAllRegister();
  const MemoryFile file(bytes);
  static constexpr const char* kDrivers[] = {"GTiff", nullptr};
  static constexpr const char* kNoOtherFiles[] = {nullptr};
  const std::unique_ptr<void, Close> data(
      GDALOpenEx(file.path(), GDAL_OF_RASTER | GDAL_OF_READONLY, kDrivers, nullptr, kNoOtherFiles));
  if (!data) refuse_raster(name, CPLGetLastErrorMsg()[0] != 0 ? CPLGetLastErrorMsg() : "it is not a GeoTIFF file");

  HeightRaster raster;
  raster.columns = GDALGetRasterXSize(data.get());
  raster.rows = GDALGetRasterYSize(data.get());
  if (raster.columns < 1 || raster.rows < 1 || raster.columns > kMostSide || raster.rows > kMostSide)
    refuse_raster(name,
                  fmt::format("it has {} x {} points (at most {} a side)", raster.columns, raster.rows, kMostSide));
  if (GDALGetRasterCount(data.get()) < 1) refuse_raster(name, "it has no band");

  // Row by row: a head that claims more than the file has must not take memory for it.
  const GDALRasterBandH band = GDALGetRasterBand(data.get(), 1);
  std::vector<float> row(static_cast<std::size_t>(raster.columns));
  for (int y = 0; y < raster.rows; ++y) {
    if (GDALRasterIO(band, GF_Read, 0, y, raster.columns, 1, row.data(), raster.columns, 1, GDT_Float32, 0, 0) !=
        CE_None)
      refuse_raster(name, CPLGetLastErrorMsg());
    raster.values.insert(raster.values.end(), row.begin(), row.end());
    if (poll) poll();
  }
  fill_missing(raster.values, band, name);
  return raster;
}

}  // namespace breve
