// Pictures are drawn by the host, and written through its files.
#include "steve/library/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/store/image.hpp"
#include "steve/library/show.hpp"
#include "steve/library/support.hpp"

namespace breve::steve {

namespace {

// Work for each pixel of a picture, and how many it has.
constexpr std::uint64_t kOfDrawing = 16, kPixels = 640 * 480;
constexpr std::uint64_t kOfObject = 16384;  // of an object that may have to be drawn: its corners are passed on first
constexpr std::uint64_t kOfNumber = 8;      // of a cell of a grid or a value of a plot that is passed on
constexpr double kNear = 0.1;

void no_renderer(Machine& machine, std::string_view selector, std::string_view why) {
  machine.warn_once("renderer:" + std::string(selector),
                    [&] { return std::string(selector) + ": " + std::string(why); });
}

}  // namespace

const DrawnView* draw_view(Machine& machine, std::string_view selector, std::uint64_t more, const ViewPart& part) {
  const auto& draw = machine.host().draw;
  if (!draw) {
    no_renderer(machine, selector, "nothing draws this world");
    return nullptr;
  }
  machine.charge_for((kOfDrawing + more) * kPixels + kOfObject * machine.world().object_count());
  machine.charge_for(kOfNumber * shown_numbers(machine));
  try {
    return &draw(part);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Unsupported && error.code() != ErrorCode::File) throw;
    no_renderer(machine, selector, error.what());
    return nullptr;
  }
}

DepthGrays::DepthGrays(std::string_view selector, bool linear, double farthest) : linear_(linear), farthest_(farthest) {
  if (!(farthest > kNear) || !std::isfinite(farthest))
    throw Error(ErrorCode::Argument, fmt::format("{}: max-dist is {} (must be above {})", selector, farthest, kNear));
}

double DepthGrays::of(float depth) const {
  const double seen = std::clamp(static_cast<double>(depth), kNear, farthest_);
  return linear_ ? seen / farthest_ : (1 / kNear - 1 / seen) / (1 / kNear - 1 / farthest_);
}

bool write_picture(Machine& machine, std::string_view selector, const std::string& name, std::string_view bytes) {
  try {
    write_file(machine, name, bytes);
    return true;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::File) throw;
    machine.warn(fmt::format("{}: picture '{}' not written: {}", selector, name, error.what()));
    return false;
  }
}

bool write_view(Machine& machine, const std::string& name, std::string_view selector) {
  const DrawnView* view = draw_view(machine, selector, kOfDeflation);
  if (!view) return false;
  const std::size_t row_bytes = 4 * static_cast<std::size_t>(view->width);
  const std::string png = make_png(
      PngKind::Rgba8, view->width, view->height,
      [&](std::size_t y, std::span<std::uint8_t> row) {
        std::copy_n(view->rgba.begin() + static_cast<std::ptrdiff_t>(y * row_bytes), row_bytes, row.begin());
      },
      machine.poller());
  return write_picture(machine, selector, name, png);
}

bool write_frame(Machine& machine, std::string_view name, std::int64_t number, std::string_view selector) {
  return write_view(machine, fmt::format("{}_{:05}.png", name, number), selector);
}

}  // namespace breve::steve
