// Colours by median cut (Heckbert 1982, Color image quantization), codes by LZW (Welch 1984).
#include "runtime/movie/gif.hpp"

#include <algorithm>
#include <cmath>

namespace breve::movie {

namespace {

using Bytes = std::vector<std::uint8_t>;

void put16(Bytes& out, std::uint32_t number) {
  out.push_back(static_cast<std::uint8_t>(number & 0xff));
  out.push_back(static_cast<std::uint8_t>(number >> 8 & 0xff));
}

// --- colours ---------------------------------------------------------------------------------------------------------

constexpr std::size_t kColors = 255;  // and one that means: as before
constexpr std::uint8_t kTransparent = 255;
constexpr int kBits = 5;  // of each channel, where colours are told apart

struct Bin {
  std::array<std::uint8_t, 3> color;
  std::uint32_t key, count;
};

std::uint32_t key_of(const std::uint8_t* pixel) {
  constexpr int kShift = 8 - kBits;
  return static_cast<std::uint32_t>(pixel[0] >> kShift) << 2 * kBits |
         static_cast<std::uint32_t>(pixel[1] >> kShift) << kBits | static_cast<std::uint32_t>(pixel[2] >> kShift);
}

struct Box {
  std::size_t first, last;  // of the bins
  int axis = 0;
  double worth = 0;  // of dividing it
};

Box box_of(const std::vector<Bin>& bins, std::size_t first, std::size_t last) {
  Box box{first, last};
  double count = 0;
  std::array<int, 3> low{255, 255, 255}, high{0, 0, 0};
  for (std::size_t i = first; i < last; ++i) {
    count += bins[i].count;
    for (std::size_t c = 0; c < 3; ++c) {
      low[c] = std::min<int>(low[c], bins[i].color[c]);
      high[c] = std::max<int>(high[c], bins[i].color[c]);
    }
  }
  int widest = 0;
  for (int c = 0; c < 3; ++c) {
    const auto at = static_cast<std::size_t>(c);
    if (high[at] - low[at] > widest) {
      widest = high[at] - low[at];
      box.axis = c;
    }
  }
  box.worth = last - first > 1 ? widest * widest * std::sqrt(count) : 0;
  return box;
}

/// The bins of a box in two halves with as many pixels.
std::size_t divide(std::vector<Bin>& bins, const Box& box) {
  const auto at = static_cast<std::size_t>(box.axis);
  std::sort(bins.begin() + static_cast<std::ptrdiff_t>(box.first), bins.begin() + static_cast<std::ptrdiff_t>(box.last),
            [&](const Bin& a, const Bin& b) {
              return a.color[at] != b.color[at] ? a.color[at] < b.color[at] : a.key < b.key;
            });
  std::uint64_t all = 0, sum = 0;
  for (std::size_t i = box.first; i < box.last; ++i) all += bins[i].count;
  std::size_t middle = box.first;
  while (middle + 1 < box.last && 2 * (sum += bins[middle].count) < all) ++middle;
  return std::clamp(middle + 1, box.first + 1, box.last - 1);
}

struct Palette {
  std::array<std::array<std::uint8_t, 3>, 256> colors{};
  std::vector<std::uint8_t> index;  // by key
};

Palette palette_of(std::span<const std::uint8_t> rgba) {
  constexpr std::size_t kKeys = std::size_t{1} << 3 * kBits;
  std::vector<std::array<std::uint64_t, 4>> sums(kKeys);
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    auto& sum = sums[key_of(&rgba[i])];
    ++sum[3];
    for (std::size_t c = 0; c < 3; ++c) sum[c] += rgba[i + c];
  }
  std::vector<Bin> bins;
  for (std::uint32_t key = 0; key < kKeys; ++key)
    if (const auto& sum = sums[key]; sum[3] != 0)
      bins.push_back({{static_cast<std::uint8_t>(sum[0] / sum[3]), static_cast<std::uint8_t>(sum[1] / sum[3]),
                       static_cast<std::uint8_t>(sum[2] / sum[3])},
                      key,
                      static_cast<std::uint32_t>(sum[3])});
  std::vector<Box> boxes{box_of(bins, 0, bins.size())};
  while (boxes.size() < kColors) {
    const auto most =
        std::max_element(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.worth < b.worth; });
    if (most->worth <= 0) break;
    const Box box = *most;
    const std::size_t middle = divide(bins, box);
    *most = box_of(bins, box.first, middle);
    boxes.push_back(box_of(bins, middle, box.last));
  }
  Palette palette;
  palette.index.resize(kKeys);
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    std::array<std::uint64_t, 4> sum{};
    for (std::size_t i = boxes[b].first; i < boxes[b].last; ++i) {
      palette.index[bins[i].key] = static_cast<std::uint8_t>(b);
      sum[3] += bins[i].count;
      for (std::size_t c = 0; c < 3; ++c) sum[c] += std::uint64_t{bins[i].color[c]} * bins[i].count;
    }
    for (std::size_t c = 0; c < 3; ++c) palette.colors[b][c] = static_cast<std::uint8_t>(sum[c] / sum[3]);
  }
  return palette;
}

// --- codes -----------------------------------------------------------------------------------------------------------

/// Codes of growing width, in blocks of at most 255 bytes.
class CodeWriter {
 public:
  explicit CodeWriter(Bytes& out) : out_(out) {}
  void put(std::uint32_t code, int width) {
    bits_ |= std::uint64_t{code} << held_;
    for (held_ += width; held_ >= 8; held_ -= 8, bits_ >>= 8) put_byte(static_cast<std::uint8_t>(bits_ & 0xff));
  }
  void end() {
    if (held_ > 0) put_byte(static_cast<std::uint8_t>(bits_ & 0xff));
    flush();
    out_.push_back(0);
  }

 private:
  void put_byte(std::uint8_t byte) {
    block_.push_back(byte);
    if (block_.size() == 255) flush();
  }
  void flush() {
    if (block_.empty()) return;
    out_.push_back(static_cast<std::uint8_t>(block_.size()));
    out_.insert(out_.end(), block_.begin(), block_.end());
    block_.clear();
  }
  Bytes& out_;
  Bytes block_;
  std::uint64_t bits_ = 0;
  int held_ = 0;
};

void compress(const Bytes& indices, Bytes& out) {
  constexpr std::uint32_t kClear = 256, kEnd = 257, kFirst = 258, kMost = 4096;
  out.push_back(8);
  CodeWriter writer(out);
  std::vector<std::uint16_t> next(std::size_t{kMost} * 256, 0);  // code and byte -> code; 0: none
  std::uint32_t free = kFirst;
  int width = 9;
  writer.put(kClear, width);
  std::uint32_t code = indices.empty() ? kEnd : indices[0];
  for (std::size_t i = 1; i < indices.size(); ++i) {
    std::uint16_t& longer = next[std::size_t{code} << 8 | indices[i]];
    if (longer != 0) {
      code = longer;
      continue;
    }
    writer.put(code, width);
    longer = static_cast<std::uint16_t>(free++);
    if (free - 1 == 1U << width) ++width;
    if (free == kMost) {
      writer.put(kClear, width);
      std::fill(next.begin(), next.end(), std::uint16_t{0});
      free = kFirst;
      width = 9;
    }
    code = indices[i];
  }
  writer.put(code, width);
  if (code != kEnd) writer.put(kEnd, width);
  writer.end();
}

}  // namespace

GifEncoder::GifEncoder(std::uint32_t width, std::uint32_t height, std::uint16_t delay, Bytes& out)
    : width_(width), height_(height), delay_(delay) {
  for (const char c : {'G', 'I', 'F', '8', '9', 'a'}) out.push_back(static_cast<std::uint8_t>(c));
  put16(out, width);
  put16(out, height);
  out.insert(out.end(), {0x70, 0, 0});  // no palette for all
  out.insert(out.end(), {0x21, 0xff, 11});
  for (const char c : {'N', 'E', 'T', 'S', 'C', 'A', 'P', 'E', '2', '.', '0'})
    out.push_back(static_cast<std::uint8_t>(c));
  out.insert(out.end(), {3, 1, 0, 0, 0});  // again and again
}

void GifEncoder::add(std::span<const std::uint8_t> rgba, Bytes& out) {
  const Palette palette = palette_of(rgba);
  Bytes indices(rgba.size() / 4);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const bool same = !last_.empty() && std::equal(&rgba[4 * i], &rgba[4 * i] + 3, &last_[4 * i]);
    indices[i] = same ? kTransparent : palette.index[key_of(&rgba[4 * i])];
  }
  last_.assign(rgba.begin(), rgba.end());
  out.insert(out.end(), {0x21, 0xf9, 4, 0x05});  // transparent; the frame before stays
  put16(out, delay_);
  out.insert(out.end(), {kTransparent, 0, 0x2c});
  put16(out, 0);
  put16(out, 0);
  put16(out, width_);
  put16(out, height_);
  out.push_back(0x87);  // its own palette of 256
  for (const auto& color : palette.colors) out.insert(out.end(), color.begin(), color.end());
  compress(indices, out);
}

}  // namespace breve::movie
