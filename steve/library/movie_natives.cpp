// Natives of Movie and Graph that write files, and those of the controller that write what its camera sees. A movie is
// packed in memory, and its file is written when it ends.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "runtime/movie/movie.hpp"
#include "runtime/scene/plot_picture.hpp"
#include "runtime/store/image.hpp"
#include "steve/library/pictures.hpp"
#include "steve/library/show.hpp"
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

// Names that say that a movie is meant. Any other name is that of numbered pictures.
constexpr std::uint64_t kOfPacking = 64;  // work for each pixel of a picture that is packed into a movie
constexpr std::array<std::string_view, 11> kEndings{"mp4", "mpeg", "mpg", "m4v", "mov", "avi",
                                                    "mkv", "webm", "gif", "ogv", "wmv"};

/// Where the ending of a name begins, at its dot; its length if it has none.
std::size_t dot_of(std::string_view name) {
  const std::size_t slash = name.rfind('/'), dot = name.rfind('.');
  const std::size_t begin = slash == std::string_view::npos ? 0 : slash + 1;
  return dot == std::string_view::npos || dot <= begin ? name.size() : dot;
}

/// "mp4" of "walk.MP4".
std::string format_of(std::string_view name) {
  const std::size_t dot = dot_of(name);
  std::string format(name.substr(std::min(dot + 1, name.size())));
  for (char& c : format)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return format;
}

/// A movie that is being made, and the file that it goes to. The file is opened at once, so that a host that refuses it
/// does so before anything is drawn, and written as a whole: how often a codec writes is not the run's business.
class Packer final : public NativePointer {
 public:
  Packer(Machine& machine, std::string_view name)
      : name_(name),
        output_(machine.heap().memory()),
        file_(open_for_writing(machine, name, false)),
        replays_(machine.host().replays && machine.host().replays()) {
    format_ = {format_of(name), 0, 0, 1 / machine.world().iteration_step()};
    format_.fps = std::clamp(format_.fps, 1.0, 120.0);
  }
  /// One that nobody has closed is written as far as it was made.
  ~Packer() override {
    try {
      finish();
    } catch (...) {  // nobody hears of it
    }
  }
  Packer(const Packer&) = delete;
  Packer& operator=(const Packer&) = delete;

  const std::string& name() const { return name_; }
  void add(const DrawnView& view) {
    added_ = true;
    if (replays_) return;  // the file is not written
    if (!movie_) {
      format_.width = view.width;
      format_.height = view.height;
      movie_ = movie::open(format_, output_);
    }
    movie_->add(view.rgba);
  }
  void finish() {
    const auto file = std::move(file_);
    const auto movie = std::move(movie_);
    if (!file) return;
    if (movie) movie->finish();
    if (added_) file->write(replays_ ? std::string_view(" ") : output_.bytes());
    file->close();
  }

 private:
  std::string name_;
  movie::Settings format_;
  movie::MemoryOutput output_;
  std::unique_ptr<FileWriter> file_;
  std::unique_ptr<movie::Movie> movie_;  // null before the first picture
  bool replays_, added_ = false;
};

/// Runs something that fills or writes a file: 1, or 0 with a warning.
template <class Work>
std::int32_t try_to_pack(Machine& machine, std::string_view name, Work work) {
  try {
    work();
    return 1;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::File && error.code() != ErrorCode::Unsupported) throw;
    machine.warn(fmt::format("movie '{}' not written: {}", name, error.what()));
    return 0;
  }
}

Text movie_get_base_name(Machine& machine, Instance&, Text file) {
  return machine.heap().string(view(file).substr(0, dot_of(view(file))));
}

std::int32_t movie_can_draw(Machine& machine, Instance&) { return draw_view(machine, "record") ? 1 : 0; }

std::int32_t movie_has_format(Machine& machine, Instance&, Text file) {
  const std::string name(view(file)), format = format_of(name);
  if (std::find(kEndings.begin(), kEndings.end(), format) == kEndings.end()) return 0;
  std::string why;
  std::int32_t has = movie::has_format(format, why) ? 1 : 0;
  // Whether ffmpeg's libraries are here does not change the run that is repeated elsewhere.
  if (machine.host().from_outside) machine.host().from_outside(&has, sizeof has);
  if (has == 0)
    machine.warn_once("movie:" + format,
                      fmt::format("record: {}, so '{}' becomes numbered pictures, {}_00000.png and so on", why, name,
                                  name.substr(0, dot_of(name))));
  return has;
}

PointerCell* movie_pack(Machine& machine, Instance&, Text file) {
  const std::string name(view(file));
  std::unique_ptr<Packer> packer;
  if (!try_to_pack(machine, name, [&] { packer = std::make_unique<Packer>(machine, name); })) return nullptr;
  return machine.heap().pointer(std::move(packer));
}

Packer* packer_of(PointerCell* pointer) { return pointer ? dynamic_cast<Packer*>(pointer->native.get()) : nullptr; }

std::int32_t movie_add_picture(Machine& machine, Instance&, PointerCell* pointer) {
  Packer* const packer = packer_of(pointer);
  if (!packer) {
    machine.warn("this movie has ended: the world went back to an earlier state, which has no open files");
    return 0;
  }
  const DrawnView* const drawn = draw_view(machine, "add-frame-from-display", kOfPacking);
  if (!drawn) return 0;
  return try_to_pack(machine, packer->name(), [&] { packer->add(*drawn); });
}

void movie_finish(Machine& machine, Instance&, PointerCell* pointer) {
  if (Packer* const packer = packer_of(pointer)) try_to_pack(machine, packer->name(), [&] { packer->finish(); });
}

std::int32_t movie_write_frame(Machine& machine, Instance&, Text name, std::int32_t number) {
  return write_frame(machine, view(name), number, "add-frame-from-display") ? 1 : 0;
}

// --- Graph -----------------------------------------------------------------------------------------------------------

constexpr std::uint64_t kOfNumber = 16;  // work for a line or value that is copied before it is written

std::int32_t graph_write(Machine& machine, Instance& self, Text file) {
  const std::string name(view(file));
  const bool table = name.ends_with(".csv"), scalable = name.ends_with(".svg");
  if (!table && !scalable && !name.ends_with(".png"))
    throw Error(ErrorCode::Argument, fmt::format("write: '{}' does not end with .svg, .png or .csv", name));
  machine.charge_for(kOfNumber * plot_size(machine, self));
  const ScenePlot plot = plot_of(machine, self, machine.poller());
  const CostMeter meter = [&machine](std::uint64_t units) { machine.charge(units); };
  if (table) return write_picture(machine, "write", name, plot_csv(plot, meter));
  if (scalable) return write_picture(machine, "write", name, plot_svg(plot, meter));
  constexpr std::uint64_t kPixels = 900 * 520;
  machine.charge_for(kOfDeflation * kPixels);
  return write_picture(machine, "write", name, png_of(plot, meter));
}

constexpr Native kMovieNatives[] = {
    native<save_snapshot>("control.save-snapshot", Reach::Writes),
    native<save_depth_snapshot>("control.save-depth-snapshot", Reach::Writes),
    native<toggle_recording>("control.toggle-recording-to-movie", Reach::Writes),
    native<movie_get_base_name>("movie.get-base-name"),
    native<movie_can_draw>("movie.can-draw"),
    native<movie_has_format>("movie.has-format"),
    native<movie_pack>("movie.pack", Reach::Writes),
    native<movie_add_picture>("movie.add-picture", Reach::Writes),
    native<movie_finish>("movie.finish", Reach::Writes),
    native<movie_write_frame>("movie.write-frame", Reach::Writes),
    native<graph_write>("graph.write", Reach::Writes),
};

}  // namespace

std::string png_of(const ScenePlot& plot, const CostMeter& meter) {
  const Picture picture = plot_picture(plot, meter);
  const Poll poll = meter ? Poll([&meter] { meter(0); }) : Poll();
  const std::size_t row = 4 * static_cast<std::size_t>(picture.width);
  return make_png(
      PngKind::Rgba8, picture.width, picture.height,
      [&](std::size_t y, std::span<std::uint8_t> to) { std::copy_n(picture.rgba.data() + y * row, row, to.begin()); },
      poll);
}

std::span<const Native> movie_natives() { return kMovieNatives; }

}  // namespace breve::steve
