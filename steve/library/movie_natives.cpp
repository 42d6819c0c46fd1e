// Natives of Movie, and those of the controller that write what its camera sees.
#include <fmt/format.h>

#include <vector>

#include "runtime/store/image.hpp"
#include "steve/library/pictures.hpp"
#include "steve/library/support.hpp"
#include "steve/library/tables.hpp"

namespace breve::steve {

namespace {

using Text = StringCell*;

void save_snapshot(Machine& machine, Instance&, Text name) {
  write_view(machine, std::string(view(name)), "save-snapshot");
}

void save_depth_snapshot(Machine& machine, Instance&, Text file, std::int32_t linear, double farthest) {
  constexpr std::string_view kSelector = "save-depth-snapshot";
  const DepthGrays gray(kSelector, linear != 0, farthest);
  const DrawnView* view = draw_view(machine, kSelector, kOfDeflation);
  if (!view) return;
  std::vector<double> grays;
  grays.reserve(view->depth.size());
  for (const float depth : view->depth) grays.push_back(gray.of(depth));
  write_picture(machine, kSelector, std::string(steve::view(file)),
                gray16_png(view->width, view->height, grays, machine.poller()));
}

void toggle_recording(Machine& machine, Instance&) {
  DrawingFlags& flags = machine.world().view().flags;
  flags.recording = !flags.recording;
  if (flags.recording && !draw_view(machine, "toggle-recording-to-movie")) flags.recording = false;
}

// --- Movie -----------------------------------------------------------------------------------------------------------

Text movie_get_base_name(Machine& machine, Instance&, Text file) {
  const std::string_view name = view(file);
  const std::size_t slash = name.rfind('/'), dot = name.rfind('.');
  const std::size_t begin = slash == std::string_view::npos ? 0 : slash + 1;
  return machine.heap().string(dot == std::string_view::npos || dot <= begin ? name : name.substr(0, dot));
}

std::int32_t movie_can_draw(Machine& machine, Instance&) { return draw_view(machine, "record") ? 1 : 0; }

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

std::span<const Native> movie_natives() { return kMovieNatives; }

}  // namespace breve::steve
