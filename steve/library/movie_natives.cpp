// Natives of Movie, and those of the controller that write what its camera sees.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/store/image.hpp"
#include "steve/library/pictures.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

// Elements for each pixel of a picture, and how many it has: what exceeds a budget does not begin.
constexpr std::uint64_t kOfDrawing = 16, kOfDeflation = 64, kPixels = 640 * 480;

void no_renderer(Machine& machine, std::string_view selector, std::string_view why) {
  machine.warn_once("renderer:" + std::string(selector), std::string(selector) + ": " + std::string(why));
}

/// The view as it is now; none with a warning where nothing draws.
const DrawnView* draw(Machine& machine, std::string_view selector) {
  const auto& draw = machine.host().draw;
  if (!draw) {
    no_renderer(machine, selector, "nothing draws this world");
    return nullptr;
  }
  machine.charge_for(kOfDrawing * kPixels);
  try {
    return &draw();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Unsupported && error.code() != ErrorCode::File) throw;
    no_renderer(machine, selector, error.what());
    return nullptr;
  }
}

/// Write a file; false with a warning if that fails.
bool try_to_write(Machine& machine, std::string_view selector, const std::string& name, std::string_view bytes) {
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
  machine.charge_for(kOfDeflation * kPixels);
  const DrawnView* view = draw(machine, selector);
  if (!view) return false;
  const std::size_t row_bytes = 4 * static_cast<std::size_t>(view->width);
  const std::string png = make_png(
      PngKind::Rgba8, view->width, view->height,
      [&](std::size_t y, std::span<std::uint8_t> row) {
        std::copy_n(view->rgba.begin() + static_cast<std::ptrdiff_t>(y * row_bytes), row_bytes, row.begin());
      },
      machine.poller());
  return try_to_write(machine, selector, name, png);
}

void save_snapshot(Machine& machine, Instance&, Text name) {
  write_view(machine, std::string(view(name)), "save-snapshot");
}

/// Black is near. If it is not linear, gray stands for the depth that a depth buffer holds of a view from `kNear` on.
void save_depth_snapshot(Machine& machine, Instance&, Text file, std::int32_t linear, double farthest) {
  constexpr std::string_view kSelector = "save-depth-snapshot";
  constexpr double kNear = 0.1;
  if (!(farthest > kNear) || !std::isfinite(farthest))
    throw Error(ErrorCode::Argument, fmt::format("save-depth-snapshot: max-dist is {} (must be above 0.1)", farthest));
  machine.charge_for(kOfDeflation * kPixels);
  const DrawnView* view = draw(machine, kSelector);
  if (!view) return;
  std::vector<double> grays;
  grays.reserve(view->depth.size());
  for (const float value : view->depth) {
    const double depth = std::clamp(static_cast<double>(value), kNear, farthest);
    grays.push_back(linear != 0 ? depth / farthest : (1 / kNear - 1 / depth) / (1 / kNear - 1 / farthest));
  }
  const std::string name(steve::view(file));
  try_to_write(machine, kSelector, name, gray16_png(view->width, view->height, grays, machine.poller()));
}

void toggle_recording(Machine& machine, Instance&) {
  DrawingFlags& flags = machine.world().view().flags;
  flags.recording = !flags.recording;
  if (flags.recording && !draw(machine, "toggle-recording-to-movie")) flags.recording = false;
}

// --- Movie -----------------------------------------------------------------------------------------------------------

Text movie_get_base_name(Machine& machine, Instance&, Text file) {
  const std::string_view name = view(file);
  const std::size_t slash = name.rfind('/'), dot = name.rfind('.');
  const std::size_t begin = slash == std::string_view::npos ? 0 : slash + 1;
  return machine.heap().string(dot == std::string_view::npos || dot <= begin ? name : name.substr(0, dot));
}

std::int32_t movie_can_draw(Machine& machine, Instance&) { return draw(machine, "record") ? 1 : 0; }

std::int32_t movie_write_frame(Machine& machine, Instance&, Text name, std::int32_t number) {
  return write_frame(machine, view(name), number, "add-frame-from-display") ? 1 : 0;
}

constexpr Native kMovieNatives[] = {
    native<save_snapshot>("control.save-snapshot", Reach::Writes),
    native<save_depth_snapshot>("control.save-depth-snapshot", Reach::Writes),
    native<toggle_recording>("control.toggle-recording-to-movie", Reach::Writes),
    native<movie_get_base_name>("movie.get-base-name"),
    native<movie_can_draw>("movie.can-draw"),
    native<movie_write_frame>("movie.write-frame", Reach::Writes),
};

}  // namespace

bool write_frame(Machine& machine, std::string_view name, std::int64_t number, std::string_view selector) {
  return write_view(machine, fmt::format("{}_{:05}.png", name, number), selector);
}

std::span<const Native> movie_natives() { return kMovieNatives; }

}  // namespace breve::steve
