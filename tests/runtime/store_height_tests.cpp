// GeoTIFF files, made here byte by byte, where breve is built with GDAL; elsewhere they are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/base/error.hpp"
#include "runtime/store/height_raster.hpp"

namespace breve {
namespace {

TEST(HeightRaster, HeightsBetweenPointsAreLinear) {
  HeightRaster raster;
  raster.columns = 2;
  raster.rows = 2;
  raster.values = {0, 4, 8, 20};
  EXPECT_EQ(raster.at(0, 0), 0);
  EXPECT_EQ(raster.at(1, 1), 20);
  EXPECT_EQ(raster.at(0.5, 0), 2);
  EXPECT_EQ(raster.at(0.5, 0.5), 8);
  EXPECT_EQ(raster.at(-3, 9), 8);
}

/// A TIFF file with one strip of 32-bit floats, whose missing points are marked by -9999.
std::string tiff(std::uint32_t columns, std::uint32_t rows, const std::vector<float>& values) {
  constexpr std::uint16_t kShort = 3, kLong = 4, kAscii = 2;
  struct Entry {
    std::uint16_t tag, type;
    std::uint32_t count, value;
  };
  const auto size = static_cast<std::uint32_t>(values.size() * sizeof(float));
  constexpr std::uint32_t kHead = 8, kEntries = 11, kMark = kHead + 2 + 12 * kEntries + 4, kData = kMark + 8;
  const Entry entries[kEntries] = {{256, kLong, 1, columns}, {257, kLong, 1, rows},    {258, kShort, 1, 32},
                                   {259, kShort, 1, 1},      {262, kShort, 1, 1},      {273, kLong, 1, kData},
                                   {277, kShort, 1, 1},      {278, kLong, 1, rows},    {279, kLong, 1, size},
                                   {339, kShort, 1, 3},      {42113, kAscii, 6, kMark}};
  std::string out("II*\0\x08\0\0\0", 8);
  const auto put = [&](const auto& number) { out.append(reinterpret_cast<const char*>(&number), sizeof number); };
  put(static_cast<std::uint16_t>(kEntries));
  for (const Entry& entry : entries) {
    put(entry.tag);
    put(entry.type);
    put(entry.count);
    put(entry.value);
  }
  put(std::uint32_t{0});
  out.append("-9999\0\0\0", 8);
  out.append(reinterpret_cast<const char*>(values.data()), size);
  return out;
}

#ifdef BREVE_WITH_GDAL

TEST(HeightRaster, GeoTiffIsRead) {
  const HeightRaster raster = HeightRaster::parse_geo_tiff(tiff(3, 2, {1, 2, 3, 4.5, -9999, 6}), "dem.tif", {});
  EXPECT_EQ(raster.columns, 3);
  EXPECT_EQ(raster.rows, 2);
  EXPECT_EQ(raster.values, (std::vector<float>{1, 2, 3, 4.5, 1, 6}));
}

TEST(HeightRaster, DamagedFilesAreRefusedOrHaveFiniteHeights) {
  const std::string whole = tiff(3, 2, {1, 2, 3, 4.5, -9999, 6});
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const int value : {0, 1, 255}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(value);
      if (value == 1) damaged.resize(at);
      try {
        for (const float height : HeightRaster::parse_geo_tiff(damaged, "dem.tif", {}).values)
          EXPECT_TRUE(std::isfinite(height));
      } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("dem.tif"), std::string::npos);
      }
    }
  EXPECT_THROW(HeightRaster::parse_geo_tiff(tiff(2, 1, {-9999, -9999}), "dem.tif", {}), Error);
  EXPECT_THROW(HeightRaster::parse_geo_tiff(tiff(30'000, 1, {1}), "dem.tif", {}), Error);
}

#else

TEST(HeightRaster, WithoutGdalTheOptionIsNamed) {
  try {
    HeightRaster::parse_geo_tiff(tiff(3, 2, {1, 2, 3, 4, 5, 6}), "dem.tif", {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Unsupported);
    EXPECT_NE(std::string(error.what()).find("BREVE_WITH_GDAL"), std::string::npos);
  }
}

#endif

}  // namespace
}  // namespace breve
