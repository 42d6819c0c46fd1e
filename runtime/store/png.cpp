// Each row gets the filter whose residues are the smallest in sum (section 12.8 of the standard).
#include "runtime/store/png.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <new>
#include <vector>

namespace breve {

namespace {

using Buffer = std::vector<std::uint8_t>;

constexpr std::size_t kBetweenPolls = std::size_t{1} << 18;  // bytes, some ten milliseconds of compression

/// A zlib stream whose output goes to `sink(bytes, size)`.
template <class Sink>
class Deflater {
 public:
  Deflater(Sink sink, const Poll& poll) : sink_(std::move(sink)), poll_(poll) {
    if (deflateInit(&stream_, Z_DEFAULT_COMPRESSION) != Z_OK) throw std::bad_alloc();
  }
  ~Deflater() { deflateEnd(&stream_); }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  void add(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      const std::size_t size = std::min(bytes.size(), kBetweenPolls);
      run(bytes.first(size), Z_NO_FLUSH);
      bytes = bytes.subspan(size);
      since_poll_ += size;
      if (since_poll_ < kBetweenPolls) continue;
      since_poll_ = 0;
      if (poll_) poll_();
    }
  }
  void finish() { run({}, Z_FINISH); }

 private:
  void run(std::span<const std::uint8_t> bytes, int flush) {
    stream_.next_in = const_cast<Bytef*>(bytes.data());
    stream_.avail_in = static_cast<uInt>(bytes.size());
    do {
      stream_.next_out = out_.data();
      stream_.avail_out = static_cast<uInt>(out_.size());
      deflate(&stream_, flush);
      sink_(out_.data(), out_.size() - stream_.avail_out);
    } while (stream_.avail_out == 0);
  }

  Sink sink_;
  const Poll& poll_;
  z_stream stream_{};
  std::size_t since_poll_ = 0;
  std::array<std::uint8_t, 1 << 15> out_;
};

void put_big_endian(Buffer& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// Length, type, data, CRC of type and data (section 5.3).
void put_chunk(std::string& out, const char* type, std::span<const std::uint8_t> data) {
  Buffer chunk;
  put_big_endian(chunk, static_cast<std::uint32_t>(data.size()));
  chunk.insert(chunk.end(), type, type + 4);
  chunk.insert(chunk.end(), data.begin(), data.end());
  put_big_endian(chunk, static_cast<std::uint32_t>(crc32(0, chunk.data() + 4, static_cast<uInt>(chunk.size() - 4))));
  out.append(reinterpret_cast<const char*>(chunk.data()), chunk.size());
}

/// The predictor of filter 4 (section 9.4).
std::uint8_t paeth(int left, int above, int corner) {
  const int guess = left + above - corner;
  const int a = std::abs(guess - left), b = std::abs(guess - above), c = std::abs(guess - corner);
  return static_cast<std::uint8_t>(a <= b && a <= c ? left : b <= c ? above : corner);
}

std::uint8_t predicted(int filter, int left, int above, int corner) {
  switch (filter) {
    case 1: return static_cast<std::uint8_t>(left);
    case 2: return static_cast<std::uint8_t>(above);
    case 3: return static_cast<std::uint8_t>((left + above) / 2);
    case 4: return paeth(left, above, corner);
    default: return 0;
  }
}

/// Rows one after the other, each with the filter that suits it.
class Filters {
 public:
  Buffer row;  // to be filled

  Filters(std::size_t row_bytes, std::size_t pixel_bytes)
      : row(row_bytes), pixel_bytes_(pixel_bytes), above_(row_bytes), best_(row_bytes + 1), tried_(row_bytes + 1) {}

  /// `row`, filtered, with the number of the filter in front.
  const Buffer& filtered() {
    std::uint64_t least = ~std::uint64_t{0};
    for (int filter = 0; filter <= 4; ++filter) {
      const std::uint64_t sum = attempt(filter);
      if (sum >= least) continue;
      least = sum;
      best_.swap(tried_);
    }
    above_ = row;
    return best_;
  }

 private:
  std::uint64_t attempt(int filter) {
    std::uint64_t sum = 0;
    tried_[0] = static_cast<std::uint8_t>(filter);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool first = i < pixel_bytes_;
      const int left = first ? 0 : row[i - pixel_bytes_], corner = first ? 0 : above_[i - pixel_bytes_];
      const auto residue = static_cast<std::uint8_t>(row[i] - predicted(filter, left, above_[i], corner));
      tried_[i + 1] = residue;
      sum += static_cast<std::uint64_t>(std::abs(static_cast<std::int8_t>(residue)));
    }
    return sum;
  }

  const std::size_t pixel_bytes_;
  Buffer above_, best_, tried_;
};

}  // namespace

std::string make_png(PngKind kind, int width, int height,
                     const std::function<void(std::size_t y, std::span<std::uint8_t> bytes)>& row, const Poll& poll) {
  const bool color = kind == PngKind::Rgba8;
  const std::size_t pixel_bytes = color ? 4 : 2;
  Buffer data;
  Deflater deflater([&](const std::uint8_t* bytes, std::size_t size) { data.insert(data.end(), bytes, bytes + size); },
                    poll);
  Filters filters(static_cast<std::size_t>(width) * pixel_bytes, pixel_bytes);
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    row(y, filters.row);
    deflater.add(filters.filtered());
  }
  deflater.finish();

  std::string png("\x89PNG\r\n\x1a\n");
  Buffer header;
  put_big_endian(header, static_cast<std::uint32_t>(width));
  put_big_endian(header, static_cast<std::uint32_t>(height));
  const std::uint8_t depth = color ? 8 : 16, type = color ? 6 : 0;
  header.insert(header.end(), {depth, type, 0, 0, 0});  // deflate, filters, no interlace
  put_chunk(png, "IHDR", header);
  put_chunk(png, "IDAT", data);
  put_chunk(png, "IEND", {});
  return png;
}

std::size_t deflated_size(std::span<const std::uint8_t> bytes, const Poll& poll) {
  std::size_t size = 0;
  Deflater deflater([&](const std::uint8_t*, std::size_t made) { size += made; }, poll);
  deflater.add(bytes);
  deflater.finish();
  return size;
}

}  // namespace breve
