// Natives of Image: pixels, files, and the library's own pictures.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "runtime/store/painted_pictures.hpp"
#include "steve/library/image_access.hpp"
#include "steve/library/pictures.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

Image& image(Machine& machine, Instance& self) { return image_of(machine, &self, "the image"); }

void image_init(Machine& machine, Instance& self) { image(machine, self); }

/// Changed pixels are marked as they are written and taken by whoever draws: an iteration has nothing to add.
void image_iterate(Machine&, Instance&) {}

// --- size and files --------------------------------------------------------------------------------------------------

Instance* image_set_size(Machine& machine, Instance& self, std::int32_t width, std::int32_t height) {
  if (width > 0 && height > 0)
    machine.charge_for(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height));
  image(machine, self) = Image(width, height, machine.heap().memory());
  return &self;
}

void charge_for_decoding(Machine& machine, int width, int height) {
  constexpr std::uint64_t kOfPixel = 32;
  machine.charge_for(kOfPixel * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height));
}

void charge_for_deflation(Machine& machine, const Image& picture) {
  constexpr std::uint64_t kOfByte = 16;
  machine.charge_for(kOfByte * picture.bytes().size());
}

/// Run something that writes a file: 1, or 0 with a message.
template <class Write>
std::int32_t try_to_write(Machine& machine, const std::string& name, Write write) {
  try {
    write();
    return 1;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::File && error.code() != ErrorCode::Argument) throw;
    machine.warn("image '" + name + "' not written: " + error.what());
    return 0;
  }
}

std::int32_t image_write(Machine& machine, Instance& self, Text file) {
  const std::string name(view(file));
  charge_for_deflation(machine, image(machine, self));
  return try_to_write(machine, name, [&] { write_file(machine, name, image(machine, self).png(machine.poller())); });
}

std::int32_t image_write_16_bit(Machine& machine, Instance& self, Text file) {
  const std::string name(view(file));
  const Image& picture = image(machine, self);
  charge_for_deflation(machine, picture);
  constexpr double kHighest = 65535;
  std::pmr::vector<double> greys(machine.heap().memory());
  greys.reserve(picture.bytes().size() / 4);
  for (int y = 0; y < picture.height(); ++y) {
    machine.poll();
    for (int x = 0; x < picture.width(); ++x)
      greys.push_back((picture.byte(x, y, Channel::Red) * 256 + picture.byte(x, y, Channel::Green)) / kHighest);
  }
  return try_to_write(machine, name, [&] {
    write_file(machine, name, gray16_png(picture.width(), picture.height(), greys, machine.poller()));
  });
}

// --- the library's own pictures --------------------------------------------------------------------------------------

/// Replace the pixels by those of a pattern.
void paint(Machine& machine, Instance& self, std::string_view pattern) {
  machine.charge(pattern_work(pattern));
  image(machine, self) = paint_pattern(pattern, machine.heap().memory());
}

void image_paint_pattern(Machine& machine, Instance& self, Text name) {
  if (std::find(kPatterns.begin(), kPatterns.end(), view(name)) == kPatterns.end())
    throw Error(ErrorCode::Argument,
                fmt::format("there is no pattern '{}'; the patterns are {}", view(name), fmt::join(kPatterns, ", ")));
  paint(machine, self, view(name));
}

/// The bytes of a picture file. Without them `self` shows the picture that stands in for the file, if there is one.
std::optional<std::pmr::string> read_picture(Machine& machine, Instance& self, const std::string& name, bool& painted) {
  const auto pattern = pattern_of_file(name);
  try {
    return read_file(machine, name);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::File) throw;
    // The library's own pictures need no file and no right to read one.
    painted = pattern.has_value();
    if (pattern)
      paint(machine, self, *pattern);
    else if (dynamic_cast<const MissingFile*>(&error))
      warn_of_missing_image(machine, name);
    else
      machine.warn_once("image:" + name, "image '" + name + "' not loaded: " + error.what());
    return std::nullopt;
  }
}

Instance* image_load(Machine& machine, Instance& self, Text file) {
  const std::string name(view(file));
  bool painted = false;
  const auto bytes = read_picture(machine, self, name, painted);
  if (!bytes) return painted ? &self : nullptr;
  try {
    image(machine, self) = Image::parse(*bytes, name, machine.heap().memory(),
                                        [&](int width, int height) { charge_for_decoding(machine, width, height); });
  } catch (const Error& error) {
    if (error.code() != ErrorCode::File) throw;
    machine.warn_once("image:" + name, "image '" + name + "' not loaded: " + error.what());
    return nullptr;
  }
  return &self;
}

// --- pixels ----------------------------------------------------------------------------------------------------------

std::int32_t image_get_width(Machine& machine, Instance& self) { return image(machine, self).width(); }
std::int32_t image_get_height(Machine& machine, Instance& self) { return image(machine, self).height(); }

/// Reading outside gives a message; the caller then yields 0.
bool readable(Machine& machine, const Image& picture, std::int32_t x, std::int32_t y) {
  if (picture.holds(x, y)) return true;
  machine.warn("pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") is outside an image of " +
               std::to_string(picture.width()) + " x " + std::to_string(picture.height()));
  return false;
}

template <Channel C>
double get_channel(Machine& machine, Instance& self, std::int32_t x, std::int32_t y) {
  const Image& picture = image(machine, self);
  return readable(machine, picture, x, y) ? picture.get(x, y, C) : 0.0;
}

template <Channel C>
void set_channel(Machine& machine, Instance& self, double value, std::int32_t x, std::int32_t y) {
  Image& picture = image(machine, self);
  if (picture.holds(x, y)) picture.set(x, y, C, value);
}

Vector3 get_rgb(Machine& machine, Instance& self, std::int32_t x, std::int32_t y) {
  const Image& picture = image(machine, self);
  if (!readable(machine, picture, x, y)) return {0, 0, 0};
  return {picture.get(x, y, Channel::Red), picture.get(x, y, Channel::Green), picture.get(x, y, Channel::Blue)};
}

void set_rgb(Machine& machine, Instance& self, Vector3 color, std::int32_t x, std::int32_t y) {
  Image& picture = image(machine, self);
  if (!picture.holds(x, y)) return;
  picture.set(x, y, Channel::Red, color.x());
  picture.set(x, y, Channel::Green, color.y());
  picture.set(x, y, Channel::Blue, color.z());
}

DataCell* image_get_data(Machine& machine, Instance& self) {
  const std::pmr::vector<std::uint8_t>& bytes = image(machine, self).bytes();
  machine.charge_for(bytes.size());
  return machine.heap().data({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::int32_t image_get_texture_number(Machine&, Instance& self) { return static_cast<std::int32_t>(self.id.index); }

std::int32_t image_get_compression_size(Machine& machine, Instance& self) {
  charge_for_deflation(machine, image(machine, self));
  return static_cast<std::int32_t>(image(machine, self).deflated_size(machine.poller()));
}

// --- the view --------------------------------------------------------------------------------------------------------

/// Calls `visit(x, y, pixel)` for the pixels of an image that the view covers, if its pixel (0, 0) is that of the view
/// at (left, top); `pixel` is the index in the view.
template <class Visit>
void for_each_seen(const Image& picture, const DrawnView& view, std::int32_t left, std::int32_t top, Visit&& visit) {
  for (std::int64_t y = std::max(0, -top); y < std::min<std::int64_t>(picture.height(), view.height - top); ++y)
    for (std::int64_t x = std::max(0, -left); x < std::min<std::int64_t>(picture.width(), view.width - left); ++x)
      visit(static_cast<std::int32_t>(x), static_cast<std::int32_t>(y),
            static_cast<std::size_t>((y + top) * view.width + x + left));
}

/// Window positions that no image reaches from are all the same.
std::int32_t bounded(std::int32_t position) { return std::clamp(position, -100'000, 100'000); }

/// The view where the image covers it, if there is one, and the image black for what is outside of it.
const DrawnView* begin_reading(Machine& machine, Image& picture, std::string_view selector, std::int32_t left,
                               std::int32_t top) {
  machine.charge_for(picture.bytes().size() / 4);
  const DrawnView* view =
      picture.empty() ? nullptr : draw_view(machine, selector, 0, {left, top, picture.width(), picture.height()});
  if (!picture.empty()) picture = Image(picture.width(), picture.height(), machine.heap().memory());
  return view;
}

void image_read_pixels(Machine& machine, Instance& self, std::int32_t x, std::int32_t y) {
  Image& picture = image(machine, self);
  const DrawnView* view = begin_reading(machine, picture, "read-pixels", bounded(x), bounded(y));
  if (!view) return;
  for_each_seen(picture, *view, bounded(x), bounded(y), [&](std::int32_t at_x, std::int32_t at_y, std::size_t pixel) {
    constexpr Channel kChannels[] = {Channel::Red, Channel::Green, Channel::Blue};
    for (std::size_t k = 0; k < 3; ++k) picture.set(at_x, at_y, kChannels[k], view->rgba[4 * pixel + k] / 255.0);
  });
}

/// As write-16-bit-grayscale reads them: the high byte is red, the low one green.
void image_read_depth(Machine& machine, Instance& self, std::int32_t x, std::int32_t y, std::int32_t linear,
                      double farthest) {
  const DepthGrays gray("read-depth", linear != 0, farthest);
  Image& picture = image(machine, self);
  const DrawnView* view = begin_reading(machine, picture, "read-depth", bounded(x), bounded(y));
  if (!view) return;
  for_each_seen(picture, *view, bounded(x), bounded(y), [&](std::int32_t at_x, std::int32_t at_y, std::size_t pixel) {
    const auto value = static_cast<int>(std::lround(65535 * gray.of(view->depth[pixel])));
    picture.set(at_x, at_y, Channel::Red, (value >> 8) / 255.0);
    picture.set(at_x, at_y, Channel::Green, (value & 255) / 255.0);
  });
}

constexpr Native kImageNatives[] = {
    native<image_init>("image.init"),
    native<image_iterate>("image.iterate"),
    native<image_load>("image.load", Reach::Reads),
    native<image_set_size>("image.init-with"),
    native<image_set_size>("image.set-size"),
    native<image_paint_pattern>("image.paint-pattern"),
    native<image_get_data>("image.get-image-data"),
    native<image_get_texture_number>("image.get-texture-number"),
    native<image_get_width>("image.get-width"),
    native<image_get_height>("image.get-height"),
    native<get_channel<Channel::Red>>("image.get-red-pixel"),
    native<get_channel<Channel::Green>>("image.get-green-pixel"),
    native<get_channel<Channel::Blue>>("image.get-blue-pixel"),
    native<get_channel<Channel::Alpha>>("image.get-alpha-pixel"),
    native<get_rgb>("image.get-rgb-pixel"),
    native<image_get_compression_size>("image.get-compression-size"),
    native<set_channel<Channel::Red>>("image.set-red-pixel"),
    native<set_channel<Channel::Green>>("image.set-green-pixel"),
    native<set_channel<Channel::Blue>>("image.set-blue-pixel"),
    native<set_channel<Channel::Alpha>>("image.set-alpha-pixel"),
    native<set_rgb>("image.set-pixel"),
    native<set_rgb>("image.set-rgb-pixel"),
    native<image_read_pixels>("image.read-pixels"),
    native<image_read_depth>("image.read-depth"),
    native<image_write>("image.write", Reach::Writes),
    native<image_write_16_bit>("image.write-16-bit-grayscale", Reach::Writes),
};

}  // namespace

std::span<const Native> image_natives() { return kImageNatives; }

}  // namespace breve::steve
