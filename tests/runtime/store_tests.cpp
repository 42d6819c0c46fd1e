// Pictures: what is written is read back, and every failure is named.
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>

#include "runtime/base/error.hpp"
#include "runtime/store/image.hpp"

namespace breve {
namespace {

std::string message(ErrorCode code, auto act) {
  try {
    act();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

Image sample() {
  Image image(5, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x)
      for (int c = 0; c < 4; ++c)
        image.set_byte(x, y, static_cast<Channel>(c), static_cast<std::uint8_t>(17 * x + 60 * y + 5 * c + 1));
  return image;
}

TEST(Image, StartsBlackAndOpaque) {
  const Image image(2, 3);
  EXPECT_EQ(image.width(), 2);
  EXPECT_EQ(image.height(), 3);
  EXPECT_EQ(image.get(1, 2, Channel::Red), 0);
  EXPECT_EQ(image.get(1, 2, Channel::Alpha), 1);
  EXPECT_TRUE(image.changed());
  EXPECT_TRUE(Image().empty());
}

TEST(Image, ValuesAreClampedAndRounded) {
  Image image(1, 1);
  image.clear_changed();
  image.set(0, 0, Channel::Green, 2);
  EXPECT_TRUE(image.changed());
  EXPECT_EQ(image.get(0, 0, Channel::Green), 1);
  image.set(0, 0, Channel::Green, -2);
  EXPECT_EQ(image.get(0, 0, Channel::Green), 0);
  image.set(0, 0, Channel::Green, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(image.get(0, 0, Channel::Green), 0);
  image.set(0, 0, Channel::Green, 0.5);
  EXPECT_EQ(image.byte(0, 0, Channel::Green), 128);
  for (int byte = 0; byte < 256; ++byte) {
    image.set(0, 0, Channel::Blue, byte / 255.0);
    EXPECT_EQ(image.byte(0, 0, Channel::Blue), byte);
  }
}

TEST(Image, PlacesAndSizesAreChecked) {
  Image image(2, 3);
  EXPECT_EQ(message(ErrorCode::Argument, [&] { image.get(2, 0, Channel::Red); }),
            "pixel (2, 0) is outside an image of 2 x 3 (indices start at 0)");
  EXPECT_NE(message(ErrorCode::Argument, [&] { image.set(0, -1, Channel::Red, 1); }).find("(0, -1)"),
            std::string::npos);
  EXPECT_NE(message(ErrorCode::Argument, [] { Image(0, 3); }).find("0 x 3"), std::string::npos);
  EXPECT_NE(message(ErrorCode::Argument, [] { Image(1, 1 << 30); }).find("1073741824"), std::string::npos);
  EXPECT_NE(message(ErrorCode::Argument, [&] { image.set_bytes(std::vector<std::uint8_t>(5)); }).find("must be 24"),
            std::string::npos);
}

TEST(Image, AnAssignmentThatFindsNoMemoryChangesNothing) {
  std::array<std::byte, 256> room;
  std::pmr::monotonic_buffer_resource memory(room.data(), room.size(), std::pmr::null_memory_resource());
  Image image(2, 3, &memory);
  EXPECT_THROW(image = Image(64, 64), std::bad_alloc);
  EXPECT_EQ(image.width(), 2);
  EXPECT_EQ(image.height(), 3);
  EXPECT_EQ(image.get(1, 2, Channel::Alpha), 1);
}

TEST(ImageFile, PngRoundTripKeepsEveryByte) {
  const Image image = sample();
  const Image back = Image::parse(image.png(), "a.png");
  EXPECT_EQ(back.width(), 5);
  EXPECT_EQ(back.height(), 3);
  EXPECT_EQ(back.bytes(), image.bytes());
  EXPECT_TRUE(back.changed());
}

TEST(ImageFile, TgaIsReadAndGivenAlpha) {
  // An uncompressed 24-bit TGA of 2 x 1, top-left origin: blue, green, red a pixel.
  std::string tga(18, '\0');
  tga[2] = 2;
  tga[12] = 2;
  tga[14] = 1;
  tga[16] = 24;
  tga[17] = 0x20;
  tga += std::string("\x01\x02\x03\x04\x05\x06", 6);
  const Image image = Image::parse(tga, "a.tga");
  EXPECT_EQ(image.bytes(), (std::pmr::vector<std::uint8_t>{3, 2, 1, 255, 6, 5, 4, 255}));
}

TEST(ImageFile, FailuresNameTheFile) {
  const auto refusal = [](const std::string& bytes) {
    return message(ErrorCode::File, [&] { Image::parse(bytes, "a.png"); });
  };
  EXPECT_EQ(refusal("this is not a picture").find("cannot read image file 'a.png': "), 0U);
  EXPECT_EQ(refusal(sample().png().substr(0, 40)).find("cannot read image file 'a.png': "), 0U);
  EXPECT_NE(refusal(sample().png().substr(0, 40)).find("a PNG file that is damaged"), std::string::npos);
  EXPECT_NE(refusal("\xff\xd8\xff\xe0 and no more").find("a JPEG file that is damaged"), std::string::npos);
  EXPECT_NE(refusal("GIF89a").find("a GIF file; save it as PNG"), std::string::npos);
  EXPECT_NE(refusal("").find("it is empty"), std::string::npos);
  EXPECT_NE(refusal(""), "");
  EXPECT_EQ(message(ErrorCode::Argument, [] { (void)Image().png(); }), "the image is empty");
}

TEST(ImageFile, SixteenBitGrayKeepsSixteenBits) {
  const std::vector<double> values{0, 1, 0.5, -3, 7, std::numeric_limits<double>::quiet_NaN()};
  const std::string png = gray16_png(3, 2, values);
  // IHDR: width 3, height 2, depth 16, colour type 0.
  EXPECT_EQ(png.substr(16, 10), std::string("\0\0\0\x03\0\0\0\x02\x10\0", 10));
  // The one IDAT chunk, inflated: rows of a filter byte 0 and big-endian samples.
  const std::size_t data = png.find("IDAT") + 4;
  std::vector<std::uint8_t> raw(100);
  uLongf size = raw.size();
  ASSERT_EQ(uncompress(raw.data(), &size, reinterpret_cast<const Bytef*>(png.data() + data),
                       static_cast<uLong>(png.size() - data - 16)),
            Z_OK);
  raw.resize(size);
  EXPECT_EQ(raw, (std::vector<std::uint8_t>{0, 0, 0, 255, 255, 128, 0, 0, 0, 0, 255, 255, 0, 0}));
  // Another reader also accepts it, including its checksums.
  EXPECT_EQ(Image::parse(png, "gray.png").byte(1, 0, Channel::Red), 255);
  EXPECT_NE(message(ErrorCode::Argument, [&] { (void)gray16_png(2, 2, values); }).find("6 values"), std::string::npos);
}

TEST(Image, ARegularPictureDeflatesToLess) {
  Image regular(64, 64), noisy(64, 64);
  std::uint32_t state = 1;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 4; ++c) {
        state = state * 1664525 + 1013904223;
        noisy.set_byte(x, y, static_cast<Channel>(c), static_cast<std::uint8_t>(state >> 24));
      }
  EXPECT_LT(regular.deflated_size(), 200U);
  EXPECT_GT(noisy.deflated_size(), 64U * 64 * 4 * 9 / 10);
}

TEST(Image, ASnapshotGivesTheSameImageBack) {
  Image image = sample();
  image.clear_changed();
  ByteWriter out;
  image.save(out);
  Image().save(out);
  const auto bytes = out.take();
  ByteReader in(bytes.data(), bytes.size());
  const Image back = Image::load(in);
  EXPECT_TRUE(Image::load(in).empty());
  EXPECT_FALSE(back.changed());
  Hasher before, after;
  image.hash(before);
  back.hash(after);
  EXPECT_EQ(before.value(), after.value());
  for (std::size_t size = 0; size < bytes.size() - 9; ++size) {
    ByteReader cut(bytes.data(), size);
    EXPECT_THROW(Image::load(cut), Error);
  }
}

}  // namespace
}  // namespace breve
